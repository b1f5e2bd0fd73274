"""Ball balancers: equations against Lagrange's, energy, balanced states, Jeffcott and two planes in time."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from meshes.arrays import Array
from meshes.errors import InputError
from solvers.rotor.balls import motion as ball_motion
from solvers.rotor.balls import steps as ball_steps
from solvers.rotor.balls.balancers import (
    BalancedRun,
    BallRace,
    simulate,
)
from solvers.rotor.balls.two_plane_balance import dynamic_balancing, of_two_planes
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import RotorSystem
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from tests.mutants import kills
from tests.oracles.balls import balanced_places, residual_unbalance, unbalance_in_planes

ROTOR = Jeffcott(mass=10.0, stiffness=25000.0, damping=100.0, unbalance=2e-3)
RACE = BallRace(0.0, 0.1, (0.02, 0.02), 0.5)
# Little drag, so that balls in a weak field come to rest within a minute, to better than e^-20.
FREE = BallRace(0.0, 0.1, (0.02, 0.02), 0.05)


def random_case(seed: int, n: int = 4, count: int = 3) -> tuple[Array, tuple[Array, ...], Array]:
    """State, matrices and numbers of the equations, all of order one; no structure but symmetry."""
    rng = np.random.default_rng(seed)
    shape = rng.normal(size=(n, n))
    mass, stiffness = shape @ shape.T + n * np.eye(n), shape.T @ shape
    skew = rng.normal(size=(n, n))
    damping = 0.1 * np.eye(n) + (skew - skew.T)
    balls = rng.uniform(0.5, 1.5, size=(count, 4)) + np.array([0.0, 0.0, 0.0, 0.5])
    matrices = (mass, damping, stiffness, rng.normal(size=(2, n)), rng.normal(size=(count, 2, n)), balls)
    return rng.normal(size=2 * (n + count) + 2), matrices, np.array([1.7, 0.9])


def slope(time: float, state: Array, matrices: tuple[Array, ...], numbers: Array) -> Array:
    out = np.zeros_like(state)
    ball_motion.rates(time, state, *matrices, numbers, out)
    return out


def momenta(q_rate: Array, angle: Array, rate: Array, mass: Array, axes: Array, balls: Array) -> Array:
    """Generalized momenta from the kinetic energy, rotor's coordinates first."""
    p = mass @ q_rate
    own = []
    for (m, radius, _, rolling), axis, a, w in zip(balls, axes, angle, rate, strict=True):
        tangent = np.array([-math.sin(a), math.cos(a)])
        velocity = axis @ q_rate + radius * w * tangent
        p = p + m * axis.T @ velocity
        own.append(m * radius * tangent @ velocity + (rolling - 1.0) * m * radius**2 * w)
    return np.concatenate((p, own))


