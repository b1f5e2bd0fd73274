"""Chambers seen along the axis, drawn on axes that are handed in: wall and liquid, enlarged as needed."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from leblanc.figures.page import MOST_LINES, RIGHT, WIDTH, Figure, Frame, caption, fill, lay_out, style
from leblanc.results.base import FilledChamber
from leblanc.results.drawn import chord, rounded_down
from leblanc.results.response import RunResult, peak, phase
from leblanc.text.run import alts, amplitude_place
from leblanc.units import DEGREE, LENGTH, MINUS, MM, TIMES, in_rpm, number, with_unit
from meshes.arrays import Array, Complex
from meshes.baffles import Baffles
from meshes.chamber_section import ChamberSection
from meshes.liquid_section import free_sides

RAYS = 361  # one degree apart, closed
BISECTIONS = 60  # from the radius down to rounding

UNEVEN_RAYS = 721

Axes = Any  # matplotlib's, which no module that only draws imports

WALL, LIQUID, CENTRE, UNBALANCE = "0.15", "#56B4E9", "#D55E00", "0.15"
MOST_DRAWINGS = 3  # side by side
FRAME = Frame(left=0.15, top=0.26, between=0.6, below=0.36)
HEADING_ROW = 0.14  # inches
NOTED_LINES = 10  # of a caption with notes


@dataclass(frozen=True)
class Exaggeration:
    """Factors that the drawing applies.

    Parameters
    ----------
    deflection, depth : of the geometric centre and of the mean layer
    """

    deflection: float
    depth: float


def liquid_outline(chamber: FilledChamber, centre: complex, depth: float) -> tuple[Array, Array, Array]:
    """Liquid between the wall and the circle about the rotation axis that leaves the right area of it.

    Parameters
    ----------
    chamber : its walls are drawn to scale
    centre : geometric centre as drawn, so near that the rotation axis lies inside the inner wall, m
    depth : mean depth of the layer as drawn, m

    Returns
    -------
    Angles of rays about the rotation axis, rad; inner and outer end of the liquid on each, m; shape (361,).
    """
    angle = np.linspace(-math.pi, math.pi, RAYS)
    outer = chord(chamber.radius, centre, angle)
    floor = np.zeros_like(outer)
    if chamber.inner_radius > 0.0:
        floor = chord(chamber.inner_radius, centre, angle)
    wanted = math.pi * depth * (2.0 * chamber.radius - depth)
    low, high = 0.0, float(outer.max())
    for _ in range(BISECTIONS):
        surface = 0.5 * (low + high)
        inner = np.clip(surface, floor, outer)
        # The rays are equally spaced over a turn, where the mean is exact for smooth outlines.
        area = math.pi * float(np.mean((outer**2 - inner**2)[1:]))
        low, high = (surface, high) if area > wanted else (low, surface)
    return angle, np.clip(0.5 * (low + high), floor, outer), outer


def exaggeration(chambers: tuple[FilledChamber, ...], deflections: tuple[float, ...]) -> Exaggeration:
    """Factors that make deflection and layer visible and keep wet walls wet and dry patches dry.

    Parameters
    ----------
    chambers : those that are drawn
    deflections : amplitudes that are drawn, m, 0 or above
    """
    layers = [(c.least_depth, c) for c in chambers]
    layers = [(depth, c) for depth, c in layers if depth > 0.0]
    depth_factor = 1.0
    if layers:
        fits = min(0.5 * (c.radius - c.inner_radius) / depth for depth, c in layers)
        shows = max(0.15 * c.radius / depth for depth, c in layers)
        depth_factor = rounded_down(max(1.0, min(fits, shows)))
    sizes = [w for w in deflections if w > 0.0]
    if not sizes:
        return Exaggeration(1.0, depth_factor)
    inner = [0.9 * c.inner_radius for c in chambers if c.inner_radius > 0.0]
    widest = min([0.35 * c.radius for c in chambers] + inner) / max(sizes)
    wet = [0.9 * depth_factor * depth / w for depth, _ in layers for w in sizes if w < depth]
    factor = rounded_down(min([widest, *wet]))
    dry = [factor * w / depth for depth, _ in layers for w in sizes if w >= depth]
    # Equal factors keep what is dry dry; with unequal ones a thick layer would cover it.
    return Exaggeration(factor, factor if dry and min(dry) < depth_factor else depth_factor)


def side_by_side(chambers: tuple[FilledChamber, ...]) -> list[tuple[FilledChamber, ...]]:
    """Chambers sorted into drawings: those that lie inside one another share one, equal ones are drawn once.

    Parameters
    ----------
    chambers : of the rotor, in any order
    """
    drawings: list[list[FilledChamber]] = []
    for chamber in sorted(dict.fromkeys(chambers), key=lambda c: -c.radius):
        for drawing in drawings:
            if chamber.radius <= drawing[-1].inner_radius and chamber.plane == drawing[-1].plane:
                drawing.append(chamber)
                break
        else:
            drawings.append([chamber])
    return [tuple(drawing) for drawing in drawings]


def is_uneven(chamber: FilledChamber) -> bool:
    """Baffles or a section of its own."""
    return chamber.baffles is not None or chamber.section is not None


def wall_line(section: ChamberSection) -> list[Array]:
    """Walls of a section as closed or open lines of points, m.

    Parameters
    ----------
    section : of the chamber
    """
    sides = free_sides(section.mesh.triangles)
    ordered = sides[:, [0, 2, 1]] if sides.shape[1] == 3 else sides
    return [section.mesh.points[corners] for corners in ordered]


def bodies(chamber: FilledChamber, centre: complex, depth: float) -> list[Array]:
    """Outline of each body of liquid, m, as closed lines of points, shape (k, 2).

    Parameters
    ----------
    chamber : its walls are drawn to scale
    centre : geometric centre as drawn, from the rotation axis, m
    depth : of the undisturbed layer as drawn, m
    """
    found = []
    for angle in _sectors(chamber):
        wall = _wall(chamber, angle)
        rest = np.minimum(chamber.radius - depth, wall)
        wanted = np.trapezoid(wall**2 - rest**2, angle)
        low, high = 0.0, float(wall.max()) + abs(centre)
        for _ in range(BISECTIONS):
            level = 0.5 * (low + high)
            inner = np.clip(_surface(level, centre, angle), chamber.inner_radius, wall)
            enough = np.trapezoid(wall**2 - inner**2, angle) > wanted
            low, high = (level, high) if enough else (low, level)
        around = np.concatenate([wall * np.exp(1j * angle), (inner * np.exp(1j * angle))[::-1]]) + centre
        found.append(np.stack([around.real, around.imag], axis=1))
    return found


def plates(baffles: Baffles, radius: float, depth_factor: float) -> list[tuple[complex, complex]]:
    """Ends of each baffle from the geometric centre, m; distances from the wall grow as the layer does.

    Parameters
    ----------
    baffles : of the chamber
    radius : of its wall, m
    depth_factor : by which layers are drawn deeper
    """
    inner = max(radius - (radius - baffles.tip_radius) * depth_factor, 0.0)
    outer = max(radius - baffles.wall_gap * depth_factor, inner)
    return [(inner * complex(turn), outer * complex(turn)) for turn in np.exp(1j * baffles.angles)]


def _sectors(chamber: FilledChamber) -> list[Array]:
    """Angles of each body of liquid that cannot mix with the others."""
    baffles = chamber.baffles
    whole = np.linspace(-math.pi, math.pi, UNEVEN_RAYS)
    if baffles is None:
        return [whole]
    span = baffles.wetted_span(chamber.radius, chamber.mean_surface_radius)
    if span != (chamber.mean_surface_radius, chamber.radius):
        return [whole]
    width = 2.0 * math.pi / baffles.count
    return [start + np.linspace(0.0, width, UNEVEN_RAYS) for start in baffles.angles]


def _wall(chamber: FilledChamber, angle: Array) -> Array:
    """Distance of the outermost wall in each direction, m."""
    if chamber.section is None:
        return np.full(angle.shape, chamber.radius)
    lines = np.stack(wall_line(chamber.section))
    nodes = lines[..., 0] + 1j * lines[..., 1]
    return _outermost(nodes[:, :-1].ravel(), nodes[:, 1:].ravel(), angle)


def _outermost(start: Complex, stop: Complex, angle: Array) -> Array:
    """Distance along each ray of the outermost of many straight sides, given by their ends x + i y, m."""
    turn = np.exp(-1j * angle)[:, None]
    low, other = start * turn, stop * turn
    meets = (low.imag * other.imag <= 0.0) & (low.imag != other.imag)
    share = np.divide(low.imag, low.imag - other.imag, where=meets, out=np.zeros(meets.shape))
    away = np.where(meets, low.real + share * (other.real - low.real), 0.0)
    return np.asarray(away.max(axis=1))


def _surface(level: float, centre: complex, angle: Array) -> Array:
    """Distance from the geometric centre to a circle about the rotation axis; 0 where a ray misses it, m."""
    toward = -centre * np.exp(-1j * angle)
    square = level**2 - toward.imag**2
    return np.asarray(np.maximum(toward.real + np.sqrt(np.maximum(square, 0.0)), 0.0))


@dataclass(frozen=True)
class Views:
    """What the figure of the chambers shows.

    Parameters
    ----------
    drawings : chambers of each column
    instants : index of each view over the speeds of the curve
    scale : exaggeration, common to all views so that they can be compared
    largest : deflection of all views, m
    left_out : number of chambers that found no room
    """

    drawings: list[tuple[FilledChamber, ...]]
    instants: list[int]
    scale: Exaggeration
    largest: float
    left_out: int


def chamber_figure(result: RunResult) -> Figure:
    """Chambers as seen along the axis at the largest deflection and at the working speed."""
    views = choose_views(result)
    zero = "unbalance" if result.motion is None else result.motion.zero
    with style():
        figure = Figure()
        figure.alt = alts(result)["chamber"]
        cells = [(drawing, index) for index in views.instants for drawing in views.drawings]
        if not cells:
            axes: Axes = figure.add_axes((0, 0, 1, 1), frame_on=False, xticks=[], yticks=[])
            axes.text(0.5, 0.5, "no chamber, or no deflection found", ha="center")
            lay_out(figure, [[axes]], [1.0], FRAME, caption(result, "Chamber seen along the axis."))
            return figure
        drawn = []
        for i, (chambers, index) in enumerate(cells):
            axes = figure.add_axes((0, 0, 1, 1), label=str(i))
            at = moved(result, chambers, index)
            draw_chambers(axes, chambers, at, views, zero)
            if i % len(views.drawings) == 0:
                write_numbers(axes, result, views, index)
            drawn.append(axes)
        # Up to two drawings of each view stand in one row, more in a row for each view.
        columns = len(drawn) if len(views.drawings) < 3 else len(views.drawings)
        rows = [drawn[i : i + columns] for i in range(0, len(drawn), columns)]
        sides = [min(2.7, (WIDTH - FRAME.left - RIGHT) / columns)] * len(rows)
        part = ""
        if result.motion is not None:
            place = amplitude_place(result)
            part = f" Amplitudes are those {place}; drawn is the part of the motion that turns with the spin."
        text = caption(result, f"Chamber seen along the axis. {describe_scale(views)}{part}")
        more = HEADING_ROW * more_heading_rows(result, views)
        below = 0.0 if result.motion is None else HEADING_ROW
        frame = replace(
            FRAME, top=FRAME.top + more, between=FRAME.between + more + below, below=FRAME.below + below
        )
        lay_out(figure, rows, sides, frame, text, MOST_LINES if result.motion is None else NOTED_LINES)
    return figure


def choose_views(result: RunResult) -> Views:
    """The chambers at the resonance peak and at the working speed, the last one.

    Parameters
    ----------
    result : the study; a speed at which nothing was found is not drawn
    """
    curve = result.curve
    deflection = curve.deflection
    last, highest = deflection.size - 1, peak(curve.amplitude)
    instants = [i for i in (highest, last) if i is not None and np.isfinite(deflection[i])]
    if highest is None or highest == last or curve.amplitude[highest] == 0.0:
        instants = instants[-1:]
    drawings = side_by_side(result.chambers)
    drawn = drawings[:MOST_DRAWINGS]
    amplitudes = tuple(abs(moved(result, drawing, i)) for drawing in drawn for i in instants)
    chambers = tuple(chamber for drawing in drawn for chamber in drawing)
    scale = exaggeration(chambers, amplitudes) if chambers else Exaggeration(1.0, 1.0)
    left_out = sum(map(len, drawings[MOST_DRAWINGS:]))
    return Views(drawn, instants, scale, max(amplitudes, default=0.0), left_out)


def moved(result: RunResult, chambers: tuple[FilledChamber, ...], index: int) -> complex:
    """Deflection of the axis at the chambers of one drawing, m; the unbalance along the real axis."""
    return complex(result.chamber_curve[index, result.chambers.index(chambers[0])])


def describe_scale(views: Views) -> str:
    """The exaggeration as text."""
    deflection, depth = f"{TIMES} {views.scale.deflection:g}", f"{TIMES} {views.scale.depth:g}"
    if views.scale.depth == 1.0:
        depth = "to scale"
    text = f"Deflection drawn {deflection}, mean depth of the layer {depth}; walls to scale."
    return f"{text} {views.left_out} more chambers are not drawn." if views.left_out else text


def describe_view(result: RunResult, index: int) -> str:
    """Name and speed of one view."""
    r = result.curve
    name = "Working speed" if index == r.speed.size - 1 else "Largest deflection"
    text = f"{name}, {in_rpm(r.speed[index])}"
    return text if r.in_range[index] else f"{text}\n(model out of range)"


def more_heading_rows(result: RunResult, views: Views) -> int:
    """Lines above the drawings besides the first."""
    out_of_range = not result.curve.in_range[views.instants].all()
    return int(len(views.drawings) > 1) + int(out_of_range)


def describe_state(result: RunResult, index: int) -> str:
    """Numbers of one view as text."""
    r = result.curve
    w, offset = r.deflection[index], r.liquid_offset[index]
    if w == 0.0:
        return "no deflection"
    place = f"{with_unit(abs(w), LENGTH)} at {_degrees(float(phase(w)))}{DEGREE}"
    text = f"deflection {place}"
    if result.motion is not None:
        size = with_unit(float(result.curve.amplitude[index]), LENGTH)
        text = f"amplitude {size} at chamber 1,\nof it with the spin {place}"
    if offset > 0.0:
        text += f"\nliquid {with_unit(offset, LENGTH)} at {_degrees(float(r.liquid_angle[index]))}{DEGREE}"
    return text


def _degrees(angle: float) -> str:
    return f"{math.degrees(angle):.0f}".replace("-0", "0", 1).replace("-", MINUS)


def draw_chambers(
    axes: Axes,
    chambers: tuple[FilledChamber, ...],
    deflection: complex,
    views: Views,
    zero: str = "unbalance",
) -> None:
    """Walls, liquid, axes, unbalance and spin.

    Parameters
    ----------
    axes : an empty drawing
    chambers : that lie inside one another, the widest first
    deflection : complex, the unbalance along the real axis, m
    views : how much deflection and layer are exaggerated
    zero : what the real axis points to
    """
    centre = deflection * views.scale.deflection * MM
    widest = chambers[0].radius * MM
    reach = 1.18 * widest + views.largest * views.scale.deflection * MM
    for chamber in chambers:
        depth = (chamber.radius - chamber.mean_surface_radius) * views.scale.depth
        if is_uneven(chamber):
            _draw_uneven(axes, chamber, centre, depth, views.scale.depth)
            continue
        angle, inner, outer = liquid_outline(chamber, centre / MM, depth)
        if depth > 0.0:
            x = np.concatenate([outer * np.cos(angle), (inner * np.cos(angle))[::-1]]) * MM
            y = np.concatenate([outer * np.sin(angle), (inner * np.sin(angle))[::-1]]) * MM
            fill(axes, x, y, facecolor=LIQUID, edgecolor="none", label="liquid")
            surface = np.where(inner < outer * (1.0 - 1e-9), inner, np.nan) * MM
            axes.plot(surface * np.cos(angle), surface * np.sin(angle), color="#0072B2", linewidth=0.7)
        for radius in (chamber.radius, chamber.inner_radius):
            if radius > 0.0:
                axes.plot(*_circle(centre, radius * MM), color=WALL, linewidth=1.4)
    _unbalance(axes, centre, widest, zero)
    axes.plot([0.0, centre.real], [0.0, centre.imag], color=CENTRE, linewidth=1.2)
    axes.plot([0.0], [0.0], "+", color="black", markersize=9, markeredgewidth=1.2, label="rotation axis")
    axes.plot(
        *([centre.real], [centre.imag]),
        *("o",),
        markerfacecolor="white",
        markeredgecolor=CENTRE,
        markersize=5,
        markeredgewidth=1.3,
        label="geometric centre",
    )
    axes.set_xlim(-reach, reach)
    axes.set_ylim(-reach, reach)
    axes.set_aspect("equal")
    if len(views.drawings) > 1:
        names = ", ".join(f"{number(chamber.radius * MM)}" for chamber in chambers)
        planes = {chamber.plane for drawing in views.drawings for chamber in drawing}
        place = f", at {number(chambers[0].plane * MM)}".replace("-", MINUS) if len(planes) > 1 else ""
        axes.set_title(f"radius {names}{place} mm", fontsize=7, color="0.3", pad=3.0, y=1.0)
    axes.axis("off")


def _draw_uneven(
    axes: Axes, chamber: FilledChamber, centre: complex, depth: float, depth_factor: float
) -> None:
    """Walls, baffles and each body of liquid of a chamber that is no clear ring."""
    if depth > 0.0:
        for points in bodies(chamber, centre / MM, depth):
            fill(axes, *(points.T * MM), facecolor=LIQUID, edgecolor="none", label="liquid")
            wall, surface = np.split(points * MM, 2)
            wet = np.hypot(*(wall[::-1] - surface).T) > 1e-9 * chamber.radius * MM
            axes.plot(*np.where(wet[:, None], surface, np.nan).T, color="#0072B2", linewidth=0.7)
    if chamber.section is not None:
        for line in wall_line(chamber.section):
            axes.plot(line[:, 0] * MM + centre.real, line[:, 1] * MM + centre.imag, color=WALL, linewidth=1.4)
        return
    for radius in (chamber.radius, chamber.inner_radius):
        if radius > 0.0:
            axes.plot(*_circle(centre, radius * MM), color=WALL, linewidth=1.4)
    if chamber.baffles is not None:
        for ends in plates(chamber.baffles, chamber.radius, depth_factor):
            x, y = np.array([centre + end * MM for end in ends]).view(float).reshape(-1, 2).T
            axes.plot(x, y, color=WALL, linewidth=1.4)


def write_numbers(axes: Axes, result: RunResult, views: Views, index: int) -> None:
    """Heading above and numbers below the drawings of one view.

    Parameters
    ----------
    axes : the first of its drawings; the others follow to the right
    result, views : the study and what is shown of it
    index : of the view's speed
    """
    middle = 0.5 * len(views.drawings)
    place = {"xycoords": "axes fraction", "textcoords": "offset points", "ha": "center"}
    # Above names of the drawings if there are several.
    above = 4.0 if len(views.drawings) == 1 else 13.0
    axes.annotate(describe_view(result, index), (middle, 1.0), xytext=(0.0, above), va="bottom", **place)
    axes.annotate(describe_state(result, index), (middle, 0.0), xytext=(0.0, -2.0), va="top", **place)


def _unbalance(axes: Axes, centre: complex, radius: float, label: str) -> None:
    """A heavy spot on the wall along the unbalance, and an arrow for the sense of the spin."""
    spot = centre + radius
    arm = {"linewidth": 0.8, "linestyle": (0, (5, 2)), "color": UNBALANCE}
    axes.plot([centre.real, spot.real], [centre.imag, spot.imag], **arm)
    axes.plot([spot.real], [spot.imag], "s", color=UNBALANCE, markersize=6, label=label, zorder=4)
    sweep = np.linspace(math.radians(115.0), math.radians(155.0), 30)
    arc: Array = centre + 1.13 * radius * np.exp(1j * sweep)
    axes.plot(arc.real, arc.imag, color="0.3", linewidth=1.0)
    axes.annotate(
        *("", (arc[-1].real, arc[-1].imag)),
        xytext=(arc[-3].real, arc[-3].imag),
        arrowprops={"arrowstyle": "-|>", "color": "0.3", "linewidth": 1.0, "shrinkA": 0, "shrinkB": 0},
    )
    middle = centre + 1.25 * radius * cmath.exp(1j * math.radians(135.0))
    axes.text(middle.real, middle.imag, "spin", fontsize=7, color="0.3", ha="right", va="center")


def _circle(centre: complex, radius: float) -> tuple[Array, Array]:
    points = centre + radius * np.exp(1j * np.linspace(0.0, 2.0 * math.pi, 361))
    return points.real, points.imag
