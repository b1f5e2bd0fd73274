"""How much larger than it is a picture draws the deflection, and how much deeper the liquid."""

from __future__ import annotations

import math

import numpy as np

from fluid.fill import Fill
from leblanc.results.drawn import MachineMotion, Scale, rounded_down
from leblanc.studies.shapes.bodies import is_cut
from meshes.arrays import Array, Complex
from meshes.chamber import Chamber
from meshes.errors import InputError
from meshes.liquid_section import free_sides
from meshes.refine.waterline import area_outside
from solvers.statics.hydrostatics import optimal_volume

SHOWN = 0.15  # deflection as drawn over the widest chamber's radius, if there is room
SWING = 0.5  # the largest that a deflection drawn smaller than it is may be
THIN = 0.03  # a layer thinner than this over the radius, or half the length, is drawn deeper
DEEP = 0.12  # and then at most so deep
FILLED = 0.5  # of the room between the walls
MOST = 100.0  # beyond it a deflection is too small for a picture
CLEAR = 0.9  # of the deflection at which the wall falls dry, where it is wet
WAVE_DEPTH = 0.25  # of a layer in a mode, over the chamber's radius: less is drawn deeper, if there is room
WAVE = 0.75  # of the area that the layer has there, or that is free inside it: what a mode's wave moves
INNER = 0.9  # of an inner wall's radius, inside which the axis at rest stays
_HALVINGS = 60


def drawn_volume(fill: Fill, depth: float) -> float:
    """Volume of a liquid layer drawn deeper than it is.

    Parameters
    ----------
    fill : the chamber with its liquid
    depth : factor of the mean depth

    Returns
    -------
    m^3; that of the scene for a factor of 1. In a section of its own the layer grows by as much everywhere
    as where it is thinnest
    """
    if depth == 1.0 or (fill.chamber.section is not None and not fill.uneven):
        return fill.volume
    layer = depth * fill.depth
    if fill.chamber.section is not None:
        inner = fill.surface_radius + fill.depth - layer
        return area_outside(fill.chamber.section.mesh, inner) * fill.chamber.height
    return math.pi * fill.chamber.height * layer * (2.0 * fill.chamber.radius - layer)


def wet_deflection(fill: Fill, depth: float, speed: Array, gravity: float) -> Array:
    """Deflection up to which the wall stays wet all round.

    In a section of its own, and between closed baffles, the depth where the layer is thinnest: a bowl under
    gravity along the axis and the compartments leave more.

    Parameters
    ----------
    fill : the chamber with its liquid
    depth : factor of its depth as drawn
    speed : spin speeds, rad/s, shape (s,)
    gravity : along the axis, m/s^2

    Returns
    -------
    m, shape (s,)
    """
    if is_cut(fill):
        return np.full(speed.shape, depth * fill.depth if fill.uneven else math.inf)
    return drying_deflection(fill.chamber, drawn_volume(fill, depth), speed, gravity)


def drying_deflection(chamber: Chamber, volume: float, speed: Array, gravity: float) -> Array:
    """Deflection at which the wall just falls dry [theory: statics, eq. 8].

    Parameters
    ----------
    chamber : where the liquid is
    volume : of the liquid, m^3
    speed : spin speeds, rad/s, shape (s,)
    gravity : along the axis, m/s^2

    Returns
    -------
    m, at most the chamber's radius, shape (s,)
    """
    low, high = np.zeros(speed.shape), np.full(speed.shape, chamber.radius)
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        wet = optimal_volume(chamber, middle, speed, gravity) <= volume
        low, high = np.where(wet, middle, low), np.where(wet, high, middle)
    return low


def choose_scale(
    fills: tuple[Fill, ...], deflection: Complex, speed: Array, gravity: float, length: float = 0.0
) -> Scale:
    """Factors that make the deflection visible and keep wet walls wet and dry patches dry.

    As much liquid as there is, unless its layer is too thin to be seen: then it is drawn deeper. The
    deflection grows until the wall is about to fall dry. If it is dry at one of the instants, the deflection
    is drawn as it is, or both grow by the same factor, which leaves wet what is wet and dry what is dry.

    Parameters
    ----------
    fills : the chambers drawn, with their liquid
    deflection : of each chamber at each instant drawn, m, nan where unknown, shape (s, c)
    speed : of each instant, rad/s, shape (s,)
    gravity : along the axis, m/s^2
    length : of the machine along its axis, m
    """
    size = np.nan_to_num(np.abs(deflection))
    largest, radius = float(size.max(initial=0.0)), max((f.chamber.radius for f in fills), default=0.1)
    span = max(radius, 0.5 * length)
    if largest == 0.0:
        return Scale()
    limit = _room(fills, size)
    wanted = min(SHOWN * radius / largest, limit, MOST)
    if wanted < 1.0:
        wanted = 1.0 if limit >= 1.0 and largest <= SWING * radius else min(limit, SWING * radius / largest)
        return Scale(float(f"{rounded_down(wanted):.6g}") if wanted < 1.0 else 1.0)
    depth = _deeper(fills, span)
    alike, clear = _wettings(fills, size, speed, gravity, 1.0)
    if depth > 1.0 and not alike:
        both = _two_digits(min(wanted, depth))
        return Scale(both, both)
    if depth > 1.0:
        alike, clear = _wettings(fills, size, speed, gravity, depth)
    return Scale(_two_digits(min(wanted, clear) if alike else 1.0), depth)