@kills(
    "solvers.rotor.balls.motion:rates", "* cosine - turning[1, i] * sine", "* cosine + turning[1, i] * sine"
)
@kills("solvers.rotor.balls.motion:rates", "cosine, sine = spin * spin *", "cosine, sine = spin *")
@kills("solvers.rotor.balls.motion:rates", "push - drawn - held", "push - drawn + held")
@kills("solvers.rotor.balls.motion:rates", "damping[i, k] * state[n + k]", "damping[k, i] * state[n + k]")
@kills("solvers.rotor.balls.motion:rates", "-drag * radius * radius * (rate", "-drag * radius * (rate")
@kills("solvers.rotor.balls.motion:rates", "slip - weight * gravity", "slip + weight * gravity")
@kills("solvers.rotor.balls.motion:rates", "weight * radius * rate * rate\n", "weight * radius * rate\n")
@kills(
    "solvers.rotor.balls.motion:rates",
    "torque / (rolling * weight * radius * radius)",
    "torque / (weight * radius * radius)",
)
@kills(
    "solvers.rotor.balls.motion:rates",
    "x * axes[j, 0, i] + y * axes[j, 1, i], x * axes",
    "x * axes[j, 0, i] - y * axes[j, 1, i], x * axes",
)
@kills(
    "solvers.rotor.balls.motion:rates",
    "away * outward - torque / (rolling * radius)",
    "away * outward + torque / (rolling * radius)",
)
@kills("solvers.rotor.balls.motion:rates", "(1.0 - 1.0 / rolling) * along", "1.0 / rolling * along")
@kills(
    "solvers.rotor.balls.motion:rates",
    "out[second + j] -= along * out[n + i]",
    "out[second + j] += along * out[n + i]",
)
@kills(
    "solvers.rotor.balls.motion:rates", "out[n + k] -= share * out[n + i]", "out[n + k] += share * out[n + i]"
)
def test_equations() -> None:
    """Lagrange's equations: the rate of the momenta along the motion is the force, by central differences.

    Over +-1e-5 of an order-one motion these are right to 1e-9, with rounding over the step to 1e-10.
    """
    for seed in range(3):
        state, matrices, numbers = random_case(seed)
        mass, damping, stiffness, turning, axes, balls = matrices
        spin, gravity = numbers
        time, n, count = 0.6, mass.shape[0], balls.shape[0]
        rates = slope(time, state, matrices, numbers)
        q, dq = state[:n], state[n : 2 * n]
        angle, rate = state[2 * n : 2 * n + count], state[2 * n + count : 2 * (n + count)]
        assert np.array_equal(rates[:n], dq) and np.array_equal(rates[2 * n : 2 * n + count], rate)
        step = 1e-5
        ends = [
            momenta(
                dq + s * rates[n : 2 * n],
                angle + s * rate,
                rate + s * rates[2 * n + count : -2],
                mass,
                axes,
                balls,
            )
            for s in (-step, step)
        ]
        found = (ends[1] - ends[0]) / (2 * step)
        push = spin**2 * ((turning[0] + 1j * turning[1]) * cmath.exp(1j * spin * time)).real
        force = list(push - damping @ dq - stiffness @ q)
        for (m, radius, drag, _), axis, a, w in zip(balls, axes, angle, rate, strict=True):
            # dT/d(angle) from the turning tangent, then drag and weight.
            inward = -np.array([math.cos(a), math.sin(a)])
            coupling = m * radius * w * inward @ (axis @ dq)
            force.append(coupling - drag * radius**2 * (w - spin) - m * gravity * radius * math.cos(a))
        assert found == pytest.approx(np.array(force), abs=2e-8)


@kills("solvers.rotor.balls.motion:rates", "out[work] += (push - drawn)", "out[work] += (push + drawn)")
@kills("solvers.rotor.balls.motion:rates", "out[work] += slip * rate", "out[work] += slip")
@kills("solvers.rotor.balls.motion:energy", "(rolling - 1.0) * np.square", "rolling * np.square")
@kills("solvers.rotor.balls.motion:energy", "carried[:, 0] - radius * rate", "carried[:, 0] + radius * rate")
@kills("solvers.rotor.balls.motion:energy", "lifted = gravity * np.sum", "lifted = -gravity * np.sum")
@kills("solvers.rotor.balls.motion:energy", "0.5 * q @ stiffness @ q", "q @ stiffness @ q")
def test_energy() -> None:
    """The rate of the energy is the work that `rates` counts: central difference, as above."""
    for seed in range(3):
        state, matrices, numbers = random_case(seed)
        mass, _, stiffness, _, axes, balls = matrices
        rates = slope(0.3, state, matrices, numbers)
        step = 1e-5
        ends = [
            ball_motion.energy(state + s * rates, mass, stiffness, axes, balls, float(numbers[1]))
            for s in (-step, step)
        ]
        assert (ends[1] - ends[0]) / (2 * step) == pytest.approx(rates[-2], abs=2e-8)
        assert rates[-1] >= 0.0


@kills("solvers.rotor.balls.motion:rates", "out[work + 1] += abs(slip * rate)", "out[work + 1] += abs(slip)")
@kills("solvers.rotor.balls.motion:rates", "abs(push * state[n + i])", "abs(push * state[i])")
def test_turnover() -> None:
    """The size of all work, written out: push of the unbalance, drag of the balls."""
    state, matrices, numbers = random_case(4)
    mass, _, _, turning, _, balls = matrices
    n, count, spin, time = mass.shape[0], balls.shape[0], float(numbers[0]), 0.2
    push = spin**2 * ((turning[0] + 1j * turning[1]) * cmath.exp(1j * spin * time)).real
    rate = state[2 * n + count : -2]
    slip = balls[:, 2] * balls[:, 1] ** 2 * (rate - spin)
    total = np.abs(push * state[n : 2 * n]).sum() + np.abs(slip * rate).sum()
    assert slope(time, state, matrices, numbers)[-1] == pytest.approx(total, rel=1e-12)


