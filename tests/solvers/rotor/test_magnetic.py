"""The rotor in magnetic bearings: equations of motion derived again, magnets, motor, energy."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from meshes.errors import InputError
from solvers.rotor.magnetic.control import Uncontrolled
from solvers.rotor.magnetic.machine import Magnets, dimensionless, motor_length, screw_drag
from solvers.rotor.magnetic.motion import Ending, SpeedLaw, integrate
from tests.mutants import kills
from tests.oracles.blood_pump import MAGNETS, ROTOR

AT = "solvers.rotor.magnetic.machine:"


@cache
def euler_equations() -> tuple[Any, ...]:
    """Force and moments that the rotor's motion needs, to first order, from H = R I R^T omega."""
    import sympy as sp

    t, small = sp.symbols("t small")
    m, across, along, e, tilt = sp.symbols("m I_x I_z e gamma")
    x, y, a, b, phi = (sp.Function(name)(t) for name in ("x", "y", "alpha", "beta", "phi"))

    def turn(axis: int, angle: Any) -> Any:
        i, j = [(1, 2), (2, 0), (0, 1)][axis]
        found = sp.eye(3)
        found[i, i] = found[j, j] = sp.cos(angle)
        found[i, j], found[j, i] = -sp.sin(angle), sp.sin(angle)
        return found

    # Lean by small angles about the fixed axes, spin; the principal axes lean by gamma about the body's x.
    # Products of two small angles are left out, so their order does not matter.
    lean = sp.Matrix([[1, 0, small * b], [0, 1, -small * a], [-small * b, small * a, 1]])
    body = lean * turn(2, phi)
    principal = body * sp.Matrix([[1, 0, 0], [0, 1, -small * tilt], [0, small * tilt, 1]])
    spin = sp.Matrix([small * (a.diff(t)), small * (b.diff(t)), 0]) + phi.diff(t) * lean[:, 2]
    momentum = principal * sp.diag(across, across, along) * principal.T * spin
    centre = sp.Matrix([x, y]) * small + small * e * sp.Matrix([sp.cos(phi), sp.sin(phi)])
    needed = [*(m * centre.diff(t, 2)), *momentum.diff(t)[:2]]
    first = [sp.diff(sp.expand(part), small).subs(small, 0) for part in needed]
    return first, (m, across, along, e, tilt), (x, y, a, b, phi), t


@kills(
    AT + "MagneticRotor.gyroscopic",
    "self.polar_inertia, -self.polar_inertia",
    "-self.polar_inertia, self.polar_inertia",
)
@kills(
    AT + "MagneticRotor.unbalance",
    "self.transverse_inertia - self.polar_inertia",
    "self.polar_inertia - self.transverse_inertia",
)
@kills(AT + "MagneticRotor.unbalance_load", "speed**2 - 1j", "speed**2 + 1j")
def test_equations_of_motion() -> None:
    """Inertia, gyroscopic terms and unbalances against the derivative of momentum; rounding only."""
    import sympy as sp

    first, letters, motion, t = euler_equations()
    values = (
        ROTOR.mass,
        ROTOR.transverse_inertia,
        ROTOR.polar_inertia,
        ROTOR.eccentricity,
        ROTOR.inertia_tilt,
    )
    q = np.array([3e-5, -2e-5, 1e-3, 2e-3])
    v, w = np.array([0.01, 0.02, -0.3, 0.7]), np.array([5.0, -7.0, 300.0, -800.0])
    angle, speed, rate = 0.7, 940.0, 460.0
    names = dict(zip(letters, values, strict=True))
    for part, known in zip(motion, zip([*q, angle], [*v, speed], [*w, rate], strict=True), strict=True):
        names |= {part.diff(t, 2): known[2], part.diff(t): known[1], part: known[0]}
    order = sorted(names, key=lambda key: -sp.count_ops(key) if key.has(sp.Derivative) else 1)
    # Derivatives of higher order are put in first.
    order.sort(key=lambda key: -key.derivative_count if isinstance(key, sp.Derivative) else 0)
    needed = np.array([float(part.subs([(key, names[key]) for key in order])) for part in first])
    found = ROTOR.inertia * w + speed * ROTOR.gyroscopic @ v + rate * ROTOR.gyroscopic @ q
    found = found - ROTOR.unbalance_load(angle, speed, rate)
    np.testing.assert_allclose(found, needed, rtol=1e-11, atol=1e-13 * np.abs(needed).max())


@kills(AT + "MagneticRotor.bearing_motion", "(0, 1, -z, 0)", "(0, 1, z, 0)")
def test_bearings_as_printed() -> None:
    """[BG18, eq. 26] with two different distances."""
    rotor = replace(ROTOR, first=-8e-3, second=11e-3)
    a, b = 8e-3, 11e-3
    printed = [[1, 0, 0, -a], [0, 1, a, 0], [1, 0, 0, b], [0, 1, -b, 0]]
    assert np.array_equal(rotor.bearing_motion, printed)


