"""The motion of a vibrating table with balls as a picture draws it."""

from __future__ import annotations

import math

import numpy as np

from leblanc.results.drawn import TableView, rounded_down
from leblanc.scene.scene import Exciter, Scene
from meshes.errors import InputError
from solvers.rotor.exciter.machine import platform_motion, stuck_speeds

SWING, MOST = 0.35, 100.0  # vibration as drawn over the track's radius, and the largest factor


def table_view(scene: Scene, speed: float | None = None) -> TableView:
    """A table with balls at the moment when balls and unbalance both point along the vibration.

    Parameters
    ----------
    scene : of kind "exciter"
    speed : of the shaft, rad/s; the last of its speeds if None

    Raises
    ------
    InputError : another rotor, a speed that is not above 0
    """
    rotor = scene.rotor
    if not isinstance(rotor, Exciter):
        raise InputError("rotor.kind", rotor.kind, "exciter for this")
    spin = scene.speeds.stop if speed is None else speed
    if not (math.isfinite(spin) and spin > 0.0):
        raise InputError("--speed", spin, "a finite number above 0")
    machine = rotor.machine()
    numbers, unit = machine.dimensionless(), machine.natural_frequency
    stuck = float(stuck_speeds(np.array([spin / unit]), numbers)[0, 0])
    slow, fast = (abs(part) * machine.length for part in platform_motion(numbers, spin / unit, stuck))
    largest, track = slow + fast, rotor.balls.track_radius
    factor = float(f"{rounded_down(min(MOST, SWING * track / largest)):.6g}") if largest > 0.0 else 1.0
    return TableView(
        name=scene.name,
        speed=spin,
        stuck_speed=stuck * unit,
        slow=slow,
        fast=fast,
        track_radius=track,
        balls=rotor.balls.count,
        kind=rotor.balls.name,
        factor=factor,
    )
