"""The rotor of the blood pump as its source gives it, with assumed magnets [BG18, table 1]."""

from __future__ import annotations

import math

from solvers.rotor.magnetic.control import Pid, Synergetic, source_times
from solvers.rotor.magnetic.machine import MagneticRotor, Magnets, motor_length, screw_drag

SPEED = 9000.0 * math.pi / 30.0
MAGNETS = Magnets(gap=2e-4, force_constant=2e-5, bias_current=0.03)
ROTOR = MagneticRotor(
    mass=12.42e-3,
    transverse_inertia=6.9e-7,
    polar_inertia=3.78e-7,
    eccentricity=4.27e-7,
    inertia_tilt=2.15e-5,
    first=-9e-3,
    second=9e-3,
    magnets=MAGNETS,
    motor_stiffness=6000.0,
    motor_length=motor_length(0.202, -9e-3, 9e-3),
    drag=screw_drag(0.91, 0.056, 7.8e-3, 22e-3),
)


def synergetic(machine: MagneticRotor = ROTOR) -> Synergetic:
    """The controller of the source, made for a rotor."""
    return source_times(machine, 35.0, 4000.0, 0.2, 1.2)


def pid(machine: MagneticRotor = ROTOR) -> Pid:
    """A stiff PID controller for it."""
    return Pid(machine, proportional=150e3, integral=7.5e6, derivative=41.0, cutoff=5e4)