@kills("solvers.rotor.balls.steps:_stretch", "2.0 * middle", "1.0 * middle")
@kills(
    "solvers.rotor.balls.steps:_stretch", "time = number * step", "time = (number - number % steps) * step"
)
def test_steps() -> None:
    """The loop as Python against an adaptive method: fourth order, factor 16 within a third."""
    state, matrices, numbers = random_case(2, n=2, count=1)
    state[-2:] = 0.0
    exact = solve_ivp(
        lambda t, y: slope(t, y, matrices, numbers),
        (0.0, 1.2),
        state,
        method="DOP853",
        rtol=1e-12,
        atol=1e-12,
    ).y[:-1, -1]
    errors = []
    for steps in (10, 20):
        record = np.zeros((3, state.size))
        ball_steps.advance(
            *(state.copy(), matrices, numbers, 1.2 / (2 * steps), steps, record), ball_steps._stretch
        )
        # The sum of sizes has kinks, the rest none.
        errors.append(np.max(np.abs(record[-1, :-1] - exact)))
        assert np.array_equal(record[0], state)
    assert errors[1] < 1e-5 and 11.0 < errors[0] / errors[1] < 21.0


def test_places() -> None:
    """The balls' moment is the unbalance, opposite, to rounding; what cannot be balanced is said so."""
    for count in (2, 3, 4, 7):
        unbalance = cmath.rect(2.9e-3, 0.7)
        places = balanced_places(unbalance, 1.6e-3, count)
        assert places is not None
        assert abs(residual_unbalance(unbalance, 1.6e-3, places)) < 1e-17 + 1e-15 * abs(unbalance)
    assert balanced_places(3.3e-3, 1.6e-3, 2) is None
    assert balanced_places(3.2e-3, 1.6e-3, 2) == pytest.approx([math.pi, math.pi], abs=1e-7)  # square root
    assert balanced_places(1e-3, 1.6e-3, 1) is None
    assert balanced_places(1.6e-3, 1.6e-3, 1) == pytest.approx([math.pi])
    assert balanced_places(0.0, 1.6e-3, 2) == pytest.approx([math.pi / 2, -math.pi / 2])


def last_places(run: BalancedRun) -> Array:
    """Angles of the balls in the rotor at the end, from the origin of its unbalance's angle, rad."""
    return np.asarray(run.ball_angle[-1] - run.speed * run.time[-1])


def test_supercritical() -> None:
    """Above the critical speed (50 rad/s) the residual is 0 and the balls stand where statics put them.

    The slowest motion about the balanced state decays at more than 1/s here: after 30 s rounding is left.
    """
    run = simulate(ROTOR.system(), [RACE], 150.0, 30.0, places=[1.0, 2.5])
    assert run.converged and run.energy_error < 1e-6
    alone = abs(ROTOR.unbalance * 150.0**2 / ROTOR.dynamic_stiffness(np.array(150.0)))
    assert abs(run.deflection(ROTOR.system(), 0.0)[-1]) < 1e-9 * alone
    expected = balanced_places(2e-3, 0.02 * 0.1, 2)
    assert expected is not None
    gaps = np.exp(1j * np.sort(last_places(run) % (2 * math.pi))) - np.exp(
        1j * np.sort(expected % (2 * math.pi))
    )
    assert np.max(np.abs(gaps)) < 1e-7


