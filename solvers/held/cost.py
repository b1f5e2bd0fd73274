"""Cost of holding a motion: turns until it has converged, steps in a turn, cells in a step."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from fluid.fill import Fill
from meshes.arrays import Array
from solvers.held.state import HoldNumerics

# Turns of a motion that dies, with all cells and with half of them; windows of one that does not.
_DYING, _LIVING = np.array([[60.0], [33.0]]), np.array([[4.5], [2.0]])
# By Newton's method, a turn with a quarter of the cells for half of one with half of them.
_FOUND = np.array([[36.0], [48.0]])
_SHORTEST, _LONGEST = 32.0, 512.0  # turns of a window
_THROWN = 0.15  # of gravity over the centrifugal acceleration, from which a motion hardly ever repeats
# Measured, s: of a turn, and of a cell in a step.
_TURN, _CELL = 4e-4, 1e-7
# Of fully nonlinear waves: of a step's rotor, of a layer's, and of each of its nodes.
_ROTOR, _NODES, _NODE = 2e-3, 4e-3, 1e-5
# Of KdV-Burgers: steps in a turn, at least and by cells; of a step, and of a cell in it.
_FEWEST, _PER_CELL, _PLACE, _WAVES = 48.0, 0.6, 1.6e-3, 2e-6
_HEAPED, _MOST = 80.0, 22.0  # by what a turn takes longer where gravity heaps the liquid up


def settling_turns(
    spin: Array, growth: Array, strength: Array, numerics: HoldNumerics, dying: Array = _DYING
) -> Array:
    """Turns that motions take to converge, about, shape (2, n) [theory: held, eq. 11].

    With all cells, and with half of them; `dying` is what those that decay take. `growth`: rate of the
    fastest-growing small whirl, 1/s, nan where it is not known; `strength`: gravity across the axis over the
    centrifugal acceleration at the surface.
    """
    change = np.abs(np.where(np.isnan(growth), math.inf, growth)) * 2.0 * math.pi / spin
    slow = np.full(change.shape, math.inf)
    window = np.clip(np.divide(0.5, change, out=slow, where=change > 0.0), _SHORTEST, _LONGEST)
    dies = (growth < 0.0) & (strength < _THROWN)
    return np.asarray(np.minimum(np.where(dies, dying, _LIVING * window), numerics.turns))


def hold_seconds(
    fills: Sequence[Fill],
    spin: Array,
    growth: Array,
    across: float = 0.0,
    numerics: HoldNumerics | None = None,
    liquid: str = "long_wave",
) -> Array:
    """Processor time to hold motions until they converge, with half the cells for the error, s, shape (n,).

    Of one core of the machine it was measured on, to a factor of two [theory: held, eq. 12 and 13]; of exact
    waves [theory: held, eq. 14], of KdV-Burgers [theory: held, eq. 18].
    """
    numerics = numerics or HoldNumerics()
    surfaces = [fill.surface_radius for fill in fills if fill.volume > 0.0 and fill.surface_radius > 0.0]
    strength = across / (np.square(spin) * min(surfaces, default=math.inf))
    cells = np.array([[numerics.cells], [numerics.cells // 2]])
    if liquid == "kdv":
        turn = np.maximum(_FEWEST, _PER_CELL * cells) * (_PLACE + _WAVES * cells * len(surfaces))
        return np.asarray((settling_turns(spin, growth, strength, numerics) * turn).sum(axis=0))
    if liquid == "potential":
        steps = math.pi * (1.0 + np.sqrt(1.0 + cells / 3.0))
        turn = steps * (_ROTOR + len(surfaces) * (_NODES + _NODE * cells))
        return np.asarray((settling_turns(spin, growth, strength, numerics) * turn).sum(axis=0))
    turn = _TURN + _CELL * len(surfaces) * np.square(cells) / numerics.courant
    heaped = np.minimum(1.0 + _HEAPED * strength**4, _MOST)
    turns = settling_turns(spin, growth, strength, numerics, _FOUND)
    return np.asarray((turns * turn).sum(axis=0) * heaped)
