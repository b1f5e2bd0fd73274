"""How far a run-up with linear layers is from one with long waves, estimated from the linear run alone."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fluid.fill import Fill
from fluid.whirl import is_full
from solvers.runup.runup import RunupHistory

# Found from random run-ups with both models: see the theory page.
FLOOR = 0.006
_WAVE = 2.0
_LAG = 2.0
MOST_WAVE = 0.5
MOST_LAG = 0.08


@dataclass(frozen=True)
class LinearRunError:
    """What a linear run says of its own error.

    Parameters
    ----------
    estimate : of the amplitude's largest error over its largest value; infinite where there is none
    wave : largest rise of a surface over its layer's mean depth
    lag : largest lag of a layer's rotation behind its drum over the spin
    touches : a surface came to an inner wall
    """

    estimate: float
    wave: float
    lag: float
    touches: bool


def largest_wave(tolerance: float) -> float:
    """Rise of a surface over its depth at which a run without lag reaches a tolerance; 0 where none does."""
    return min(math.sqrt(max(tolerance - FLOOR, 0.0) / _WAVE), MOST_WAVE)


def linear_run_error(history: RunupHistory, fills: Sequence[Fill]) -> LinearRunError:
    """Error of a run with linear layers from how large its waves were [theory: model_error, eq. 22].

    Parameters
    ----------
    history : the run
    fills : of its chambers
    """
    wave, lag, touches = 0.0, 0.0, False
    for k, fill in enumerate(fills):
        held = history.captured[:, k]
        if fill.volume == 0.0 or is_full(fill) or not held.any():
            continue
        crest = float(history.depth_max[held, k].max())
        wave = max(wave, crest / fill.depth - 1.0)
        slow = np.abs(history.mean_rotation[held, k]) / np.abs(history.speed[held])
        lag = max(lag, float(slow.max()))
        inner = fill.chamber.inner_radius
        touches |= inner > 0.0 and crest >= fill.chamber.radius - inner
    lost = not history.converged or touches or wave > MOST_WAVE or lag > MOST_LAG
    estimate = np.inf if lost else FLOOR + _WAVE * wave**2 + _LAG * lag**2
    return LinearRunError(float(estimate), wave, lag, touches)
