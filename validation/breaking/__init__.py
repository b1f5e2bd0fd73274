"""When the nonlinear wave breaks, how high natural waves are at most, how far long waves go with it.

`python -m tests.breaking` computes it again; `kept` reads what it left.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from validation.study import stored

KEPT = Path(__file__).parent / "results.json"


@dataclass(frozen=True)
class Ending:
    """The nonlinear wave under a whirl as fast as the backward natural wave, grown over 0.9 whirl periods."""

    depth: float  #: h_0/R
    whirl: float  #: w_0/h_0
    periods: float  #: whirl periods until it broke, or that it was followed
    state: str  #: what was known of it then
    reason: str  #: why it is broken, or empty
    crest: float  #: greatest depth over h_0
    crest_number: float  #: greatest speed of the liquid at a crest over that of the crest
    slope: float  #: steepest, deg
    nodes: int  #: at the end


@dataclass(frozen=True)
class Highest:
    """The highest natural sloshing wave of one crest at a depth."""

    depth: float  #: h_0/R
    #: its depth over h_0, continued to a crest at which the liquid stands still, seen from the wave
    crest: float
    last: float  #: crest of the last wave that was found, over h_0
    speed: float  #: of the liquid at that crest seen from the wave, over |s| R
    slip: float  #: s/Omega of that wave running backward


@dataclass(frozen=True)
class Beside:
    """Long waves beside the exact one until it breaks, at one depth and whirl."""

    depth: float  #: h_0/R, w_0/h_0
    whirl: float
    dispersion: bool  #: of the long waves
    #: of each whirl period that the fully nonlinear wave finished, how far off the mean force is, relative
    force: tuple[float, ...]
    time: tuple[float, ...]  #: of the crests, whirl periods
    exact: tuple[float, ...]  #: greatest depth over h_0 then, of the fully nonlinear wave and of the long one
    crest: tuple[float, ...]
    #: whirl periods until a front stands in the long wave; None: there is none until then
    front: float | None


@dataclass(frozen=True)
class Kept:
    """All of them."""

    endings: tuple[Ending, ...]
    highest: tuple[Highest, ...]
    beside: tuple[Beside, ...]


kept, keep = stored(KEPT, Kept)
