"""All that a page shows, and what its controls do to it."""

from __future__ import annotations

import re
import tempfile
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

from leblanc.app.jobs import WORKS, Jobs
from leblanc.app.live import Live, numbers
from leblanc.app.machine import Machine
from leblanc.core.files import path_text
from leblanc.core.units import VOLUME, unit_for
from leblanc.scene.schema.load import SceneError
from leblanc.studies.fit.measured import read_measured
from meshes.errors import InputError

FROZEN = 5  # curves beside the present one
MOST_UPLOADED = 5_000_000  # characters of a table or a machine file

Push = Callable[[str, Any], None]


class State:
    """A machine, its answer, what it is compared with and the work on it.

    `push` is called, in any thread, with the name and the value of what has changed: form, curve, words,
    compared, jobs, said. Every change goes through one lock, so that pages and threads do not mix.
    """

    def __init__(self, text: str, file: str, push: Push) -> None:
        """Raises a `SceneError` with everything that is wrong with the text."""
        self.machine = Machine(text, file)
        self._push = push
        self._lock = threading.RLock()
        self._frozen: list[dict[str, Any]] = []
        self._measured: dict[str, Any] | None = None
        self._curve: dict[str, Any] | None = None
        self._count = 0
        self._live = Live(self._heard)
        self._jobs = Jobs(self._tell_of_jobs)

    def begin(self) -> None:
        """Show everything, and answer the machine for the first time."""
        with self._lock:
            self._tell_of_form()
            self._tell_of_compared()
            self._tell_of_jobs()
            self._say("")
            self._live.ask(self.machine.scene)

    def close(self) -> None:
        """End the work."""
        self._jobs.close()
        self._live.close()

    def drag(self, path: str, typed: str, mark: str = "") -> None:
        """A slider goes by a value."""
        with self._lock:
            if self.machine.drag(path, typed):
                self._say("")
                self._live.ask(self.machine.scene, mark)
            else:
                self._tell_of_faults()

    def edit(self, path: str, typed: str, mark: str = "") -> None:
        """A value is typed, or a slider let go."""
        with self._lock:
            self.machine.edit(path, typed)
            self._tell_of_form()
            self._tell_of_faults()
            self._live.ask(self.machine.scene, mark)  # where it is refused that before the slider was drawn

    def undo(self) -> None:
        """One step back."""
        self._step(self.machine.undo)

    def redo(self) -> None:
        """One step forward again."""
        self._step(self.machine.redo)

    def _step(self, step: Callable[[], None]) -> None:
        with self._lock:
            step()
            self._tell_of_form()
            self._say("")
            self._live.ask(self.machine.scene)

    def freeze(self) -> None:
        """Keep the present curve to compare with."""
        with self._lock:
            if self._curve is None:
                self._say("There is no curve to freeze yet.")
                return
            self._count += 1
            kept = {name: self._curve[name] for name in ("speed", "amplitude")}
            self._frozen = [*self._frozen, kept | {"name": f"frozen {self._count}"}][-FROZEN:]
            self._tell_of_compared()

    def clear(self) -> None:
        """Compare with nothing any more."""
        with self._lock:
            self._frozen, self._measured, self._count = [], None, 0
            self._tell_of_compared()

    def measured(self, name: str, content: str) -> None:
        """Lay a measured curve beside, from a table as `leblanc fit` reads it."""
        with self._lock, tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "measured.csv"
            try:
                if len(content) > MOST_UPLOADED:
                    raise InputError("measured", f"{len(content)} characters", f"at most {MOST_UPLOADED}")
                path.write_text(content, encoding="utf-8")
                found = read_measured(path, ())
                columns = dict(found.columns)
                if found.over != "speed" or "amplitude" not in columns:
                    raise InputError("measured", found.over, "a table of an amplitude over speed")
            except InputError as error:
                self._say(str(error).replace(str(path), path_text(name)))
                return
            self._measured = {
                "name": f"measured, {path_text(name)}",
                "speed": numbers(found.at),
                "amplitude": numbers(columns["amplitude"]),
            }
            self._say(" ".join(note.text for note in found.notes))
            self._tell_of_compared()

    def open(self, name: str, content: str) -> None:
        """Take another machine file in place of this one."""
        with self._lock:
            try:
                self.machine = Machine(content[:MOST_UPLOADED], Path(name).name or "scene.toml")
            except SceneError as error:
                self._say(str(error))
                return
            self._jobs.close()
            self._frozen, self._measured, self._curve = [], None, None
            self.begin()

    def start(self, kind: str, speed: float | None = None) -> None:
        """Start long work on the machine as it is."""
        with self._lock:
            if kind not in WORKS:
                return
            if kind == "runup" and self.machine.scene.speed_plan is None:
                self._say("This machine has no run-up: its file has no table [runup] or [programme].")
                return
            options = ("--speed", f"{speed!r} rad/s") if kind == "view" and speed is not None else ()
            self._jobs.start(kind, self.machine.text, self.machine.file, options)

    def cancel(self, kind: str) -> None:
        """End long work."""
        self._jobs.cancel(kind)

    def dismiss(self, kind: str) -> None:
        """Forget long work and its result."""
        self._jobs.dismiss(kind)

    def content(self, kind: str) -> dict[str, str] | None:
        """File that long work has made."""
        return self._jobs.content(kind)

    def take_best(self) -> None:
        """Fill the chambers with the best volumes that were found."""
        with self._lock:
            found = self._jobs.result("best")
            if found is None or not found.get("volume"):
                self._say("No best volumes have been found yet.")
                return
            volumes = {}
            for k, volume in enumerate(found["volume"]):
                unit = unit_for(VOLUME, volume)
                volumes[f"chambers.{k}.volume"] = f"{volume * unit.count:.6g} {unit.name}"
            went = self.machine.put(volumes)
            self._tell_of_form()
            self._tell_of_faults()
            if went:
                self._live.ask(self.machine.scene)

    def _heard(self, news: dict[str, Any]) -> None:
        """An answer, its words, or why there is none; called in the thread that answers."""
        with self._lock:
            if "fault" in news:
                self._push("said", {"text": news["fault"], "path": "", "mark": news["mark"]})
            elif "words" in news:
                self._push("words", news["words"])
            else:
                self._curve = news["curve"]
                self._push("curve", {"curve": news["curve"], "mark": news["mark"]})

    def _tell_of_form(self) -> None:
        machine = self.machine
        name = re.sub(r"[^\w-]+", "_", Path(machine.file).stem) or "scene"
        self._push(
            "form",
            {
                "name": machine.scene.name,
                "file": f"{name}.toml",
                "groups": machine.form(),
                "text": machine.text,
                "undo": machine.can_undo,
                "redo": machine.can_redo,
                "runup": machine.scene.speed_plan is not None,
            },
        )

    def _tell_of_compared(self) -> None:
        self._push("compared", {"frozen": self._frozen, "measured": self._measured})

    def _tell_of_jobs(self) -> None:
        self._push("jobs", self._jobs.shown())

    def _tell_of_faults(self) -> None:
        faults = self.machine.faults
        path = next(iter(faults), "")
        self._push("said", {"text": faults.get(path, ""), "path": path, "mark": ""})

    def _say(self, text: str) -> None:
        self._push("said", {"text": text, "path": "", "mark": ""})
