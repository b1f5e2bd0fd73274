"""Whirl of a rotor with an exact layer: where it begins softly, the circle it comes to, where it breaks.

`python -m validation.exact_whirl` computes it again; `kept` reads what it left. Closed forms are in `edges`.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from validation.exact_whirl.in_time import Grown, Setting
from validation.exact_whirl.lagging import Circle

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


def kept() -> Kept:
    """What was computed last."""
    found = json.loads(KEPT.read_text(encoding="utf-8"))
    ways = [
        Way(way["layer"], way["mass_ratio"], tuple(Circle(**each) for each in way["circles"]))
        for way in found["ways"]
    ]
    onsets = [
        Onset(**{key: float("nan") if value is None else value for key, value in each.items()})
        for each in found["onsets"]
    ]
    return Kept(
        damping=found["damping"],
        friction=found["friction"],
        onsets=tuple(onsets),
        ways=tuple(ways),
        settled=tuple(_grown(each) for each in found["settled"]),
        grown=tuple(_grown(each) for each in found["grown"]),
    )


def _grown(found: dict[str, Any]) -> Grown:
    series = {key: tuple(found[key]) for key in ("time", "whirl")}
    return Grown(**(found | series | {"setting": Setting(**found["setting"])}))


def keep(results: Kept) -> None:
    """Write what was computed."""
    KEPT.write_text(json.dumps(_plain(asdict(results)), separators=(",", ":")) + "\n", encoding="utf-8")


def _plain(value: object) -> object:
    """As JSON has it: no nan, nine digits."""
    if isinstance(value, float):
        return None if value != value else float(f"{value:.9g}")
    if isinstance(value, dict):
        return {key: _plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    return value