@kills(AT + "MagneticRotor.motor_pull", "self.motor_length**2 / 12.0", "self.motor_length**2 / 3.0")
@kills(AT + "MagneticRotor.motor_pull", "middle = 0.5 * (self.first + self.second)", "middle = 0.0")
@kills(AT + "motor_length", "3.0 * shape", "12.0 * shape")
def test_motor_as_printed() -> None:
    """A pull spread over the motor's length is [BG18, eq. 31 and 32], also off the middle."""
    shape, place = 0.202, (-8e-3, 11e-3)
    rotor = replace(ROTOR, first=place[0], second=place[1], motor_length=motor_length(shape, *place))
    much, little = 1.0 + shape, 1.0 - shape
    printed = np.array(
        [[much, 0, little, 0], [0, much, 0, little], [little, 0, much, 0], [0, little, 0, much]]
    )
    motion = rotor.bearing_motion
    expected = motion.T @ (0.25 * rotor.motor_stiffness * printed) @ motion
    np.testing.assert_allclose(rotor.motor_pull, expected, rtol=1e-12, atol=1e-12)
    with pytest.raises(InputError, match="shape"):
        motor_length(-1.0, -1.0, 1.0)


@kills(AT + "MagneticRotor.circulation", "self.drag, -self.drag", "-self.drag, self.drag")
def test_drag_as_printed() -> None:
    """[BG18, eq. 34]: against the whole turning, of which a part lies across where the rotor leans."""
    speed, q, v = 900.0, np.array([0.0, 0.0, 2e-3, 5e-3]), np.array([0.0, 0.0, 0.4, -0.3])
    turning = np.array([v[2] + speed * q[3], v[3] - speed * q[2]])
    found = -(ROTOR.damping @ v + speed * ROTOR.circulation @ q)
    np.testing.assert_allclose(found, [0.0, 0.0, *(-ROTOR.drag * turning)], rtol=1e-14)
    assert ROTOR.drag == pytest.approx(0.91 * 0.056 * math.pi * 7.8e-3**2 * 22e-3, rel=1e-14)
    with pytest.raises(InputError, match="radius"):
        screw_drag(1.0, 1.0, 0.0, 1.0)


SHARE = st.floats(-0.98, 0.98)


@kills(AT + "Magnets.force", "near - far", "near + far")
@kills(AT + "Magnets.current", "apart * i * i) / (both + root)", "apart * i * i) / (both + 2.0 * root)")
@kills(AT + "Magnets.current", "4.0 * near * far * i * i + apart * f", "4.0 * near * far * i * i - apart * f")
@given(SHARE, SHARE, st.floats(-9.0, 0.0), st.floats(-4.0, 2.0))
def test_current_of_a_force(place: float, share: float, constant: float, bias: float) -> None:
    """Force and current are one another's inverse, for every current up to the bias current.

    The current changes with the force by 1/(dF/di), which is least at the edge: with x/delta = 0.98 and the
    current at -0.98 of the bias current F is still 4 % of the bias current's own, so that a rounding of F by
    1e-15 of its parts moves i by 1e-12 i_0 at most.
    """
    magnets = Magnets(2e-4, 10.0**constant, 10.0**bias)
    x, i = place * magnets.gap, share * magnets.bias_current
    back = float(magnets.current(x, magnets.force(x, i)))
    assert back == pytest.approx(i, abs=1e-11 * magnets.bias_current)


@kills(AT + "Magnets.current", "np.where(root > 0.0, f, ", "np.where(root > -1.0, f, ")
@given(st.floats(0.02, 0.98), st.floats(1.0, 1e6))
def test_a_force_that_is_too_large(place: float, much: float) -> None:
    """Away from the near magnet there is a largest force; asked for more, the current is that of the largest.

    Near it the force is flat: a current that is off by s i_0 misses s^2 of it. 1e-9 below it leaves s = 3e-5.
    """
    x = place * MAGNETS.gap
    near, far = 1.0 / (MAGNETS.gap - x) ** 2, 1.0 / (MAGNETS.gap + x) ** 2
    most = 4.0 * near * far / (near - far) * MAGNETS.force_constant * MAGNETS.bias_current**2
    found = float(MAGNETS.current(x, -most * (1.0 + much)))
    assert float(MAGNETS.force(x, found)) == pytest.approx(-most, rel=1e-9)
    for other in (0.999 * found, 1.001 * found):
        assert float(MAGNETS.force(x, other)) > float(MAGNETS.force(x, found))


