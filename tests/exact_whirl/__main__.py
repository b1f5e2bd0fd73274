"""`python -m tests.exact_whirl`: onsets, circles and ends of a whirl with an exact layer; kept."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any, Literal, get_args

from tests.exact_whirl import Kept, Onset, Way, keep, kept
from tests.exact_whirl.in_time import Grown, Setting, grown
from tests.exact_whirl.lagging import circles
from validation.study import launch

Part = Literal["onsets", "ways", "settled", "grown"]
# Losses of onsets and ways.
DAMPING, FRICTION = 0.02, 0.03
LAYERS = (0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9)
MASS_RATIOS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0)
# Whirls over h_0 of which the smaller is of second order to a part in a thousand at all of these.
NEAR = (5e-5,)
# Ways: depth and mass ratio, and their whirls.
WAYS = ((0.1, 0.1), (0.3, 0.1), (0.5, 0.05), (0.7, 0.1))
WHIRLS = (2e-4, *(5e-4 * n for n in range(1, 17)), *(2e-3 * n for n in range(5, 16)))
# In time: depth, mass ratio, speed, and the whirl of another speed's circle that it begins with; how long,
# on how many nodes.
SETTLING = ((0.5, 0.05, 1.4769, 0.003), (0.5, 0.05, 1.4769, 0.005))
LONG, FEW = 600.0, 64
# Until the wave ends: depth, speed, friction; mass ratio and push; nodes.
GROWING = (
    (0.1, 1.13, 0.03), (0.1, 1.2, 0.03), (0.1, 1.3, 0.03), (0.1, 1.45, 0.03),
    (0.1, 1.2, 0.3), (0.3, 1.3, 0.03),
)  # fmt: skip
HEAVY, SMALL, LONGEST, MOST = 0.1, 1e-4, 1500.0, 2048


def onset_of(layer: float, mass_ratio: float) -> Onset:
    """How a whirl begins."""
    found = circles(layer, mass_ratio, DAMPING, FRICTION, NEAR)
    if not found:
        return Onset(layer, mass_ratio, math.nan, math.nan)
    shift = (found[1].speed - found[0].speed) / NEAR[0] ** 2 if len(found) > 1 else math.nan
    return Onset(layer, mass_ratio, found[0].speed, shift)


def way_of(layer: float, mass_ratio: float) -> Way:
    """Circles of a machine, h_0/R and mu."""
    return Way(layer, mass_ratio, tuple(circles(layer, mass_ratio, DAMPING, FRICTION, WHIRLS)))


def settled_at(layer: float, mass_ratio: float, speed: float, whirl: float) -> Grown:
    """Machine begun on a circle W/h_0 smaller or larger than that of its speed Omega/omega_n."""
    begin = circles(layer, mass_ratio, DAMPING, FRICTION, (0.3 * whirl, whirl))[-1]
    return grown(Setting(layer, mass_ratio, speed, DAMPING, FRICTION), whirl, LONG, FEW, begin=begin)


def grown_at(layer: float, speed: float, friction: float) -> Grown:
    """Whirl until its wave ends, without its history; Omega/omega_n, k/omega_n."""
    found = grown(Setting(layer, HEAVY, speed, DAMPING, friction), SMALL, LONGEST, MOST)
    return replace(found, time=(), whirl=())


def main(only: Part | None = None) -> Iterator[object]:
    """Compute one part or all, keep, print."""
    results = Kept(DAMPING, FRICTION, (), (), (), ()) if only is None else kept()
    for part in get_args(Part) if only is None else (only,):
        found = []
        for row in computed(part):
            found.append(row)
            yield row
        changes: dict[str, Any] = {part: tuple(found)}
        results = replace(results, **changes)
    keep(results)


def computed(part: Part) -> Iterator[Onset | Way | Grown]:
    """Rows of a part, one after another."""
    if part == "onsets":
        yield from (onset_of(layer, ratio) for layer in LAYERS for ratio in MASS_RATIOS)
    elif part == "ways":
        yield from (way_of(*case) for case in WAYS)
    elif part == "settled":
        yield from (settled_at(*case) for case in SETTLING)
    else:
        yield from (grown_at(*case) for case in GROWING)


if __name__ == "__main__":
    launch(main)
