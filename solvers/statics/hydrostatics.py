"""Liquid at rest in a whirling, spinning chamber: surface for a given volume, unbalance, optimal volume.

The one unknown is the wetted height Z, the height of the unclamped surface above the floor at the wall's
farthest point from the rotation axis. Unlike the surface constant C it keeps its digits when the spin is fast
(C loses them as beta R^2/h) and when the fill is small [theory: statics, eq. 12]. Integrals over the liquid
are what is inside the outer wall less what is inside the inner one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fluid.paraboloid import Moments, steepness
from meshes.arrays import Array
from meshes.chamber import Chamber, Chambers
from meshes.errors import InputError
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


_ITERATIONS = 200
_ROUNDING = 8.0 * np.finfo(float).eps


@dataclass(frozen=True)
class Equilibrium:
    """The liquid's surface at a given volume, eccentricity and speed; all shapes (...,).

    Parameters
    ----------
    chamber : the chamber, or one for each state
    eccentricity : distance e of the rotation axis from the chamber's centre, m
    steepness : beta R^2/h of the surface
    wetted_height : Z over the chamber's height: unclamped surface height at the farthest wall point
    nearest_depth : the same at the nearest wall point; below 0 it is dry there, above 1 wet to the lid
    volume : liquid volume reached, m^3
    converged : the volume was met to rounding
    """

    chamber: AnyChamber
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
        x, plan, plan_x, plan_xx = plan_moments(
            self.chamber, self.eccentricity, self.steepness, self.wetted_height
        )
        mean = np.divide(plan_x, plan, out=np.zeros_like(plan), where=plan > 0.0)
        return x, self.volume + 2.0 * np.maximum(plan_xx - mean * plan_x, 0.0)


def equilibrium(
    chamber: AnyChamber,
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
    chamber : the chamber, or one for each state, shape (n,)
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
    v, e, spin, g = same_shape(volume, eccentricity, speed, gravity)
    _check("eccentricity", e)
    _check("speed", spin)
    _check("gravity", g)
    _check("volume", v)
    # A volume given as the capacity may exceed it by rounding.
    capacity = np.broadcast_to(np.asarray(chamber.capacity), v.shape)
    if np.any(v > capacity * (1.0 + 1e-12)):
        worst = int(np.argmax(v - capacity))
        allowed = f"at most the chamber's capacity ({capacity.flat[worst]:g} m^3)"
        raise InputError("volume", float(v.flat[worst]), allowed)
    steep = steepness(spin, g, chamber.radius, chamber.height)
    zeta, reached, converged = _solve(chamber, np.minimum(v, capacity), e, steep)
    nearest = zeta - 4.0 * steep * e / chamber.radius
    return Equilibrium(chamber, e, steep, zeta, nearest, reached, converged)


def optimal_volume(
    chamber: AnyChamber, eccentricity: ArrayLike, speed: ArrayLike, gravity: ArrayLike = 9.81
) -> Array:
    """Volume whose surface just touches the near wall at the floor [DR18, eq. 18-19; theory: statics, eq. 8].

    Less leaves a dry patch, more does not change the liquid's unbalance.

    Parameters
    ----------
    chamber : the chamber, or one for each state, shape (n,)
    eccentricity : deflection e, m, shape (...,)
    speed : spin speed Omega, rad/s, shape (...,)
    gravity : along the axis, m/s^2, shape (...,)

    Returns
    -------
    V, m^3, shape (...,)

    Examples
    --------
    >>> from meshes.chamber import Chamber
    >>> print(f"{optimal_volume(Chamber(0.2, 0.05), 0.001, 90.0) * 1e6:.6f} ml")
    54.439572 ml
    """
    e, spin, g = same_shape(eccentricity, speed, gravity)
    _check("eccentricity", e)
    _check("speed", spin)
    _check("gravity", g)
    steep = steepness(spin, g, chamber.radius, chamber.height)
    return volume_under(chamber, e, steep, 4.0 * steep * e / chamber.radius)


def _solve(
    chamber: AnyChamber, volume: Array, e: Array, steep: Array
) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Wetted height for a volume, the volume reached, and whether it is the one asked for."""
    shape = volume.shape
    capacity = np.broadcast_to(np.asarray(chamber.capacity), shape).ravel()
    eps = (e / chamber.radius).ravel()
    volume, e, steep = volume.ravel(), e.ravel(), steep.ravel()
    nearest = np.where(eps < 1.0, 0.0, eps - 1.0)
    full = 1.0 + steep * (1.0 + eps - nearest) * (1.0 + eps + nearest)
    fill = volume / capacity
    zeta = np.where(fill >= 1.0, full, 0.0)
    reached = np.where(fill >= 1.0, capacity, 0.0)
    converged = (fill <= 0.0) | (fill >= 1.0)
    # The depth nowhere exceeds the wetted height, so the fill is a lower bound of it.
    low, high = np.minimum(fill, full), full.copy()
    # A surface clear of the walls is known [theory: statics, eq. 3]; a nearly flat one is near the bound.
    disc = np.pi * np.square(chamber.radius) * chamber.height
    clear = 0.5 + steep * (volume / disc + eps * (2.0 + eps))
    guess = np.where(full < 2.0, low, np.sqrt(low * high))
    guess = np.where((clear > low) & (clear < high), clear, guess)
    for _ in range(_ITERATIONS):
        todo = np.flatnonzero(~converged)
        if todo.size == 0:
            break
        z, v, most = guess[todo], volume[todo], capacity[todo]
        here = chamber.at(todo) if isinstance(chamber, Chambers) else chamber
        wet, plan = volume_and_plan(here, e[todo], steep[todo], z)
        off = wet - v
        low[todo] = np.where(off <= 0.0, z, low[todo])
        high[todo] = np.where(off >= 0.0, z, high[todo])
        bottom, top = low[todo], high[todo]
        zeta[todo], reached[todo] = z, wet
        # Rounding of zeta alone moves the volume by plan * zeta units in the last place.
        converged[todo] = (np.abs(off) <= _ROUNDING * np.maximum(v, plan * z)) | (
            top - bottom <= _ROUNDING * top
        )
        step = _logit_step(z, full[todo], wet, v, most, plan)
        converged[todo] |= (np.abs(step - z) <= _ROUNDING * z) & (np.abs(off) <= 1e-12 * v)
        middle = np.where(top > 4.0 * bottom, np.sqrt(bottom * top), 0.5 * (bottom + top))
        guess[todo] = np.where((step > bottom) & (step < top), step, middle)
    return zeta.reshape(shape), reached.reshape(shape), converged.reshape(shape)


def _logit_step(
    zeta: Array, full: Array, reached: Array, volume: Array, capacity: Array, plan: Array
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


def _check(field: str, value: Array) -> None:
    wrong = ~(np.isfinite(value) & (value >= 0.0))
    if np.any(wrong):
        raise InputError(field, float(value[wrong].flat[0]), "a finite number, 0 or above")
