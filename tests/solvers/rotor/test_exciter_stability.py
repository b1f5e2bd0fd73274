"""Small motions of stuck balls against the exact fold, Floquet's multipliers, and growth in time."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from meshes.arrays import Array
from meshes.errors import InputError
from solvers.rotor.exciter import machine as exciter
from solvers.rotor.exciter.machine import Dimensionless, characteristic_speeds, platform_motion, stuck_speeds
from solvers.rotor.exciter.motion import placed_state
from solvers.rotor.exciter.regimes import Kind, Place, regime
from solvers.rotor.exciter.stability import (
    capture_unbalance,
    parting_roots,
    resonance_speed,
    stuck_roots,
    third_speed,
)
from solvers.rotor.exciter.tangent import follow
from tests.mutants import kills

TYPICAL = Dimensionless(0.01, 0.4, 0.25, 0.03)
machines = st.builds(
    Dimensionless,
    smallness=st.floats(0.005, 0.05),
    drag=st.floats(0.1, 0.6),
    unbalance=st.floats(0.0, 1.0),
    damping=st.floats(0.01, 0.07),
)


def slope(machine: Dimensionless, stuck: float, share: float) -> float:
    """dn/dQ of eq. 1 by the complex step."""
    q, h = stuck + 1e-30j, machine.damping
    chi = share * h / machine.drag
    return float((q + chi * q**5 / ((1.0 - q**2) ** 2 + (2.0 * h * q) ** 2)).imag / 1e-30)


def check_product(machine: Dimensionless, stuck: float, share: float) -> None:
    """The product of the roots is eps b D dn/dQ: exact, for every speed of every branch.

    Five roots of a polynomial whose sizes differ by up to 1e3 keep some 1e-10 of their product.
    """
    product = np.prod(-stuck_roots(machine, stuck, share)) * (1.0 - 0.5 * machine.smallness * share)
    bell = (1.0 - stuck**2) ** 2 + (2.0 * machine.damping * stuck) ** 2
    scale = machine.smallness * machine.drag * bell
    assert product.imag == pytest.approx(0.0, abs=1e-9 * scale)
    size = abs(slope(machine, stuck, share)) + 1.0
    assert product.real / scale == pytest.approx(slope(machine, stuck, share), abs=1e-8 * size)


@given(machine=machines, stuck=st.floats(0.5, 3.0), share=st.sampled_from((0.25, 0.5, 1.0)))
def test_a_root_is_zero_where_stuck_speeds_merge(machine: Dimensionless, stuck: float, share: float) -> None:
    check_product(machine, stuck, share)


@kills("solvers.rotor.exciter.stability:stuck_roots", "- 2j * h * steady", "+ 2j * h * steady")
@kills("solvers.rotor.exciter.stability:stuck_roots", "np.array([-2.0 * q, 1j])", "np.array([2.0 * q, 1j])")
@kills("solvers.rotor.exciter.stability:stuck_roots", "0.5 * machine.smallness", "machine.smallness")
@pytest.mark.parametrize("stuck", [0.95, 2.0])
def test_product_of_the_typical_machine(stuck: float) -> None:
    check_product(TYPICAL, stuck, 0.5)


def multipliers(machine: Dimensionless, speed: float) -> tuple[float, Array]:
    """Period and the logarithms of Floquet's multipliers over it, of one ball without unbalance.

    The return map at each full turn of the ball, of the platform's place and velocity and the ball's speed,
    linearised by central differences around its fixed point.
    """
    numbers = machine.numbers(speed)

    def rate(time: float, at: Array) -> Array:
        out = np.zeros(4)
        exciter.rates(time, at, numbers, out)
        return out

    def turned(_time: float, at: Array) -> float:
        return float(at[2] - 2.0 * math.pi)

    turned.terminal = True  # type: ignore[attr-defined]

    def back(point: Array) -> tuple[float, Array]:
        begin = np.array([point[0], point[1], 0.0, point[2]])
        found = solve_ivp(rate, (0.0, 20.0), begin, "DOP853", events=turned, rtol=1e-12, atol=1e-13)
        end = found.y_events[0][0]
        return float(found.t_events[0][0]), end[[0, 1, 3]]

    def linear(point: Array) -> Array:
        steps = 1e-5 * np.eye(3)
        return np.stack([(back(point + d)[1] - back(point - d)[1]) / 2e-5 for d in steps], axis=1)

    stuck = float(stuck_speeds(speed, machine)[0])
    slow = platform_motion(machine, speed, stuck)[0]
    point = np.array([slow.imag, (1j * stuck * slow).imag, stuck])
    for _ in range(4):
        point = point + np.linalg.solve(np.eye(3) - linear(point), back(point)[1] - point)
    period = back(point)[0]
    return period, np.sort_complex(np.log(np.linalg.eigvals(linear(point)).astype(complex)) / period)


@kills("solvers.rotor.exciter.stability:stuck_roots", "complex(2.0 * h, 2.0 * q)", "complex(h, 2.0 * q)")
@kills(
    "solvers.rotor.exciter.stability:stuck_roots",
    "-1j * (share + steady)",
    "-1j * share",
)
def test_small_motions_against_floquet() -> None:
    """Three exact multipliers at each of two sizes of eps: the difference falls with eps.

    Left out are terms of the relative order eps times the platform's amplitude, here 10: some per cent.
    """
    off = []
    for eps in (0.002, 0.001):
        machine = Dimensionless(eps, 0.4, 0.0, 0.03)
        period, exact = multipliers(machine, 5.0)
        roots = stuck_roots(machine, float(stuck_speeds(5.0, machine)[0]))
        # The fast pair belongs to an envelope that turns backwards; one turn of the balls does not see it.
        slow = np.sort_complex(roots[np.abs(roots.imag) < 1.0])
        assert period == pytest.approx(2.0 * math.pi / 0.9465, rel=1e-3)
        off.append(float(np.max(np.abs(slow - exact))) / float(np.max(np.abs(exact))))
    assert off[1] < 0.02
    assert off[1] < 0.7 * off[0]


@settings(max_examples=40)
@given(machine=machines)
def test_the_slowest_branch_has_no_growing_root_up_to_the_merger(machine: Dimensionless) -> None:
    """Over the source's ranges no oscillation starts before the fold: the stuck motion cannot end in one."""
    known = characteristic_speeds(machine)
    for part in (0.05, 0.3, 0.6, 0.9, 0.99, 0.9999):
        speed = known.second_pair + part * (known.merger - known.second_pair)
        if math.isfinite(speed):
            assert stuck_roots(machine, float(stuck_speeds(speed, machine)[0]))[0].real < 0.0


