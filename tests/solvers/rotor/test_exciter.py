"""The exciter: its numbers, its equations against the printed ones, against the general balls, in energy."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from meshes.arrays import Array
from meshes.errors import InputError
from solvers.rotor.balls import motion as ball_motion
from solvers.rotor.exciter import machine as exciter
from solvers.rotor.exciter.machine import Dimensionless, Exciter, platform_motion, rolling_inertia
from tests.mutants import kills

MACHINE = Exciter(36.1, 145083.0, 150.0, 0.1 * 0.105, 2, 0.325, 7.0 / 5.0, 0.0735, 0.05)


def slope(numbers: Dimensionless, speed: float, time: float, state: Array) -> Array:
    out = np.zeros_like(state)
    exciter.rates(time, state, numbers.numbers(speed), out)
    return out


@kills(
    "solvers.rotor.exciter.machine:Exciter.dimensionless",
    "smallness=balls / (self.rolling * mass)",
    "smallness=balls / mass",
)
@kills(
    "solvers.rotor.exciter.machine:Exciter.dimensionless",
    "unbalance=self.unbalance / (balls * self.track_radius)",
    "unbalance=self.unbalance / balls",
)
@kills(
    "solvers.rotor.exciter.machine:Exciter.dimensionless",
    "damping=self.damping / (2.0 * mass * frequency)",
    "damping=self.damping / (mass * frequency)",
)
def test_printed_numbers() -> None:
    """[YF17, section 5.2], the empty table: two or three digits as printed."""
    numbers = MACHINE.dimensionless()
    assert numbers.smallness == pytest.approx(0.0126, abs=5e-5)
    assert numbers.unbalance == pytest.approx(0.22, abs=5e-3)
    assert numbers.damping == pytest.approx(0.032, abs=5e-4)
    # 0.138 belongs to a drag of 0.05 N s/m, and not to the 0.03 printed (0.083).
    assert numbers.drag == pytest.approx(0.138, abs=5e-4)
    assert MACHINE.length == pytest.approx(1.3e-3, abs=5e-6)
    assert MACHINE.natural_frequency / (2.0 * math.pi) == pytest.approx(10.0, abs=5e-3)


@kills(
    "solvers.rotor.exciter.machine:Exciter.whole_mass",
    "return self.platform_mass + self.ball_count * self.ball_mass",
    "return self.platform_mass + self.ball_mass",
)
@kills(
    "solvers.rotor.exciter.machine:Exciter.dimensionless",
    "drag=self.ball_damping * mass / (balls * self.ball_mass * frequency)",
    "drag=self.ball_damping * mass / (balls * balls * frequency)",
)
@kills(
    "solvers.rotor.exciter.machine:Exciter.dimensionless",
    "gravity=gravity / (self.length * frequency**2)",
    "gravity=gravity / (self.length * frequency)",
)
@kills(
    "solvers.rotor.exciter.machine:Exciter.system",
    "np.array([-1j * self.unbalance]",
    "np.array([1j * self.unbalance]",
)
def test_units() -> None:
    """Seconds and metres: the dimensional equations of the general balls give the same accelerations.

    Two derivations of one motion, equal to rounding: 1e-11 of the largest.
    """
    gravity, omega = 9.81, 400.0
    numbers, unit, length = MACHINE.dimensionless(gravity), MACHINE.natural_frequency, MACHINE.length
    rng = np.random.default_rng(3)
    for _ in range(5):
        y, velocity, phase = rng.normal(size=2) * 1e-3, rng.normal() * 0.1, rng.uniform(0.0, 6.0, 2)
        rate, time = rng.uniform(0.0, omega, 2), float(rng.uniform(0.0, 1.0))
        state = np.array([y[0] / length, velocity / (length * unit), *phase, *(rate / unit)])
        ours = slope(numbers, omega / unit, time * unit, state)
        system = MACHINE.system()
        turning = np.stack((system.unbalance.real, system.unbalance.imag))
        balls = np.tile(
            [MACHINE.ball_mass, MACHINE.track_radius, MACHINE.ball_damping, MACHINE.rolling], (2, 1)
        )
        general, out = np.array([y[0], velocity, *phase, *rate, 0.0, 0.0]), np.zeros(8)
        parts = (
            system.mass,
            system.damping,
            system.stiffness,
            turning,
            np.tile(system.centre, (2, 1, 1)),
            balls,
        )
        ball_motion.rates(time, general, *parts, np.array([omega, gravity]), out)
        assert ours[1] * length * unit**2 == pytest.approx(out[1], rel=1e-11)
        assert ours[4:] * unit**2 == pytest.approx(out[4:6], rel=1e-11)


@kills("solvers.rotor.exciter.machine:rates", "load = delta * n * n *", "load = delta * n *")
@kills("solvers.rotor.exciter.machine:rates", "- 2.0 * h * velocity", "- h * velocity")
@kills("solvers.rotor.exciter.machine:rates", "velocity - state[0]", "velocity + state[0]")
@kills("solvers.rotor.exciter.machine:rates", "own = -eps * b * (rate - n)", "own = -eps * b * (rate + n)")
@kills("solvers.rotor.exciter.machine:rates", "np.cos(angle - alpha)", "np.cos(angle + alpha)")
@kills("solvers.rotor.exciter.machine:rates", "(rate * rate * np.sin(angle) -", "(rate * np.sin(angle) -")
@kills("solvers.rotor.exciter.machine:rates", "- own * cosine)", "+ own * cosine)")
@kills("solvers.rotor.exciter.machine:rates", "load / (1.0 - eps * carried", "load / (1.0 + eps * carried")
@kills(
    "solvers.rotor.exciter.machine:rates", "-= eps * acceleration * np.cos", "+= eps * acceleration * np.cos"
)
def test_equations() -> None:
    """The source's equations as printed [YF17, eq. 1] hold for what `rates` solved: residual at rounding."""
    numbers = Dimensionless(0.03, 0.4, 0.25, 0.05, gravity=1.9, incline=0.4)
    rng, n, time = np.random.default_rng(1), 4.0, 0.7
    for balls in (1, 2, 5):
        state = rng.normal(size=2 + 2 * balls)
        out = slope(numbers, n, time, state)
        v, dv, ddv = state[0], state[1], out[1]
        phi, dphi, ddphi = state[2 : 2 + balls], state[2 + balls :], out[2 + balls :]
        sum_yy = np.mean(ddphi * np.cos(phi) - dphi**2 * np.sin(phi))
        first = ddv + 2 * 0.05 * dv + v + sum_yy - 0.25 * n**2 * np.sin(n * time)
        weight = 1.9 * np.cos(phi - 0.4)
        second = ddphi + 0.03 * (0.4 * (dphi - n) + weight + ddv * np.cos(phi))
        assert abs(first) < 1e-13 and np.all(np.abs(second) < 1e-13)  # terms of order 1 to 10
        assert np.array_equal(out[2 : 2 + balls], dphi) and out[0] == dv


