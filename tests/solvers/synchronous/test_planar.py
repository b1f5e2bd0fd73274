"""Response of the rotor with liquid: closed forms, limits, every branch, stability."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

from fluid.fill import Fill
from fluid.liquid import Liquid
from leblanc.liquid.models import synchronous_model
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.vector_model import balance_residual, deflection_lag
from solvers.statics.hydrostatics import equilibrium
from solvers.synchronous.models import Linear
from solvers.synchronous.response import Response, critical_speed, response
from tests.mutants import kills

WATER = Liquid("water", 1000.0, 1e-6)


def rig(zeta: float = 0.1, unbalance: float = 6e-4) -> Jeffcott:
    """A rotor of 4 kg with its critical speed at 100 rad/s."""
    return Jeffcott(4.0, 4e4, 2.0 * zeta * 400.0, unbalance)


def fills(*volumes: float) -> list[Fill]:
    return [Fill(Chamber(0.065 - 0.015 * k, 0.02), WATER, v) for k, v in enumerate(volumes)]


def folded() -> tuple[Jeffcott, list[Fill], np.ndarray]:
    """A lightly damped rotor whose law bends while the deflection is large: three branches."""
    return rig(0.001, 1e-4), fills(1.2e-5), np.linspace(96.0, 100.0, 41)


@kills(
    "solvers.synchronous.planar:all_deflections",
    "force, damping = pairs.unbalance * squared",
    "force, damping = pairs.unbalance * pairs.speed",
)
@kills(
    "solvers.synchronous.planar:liquid_offset",
    "np.divide(unbalance, pairs.liquid_mass",
    "np.divide(unbalance - deflection, pairs.liquid_mass",
)
def test_added_mass() -> None:
    """Wall wet all over: a Jeffcott rotor of mass M + m_f, whatever the volume."""
    rotor, speed = rig(), np.linspace(10.0, 300.0, 30)
    added = sum(WATER.density * math.pi * r**2 * 0.02 for r in (0.065, 0.05))
    closed = 6e-4 * speed**2 / (4e4 - (4.0 + added) * speed**2 + 1j * rotor.damping * speed)
    for gravity in (0.0, 9.81):
        answer = response(rotor, fills(1e-4, 8e-5), speed, gravity)
        wet = ~answer.dry_patch
        assert answer.converged.all() and answer.stable.all()
        dry = 6e-4 * speed**2 / (4e4 - 4.0 * speed**2 + 1j * rotor.damping * speed)
        np.testing.assert_allclose(answer.deflection_dry, dry, rtol=1e-14)
        if gravity == 0.0:
            assert wet.all()
            np.testing.assert_allclose(answer.deflection, closed, rtol=1e-11)
            # The liquid's centre of mass from its first moment m_f |w| and its mass.
            offset = added * np.abs(closed) / (WATER.density * 1.8e-4)
            np.testing.assert_allclose(answer.liquid_offset, offset, rtol=1e-11)
            np.testing.assert_allclose(answer.liquid_angle, np.angle(closed), rtol=1e-11)


@kills(
    "solvers.rotor.jeffcott:Jeffcott.dynamic_stiffness",
    "- self.mass * np.square(speed) + 1j",
    "+ self.mass * np.square(speed) + 1j",
)
@kills(
    "solvers.rotor.jeffcott:Jeffcott.dynamic_stiffness",
    "+ 1j * self.damping * speed",
    "- 1j * self.damping * speed",
)
@kills(
    "solvers.synchronous.planar:with_phase",
    "pull = np.square(pairs.speed[which]) * state.unbalance",
    "pull = pairs.speed[which] * state.unbalance",
)
@kills(
    "solvers.synchronous.planar:all_deflections",
    "elastic = pairs.stiffness - (pairs.mass + pairs",
    "elastic = pairs.stiffness - (pairs.mass - pairs",
)
@kills(
    "solvers.synchronous.models:_touching",
    "1.0 + 4.0 * steep[which] * deflection",
    "1.0 + 2.0 * steep[which] * deflection",
)
def test_balance() -> None:
    """Every branch satisfies the vector balance of forces, with the liquid's law taken point by point."""
    for rotor, wet, speed, gravity in (
        (*folded(), 0.0),
        (rig(0.02, 3e-3), fills(1e-5, 1e-5), np.linspace(40.0, 250.0, 40), 0.0),
        (rig(0.02, 3e-3), fills(1e-5, 1e-5), np.linspace(40.0, 250.0, 40), 9.81),
        (
            rig(0.05, 2e-3),
            [Fill(Chamber(0.06, 0.03, inner_radius=0.05), WATER, 3e-5)],
            np.linspace(9.0, 200.0, 40),
            9.81,
        ),
    ):
        answer = response(rotor, wet, speed, gravity)
        assert answer.converged.all()
        rows, _ = np.nonzero(np.isfinite(answer.branch_deflection))
        w, spin = answer.branch_deflection[np.isfinite(answer.branch_deflection)], speed[rows]
        pull = np.zeros_like(spin)
        for fill in wet:
            state = equilibrium(fill.chamber, fill.volume, np.abs(w), spin, gravity)
            pull = pull + fill.liquid.density * state.unbalance()[0]
        left = rotor.dynamic_stiffness(spin) * w - spin**2 * pull * w / np.abs(w)
        # Near a fold the modulus is known to the square root of rounding; the balance still holds to it.
        scale = rotor.unbalance * spin**2
        np.testing.assert_allclose(left / scale, 1.0, atol=1e-9)


