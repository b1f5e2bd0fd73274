"""How far long waves are off the exact ones at a whirl that goes round beside the spin."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from leblanc.liquid.choose import Prepared, held_model
from meshes.arrays import Array
from solvers.held.state import HeldKind, HeldState
from solvers.rotor.system import RotorSystem
from solvers.wave_error import long_wave_error

_LINES = 2  # multiples of the spin that a motion may have beside its whirl


def wave_errors(machine: Prepared, states: Sequence[HeldState]) -> Array:
    """Error of the liquid's force at the own whirls of limit cycles, without that of the cells, shape (k,).

    That of smooth waves under a whirl of the cycle's speed and size [theory: model_error, eq. 35], of the
    layer where it is largest.

    nan without a whirl beside the spin, for other waves than long ones, past baffles, and where no smooth
    wave follows a whirl as large.
    """
    if held_model(machine.scene) != "long_wave":
        return np.full(len(states), np.nan)
    return np.array([_error(machine, state) for state in states])


def _error(machine: Prepared, state: HeldState) -> float:
    """Of one motion; one layer of which nothing is known leaves nothing known."""
    if state.kind is not HeldKind.LIMIT_CYCLE or not math.isfinite(state.whirl_speed):
        return math.nan
    detuning, errors = (1.0 - state.spin / state.whirl_speed) ** 2, []
    for fill, rides in zip(machine.scene.fills, state.captured.tolist(), strict=True):
        if not rides or fill.volume == 0.0:
            continue
        if fill.chamber.baffles is not None:
            return math.nan
        size = own_whirl(machine.system, state, fill.chamber.plane) / fill.depth
        errors.append(float(long_wave_error(fill.depth / fill.chamber.radius, detuning, size, False)))
    return float(np.max(errors)) if errors else math.nan


def own_whirl(system: RotorSystem, state: HeldState, position: float) -> float:
    """Size of the part of a motion that goes round at its own speed, m.

    By least squares over the last turns, beside what stands and what goes with multiples of the spin.
    """
    time = state.path[:, 0] - state.path[0, 0]
    first, second = system.at(position) @ state.path[:, 1:].T
    speeds = np.array([state.whirl_speed, *(state.spin * np.arange(-_LINES, _LINES + 1))])
    # Weights that fade out at both ends keep what beats from leaking.
    fade = np.sin(math.pi * time / time[-1]) ** 2
    waves = np.exp(1j * np.outer(time, speeds))
    parts = np.linalg.lstsq(fade[:, None] * waves, fade * (first + 1j * second), rcond=None)[0]
    return float(abs(parts[0]))
