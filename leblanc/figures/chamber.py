"""Chambers seen along the axis, drawn on axes that are handed in."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from leblanc.figures.section import Exaggeration, exaggeration, liquid_outline, side_by_side
from leblanc.figures.uneven import bodies, is_uneven, plates, wall_line
from leblanc.results.record import ChamberRecord, StudyRecord, peak, phase
from leblanc.units import MM, RPM
from meshes.arrays import Array

Axes = Any  # matplotlib's, which no module that only draws imports

WALL, LIQUID, CENTRE, UNBALANCE = "0.15", "#56B4E9", "#D55E00", "0.15"
MOST_DRAWINGS = 3  # side by side
TIMES, MINUS = "\N{MULTIPLICATION SIGN}", "\N{MINUS SIGN}"


@dataclass(frozen=True)
class Views:
    """What the figure of the chambers shows.

    Parameters
    ----------
    drawings : chambers of each column
    instants : index over speed of each view
    scale : exaggeration, common to all views so that they can be compared
    largest : deflection of all views, m
    left_out : number of chambers that found no room
    """

    drawings: list[tuple[ChamberRecord, ...]]
    instants: list[int]
    scale: Exaggeration
    largest: float
    left_out: int


def choose_views(record: StudyRecord) -> Views:
    """The chambers at the resonance peak and at the working speed, the last one.

    Parameters
    ----------
    record : the study; a speed at which nothing was found is not drawn
    """
    deflection = record.response.deflection
    last, highest = deflection.size - 1, peak(record.amplitude)
    instants = [i for i in (highest, last) if i is not None and np.isfinite(deflection[i])]
    if highest is None or highest == last or record.amplitude[highest] == 0.0:
        instants = instants[-1:]
    drawings = side_by_side(record.chambers)
    drawn = drawings[:MOST_DRAWINGS]
    amplitudes = tuple(abs(moved(record, drawing, i)) for drawing in drawn for i in instants)
    chambers = tuple(chamber for drawing in drawn for chamber in drawing)
    scale = exaggeration(chambers, amplitudes) if chambers else Exaggeration(1.0, 1.0)
    left_out = sum(map(len, drawings[MOST_DRAWINGS:]))
    return Views(drawn, instants, scale, max(amplitudes, default=0.0), left_out)


def moved(record: StudyRecord, chambers: tuple[ChamberRecord, ...], index: int) -> complex:
    """Deflection of the axis at the chambers of one drawing, m; the unbalance along the real axis."""
    if record.motion is None:
        return complex(record.response.deflection[index])
    return complex(record.motion.chamber_forward[index, record.chambers.index(chambers[0])])


def describe_scale(views: Views) -> str:
    """The exaggeration in words."""
    deflection, depth = f"{TIMES} {views.scale.deflection:g}", f"{TIMES} {views.scale.depth:g}"
    if views.scale.depth == 1.0:
        depth = "to scale"
    text = f"Deflection drawn {deflection}, mean depth of the layer {depth}; walls to scale."
    return f"{text} {views.left_out} more chambers are not drawn." if views.left_out else text


def describe_view(record: StudyRecord, index: int) -> str:
    """Name and speed of one view."""
    r = record.response
    name = "Working speed" if index == r.speed.size - 1 else "Largest deflection"
    text = f"{name}, {r.speed[index] * RPM:.4g} rpm"
    return text if r.in_range[index] else f"{text}\n(model out of range)"


def more_heading_rows(record: StudyRecord, views: Views) -> int:
    """Lines above the drawings besides the first."""
    out_of_range = not record.response.in_range[views.instants].all()
    return int(len(views.drawings) > 1) + int(out_of_range)


def describe_state(record: StudyRecord, index: int) -> str:
    """Numbers of one view in words."""
    r = record.response
    w, offset = r.deflection[index], r.liquid_offset[index]
    if w == 0.0:
        return "no deflection"
    place = f"{abs(w) * MM:.3g} mm at {_degrees(float(phase(w)))}\N{DEGREE SIGN}"
    text = f"deflection {place}"
    if record.motion is not None:
        several = len({chamber.plane for chamber in record.chambers}) > 1
        text = f"{'first chamber' if several else 'deflection'} {place}"
    if offset > 0.0:
        text += f"\nliquid {offset * MM:.3g} mm at {_degrees(float(r.liquid_angle[index]))}\N{DEGREE SIGN}"
    return text


def _degrees(angle: float) -> str:
    return f"{math.degrees(angle):.0f}".replace("-0", "0", 1).replace("-", MINUS)


def draw_chambers(
    axes: Axes,
    chambers: tuple[ChamberRecord, ...],
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
            axes.fill(x, y, facecolor=LIQUID, edgecolor="none", label="liquid")
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
        names = ", ".join(f"{chamber.radius * MM:.4g}" for chamber in chambers)
        planes = {chamber.plane for drawing in views.drawings for chamber in drawing}
        place = f", at {chambers[0].plane * MM:.4g}".replace("-", MINUS) if len(planes) > 1 else ""
        axes.set_title(f"radius {names}{place} mm", fontsize=7, color="0.3", pad=3.0)
    axes.axis("off")


def _draw_uneven(
    axes: Axes, chamber: ChamberRecord, centre: complex, depth: float, depth_factor: float
) -> None:
    """Walls, baffles and each body of liquid of a chamber that is no clear ring."""
    if depth > 0.0:
        for points in bodies(chamber, centre / MM, depth):
            axes.fill(*(points.T * MM), facecolor=LIQUID, edgecolor="none", label="liquid")
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


def write_numbers(axes: Axes, record: StudyRecord, views: Views, index: int) -> None:
    """Heading above and numbers below the drawings of one view.

    Parameters
    ----------
    axes : the first of its drawings; the others follow to the right
    record, views : the study and what is shown of it
    index : of the view's speed
    """
    middle = 0.5 * len(views.drawings)
    place = {"xycoords": "axes fraction", "textcoords": "offset points", "ha": "center"}
    # Above names of the drawings if there are several.
    above = 4.0 if len(views.drawings) == 1 else 13.0
    axes.annotate(describe_view(record, index), (middle, 1.0), xytext=(0.0, above), va="bottom", **place)
    axes.annotate(describe_state(record, index), (middle, 0.0), xytext=(0.0, -2.0), va="top", **place)


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