def _two_digits(factor: float) -> float:
    """Rounded down for printing, at least 1."""
    return max(1.0, float(f"{rounded_down(factor):.6g}"))


def _deeper(fills: tuple[Fill, ...], span: float) -> float:
    """Factor that makes the thinnest layer visible, if there is room in all chambers."""
    layers = [f for f in fills if f.volume > 0.0 and f.depth > 0.0]
    if not any(f.depth < THIN * span for f in layers):
        return 1.0
    return _two_digits(
        min(min(DEEP * f.chamber.radius, FILLED * (f.depth + inner_room(f))) / f.depth for f in layers)
    )


def wave_scale(fill: Fill) -> tuple[float, float]:
    """How a mode of the liquid is drawn, whose true height is any small one.

    Parameters
    ----------
    fill : the chamber with its liquid

    Returns
    -------
    Factor of the layer's depth; largest displacement, m. The area of the liquid swings, m a per angle, and
    neither comes up with the area from the surface to the nearest wall on either side
    """
    room = fill.depth + inner_room(fill)
    depth = fill.depth
    if fill.chamber.section is None:
        depth = max(depth, min(WAVE_DEPTH * fill.chamber.radius, FILLED * room))
    factor = 1.0 if depth == fill.depth else _two_digits(depth / fill.depth)
    outer = fill.surface_radius + fill.depth
    rest, inner = outer - factor * fill.depth, outer - room
    return factor, WAVE * min(outer**2 - rest**2, rest**2 - inner**2) / (2.0 * rest)


def inner_room(fill: Fill) -> float:
    """From the free surface inwards to the nearest wall, or to the axis, m.

    Parameters
    ----------
    fill : the chamber with its liquid
    """
    chamber = fill.chamber
    if chamber.section is None:
        return fill.surface_radius - chamber.inner_radius
    sides = free_sides(chamber.section.mesh.triangles)
    away = np.hypot(*chamber.section.mesh.points[np.unique(sides)].T)
    inside = float(away[away < fill.surface_radius].max(initial=0.0))
    return fill.surface_radius - inside


def _wettings(
    fills: tuple[Fill, ...], size: Array, speed: Array, gravity: float, depth: float
) -> tuple[bool, float]:
    """Whether every wall is wet all round at every instant, and the factor that leaves them so."""
    wet, most = True, math.inf
    for k, fill in enumerate(fills):
        moves = size[:, k] > 0.0
        if fill.volume == 0.0 or not moves.any():
            continue
        edge, here = (
            wet_deflection(fill, share, speed, gravity)[moves] / size[moves, k] for share in (1.0, depth)
        )
        wet = wet and bool(np.all(edge >= 1.0))
        most = min(most, CLEAR * float(here.min()))
    return wet, most


def _room(fills: tuple[Fill, ...], size: Array) -> float:
    """Factor that keeps the axis at rest inside every inner wall and well inside the others."""
    most = math.inf
    for k, fill in enumerate(fills):
        largest = float(size[:, k].max(initial=0.0))
        inside = INNER * (fill.chamber.inner_radius or fill.chamber.radius)
        most = min(most, inside / largest) if largest > 0.0 else most
    return most


def given_scale(factor: float, fills: tuple[Fill, ...], deflection: Complex) -> Scale:
    """The factor that the user gives, of the deflection alone.

    Parameters
    ----------
    factor : above 0
    fills, deflection : as for `choose_scale`

    Raises
    ------
    InputError : a factor out of its range
    """
    most = _room(fills, np.nan_to_num(np.abs(deflection)))
    if not (math.isfinite(factor) and 0.0 < factor <= most):
        allowed = "a finite number above 0" + ("" if math.isinf(most) else f", at most {most:.3g} here")
        raise InputError("--factor", factor, allowed)
    return Scale(factor)


def scale_of(motion: MachineMotion, factor: float | None = None) -> Scale:
    """The given factor, or one that makes the deflection visible at all speeds of a machine.

    Parameters
    ----------
    motion : the machine at these speeds
    factor : of the deflection; None to choose it

    Raises
    ------
    InputError : a factor out of its range
    """
    if factor is not None:
        return given_scale(factor, motion.fills, motion.deflection)
    return choose_scale(motion.fills, motion.deflection, motion.speed, motion.gravity, motion.length)


def scale_at(motion: MachineMotion, index: int) -> Scale:
    """The factors that fit one of the speeds.

    Parameters
    ----------
    motion, index : the machine, which of its speeds
    """
    rows = slice(index, index + 1)
    return choose_scale(
        motion.fills, motion.deflection[rows], motion.speed[rows], motion.gravity, motion.length
    )
