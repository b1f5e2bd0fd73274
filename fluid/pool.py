"""A pool at the bottom of a lying chamber: its shape, its slowest sloshing, and when it becomes a ring.

The free surface is a straight line; small swings are those of a pendulum about the chamber's axis. Beside it
the closures of the two layers, a stream that walls and baffles drive and a pool upon it, as functions of
single numbers over R, which compiled steps take over [theory: pool].
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import ArrayLike

from fluid.fill import FULL, Fill
from fluid.friction.baffles import loss_coefficient, open_share
from fluid.friction.laws import Friction, FrictionLaw, stokes_coefficient
from fluid.friction.pipe import bisected, drag_speed, hydraulic_diameter
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
    number, unit = _strip()
    scale = 1.0 / np.sqrt(0.5 * _STRIP * number * np.tanh(number * half_angle))
    matrix = scale[:, None] * (math.sin(half_angle) * unit) * scale
    return 1.0 / float(np.linalg.eigvalsh(matrix)[-1])


@cache
def _strip() -> tuple[Array, Array]:
    """Wave numbers of the shape functions, and their products over the surface, by Gauss's rule."""
    point, weight = np.polynomial.legendre.leggauss(_POINTS)
    place = 0.5 * _STRIP * (point + 1.0)
    number = (np.arange(_TERMS) + 0.5) * math.pi / _STRIP
    shape = np.sin(np.outer(number, place))
    metric = 0.25 * _STRIP * weight / np.square(np.cosh(0.5 * place))
    return np.asarray(number, dtype=float), np.asarray((shape * metric) @ shape.T)


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


# Of the two layers' own answers in slow ramps [theory: pool, eq. 20-21]: what F must be of the mean area
# over that of the stream, less where that is shallow, and the drag times F^2 of the mean area over R^2.
_BAFFLED, _SHALLOW, _DRAGGED = 10.6, 1.5, 24.0


def centrifuging_speed(fill: Fill, friction: Friction, gravity: float) -> float:
    """Spin speed at which liquid at rest at the bottom becomes a ring, held long enough, rad/s.

    By a quasi-steady balance [theory: pool, eq. 20-21]; inf where nothing drags on the liquid.
    """
    chamber = fill.chamber
    radius, baffles = chamber.radius, chamber.baffles
    stands, unit = math.sqrt(gravity / fill.surface_radius), math.sqrt(gravity / radius)
    mean = fill.volume / (2.0 * math.pi * chamber.height * radius**2)
    tip, plates, bare = 0.0, 0.0, 1.0
    if baffles is not None:
        if baffles.tip_radius <= chamber.inner_radius:
            return stands
        tip = 1.0 - baffles.tip_radius / radius
        often = baffles.count / (2.0 * math.pi)
        width = DRAG * (tip - baffles.wall_gap / radius) if baffles.loss is None else baffles.loss * tip
        plates = 0.5 * often * width
        bare = max(1.0 - SHELTERS * often * tip, 0.0)

    def held(log: float) -> bool:
        speed = unit * math.exp(log)
        froude = (speed / unit) ** 2
        wall = bare * wall_shear(fill, friction, speed) / (speed * radius)
        if (wall + plates) * froude**2 < _DRAGGED * mean:
            return True
        stream = mean / max(tip, wall * froude)
        return baffles is not None and froude < _BAFFLED * stream * min(stream / _SHALLOW, 1.0)

    if held(math.log(_FASTEST)):
        return math.inf
    return max(stands, unit * math.exp(bisected(held, math.log(_SLOWEST), math.log(_FASTEST))))


def wall_shear(fill: Fill, friction: Friction, speed: float) -> float:
    """Shear over density and slip of liquid at rest on a wall that turns, m/s [theory: friction, eq. 1]."""
    viscosity, slip = fill.liquid.viscosity, speed * fill.chamber.radius
    if friction.law is FrictionLaw.LINEAR:
        return friction.coefficient * fill.depth
    if friction.law is FrictionLaw.STOKES:
        return float(stokes_coefficient(viscosity, speed))
    if friction.law is FrictionLaw.QUADRATIC:
        return friction.coefficient * slip
    if friction.law is FrictionLaw.WALL:
        diameter = float(hydraulic_diameter(fill.depth, fill.chamber.height))
        return float(drag_speed(slip, diameter, viscosity, friction.roughness))
    return 0.0


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


# Constants of the closures. Depth of the stream over the height of the baffles, and how often a passage of
# one renews it: what the picture says; a free search over the computed runs gave 1.01 and 0.99.
DEPTH, RENEWED = 1.0, 1.0
# Drag coefficient of a baffle in the stream and friction factor between the two layers, fitted to the two
# computed runs of 6 mm: 2.4 to 2.8 and 0.012 to 0.016 do as well.
DRAG, INTERFACE = 2.4, 0.012
# Share of the pressure at the wall that a baffle in the pool can be pushed with, its back being open to the
# air: from the computed rings at 40 rad/s.
VENTED = 0.6
# Viscosity along the wall over slip and depth, without which two layers of unlike speed have no solution.
SPREADS = 0.1
# Flow that a smooth wall draws into a stream over its shear velocity squared over its speed, from the
# similarity of a turbulent layer on a wall that moves through liquid at rest, with the 1/7 power profile.
DRAWN = 2.72
# Heights of a plate over which it shelters the wall, before and behind, as a fence does in a flow along one.
SHELTERS = 15.0
# Speed of waves in a full gap over sqrt(g R): 2 to 7 change little.
SLOT = 5.0
# A baffle that the liquid hardly passes counts as this many of its heights.
_MOST = 20.0


def surface_of(area: float, full: float) -> float:
    """Radius of the surface r of a layer of this area, at least that of the inner wall."""
    held: float = area if area < full else full
    return math.sqrt(1.0 - 2.0 * held)


def static_pressure(surface: float, pull: float) -> float:
    """Integral of the pressure over the depth by a radial pull alone [theory: pool, eq. 10]."""
    # (1 - r)/2 - (1 - r^3)/6 = (1 - r)^2 (2 + r)/6, without cancellation.
    depth = 1.0 - surface
    return pull * depth * depth * (2.0 + surface) / 6.0


def level_of(area: float, surface: float, pull: float, full: float, slot: float) -> float:
    """What is alike all over liquid at rest: r G, less the pressure in a full gap [theory: pool, eq. 11]."""
    beyond: float = area - full
    return surface * pull - (slot * beyond / full if beyond > 0.0 else 0.0)


def area_at(level: float, pull: float, rim: float, full: float, slot: float) -> float:
    """Area that liquid at rest of a level has where the radial pull is G > 0, 0 where it is dry."""
    surface = level / pull
    if surface >= 1.0:
        return 0.0
    if surface >= rim:
        return 0.5 * (1.0 - surface) * (1.0 + surface)
    return full + full * (rim * pull - level) / slot


def pool_resistance(depth: float, tip: float, gap: float, loss: float) -> float:
    """Length Z_0 of the drag of one baffle under a pool [theory: pool, eq. 15].

    `loss`: a coefficient given by the user over the mean depth, below 0 for the law of the orifice.
    """
    if loss >= 0.0:
        return loss * depth
    most = _MOST * (tip - gap)
    share = (depth - tip if depth > tip else 0.0) + (depth if depth < gap else gap)
    share = share / depth if depth > 0.0 else 0.0
    if share <= 0.01:
        return most
    lost = 1.0 / ((0.58 + 0.42 * share * share * share) * share) - 1.0
    found = depth * lost * lost
    return found if found < most else most
