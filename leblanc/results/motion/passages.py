"""A run-up part by part: the steps of its programme, and where the speed falls."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from meshes.arrays import Flags

if TYPE_CHECKING:
    from solvers.runup.runup import RunupHistory

_STEADY = 1e-9  # relative change of the speed that is none


@dataclass(frozen=True)
class Passage:
    """A step of a programme as it went."""

    step: int  #: its number, from 1
    text: str  #: as a person writes it
    way: str  #: "up", "hold" or "down"
    begin: float  #: s
    end: float
    speed_begin: float  #: rad/s
    speed_end: float
    amplitude: float  #: largest deflection of the axis in it, m
    speed: float  #: where that was, rad/s and s
    time: float
    amplitude_dry: float  #: the largest without liquid, m; nan where that was not run


def passages_of(history: RunupHistory, dry: RunupHistory | None, texts: Sequence[str]) -> tuple[Passage, ...]:
    """The steps of a programme that were reached, in their order."""
    found = []
    for number, text in enumerate(texts):
        samples, bare = _samples(history, number), None if dry is None else _samples(dry, number)
        if not samples.size:
            continue
        largest = samples[np.argmax(history.largest[samples])]
        first, last = samples[0] - 1, samples[-1]
        begin, end = float(history.speed[first]), float(history.speed[last])
        way = "hold" if abs(end - begin) <= _STEADY * begin else "up" if end > begin else "down"
        has_dry = dry is not None and bare is not None and bare.size > 0
        found.append(
            Passage(
                step=number + 1,
                text=text,
                way=way,
                begin=float(history.time[first]),
                end=float(history.time[last]),
                speed_begin=begin,
                speed_end=end,
                amplitude=float(history.largest[largest]),
                speed=float(history.largest_speed[largest]),
                time=float(history.largest_time[largest]),
                amplitude_dry=float(dry.largest[bare].max()) if has_dry and dry is not None else np.nan,
            )
        )
    return tuple(found)


def _samples(history: RunupHistory, number: int) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """Samples that a step leads to; the one at the beginning belongs to none."""
    if history.stage is None:
        return np.empty(0, dtype=np.intp)
    found = np.flatnonzero(history.stage == number)
    return found[found > 0]


def falling(history: RunupHistory, passages: Sequence[Passage], turning: int) -> Flags:
    """The speed falls on the way to a sample, shape (k,); `turning` is the last before a run-up falls."""
    size = history.time.size
    if not passages or history.stage is None:
        return np.arange(size) > turning
    down = [passage.step - 1 for passage in passages if passage.way == "down"]
    return np.isin(history.stage, down) & (np.arange(size) > 0)


def pieces(there: Flags) -> list[slice]:
    """Parts of a run in which a condition holds, each with the sample before it, from which it is drawn."""
    edge = np.flatnonzero(np.diff(np.concatenate(([False], there, [False])).astype(np.int8)))
    pairs = zip(edge[::2].tolist(), edge[1::2].tolist(), strict=True)
    return [slice(max(first - 1, 0), last) for first, last in pairs]