@kills(
    "solvers.rotor.exciter.machine:platform_motion",
    "complex(1.0 - frequency**2,",
    "complex(frequency**2 - 1.0,",
)
@kills(
    "solvers.rotor.exciter.machine:platform_motion",
    "return frequency**2 / complex",
    "return frequency / complex",
)
def test_platform_motion() -> None:
    """The linear platform under the balls' even turning: its equation at any time, to rounding."""
    numbers, n, q = Dimensionless(0.01, 0.4, 0.25, 0.03), 5.0, 0.93
    slow, fast = platform_motion(numbers, n, q, together=0.7)
    for time in (0.0, 0.4, 2.9):
        parts = [amplitude * np.exp(1j * f * time) * np.array([1.0, 1j * f, -f * f])
                 for amplitude, f in ((slow, q), (fast, n))]  # fmt: skip
        v, dv, ddv = sum(parts).imag
        drive = 0.7 * q**2 * math.sin(q * time) + 0.25 * n**2 * math.sin(n * time)
        assert ddv + 2 * 0.03 * dv + v == pytest.approx(drive, abs=1e-12)


@kills(
    "solvers.rotor.exciter.machine:rolling_inertia",
    "return 1.0 + own_inertia / (mass",
    "return own_inertia / (mass",
)
@kills("solvers.rotor.exciter.machine:rolling_inertia", "(mass * radius**2)", "(mass * radius)")
def test_rolling() -> None:
    """Kinetic energy of a rolling solid ball and cylinder: 2/5 and 1/2 of m r^2."""
    assert rolling_inertia("ball") == 1.0 + 2.0 / 5.0
    assert rolling_inertia("roller") == 1.0 + 1.0 / 2.0
    # A rod of length 2 R hung at its end: m (2 R)^2/12 about its middle, m R^2 4/3 about the shaft.
    assert rolling_inertia("pendulum", 3.0, 0.2, 3.0 * 0.4**2 / 12.0) == pytest.approx(4.0 / 3.0, rel=1e-15)


