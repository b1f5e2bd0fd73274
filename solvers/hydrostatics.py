"""Liquid at rest in a whirling, spinning chamber: surface for a given volume, unbalance, optimal volume.

The one unknown is the wetted height Z, the height of the unclamped surface above the floor at the wall's
farthest point from the rotation axis. Unlike the surface constant C it keeps its digits when the spin is fast
(C loses them as beta R^2/h) and when the fill is small [theory: statics, eq. 12].
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fluid.moments import Moments
from fluid.paraboloid import steepness
from meshes.border import InputError
from meshes.chamber import Chamber
from solvers import wall_arc

Array = NDArray[np.float64]

_ITERATIONS = 200
_CHUNK = 256
_ROUNDING = 8.0 * np.finfo(float).eps


@dataclass(frozen=True)
class Equilibrium:
    """The liquid's surface at a given volume, eccentricity and speed; all shapes (...,).

    Parameters
    ----------
    chamber : the chamber
    eccentricity : distance e of the rotation axis from the chamber's centre, m
    steepness : beta R^2/h of the surface
    wetted_height : Z over the chamber's height: unclamped surface height at the farthest wall point
    nearest_depth : the same at the nearest wall point; below 0 it is dry there, above 1 wet to the lid
    volume : liquid volume reached, m^3
    converged : the volume was met to rounding
    """

    chamber: Chamber
    eccentricity: Array
    steepness: Array
    wetted_height: Array
    nearest_depth: Array
    volume: Array
    converged: NDArray[np.bool_]

    @property
    def dry_patch(self) -> NDArray[np.bool_]:
        """The wall is dry over its whole height at the point nearest to the rotation axis."""
        return (self.nearest_depth <= 0.0) & (self.eccentricity > 0.0)

    @property
    def surface_constant(self) -> Array:
        """C of z = beta r^2 + C, m [theory: statics, eq. 1]; minus infinity without gravity."""
        h, radius = self.chamber.height, self.chamber.radius
        farthest = np.square(1.0 + self.eccentricity / radius)
        constant = h * (self.wetted_height - self.steepness * farthest)
        return np.where(np.isfinite(self.steepness) & (self.steepness < 1e29), constant, -np.inf)

    def moments(self) -> Moments:
        """Moments of the liquid about the rotation axis and the floor, over the density."""
        return moments(self.chamber, self.eccentricity, self.steepness, self.wetted_height)

    def unbalance(self) -> tuple[Array, Array]:
        """First moment of the liquid about the rotation axis and its slope in e at fixed volume.

        Returns
        -------
        first_moment : int x dV, m^4, shape (...,)
        slope : its derivative with respect to the eccentricity, m^3, shape (...,); V + 2 beta times the
            spread of the free surface's plan [theory: statics, eq. 17]
        """
        x, plan, plan_x, plan_xx = _over_walls(
            wall_arc.unbalance,
            (3, 0, 1, 2),
            *_walls(self.chamber, self.eccentricity, self.steepness, self.wetted_height),
        )
        mean = np.divide(plan_x, plan, out=np.zeros_like(plan), where=plan > 0.0)
        return x, self.volume + 2.0 * np.maximum(plan_xx - mean * plan_x, 0.0)


@dataclass(frozen=True)
class _Wall:
    """A cylindrical wall in its own units: the liquid inside the outer one less that inside the inner one."""

    sign: float
    radius: float
    height: float
    eps: Array
    steep: Array
    zeta: Array


def _walls(chamber: Chamber, e: Array, steep: Array, zeta: Array) -> list[_Wall]:
    eps = e / chamber.radius
    walls = [_Wall(1.0, chamber.radius, chamber.height, eps, steep, zeta)]
    if chamber.inner_radius > 0.0:
        ratio = chamber.inner_radius / chamber.radius
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
    for wall in walls:
        scales = np.array([wall.sign * wall.radius**power * wall.height for power in powers])
        eps, steep, zeta = wall.eps.ravel(), wall.steep.ravel(), wall.zeta.ravel()
        # Some hundred nodes a state: a few hundred states at once stay in the processor's cache.
        for start in range(0, eps.size, _CHUNK):
            part = slice(start, start + _CHUNK)
            total[:, part] += scales[:, None] * np.stack(integrals(eps[part], steep[part], zeta[part]))
    return tuple(row.reshape(shape) for row in total)


def _all_moments(eps: Array, steep: Array, zeta: Array) -> tuple[Array, ...]:
    m = wall_arc.integrate(eps, steep, zeta)
    return m.volume, m.x, m.z, m.xx, m.yy, m.zz, m.xz


def moments(chamber: Chamber, eccentricity: ArrayLike, steep: ArrayLike, wetted_height: ArrayLike) -> Moments:
    """Moments of the liquid under a given surface.

    Parameters
    ----------
    chamber : the chamber
    eccentricity : e, m, shape (...,)
    steep : beta R^2/h, shape (...,)
    wetted_height : height of the unclamped surface at the farthest wall point over h, shape (...,)

    Returns
    -------
    Moments about the rotation axis and the chamber's floor, over the density, shape (...,)
    """
    e, b, zeta = _same_shape(eccentricity, steep, wetted_height)
    v, x, z, xx, yy, zz, xz = _over_walls(_all_moments, (2, 3, 2, 4, 4, 2, 3), *_walls(chamber, e, b, zeta))
    h = chamber.height
    none = np.zeros_like(v)
    return Moments(volume=v, x=x, y=none, z=z * h, xx=xx, yy=yy, zz=zz * h**2, xy=none, xz=xz * h, yz=none)


def volume_under(chamber: Chamber, eccentricity: Array, steep: Array, wetted_height: Array) -> Array:
    """Volume of the liquid under a given surface, m^3, shape (...,); see `moments` for the parameters."""
    return _volume_and_plan(chamber, eccentricity, steep, wetted_height)[0]


def equilibrium(
    chamber: Chamber,
    volume: ArrayLike,
    eccentricity: ArrayLike,
    speed: ArrayLike,
    gravity: ArrayLike = 9.81,
) -> Equilibrium:
    """Surface of a given volume of liquid that turns as a whole about an axis off the chamber's centre.

    The surface is found by Newton steps on the logarithm of wet over dry volume, kept inside a bracket that
    every step shrinks; a step that leaves the bracket is replaced by bisection.

    Parameters
    ----------
    chamber : the chamber
    volume : V, m^3, shape (...,), from 0 to the chamber's capacity
    eccentricity : e, m, shape (...,), >= 0
    speed : spin speed Omega, rad/s, shape (...,)
    gravity : along the axis g, m/s^2, shape (...,); 0 for a horizontal axis

    Returns
    -------
    Equilibrium, shapes broadcast together

    Raises
    ------
    InputError : a volume outside the chamber, a negative or non-finite eccentricity, speed or gravity

    Examples
    --------
    >>> from meshes.chamber import Chamber
    >>> state = equilibrium(Chamber(0.2, 0.05), 54.43957239e-6, 0.001, 90.0)
    >>> bool(abs(state.nearest_depth) < 1e-6)  # the surface just touches the near wall at the floor
    True
    """
    v, e, spin, g = _same_shape(volume, eccentricity, speed, gravity)
    _check("eccentricity", e)
    _check("speed", spin)
    _check("gravity", g)
    _check("volume", v)
    # A volume given as the capacity may exceed it by rounding.
    if np.any(v > chamber.capacity * (1.0 + 1e-12)):
        worst = float(np.max(v))
        raise InputError("volume", worst, f"at most the chamber's capacity ({chamber.capacity:g} m^3)")
    steep = steepness(spin, g, chamber.radius, chamber.height)
    zeta, reached, converged = _solve(chamber, np.minimum(v, chamber.capacity), e, steep)
    nearest = zeta - 4.0 * steep * e / chamber.radius
    return Equilibrium(chamber, e, steep, zeta, nearest, reached, converged)


def optimal_volume(
    chamber: Chamber, eccentricity: ArrayLike, speed: ArrayLike, gravity: ArrayLike = 9.81
) -> Array:
    """Volume whose surface just touches the near wall at the floor [DR18, eq. 18-19; theory: statics, eq. 8].

    Less leaves a dry patch, more does not change the liquid's unbalance.

    Parameters
    ----------
    chamber : the chamber
    eccentricity : deflection e, m, shape (...,)
    speed : spin speed Omega, rad/s, shape (...,)
    gravity : along the axis, m/s^2, shape (...,)

    Returns
    -------
    V, m^3, shape (...,)

    Examples
    --------
    >>> from meshes.chamber import Chamber
    >>> print(f"{optimal_volume(Chamber(0.2, 0.05), 0.001, 90.0) * 1e6:.8f} ml")
    54.43957239 ml
    """
    e, spin, g = _same_shape(eccentricity, speed, gravity)
    _check("eccentricity", e)
    _check("speed", spin)
    _check("gravity", g)
    steep = steepness(spin, g, chamber.radius, chamber.height)
    return volume_under(chamber, e, steep, 4.0 * steep * e / chamber.radius)


def _solve(chamber: Chamber, volume: Array, e: Array, steep: Array) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Wetted height for a volume, the volume reached, and whether it is the one asked for."""
    capacity = chamber.capacity
    shape = volume.shape
    volume, e, steep = volume.ravel(), e.ravel(), steep.ravel()
    eps = e / chamber.radius
    nearest = np.where(eps < 1.0, 0.0, eps - 1.0)
    full = 1.0 + steep * (1.0 + eps - nearest) * (1.0 + eps + nearest)
    fill = volume / capacity
    zeta = np.where(fill >= 1.0, full, 0.0)
    reached = np.where(fill >= 1.0, capacity, 0.0)
    converged = (fill <= 0.0) | (fill >= 1.0)
    # The depth nowhere exceeds the wetted height, so the fill is a lower bound of it.
    low, high = np.minimum(fill, full), full.copy()
    # A nearly flat surface stands at that bound.
    guess = np.where(full < 2.0, low, np.sqrt(low * high))
    for _ in range(_ITERATIONS):
        todo = np.flatnonzero(~converged)
        if todo.size == 0:
            break
        z, v = guess[todo], volume[todo]
        wet, plan = _volume_and_plan(chamber, e[todo], steep[todo], z)
        off = wet - v
        low[todo] = np.where(off <= 0.0, z, low[todo])
        high[todo] = np.where(off >= 0.0, z, high[todo])
        bottom, top = low[todo], high[todo]
        zeta[todo], reached[todo] = z, wet
        # Rounding of zeta alone moves the volume by plan * zeta units in the last place.
        converged[todo] = (np.abs(off) <= _ROUNDING * np.maximum(v, plan * z)) | (
            top - bottom <= _ROUNDING * top
        )
        step = _logit_step(z, full[todo], wet, v, capacity, plan)
        converged[todo] |= (np.abs(step - z) <= _ROUNDING * z) & (np.abs(off) <= 1e-12 * v)
        middle = np.where(top > 4.0 * bottom, np.sqrt(bottom * top), 0.5 * (bottom + top))
        guess[todo] = np.where((step > bottom) & (step < top), step, middle)
    return zeta.reshape(shape), reached.reshape(shape), converged.reshape(shape)