def test_vector_model() -> None:
    """Angles of the solved response balance at every speed, wet wall or dry patch [DR18, eq. 24]."""
    dry = np.zeros(0, dtype=bool)
    for rotor, wet in ((rig(0.1), fills(1e-5, 1e-5)), (rig(0.03, 3e-3), fills(1e-5, 8e-6))):
        speed = np.linspace(20.0, 250.0, 201)
        answer = response(rotor, wet, speed, 0.0)
        size = np.abs(answer.deflection)
        liquid = sum(
            WATER.density * equilibrium(f.chamber, f.volume, size, speed, 0.0).unbalance()[0] for f in wet
        )
        k = rotor.unbalance / liquid
        lag = deflection_lag(speed, rotor.mass, rotor.damping, rotor.stiffness)
        # In units of the larger unbalance; the angle itself is known to rounding.
        residual = balance_residual(-answer.liquid_angle, lag, k) / np.maximum(k, 1.0)
        np.testing.assert_allclose(residual, 0.0, atol=1e-12)
        dry = np.concatenate((dry, answer.dry_patch))
    assert dry.any() and not dry.all()


@kills("solvers.synchronous.planar:_one_way", "for slope in (a - rise, a)", "for slope in (a,)")
def test_all_branches() -> None:
    """As many branches as a fine scan of the balance sees."""
    rotor, wet, speed = folded()
    answer = response(rotor, wet, speed, 0.0)
    counts = np.isfinite(answer.branch_deflection).sum(axis=1)
    scan = np.linspace(0.0, 0.02, 40001)[1:]
    state = equilibrium(
        wet[0].chamber, wet[0].volume, scan, 1.0, 0.0
    )  # without gravity the speed is no matter
    pull = WATER.density * state.unbalance()[0]
    for k, spin in enumerate(speed):
        left = np.abs(rotor.dynamic_stiffness(spin) * scan - spin**2 * pull)
        crossings = np.count_nonzero(np.diff(np.sign(left - rotor.unbalance * spin**2)))
        assert counts[k] == crossings
    assert set(counts) == {1, 3}


@kills(
    "solvers.synchronous.planar:is_stable",
    "np.square(spin) * (own + state.slope)",
    "np.square(spin) * (own + secant)",
)
def test_middle_branch() -> None:
    """Of three branches the middle one is unstable, the others stable; the largest stable one is reported."""
    answer = response(*folded(), 0.0)
    three = np.isfinite(answer.branch_deflection).sum(axis=1) == 3
    assert three.any()
    np.testing.assert_array_equal(
        answer.branch_stable[three], np.tile([True, False, True], (np.count_nonzero(three), 1))
    )
    np.testing.assert_array_equal(answer.deflection[three], answer.branch_deflection[three, 2])
    assert answer.stable.all()


