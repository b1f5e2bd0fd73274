"""Seeded faults of a time step under the law of the wall, and their oracles, run as plain Python."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from fluid.friction.laws import WALL, Friction
from fluid.friction.wall import WallDrag, mean_rates, wall_drag, wall_shear
from solvers.layer.drag import wall_kept
from tests.mutants import kills

N = 24


def drag(nu: float = 1e-6) -> WallDrag:
    return wall_drag(Friction("wall"), nu, 0.015, 0.15, 0.05, 9.4, 40.0)  # type: ignore[arg-type]


def layer() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    theta = 2.0 * np.pi * np.arange(N) / N
    depth = 0.1 + 0.05 * np.cos(theta)
    return depth * (1.0 - 0.5 * depth), 6.0 * np.cos(theta - 0.4) - 5.0, depth


def step(known: WallDrag, area: np.ndarray, velocity: np.ndarray, dt: float) -> np.ndarray:
    kept, pushed = np.empty(N), np.empty(N)
    wall = known.lid, known.plates, known.thin, known.top, known.table
    wall_kept(area, velocity, np.sqrt(1.0 - 2.0 * area), WALL, known.coefficient, *wall, dt, kept, pushed)
    return velocity * kept + pushed


@kills("solvers.layer.drag:_slow_mean", "* over + lid", "* over")
@kills("solvers.layer.drag:_slow_mean", ", 1.0 - area[i]", ", 1.0")
@kills("solvers.layer.drag:_slow_mean", "1.0 + spare[i] * kept", "1.0 + kept")
@kills("solvers.layer.drag:_weigh", "plates * (1.0 - surface[i])", "plates * 0.0")
@kills("solvers.layer.drag:_weigh", "0.5 * thin * (1.0 + surface[i])", "0.0 * thin")
@kills("solvers.layer.drag:_weigh", "share * area[i] * kept", "share * kept")
@kills("solvers.layer.drag:_slow_mean", "ratio < 1.0 else 1.0)) * last", "ratio < 1.0 else 1.0))")
def test_a_step_follows_the_law() -> None:
    """Against the law itself, integrated in time to rounding."""
    area, velocity, depth = layer()
    for nu in (1e-6, 1e-3):
        known = drag(nu)

        def slowed(_: float, u: np.ndarray, known: WallDrag = known) -> np.ndarray:
            return -wall_shear(known, depth, area, u) / area

        time = 0.2
        wanted = solve_ivp(slowed, (0.0, time), velocity, rtol=1e-9, atol=1e-10).y[:, -1]
        left = []
        for steps in (8, 16):
            u = velocity
            for _ in range(steps):
                u = step(known, area, u, time / steps)
            left.append(float(np.abs(u - wanted).max()))
        moved = float(np.abs(wanted - velocity).max())
        assert left[0] < 0.01 * moved
        # Splitting the two parts one after the other is of first order where both act; it is small.
        assert left[1] < 0.6 * left[0]


@kills("solvers.layer.drag:wall_kept", "pushed[i] = gone * mean", "pushed[i] = 0.0")
@kills("solvers.layer.drag:_weigh", "mass += share * area[i]", "mass += share")
def test_the_waves_part_keeps_the_angular_momentum() -> None:
    known, (area, velocity, _) = drag(), layer()
    # Without the mean part, by a table of nothing.
    still = known._replace(table=np.zeros((3, 2)))
    for dt in (1e-4, 0.1, 1e3):
        after = step(still, area, velocity, dt)
        assert area @ after == pytest.approx(area @ velocity, rel=1e-13)
        assert np.abs(after - velocity).max() > 0.0
    # In the end all cells have the mean.
    assert np.ptp(step(still, area, velocity, 1e9)) < 1e-6


@kills("solvers.layer.drag:_slow_mean", "if ratio > 1.0 else 1.0", "if ratio > 1e9 else 1.0")
def test_no_step_is_too_long_and_no_velocity_too_fast() -> None:
    known, (area, velocity, depth) = drag(), layer()
    for dt in (1.0, 1e6):
        after = step(known, area, velocity, dt)
        assert np.abs(after).max() <= np.abs(velocity).max()
    fast = 10.0 * known.top * np.ones(N)
    rate = mean_rates(known, depth, area, fast)
    # 1/(1 + x) for a quadratic law, which it is beyond the table; the waves' part finds nothing to do.
    # No cells are alike in depth, so that part is switched off.
    after = step(known._replace(coefficient=0.0), area, fast, 1e-6)
    np.testing.assert_allclose(after, fast / (1.0 + 1e-6 * rate), rtol=1e-4)
    area[3], velocity[3] = 0.0, 0.0
    assert np.isfinite(step(known, area, velocity, 1e-3)).all()
    # What is no number takes the table's end instead of a place outside it.
    velocity[5] = np.nan
    assert np.isnan(step(known, area, velocity, 1e-3)[5])
