"""Long work of a page: commands in processes of their own, with how far they have come; each can be ended."""

from __future__ import annotations

import base64
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import tomlkit

from leblanc.core.files import native

_PERCENT = re.compile(r", (\d+) %")
_LINES = 20  # of what it said that are kept
_MOST = 1500  # points of a curve that is drawn
_END = 5.0  # s until a process that is to end is killed
TYPES = {".html": "text/html", ".gif": "image/gif", ".png": "image/png"}


@dataclass(frozen=True)
class Work:
    """A command that may be started."""

    title: str
    command: tuple[str, ...]  #: behind `leblanc`, before the file
    options: tuple[str, ...] = ()  #: {out} is its folder
    file: str = ""  #: in that folder, for the user; empty where its JSON is drawn


WORKS = {
    "runup": Work("Run-up", ("runup",), ("--json", "--out", "{out}/result")),
    "map": Work(
        "Stability map", ("map",), ("--json", "--out", "{out}/result", "--volumes", "41", "--speeds", "81")
    ),
    "best": Work("Best volume", ("optimise",), ("--json", "--out", "{out}/result")),
    "report": Work("Report", ("run",), ("--json", "--out", "{out}/result"), "result/summary.html"),
    "film": Work("Film", ("view",), ("--json", "--animate", "{out}/film.gif"), "film.gif"),
    "view": Work("3-D view", ("view",), ("--json", "--screenshot", "{out}/view.png"), "view.png"),
}


@dataclass
class Job:
    """One command that runs or has run."""

    kind: str
    process: subprocess.Popen[str]
    folder: tempfile.TemporaryDirectory[str]
    said: list[str] = field(default_factory=list)
    done: int | None = None  #: per cent, None where it is not known
    state: str = "runs"  #: or done, failed, cancelled
    result: dict[str, Any] | None = None

    def as_shown(self) -> dict[str, Any]:
        """What a page shows of it."""
        words = self.said[-1] if self.said else ""
        shown = {"kind": self.kind, "title": WORKS[self.kind].title, "state": self.state, "done": self.done}
        return shown | {"words": words, "result": self.result}


class Jobs:
    """One job of each kind at most; `heard` is called, in any thread, when something has changed."""

    def __init__(self, heard: Callable[[], None]) -> None:
        self._heard, self._jobs = heard, dict[str, Job]()

    def start(self, kind: str, text: str, file: str, options: tuple[str, ...] = ()) -> None:
        """Start a kind of work on the text of a machine file; what runs of that kind is ended."""
        self.cancel(kind)
        self._forget(kind)
        work = WORKS[kind]
        folder = tempfile.TemporaryDirectory(prefix="leblanc-app-", ignore_cleanup_errors=True)
        scene = Path(folder.name) / "machine.toml"
        scene.write_text(elsewhere(text, file), encoding="utf-8")
        asked = [*work.command, str(scene), *(one.format(out=folder.name) for one in work.options), *options]
        process = subprocess.Popen(
            [sys.executable, "-m", "leblanc", *asked],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            stdin=subprocess.DEVNULL,
            text=True,
            cwd=folder.name,
            env=os.environ | {"PYTHONPATH": os.pathsep.join(path for path in sys.path if path)},
            start_new_session=True,  # so that its own processes end with it
        )
        job = self._jobs[kind] = Job(kind, process, folder)
        threading.Thread(target=self._follow, args=(job,), daemon=True, name=f"job {kind}").start()
        self._heard()

    def cancel(self, kind: str) -> None:
        """End a job that runs."""
        job = self._jobs.get(kind)
        if job is None or job.state != "runs":
            return
        job.state, job.said = "cancelled", ["cancelled"]
        _end(job.process)
        self._heard()

    def dismiss(self, kind: str) -> None:
        """Forget a job and its result."""
        self.cancel(kind)
        self._forget(kind)
        self._heard()

    def close(self) -> None:
        """End all, and leave nothing behind."""
        for kind in list(self._jobs):
            self.cancel(kind)
            self._forget(kind)

    def shown(self) -> list[dict[str, Any]]:
        """All of them for a page."""
        return [job.as_shown() for job in list(self._jobs.values())]

    def result(self, kind: str) -> dict[str, Any] | None:
        """Result of a job that is done."""
        job = self._jobs.get(kind)
        return None if job is None else job.result

    def content(self, kind: str) -> dict[str, str] | None:
        """File that a job made, as a page takes it; None where there is none."""
        job = self._jobs.get(kind)
        if job is None or job.state != "done" or not WORKS[kind].file:
            return None
        path = Path(job.folder.name) / WORKS[kind].file
        data = base64.b64encode(path.read_bytes()).decode("ascii")
        return {"name": path.name, "type": TYPES[path.suffix], "data": data}

    def _forget(self, kind: str) -> None:
        job = self._jobs.pop(kind, None)
        if job is not None:
            job.folder.cleanup()

    def _follow(self, job: Job) -> None:
        """Hear what a process says until it ends, and take its answer."""
        stdout, stderr = job.process.stdout, job.process.stderr
        assert stdout is not None and stderr is not None
        answered: list[str] = []
        reader = threading.Thread(target=lambda: answered.append(stdout.read()), daemon=True)
        reader.start()
        for line in stderr:
            if job.state == "runs" and line.strip():
                job.said = [*job.said, line.strip()][-_LINES:]
                found = _PERCENT.search(line)
                job.done = int(found[1]) if found else job.done
                self._heard()
        reader.join()
        code = job.process.wait()
        stdout.close()
        stderr.close()
        if job.state != "runs":
            return
        try:
            job.result = drawn(job.kind, json.loads(answered[0]))
            job.state = "done" if code in (0, 3) else "failed"
        except (ValueError, KeyError, IndexError):
            job.state = "failed"
            job.said = job.said or [f"ended with code {code}"]
        if job.state == "done":
            job.said = [f"{WORKS[job.kind].title} is done"]
        self._heard()


def _end(process: subprocess.Popen[str]) -> None:
    """End a process and those that it started."""
    with suppress(ProcessLookupError, PermissionError):
        os.killpg(process.pid, signal.SIGTERM)
    try:
        process.wait(_END)
    except subprocess.TimeoutExpired:
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(process.pid, signal.SIGKILL)


def elsewhere(text: str, file: str) -> str:
    """The text of a machine file for another folder: files of sections are found from there too."""
    document: Any = tomlkit.parse(text)
    for chamber in document.get("chambers", []):
        section = chamber.get("section")
        if isinstance(section, str) and section:
            chamber["section"] = str((Path(file).parent / native(section)).resolve())
    return str(document.as_string())


def drawn(kind: str, answer: dict[str, Any]) -> dict[str, Any]:
    """What a page draws of the JSON of a command."""
    if kind == "runup":
        step = max(1, len(answer["time"]) // _MOST)
        found = {name: answer[name][::step] for name in ("time", "speed", "amplitude")}
        return found | {"peak": answer["peak"], "notes": answer["notes"]}
    if kind == "map":
        return {name: answer[name] for name in ("speed", "volume", "growth", "scene_volume", "notes")}
    if kind == "best":
        return {name: answer.get(name) for name in ("volume", "meaning", "vibration", "vibration_baseline")}
    return {}
