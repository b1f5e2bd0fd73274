import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fluid.printed import liquid_angle_as_printed
from meshes.errors import InputError
from solvers.rotor.vector_model import (
    balance_angles,
    balance_residual,
    deflection_lag,
    unbalance_left,
)
from tests.mutants import kills

EPS = np.finfo(float).eps


def total_over_liquid(angle: np.ndarray, lag: np.ndarray, ratio: np.ndarray) -> np.ndarray:
    """Total unbalance over the liquid's, along the direction that the deflection lags by delta.

    cos(delta) + k cos(alpha - delta), the real part of (1 + k e^{i alpha}) e^{-i delta}. A root of
    `balance_residual` is an equilibrium where this is 0 or above; below, the deflection points away from the
    side that the support allows [theory: rotor, eq. 12].

    Parameters
    ----------
    angle, lag, ratio : as in `balance_residual`

    Returns
    -------
    |U_0 + U_liq|/U_liq with its sign, shape (...,)
    """
    alpha, delta, k = (np.asarray(x, dtype=float) for x in (angle, lag, ratio))
    return np.asarray(np.cos(delta) + k * np.cos(alpha - delta))


def eq_24(alpha: np.ndarray, delta: np.ndarray, k: np.ndarray) -> np.ndarray:
    """DR18, eq. 24 as it stands, times k."""
    return k * np.sin(alpha) - np.sin(delta) * np.sqrt(np.maximum(1.0 + 2.0 * k * np.cos(alpha) + k**2, 0.0))


# k from sin(delta), below which nothing balances, upward.
balance_cases = {"delta": st.floats(0.0, np.pi), "excess": st.floats(0.0, 5.0)}


@given(**balance_cases)
def test_both_angles_balance_the_tangential_forces(delta: float, excess: float) -> None:
    k = np.sin(delta) + excess + 1e-6
    for alpha in balance_angles(delta, k):
        # Rounding of the angles (up to 2 pi) times k; arcsin near its end at 1 halves the digits of the
        # angle but not of its sine.
        assert abs(balance_residual(alpha, delta, k)) <= 20 * EPS * (1.0 + k)


@given(**balance_cases)
def test_equilibria_satisfy_the_equation_of_the_source(delta: float, excess: float) -> None:
    k = np.sin(delta) + excess + 1e-6
    for alpha in balance_angles(delta, k):
        if total_over_liquid(alpha, delta, k) >= 0.0:
            # The radicand is a square whose rounding, (1 + k)^2 eps, goes into its root in full near 0.
            slack = 4.0 * np.sqrt(EPS) * np.sin(delta) * (1.0 + k) + 20 * EPS * (1.0 + k)
            assert abs(eq_24(alpha, delta, k)) <= slack


@given(**balance_cases)
def test_cosines_are_the_roots_of_the_squared_equation(delta: float, excess: float) -> None:
    k = np.sin(delta) + excess + 1e-6
    sine2 = np.sin(delta) ** 2
    root = np.sqrt(max((sine2 - 1.0) * (sine2 - k**2), 0.0))
    want = sorted([(-sine2 - root) / k, (-sine2 + root) / k])
    got = sorted(float(np.cos(alpha)) for alpha in balance_angles(delta, k))
    # k^2 - sin^2 loses digits towards k = sin(delta), and so does the arcsine, by half.
    np.testing.assert_allclose(got, want, rtol=0, atol=1e-7)


def test_which_roots_are_equilibria() -> None:
    first, second = balance_angles(np.array([0.4, 0.4, 2.5, 2.5]), np.array([0.9, 2.0, 0.9, 2.0]))
    lag, ratio = np.array([0.4, 0.4, 2.5, 2.5]), np.array([0.9, 2.0, 0.9, 2.0])
    assert (total_over_liquid(first, lag, ratio) > 0.0).tolist() == [True, True, False, True]
    assert (total_over_liquid(second, lag, ratio) > 0.0).tolist() == [True, False, False, False]


