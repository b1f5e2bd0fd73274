"""Stuck speeds: roots of the quintic, their number, the speeds where it changes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from meshes.errors import InputError
from solvers.rotor.exciter.machine import (
    Dimensionless,
    characteristic_speeds,
    lag_number,
    shaft_speed,
    stuck_speeds,
)
from solvers.rotor.exciter.motion import printed_critical_speed
from tests.mutants import kills
from tests.oracles.exciter import approximate_speeds

MACHINE = Dimensionless(0.01, 0.4, 0.25, 0.03)


def quintic(machine: Dimensionless, n: float, together: float = 1.0) -> list[float]:
    """Coefficients as the source prints them, highest power first [YF17, eq. 9], with chi = A^2 h/b."""
    h, chi = machine.damping, together**2 * machine.damping / machine.drag
    return [1 + chi, -n, -2 * (1 - 2 * h * h), 2 * n * (1 - 2 * h * h), 1, -n]


@kills(
    "solvers.rotor.exciter.machine:lag_number",
    "return together**2 * machine.damping",
    "return together * machine.drag",
)
def test_printed_roots() -> None:
    """[YF17, section 5.3]: 0.9465, 1.0732, 4.61875 at n = 5; further digits from the quintic's roots."""
    found = stuck_speeds(5.0, MACHINE)
    assert found == pytest.approx([0.94653, 1.07323, 4.61875], abs=5e-6)
    exact = np.sort(np.roots(quintic(MACHINE, 5.0)).real[np.abs(np.roots(quintic(MACHINE, 5.0)).imag) < 1e-9])
    assert found == pytest.approx(exact, rel=1e-12)  # simple roots: rounding times their condition


@kills("solvers.rotor.exciter.machine:shaft_speed", "np.square(2.0 * h * q)", "np.square(h * q)")
@kills("solvers.rotor.exciter.machine:_turning_points", "4.0 * h * h - 2.0", "2.0 * h * h - 2.0")
@kills("solvers.rotor.exciter.machine:_turning_points", "polysub(5.0 * bell", "polysub(4.0 * bell")
def test_printed_characteristic() -> None:
    """[YF17, section 5.3]: 21.833 and 21.877, five digits."""
    known = characteristic_speeds(MACHINE)
    assert known.through_resonance == pytest.approx(21.833, abs=5e-4)
    assert known.merger == pytest.approx(21.877, abs=5e-4)
    # At the ends the quintic has a double root: its derivative vanishes there as well.
    for n in (known.second_pair, known.merger):
        roots = np.roots(quintic(MACHINE, n))
        real = roots[np.abs(roots.imag) < 1e-5].real
        assert real.size == 3 and np.min(np.diff(np.sort(real))) < 1e-5  # sqrt of rounding
    # With n2 the slowest stands at the natural frequency.
    assert stuck_speeds(known.through_resonance, MACHINE)[0] == pytest.approx(1.0, abs=1e-12)


@kills("solvers.rotor.exciter.machine:shaft_speed", "chi * q**5 /", "chi * q**4 /")
def test_balance() -> None:
    """Torque of the platform against the drag, by quadrature over a turn with the motion of the platform.

    b (n - Q) = mean of v'' cos(phi) with its sign, A = 1: the mean of a product of two harmonics, exact by
    the rectangle rule.
    """
    from solvers.rotor.exciter.machine import platform_motion

    n = 3.0
    for q in stuck_speeds(n, MACHINE):
        slow, _ = platform_motion(MACHINE, n, float(q))
        angle = np.linspace(0.0, 2.0 * math.pi, 16, endpoint=False)
        push = -(q**2) * (slow * np.exp(1j * angle)).imag
        assert np.mean(push * np.cos(angle)) == pytest.approx(MACHINE.drag * (n - q), rel=1e-10)


def test_expansion() -> None:
    """The expansions fall short by the next order: factor 16 and more for chi and h falling together.

    n1 is off by order chi^(4/3): chi by 64 is a factor 256 of it; n3 by chi^3, h^2 chi^2 and h^4/chi.
    """
    errors = []
    for shrink in (1.0, 1.0 / 64.0):
        chi, h = 1e-2 * shrink, 1e-3 * shrink
        machine = Dimensionless(0.01, h / chi, 0.25, h)
        exact, near = characteristic_speeds(machine), approximate_speeds(machine)
        errors.append(abs(near.second_pair - exact.second_pair))
        assert near.through_resonance == pytest.approx(exact.through_resonance, rel=1e-14)
        # The next terms are chi^2, h^2 chi^2 and h^4/chi; rounding of n3 itself beside them.
        assert near.merger - exact.merger == pytest.approx(
            0.0, abs=h**2 * chi + 3 * h**4 / chi + 1e-14 * exact.merger
        )
    assert 128.0 < errors[0] / errors[1] < 512.0


