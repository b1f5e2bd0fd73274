"""Stability of a spinning top's upright rotation with a partly filled chamber on its axis.

The body turns about a fixed point on its vertical axis; heights are measured upward from that point. A tilt
leaves the energy stationary; the rotation is stable where its second variation is positive.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array
from meshes.chamber import Chamber
from meshes.errors import InputError, require_positive

# The integrand is a polynomial of third degree in r^2, for which two Gauss points are exact; it is positive,
# so that nothing cancels.
_NODES = 0.5 + np.array([-1.0, 1.0]) / np.sqrt(12.0)


def free_surface_term(
    chamber: Chamber,
    floor: float,
    surface_constant: ArrayLike,
    speed: ArrayLike,
    gravity: float,
    density: float,
) -> Array:
    """What the freedom of the liquid's surface takes from the stability of the upright rotation.

    a = rho g int int (1 + Omega^2 z/g)^2 r^3 cos(phi)^2 dr dphi over the plan of the free surface, z the
    height of the surface above the fixed point [DR18, eq. 22, whose integral over the angle lacks cos(phi)^2;
    theory: statics, eq. 19]. Concentric chamber, rotation axis through its centre.

    Parameters
    ----------
    chamber : its plane is not used
    floor : height of the chamber's floor above the fixed point, m
    surface_constant : C of the surface z = beta r^2 + C, from the chamber's floor, m, shape (...,)
    speed : spin speed Omega, rad/s, shape (...,)
    gravity : along the axis g, m/s^2, above 0
    density : rho, kg/m^3

    Returns
    -------
    a, N m, shape (...,), 0 or above; 0 where there is no free surface

    Raises
    ------
    InputError : a density or gravity that is not positive, a value that is not finite
    """
    require_positive("gravity", gravity)
    require_positive("density", density)
    constant, omega = np.broadcast_arrays(
        np.asarray(surface_constant, dtype=float), np.asarray(speed, dtype=float)
    )
    for field, value in (("floor", floor), ("surface_constant", constant), ("speed", omega)):
        if not np.all(np.isfinite(value)):
            raise InputError(field, value, "finite")

    beta = np.square(omega) / (2.0 * gravity)
    inner, outer = _waterlines(chamber, constant, beta)
    width = (outer - inner)[..., None]
    s = inner[..., None] + width * _NODES
    height = floor + constant[..., None] + beta[..., None] * s
    stiffening = 1.0 + np.square(omega)[..., None] * height / gravity
    # int r^3 dr = int s/2 ds with s = r^2; the angle contributes pi; each Gauss point weighs 1/2.
    integral = np.sum(np.square(stiffening) * s * width, axis=-1) / 4.0
    return np.asarray(density * gravity * np.pi * integral)


def _waterlines(chamber: Chamber, constant: Array, beta: Array) -> tuple[Array, Array]:
    """Squared radii between which the surface lies inside the chamber; equal where it does nowhere."""
    low, high = chamber.inner_radius**2, chamber.radius**2
    found = []
    for level in (0.0, chamber.height):
        rise = level - constant
        # Where even the rim stays below the level, the surface never reaches it.
        reached = rise < beta * high
        squared = np.where(reached, 0.0, high)
        np.divide(rise, beta, out=squared, where=reached & (rise > 0.0))
        found.append(np.clip(squared, low, high))
    return found[0], found[1]
