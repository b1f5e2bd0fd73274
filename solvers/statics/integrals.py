"""Integrals over the liquid in a chamber: what is inside the outer wall less what is inside the inner one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fluid.moments import Moments
from meshes.arrays import Array
from meshes.chamber import Chamber, Chambers
from solvers.statics import wall

AnyChamber = Chamber | Chambers  # one for all states, or one for each

_CHUNK = 256


@dataclass(frozen=True)
class _Wall:
    """A cylindrical wall in its own units: the liquid inside the outer one less that inside the inner one."""

    sign: float
    radius: float | Array
    height: float | Array
    eps: Array
    steep: Array
    zeta: Array


def _walls(chamber: AnyChamber, e: Array, steep: Array, zeta: Array) -> list[_Wall]:
    eps = e / chamber.radius
    walls = [_Wall(1.0, chamber.radius, chamber.height, eps, steep, zeta)]
    if np.any(np.asarray(chamber.inner_radius) > 0.0):
        # An inner wall of no size holds nothing: any other size does for its shape.
        ratio = np.maximum(np.asarray(chamber.inner_radius) / chamber.radius, 1e-60)
        # How far the surface falls from the outer wall's farthest point to the inner one's.
        fall = steep * (1.0 - ratio) * (1.0 + ratio + 2.0 * eps)
        inner = np.maximum(zeta - fall, 0.0)
        walls.append(_Wall(-1.0, chamber.inner_radius, chamber.height, eps / ratio, steep * ratio**2, inner))
    return walls


def _over_walls(
    integrals: Callable[[Array, Array, Array], tuple[Array, ...]], powers: tuple[int, ...], *walls: _Wall
) -> tuple[Array, ...]:
    """Integrals of the outer wall less those of the inner one, scaled by R^power h."""
    shape = walls[0].eps.shape
    total = np.zeros((len(powers), walls[0].eps.size))
    for cylinder in walls:
        radius, height = np.asarray(cylinder.radius, dtype=float), cylinder.height
        sizes = [cylinder.sign * radius**power * height for power in powers]
        scales = np.stack([np.broadcast_to(scale, shape).ravel() for scale in sizes])
        eps, steep, zeta = cylinder.eps.ravel(), cylinder.steep.ravel(), cylinder.zeta.ravel()
        # Some hundred nodes a state: a few hundred states at once stay in the processor's cache.
        for start in range(0, eps.size, _CHUNK):
            part = slice(start, start + _CHUNK)
            total[:, part] += scales[:, part] * np.stack(integrals(eps[part], steep[part], zeta[part]))
    return tuple(row.reshape(shape) for row in total)


def _all_moments(eps: Array, steep: Array, zeta: Array) -> tuple[Array, ...]:
    m = wall.integrate(eps, steep, zeta)
    return m.volume, m.x, m.z, m.xx, m.yy, m.zz, m.xz


def moments(
    chamber: AnyChamber, eccentricity: ArrayLike, steep: ArrayLike, wetted_height: ArrayLike
) -> Moments:
    """Moments of the liquid under a given surface.

    Parameters
    ----------
    chamber : the chamber, or one for each state, shape (n,)
    eccentricity : e, m, shape (...,)
    steep : beta R^2/h, shape (...,)
    wetted_height : height of the unclamped surface at the farthest wall point over h, shape (...,)

    Returns
    -------
    Moments about the rotation axis and the chamber's floor, over the density, shape (...,)
    """
    e, b, zeta = same_shape(eccentricity, steep, wetted_height)
    v, x, z, xx, yy, zz, xz = _over_walls(_all_moments, (2, 3, 2, 4, 4, 2, 3), *_walls(chamber, e, b, zeta))
    h = chamber.height
    none = np.zeros_like(v)
    return Moments(volume=v, x=x, y=none, z=z * h, xx=xx, yy=yy, zz=zz * h**2, xy=none, xz=xz * h, yz=none)


def volume_under(chamber: AnyChamber, eccentricity: Array, steep: Array, wetted_height: Array) -> Array:
    """Volume of the liquid under a given surface, m^3, shape (...,); see `moments` for the parameters."""
    return volume_and_plan(chamber, eccentricity, steep, wetted_height)[0]


def volume_and_plan(chamber: AnyChamber, e: Array, steep: Array, zeta: Array) -> tuple[Array, Array]:
    """Volume under the surface and its derivative with respect to the wetted height over h.

    Parameters and shapes as for `moments`.
    """
    volume, plan = _over_walls(wall.volume_and_plan, (2, 2), *_walls(chamber, e, steep, zeta))
    return volume, plan


def plan_moments(chamber: AnyChamber, e: Array, steep: Array, zeta: Array) -> tuple[Array, ...]:
    """First moment of the liquid about the rotation axis, m^4, and the moments of its free surface's plan.

    Parameters and shapes as for `moments`; the plan's area, first and second moment along the deflection are
    beta-fold, so that they stay finite as the surface becomes a cylinder [theory: statics, eq. 17].
    """
    return _over_walls(wall.unbalance, (3, 0, 1, 2), *_walls(chamber, e, steep, zeta))


def same_shape(*values: ArrayLike) -> tuple[Array, ...]:
    """Copies of some values, broadcast to one shape."""
    return tuple(np.array(x) for x in np.broadcast_arrays(*(np.asarray(v, dtype=float) for v in values)))
