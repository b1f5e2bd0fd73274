"""Answers of a machine while it changes: the newest wins, older requests are dropped.

Words and tables may take longer than the curve, those of a tub with its loads three times as long: a process
of its own answers once more for them, so that the next curve does not wait.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future
from functools import partial
from typing import Any

import numpy as np

import leblanc as lb
from leblanc.core.answer import Answer, NotConverged
from leblanc.core.blocks import Cell, Checks, Grade, Headline, Notes, Table, flat
from leblanc.scene.scene import Scene
from leblanc.studies.processes import processes
from leblanc.studies.run.answer import RunAnswer
from meshes.arrays import Array
from meshes.errors import InputError

IDLE = 0.15  # s without a new request until words and tables are made
_DIGITS = 6  # of a number that is drawn

Heard = Callable[[dict[str, Any]], None]


class Live:
    """A thread that answers a machine; `heard` is called there with what a page draws.

    A request is a scene and a mark that its answer carries. Of requests that wait the last alone is answered.
    """

    def __init__(self, heard: Heard) -> None:
        self._heard = heard
        self._wanted: tuple[Scene, str] | None = None
        self._count = 0  # of answers begun
        self._over = False
        self._news = threading.Condition()
        self._thread = threading.Thread(target=self._work, daemon=True, name="live")
        self._thread.start()

    def ask(self, scene: Scene, mark: str = "") -> None:
        """Ask for an answer, in place of one that is asked for and not yet begun."""
        with self._news:
            self._wanted = scene, mark
            self._news.notify()

    def close(self) -> None:
        """Ask for nothing more; what is being answered comes to its end."""
        with self._news:
            self._over = True
            self._news.notify()
        self._thread.join()

    def _work(self) -> None:
        with processes(1) as pool:
            pool.submit(words_at)  # loads what it needs meanwhile
            unsaid: tuple[Scene, str] | None = None
            while True:
                with self._news:
                    self._news.wait_for(lambda: self._over or self._wanted is not None, unsaid and IDLE)
                    if self._over:
                        return
                    wanted, self._wanted = self._wanted, None
                if wanted is not None:
                    self._count += 1
                    unsaid = wanted if self._answered(*wanted) else None
                elif unsaid is not None:
                    (scene, mark), unsaid = unsaid, None
                    said = pool.submit(words_at, scene)
                    said.add_done_callback(partial(self._said, self._count, mark))

    def _said(self, count: int, mark: str, said: Future[dict[str, Any] | None]) -> None:
        """Hear the words of an answer unless there is a newer one."""
        if said.cancelled() or said.exception() is not None or count != self._count or self._over:
            return
        self._heard({"words": said.result(), "mark": mark})

    def _answered(self, scene: Scene, mark: str) -> bool:
        """Answer a scene; False where there is no answer."""
        try:
            found = curve_of(lb.run(scene))
        except (InputError, lb.SceneError, NotConverged, ArithmeticError) as error:
            self._heard({"fault": str(error), "mark": mark})
            return False
        self._heard({"curve": found, "mark": mark})
        return True


def curve_of(answer: Answer) -> dict[str, Any] | None:
    """Numbers of the answer that are drawn, SI; None of a machine that has no amplitude over speed."""
    if not isinstance(answer, RunAnswer):
        return None
    curve, moved = answer.curve, answer.chamber_curve
    unstable = [answer.speed[k] for k in np.flatnonzero(~answer.stable)]
    return {
        "speed": numbers(curve.speed),
        "amplitude": numbers(curve.amplitude),
        "dry": numbers(curve.amplitude_dry),
        "in_range": curve.in_range.tolist(),
        "unstable": numbers(np.array(unstable)),
        "bands": [numbers(np.array(band)) for band in answer.whirl_bands],
        "peak": {name: _number(value) for name, value in answer.peak.items()},
        "peak_dry": {name: _number(value) for name, value in answer.peak_dry.items()},
        "real": [numbers(column.real) for column in moved.T],
        "imag": [numbers(column.imag) for column in moved.T],
        "horizontal": answer.axis == "horizontal",
        "capture": None if answer.capture_speed is None else _number(answer.capture_speed),
        "chambers": [
            {
                "radius": each.radius,
                "inner": each.inner_radius,
                "area": each.volume / each.height,
                "round": each.section is None,
                "liquid": each.liquid_name,
            }
            for each in answer.chambers
        ],
    }


def words_at(scene: Scene | None = None) -> dict[str, Any] | None:
    """Words of a machine's answer; None without a machine."""
    return None if scene is None else words_of(lb.run(scene))


def words_of(answer: Answer) -> dict[str, Any]:
    """Headline, cautions and tables of an answer."""
    found: dict[str, Any] = {
        "headline": "",
        "about": "",
        "error": "",
        "cautions": [],
        "notes": [],
        "tables": [],
    }
    for block in flat(answer.blocks(), "page"):
        if isinstance(block, Headline) and not found["headline"]:
            found |= {"headline": block.text, "about": block.about, "error": block.error}
        elif isinstance(block, Checks):
            failed = [one for one in block.rows if one.grade >= Grade.CAUTION]
            found["cautions"] += [f"{one.label}: {one.where}" for one in failed]
        elif isinstance(block, Notes):
            found["notes"] += [text for text in block.texts if text]
        elif isinstance(block, Table) and block.rows:
            rows = [
                [cell.text if isinstance(cell, Cell) else str(cell) for cell in row] for row in block.rows
            ]
            found["tables"].append({"title": block.title, "head": list(block.head), "rows": rows})
    return found


def numbers(values: Array) -> list[float | None]:
    """Values as a page takes them: so many digits, None for what is not finite."""
    return [_number(value) for value in np.asarray(values, dtype=float).tolist()]


def _number(value: float) -> float | None:
    return float(f"{value:.{_DIGITS}g}") if np.isfinite(value) else None
