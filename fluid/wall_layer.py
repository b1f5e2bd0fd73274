"""Laminar layers that an oscillating flow leaves on the walls of a spinning drum, and how they damp it.

The flow outside the layers is plane, irrotational and free of divergence, with frequency sigma in the frame
of the drum. Layers are thin beside the liquid.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from fluid.friction import stokes_coefficient
from meshes.arrays import Array


def layer_thickness(viscosity: ArrayLike, frequency: ArrayLike) -> Array:
    """Thickness of an oscillating layer, sqrt(2 nu/|sigma|), m [theory: sloshing, eq. 19].

    Parameters
    ----------
    viscosity : nu, m^2/s, shape (...,)
    frequency : sigma, rad/s, not 0, shape (...,)
    """
    return np.asarray(np.sqrt(2.0 * np.asarray(viscosity, dtype=float) / np.abs(frequency)))


def plate_drags(viscosity: ArrayLike, frequency: ArrayLike, spin: ArrayLike) -> tuple[Array, Array]:
    """Shear over velocity on floor and lid for the two circles of an oscillation e^{-i sigma t}, m/s.

    sqrt(nu |2 Omega - sigma|/2) for the circle that goes round as e^{-i sigma t} and sqrt(nu |2 Omega +
    sigma|/2) for the other [theory: sloshing, eq. 21].

    Parameters
    ----------
    viscosity : nu, m^2/s, shape (...,)
    frequency : sigma in the frame of the drum, rad/s, shape (...,)
    spin : Omega, rad/s; 0 for the plain layers without Coriolis force, shape (...,)
    """
    sigma, twice = np.asarray(frequency, dtype=float), 2.0 * np.asarray(spin, dtype=float)
    return stokes_coefficient(viscosity, twice - sigma), stokes_coefficient(viscosity, twice + sigma)


def edge_weight(distance: ArrayLike, thickness: ArrayLike) -> Array:
    """Share of the squared outer velocity that counts near the edge of a thin baffle, d/(d + delta).

    The outer velocity grows as d^(-1/2) towards the edge and its square has no integral. A layer cannot
    follow it nearer than its own thickness [theory: sloshing, eq. 23].

    Parameters
    ----------
    distance : d from the edge, m, shape (...,); inf without an edge
    thickness : delta of the layer, m, above 0, shape (...,)
    """
    return np.asarray(1.0 / (1.0 + np.asarray(thickness, dtype=float) / np.asarray(distance, dtype=float)))


def decay_rate(
    wall: ArrayLike,
    kinetic: ArrayLike,
    sense: ArrayLike,
    potential: ArrayLike,
    height: float,
    drags: tuple[ArrayLike, ArrayLike, ArrayLike],
) -> Array:
    """Rate at which the amplitude of a mode decays: loss of energy over twice the energy.

    [g w + (g_1 (k + c) + g_2 (k - c))/h]/(k + b) [theory: sloshing, eq. 22].

    Parameters
    ----------
    wall : w = oint |d psi/dn|^2 ds on all walls, m^3/s^2, shape (...,)
    kinetic : k = int |grad psi|^2, m^4/s^2, shape (...,)
    sense : c = Im oint psi* psi_theta dtheta on the free surface, m^4/s^2, shape (...,)
    potential : b = (Omega/sigma)^2 oint |psi_theta|^2 dtheta, m^4/s^2, shape (...,)
    height : of the chamber, m; inf leaves floor and lid out
    drags : g on the walls; g_1 and g_2 of `plate_drags`, m/s, shape (...,)

    Returns
    -------
    1/s, shape (...,)
    """
    g, first, second = (np.asarray(one, dtype=float) for one in drags)
    k, c = np.asarray(kinetic, dtype=float), np.asarray(sense, dtype=float)
    lost = g * wall + (first * (k + c) + second * (k - c)) / height
    return np.asarray(lost / (k + potential))