@given(
    st.floats(0.001, 0.3), st.floats(0.0, 2.0), st.floats(0.1, 30.0), st.integers(1, 6), st.integers(0, 999)
)
def test_balls_without_drag_keep_their_energy(
    eps: float, sigma: float, n: float, balls: int, seed: int
) -> None:
    """Without drag, damping and unbalance the energy's rate is 0 to rounding, whatever the state."""
    numbers = Dimensionless(eps, 0.0, 0.0, 0.0, sigma, 0.3)
    rng = np.random.default_rng(seed)
    state = np.concatenate((rng.normal(size=2), rng.uniform(0, 6.28, balls), rng.uniform(0.0, n, balls)))
    out = slope(numbers, n, 0.0, state)
    v, dv, ddv = state[0], state[1], out[1]
    phi, w, dw = state[2 : 2 + balls], state[2 + balls :], out[2 + balls :]
    # E = v'^2/2 + v^2/2 + mean(w v' cos phi) + mean(w^2)/(2 eps) + sigma mean(sin(phi - alpha))
    terms = [dv * ddv, v * dv, np.mean(dw * dv * np.cos(phi)), np.mean(w * ddv * np.cos(phi)),
             -np.mean(w * w * dv * np.sin(phi)), np.mean(w * dw) / eps,
             sigma * np.mean(w * np.cos(phi - 0.3))]  # fmt: skip
    assert abs(sum(terms)) <= 1e-13 * max(1.0, sum(map(abs, terms)))


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"platform_mass": 0.0}, "platform_mass"),
        ({"rolling": 0.9}, "rolling"),
        ({"ball_count": 0}, "ball_count"),
        ({"ball_damping": 0.0}, "ball_damping"),
        ({"unbalance": -1.0}, "unbalance"),
        ({"track_radius": math.inf}, "track_radius"),
    ],
)
def test_bad_machines_are_named(change: dict[str, float], field: str) -> None:
    values = {name: getattr(MACHINE, name) for name in Exciter.__dataclass_fields__} | change
    with pytest.raises(InputError) as caught:
        Exciter(**values)
    assert caught.value.field == field


def test_bad_numbers_are_named() -> None:
    for values, field in (
        ((0.0, 0.4, 0.2, 0.03), "smallness"),
        ((1.0, 0.4, 0.2, 0.03), "smallness"),
        ((0.1, math.nan, 0.2, 0.03), "drag"),
        ((0.1, 0.4, 0.2, 0.03, 0.0, math.inf), "incline"),
    ):
        with pytest.raises(InputError) as caught:
            Dimensionless(*values)
        assert caught.value.field == field
    for kind, mass in (("cube", 1.0), ("pendulum", 0.0)):
        with pytest.raises(InputError):
            rolling_inertia(kind, mass)