@kills(AT + "Magnets.current_stiffness", "4.0 *", "2.0 *")
@kills(AT + "Magnets.position_stiffness", "self.gap**3", "self.gap**2")
@kills(AT + "Magnets.energy", "-self.force_constant", "self.force_constant")
def test_slopes_of_the_force() -> None:
    """Differences of force and potential: errors h^2 f'''/6, 1e-8 of the slope with h = 1e-4 delta."""
    h, i = 1e-4 * MAGNETS.gap, 1e-4 * MAGNETS.bias_current
    along = (MAGNETS.force(h, 0.0) - MAGNETS.force(-h, 0.0)) / (2.0 * h)
    assert along == pytest.approx(MAGNETS.position_stiffness, rel=1e-7)
    by_current = (MAGNETS.force(0.0, i) - MAGNETS.force(0.0, -i)) / (2.0 * i)
    assert by_current == pytest.approx(MAGNETS.current_stiffness, rel=1e-7)
    x, current = 0.3 * MAGNETS.gap, 0.4 * MAGNETS.bias_current
    slope = (MAGNETS.energy(x + h, current) - MAGNETS.energy(x - h, current)) / (2.0 * h)
    assert -slope == pytest.approx(float(MAGNETS.force(x, current)), rel=1e-6)


@kills(AT + "MagneticRotor.energy", "motor = -0.5", "motor = 0.5")
@kills("solvers.rotor.magnetic.motion:_Equations.__call__", "self.pull - speed", "-self.pull - speed")
@kills(
    "solvers.rotor.magnetic.motion:_Equations.__call__",
    "force = self.magnets.force(",
    "force = 0.9 * self.magnets.force(",
)
def test_energy_of_the_uncontrolled_rotor() -> None:
    """Without unbalance, drag and control the energy stays until the rotor touches a magnet.

    Steps keep 1e-8 of each state; within the fall, some ten times as long as the magnets need to throw the
    rotor off, errors grow as the motion itself does.
    """
    rotor = replace(ROTOR, eccentricity=0.0, inertia_tilt=0.0, drag=0.0)
    start = (2e-6, -1e-6, 1e-4, 3e-4)
    motion = integrate(rotor, Uncontrolled(), SpeedLaw(900.0), 0.1, place=start, samples=2001)
    assert motion.ending is Ending.TOUCHED and 0.001 < motion.time[-1] < 0.1
    energy = rotor.energy(motion.place, motion.rate)
    kinetic = 0.5 * np.sum(rotor.inertia * motion.rate**2, axis=-1)
    assert kinetic.max() > 1e-5 and np.ptp(energy) < 1e-6 * kinetic.max()
    assert motion.distance[-1] == pytest.approx(rotor.magnets.gap, rel=1e-9)


@kills(AT + "dimensionless", "machine.drag * time / inertia", "machine.drag * time")
@kills(AT + "dimensionless", "machine.mass * length**2 / inertia", "machine.mass * length / inertia")
def test_numbers_of_the_table() -> None:
    """[BG18, table 1 and eq. 41]: inertias of two digits, so the numbers hold to half a per cent."""
    numbers = dimensionless(ROTOR, 22e-3)
    assert numbers.gyroscopic == pytest.approx(0.548, rel=5e-3)
    assert numbers.slenderness == pytest.approx(8.714, rel=5e-3)
    assert numbers.drag == pytest.approx(4.47e-4, rel=5e-3)
    assert numbers.time == pytest.approx(math.sqrt(12.42e-3 / 6000.0), rel=1e-14)
    assert numbers.magnets == pytest.approx(2e-5 * 0.03**2 / (6000.0 * 2e-4**3), rel=1e-14)
    assert dimensionless(ROTOR).slenderness == pytest.approx(numbers.slenderness * (18.0 / 22.0) ** 2)
    assert math.isnan(dimensionless(replace(ROTOR, motor_stiffness=0.0)).magnets)


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"mass": 0.0}, "mass"),
        ({"eccentricity": -1.0}, "eccentricity"),
        ({"polar_inertia": 1.0}, "polar_inertia"),
        ({"first": 1.0}, "first, second"),
        ({"drag": math.nan}, "drag"),
    ],
)
def test_bad_rotors(changes: dict[str, float], field: str) -> None:
    with pytest.raises(InputError, match=field):
        replace(ROTOR, **changes)


def test_bad_magnets() -> None:
    with pytest.raises(InputError, match="bias_current"):
        Magnets(2e-4, 1e-5, 0.0)
    with pytest.raises(InputError, match="most_current"):
        Magnets(2e-4, 1e-5, 0.03, most_current=0.04)
    with pytest.raises(InputError, match="bandwidth"):
        Magnets(2e-4, 1e-5, 0.03, bandwidth=-1.0)
