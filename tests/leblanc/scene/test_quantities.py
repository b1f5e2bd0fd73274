"""What a critical speed, a damping ratio and a unit mean."""

from __future__ import annotations

import math
import tomllib

import numpy as np
import pytest

from leblanc.core import units
from leblanc.scene.scene import jeffcott, scene_from_table
from tests.mutants import kills

_SCENE = """
name = "x"
rotor.kind = "jeffcott"
rotor.mass = 4
rotor.critical_speed = "1000 rpm"
rotor.damping_ratio = 0.1
rotor.unbalance = 0
rotor.axis = "vertical"
chambers = [{ radius = 1, height = 1, volume = 1, liquid = "water" }]
speeds = { start = 1, stop = 2, count = 2 }
"""


@kills(
    "leblanc.scene.rotors:JeffcottRotor._machine",
    "self.mass * self.critical_speed**2",
    "self.mass * self.critical_speed",
)
@kills(
    "leblanc.scene.rotors:JeffcottRotor._machine",
    "self.mass * self.critical_speed**2",
    "self.critical_speed**2",
)
@kills("leblanc.scene.rotors:JeffcottRotor._machine", "2.0 * self.damping_ratio", "self.damping_ratio")
@kills(
    "leblanc.scene.rotors:JeffcottRotor._machine",
    "math.sqrt(stiffness * self.mass)",
    "math.sqrt(stiffness / self.mass)",
)
def test_free_vibration() -> None:
    """The rotor let go turns at its critical speed and loses 2 pi zeta/sqrt(1 - zeta^2) a turn."""
    rotor = jeffcott(scene_from_table(tomllib.loads(_SCENE)))
    roots = np.roots([rotor.mass, rotor.damping, rotor.stiffness])
    # eigenvalues of a 2 x 2 matrix: a few rounding errors
    np.testing.assert_allclose(np.abs(roots), 1000.0 * 2.0 * math.pi / 60.0, rtol=1e-12)
    np.testing.assert_allclose(-roots.real / np.abs(roots), 0.1, rtol=1e-12)


@kills("leblanc.core.units:_scaled", "return number / parts", "return number * parts")
@kills("leblanc.core.units:_scaled", "return number * (whole", "return number / (whole")
@kills("leblanc.core.units:_base", r"(\1turn/s)", r"(\1rad/s)")
def test_one_box_in_three_units() -> None:
    """A litre is a cube of ten centimetres; a hertz is a turn, 60 rpm."""
    units._factor.cache_clear()
    try:
        edge, litre = units.parse("10 cm", units.LENGTH), units.parse("1 l", units.VOLUME)
        hertz, rpm = units.parse("1 Hz", units.ANGULAR_SPEED), units.parse("60 rpm", units.ANGULAR_SPEED)
        kilo = units.parse("1 kN/m", units.STIFFNESS)
        assert units.parse("0.001 kHz", units.ANGULAR_SPEED) == pytest.approx(hertz, rel=1e-15)
        assert math.isclose(edge**3, litre, rel_tol=1e-15)
        assert math.isclose(hertz, rpm, rel_tol=1e-15)
        assert math.isclose(rpm, 2.0 * math.pi, rel_tol=1e-15)
        assert kilo == 1000.0
    finally:
        units._factor.cache_clear()
