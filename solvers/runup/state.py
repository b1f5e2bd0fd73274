"""What the coupled time steps work on: the machine, its state, and room for the steps. SI units."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from meshes.arrays import Array

# Columns of a layer's properties: R, rho h_c, mass, friction law, its coefficient (linear: k, 1/s; Stokes:
# over the root of the spin; quadratic: a number), 2 R/h_c or 0, square of L for dispersion or 0.
RADIUS, WEIGHT, MASS, LAW, RUBBING, LID, SPREAD = range(7)
# What is summed up over time [theory: coupling, eq. 9-10]: work of the unbalance, of the drive on the liquid,
# of gravity; heat in the supports and by wall friction, loss in bores and by the scheme, what the assumed
# profile of the flow misses while the spin changes; work of the motor; steps, layer steps, largest
# disagreement left.
UNBALANCE, DRIVE, GRAVITY, SUPPORT, FRICTION, BORES, PROFILE, MOTOR, STEPS, LAYER_STEPS, DISAGREED = range(11)
TALLIES = 11
# What a layer is measured by: moment and its rate of change by the flow (two parts each), inertia of the flow
# (xx, xy, yy), angular momentum and energy in the frame that does not turn.
MOMENT, FLOW, INERTIA, SPINNING, ENERGY, MEASURES = 0, 2, 4, 7, 8, 9
# What a layer's step adds up: impulse of the wall's torque, heat by friction, loss in bores and by the
# scheme, energy that the flow's profile misses.
TORQUE, HEAT, LOSS, MISSED, GAINS = range(5)


class Machine(NamedTuple):
    """Rotor and layers; n coordinates, l layers, c cells.

    Parameters
    ----------
    matrices : M, C, G, K, shape (4, n, n)
    unbalance : U, complex, shape (n,)
    planes : in-plane displacement of each layer's axis for unit coordinates, shape (l, 2, n)
    layers : their properties, shape (l, 7)
    gravity : acceleration across the axis, shape (2,)
    angles : cosine and sine at the cells' middles and at their left faces, shape (4, c)
    drive : rate of change of the spin on its ramp, moment of inertia about the axis with a motor, shape (2,)
    curve : the motor's speeds and torques, shape (2, k); k = 0 for a ramp
    """

    matrices: Array
    unbalance: NDArray[np.complex128]
    planes: Array
    layers: Array
    gravity: Array
    angles: Array
    drive: Array
    curve: Array


class State(NamedTuple):
    """What changes with time.

    Parameters
    ----------
    rotor : coordinates, velocities, spin, angle, time, shape (2 n + 3,)
    area, momentum : A/R^2 and q/R^2 of the layers' cells, shape (l, c)
    memory : mean accelerations of the axes over the last two steps, two parts each; in the last row the
        lengths of these steps, the fastest wave, and by what the next step is shortened, shape (l + 1, 4)
    sums : tallies, shape (TALLIES,)
    """

    rotor: Array
    area: Array
    momentum: Array
    memory: Array
    sums: Array


class Room(NamedTuple):
    """Scratch of the steps, made by `solvers.runup.long_wave`."""

    area: Array
    momentum: Array
    begin: Array
    end: Array
    gains: Array
    inertia: Array
    before: Array
    after: Array
    guess: Array
    found: Array
    change: Array
    swing: Array
    left: Array
    spins: Array
    turn: Array
    push: Array
    rub: Array
    spare: Array
