"""A pool at the bottom of a lying chamber: a segment of its circle that leans, sloshes and is carried along.

The free surface stays a straight line; the pool is a pendulum about the chamber's axis, right in its statics
and in its slowest frequency [theory: pool].
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fluid.fill import FULL, Fill
from fluid.friction.baffles import loss_coefficient, open_share
from fluid.friction.laws import Friction, FrictionLaw, stokes_coefficient
from fluid.friction.pipe import bisected, drag_speed
from meshes.arrays import Array

# Of the slowest mode on the strip: shape functions, length of the strip, points of Gauss. Twice as many of
# each change the frequency by 2e-8.
_TERMS, _STRIP, _POINTS = 40, 20.0, 200


@dataclass(frozen=True)
class Pool:
    """A pool at rest and as a pendulum."""

    mass: float  #: m, kg
    arm: float  #: distance of the centre of mass from the axis l_c, m
    length: float  #: of the pendulum l = g/omega^2, from the slowest sloshing, m; at least the arm
    half_angle: float  #: half of the wetted arc of the outer wall, rad
    inner_half_angle: float  #: the same of the inner wall, 0 where it is dry, rad
    area: float  #: of the section A, m^2
    square: float  #: integrals of r^2 and r^3 over the section, m^4 and m^5
    cube: float

    @property
    def inertia(self) -> float:
        """Moment of inertia J = m l_c l of the motion about the axis, kg m^2 [theory: pool, eq. 5]."""
        return self.mass * self.arm * self.length


def pool_of(fill: Fill) -> Pool | None:
    """The liquid lying at the bottom of a chamber; None where there is no free surface (empty or full)."""
    chamber = fill.chamber
    if not 0.0 < fill.volume < chamber.capacity * FULL:
        return None
    radius, inner, area = chamber.radius, chamber.inner_radius, fill.volume / chamber.height
    height = _level(radius, inner, area)
    outer, hole = _segment(radius, height), _segment(inner, height)
    arm = (outer.moment - hole.moment) / area
    square = outer.square - hole.square
    # In a gap that is full the liquid goes round as a body; without an inner wall in it it does not turn.
    length = square / (area * arm) if hole.half_angle > 0.0 else radius / sloshing_number(outer.half_angle)
    return Pool(
        mass=fill.mass,
        arm=arm,
        length=max(length, arm),
        half_angle=outer.half_angle,
        inner_half_angle=hole.half_angle,
        area=area,
        square=square,
        cube=outer.cube - hole.cube,
    )


def sloshing_number(half_angle: float) -> float:
    """Slowest frequency of a liquid in a lying cylinder, omega^2 R/g [theory: pool, eq. 3-4].

    For half of the wetted arc, rad: 1 for a shallow pool, 1.3557 for a half full cylinder.
    """
    point, weight = np.polynomial.legendre.leggauss(_POINTS)
    place = 0.5 * _STRIP * (point + 1.0)
    number = (np.arange(_TERMS) + 0.5) * math.pi / _STRIP
    shape = np.sin(np.outer(number, place))
    metric = 0.25 * _STRIP * weight * math.sin(half_angle) / np.square(np.cosh(0.5 * place))
    scale = 1.0 / np.sqrt(0.5 * _STRIP * number * np.tanh(number * half_angle))
    matrix = scale[:, None] * ((shape * metric) @ shape.T) * scale
    return 1.0 / float(np.linalg.eigvalsh(matrix)[-1])


def wall_torque(fill: Fill, pool: Pool, friction: Friction, rotation: ArrayLike) -> Array:
    """Torque of walls and baffles on a pool past which they move, N m [theory: pool, eq. 6-7].

    Of the sign of `rotation`, the chamber's relative to the pool; the laminar law at the frequency at which a
    point of the wall comes by.
    """
    turn = np.asarray(rotation, dtype=float)
    pushed = _baffle_factor(fill, pool) * turn * np.abs(turn)
    return np.asarray(_shear_torque(fill, pool, friction, turn) + pushed)


def _shear_torque(fill: Fill, pool: Pool, friction: Friction, turn: Array) -> Array:
    """Torque of the walls' shear."""
    chamber, density = fill.chamber, fill.liquid.density
    radius, inner, height = chamber.radius, chamber.inner_radius, chamber.height
    # Of the walls the integrals of r^2 and r^3, of floor and lid those of their section.
    arcs = (radius, 2.0 * pool.half_angle), (inner, 2.0 * pool.inner_half_angle)
    walls_2 = sum(height * arc * r**3 for r, arc in arcs)
    walls_3 = sum(height * arc * r**4 for r, arc in arcs)
    if friction.law is FrictionLaw.LINEAR:
        return np.asarray(friction.coefficient * density * height * pool.square * turn)
    if friction.law is FrictionLaw.STOKES:
        shear = stokes_coefficient(fill.liquid.viscosity, turn)
        return np.asarray(density * shear * turn * (walls_2 + 2.0 * pool.square))
    if friction.law is FrictionLaw.QUADRATIC:
        return np.asarray(density * friction.coefficient * turn * np.abs(turn) * walls_3)
    if friction.law is FrictionLaw.WALL:
        # The factor of the speed at the wall; within floor and lid the shear falls with r^2.
        wet = 2.0 * height * (pool.half_angle * radius + pool.inner_half_angle * inner) + 2.0 * pool.area
        diameter = 4.0 * pool.area * height / wet
        shear = drag_speed(radius * turn, diameter, fill.liquid.viscosity, friction.roughness)
        return np.asarray(density * shear / radius * turn * (walls_3 + 2.0 * pool.cube))
    return 0.0 * turn