@kills(
    "solvers.rotor.balls.balancers:BalancedRun.deflection",
    "1j * self.speed * self.time",
    "2j * self.speed * self.time",
)
def test_subcritical() -> None:
    """Below it the balls gather on the heavy side: amplitude of the unbalance and both balls together.

    The synchronous answer of (M + 2 m) to U0 + 2 m R; the balls lie along the deflection, which lags,
    and the sum is solved by iteration. A turn in 96 steps
    is right to (2 pi/96)^4/24 = 8e-7, a tenth of the bound.
    """
    speed = 30.0
    run = simulate(ROTOR.system(), [FREE], speed, 60.0, places=[1.0, 2.5], steps=96)
    moment = 2 * 0.02 * 0.1
    stiffness = complex(25000.0 - 10.04 * speed**2, 100.0 * speed)
    w = 1e-4 + 0j
    for _ in range(200):
        w = 0.5 * (w + speed**2 * (2e-3 + moment * w / abs(w)) / stiffness)
    assert abs(w) > 2.5 * abs(2e-3 * speed**2 / stiffness)
    assert run.deflection(ROTOR.system(), 0.0)[-1] == pytest.approx(w, rel=1e-5)
    assert np.exp(1j * last_places(run)) == pytest.approx(np.full(2, w / abs(w)), rel=1e-5)


def test_too_light() -> None:
    """Balls too light for the unbalance come to lie opposite and leave U0 - N m R."""
    light = BallRace(0.0, 0.1, (0.005, 0.005), 0.05)
    run = simulate(ROTOR.system(), [light], 150.0, 60.0, places=[1.0, 2.5], steps=96)
    # The balls lie along the axis of rotation's far side: along -w with the phase of the damped rotor.
    stiffness = complex(25000.0 - 10.01 * 150.0**2, 100.0 * 150.0)
    w = -1e-4 + 0j
    for _ in range(200):
        w = 0.5 * (w + 150.0**2 * (2e-3 + 1e-3 * w / abs(w)) / stiffness)
    assert run.deflection(ROTOR.system(), 0.0)[-1] == pytest.approx(w, rel=1e-5)
    assert abs(w) < 0.55 * abs(2e-3 * 150.0**2 / stiffness)


LONG, SHORT = (0.5, 0.1), (0.1, 0.18)
UNBALANCES = (PlaneUnbalance(0.15, 1e-3, 0.0), PlaneUnbalance(-0.1, 8e-4, 2.0))
RACES = (BallRace(0.15, 0.08, (0.015, 0.015), 0.3), BallRace(-0.15, 0.08, (0.015, 0.015), 0.3))


def two_planes(inertia: tuple[float, float]) -> TwoPlane:
    return TwoPlane(10.0, *inertia, (Support(0.2, 1e4, 40.0), Support(-0.22, 1.1e4, 40.0)), UNBALANCES)


def two_plane_run(inertia: tuple[float, float], speed: float) -> tuple[BalancedRun, RotorSystem]:
    system = two_planes(inertia).system()
    return simulate(system, RACES, speed, 60.0, places=[0.5, 1.5, 0.2, 3.0]), system


def largest_end(run: BalancedRun, system: RotorSystem) -> float:
    """Largest deflection of the two supports over the last tenth."""
    return max(float(np.abs(run.deflection(system, z))[-40:].max()) for z in (0.2, -0.22))


@kills(
    "solvers.rotor.balls.balancers:simulate",
    "damping = system.damping + speed * system.gyroscopic",
    "damping = system.damping",
)
def test_two_planes() -> None:
    """Balancers in two planes balance the long rotor above its resonances, where the conditions say yes."""
    for inertia, speed in ((LONG, 30.0), (LONG, 120.0), (SHORT, 30.0), (SHORT, 120.0)):
        run, system = two_plane_run(inertia, speed)
        said = bool(dynamic_balancing(of_two_planes(two_planes(inertia), 0.06), speed).possible[0])
        assert run.converged and said == (inertia == LONG and speed == 120.0)
        # The unbalances' own size, 1e-3 kg m on 10 kg, is 0.1 mm.
        assert (largest_end(run, system) < 1e-9) == said
        if not said:
            assert largest_end(run, system) > 5e-5


def test_two_plane_places() -> None:
    """The balls of each race end opposite to the race's part of the static and couple unbalance."""
    run, _ = two_plane_run(LONG, 120.0)
    parts = unbalance_in_planes([(u.position, cmath.rect(u.size, u.angle)) for u in UNBALANCES], 0.15, -0.15)
    for part, angles in zip(parts, (last_places(run)[:2], last_places(run)[2:]), strict=True):
        assert abs(residual_unbalance(part, 0.015 * 0.08, angles)) < 1e-7 * abs(part)


