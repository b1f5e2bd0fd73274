"""Forces in the two bearings between a tub and its drum. SI units."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from meshes.arrays import Array
from solvers.rotor.loads.frame import Weight
from solvers.rotor.tub import Tub


def hub_load(rotor: Tub, place: Array, rate: Array, acceleration: Array) -> Array:
    """Force and moment of the drum on the tub, about the tub's centre, N and N m, shape (..., 6).

    From the balance of the tub alone, so that neither the inertia of the drum nor the liquid is needed
    [theory: loads, eq. 12]. Coordinates count from the equilibrium at rest: what carries the weight there is
    not in it.
    """
    system = rotor.system()
    tub = np.array([rotor.tub_mass] * 3 + list(rotor.tub_inertia))
    return np.asarray(acceleration * tub + rate @ system.damping.T + place @ system.stiffness.T)


def weight_load(weights: Sequence[Weight], gravity: Array) -> Array:
    """Force and moment on the tub at rest by the weight of the drum and its liquid, N and N m, shape (6,).

    Weights of the tub itself are left out.
    """
    total = np.zeros(6)
    for weight in weights:
        if weight.turns:
            force = weight.mass * gravity
            total += np.concatenate([force, np.cross(weight.position, force)])
    return total


def bearing_forces(rotor: Tub, bearings: tuple[float, float], load: Array) -> Array:
    """Share of each of two bearings across the axis in what the drum does to the tub [theory: loads, eq. 13].

    Force of the drum on the tub along z and x, N, shape (..., 2, 2), from the load about the tub's centre,
    (..., 6); bearings at both y, m.
    """
    x, _, z = rotor.drum_position
    first, other = bearings
    # The force along the axis acts on the axis.
    about_x = load[..., 3] + z * load[..., 1]
    about_z = load[..., 5] - x * load[..., 1]
    span = other - first
    second_z, second_x = (about_x - first * load[..., 2]) / span, (-about_z - first * load[..., 0]) / span
    pairs = [(load[..., 2] - second_z, load[..., 0] - second_x), (second_z, second_x)]
    return np.stack([np.stack(pair, axis=-1) for pair in pairs], axis=-2)
