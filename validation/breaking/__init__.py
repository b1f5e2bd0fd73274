"""When the exact wave breaks, how high free waves are at most, and how far long waves go with it until then.

`python -m validation.breaking` computes it again; `kept` reads what it left.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path

KEPT = Path(__file__).parent / "results.json"


@dataclass(frozen=True)
class Ending:
    """The exact wave under a whirl as fast as the backward free wave, grown over 0.9 whirl periods.

    Parameters
    ----------
    depth : h_0/R
    whirl : w_0/h_0
    periods : whirl periods until it broke, or that it was followed
    state : what was known of it then
    reason : why it is broken, or empty
    crest : greatest depth over h_0
    crest_number : greatest speed of the liquid at a crest over that of the crest
    slope : steepest, deg
    nodes : at the end
    """

    depth: float
    whirl: float
    periods: float
    state: str
    reason: str
    crest: float
    crest_number: float
    slope: float
    nodes: int


@dataclass(frozen=True)
class Highest:
    """The highest free wave of one crest at a depth.

    Parameters
    ----------
    depth : h_0/R
    crest : its depth over h_0, continued to a crest at which the liquid stands still, seen from the wave
    last : crest of the last wave that was found, over h_0
    speed : of the liquid at that crest seen from the wave, over |s| R
    slip : s/Omega of that wave running backward
    """

    depth: float
    crest: float
    last: float
    speed: float
    slip: float


@dataclass(frozen=True)
class Beside:
    """Long waves beside the exact one until it breaks, at one depth and whirl.

    Parameters
    ----------
    depth, whirl : h_0/R, w_0/h_0
    dispersion : of the long waves
    force : of each whirl period that the exact wave finished, how far off the mean force is, relative
    time : of the crests, whirl periods
    exact, crest : greatest depth over h_0 then, of the exact wave and of the long one
    front : whirl periods until a front stands in the long wave; None: there is none until then
    """

    depth: float
    whirl: float
    dispersion: bool
    force: tuple[float, ...]
    time: tuple[float, ...]
    exact: tuple[float, ...]
    crest: tuple[float, ...]
    front: float | None


@dataclass(frozen=True)
class Kept:
    """All of them."""

    endings: tuple[Ending, ...]
    highest: tuple[Highest, ...]
    beside: tuple[Beside, ...]


def kept() -> Kept:
    """What was computed last."""
    found = json.loads(KEPT.read_text(encoding="utf-8"))
    series = ("force", "time", "exact", "crest")
    return Kept(
        endings=tuple(Ending(**row) for row in found["endings"]),
        highest=tuple(Highest(**row) for row in found["highest"]),
        beside=tuple(Beside(**row | {key: tuple(row[key]) for key in series}) for row in found["beside"]),
    )


def keep(results: Kept) -> None:
    """Write what was computed.

    Parameters
    ----------
    results : all of it
    """
    KEPT.write_text(json.dumps(asdict(results), indent=1) + "\n", encoding="utf-8")
