"""Whirl of a rotor with an exact layer: where it begins softly, the circle it comes to, where it breaks.

`python -m tests.exact_whirl` computes it again; `kept` reads what it left. Closed forms are in `edges`.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from tests.exact_whirl.in_time import Grown
from tests.exact_whirl.lagging import Circle
from validation.study import stored

KEPT = Path(__file__).parent / "results.json"


@dataclass(frozen=True)
class Onset:
    """How a whirl begins on the way up."""

    layer: float  #: h_0/R, mu
    mass_ratio: float
    speed: float  #: Omega/omega_n at which it does; nan where none does
    shift: float  #: change of the circle's Omega/omega_n over (W/h_0)^2; positive where it begins softly


@dataclass(frozen=True)
class Way:
    """Circles of growing whirls from an onset, as far as they were found."""

    layer: float  #: h_0/R, mu
    mass_ratio: float
    circles: tuple[Circle, ...]  #: the onset first


@dataclass(frozen=True)
class Kept:
    """All that is kept."""

    damping: float  #: zeta and k/omega_n of onsets and ways
    friction: float
    onsets: tuple[Onset, ...]  #: over depth and mass ratio
    ways: tuple[Way, ...]  #: of some machines
    settled: tuple[Grown, ...]  #: in time, from a small push at a speed of a way
    grown: tuple[Grown, ...]  #: in time, until the wave ends


kept, keep = stored(KEPT, Kept, digits=9, compact=True)
