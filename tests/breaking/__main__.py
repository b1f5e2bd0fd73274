"""`python -m tests.breaking`: endings, highest waves, a crest, long waves beside the exact one."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator

import numpy as np

from meshes.arrays import Array
from solvers.layer.state import Numerics
from solvers.potential import histories
from solvers.potential.in_time import Steps, course
from solvers.potential.steady import follow, free
from solvers.potential.unsteady import still
from solvers.pypde import settle
from validation.breaking import Beside, Ending, Highest, Kept, crests, keep
from validation.breaking.crests import resonant
from validation.study import launch

DEPTHS = (0.1, 0.3, 0.5, 0.7)
WHIRLS = (0.1, 0.05, 0.02, 0.01, 0.005, 0.002)
CREST_DEPTHS = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7)
BESIDE = ((0.1, 0.1), (0.1, 0.05), (0.1, 0.02), (0.3, 0.05))
LONGEST = 25.0  # whirl periods
STEPS = Steps(nodes=crests.FIRST, most=2048, damping=crests.DAMPING)
# Moments in a whirl period at which a wave is looked at.
LOOKS = 20
CELLS = 512
# A front: half of the height within so many of 512 cells.
FRONT, WITHIN = 0.5, 8
# The crest of the last free wave, over |s| R, and the shortest step towards the highest, over h_0.
LAST, SHORTEST = 0.07, 1e-5


def ending(depth: float, whirl: float, longest: float = LONGEST, steps: Steps = STEPS) -> Ending:
    """Exact wave until it breaks, followed over at most `longest` whirl periods."""
    fill, motion = resonant(depth, whirl)
    times = motion.period * np.arange(1, round(longest * LOOKS) + 1) / LOOKS
    moments = course(still(depth, steps.nodes), times, histories.whirl_push(fill, motion), steps)
    *_, last = moments
    seen = last.extremes
    return Ending(
        depth=depth,
        whirl=whirl,
        periods=last.time / motion.period,
        state=last.state.value,
        reason=last.reason,
        crest=seen.crest / depth,
        crest_number=seen.crest_number,
        slope=math.degrees(seen.slope),
        nodes=last.surface.height.size,
    )


def highest(depth: float) -> Highest:
    """Highest natural wave: its crest as the square of the liquid's speed there goes to nothing."""
    wave = free(depth, 1.0 + 0.1 / (1.0 + 5.0 * depth))
    found, step = [(wave.crest_speed**2, wave.crest)], 0.05 * (wave.crest - 1.0)
    while wave.crest_speed > LAST and step > SHORTEST:
        ahead = follow(wave, {"whirl": 0.0, "crest": wave.crest + step}, 1)
        if not ahead.converged:
            step *= 0.5
            continue
        wave = ahead
        found.append((wave.crest_speed**2, wave.crest))
        fall, rise = found[-2][0] - found[-1][0], found[-1][1] - found[-2][1]
        # Each step takes a third off the square.
        step = 0.33 * found[-1][0] * rise / fall
    square, crest = np.array(found[-4:]).T
    limit = float(np.polyval(np.polyfit(square, crest, 2), 0.0))
    return Highest(depth, limit, wave.crest, wave.crest_speed, wave.slip_speeds()[1])


def beside(depth: float, whirl: float, dispersion: bool, end: float) -> Beside:
    """Long waves beside the exact one, which breaks after `end` whirl periods."""
    fill, motion = resonant(depth, whirl)
    numerics = Numerics(CELLS, dispersion=dispersion)
    whole = max(math.floor(end), 1) * motion.period
    exact = histories.simulate(fill, motion, whole, STEPS).periods.force_ratio
    long = settle.simulate(fill, motion, whole, numerics=numerics).force_ratio
    frames = math.floor(end * LOOKS)
    periods = frames / LOOKS
    pictures = settle.film(fill, motion, frames, periods, numerics=numerics)
    drawn = histories.film(fill, motion, frames, periods, STEPS)
    count = min(pictures.time.size, drawn.time.size)
    time = pictures.time[:count] / motion.period
    standing = [k for k, picture in enumerate(pictures.depth) if _steepness(picture) > FRONT]
    return Beside(
        depth=depth,
        whirl=whirl,
        dispersion=dispersion,
        force=tuple(np.abs(long / exact - 1.0).tolist()),
        time=tuple(time.tolist()),
        exact=tuple((drawn.depth[:count].max(axis=1) / depth).tolist()),
        crest=tuple((pictures.depth[:count].max(axis=1) / depth).tolist()),
        front=float(pictures.time[standing[0]] / motion.period) if standing else None,
    )


def _steepness(depth: Array) -> float:
    """Largest change of the depth within a few cells, over the wave's height."""
    height = float(depth.max() - depth.min())
    if height < 0.02 * float(depth.mean()):
        return 0.0
    return float(np.abs(np.roll(depth, -WITHIN) - depth).max()) / height


def main() -> Iterator[object]:
    """Compute, keep, print."""
    endings, high, pairs = [], [], []
    for depth, whirl in itertools.product(DEPTHS, WHIRLS):
        endings.append(ending(depth, whirl))
        yield endings[-1]
    for depth in CREST_DEPTHS:
        high.append(highest(depth))
        yield high[-1]
    until = {(each.depth, each.whirl): each.periods for each in endings}
    for (depth, whirl), dispersion in itertools.product(BESIDE, (False, True)):
        pairs.append(beside(depth, whirl, dispersion, until[depth, whirl]))
        yield f"{depth} {whirl} {dispersion} {pairs[-1].force} {pairs[-1].front}"
    keep(Kept(tuple(endings), tuple(high), tuple(pairs)))
    crests.keep(crests.computed())


if __name__ == "__main__":
    launch(main)
