"""The map of self-excited whirl as text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from leblanc.core.units import LENGTH, RPM, VOLUME, in_rpm, number, with_unit
from leblanc.results.whirl_map import WhirlMap

if TYPE_CHECKING:
    from collections.abc import Sequence

MOST_BANDS = 4  # listed one by one


def answer(found: WhirlMap) -> str:
    """Where a whirl grows, in one sentence."""
    values = dict(facts(found))
    if not (found.growth > 0.0).any():
        if found.not_known == found.growth.size:
            return "Whether a whirl grows by itself is not known at any speed with any volume of liquid."
        where = (
            "where it is known, which is not everywhere" if found.not_known else "with any volume of liquid"
        )
        return f"No whirl grows by itself at any speed {where}."
    own = f"with the scene's {with_unit(found.scene_volume, VOLUME)}"
    bands = f"from {band_words(found.scene_edges)} rpm" if found.scene_edges else "nowhere"
    largest = _largest(found)
    grown = f", up to {largest}" if largest else ""
    return (
        f"A whirl grows by itself at {values['A whirl grows at']}, fastest by {values['Fastest growth']}; "
        f"{own} it grows {bands}{grown}."
    )


def _largest(found: WhirlMap) -> str:
    """Amplitude of the largest stable whirl, and its speed; empty where there is none."""
    stable = [row for row in _within(found) if row["stable"]]
    if not stable:
        return ""
    row = max(stable, key=lambda row: float(row["amplitude"]))
    return f"{with_unit(row['amplitude'], LENGTH)} at {in_rpm(row['speed'])}"


def _within(found: WhirlMap) -> list[dict[str, Any]]:
    """Limit cycles at the speeds of the map, without those on the way to them."""
    # The whirl at the end of the range is there up to rounding.
    first, last = float(found.speed[0]) * (1.0 - 1e-9), float(found.speed[-1]) * (1.0 + 1e-9)
    return [row for row in found.cycles if first <= row["speed"] <= last]


def cycle_facts(found: WhirlMap) -> list[tuple[str, str]]:
    """What the limit cycles say in numbers: label and value; nothing where there are none."""
    rows = _within(found)
    if not rows:
        return []
    stable = [row for row in rows if row["stable"]]
    folds = [f"{in_rpm(fold['speed'])} at {with_unit(fold['amplitude'], LENGTH)}" for fold in found.folds]
    said = [
        ("Whirls of finite size", f"{len(rows)} on {len(found.branches or ())} branches"),
        ("Largest stable whirl", _largest(found) or "none is stable"),
    ]
    if stable:
        power = max(stable, key=lambda row: float(row["power"]))
        ends = [number(f([row["speed"] for row in stable]) * RPM) for f in (min, max)]
        turning = [number(f([row["whirl_speed"] for row in stable]) * RPM) for f in (min, max)]
        lag = max(float(row["lag"] / row["speed"]) for row in stable)
        said += [
            ("Stable whirls (rpm)", f"{ends[0]} to {ends[1]}"),
            ("They go round in space with (rpm)", f"{turning[0]} to {turning[1]}"),
            ("Their liquid lags by up to", f"{number(100.0 * lag)} % of the spin"),
            ("Power of the drive on top", f"up to {number(power['power'])} W at {in_rpm(power['speed'])}"),
        ]
    return [*said, ("Folds", "; ".join(folds) or "none in this range")]


def band_words(bands: Sequence[tuple[float, float]]) -> str:
    """Ranges of speed in which a whirl grows."""
    parts = [f"{number(low * RPM)} to {number(high * RPM)}" for low, high in bands]
    if len(parts) > MOST_BANDS:
        return f"{len(parts)} bands between {number(bands[0][0] * RPM)} and {number(bands[-1][1] * RPM)}"
    return "; ".join(parts) or "none"


def facts(found: WhirlMap) -> list[tuple[str, str]]:
    """What the map says in numbers: label and value."""
    growth, size = found.growth, found.growth.size
    unstable = growth > 0.0
    fastest, turning = "none grows", "none grows"
    if unstable.any():
        row, column = np.unravel_index(int(np.nanargmax(growth)), growth.shape)
        speed, volume = float(found.speed[column]), float(found.volume[row])
        at = f"{in_rpm(speed)}, {with_unit(volume, VOLUME)}"
        fastest = f"{number(float(growth[row, column]))} 1/s at {at}"
        turning = f"{number(float(found.whirl_speed[row, column]) / speed)} of the spin"
    return [
        ("Volumes by speeds", f"{found.volume.size} by {found.speed.size}"),
        ("Most liquid, all chambers", with_unit(float(found.volume[-1]), VOLUME)),
        ("A whirl grows at", f"{number(100.0 * float(np.count_nonzero(unstable)) / size)} % of the points"),
        *([("Growth not known at", f"{found.not_known} of {size} points")] if found.not_known else []),
        ("Fastest growth", fastest),
        ("That whirl's speed in space", turning),
        (
            f"Bands with the scene's {with_unit(found.scene_volume, VOLUME)} (rpm)",
            band_words(found.scene_edges),
        ),
        ("Friction of the liquid", found.friction),
        ("Support", found.damping),
        *cycle_facts(found),
    ]


def alt(found: WhirlMap) -> str:
    """What the figure shows and the numbers a reader would take from it."""
    values = dict(facts(found))
    return (
        "Map of the growth rate over speed and liquid, and of the whirl's speed where one grows; one grows "
        f"at {values['A whirl grows at']}, fastest: {values['Fastest growth']}."
    )


def cycles_alt(found: WhirlMap) -> str:
    """What the figure of limit cycles shows and the numbers a reader would take from it."""
    values = dict(cycle_facts(found))
    return (
        "Curves of the amplitude and, below, of the frequency of self-excited whirls over speed, the stable "
        f"ones in full lines. Largest: {values['Largest stable whirl']}; folds: {values['Folds']}."
    )
