"""The exact wave that a whirl from rest leads to, and where it ends: at a fold, or where it chokes.

Whirls are over h_0, detunings p/p_1 of the free wave; lengths otherwise over R.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from solvers.potential.steady import SteadyWave, at_rest, follow, solve
from solvers.potential.strip import nodes
from validation.exact import SMOOTH, detuning

_FIRST, _MOST, _MOST_AT_FOLDS = 64, 128, 216  # steps from crest to trough to begin with, and at most
# Lee waves, over the height, beyond which a wave is not one wave any more.
RIPPLED = 0.1
# Shortest step of a way, of the way.
_SHORTEST = 1.0 / 24.0
# Height of the first step on the way to a fold over h_0; how steps grow; those of a whirl to another end.
_RISE, _GROWTH, _FURTHER = 0.03, 1.3, 1.15
# Whirl beyond which no end is looked for, and the first one on the way, over h_0.
WIDEST, _NARROWEST = 0.5, 1e-4


@dataclass(frozen=True)
class Held:
    """The exact wave at one whirl."""

    whirl: float  #: w_0/h_0
    force_ratio: float  #: G
    crest: float  #: depth over h_0
    trough: float
    #: what rises between crest and trough, where it should fall, over the height; 0 without lee waves
    ripple: float


@dataclass(frozen=True)
class End:
    """The largest whirl of a branch that was reached."""

    whirl: float  #: w_0/h_0
    fold: bool  #: there it turns back; elsewhere no smooth wave was found any more


def held_waves(layer: float, ratio: float, whirls: Sequence[float], end: float = math.inf) -> list[Held]:
    """Exact waves of rising whirls w_0/h_0 from nothing, as far as they are smooth, at p/p_1 other than 1.

    `end` is w_0/h_0 of the fold, if it is known.
    """
    wave, found = _rest(layer, ratio), []
    for whirl in whirls:
        if whirl >= end:
            break
        wave = _grown(wave, layer, ratio, whirl)
        held = _smooth(wave, whirl, ratio)
        if held is None:
            break
        found.append(held)
    return found


def end(layer: float, ratio: float) -> End:
    """End of whirls that grow from nothing, at p/p_1 other than 1; `WIDEST` where no fold is.

    Against the deflection, p > p_1, they are followed in their height, with it in the whirl.
    """
    return _end_against(layer, ratio) if ratio > 1.0 else _end_with(layer, ratio)


def _end_with(layer: float, ratio: float) -> End:
    """Of waves that move with the deflection: no fold, but what chokes or lee waves."""
    wave, reached, whirl = _rest(layer, ratio), 0.0, _NARROWEST
    while reached < WIDEST:
        wave = _grown(wave, layer, ratio, whirl)
        if _smooth(wave, whirl, ratio) is None:
            return End(reached, False)
        reached, whirl = whirl, min(whirl * _FURTHER, WIDEST)
    return End(WIDEST, False)


def _end_against(layer: float, ratio: float) -> End:
    """Of waves that move against the deflection."""
    square = detuning(layer, ratio)
    height, rise = 0.0, _RISE * min(1.0, ratio - 1.0)
    seen: list[tuple[float, float, SteadyWave]] = [(0.0, 0.0, _rest(layer, ratio))]
    while seen[-1][1] < WIDEST:
        wanted = {"detuning": square, "height": height + rise}
        wave = follow(seen[-1][2], wanted, steps=1, most=_MOST_AT_FOLDS, least=_SHORTEST)
        if not wave.converged or wave.tail > SMOOTH or not wave.single:
            return End(seen[-1][1], False)
        height += rise
        seen.append((height, abs(wave.whirl) / layer, wave))
        if seen[-1][1] < seen[-2][1]:
            return End(_largest(layer, square, seen[-3:]), True)
        rise *= _GROWTH
    return End(WIDEST, False)


def _largest(layer: float, square: float, seen: list[tuple[float, float, SteadyWave]]) -> float:
    """The largest whirl between three heights, by parabolas through the best three points."""
    points = [(height, whirl) for height, whirl, _ in seen]
    for _ in range(4):
        points = sorted(sorted(points, key=lambda point: -point[1])[:3])
        middle = points[1][0]
        curve = np.polyfit([height - middle for height, _ in points], [whirl for _, whirl in points], 2)
        if curve[0] >= 0.0:
            break
        wanted = {"detuning": square, "height": float(middle - curve[1] / (2.0 * curve[0]))}
        wave = follow(seen[0][2], wanted, steps=2, most=_MOST_AT_FOLDS)
        if not wave.converged:
            break
        points.append((wanted["height"], abs(wave.whirl) / layer))
    return max(whirl for _, whirl in points)


def _rest(layer: float, ratio: float) -> SteadyWave:
    """The layer at rest, at the detuning."""
    return solve(at_rest(layer, nodes(_FIRST)), {"detuning": detuning(layer, ratio), "whirl": 0.0})


def _grown(wave: SteadyWave, layer: float, ratio: float, whirl: float) -> SteadyWave:
    """The wave of a larger whirl; its crest is at u = 0, along the deflection or opposite to it."""
    signed = whirl * layer if ratio < 1.0 else -whirl * layer
    wanted = {"detuning": detuning(layer, ratio), "whirl": signed}
    return follow(wave, wanted, steps=2, most=_MOST, least=_SHORTEST)


def _smooth(wave: SteadyWave, whirl: float, ratio: float) -> Held | None:
    """What is kept of it; None unless it is the wave that was followed, resolved by its nodes.

    Beyond a fold Newton's method may land on short waves, which are no continuation of what came before.
    """
    if not wave.converged or wave.tail > SMOOTH:
        return None
    depth = wave.depth / wave.layer
    height = float(depth.max() - depth.min())
    ripple = float(np.maximum(np.diff(depth), 0.0).sum()) / height
    if ripple > (RIPPLED if ratio < 1.0 else SMOOTH):
        return None
    return Held(whirl, wave.force_ratio, float(depth.max()), float(depth.min()), ripple)
