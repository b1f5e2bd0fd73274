"""Liquid at rest in a whirling, spinning chamber: surface for a given volume, unbalance, optimal volume.

The unknown is the wetted height Z of the unclamped surface above the floor at the wall's farthest point from
the rotation axis. It keeps its digits at fast spin (C loses them as beta R^2/h) and small fills
[theory: statics, eq. 12]. Integrals are what is inside the outer wall less what is inside the inner one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fluid.paraboloid import CYLINDER_STEEPNESS, Moments, steepness
from meshes.arrays import Array, Flags
from meshes.chamber import Chamber, Chambers
from meshes.errors import InputError

AnyChamber = Chamber | Chambers  # one for all states, or one for each

# Kernels that fill their last argument, of so many rows, with integrals of some states.
_Kernel = Callable[..., None]


def _sizes(chamber: AnyChamber, count: int) -> tuple[Array, ...]:
    """Radius, inner radius and height for each of some states, shape (n,)."""
    return tuple(_row(x, count) for x in (chamber.radius, chamber.inner_radius, chamber.height))


def _row(value: ArrayLike, count: int) -> Array:
    """One for each of some states, shape (n,)."""
    one = np.asarray(value, dtype=float)
    return np.ascontiguousarray(one if one.shape == (count,) else np.broadcast_to(one, count))


def _integrals(
    kernel: _Kernel, rows: int, chamber: AnyChamber, e: Array, steep: Array, zeta: Array
) -> tuple[Array, ...]:
    """What a kernel of `solvers.statics.kernel` finds, shape (...,) each."""
    found = np.zeros((rows, e.size))
    kernel(*_sizes(chamber, e.size), e.ravel(), steep.ravel(), zeta.ravel(), found)
    return tuple(row.reshape(e.shape) for row in found)


# How near to a wall, relatively, a cylinder is left to the kernel.
_CLEAR = 1e-9


def _clear_of_walls(chamber: AnyChamber, volume: Array, e: Array, steep: Array) -> Flags:
    """Where the surface is a cylinder about the rotation axis that meets no wall, shape (...,).

    Closed forms hold there [theory: statics, eq. 3 and 9], without a compiled kernel.
    """
    radius, inner = np.asarray(chamber.radius), np.asarray(chamber.inner_radius)
    film = volume / (np.pi * np.asarray(chamber.height))
    surface = np.sqrt(np.maximum(np.square(radius) - film, 0.0))
    away = e + _CLEAR * radius
    return np.asarray(
        (steep >= CYLINDER_STEEPNESS) & (away <= film / (radius + surface)) & (away <= surface - inner)
    )


def moments(
    chamber: AnyChamber, eccentricity: ArrayLike, steep: ArrayLike, wetted_height: ArrayLike
) -> Moments:
    """Moments of the liquid under a surface about the rotation axis and the floor, over the density.

    `steep` is beta R^2/h, `wetted_height` that of the unclamped surface at the farthest wall point over h.
    """
    e, b, zeta = same_shape(eccentricity, steep, wetted_height)
    from solvers.statics import kernel

    v, x, z, xx, yy, zz, xz = _integrals(kernel.moments, 7, chamber, e, b, zeta)
    h = chamber.height
    none = np.zeros_like(v)
    return Moments(volume=v, x=x, y=none, z=z * h, xx=xx, yy=yy, zz=zz * h**2, xy=none, xz=xz * h, yz=none)


def volume_under(chamber: AnyChamber, eccentricity: Array, steep: Array, wetted_height: Array) -> Array:
    """Volume of the liquid under a given surface, m^3, shape (...,); see `moments` for the parameters."""
    return volume_and_plan(chamber, eccentricity, steep, wetted_height)[0]


def volume_and_plan(chamber: AnyChamber, e: Array, steep: Array, zeta: Array) -> tuple[Array, Array]:
    """Volume under the surface and its derivative with respect to the wetted height over h; as `moments`."""
    from solvers.statics import kernel

    volume, plan = _integrals(kernel.volumes, 2, chamber, e, steep, zeta)
    return volume, plan


def plan_moments(chamber: AnyChamber, e: Array, steep: Array, zeta: Array) -> tuple[Array, ...]:
    """First moment of the liquid, m^4, and the beta-fold moments of its surface's plan; as `moments`.

    Area, first and second moment along the deflection, times beta to stay finite as the surface becomes a
    cylinder [theory: statics, eq. 17].
    """
    from solvers.statics import kernel

    return _integrals(kernel.plan_moments, 4, chamber, e, steep, zeta)


def same_shape(*values: ArrayLike) -> tuple[Array, ...]:
    """Copies of some values, broadcast to one shape."""
    own = [np.array(value, dtype=float) for value in values]
    if all(x.shape == own[0].shape for x in own):
        return tuple(own)
    return tuple(np.array(x) for x in np.broadcast_arrays(*own))


@dataclass(frozen=True)
class Equilibrium:
    """The liquid's surface at a given volume, eccentricity and speed; all shapes (...,)."""

    chamber: AnyChamber  #: the chamber, or one for each state
    eccentricity: Array  #: distance e of the rotation axis from the chamber's centre, m
    steepness: Array  #: beta R^2/h of the surface
    wetted_height: Array  #: Z over the chamber's height: unclamped surface height at the farthest wall point
    #: the same at the nearest wall point; below 0 it is dry there, above 1 wet to the lid
    nearest_depth: Array
    volume: Array  #: liquid volume reached, m^3
    converged: NDArray[np.bool_]  #: the volume was met to rounding
    clear: Flags  #: a cylinder that meets no wall: the liquid adds the mass of a full chamber

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

    @property
    def farthest_depth(self) -> Array:
        """Depth on the floor at the farthest wall point, the largest there is, m [theory: optimum, eq. 12].

        Up to the rotation axis where it covers the floor.
        """
        farthest = self.chamber.radius + self.eccentricity
        fall = np.full(farthest.shape, np.inf)
        np.divide(self.wetted_height, self.steepness, out=fall, where=self.steepness > 0.0)
        fall = np.minimum(fall * np.square(self.chamber.radius), np.square(farthest))
        return np.asarray(fall / (farthest + np.sqrt(np.square(farthest) - fall)))

    def moments(self) -> Moments:
        """Moments of the liquid about the rotation axis and the floor, over the density."""
        return moments(self.chamber, self.eccentricity, self.steepness, self.wetted_height)

    @property
    def _disc(self) -> Array:
        """Volume of the cylinder inside the outer wall, m^3."""
        return np.asarray(np.pi * np.square(self.chamber.radius) * self.chamber.height)

    def first_moment(self) -> Array:
        """First moment of the liquid about the rotation axis, m^4, shape (...,)."""
        full = self._disc * self.eccentricity
        if self.clear.all():
            return full
        from solvers.statics import kernel

        state = self.eccentricity, self.steepness, self.wetted_height
        return np.where(self.clear, full, _integrals(kernel.first_moments, 1, self.chamber, *state)[0])

    def unbalance(self) -> tuple[Array, Array]:
        """First moment of the liquid about the rotation axis, m^4, and its slope in e at fixed volume, m^3.

        The slope is V + 2 beta times the spread of the free surface's plan [theory: statics, eq. 17].
        """
        line = self._disc * self.eccentricity, np.broadcast_to(self._disc, self.eccentricity.shape)
        if self.clear.all():
            return line[0], line[1].copy()
        x, plan, plan_x, plan_xx = plan_moments(
            self.chamber, self.eccentricity, self.steepness, self.wetted_height
        )
        mean = np.divide(plan_x, plan, out=np.zeros_like(plan), where=plan > 0.0)
        slope = self.volume + 2.0 * np.maximum(plan_xx - mean * plan_x, 0.0)
        return np.where(self.clear, line[0], x), np.where(self.clear, line[1], slope)


