"""What is read off the coupled machine at one moment."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from solvers.coupled_machine import Coupled
from solvers.machine import RADIUS


def reading(machine: Coupled) -> dict[str, Any]:
    """What `solvers.runup.RunupHistory` records of a moment, by its names."""
    n, count = len(machine.system.coordinates), len(machine.fills)
    x, angle = machine.state.rotor[:n].copy(), float(machine.state.rotor[-2])
    turn = complex(math.cos(angle), math.sin(angle))
    planes = [machine.system.at(fill.chamber.plane) for fill in machine.fills] or [machine.system.centre]
    surface = np.sqrt(np.maximum(1.0 - 2.0 * machine.area, 0.0))
    lever = (1.0 - surface) * (1.0 + surface + np.square(surface)) / 3.0
    whole = np.maximum(machine.area.sum(axis=1), 1e-300)
    angles, radius = machine.machine.angles, machine.layers[:, RADIUS]
    moved = radius * (lever @ angles[0] + 1j * (lever @ angles[1])) / whole * turn
    velocity = np.divide(machine.momentum, machine.area, out=np.zeros_like(surface), where=machine.area > 0.0)
    velocity += machine.spin * machine.area
    flow = velocity * -np.log(np.maximum(surface, 1e-300))
    nothing = np.full(count, np.nan)
    return {
        "time": machine.time,
        "speed": machine.spin,
        "angle": angle,
        "coordinates": x,
        "deflection": np.array([complex(*(plane @ x)) for plane in planes]),
        "offset": np.where(machine.active, moved, machine.pool),
        "captured": machine.active.copy(),
        "depth_min": np.where(machine.active, radius * (1.0 - surface.max(axis=1, initial=0.0)), nothing),
        "depth_max": np.where(machine.active, radius * (1.0 - surface.min(axis=1, initial=1.0)), nothing),
        "mean_rotation": np.where(machine.active, flow.sum(axis=1) / whole, 0.0),
    }