def _settle(rotor: Jeffcott, fill: Fill, spin: float, start: complex) -> complex:
    """Integrate a rotor whose liquid follows at once, from rest in the drum frame."""
    grid = np.linspace(1e-5, 0.03, 3000)
    state = equilibrium(fill.chamber, fill.volume, grid, spin, 0.0)
    secant = CubicSpline(grid, fill.liquid.density * state.unbalance()[0] / grid)
    elastic = complex(rotor.dynamic_stiffness(np.array(spin)))

    def rate(_: float, y: np.ndarray) -> np.ndarray:
        w, v = complex(y[0], y[1]), complex(y[2], y[3])
        added = float(secant(abs(w)))
        mass = rotor.mass + added
        force = rotor.unbalance * spin**2 - elastic * w + spin**2 * added * w
        a = (force - (2j * spin * mass + rotor.damping) * v) / mass
        return np.array([v.real, v.imag, a.real, a.imag])

    end = solve_ivp(rate, (0.0, 40.0), [start.real, start.imag, 0.0, 0.0], "DOP853", rtol=1e-6, atol=1e-9).y[
        :, -1
    ]
    return complex(end[0], end[1])


def test_time_integration_leaves_the_middle_branch() -> None:
    # Damping 100 rad/s * 0.003: what has found a stable branch has settled to exp(-12) of it after 40 s.
    rotor, wet = rig(0.003, 3e-4), fills(1.2e-5)
    speed = np.linspace(96.0, 99.0, 61)
    answer = response(rotor, wet, speed, 0.0)
    three = np.flatnonzero(np.isfinite(answer.branch_deflection).sum(axis=1) == 3)
    row = int(three[three.size // 2])
    low, middle, high = answer.branch_deflection[row]
    for nudge in (0.99, 1.01):
        end = _settle(rotor, wet[0], float(speed[row]), middle * nudge)
        assert min(abs(end - low), abs(end - high)) < 1e-3 * abs(end - middle)
    for outer in (low, high):
        end = _settle(rotor, wet[0], float(speed[row]), outer * 1.01)
        assert abs(end - outer) < 1e-3 * abs(outer)


def test_far_above_resonance() -> None:
    # |w| -> U0/(M + m_f) with the wall wet, U0/(M + m_l) + pull beyond it; the dry rotor -> U0/M.
    rotor, speed = rig(0.1), np.array([1e5])
    added = WATER.density * math.pi * 0.065**2 * 0.02
    answer = response(rotor, fills(1e-4), speed, 9.81)
    np.testing.assert_allclose(np.abs(answer.deflection), 6e-4 / (4.0 + added), rtol=1e-5)
    np.testing.assert_allclose(np.abs(answer.deflection_dry), 6e-4 / 4.0, rtol=1e-5)
    np.testing.assert_allclose(answer.liquid_angle, -math.pi, atol=1e-3)


def same(a: Response, b: Response) -> None:
    np.testing.assert_array_equal(a.deflection, b.deflection)


@kills(
    "solvers.synchronous.response:critical_speed",
    "rotor.stiffness - (rotor.mass + slope) * np.square(speed)",
    "rotor.stiffness - (rotor.mass - slope) * np.square(speed)",
)
def test_critical_speed() -> None:
    """Added mass of full chambers where the wall is wet, of a bowl where floor and lid decide otherwise."""
    added = sum(WATER.density * math.pi * r**2 * 0.02 for r in (0.065, 0.05))
    wet = critical_speed(rig(), fills(1e-4, 8e-5), gravity=0.0)
    assert wet == pytest.approx(math.sqrt(4e4 / (4.0 + added)), rel=1e-9)
    assert critical_speed(rig(), []) == pytest.approx(100.0, rel=1e-9)
    # A tall, slow chamber: U = (V + beta pi R^4/2) e, so Omega solves K = (M + rho (V + ...)) Omega^2.
    rotor, tall = Jeffcott(30.0, 30.0 * 8.0**2, 1.0, 0.0), Fill(Chamber(0.2, 0.5), WATER, 0.02)
    speed = critical_speed(rotor, [tall])
    bowl = WATER.density * (0.02 + speed**2 / (2 * 9.81) * math.pi * 0.2**4 / 2)
    assert (rotor.mass + bowl) * speed**2 == pytest.approx(rotor.stiffness, rel=1e-9)


def test_no_liquid_is_the_dry_rotor() -> None:
    speed = np.linspace(5.0, 400.0, 50)
    for wet in ([], fills(0.0), fills(0.0, 0.0)):
        answer = response(rig(), wet, speed)
        np.testing.assert_allclose(answer.deflection, answer.deflection_dry, rtol=1e-14)
        assert not answer.dry_patch.any() and answer.stable.all() and answer.converged.all()


def test_full_chamber_is_a_solid() -> None:
    speed = np.linspace(5.0, 400.0, 50)
    chamber = Chamber(0.065, 0.02)
    solid = WATER.density * chamber.capacity
    answer = response(rig(), [Fill(chamber, WATER, chamber.capacity)], speed)
    closed = 6e-4 * speed**2 / (4e4 - (4.0 + solid) * speed**2 + 1j * rig().damping * speed)
    np.testing.assert_allclose(answer.deflection, closed, rtol=1e-9)


def test_no_unbalance_stands_still() -> None:
    answer = response(rig(unbalance=0.0), fills(1e-5), [50.0, 100.0])
    assert not answer.deflection.any() and not answer.liquid_offset.any()
    assert answer.converged.all()


def test_undamped_resonance_is_said() -> None:
    rotor = Jeffcott(4.0, 4e4, 0.0, 6e-4)
    answer = response(rotor, [], [99.0, 100.0, 101.0])
    np.testing.assert_array_equal(answer.converged, [True, False, True])
    assert np.isinf(answer.deflection_dry[1].real)
    wet = response(rotor, fills(1e-5), [99.0, 100.0, 101.0], 0.0)
    assert wet.converged.all() and np.isfinite(wet.deflection).all()


@given(
    zeta=st.floats(0.003, 1.0),
    unbalance=st.floats(1e-6, 1e-2),
    volume=st.floats(1e-7, 2.6e-4),
    speed=st.floats(1.0, 1e4),
    gravity=st.sampled_from((0.0, 9.81)),
)
@settings(max_examples=60)
def test_there_is_always_an_odd_number_of_branches(
    zeta: float, unbalance: float, volume: float, speed: float, gravity: float
) -> None:
    answer = response(rig(zeta, unbalance), fills(volume), [speed], gravity)
    assert answer.converged.all()
    assert np.isfinite(answer.branch_deflection).sum() % 2 == 1
    # The damper alone bounds the deflection.
    assert np.abs(answer.deflection[0]) <= unbalance * speed / rig(zeta).damping * (1.0 + 1e-9)


def test_linear_model_says_where_it_ends() -> None:
    speed = np.linspace(60.0, 150.0, 40)
    exact = response(rig(0.03, 2e-3), fills(1e-5), speed, 0.0)
    linear = response(rig(0.03, 2e-3), fills(1e-5), speed, 0.0, model=Linear())
    inside = linear.in_range
    assert inside.any() and not inside.all()
    np.testing.assert_allclose(linear.deflection[inside], exact.deflection[inside], rtol=1e-9)


@pytest.mark.parametrize(("speed", "model"), [([0.0], "auto"), ([math.nan], "auto"), ([1.0], "long_wave")])
def test_bad_input(speed: list[float], model: str) -> None:
    with pytest.raises(InputError):
        response(rig(), [], speed, model=synchronous_model(model))
