"""Friction of channels against the laws it joins, and the spin-up by an independent integration."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from fluid.friction.pipe import (
    Regime,
    drag_speed,
    friction_factor,
    hydraulic_diameter,
    regime,
    spin_up_time,
    steady_lag,
)
from tests.mutants import kills

_SHARES = (0.5, 0.1, 0.05)
# R, h, h_c, nu and Omega of a layer at rest in space, and when its lag is down to a half, a tenth and a
# twentieth: computed beside the package, to the digits shown.
CASES = (
    (0.24, 0.0137, 0.060, 1.6e-6, 6.6, (1.950, 12.97, 26.25)),
    (0.24, 0.0137, 0.060, 1.6e-6, 40.0, (0.479, 3.371, 6.21)),
    (0.24, 0.0137, 0.060, 1.6e-6, 125.0, (0.190, 1.374, 2.57)),
    (0.15, 0.0150, 0.050, 1.0e-6, 40.0, (0.763, 5.372, 9.89)),
)


@kills("fluid.friction.pipe:friction_factor", "math.log(8.0) - np", "math.log(9.0) - np")
def test_slow_flow_is_that_of_hagen_and_poiseuille() -> None:
    re = np.geomspace(1e-200, 1000.0, 300)
    # The turbulent branch adds (A + B)^-1.5 to (8/Re)^12: at 1000 less than 1e-9 of it.
    np.testing.assert_allclose(friction_factor(re) * re, 64.0, rtol=1e-8)


@kills("fluid.friction.pipe:friction_factor", "-2.457", "-2.557")
@kills("fluid.friction.pipe:friction_factor", "7.0 / re", "9.0 / re")
@kills("fluid.friction.pipe:friction_factor", "0.27 * rough", "0.37 * rough")
def test_turbulent_flow_is_that_of_colebrook() -> None:
    """1/sqrt(f) = -2 log10(eps/(3.7 D) + 2.51/(Re sqrt(f))), solved; smooth it is that of Prandtl and Karman.

    Churchill states the departure of his formula as a few per cent.
    """
    for rough in (0.0, 1e-4, 1e-3, 1e-2):
        for reynolds in (1e4, 1e5, 1e6, 1e7):

            def gap(x: float, rough: float = rough, reynolds: float = reynolds) -> float:
                return x + 2.0 * math.log10(rough / 3.7 + 2.51 * x / reynolds)

            wanted = brentq(gap, 1.0, 30.0) ** -2
            assert friction_factor(reynolds, rough) == pytest.approx(wanted, rel=0.035)


@kills("fluid.friction.pipe:friction_factor", "math.log(37530.0)", "math.log(3753.0)")
def test_the_change_is_between_the_two_numbers_of_the_regimes() -> None:
    # At 2e3 laminar, at 2900 on the way up, at 1e4 that of Blasius (0.3164/Re^0.25, to 3 % there).
    assert friction_factor(2000.0) == pytest.approx(0.032, rel=0.01)
    assert 0.023 < friction_factor(2900.0) < 0.044
    assert friction_factor(1e4) == pytest.approx(0.03164, rel=0.03)
    found = [regime(x) for x in (0.0, 2099.0, 2100.0, 3999.0, 4000.0, math.inf)]
    assert found == [Regime.LAMINAR] * 2 + [Regime.TRANSITION] * 2 + [Regime.TURBULENT] * 2


def test_a_rough_wall_at_last_forgets_the_viscosity() -> None:
    # 8/(2.457 ln(1/(0.27 e)))^2, what is left of the formula.
    for rough in (1e-5, 1e-3, 0.05):
        wanted = 8.0 / (2.457 * math.log(1.0 / (0.27 * rough))) ** 2
        assert friction_factor(math.inf, rough) == pytest.approx(wanted, rel=1e-12)
    assert friction_factor(math.inf) == 0.0


@given(
    st.floats(-300.0, 12.0).map(lambda x: 10.0**x),
    st.floats(0.0, 1e6),
)
def test_no_number_overflows(reynolds: float, rough: float) -> None:
    found = float(friction_factor(max(reynolds, 1e-300), rough))
    # No less than laminar flow has, but for the rounding of the logarithms, whose sums are up to 1e4.
    assert 64.0 / max(reynolds, 1e-300) * (1.0 - 1e-10) <= found < 1e303


@given(
    st.floats(-300.0, 300.0).map(lambda x: 10.0**x),
    st.floats(1e-6, 1.0),
    st.sampled_from([0.0, 1e-12, 1e-6, 1e-2, 1e3]),
    st.floats(0.0, 0.1),
)
def test_the_drag_is_a_number_everywhere(u: float, diameter: float, nu: float, rough: float) -> None:
    found = float(drag_speed(u, diameter, nu, rough))
    assert math.isfinite(found)
    assert found >= 8.0 * nu / diameter * (1.0 - 1e-10)


@kills("fluid.friction.pipe:hydraulic_diameter", "1.0 + 2.0 * h", "1.0 + h")
@kills("fluid.friction.pipe:hydraulic_diameter", "4.0 * h", "2.0 * h")
def test_hydraulic_diameter_is_of_wall_floor_and_lid() -> None:
    h, height = 0.0137, 0.06
    assert hydraulic_diameter(h, height) == pytest.approx(4.0 * h * height / (height + 2.0 * h), rel=1e-14)
    assert hydraulic_diameter(h, math.inf) == 4.0 * h


@kills("fluid.friction.pipe:spin_up_time", "0.25 * diameter", "0.5 * diameter")
@kills("fluid.friction.pipe:drag_speed", "8.0 * nu / d", "12.0 * nu / d")
@kills("fluid.friction.pipe:drag_speed", "* u / 8.0", "* u / 2.0")
@pytest.mark.parametrize(("radius", "depth", "height", "nu", "spin", "printed"), CASES)
def test_spin_up_by_an_ode_and_by_numbers_from_elsewhere(
    radius: float, depth: float, height: float, nu: float, spin: float, printed: tuple[float, ...]
) -> None:
    diameter = 4.0 * depth * height / (height + 2.0 * depth)
    found = spin_up_time(_SHARES, spin * radius, diameter, nu)
    np.testing.assert_allclose(found, printed, rtol=2e-3)  # their digits

    def slowed(_: float, u: np.ndarray) -> np.ndarray:
        return -0.5 * friction_factor(u * diameter / nu) * u * u / diameter

    start = np.array([spin * radius])
    way = solve_ivp(slowed, (0.0, 1.01 * found[-1]), start, rtol=1e-9, atol=1e-12, dense_output=True)
    for share, time in zip(_SHARES, found.tolist(), strict=True):
        # The trapezium over 2000 steps of ln u: 1e-6 of it, more at the corner of the transition.
        assert way.sol(time)[0] == pytest.approx(share * start[0], rel=1e-4)
    # Down to where it is laminar, which is exponential: tau = D^2/(32 nu).
    late = spin_up_time([1e-8, 1e-9], 1e-3 * nu / diameter, diameter, nu)
    assert late[1] - late[0] == pytest.approx(math.log(10.0) * diameter**2 / (32.0 * nu), rel=1e-6)


def test_without_a_lag_or_without_friction() -> None:
    assert spin_up_time(0.5, 0.0, 0.03, 1e-6) == 0.0
    assert spin_up_time([1.0, 0.5], 1.0, 0.03, 0.0).tolist() == [0.0, math.inf]


@kills("fluid.friction.pipe:steady_lag", "4.0 * drag", "2.0 * drag")
@kills("fluid.friction.pipe:steady_lag", "acceleration * radius", "acceleration")
def test_a_lag_that_keeps_up_with_a_ramp() -> None:
    """dOmega/dt R = (f_D/2) u^2/D_h, turbulent; in laminar flow it is 32 nu u/D_h^2."""
    u, diameter = steady_lag(7.0, 0.24, 0.0376, 1.6e-6), 0.0376
    factor = float(friction_factor(u * diameter / 1.6e-6))
    assert 0.5 * factor * u**2 / diameter == pytest.approx(7.0 * 0.24, rel=1e-9)
    assert steady_lag(1e-6, 0.2, 0.03, 1e-3) == pytest.approx(2e-7 * 0.03**2 / 32e-3, rel=1e-9)
    assert (steady_lag(0.0, 0.2, 0.03, 1e-6), steady_lag(1.0, 0.2, 0.03, 0.0)) == (0.0, math.inf)
