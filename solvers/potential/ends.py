"""Where the waves that a growing whirl holds come to an end, and why.

Lengths over R, times in 1/Omega, as in `steady`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from meshes.arrays import Array
from solvers.potential.steady import MOST, RESOLVED, SteadyWave, follow, linear_detuning

# Growth of the wave's height from step to step round a fold, and how many steps there may be.
_RISE, _STEPS = 1.04, 60
# Fall of the whirl, of its largest, that is a fold and no rounding.
_FALL = 1e-3
# Square of the local Froude number that dispersion leaves of a flow that chokes.
_CHOKED = 0.84
_MOST_CRESTS = 64


class EndKind(StrEnum):
    """Why there is no smooth steady wave beyond some whirl."""

    FOLD = "fold"
    CHOKING = "choking"
    RESONANCE = "resonance"
    NODES = "nodes"


@dataclass(frozen=True)
class End:
    """End of a branch of waves."""

    kind: EndKind  #: what it comes of
    whirl: float  #: largest |w_0|/R of a wave that was found on it
    froude: float  #: square of the largest local Froude number of that wave
    crests: int  #: of the free wave that the whirl's speed is nearest to, but for that of one crest


def froude(wave: SteadyWave) -> Array:
    """Square of the local Froude number of the flow seen from the wave [theory: potential, eq. 33].

    At the nodes: 1 where long waves stand still on the flow.
    """
    y, speed = wave.surface, wave.speeds
    radius = np.exp(-y)
    return np.asarray(wave.detuning * speed * (speed / y + 2.0 * radius - speed) / np.square(radius))


def end(wave: SteadyWave, most: int = MOST) -> End:
    """Why a branch did not go on."""
    ratios = [abs(wave.detuning / linear_detuning(wave.layer, n) - 1.0) for n in range(2, _MOST_CRESTS)]
    crests, local = 2 + int(np.argmin(ratios)), float(froude(wave).max())
    reached = abs(wave.whirl)
    if wave.detuning > linear_detuning(wave.layer):
        largest = _fold(wave, most)
        if not math.isnan(largest):
            return End(EndKind.FOLD, largest, local, crests)
    if wave.tail > RESOLVED:
        return End(EndKind.NODES, reached, local, crests)
    kind = EndKind.CHOKING if local > _CHOKED else EndKind.RESONANCE
    return End(kind, reached, local, crests)


def _fold(wave: SteadyWave, most: int) -> float:
    """Largest whirl of a branch, which goes on with the height of its waves; nan where it has none."""
    heights, whirls = [wave.crest - wave.trough], [abs(wave.whirl)]
    if not heights[0] > 0.0:
        return math.nan
    for _ in range(_STEPS):
        height = _RISE * heights[-1]
        wave = follow(wave, {"detuning": wave.detuning, "height": height}, 1, most, 0.1)
        if not wave.converged or not wave.single:
            return math.nan
        heights.append(height)
        whirls.append(abs(wave.whirl))
        top = int(np.argmax(whirls))
        if top < len(whirls) - 1 and whirls[-1] < (1.0 - _FALL) * whirls[top]:
            break
    else:
        return math.nan
    if top == 0:
        return whirls[0]
    # The top of a parabola through three heights.
    near = slice(top - 1, top + 2)
    bend, slope, level = np.polyfit(heights[near], whirls[near], 2)
    return float(level - slope**2 / (4.0 * bend))
