"""How a study is to hold waves in time, and what it knows before."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from meshes.arrays import Array, Flags
from solvers.held.state import COUPLED
from solvers.synchronous.response import Response


@dataclass(frozen=True)
class Holding:
    """How waves are integrated in time."""

    workers: int = 0  #: processes; 0 or 1 for this one alone
    #: where states are kept, so that a run that was broken off goes on; None keeps none
    folder: Path | None = None
    fresh: bool = False  #: do not take what is kept there
    #: its name in py-pde; another than the compiled steps is slow, and an independent check
    solver: str = COUPLED


HERE = Holding()


def cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@dataclass(frozen=True)
class Began:
    """The steady answer with which time-domain states begin; n speeds."""

    answer: Response  #: at the speeds asked for
    refined: Response  #: between them
    growth: Array  #: of the fastest-growing whirl, 1/s, shape (n,)
    at: Flags  #: at which speeds the wave is to be held, shape (n,)