@kills(
    "solvers.rotor.exciter.stability:parting_roots", "0.5 * machine.smallness * share", "machine.smallness"
)
@kills("solvers.rotor.exciter.stability:parting_roots", "(1.0 - stuck**2) / bell", "(stuck**2 - 1.0) / bell")
def test_balls_together_part_at_the_third_speed_and_not_at_the_resonance() -> None:
    """Growth of the difference of two balls in time against its root.

    Left out are terms of the relative order sqrt(eps)/5, by which the platform follows a growth of 1.4.
    """
    speed, machine = 8.0, Dimensionless(0.01, 0.4, 0.0, 0.03)
    against = np.array([0.0, 0.0, 1.0, -1.0, 0.0, 0.0])
    roots = stuck_speeds(speed, machine)
    apart = placed_state(machine, speed, [roots[2]] * 2, [0.0, 0.0])
    grown = follow(machine, speed, apart, 200.0, against, blocks=4).growth[-2:].mean()
    assert grown == pytest.approx(parting_roots(machine, float(roots[2]))[0].real, rel=0.03)
    together = placed_state(machine, speed, [roots[0]] * 2, [0.0, 0.0])
    # A pair of complex roots: the disturbance's length swings by a factor of 5, over 8000 this is a tenth of
    # the rate. Rounding feeds the neutral motion of both balls alike, which takes over after some 1.8e4.
    kept = follow(machine, speed, together, 12000.0, against, blocks=3).growth[-2:].mean()
    assert kept == pytest.approx(parting_roots(machine, float(roots[0]))[0].real, rel=0.15)


@given(machine=machines, share=st.sampled_from((0.25, 0.5, 1.0)), stuck=st.floats(0.5, 30.0))
def test_balls_part_above_the_natural_frequency_only(
    machine: Dimensionless, share: float, stuck: float
) -> None:
    growing = parting_roots(machine, stuck, share)[0].real > 0.0
    assert growing == (stuck > 1.0)


@kills(
    "solvers.rotor.exciter.stability:capture_unbalance",
    "math.pi**2 / 8.0",
    "math.pi**2 / 4.0",
)
@kills(
    "solvers.rotor.exciter.stability:capture_unbalance",
    "(1.0 - third / speed) ** 2",
    "(1.0 - third / speed)",
)
@kills("solvers.rotor.exciter.stability:third_speed", "math.sqrt(share)", "share")
@pytest.mark.parametrize("drag", [0.25, 0.4])
def test_an_unbalance_catches_a_ball_that_passes_too_slowly(drag: float) -> None:
    """In time, a fifth below the bound a ball goes on at the third speed, a quarter above it is caught.

    The bound is that of weak drag; the other ball's vibration shakes it by some per cent.
    """
    speed = 8.0
    bound = capture_unbalance(Dimensionless(0.01, drag, 0.0, 0.03), speed, 0.5)
    for factor, place in ((0.8, Place.THIRD), (1.25, Place.SHAFT)):
        machine = Dimensionless(0.01, drag, factor * bound, 0.03)
        speeds = resonance_speed(machine, speed, 0.5), third_speed(machine, speed, 0.5)
        found = regime(machine, speed, placed_state(machine, speed, speeds, (0.0, 0.0)))
        assert found.places == (Place.RESONANCE, place)
        assert found.kind is (Kind.THIRD if place is Place.THIRD else Kind.PART_STUCK)


def test_shares_out_of_range_are_refused() -> None:
    for call in (
        lambda: stuck_roots(TYPICAL, 0.95, 0.0),
        lambda: parting_roots(TYPICAL, 0.95, 1.5),
        lambda: capture_unbalance(TYPICAL, 8.0, -1.0),
        lambda: third_speed(TYPICAL, 8.0, 2.0),
        lambda: resonance_speed(TYPICAL, 8.0, math.nan),
    ):
        with pytest.raises(InputError, match="share"):
            call()
    # Below the first characteristic speed there is no third speed to be caught from.
    assert math.isnan(third_speed(TYPICAL, 0.9))
    assert math.isnan(capture_unbalance(TYPICAL, 0.9, 0.5))
