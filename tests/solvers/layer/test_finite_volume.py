"""Finite volumes: equilibria stay, nothing is lost, bores obey the jump conditions, second order."""

from __future__ import annotations

import math
from itertools import pairwise

import mpmath as mp
import numpy as np
import pytest
from numba import njit

from fluid import long_wave as lw
from solvers.layer.drag import kept_speed
from solvers.layer.finite_volume import DRY, FULL, GHOSTS, WORK, log_and_inverse, rates, solve_ring
from solvers.layer.inside import NOTHING
from solvers.layer.records import LOADS, Drive, Outcome, Wall, records
from solvers.layer.step import march, scratch

SPIN = 1.0


def angles(n: int) -> np.ndarray:
    edge = 2 * np.pi * np.arange(n) / n
    middle = edge + np.pi / n
    return np.stack([np.cos(middle), np.sin(middle), np.cos(edge), np.sin(edge)])


def circle(n: int, amplitude: float, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Equilibrium under a synchronous whirl: a circle about the rotation axis, as values at the middles."""
    cosine, sine = angles(n)[:2]
    surface = np.sqrt(np.maximum(radius**2 - (amplitude * sine) ** 2, 0.0)) - amplitude * cosine
    area = 0.5 * np.maximum(1.0 - np.clip(surface, 0.0, 1.0) ** 2, 0.0)
    return area, -SPIN * area**2


def run(
    area: np.ndarray, q: np.ndarray, length: float, drive=(0.0, 0.0, 0.0, 1.0, 0.0), rub=(0, 0.0, 0.0, False)
):  # type: ignore[no-untyped-def]
    n, sums, whole = area.size, records(LOADS), Drive(*drive, SPIN)
    outcome, steps = march(area, q, 0.0, length, whole, Wall(*rub), angles(n), 0.8, scratch(n), sums)
    assert outcome == Outcome.DONE
    return steps


def marched(
    area: np.ndarray, q: np.ndarray, energy: np.ndarray, length: float, amplitude: float = 0.0
) -> None:
    n, sums, drive = area.size, records(LOADS), Drive(amplitude, -0.3, 2.0, 0.7, 0.0, SPIN)
    outcome, _ = march(
        *(area, q, 0.0, length, drive, Wall(0, 0.0, 0.0, False), angles(n), 0.8, scratch(n), sums),
        energy=energy,
    )
    assert outcome == Outcome.DONE


def dammed(n: int) -> tuple[np.ndarray, np.ndarray]:
    """Deeper on half of the wall, at rest in the drum: bores run both ways."""
    area = np.where(np.arange(n) < n // 2, 0.12, 0.06)
    return area, -SPIN * area**2


def held(area: np.ndarray, q: np.ndarray) -> float:
    """Energy of the mean flow, of which the turning as a whole does not count."""
    velocity = (q + SPIN * area**2) / area
    return float((0.5 * velocity**2 * lw.layer_log(area) + 0.5 * SPIN**2 * area**2).mean())


def test_bores_feed_fluctuations_with_what_they_take() -> None:
    """Volume and angular momentum stay to rounding; energy goes from the flow to the fluctuations."""
    for n in (100, 200):
        area, q = dammed(n)
        energy, bare_area, bare_q = np.zeros(n), area.copy(), q.copy()
        volume, turning, before = area.sum(), q.sum(), held(area, q)
        marched(area, q, energy, 4.0)
        run(bare_area, bare_q, 4.0)
        assert abs(area.sum() / volume - 1.0) < 1e-13 and abs(q.sum() - turning) < 1e-12 * abs(turning)
        assert energy.min() >= 0.0 and np.all(energy <= 0.25 * SPIN**2 * area**2 * (1.0 + 1e-12))
        lost = before - held(area, q)
        # Some of what the bores took has decayed since, and none has come from elsewhere.
        assert 0.2 * lost < energy.mean() < lost
        assert np.abs(area - bare_area).max() > 1e-4


def test_a_small_whirl_has_no_fluctuations_to_speak_of() -> None:
    n = 64
    plain = np.full(n, 0.095)
    area, energy = plain.copy(), np.zeros(n)
    q, bare = -SPIN * area**2, -SPIN * plain**2
    marched(area, q, energy, 30.0, 1e-3)
    run(plain, bare, 30.0, (1e-3, -0.3, 2.0, 0.7, 0.0))
    moved = np.abs(plain - 0.095).max()
    # A wave that does not break loses to them what the scheme loses.
    assert np.abs(area - plain).max() < 3e-3 * moved and energy.max() < 1e-3 * moved**2


def test_fluctuations_that_are_left_out_change_nothing() -> None:
    """To the last digit: an empty array of them, and none at all."""
    ends = []
    for energy in (np.zeros(0), None):
        area, q = dammed(50)
        n, sums, drive = area.size, records(LOADS), Drive(0.02, -0.3, 2.0, 0.7, 0.0, SPIN)
        wall = Wall(1, 0.05, 0.0, False)
        march(area, q, 0.0, 3.0, drive, wall, angles(n), 0.8, scratch(n), sums, energy=energy)
        ends.append(np.concatenate([area, q]))
    assert np.array_equal(*ends)


def test_equilibria() -> None:
    """Circles are kept to rounding at any amplitude, dry patches included."""
    for amplitude, radius in ((0.05, 0.9), (0.2, 0.95), (0.5, 1.2), (0.9, 1.7)):
        for n in (64, 200):
            area, q = circle(n, amplitude, radius)
            start = area.copy()
            assert amplitude < 0.1 or (area == 0.0).any()
            steps = run(area, q, 50.0, (amplitude, 0.0, 0.0, 1.0, 0.0))
            assert steps > 300
            # Rounding of some 1e-16 a step, of which the waves keep the square root.
            np.testing.assert_allclose(area, start, atol=1e-13)


def test_many_steps_lose_no_mass() -> None:
    n = 16
    area, q = np.full(n, 0.095), np.full(n, -(0.095**2))
    before, taken = area.sum(), 0
    while taken < 300_000:
        # Strong asynchronous whirl with a dry patch and bores.
        steps = run(area, q, 20000.0, (0.1, -0.24, 100.0, 0.76, 0.0), (1, 0.02, 0.0, False))
        assert steps > 0
        taken += steps
        assert area.min() >= 0.0
    assert abs(area.sum() / before - 1.0) < 1e-12


def test_angular_momentum() -> None:
    """Without a body force nothing turns the liquid, bores or not."""
    n = 256
    theta = 2 * np.pi * (np.arange(n) + 0.5) / n
    area = np.where(np.abs(theta - np.pi) < 1.0, 0.14, 0.06)
    q = 0.02 * area - SPIN * area**2
    # Absolute angular momentum: q + Omega A, up to the constant Omega^2 of the drum's own frame.
    before = (q + SPIN * area).sum()
    energy = []
    for _ in range(5):
        assert run(area, q, 4.0) > 0
        velocity = (q + SPIN * area**2) / area
        # Kinetic energy in the drum and potential of the centrifugal force.
        energy.append((0.5 * velocity**2 * lw.layer_log(area) + 0.5 * SPIN**2 * area**2).sum())
    assert abs((q + SPIN * area).sum() / before - 1.0) < 1e-12
    assert all(late < early for early, late in pairwise(energy))


def jump_residual(a: tuple[float, float], u: tuple[float, float]) -> float:
    """Rankine-Hugoniot: both equations give the same speed of the jump."""
    areas, us = np.array(a), np.array(u)
    log, surface = lw.layer_log(areas), lw.free_surface_radius(areas)
    mass = lw.mass_flux(us, log)
    flow = lw.momentum_flux(us, log, areas, surface**-2.0) + lw.pressure_force(areas, surface, SPIN, 0.0)
    q = us * areas - SPIN * areas**2
    return float((mass[1] - mass[0]) / (areas[1] - areas[0]) - (flow[1] - flow[0]) / (q[1] - q[0]))


def test_bore() -> None:
    """A dam break: the bore obeys the jump conditions, runs at their speed, and does not overshoot."""
    n = 2048
    theta = 2 * np.pi * (np.arange(n) + 0.5) / n
    area = np.where(theta < np.pi, 0.14, 0.06)
    q = -SPIN * area**2
    run(area, q, 1.5)
    velocity = (q + SPIN * area**2) / area
    # The slopes of the two waves, each within its bounds, may add up where they part: measured are 1e-6 above
    # and 2e-5 below on 256 to 4096 cells. Limiting head and velocity alone has none here, but ripples of a
    # hundredth of the jump behind the bore of the next test.
    assert area.max() <= 0.14 * (1 + 2e-6) and area.min() >= 0.06 * (1 - 3e-5)
    # The prograde bore runs into the shallow liquid at rest beyond pi.
    inside = np.flatnonzero((theta > np.pi) & (area > 0.0601) & (velocity > 0.0))
    front = theta[inside[-1]]
    plateau = inside[-1] - 40
    a, u = (float(area[plateau]), 0.06), (float(velocity[plateau]), 0.0)
    log = lw.layer_log(np.array(a))
    speed = float(lw.mass_flux(u[0], log[0]) / (a[0] - a[1]))
    assert abs(jump_residual(a, u)) < 2e-3 * speed
    # The front is a few cells wide.
    assert front == pytest.approx(np.pi + 1.5 * speed, abs=5 * 2 * np.pi / n)


def test_a_bore_under_a_whirl_leaves_no_ripples() -> None:
    """At the retrograde free wave a bore goes round behind which the surface falls without a bump."""
    for n in (64, 200):
        area = np.full(n, 0.095)
        q = -SPIN * area**2
        drive = (0.005, -0.2356, 24.0, 0.7644, 0.0)
        assert run(area, q, 600.0, drive, (1, 0.025, 0.0, False)) > 0
        assert np.abs(np.diff(area)).max() > 0.2 * np.ptp(area)
        variation = np.abs(np.diff(np.append(area, area[0]))).sum()
        assert variation == pytest.approx(2.0 * np.ptp(area), rel=1e-9)


def test_films_and_dry_beds_stay_positive() -> None:
    for n in (16, 100, 513):
        theta = 2 * np.pi * (np.arange(n) + 0.5) / n
        area = np.where(np.abs(theta - 2.0) < 0.5, 0.2, 0.0)
        q = -SPIN * area**2
        before = area.sum()
        for length in (0.1, 1.0, 20.0):
            steps = run(area, q, length)
            assert steps > 0 and np.isfinite(area).all() and np.isfinite(q).all() and area.min() >= 0.0
        assert abs(area.sum() / before - 1.0) < 1e-13


def test_energy() -> None:
    """A free wave loses energy to the grid alone, ever less of it, and gains none."""
    lost = []
    for n in (32, 64, 128):
        theta = 2 * np.pi * (np.arange(n) + 0.5) / n
        mean, log = 0.095, float(lw.layer_log(0.095))
        speed = log - math.sqrt(log * log + log)
        area = mean * (1.0 + 1e-3 * np.cos(theta))
        q = 1e-3 * mean * np.cos(theta) * speed / log * area - SPIN * area**2
        ends = []
        for length in (0.0, 6.0 * math.pi / abs(speed)):
            if length:
                run(area, q, length)
            velocity = (q + SPIN * area**2) / area
            ends.append((0.5 * velocity**2 * lw.layer_log(area) + 0.5 * (area - mean) ** 2).mean())
        lost.append(1.0 - ends[1] / ends[0])
    assert all(one > 0.0 for one in lost)
    # Third order, the limiter's at extrema; measured 2.9 to 3.2 from 64 to 1024 cells.
    assert lost[0] > 6.0 * lost[1] > 36.0 * lost[2], lost


def test_order() -> None:
    """Second order on a smooth travelling disturbance, by successive grids."""
    answers = []
    for n in (64, 128, 256, 512):
        theta = 2 * np.pi * (np.arange(n) + 0.5) / n
        # Cell averages of the smooth start: the middle's value is one to second order, sinc makes it exact.
        blunt = math.sin(np.pi / n) / (np.pi / n)
        area = 0.1 + 0.002 * np.cos(theta) * blunt
        q = -SPIN * area**2
        run(area, q, 3.0)
        answers.append(area.reshape(64, -1).mean(axis=1))
    errors = [np.abs(a - b).mean() for a, b in pairwise(answers)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    # Limiters clip at the two extrema: a little below two in the mean.
    assert np.all(orders > 1.7), orders


def test_logarithm_over_the_whole_range() -> None:
    """ln(1/r) and 1/r^2, compiled, within a few roundings of the exact ones of the same area and radius."""
    rng = np.random.default_rng(11)
    thin, deep = 10.0 ** rng.uniform(-13.0, -1.0, 4000), rng.uniform(0.1, FULL, 4000)
    edges = 0.5 * (1.0 - np.array([0.5, 0.125]) ** 2)
    area = np.concatenate(
        [thin, deep, edges, np.nextafter(edges, 0.0), np.nextafter(edges, 1.0), [1e-13, FULL]]
    )
    radius, log, inverse = lw.free_surface_radius(area), np.empty(area.size), np.empty(area.size)
    _logs(area, radius, log, inverse)
    with mp.workdps(40):
        by_area = np.array([float(-mp.log(1 - 2 * mp.mpf(a)) / 2) for a in area])
        by_radius = np.array([float(-mp.log(r)) for r in radius])
    # Beyond r = 1/2 the radius stands for the layer; its own rounding over r ln r is not the logarithm's.
    exact = np.where(radius >= 0.5, by_area, by_radius)
    assert np.abs(log / exact - 1.0).max() < 4.0 * np.finfo(float).eps
    assert np.abs(inverse * radius**2 - 1.0).max() < 5.0 * np.finfo(float).eps


@njit
def _logs(area, radius, log, inverse):  # type: ignore[no-untyped-def]
    for i in range(area.size):
        log[i], inverse[i] = log_and_inverse(area[i], radius[i])


def test_friction_keeps_its_digits() -> None:
    """The share of the velocity that friction leaves, by the series and beyond it."""
    area = np.array([1e-9, 1e-5, 0.02, 0.1, 0.3])
    surface, kept, velocity = lw.free_surface_radius(area), np.empty(5), np.full(5, 0.1)
    for coefficient in (1e-9, 1e-3, 0.03, 0.3, 30.0):
        kept_speed(area, velocity, surface, 1, coefficient, 0.0, 1.0, kept)
        with mp.workdps(40):
            shear = [coefficient * 2 / (1 + mp.sqrt(1 - 2 * mp.mpf(a))) for a in area]
            exact = np.array([float(mp.exp(-x)) for x in shear])
        np.testing.assert_allclose(kept, exact, rtol=2.0 * np.finfo(float).eps * (1.0 + 2.0 * coefficient))


def test_ring() -> None:
    """The system of the dispersive term, against dense elimination; rings with gaps, and sizes apart."""
    rng = np.random.default_rng(3)
    for n in (8, 33, 500):
        side = np.exp(rng.normal(size=n)) * (rng.random(n) > 0.1)
        diagonal = np.exp(rng.normal(size=n)) + side + np.roll(side, -1)
        value = rng.normal(size=n)
        matrix = np.diag(diagonal)
        for i in range(n):
            matrix[i, i - 1] -= side[i]
            matrix[i - 1, i] -= side[i]
        found = value.copy()
        solve_ring(diagonal.copy(), np.append(side, side[0]), found, np.empty(n))
        # Elimination without pivots is stable for a dominant diagonal: rounding times size and answer.
        wrong = np.abs(matrix @ found - value).max()
        assert wrong < 20.0 * np.finfo(float).eps * np.abs(matrix).max() * np.abs(found).max()


@pytest.mark.parametrize("amplitude", [0.0566, 0.13])
def test_dispersion_leaves_the_torque(amplitude: float) -> None:
    """In a whirl that nearly or wholly dries its trough the wall's torque balances the body force's.

    The layer stands in the whirl's frame: its angular momentum in the drum's does not change, and the drag of
    the wall on it is what the force turns it by.
    """
    whirl, k, depth = 0.73132, 0.0230769, 0.1
    period = 2.0 * math.pi / (1.0 - whirl)
    for n in (64, 128, 256):
        area = np.full(n, depth - 0.5 * depth**2)
        q, cosine, sine = -(area**2), *angles(n)[:2]
        drive, rub = (amplitude, whirl - 1.0, 10.0 * period, whirl, 0.0), Wall(1, k, 0.0, True)
        spare, sums, now = scratch(n), records(LOADS), 0.0
        torque, turned, before, samples = 0.0, 0.0, 0.0, 200
        for sample in range(samples + 1):
            # First 30 periods by itself, then by twentieths of a period, of which means are taken.
            stop = (30.0 + sample / 20.0) * period
            done = march(area, q, now, stop, Drive(*drive, SPIN), rub, angles(n), 0.8, spare, sums)
            assert done[0] == Outcome.DONE
            now, surface = stop, np.sqrt(1.0 - 2.0 * area)
            before = (q + area).sum() if sample == 0 else before
            wet = area > 1e-10
            velocity = np.where(wet, q / np.where(wet, area, 1.0) + area, 0.0)
            torque -= (k * (1.0 - surface) * velocity).sum() * (sample > 0)
            lever = (1.0 - surface**3) / 3.0 * (sample > 0)
            at = (whirl - 1.0) * now
            turned += amplitude * whirl**2 * (lever * (cosine * math.sin(at) - sine * math.cos(at))).sum()
        length, gained = 10.0 * period, (q + area).sum() - before
        assert area.min() < 0.3 * area.mean()
        assert torque / (gained / length * samples - turned) == pytest.approx(1.0, abs=2e-3), n


def test_friction() -> None:
    """A layer that turns as a whole slows down as each law says."""
    n, area0, u0 = 32, 0.08, 0.05
    depth = 1.0 - math.sqrt(1.0 - 2.0 * area0)
    for law, coefficient, lid, kept in (
        (1, 0.3, 0.0, math.exp(-0.3 * depth / area0 * 2.0)),
        (2, 0.004, 5.0, math.exp(-0.004 * (1 + 5.0 * depth) / area0 * 2.0)),
        (3, 0.5, 0.0, 1.0 / (1.0 + 0.5 * u0 / area0 * 2.0)),
    ):
        area = np.full(n, area0)
        q = u0 * area - SPIN * area**2
        run(area, q, 2.0, rub=(law, coefficient, lid, False))
        np.testing.assert_allclose((q + SPIN * area**2) / area, u0 * kept, rtol=1e-10)


def test_euler_force_spins_the_liquid_back() -> None:
    n = 16
    area = np.full(n, 0.08)
    q, work = -SPIN * area**2, np.zeros((WORK, n + 2 * GHOSTS))
    d_area, d_q, still = np.zeros(n), np.zeros(n), np.zeros(n)
    none, step = np.empty(0), 2 * np.pi / n
    rates(area, q, none, SPIN, 0.7, still, still, *NOTHING, step, 1e-3, False, work, d_area, d_q, none)
    np.testing.assert_allclose(d_q, -0.7 * area, rtol=1e-13)
    np.testing.assert_allclose(d_area, 0.0, atol=1e-15)
    assert DRY < 1e-12