def equilibrium(
    chamber: AnyChamber,
    volume: ArrayLike,
    eccentricity: ArrayLike,
    speed: ArrayLike,
    gravity: ArrayLike = 9.81,
) -> Equilibrium:
    """Surface of a given volume of liquid that turns as a whole about an axis off the chamber's centre.

    `gravity` is along the axis, 0 if that is horizontal; one chamber, or one for each state. Bracketed Newton
    steps on the logarithm of wet over dry volume.
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
    v = np.minimum(v, capacity)
    clear = _clear_of_walls(chamber, v, e, steep)
    eps = e / np.asarray(chamber.radius)
    disc = np.pi * np.square(chamber.radius) * np.asarray(chamber.height)
    zeta, reached, converged = steep * (v / disc + eps * (2.0 + eps)), v.copy(), np.ones(v.shape, dtype=bool)
    if not clear.all():
        found = _solve(chamber, v, e, steep)
        whole = zeta, reached, converged
        zeta, reached, converged = (np.where(clear, x, y) for x, y in zip(whole, found, strict=True))
    nearest = zeta - 4.0 * steep * eps
    return Equilibrium(chamber, e, steep, zeta, nearest, reached, converged, clear)


def optimal_volume(
    chamber: AnyChamber, eccentricity: ArrayLike, speed: ArrayLike, gravity: ArrayLike = 9.81
) -> Array:
    """Volume whose surface just touches the near wall at the floor [DR18, eq. 18-19; theory: statics, eq. 8].

    Less leaves a dry patch. Along an upright axis more still adds to the liquid's unbalance, up to the full
    one of `wall_volumes`.

    >>> from meshes.chamber import Chamber
    >>> print(f"{optimal_volume(Chamber(0.2, 0.05), 0.001, 90.0) * 1e6:.6f} ml")
    54.439572 ml
    """
    e, spin, g = same_shape(eccentricity, speed, gravity)
    _check("eccentricity", e)
    _check("speed", spin)
    _check("gravity", g)
    steep = steepness(spin, g, chamber.radius, chamber.height)
    clear = _inside_both(chamber, e, steep)
    # A cylinder about the rotation axis that touches the near wall from within.
    ring = np.pi * np.asarray(chamber.height) * e * (2.0 * np.asarray(chamber.radius) - e)
    if clear.all():
        return np.asarray(ring)
    return np.where(clear, ring, volume_under(chamber, e, steep, 4.0 * steep * e / chamber.radius))


def _inside_both(chamber: AnyChamber, e: Array, steep: Array) -> Flags:
    """Where cylinders that touch one wall from within do not meet the other, shape (...,)."""
    free = np.asarray(chamber.radius) * (1.0 - _CLEAR) - chamber.inner_radius
    return np.asarray((steep >= CYLINDER_STEEPNESS) & (2.0 * e <= free))


class WallVolumes(NamedTuple):
    """Volumes at which the free surface meets an edge of the chamber, m^3, shape (...,)."""

    wetting: Array  #: the wall is wet all round at the floor: `optimal_volume`
    lid: Array  #: the lid is touched, where the axis is farthest; nan without gravity along the axis
    inner: Array  #: the foot of the inner wall is touched; nan without one
    full: Array  #: the wall is wet all round up to the lid


def wall_volumes(
    chamber: AnyChamber, eccentricity: ArrayLike, speed: ArrayLike, gravity: ArrayLike = 9.81
) -> WallVolumes:
    """Volumes that wet the wall at the floor, touch the lid or the inner wall, wet the wall up to the lid.

    C = -beta (R - e)^2, h - beta (R + e)^2, -beta (R_i + e)^2, h - beta (R - e)^2 [theory: statics, eq. 8,
    22, 23]. Without gravity along the axis the surface is a cylinder that meets lid and floor at once: the
    first and the last are one.
    """
    e, spin, g = same_shape(eccentricity, speed, gravity)
    wetting = optimal_volume(chamber, e, spin, g)
    radius, inner = (np.asarray(x, dtype=float) for x in (chamber.radius, chamber.inner_radius))
    steep, upright = steepness(spin, g, radius, chamber.height), g > 0.0
    foot = steep * (radius - inner) * (radius + inner + 2.0 * e) / radius**2
    clear = _inside_both(chamber, e, steep)
    # The cylinder that holds the inner wall and touches its foot.
    reached = np.pi * np.asarray(chamber.height) * (radius - inner - e) * (radius + inner + e)
    lid, full = wetting, np.full(e.shape, np.nan)
    if not (clear & ~upright).all():
        heights = np.ones_like(e), foot, 1.0 + 4.0 * steep * e / radius
        lid, met, full = (volume_under(chamber, e, steep, height) for height in heights)
        reached = np.where(clear, reached, met)
    return WallVolumes(
        wetting,
        np.where(upright, lid, np.nan),
        np.where(inner > 0.0, reached, np.nan),
        np.where(upright, full, wetting),
    )


def _solve(
    chamber: AnyChamber, volume: Array, e: Array, steep: Array
) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Wetted height for a volume, the volume reached, and whether it is the one asked for."""
    from solvers.statics import kernel

    shape, count = volume.shape, volume.size
    capacity = _row(chamber.capacity, count)
    zeta, reached, converged = np.empty(count), np.empty(count), np.empty(count, dtype=bool)
    states = volume.ravel(), e.ravel(), steep.ravel()
    kernel.wetted_heights(*_sizes(chamber, count), capacity, *states, zeta, reached, converged)
    return zeta.reshape(shape), reached.reshape(shape), converged.reshape(shape)


def _check(field: str, value: Array) -> None:
    wrong = ~(np.isfinite(value) & (value >= 0.0))
    if np.any(wrong):
        raise InputError(field, float(value[wrong].flat[0]), "a finite number, 0 or above")