@kills(
    "solvers.rotor.exciter.motion:printed_critical_speed",
    "(4.0 * (b + eps * second)",
    "(2.0 * (b + eps * second)",
)
def test_regression() -> None:
    """The printed function at the source's worked numbers: 7.0, with its error of 6 %."""
    assert float(printed_critical_speed(0.01, 0.4, 0.25, 0.03)) == pytest.approx(7.0, rel=0.06)
    # For eps = 0 it is n2 [YF17, section 5.5].
    assert float(printed_critical_speed(0.0, 0.4, 0.25, 0.03)) == pytest.approx(1.0 + 1.0 / (4 * 0.4 * 0.03))


@kills("solvers.rotor.exciter.motion:printed_critical_speed", "(h + eps * third)", "(h - eps * third)")
@kills("solvers.rotor.exciter.motion:printed_critical_speed", "(1.0 + eps * first)", "(1.0 - eps * first)")
def test_regression_by_hand() -> None:
    """One value by long-hand arithmetic from the printed coefficients."""
    e, b, d, h = 0.02, 0.3, 0.5, 0.05
    g1 = (1 - 26.5235 * d - 16.7424 * h - 30.1288 * b) / (-0.2537 - 0.8080 * d - 3.9439 * h + 0.6984 * b)
    g2 = (1 + 1.7134 * d + 8.2055 * h - 28.7751 * b) / (-0.3455 - 0.5673 * d + 4.3034 * h + 8.2679 * b)
    g3 = (1 - 9.2714 * d + 229.7664 * h + 43.5133 * b) / (-0.0992 + 2.4911 * d + 35.3149 * h - 0.1019 * b)
    value = 1 + (1 + e * g1) / (4 * (b + e * g2) * (h + e * g3))
    assert float(printed_critical_speed(e, b, d, h)) == pytest.approx(value, rel=1e-13)


@given(st.floats(0.05, 2.0), st.floats(0.005, 0.5), st.floats(0.05, 200.0), st.floats(0.1, 1.0))
def test_roots_are_those_of_the_quintic(b: float, h: float, n: float, together: float) -> None:
    """As many as the eigenvalues say, away from double roots, each solving the quintic to rounding."""
    machine = Dimensionless(0.01, b, 0.25, h)
    found = stuck_speeds(n, machine, together)
    found = found[np.isfinite(found)]
    known = characteristic_speeds(machine, together)
    three = known.second_pair < n < known.merger
    near = any(abs(n - edge) < 1e-9 * n for edge in (known.second_pair, known.merger) if math.isfinite(edge))
    assert near or found.size == (3 if three else 1)
    assert np.all((found > 0.0) & (found <= n))
    assert shaft_speed(found, machine, together) == pytest.approx(np.full(found.shape, n), rel=1e-9)
    for q in found:
        terms = [c * q ** (5 - k) for k, c in enumerate(quintic(machine, n, together))]
        assert abs(sum(terms)) <= 1e-10 * sum(map(abs, terms))


@given(st.floats(0.05, 2.0), st.floats(1e-4, 0.7))
def test_the_number_changes_at_the_characteristic_speeds(b: float, h: float) -> None:
    """Just inside there are three real eigenvalues of the quintic, just outside one."""
    machine = Dimensionless(0.01, b, 0.25, h)
    known = characteristic_speeds(machine)
    if math.isnan(known.merger) or known.merger / known.second_pair < 1.0 + 1e-6:
        return
    step = 1e-5 * min(known.merger - known.second_pair, 1.0)
    for n, count in (
        (known.second_pair - step, 1),
        (known.second_pair + step, 3),
        (known.merger - step, 3),
        (known.merger + step, 1),
    ):
        assert np.isfinite(stuck_speeds(n, machine)).sum() == count


def test_heavy_damping_leaves_one_stuck_speed() -> None:
    machine = Dimensionless(0.01, 2.0, 0.25, 0.7)
    assert math.isnan(characteristic_speeds(machine).merger)
    assert np.isfinite(stuck_speeds([0.5, 2.0, 50.0], machine)).sum(axis=1).tolist() == [1, 1, 1]


def test_balls_opposite_do_not_stick() -> None:
    """With A = 0 the balls feel nothing and run with the shaft."""
    assert shaft_speed(2.0, MACHINE, together=0.0) == 2.0
    assert lag_number(MACHINE, 0.0) == 0.0


def test_bad_input_is_named() -> None:
    with pytest.raises(InputError):
        stuck_speeds([1.0, 0.0], MACHINE)
    for b, h in ((0.0, 0.03), (0.4, 0.0)):
        with pytest.raises(InputError):
            stuck_speeds(1.0, Dimensionless(0.01, b, 0.0, h))
    with pytest.raises(InputError):
        lag_number(MACHINE, 1.5)