def jeffcott(
    omega: np.ndarray, mass: float, added: float, damping: float, stiffness: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Angle, lag and ratio of the rotor with the liquid's added mass, from its equation of motion."""
    u0 = 0.02
    w = omega**2 * u0 / (stiffness - (mass + added) * omega**2 + 1j * damping * omega)
    return -np.angle(w), deflection_lag(omega, mass, damping, stiffness), u0 / (added * np.abs(w))


@settings(max_examples=60)
@given(
    added=st.floats(0.01, 2.0),
    zeta=st.floats(0.001, 2.0),
    speeds=st.lists(st.floats(0.05, 20.0), min_size=1, max_size=8),
)
def test_jeffcott_rotor_with_added_mass(added: float, zeta: float, speeds: list[float]) -> None:
    assert_jeffcott(added, zeta, np.array(speeds))


def assert_jeffcott(added: float = 0.3, zeta: float = 0.1, speeds: np.ndarray | None = None) -> None:
    """The angles of the solved equation of motion are in balance at every speed."""
    omega = np.linspace(0.1, 5.0, 50) if speeds is None else speeds
    alpha, delta, k = jeffcott(omega, 1.0, added, 2.0 * zeta, 1.0)
    assert np.all(np.abs(balance_residual(alpha, delta, k)) <= 20 * EPS * (1.0 + k))
    assert np.all(total_over_liquid(alpha, delta, k) > 0.0)
    np.testing.assert_array_less(np.abs(eq_24(alpha, delta, k)), 4 * np.sqrt(EPS) * (1.0 + k))
    roots = np.array(balance_angles(delta, k))
    # Where the two roots meet, the arcsine keeps half of the digits.
    assert np.all(np.abs(roots - alpha).min(axis=0) <= 4 * np.sqrt(EPS))
    # The unbalance left is that which bends the dry rotor as far.
    dry = np.abs(1.0 - omega**2 + 2j * zeta * omega) / omega**2
    np.testing.assert_allclose(
        unbalance_left(alpha, k), dry / (k * added), rtol=0, atol=1e-12 * (1 + 1 / k.min())
    )


@kills("solvers.rotor.vector_model:balance_angles", "delta + np.pi - inner", "delta - np.pi - 2.0 * inner")
def test_second_root_between_the_critical_speeds() -> None:
    """Between the critical speeds with and without liquid the answer is the second root, else the first."""
    omega, added = np.array([0.5, 0.8, 0.95, 1.5]), 1.0
    alpha, delta, k = jeffcott(omega, 1.0, added, 0.02, 1.0)
    first, second = balance_angles(delta, k)
    nearer = np.abs(second - alpha) < np.abs(first - alpha)
    assert nearer.tolist() == [False, True, True, False]
    assert np.all(k[1:3] < 1.0)


@kills("solvers.rotor.vector_model:deflection_lag", "k - m * np.square(omega)", "k + m * np.square(omega)")
def test_lag() -> None:
    # At the dry resonance 90 deg whatever the damping; far above it 180 deg.
    assert float(deflection_lag(10.0, 2.0, 3.0, 200.0)) == pytest.approx(np.pi / 2, rel=1e-15)
    # tan = 3*5/(200 - 50)
    assert float(deflection_lag(5.0, 2.0, 3.0, 200.0)) == pytest.approx(np.arctan(0.1), rel=1e-14)
    assert float(deflection_lag(1e6, 2.0, 3.0, 200.0)) == pytest.approx(np.pi, abs=1e-5)


def test_equal_unbalances() -> None:
    """k = 1: an isosceles triangle, alpha = 2 delta, and the opposite liquid."""
    delta = np.array([0.1, 0.7, 1.5])
    first, second = balance_angles(delta, 1.0)
    np.testing.assert_allclose(first, 2.0 * delta, rtol=1e-13)
    np.testing.assert_allclose(second, np.pi, rtol=1e-13)
    np.testing.assert_allclose(unbalance_left(first, 1.0), 2.0 * np.cos(delta), rtol=1e-12)


def test_printed_solution_holds_only_for_equal_unbalances() -> None:
    for delta in (0.3, 1.0):
        assert abs(balance_residual(liquid_angle_as_printed(delta, 1.0), delta, 1.0)) < 1e-7
        for k in (0.9, 0.95):
            printed = liquid_angle_as_printed(delta, k)
            # Five orders above what a balance leaves; it shrinks towards k = sin(delta) and k = 1.
            assert abs(balance_residual(printed, delta, k)) > 0.01
            assert abs(eq_24(printed, delta, k)) > 0.01


def test_no_damping_no_angle() -> None:
    first, second = balance_angles(0.0, [0.5, 1.0, 3.0])
    np.testing.assert_array_equal(first, 0.0)
    np.testing.assert_allclose(second, np.pi, rtol=1e-15)


@pytest.mark.parametrize(
    ("call", "field"),
    [
        (lambda: balance_angles(-0.1, 1.0), "lag"),
        (lambda: balance_angles(np.nan, 1.0), "lag"),
        (lambda: balance_angles(1.0, 0.5), "ratio"),
        (lambda: balance_angles(0.0, 0.0), "ratio"),
        (lambda: unbalance_left(1.0, 0.0), "ratio"),
    ],
)
def test_bad_input(call, field: str) -> None:
    with pytest.raises(InputError) as caught:
        call()
    assert caught.value.field == field


@kills(
    "solvers.rotor.vector_model:balance_residual", "k * np.sin(alpha - delta)", "k * np.sin(alpha + delta)"
)
@kills(
    "solvers.rotor.vector_model:balance_angles", "np.arcsin(np.sin(delta) / k)", "np.arcsin(np.sin(delta))"
)
@kills("solvers.rotor.vector_model:unbalance_left", "k * np.sin(alpha)) / k)", "k * np.sin(alpha)))")
def test_jeffcott_rotor_with_three_tenths_of_added_mass() -> None:
    assert_jeffcott()
