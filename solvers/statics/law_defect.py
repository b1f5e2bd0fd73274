"""How far the liquid's law is below the straight line of its added mass: closed forms, nothing is solved for.

The linear law is exact while the wall is wet to the lid all round and the inner wall is dry; beyond, the
first moment of the air that has moved is missing [theory: model_error]. Lengths over R across the axis, over
h along it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fluid.fill import Fills
from fluid.paraboloid import lens_moments, steepness
from meshes.arrays import Array, Index

# Above this steepness the surface is taken as a cylinder: the heights' sum is off by its power -3/2, as the
# exact sum is by rounding.
_CYLINDER = 1e6
_STEPS = 2  # of Newton's method from the upright surface


@dataclass(frozen=True)
class Surfaces:
    """The upright surfaces of n chambers, in the chambers' own units, shape (n,)."""

    radius: Array  #: R, m
    unit: Array  #: of unbalances, rho R^3 h, kg m
    filled: Array  #: V/(pi R^2 h)
    inner: Array  #: (R_i/R)^2
    steep: Array  #: B = beta R^2/h
    floor: Array  #: squared radius of the surface where its paraboloid cuts the floor's plane, may be below 0
    straight: Array  #: deflection up to which the unbalance is the full mass times the deflection, over R

    def at(self, which: Index) -> Surfaces:
        """Those at some indices, shape (m,)."""
        return Surfaces(*(getattr(self, name)[which] for name in self.__dataclass_fields__))


def upright_surfaces(fills: Fills, speed: Array, gravity: Array) -> Surfaces:
    """Concentric surfaces, and how far the axis may move before the law bends.

    [theory: model_error, eq. 3 and 4]
    """
    chamber = fills.chamber
    radius, height = chamber.radius, chamber.height
    inner = np.square(chamber.inner_radius / radius)
    filled = np.minimum(fills.volume / (np.pi * np.square(radius) * height), 1.0 - inner)
    steep = steepness(speed, gravity, radius, height)
    # A surface at rest has no steepness; one of a millionth is as flat and divides.
    steep = np.maximum(steep, 1e-6)
    air, ring = 1.0 - inner - filled, 1.0 / steep
    whole, bare = filled >= 0.5 * ring, air >= 0.5 * ring
    lid_clear, floor_clear = 2.0 * air * ring <= (1.0 - inner) ** 2, 2.0 * filled * ring <= (1.0 - inner) ** 2
    floor = np.select(
        [whole & bare, ~bare & lid_clear, ~whole & floor_clear],
        [
            1.0 - filled - 0.5 * ring,
            inner - ring + np.sqrt(2.0 * air * ring),
            1.0 - np.sqrt(2.0 * filled * ring),
        ],
        1.0 - ring + air * ring / (1.0 - inner) - 0.5 * (1.0 - inner),
    )
    lid = np.sqrt(np.clip(floor + ring, 0.0, 1.0))
    # The nearest wall under the lid; without cancellation for thin layers.
    outwards = np.where(bare, filled - 0.5 * ring, 1.0 - np.square(lid)) / (1.0 + lid)
    cut = np.sqrt(np.maximum(floor, 0.0)) + np.sqrt(inner)
    inwards = np.where(
        inner > 0.0, np.divide(air - 0.5 * ring, cut, out=np.zeros_like(cut), where=cut > 0.0), np.inf
    )
    straight = np.where((whole & bare) | (~bare & lid_clear), np.minimum(outwards, inwards), 0.0)
    unit = fills.density * radius**3 * height
    return Surfaces(radius, unit, filled, inner, steep, floor, np.maximum(straight, 0.0))


def defect_bound(surfaces: Surfaces, deflection: Array) -> Array:
    """Upper bound of full mass times deflection less the liquid's unbalance, kg m, shape (n,).

    Never below it, 0 while nothing is missing, near where little is [theory: model_error, eq. 7 and 8].
    """
    eps = deflection / surfaces.radius
    # The slope of the unbalance is between the liquid's mass and the full one.
    steepest = np.pi * (1.0 - surfaces.filled) * np.maximum(eps - surfaces.straight, 0.0)
    rows = np.flatnonzero((steepest > 0.0) & np.isfinite(eps))
    bound = steepest.copy()
    if rows.size:
        bound[rows] = np.minimum(bound[rows], _moved_moment(surfaces.at(rows), eps[rows]))
    return np.asarray(surfaces.unit * bound)


