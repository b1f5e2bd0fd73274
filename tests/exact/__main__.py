"""`python -m tests.exact`: the exact wave beside the models over depth, detuning and whirl; kept."""

from __future__ import annotations

import time
from collections.abc import Iterator

import numpy as np

from fluid.friction.laws import NO_FRICTION
from meshes.arrays import Array
from solvers.layer.state import Numerics
from solvers.liquid_model import Whirl
from solvers.pypde.settle import settle
from tests.exact.answers import beside, layer_fill
from tests.exact.branch import WIDEST, End, Held, end, held_waves
from tests.exact.choice import choices, words
from validation.exact import Cases, Ends, Marched, Measured, detuning, keep, kept
from validation.exact.long_wave import choking, steady_long_wave
from validation.study import launch

LAYERS = (0.02, 0.03, 0.04, 0.055, 0.075, 0.1, 0.135, 0.18, 0.24, 0.3, 0.4, 0.5, 0.6, 0.7)
_AWAY = (0.015, 0.025, 0.04, 0.06, 0.08, 0.1, 0.13, 0.17, 0.22, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8)
RATIOS = (
    *sorted(1.0 - away for away in _AWAY),
    *(1.0 + away for away in _AWAY), 1.95, 2.15, 2.5,
)  # fmt: skip
WHIRLS = (0.001, 0.003, 0.01, 0.03, 0.1, 0.3)
# Draws of chance: how many, from which seed, between which values, and how near the resonance none is.
DRAWS, SEED = 650, 20240
BETWEEN = {"layer": (0.02, 0.7), "ratio": (0.2, 2.5), "whirl": (0.001, 0.3)}
NEAREST = 0.01
# Cases gone through in time: depth, whirl speed, whirl; cells.
IN_TIME = (
    (0.1, 0.7, 0.1), (0.1, 1.75, 0.1), (0.1, 0.85, 0.1), (0.1, 1.3, 0.02), (0.3, 0.85, 0.2), (0.3, 1.3, 0.1),
    (0.05, 0.7, 0.2),
)  # fmt: skip
CELLS = (64, 128, 256)
TOLERANCES = (0.05, 0.01, 0.001, 1e-4)  # of what auto is asked


def measure() -> Measured:
    """All of it, some minutes on one core."""
    begin = time.process_time()
    ends = {(layer, ratio): end(layer, ratio) for layer in LAYERS for ratio in RATIOS}
    parts = _maps(ends), _drawn(), _ends(ends), _marched()
    return Measured(*parts, seconds=round(time.process_time() - begin, 0))


def _maps(ends: dict[tuple[float, float], End]) -> Cases:
    points: list[tuple[float, float, float]] = []
    held: list[Held | None] = []
    for (layer, ratio), last in ends.items():
        found = held_waves(layer, ratio, WHIRLS, last.whirl)
        points += [(layer, ratio, whirl) for whirl in WHIRLS]
        held += [*found, *[None] * (len(WHIRLS) - len(found))]
    return beside(points, held)


def _drawn() -> Cases:
    """Cases by chance, evenly in the logarithms; those without a smooth wave are kept as such."""
    rng = np.random.default_rng(SEED)
    bounds = np.log(np.array(list(BETWEEN.values())))
    drawn = np.exp(rng.uniform(bounds[:, 0], bounds[:, 1], (DRAWS, 3)))
    drawn = drawn[np.abs(drawn[:, 1] - 1.0) > NEAREST]
    points = [(float(layer), float(ratio), float(whirl)) for layer, ratio, whirl in drawn]
    held: list[Held | None] = []
    for layer, ratio, whirl in points:
        # Against the deflection a whirl beyond the fold is found out by the way there.
        last = end(layer, ratio).whirl if ratio > 1.0 else np.inf
        found = held_waves(layer, ratio, (0.3 * whirl, whirl), last)
        held.append(found[1] if len(found) == 2 else None)
    return beside(points, held)


def _ends(ends: dict[tuple[float, float], End]) -> Ends:
    layers, ratios = np.array(list(ends)).T
    return Ends(
        layer=layers,
        ratio=ratios,
        whirl=np.array([last.whirl for last in ends.values()]),
        fold=np.array([last.fold for last in ends.values()]),
        choked=np.array([choking(layer, detuning(layer, ratio), WIDEST) for layer, ratio in ends]),
    )


def _marched() -> Marched:
    cases = [
        (*case, dispersion, cells) for case in IN_TIME for dispersion in (False, True) for cells in CELLS
    ]
    histories = [
        settle(
            layer_fill(layer),
            Whirl(1.0, speed, whirl * layer),
            NO_FRICTION,
            Numerics(cells=cells, dispersion=dispersion),
        )
        for layer, speed, whirl, dispersion, cells in cases
    ]
    steady = [
        steady_long_wave(layer, (1.0 - 1.0 / speed) ** 2, whirl * layer, dispersion).force_ratio
        for layer, speed, whirl, dispersion, _ in cases
    ]
    table: Array = np.array(cases, dtype=float).T
    return Marched(
        layer=table[0],
        speed=table[1],
        whirl=table[2],
        dispersion=table[3].astype(bool),
        cells=table[4],
        force=np.array([history.force_ratio[-1].real for history in histories]),
        steady=np.array(steady),
        converged=np.array([history.converged for history in histories]),
    )


def main(auto: bool = False) -> Iterator[str]:
    """Measure, keep, print; auto: only what --model auto takes and how good it is at the kept draws."""
    measured = kept() if auto else measure()
    if not auto:
        keep(measured)
        for name in measured.maps.models:
            error = measured.maps.error(name)
            half, nine, most = np.nanquantile(error, (0.5, 0.9, 1.0))
            yield f"{name:14} error: median {half:.1e}, nine in ten below {nine:.1e}, most {most:.1e}"
        yield f"{measured.seconds:.0f} s, {np.count_nonzero(measured.maps.smooth)} smooth waves on the maps"
    yield "| tolerance | linear | kdv | potential | long_wave | covered | largest error | no smooth wave |"
    yield "|---|---|---|---|---|---|---|---|"
    for tolerance in TOLERANCES:
        yield words(measured.drawn, tolerance, choices(measured.drawn, tolerance))


if __name__ == "__main__":
    launch(main)