def test_gravity_across_leaves_a_small_wobble() -> None:
    """Gravity disturbs the balls once a turn: a wobble of the order of g/(kappa R Omega^2) rad."""
    run = simulate(ROTOR.system(), [RACE], 300.0, 30.0, places=[1.0, 2.5], gravity=9.81)
    wobble = 9.81 / (7 / 5 * 0.1 * 300.0**2)
    end = np.abs(run.deflection(ROTOR.system(), 0.0))[-40:].max()
    alone = abs(2e-3 * 300.0**2 / ROTOR.dynamic_stiffness(np.array(300.0)))
    assert run.converged
    assert 0.05 * wobble * alone < end < 20.0 * wobble * alone


@given(st.floats(0.0, 10.0), st.integers(2, 9), st.floats(-6.0, 6.0))
def test_places_balance_whatever_can_be(ratio: float, count: int, angle: float) -> None:
    unbalance = cmath.rect(ratio, angle)
    places = balanced_places(unbalance, 1.0, count)
    assert (places is None) == (ratio > count)
    if places is not None:
        # acos loses half the digits at its ends, where its slope is without bound: not the sum, though.
        assert abs(residual_unbalance(unbalance, 1.0, places)) < 1e-13 * count


@given(
    st.lists(st.tuples(st.floats(-1, 1), st.floats(0, 1), st.floats(-3, 3)), max_size=5), st.floats(0.05, 1)
)
def test_planes_carry_the_static_and_the_couple_part(
    parts: list[tuple[float, float, float]], half: float
) -> None:
    unbalances = [(z, cmath.rect(size, angle)) for z, size, angle in parts]
    first, second = unbalance_in_planes(unbalances, half, -half)
    assert first + second == pytest.approx(sum(u for _, u in unbalances), abs=1e-12 / half)
    assert half * (first - second) == pytest.approx(sum(z * u for z, u in unbalances), abs=1e-12 / half)


def test_bad_input_is_named() -> None:
    for values in (
        (math.nan, 0.1, (0.1,), 0.1),
        (0.0, 0.0, (0.1,), 0.1),
        (0.0, 0.1, (), 0.1),
        (0.0, 0.1, (-0.1,), 0.1),
        (0.0, 0.1, (0.1,), -0.1),
        (0.0, 0.1, (0.1,), 0.1, 0.5),
    ):
        with pytest.raises(InputError):
            BallRace(*values)
    system = ROTOR.system()
    for change in ({"places": [1.0]}, {"samples": 1}, {"steps": 4}, {"gravity": -1.0}):
        with pytest.raises(InputError):
            simulate(system, [RACE], 10.0, 1.0, **change)
    for speed, duration, races in ((0.0, 1.0, [RACE]), (10.0, 0.0, [RACE]), (10.0, 1.0, [])):
        with pytest.raises(InputError):
            simulate(system, races, speed, duration)


@pytest.mark.parametrize(
    ("stiffness", "damping", "masses", "drag"),
    [
        (1e11, 100.0, (0.02, 0.02), 0.5),  # rigid supports
        (1e-3, 0.0, (0.02, 0.02), 0.5),  # free in space, no damping
        (25000.0, 1e6, (0.02, 0.02), 0.5),  # stuck in tar
        (25000.0, 100.0, (50.0, 20.0), 0.5),  # balls heavier than the rotor
        (25000.0, 100.0, (1e-9,), 1e-7),  # dust
        (25000.0, 0.0, (0.02, 0.02), 0.0),  # nothing is dissipated
    ],
)
def test_extremes_stay_sound(
    stiffness: float, damping: float, masses: tuple[float, ...], drag: float
) -> None:
    """Finite, and the energy audit closes: within a thousandth of all the work."""
    rotor = Jeffcott(10.0, stiffness, damping, 2e-3)
    run = simulate(rotor.system(), [BallRace(0.0, 0.1, masses, drag)], 150.0, 1.0, samples=20)
    assert run.converged and np.isfinite(run.coordinates).all()


def test_too_many_steps_are_refused() -> None:
    rotor = Jeffcott(10.0, 1e15, 0.0, 2e-3)
    with pytest.raises(InputError, match="steps"):
        simulate(rotor.system(), [RACE], 150.0, 1e4)