# Drag coefficient of a plate on a wall under much liquid, and the open share below which more closes nothing.
_PLATE, _NARROW = 1.2, 0.05


def _baffle_factor(fill: Fill, pool: Pool) -> float:
    """Torque of the baffles under a pool over the rotation squared, kg m^2 [theory: pool, eq. 7]."""
    chamber = fill.chamber
    if chamber.baffles is None:
        return 0.0
    baffles, radius = chamber.baffles, chamber.radius
    tip, gap = radius - baffles.tip_radius, baffles.wall_gap
    depth = pool.area / (2.0 * pool.half_angle * radius)
    plate = _PLATE * (min(tip, depth) - min(gap, depth))
    loss = loss_coefficient(max(float(open_share(depth, tip, gap)), _NARROW))
    width = max(plate, loss * depth) if baffles.loss is None else baffles.loss * depth
    lever = radius - 0.5 * (min(tip, depth) + min(gap, depth))
    wet = baffles.count * pool.half_angle / math.pi
    return float(0.5 * fill.liquid.density * chamber.height * wet * width * lever**3)


def balance_speed(fill: Fill, pool: Pool, friction: Friction, gravity: float) -> float:
    """Spin speed at which the walls' drag lifts a pool to the axis' height, rad/s [theory: pool, eq. 8].

    Above it gravity cannot hold the pool; inf where 1e9 times the pendulum's frequency does not suffice.
    """
    weight = pool.mass * gravity * pool.arm

    def held(speed: float) -> bool:
        return float(wall_torque(fill, pool, friction, speed)) < weight

    unit = math.sqrt(gravity / pool.length)
    if not held(_SLOWEST * unit):
        return 0.0
    if held(_FASTEST * unit):
        return math.inf
    ends = math.log(_SLOWEST), math.log(_FASTEST)
    return unit * math.exp(bisected(lambda log: held(unit * math.exp(log)), *ends))


# Spin speeds between which a balance is looked for, over the pendulum's frequency.
_SLOWEST, _FASTEST = 1e-9, 1e9


@dataclass(frozen=True)
class _Segment:
    """Part of a disc below a level: half of its arc; area; first moment about the axis; of r^2 and r^3."""

    half_angle: float
    area: float
    moment: float
    square: float
    cube: float


def _segment(radius: float, height: float) -> _Segment:
    """Part of a disc that lies at least `height` below its centre [theory: pool, eq. 1-2]."""
    if radius <= height:
        return _Segment(0.0, 0.0, 0.0, 0.0, 0.0)
    if height <= -radius:
        whole = math.pi * radius**2
        return _Segment(math.pi, whole, 0.0, 0.5 * whole * radius**2, 0.4 * whole * radius**3)
    alpha = math.acos(height / radius)
    s, c = math.sin(alpha), math.cos(alpha)
    if alpha < 0.004:
        # The closed forms lose their digits, the series its fourth power: 3e-10.
        area = radius**2 * (2.0 / 3.0) * alpha**3 * (1.0 - 0.2 * alpha**2)
        moment = 2.0 / 3.0 * (radius * s) ** 3
        square, cube = area * radius**2 * (1.0 - 0.4 * alpha**2), area * radius**3 * (1.0 - 0.6 * alpha**2)
        return _Segment(alpha, area, moment, square, cube)
    square = 0.5 * radius**4 * (alpha - s * c * (c * c + s * s / 3.0))
    return _Segment(
        half_angle=alpha,
        area=radius**2 * (alpha - s * c),
        moment=2.0 / 3.0 * (radius * s) ** 3,
        square=square,
        cube=radius**5 * _cube(alpha),
    )


def _cube(alpha: float) -> float:
    """Integral of r^3 over a segment of the unit disc."""
    if alpha > 0.5 * math.pi:
        return 0.4 * math.pi - _cube(math.pi - alpha)
    s, c = math.sin(alpha), math.cos(alpha)
    rest = 0.25 * s * c + 0.375 * s * c**3 + 0.375 * c**5 * math.log((1.0 + s) / max(c, 1e-300))
    return 0.4 * (alpha - rest)


def _level(radius: float, inner: float, area: float) -> float:
    """How far the level lies below the axis, m, for the liquid between two circles to have an area."""

    def too_low(height: float) -> bool:
        return _segment(radius, height).area - _segment(inner, height).area > area

    return bisected(too_low, -radius, radius)
