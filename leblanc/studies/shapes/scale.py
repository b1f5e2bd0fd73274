"""How much larger than it is a picture draws the deflection, and how much deeper the liquid."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fluid.fill import Fill
from leblanc.plotting.bodies import MachineMotion, Scale, rounded_down
from leblanc.studies.shapes.bodies import is_cut, meets_inner_wall
from meshes.arrays import Array, Complex
from meshes.chamber import Chamber
from meshes.errors import InputError
from meshes.liquid_section import free_sides
from meshes.refine.waterline import area_outside
from solvers.statics.hydrostatics import equilibrium, optimal_volume

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
GAP = 0.02  # over the radius, between an inner wall and a surface drawn larger that does not meet it
SHARES = 21  # of the exponent with which factors that do not fit are tried again
_HALVINGS = 60


def drawn_volume(fill: Fill, depth: float) -> float:
    """Volume of a liquid layer drawn deeper than it is.

    In a section of its own the layer grows by as much everywhere as where it is thinnest.
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

    m, shape (s,).
    """
    if is_cut(fill):
        return np.full(speed.shape, depth * fill.depth if fill.uneven else math.inf)
    return drying_deflection(fill.chamber, drawn_volume(fill, depth), speed, gravity)


def drying_deflection(chamber: Chamber, volume: float, speed: Array, gravity: float) -> Array:
    """Deflection at which the wall just falls dry [theory: statics, eq. 8]."""
    low, high = np.zeros(speed.shape), np.full(speed.shape, chamber.radius)
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        wet = optimal_volume(chamber, middle, speed, gravity) <= volume
        low, high = np.where(wet, middle, low), np.where(wet, high, middle)
    return low


def choose_scale(
    fills: tuple[Fill, ...], deflection: Complex, speed: Array, gravity: float, length: float = 0.0
) -> Scale:
    """Factors that make the deflection visible and leave what the liquid touches as it is.

    As much liquid as there is, unless its layer is too thin to be seen: then it is drawn deeper. The
    deflection grows until the wall is about to fall dry. If it is dry at one of the instants, the deflection
    is drawn as it is, or both grow by the same factor, which leaves wet what is wet and dry what is dry. A
    surface that meets no inner wall meets none as drawn: both factors fall until there is room.
    """
    wanted = _visible(fills, deflection, speed, gravity, length)
    return _with_room(wanted, fills, deflection, speed, gravity)


def _with_room(
    wanted: Scale, fills: tuple[Fill, ...], deflection: Complex, speed: Array, gravity: float
) -> Scale:
    """Lower factors, if liquid would meet an inner wall that it does not meet."""
    if wanted.deflection <= 1.0 and wanted.depth == 1.0:
        return wanted
    found = np.where(np.isfinite(deflection), deflection, 0.0)
    clear = [
        ~_meets_inner_wall(fill, found[:, k], speed, gravity, Scale(), 0.0) for k, fill in enumerate(fills)
    ]
    for share in np.linspace(1.0, 0.0, SHARES):
        scale = replace(
            wanted,
            deflection=_power(wanted.deflection, float(share)),
            depth=_power(wanted.depth, float(share)),
        )
        if not any(
            _meets_inner_wall(fill, found[free, k], speed[free], gravity, scale, GAP).any()
            for k, (fill, free) in enumerate(zip(fills, clear, strict=True))
        ):
            break
    return scale


def _power(factor: float, share: float) -> float:
    """Of a factor above 1; smaller ones are needed for the deflection to fit at all."""
    return factor if factor <= 1.0 or share == 1.0 else _two_digits(factor**share)


def _meets_inner_wall(
    fill: Fill, deflection: Complex, speed: Array, gravity: float, scale: Scale, gap: float
) -> NDArray[np.bool_]:
    """Where liquid comes as near to an inner wall as the gap, over the chamber's radius, shape (s,)."""
    chamber, volume = fill.chamber, drawn_volume(fill, scale.depth)
    moved = scale.deflection * deflection
    if fill.volume == 0.0 or fill.depth == 0.0 or moved.size == 0:
        return np.zeros(moved.shape, dtype=bool)
    if is_cut(fill):
        # The widest deflection and the slowest speed, at which a bowl reaches farthest over the floor.
        found = np.zeros(moved.shape, dtype=bool)
        for k in {int(np.abs(moved).argmax()), int(speed.argmin())}:
            here = complex(moved[k]), float(speed[k])
            found[k] = meets_inner_wall(fill, volume, *here, gravity, scale.depth, gap)
        return found
    if chamber.inner_radius == 0.0:
        return np.zeros(moved.shape, dtype=bool)
    reach = equilibrium(chamber, volume, np.abs(moved), speed, gravity).farthest_depth
    return np.asarray(reach > chamber.radius * (1.0 - gap) - chamber.inner_radius)


def _visible(
    fills: tuple[Fill, ...], deflection: Complex, speed: Array, gravity: float, length: float
) -> Scale:
    """Factors that make the deflection visible and keep wet walls wet and dry patches dry."""
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

    Factor of the layer's depth; largest displacement, m. Neither comes up with the area to the nearest wall
    on either side.
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
    """From the free surface inwards to the nearest wall, or to the axis, m."""
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


def given_scale(
    factor: float,
    fills: tuple[Fill, ...],
    deflection: Complex,
    speed: Array | None = None,
    gravity: float = 0.0,
) -> Scale:
    """The factor that the user gives, of the deflection alone; less where walls leave no room for it."""
    most = _room(fills, np.nan_to_num(np.abs(deflection)))
    if not (math.isfinite(factor) and 0.0 < factor <= most):
        allowed = "a finite number above 0" + ("" if math.isinf(most) else f", at most {most:.3g} here")
        raise InputError("--factor", factor, allowed)
    if speed is None:
        return Scale(factor)
    found = _with_room(Scale(factor), fills, deflection, speed, gravity)
    return found if found.deflection == factor else replace(found, asked=factor)


def scale_of(motion: MachineMotion, factor: float | None = None) -> Scale:
    """The given factor, or one that makes the deflection visible at all speeds of a machine."""
    if factor is not None:
        return given_scale(factor, motion.fills, motion.deflection, motion.speed, motion.gravity)
    return choose_scale(motion.fills, motion.deflection, motion.speed, motion.gravity, motion.length)


def scale_at(motion: MachineMotion, index: int) -> Scale:
    """The factors that fit one of the speeds."""
    rows = slice(index, index + 1)
    return choose_scale(
        motion.fills, motion.deflection[rows], motion.speed[rows], motion.gravity, motion.length
    )
