"""What the coupled machine costs: run-ups over cells, stability maps, the tub's response.

`python -m validation.benchmarks.machine` prints the tables of one run on one core.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import NO_FRICTION, Friction, FrictionLaw
from fluid.liquid import Liquid
from meshes.arrays import Array
from meshes.chamber import Chamber
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.vibration import unbalance_response
from solvers.runup.machine import Ramp
from solvers.runup.runup import RunupHistory, RunupNumerics, run_up
from solvers.whirl.growth import growth_map
from validation.benchmarks.timing import Answer, Contestant, Go, Sample, measure, one_core
from validation.cases.rotors.tub import suspended_tub
from validation.page import Table
from validation.study import launch

_OURS = "leblanc"
_ROTOR = Jeffcott(30.0, 30.0 * 25.0**2, 2.0 * 0.06 * 30.0 * 25.0, 0.1)
_WATER, _CHAMBER = Liquid("water", 998.2, 1.004e-6), Chamber(0.25, 0.04)
_FILL = Fill(_CHAMBER, _WATER, 5e-4)
# Through the resonance to 100 rad/s in twelve seconds, then held for eight.
_RAMP = Ramp(5.0, 100.0, 8.0, 20.0)
_SAMPLES, _FINE = 401, 1024
_MAP = 400


def runups(cells: tuple[int, ...] = (32, 64, 128, 256), repeats: int = 3) -> list[Sample]:
    """Run-ups of 20 s with one layer; error: of the amplitude over its largest, reference 1024 cells."""
    exact = _history(_FINE).amplitude

    def runner(n: int) -> Callable[[], Callable[[], Go]]:
        return lambda: lambda: lambda: _history(n).amplitude

    rows = [Contestant(_OURS, f"{n} cells", runner(n), size=n) for n in cells]
    return measure(rows, lambda found: _gap(found, exact), repeats)


def _history(cells: int) -> RunupHistory:
    numerics = RunupNumerics(cells=cells, samples=_SAMPLES, companion=False)
    return run_up(_ROTOR.system(), [_FILL], _RAMP, Friction(FrictionLaw.LINEAR, 3.0), 0.0, numerics)


def _gap(found: Answer, exact: Answer) -> float:
    return float(np.abs(found - exact).max() / np.abs(exact).max())


def maps(repeats: int = 3) -> list[Sample]:
    """Growth rates at 400 speeds by 400 volumes; error against numpy's eigenvalues, over the largest rate."""
    speed = np.linspace(5.0, 100.0, _MAP)
    fills = [replace(_FILL, volume=part * _CHAMBER.capacity) for part in np.linspace(0.001, 0.9, _MAP)]

    def ours(friction: Friction) -> Callable[[], Callable[[], Go]]:
        return lambda: lambda: lambda: growth_map(_ROTOR, [[fill] for fill in fills], speed, friction)[0]

    def eigenvalues() -> Callable[[], Go]:
        return lambda: lambda: _by_eigenvalues(fills, speed, 3.0)

    exact = _by_eigenvalues(fills, speed, 3.0)
    rows = [
        Contestant(_OURS, "linear friction", ours(Friction(FrictionLaw.LINEAR, 3.0)), size=_MAP),
        Contestant("numpy", "eigenvalues of 160 000 matrices", eigenvalues, size=_MAP),
    ]
    found = measure(rows, lambda answer: _gap(answer, exact), repeats)
    others = [
        Contestant(_OURS, "no friction", ours(NO_FRICTION), size=_MAP),
        Contestant(_OURS, "laminar friction", ours(Friction(FrictionLaw.STOKES)), size=_MAP),
    ]
    # These have no equals among the linear eigenvalue problems.
    return [*found, *measure(others, lambda answer: 0.0 if np.isfinite(answer).all() else math.nan, repeats)]


def _by_eigenvalues(fills: list[Fill], speed: Array, rate: float) -> Array:
    """Largest growth from the equations of deflection and offset, first order, all points at once."""
    radius = np.array([fill.surface_radius for fill in fills])[:, None]
    depth = np.array([fill.depth for fill in fills])[:, None]
    kappa, mass = np.square(_CHAMBER.radius / radius), np.array([fill.mass for fill in fills])[:, None]
    k = rate * 2.0 * depth * _CHAMBER.radius / (_CHAMBER.radius**2 - radius**2)
    shape = (len(fills), speed.size, 2, 2)
    inertia, damping, stiffness = (np.zeros(shape, dtype=complex) for _ in range(3))
    inertia[..., 0, 0], inertia[..., 0, 1] = _ROTOR.mass + mass, mass
    inertia[..., 1, 0], inertia[..., 1, 1] = 1.0, 1.0 + kappa
    damping[..., 0, 0], stiffness[..., 0, 0] = _ROTOR.damping, _ROTOR.stiffness
    damping[..., 1, 1] = -4j * kappa * speed + k * (1.0 + kappa)
    stiffness[..., 1, 1] = -2.0 * kappa * speed**2 - 1j * speed * k * (1.0 + kappa)
    whole = np.zeros((*shape[:2], 4, 4), dtype=complex)
    whole[..., 0, 2] = whole[..., 1, 3] = 1.0
    whole[..., 2:, :2] = -np.linalg.solve(inertia, stiffness)
    whole[..., 2:, 2:] = -np.linalg.solve(inertia, damping)
    return np.asarray(np.linalg.eigvals(whole).real.max(axis=-1))


def tub(repeats: int = 5) -> list[Sample]:
    """Unbalance response of the tub at 1000 speeds; error against solutions speed by speed."""
    system = suspended_tub().system()
    speed = np.linspace(1.0, 150.0, 1000)

    def one_by_one() -> Answer:
        rows = []
        for w in speed.tolist():
            turning = system.damping + w * system.gyroscopic
            matrix = system.stiffness - w**2 * system.mass + 1j * w * turning
            rows.append(np.linalg.solve(matrix, w**2 * system.unbalance))
        return np.array(rows)

    exact = one_by_one()
    rows = [
        Contestant(_OURS, "all speeds at once", lambda: lambda: lambda: unbalance_response(system, speed), 6),
        Contestant("numpy", "one speed after another", lambda: lambda: one_by_one, 6),
    ]
    return measure(rows, lambda found: _gap(found, exact), repeats)


def table(samples: list[Sample]) -> Table:
    """One row a sample."""
    rows = [
        (one.code, one.setting, f"{one.seconds:.3g}", f"{one.error:.1e}", f"{one.first:.2g}")
        for one in samples
    ]
    return Table(("code", "setting", "seconds", "error", "first call, s"), tuple(rows))


def main() -> Iterator[str]:
    """Tables of one run on one core."""
    from threadpoolctl import threadpool_limits

    one_core()
    with threadpool_limits(1):
        for name, study in (("Run-up of 20 s", runups), ("Map of 400 x 400", maps), ("Tub", tub)):
            yield f"\n### {name}\n\n{table(study())}"


if __name__ == "__main__":
    launch(main)