def _moved_moment(surfaces: Surfaces, eps: Array) -> Array:
    """First moment of the moved air over rho R^3 h, bounded from above; shape (n,)."""
    target = np.pi * (1.0 - surfaces.inner - surfaces.filled)
    # What the sums below leave to rounding, or to taking the surface as a cylinder.
    slack = np.where(
        surfaces.steep > _CYLINDER, 0.1 * surfaces.steep**-1.5 / np.sqrt(eps), 1e-15 * surfaces.steep
    )
    floor = surfaces.floor.copy()
    best = np.full(eps.shape, np.inf)
    walls = _Walls.of(surfaces, eps)
    for step in range(_STEPS + 1):
        volume, moment = walls.air(floor)
        missing = target - volume
        # No air lies farther out along the deflection than the chamber does.
        best = np.minimum(best, moment + np.abs(missing) * (1.0 + eps) + slack)
        if step < _STEPS:
            plan = _plan(surfaces, floor, eps)
            floor = floor + np.divide(missing, plan, out=np.zeros_like(plan), where=plan > 0.0)
    return np.asarray(np.maximum(best, 0.0))


@dataclass(frozen=True)
class _Walls:
    """Outer walls of n chambers, then the inner ones of those that have one, shape (m,)."""

    count: int  #: n
    rows: Index  #: the chambers with an inner wall
    both: Index  #: the chamber of each wall
    wall: Array  #: radius
    eps: Array  #: as of the chambers
    steep: Array

    @classmethod
    def of(cls, surfaces: Surfaces, eps: Array) -> _Walls:
        """Walls of some chambers."""
        rows = np.flatnonzero(surfaces.inner > 0.0)
        both = np.concatenate([np.arange(eps.size), rows])
        wall = np.concatenate([np.ones(eps.size), np.sqrt(surfaces.inner[rows])])
        return cls(eps.size, rows, both, wall, eps[both], surfaces.steep[both])

    def air(self, floor: Array) -> tuple[Array, Array]:
        """Volume of the air over R^2 h, and the moment that it takes from the full chamber, over R^3 h."""
        rows, count = self.rows, self.count
        volume, moment = self._under(floor[self.both])
        volume[rows] -= volume[count:]
        moment[rows] += np.pi * np.square(self.wall[count:]) * self.eps[count:] - moment[count:]
        return volume[:count], moment[:count]

    def _under(self, floor: Array) -> tuple[Array, Array]:
        """Volume and first moment of the air inside the cylinders of the walls [theory: statics, eq. 7]."""
        wall, eps, ring = self.wall, self.eps, 1.0 / self.steep
        flat = self.steep > _CYLINDER
        rows = np.flatnonzero(~flat)
        q, low = wall[rows], np.maximum(floor[rows], 0.0)
        high = np.maximum(floor + np.where(flat, 0.5 * ring, ring), 0.0)
        # Of the discs at the top, then of those on the floor.
        disc = np.concatenate([np.sqrt(high) / wall, np.sqrt(low) / q])
        lens = lens_moments(disc, 1.0, np.concatenate([eps / wall, eps[rows] / q]))
        area, x, polar, x_polar = (
            np.split(part, [wall.size]) for part in (lens.area, lens.x, lens.polar, lens.x_polar)
        )
        volume, moment = np.square(wall) * area[0], wall**3 * x[0]
        b, s = self.steep[rows], high[rows]
        risen = q**4 * (polar[0][rows] - polar[1]), q**5 * (x_polar[0][rows] - x_polar[1])
        volume[rows] = b * (s * volume[rows] - low * q**2 * area[1] - risen[0])
        moment[rows] = b * (s * moment[rows] - low * q**3 * x[1] - risen[1])
        return volume, moment


def _plan(surfaces: Surfaces, floor: Array, eps: Array) -> Array:
    """About B times the area of the surface's plan: how the air grows with the floor's squared radius."""
    low, high = np.maximum(floor, 0.0), np.maximum(floor + 1.0 / surfaces.steep, 0.0)
    squared = np.stack([low, 0.5 * (low + high), high])
    angles = _inside(squared, 1.0, eps) - _inside(squared, surfaces.inner, eps)
    share = np.minimum(surfaces.steep * (high - low), 1.0)
    return np.asarray(share * (angles[0] + 4.0 * angles[1] + angles[2]) / 6.0)


def _inside(squared: Array, wall: Array | float, eps: Array) -> Array:
    """Half the angle of a circle about the rotation axis inside a cylinder of a squared radius."""
    reach = squared + np.square(eps) - wall
    twice = 2.0 * np.sqrt(squared) * eps
    cosine = np.divide(reach, twice, out=np.sign(reach), where=twice > 0.0)
    return np.asarray(np.arccos(np.clip(cosine, -1.0, 1.0)))
