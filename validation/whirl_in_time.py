"""Growth of a small whirl in time, by the coupled nonlinear model: the check on the linear stability."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fluid.fill import Fill
from fluid.friction import Friction
from meshes.errors import InputError, require_positive
from solvers.layer.records import Outcome
from solvers.rotor.system import RotorSystem
from solvers.runup.long_wave import couple
from solvers.runup.runup import RunupNumerics

_SAMPLES = 800
_SMALL = 1e-7  # of the smallest layer's depth, at first
_LARGE = 0.02  # of that depth; beyond it the layer is no longer linear


@dataclass(frozen=True)
class WhirlInTime:
    """What a small disturbance did.

    Parameters
    ----------
    growth : of the deflection's modulus over the last half of the time, 1/s
    whirl_speed : of the deflection over it, rad/s, standing frame
    linear : the layers stayed within the range of linear waves
    """

    growth: float
    whirl_speed: float
    linear: bool


def whirl_in_time(
    system: RotorSystem,
    fills: Sequence[Fill],
    spin: float,
    friction: Friction,
    duration: float,
    numerics: RunupNumerics | None = None,
) -> WhirlInTime:
    """Let go a rotor with liquid at a constant speed from a tiny deflection [theory: coupling].

    Parameters
    ----------
    system, fills, friction : as for `solvers.runup.runup.run_up`, at least one chamber with a layer
    spin : rad/s
    duration : s; long enough for the mode that grows most, or dies slowest, to outlast the others
    numerics : resolution

    Raises
    ------
    InputError : no layer, a time or speed that is not positive
    """
    require_positive("duration", duration)
    require_positive("spin", spin)
    numerics = numerics or RunupNumerics()
    machine = couple(system, fills, spin, friction, 0.0, numerics.cells, numerics.dispersion)
    if not machine.active.any():
        raise InputError("chambers", len(fills), "at least one with a layer of liquid")
    depth = min(fill.depth for fill, moving in zip(fills, machine.active, strict=True) if moving)
    plane = machine.machine.planes[0]
    # The coordinates that move the first axis along its first direction, as little as may be.
    kick = np.linalg.pinv(plane) @ np.array([_SMALL * depth, 0.0])
    machine.state.place[: kick.size] = kick
    time = np.linspace(0.0, duration, _SAMPLES + 1)
    deflection = np.empty(_SAMPLES, dtype=complex)
    for k, stop in enumerate(time[1:].tolist()):
        if machine.advance(stop, 0.0, numerics.courant, 10**9) != Outcome.DONE:
            return WhirlInTime(math.nan, math.nan, False)
        deflection[k] = complex(*(plane @ machine.state.place[: kick.size]))
    last = slice(_SAMPLES // 2, None)
    modulus = np.abs(deflection[last])
    if modulus.min() <= 0.0:
        return WhirlInTime(-math.inf, 0.0, True)
    growth = np.polyfit(time[1:][last], np.log(modulus), 1)[0]
    turning = np.polyfit(time[1:][last], np.unwrap(np.angle(deflection[last])), 1)[0]
    return WhirlInTime(float(growth), float(turning), bool(modulus.max() < _LARGE * depth))
