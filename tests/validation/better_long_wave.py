"""What a better long wave would bring: errors of the force beside the exact wave, by model and by cells.

`python -m tests.validation.better_long_wave` computes the tables of docs/theory/nonlinear.md, in minutes, and
keeps them in better_long_wave.json.
"""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from meshes.arrays import Array
from solvers.layer.records import LOADS, Drive, Wall, records
from solvers.layer.state import means, ring
from solvers.layer.step import centre, march, scratch
from solvers.potential import steady as exact
from solvers.potential.strip import nodes
from tests.oracles.better_steady import Model, Wave, steady
from validation.study import launch, write

KEPT = Path(__file__).with_suffix(".json")
DEPTHS = (0.1, 0.2, 0.3, 0.5)
# Detunings p over that of the small free wave.
DETUNINGS = (0.7, 0.8, 0.9, 0.95, 1.05, 1.1, 1.2, 1.3, 1.4)
# Whirls over the largest that the wave out of phase bears; below the free wave those of the detuning as far
# above it.
SHARES = (0.1, 0.5)
# Whirls for the cells: h_0/R, detuning p over that of the free wave, share of the fold.
MARCHED = (
    (0.1, 0.95, 0.1),
    (0.1, 1.4, 0.5),
    (0.2, 1.2, 0.5),
    (0.3, 0.9, 0.1),
    (0.3, 1.1, 0.1),
    (0.3, 1.2, 0.5),
)
CELLS = (64, 128, 256, 512)
PERIODS = 20
_GROWTH, _LOW = 1.08, 1e-4
_COURANT = 0.8


@dataclass(frozen=True)
class Case:
    """A whirl, the exact force and the relative errors of the models."""

    layer: float  #: h_0/R
    detuning: float  #: p over that of the small free wave
    share: float  #: whirl over that of the fold
    whirl: float  #: w_0/h_0
    exact: float  #: G
    single: bool  #: whether the exact wave has no shorter ones in its lee
    errors: dict[str, float | None]  #: of G by model, None where it has no smooth steady wave


@dataclass(frozen=True)
class Marched:
    """What the cells add: the steady wave of a model's own equations, put into the finite volumes."""

    layer: float  #: as of `Case`
    detuning: float
    share: float
    model: str  #: HYDROSTATIC or DISPERSION
    equations: float  #: relative error of G of the model's own steady wave
    cells: tuple[int, ...]  #: of the ring
    errors: tuple[float, ...]  #: of the mean of G over some whirl periods beside that steady wave, by cells


def fold(layer: float, detuning: float) -> float:
    """Largest w_0/h_0 that the exact wave out of phase bears; detuning p/p_1 above 1."""
    square = detuning**2 * exact.linear_detuning(layer)
    rest = exact.solve(exact.at_rest(layer, nodes(64)), {"detuning": square, "whirl": 0.0})
    wave = exact.follow(rest, {"detuning": square, "whirl": -_LOW * layer})
    height, most = wave.crest - wave.trough, -wave.whirl
    while True:
        height *= _GROWTH
        wave = exact.follow(wave, {"detuning": square, "height": height}, 1)
        if not wave.converged or -wave.whirl < most:
            return most / layer
        most = -wave.whirl


def case(layer: float, detuning: float, share: float, largest: float, models: tuple[Model, ...]) -> Case:
    """Errors of the models at one whirl; `largest` is w_0/h_0 of the fold."""
    square, whirl = detuning**2 * exact.linear_detuning(layer), share * largest * layer
    truth = exact.forced(layer, square, whirl)
    errors: dict[str, float | None] = {}
    for model in models:
        wave = steady(model, layer, square, whirl)
        errors[model] = None if wave is None else wave.force_ratio / truth.force_ratio - 1.0
    known = truth.force_ratio if truth.converged else math.nan
    return Case(layer, detuning, share, whirl / layer, known, truth.single, errors)


def marched(wave: Wave, detuning: float, dispersion: bool, cells: int, periods: int = PERIODS) -> Array:
    """Force ratio G along the deflection over whirl periods of finite volumes, shape (periods,).

    They begin with a steady wave of the model's own equations, without friction; the whirl is the slower of
    the two twins, periods are seen from the drum.
    """
    # Times over 1/Omega.
    whirl = 1.0 / (1.0 + detuning)
    slip = whirl - 1.0
    middle = 2.0 * math.pi * (np.arange(cells) + 0.5) / cells
    area, velocity = wave.coefficients()
    k = np.arange(area.size)
    mean = np.sinc(k / cells)
    waves = np.cos(np.outer(middle, k)) * mean
    held = np.ascontiguousarray(waves @ area)
    q = slip * (waves @ velocity) * held - held**2
    drive = Drive(wave.whirl, slip, 0.0, whirl, 0.0, 1.0)
    angles, spare, period = ring(cells), scratch(cells), 2.0 * math.pi / abs(slip)
    mass, found, before = 2.0 * math.pi * held.mean(), np.empty(periods), complex(*centre(held, angles))
    for i in range(periods):
        loads = records(LOADS)
        march(
            held,
            q,
            i * period,
            (i + 1) * period,
            drive,
            Wall(0, 0.0, 0.0, dispersion),
            angles,
            _COURANT,
            spare,
            loads,
        )
        after = complex(*centre(held, angles))
        # A wave that stands leaves the period as fast as it came.
        found[i] = means(loads[0], period, mass, whirl, (before, after), (0j, 0j))[0].real
        before = after
    return found / (math.pi * whirl**2 * wave.whirl)


def by_cells(layer: float, detuning: float, share: float, largest: float, model: Model) -> Marched | None:
    """What the cells add to one wave of HYDROSTATIC or DISPERSION; None where the model has no steady one."""
    square, whirl = detuning**2 * exact.linear_detuning(layer), share * largest * layer
    wave = steady(model, layer, square, whirl)
    if wave is None:
        return None
    own = wave.force_ratio
    runs = [marched(wave, math.sqrt(square), model is Model.DISPERSION, cells).mean() for cells in CELLS]
    equations = own / exact.forced(layer, square, whirl).force_ratio - 1.0
    errors = tuple(float(run / own - 1.0) for run in runs)
    return Marched(layer, detuning, share, model, equations, CELLS, errors)


def compute() -> dict[str, list[dict[str, object]]]:
    """Both tables, as they are kept."""
    folds = {(layer, f): fold(layer, f) for layer in DEPTHS for f in DETUNINGS if f > 1.0}
    # Detunings lie in pairs about 1.
    above = {f: max(f, round(2.0 - f, 2)) for f in DETUNINGS}
    cases = [
        case(layer, f, share, folds[layer, above[f]], tuple(Model))
        for layer in DEPTHS
        for f in DETUNINGS
        for share in SHARES
    ]
    runs = [
        by_cells(layer, f, share, folds[layer, above[f]], model)
        for layer, f, share in MARCHED
        for model in (Model.HYDROSTATIC, Model.DISPERSION)
    ]
    return {
        "equations": [asdict(found) for found in cases],
        "cells": [asdict(run) for run in runs if run is not None],
    }


def main() -> list[object]:
    """Compute, keep and print."""
    found = compute()
    write(KEPT, found)
    return [row for rows in found.values() for row in rows]


if __name__ == "__main__":
    launch(main)