def _logit_step(
    zeta: Array, full: Array, reached: Array, volume: Array, capacity: float, plan: Array
) -> Array:
    """Newton step on log(wet/dry) as a function of log(zeta/(full - zeta)); nan-free, may be outside."""
    tiny = np.finfo(float).tiny
    wet, dry = np.maximum(reached, tiny), np.maximum(capacity - reached, _ROUNDING * capacity)
    left = np.maximum(full - zeta, _ROUNDING * full)
    target = np.log(np.maximum(volume, tiny)) - np.log(np.maximum(capacity - volume, _ROUNDING * capacity))
    off = np.log(wet) - np.log(dry) - target
    slope = plan * (capacity / (wet * dry)) * (zeta * left / full)
    shift = np.clip(np.divide(off, slope, out=np.zeros_like(off), where=slope > 0.0), -50.0, 50.0)
    odds = zeta / left * np.exp(-shift)
    return np.asarray(full * odds / (1.0 + odds))


def _volume_and_plan(chamber: Chamber, e: Array, steep: Array, zeta: Array) -> tuple[Array, Array]:
    """Volume under the surface and its derivative with respect to the wetted height over h."""
    volume, plan = _over_walls(wall_arc.volume_and_plan, (2, 2), *_walls(chamber, e, steep, zeta))
    return volume, plan


def _same_shape(*values: ArrayLike) -> tuple[Array, ...]:
    return tuple(np.array(x) for x in np.broadcast_arrays(*(np.asarray(v, dtype=float) for v in values)))


def _check(field: str, value: Array) -> None:
    wrong = ~(np.isfinite(value) & (value >= 0.0))
    if np.any(wrong):
        raise InputError(field, float(value[wrong].flat[0]), "a finite number, 0 or above")
