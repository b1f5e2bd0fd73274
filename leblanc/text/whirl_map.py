"""The map of self-excited whirl as text."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from leblanc.results.whirl_map import WhirlMap
from leblanc.text.numbers import number
from leblanc.units import RPM, VOLUME, in_rpm, with_unit

if TYPE_CHECKING:
    from collections.abc import Sequence

MOST_BANDS = 4  # listed one by one


def answer(found: WhirlMap) -> str:
    """Where a whirl grows, in one sentence.

    Parameters
    ----------
    found : the map
    """
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
    return (
        f"A whirl grows by itself at {values['A whirl grows at']}, fastest by {values['Fastest growth']}; "
        f"{own} it grows {bands}."
    )


def band_words(bands: Sequence[tuple[float, float]]) -> str:
    """Ranges of speed in which a whirl grows."""
    parts = [f"{number(low * RPM)} to {number(high * RPM)}" for low, high in bands]
    if len(parts) > MOST_BANDS:
        return f"{len(parts)} bands between {number(bands[0][0] * RPM)} and {number(bands[-1][1] * RPM)}"
    return "; ".join(parts) or "none"


def facts(found: WhirlMap) -> list[tuple[str, str]]:
    """What the map says in numbers: label and value.

    Parameters
    ----------
    found : the map
    """
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
    ]


def alt(found: WhirlMap) -> str:
    """What the figure shows and the numbers a reader would take from it."""
    values = dict(facts(found))
    return (
        "Map of the growth rate over speed and liquid, and of the whirl's speed where one grows; one grows "
        f"at {values['A whirl grows at']}, fastest: {values['Fastest growth']}."
    )
