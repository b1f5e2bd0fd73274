"""The fully nonlinear wave as the measure of the other models of a layer: their errors, kept as JSON.

`python -m tests.exact` measures again; `kept` reads what it left. Depths are over R, whirls over h_0,
detunings are ratios p/p_1 to that of small natural sloshing waves.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from meshes.arrays import Array, Flags
from solvers.potential.steady import linear_detuning
from validation.study import stored

KEPT = Path(__file__).parent / "results.json"
SMOOTH = 1e-6  # tail of a spectrum that counts as ended
# Models by their names here; one family answers the whirl behind the drum and its twin ahead, which the
# others do not tell apart.
MODELS = ("linear", "long_wave", "dispersion", "kdv", "kdv_twin", "whitham", "whitham_twin")


def detuning(layer: float, ratio: float) -> float:
    """p^2 at a ratio p/p_1."""
    return ratio * ratio * linear_detuning(layer)


def whirl_speeds(layer: float, ratio: float) -> tuple[float, float]:
    """Whirl speeds at a ratio p/p_1, over the spin: behind the drum, and ahead or against it."""
    p = math.sqrt(detuning(layer, ratio))
    return 1.0 / (1.0 + p), 1.0 / (1.0 - p)


@dataclass(frozen=True)
class Cases:
    """Answers of all models to some whirls; all shapes (n,)."""

    layer: Array  #: h_0/R, p/p_1, w_0/h_0
    ratio: Array
    whirl: Array
    exact: Array  #: G of the fully nonlinear wave; nan where no smooth one was found
    crest: Array  #: of that wave: depths over h_0, and lee waves over its height
    trough: Array
    ripple: Array
    models: Mapping[str, Array]  #: G by each model, nan where it has no smooth wave

    @property
    def smooth(self) -> Flags:
        """Whether there is a fully nonlinear wave to compare with."""
        return np.isfinite(self.exact)

    def error(self, model: str) -> Array:
        """Distance of a model's G from the exact one over the larger of |G| and 1, shape (n,)."""
        return np.asarray(np.abs(self.models[model] - self.exact) / np.maximum(1.0, np.abs(self.exact)))


@dataclass(frozen=True)
class Ends:
    """Where waves of whirls that grow from nothing end; all shapes (n,)."""

    layer: Array  #: h_0/R, p/p_1
    ratio: Array
    whirl: Array  #: largest w_0/h_0 of a smooth fully nonlinear wave
    fold: Flags  #: there the branch turns back
    choked: Array  #: largest w_0/h_0 of a smooth long wave without dispersion


@dataclass(frozen=True)
class Marched:
    """Long waves through time beside the steady ones; all shapes (n,)."""

    layer: Array  #: h_0/R, whirl speed over the spin, w_0/h_0
    speed: Array
    whirl: Array
    dispersion: Flags  #: with it
    cells: Array  #: round the wall
    force: Array  #: G through time, its real part
    steady: Array  #: G by the steady equations
    converged: Flags  #: it settled


@dataclass(frozen=True)
class Measured:
    """All that is kept."""

    maps: Cases  #: on a grid of depths, detunings and whirls
    drawn: Cases  #: by chance, none of which a constant was fitted to
    ends: Ends  #: of branches
    marched: Marched  #: long waves through time
    seconds: float  #: that the measurement took


# Nine digits: more than any model is right to.
kept, keep = stored(KEPT, Measured, digits=9, compact=True)
