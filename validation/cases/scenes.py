"""The rigs that the cases are computed for, and the data measured on them."""

from __future__ import annotations

import json
import math
from importlib import resources
from typing import Any

from fluid.fill import Fill
from fluid.liquid import known_liquid
from meshes.chamber import Chamber
from solvers.rotor.jeffcott import Jeffcott


def data(name: str) -> dict[str, Any]:
    """Content of a data file of this package."""
    text = resources.files("validation").joinpath("data", name).read_text(encoding="utf-8")
    content: dict[str, Any] = json.loads(text)
    return content


def horizontal_rig() -> tuple[Fill, ...]:
    """The two chambers of DR18, section 7.2; their height of 20 mm is assumed."""
    water = known_liquid("water")
    return tuple(Fill(Chamber(radius, 0.02), water, 10e-6) for radius in (0.065, 0.05))


def horizontal_rotor(damping_ratio: float, wet_critical_speed: float) -> Jeffcott:
    """Rotor of DR18, section 7.2, whose critical speed with liquid is known; 4 kg and 60 mm are assumed.

    Parameters
    ----------
    damping_ratio : of the rotor with the liquid's added mass
    wet_critical_speed : with liquid, rad/s
    """
    mass, unbalance = 4.0, 10e-3 * 60e-3
    total = mass + sum(fill.full_mass for fill in horizontal_rig())
    stiffness = total * wet_critical_speed**2
    return Jeffcott(mass, stiffness, 2.0 * damping_ratio * total * wet_critical_speed, unbalance)


def vertical_rig() -> tuple[Fill, ...]:
    """The three chambers of DR18, section 7.1; their height of 40 mm and the aperture are assumed."""
    water = known_liquid("water")
    walls = ((0.2, 0.15, 0.45e-3), (0.15, 0.1, 0.30e-3), (0.1, 0.05, 0.25e-3))
    return tuple(Fill(Chamber(outer, 0.04, inner), water, volume) for outer, inner, volume in walls)


def vertical_rotor() -> Jeffcott:
    """Rotor of DR18, section 7.1, on its suspension of 2 to 2.5 Hz.

    Assumed are 30 kg, 200 mm for the place of the 30 g, and the damping ratio.
    """
    mass, frequency = 30.0, 2.0 * math.pi * 2.25
    return Jeffcott(mass, mass * frequency**2, 2.0 * 0.01 * mass * frequency, unbalance=30e-3 * 0.2)
