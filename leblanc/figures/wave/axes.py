"""The wave of a liquid layer, drawn on axes that are handed in."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np

from leblanc.figures.over_speed import STRIP
from leblanc.figures.wave import picture as wave
from leblanc.results.base import one_line
from leblanc.results.layer import Wave
from leblanc.units import MM, RPM
from meshes.arrays import Array

Axes = Any  # matplotlib's, which no module that only draws imports

WALL, LIQUID, SURFACE, FORCE, DEFLECTION = "0.15", "#56B4E9", "#0072B2", "#D55E00", "0.15"
MINUS, DEGREE, TIMES = "\N{MINUS SIGN}", "\N{DEGREE SIGN}", "\N{MULTIPLICATION SIGN}"
BOUND = "\N{NO-BREAK SPACE}"
REACH = 1.33  # of the drawing, over the wall's radius
ARROW = 0.42  # length of the force's arrow, over the wall's radius
OUTSIDE = (1.08, 1.27)  # ends of the deflection's arrow, over the wall's radius
DRY_BAR = {"color": "0.35", "linewidth": 5, "linestyle": (0, (0.2, 0.3)), "label": "dry patch on the wall"}
MEAN_LINE = {"color": "0.25", "linewidth": 1.0, "linestyle": (0, (5, 2)), "label": "mean depth"}


def draw_annulus(axes: Axes, record: Wave, factor: float) -> None:
    """Walls, liquid, force, centre of mass, senses of spin and whirl, in the frame of the deflection.

    Parameters
    ----------
    axes : an empty drawing
    record : what to draw
    factor : of the depth
    """
    walls(axes, record)
    angle, surface = wave.free_surface(record.radius * MM, record.theta, record.depth * MM, factor)
    if np.any(record.depth > 0.0):
        x, y = wave.outline(record.radius * MM, angle, surface)
        axes.fill(x, y, facecolor=LIQUID, edgecolor="none", label="liquid")
        free = wet_surface(record, angle, surface, factor)
        axes.plot(free.real, free.imag, color=SURFACE, linewidth=0.8)
    bar = dry_wall(record, angle, surface, factor)
    if not np.isnan(bar).all():
        axes.plot(bar.real, bar.imag, **DRY_BAR)
    arrow(axes, record, 1.0, DEFLECTION, "deflection")
    turning(axes, record, "spin", 1.0, 135.0)
    if record.whirl_speed != 0.0:
        turning(axes, record, "whirl", math.copysign(1.0, record.whirl_speed), 225.0)
    axes.plot([0.0], [0.0], "+", color="black", markersize=9, markeredgewidth=1.2, label="geometric axis")
    if cmath.isfinite(record.force_ratio) and record.force_ratio != 0.0:
        _force(axes, record)
    if cmath.isfinite(record.offset):
        mass = record.offset * MM
        mark = {"markerfacecolor": "white", "markeredgecolor": "black", "markersize": 5.0}
        axes.plot([mass.real], [mass.imag], "D", zorder=5, label="liquid's centre of mass", **mark)
    place = {"xycoords": "axes fraction", "textcoords": "offset points", "ha": "center", "va": "top"}
    axes.annotate(f"{describe_force(record)}\n{describe_offset(record)}", (0.5, 0.0), xytext=(0, -3), **place)


def walls(axes: Axes, record: Wave) -> None:
    """Walls, and limits that leave room around them.

    Parameters
    ----------
    axes, record : an empty drawing, what to draw
    """
    circle = np.exp(1j * np.linspace(0.0, 2.0 * math.pi, wave.RAYS))
    for radius in (record.radius * MM, record.inner_radius * MM):
        if radius > 0.0:
            axes.plot(radius * circle.real, radius * circle.imag, color=WALL, linewidth=1.4)
    axes.set_xlim(-REACH * record.radius * MM, REACH * record.radius * MM)
    axes.set_ylim(-REACH * record.radius * MM, REACH * record.radius * MM)
    axes.set_aspect("equal")
    axes.axis("off")


def wet_surface(record: Wave, angle: Array, surface: Array, factor: float) -> Any:
    """Points of the free surface as complex numbers, nan where the wall is dry.

    Parameters
    ----------
    record : the layer
    angle, surface, factor : as drawn: rad, mm, shape (m,), factor of the depth
    """
    dry = wave.is_dry((record.radius * MM - surface) / factor, record.mean_depth * MM)
    return np.where(dry, np.nan, surface * np.exp(1j * angle))


def dry_wall(record: Wave, angle: Array, surface: Array, factor: float) -> Any:
    """Points just outside the wall as complex numbers, nan where liquid covers it.

    Parameters
    ----------
    record, angle, surface, factor : as for `wet_surface`
    """
    dry = wave.is_dry((record.radius * MM - surface) / factor, record.mean_depth * MM)
    return np.where(dry, 1.035 * record.radius * MM * np.exp(1j * angle), np.nan)


def arrow(axes: Axes, record: Wave, direction: complex, color: str, label: str) -> Any:
    """Arrow outside the wall.

    Parameters
    ----------
    axes, record : the drawing, what to draw
    direction : of the size 1 at most, which sets the length; 0 draws none
    color, label : of the line

    Returns
    -------
    The line, to be moved.
    """
    x, y, head = arrow_ends(record, direction)
    return _line_with_head(axes, x, y, head, color, label)


def _line_with_head(axes: Axes, x: list[float], y: list[float], head: Any, color: str, label: str) -> Any:
    """Line with a marker at its end; in the legend the marker points to the right."""
    style = {"color": color, "linewidth": 1.6, "markersize": 7.5, "zorder": 4}
    (line,) = axes.plot(x, y, marker=head, markevery=[1], gid=label, **style)
    axes.plot([], [], marker=_head(0.0), label=label, **style)
    return line


def arrow_ends(record: Wave, direction: complex) -> tuple[list[float], list[float], Any]:
    """Ends of an arrow outside the wall.

    Parameters
    ----------
    record, direction : as for `arrow`

    Returns
    -------
    x and y of both ends, mm, nan if there is no direction; its head as a marker.
    """
    size, angle = abs(direction), cmath.phase(direction)
    start, stop = OUTSIDE
    ends = np.array([start, start + (stop - start) * size]) * cmath.exp(1j * angle) * record.radius * MM
    ends = ends if size > 0.0 else np.full(2, complex(math.nan, math.nan))
    return ends.real.tolist(), ends.imag.tolist(), _head(angle)


def _head(angle: float) -> tuple[int, int, float]:
    """Triangle that points along an angle; matplotlib's points up."""
    return (3, 0, math.degrees(angle) - 90.0)


def _force(axes: Axes, record: Wave) -> None:
    """Arrow from the geometric axis in the direction of the force."""
    angle = cmath.phase(record.force_ratio)
    tip = ARROW * record.radius * MM * cmath.exp(1j * angle)
    _line_with_head(axes, [0.0, tip.real], [0.0, tip.imag], _head(angle), FORCE, "force on the drum")


def turning(axes: Axes, record: Wave, name: str, sense: float, middle: float) -> None:
    """Named arc with a head.

    Parameters
    ----------
    axes, record : the drawing, what to draw
    name : written beside it
    sense, middle : 1 counter-clockwise, -1 clockwise; angle of its middle, deg
    """
    sweep = np.radians(middle + sense * np.linspace(-19.0, 19.0, 30))
    arc = 1.15 * record.radius * MM * np.exp(1j * sweep)
    axes.plot(arc.real, arc.imag, color="0.3", linewidth=1.0, gid=name)
    axes.annotate(
        *("", (arc[-1].real, arc[-1].imag)),
        xytext=(arc[-3].real, arc[-3].imag),
        arrowprops={"arrowstyle": "-|>", "color": "0.3", "linewidth": 1.0, "shrinkA": 0, "shrinkB": 0},
    )
    place = 1.22 * record.radius * MM * cmath.exp(1j * math.radians(middle))
    align = "bottom" if place.imag > 0.0 else "top"
    axes.text(place.real, place.imag, name, fontsize=7, color="0.3", ha="right", va=align)


def draw_profile(axes: Axes, record: Wave) -> None:
    """Depth in mm against the angle from the deflection.

    Parameters
    ----------
    axes : an empty plot
    record : what to draw
    """
    angle, depth = wave.unrolled(record.theta, record.depth)
    axes.fill_between(np.degrees(angle), depth * MM, color=LIQUID, alpha=0.45, linewidth=0)
    axes.plot(np.degrees(angle), depth * MM, color=SURFACE, linewidth=1.2, label="depth of the layer")
    dry = wave.is_dry(depth, record.mean_depth)
    axes.axhline(record.mean_depth * MM, **MEAN_LINE)
    profile_axis(axes, float(max(depth.max(), record.mean_depth)) * MM, bool(dry.any()))
    axes.set_xlabel("Angle from the deflection, with the spin (deg)")
    if dry.any():
        bar = np.where(dry, 0.5 * STRIP, np.nan)
        axes.plot(np.degrees(angle), bar, transform=axes.get_xaxis_transform(), **DRY_BAR)


def profile_axis(axes: Axes, top: float, dry: bool) -> None:
    """Limits and labels of a plot of the depth around the wall.

    Parameters
    ----------
    axes : the plot
    top : the largest depth, mm
    dry : leave a strip below zero for the bar that marks dry places
    """
    top = 1.12 * top if top > 0.0 else 1.0
    axes.set_xlim(-180.0, 180.0)
    axes.set_xticks(np.arange(-180.0, 181.0, 90.0))
    axes.set_ylim(-(STRIP + 0.02) * top if dry else 0.0, top)
    axes.set_ylabel("Depth (mm)")
    axes.tick_params(axis="x", pad=5.0)  # the lowest depth stands beside the first angle


def describe_force(record: Wave) -> str:
    """The force in words, over that of a full drum."""
    force = record.force_ratio
    if not cmath.isfinite(force):
        return "force not converged"
    sign, size = MINUS if force.imag < 0.0 else "+", f"{abs(force):.4g}{_at_angle(force)}"
    imaginary = f" {sign} {abs(force.imag):.4g}i ({size})" if force.imag != 0.0 else ""
    return f"force ratio {signed(force.real)}{imaginary}"


def describe_offset(record: Wave) -> str:
    """The centre of mass in words."""
    if not cmath.isfinite(record.offset):
        return "centre of mass not found"
    return f"centre of mass {abs(record.offset) * MM:.3g} mm{_at_angle(record.offset)}"


def _at_angle(value: complex) -> str:
    angle = f"{math.degrees(cmath.phase(value)):.0f}".replace("-0", "0", 1).replace("-", MINUS)
    return f" at {angle}{DEGREE}" if value != 0.0 else ""


def signed(value: float) -> str:
    """Number with four digits and a minus sign of the right width."""
    return f"{value:.4g}".replace("-", MINUS)


def describe_case(record: Wave) -> str:
    """Title, model, sizes and speeds in words."""
    inner = f", inner wall {record.inner_radius * MM:.4g}{BOUND}mm" if record.inner_radius > 0.0 else ""
    slip = record.seen_from_the_drum
    drum = (
        f"{signed(slip)}{BOUND}rad/s seen from the drum"
        if slip != 0.0
        else "the deflection at rest in the drum"
    )
    return (
        f"{one_line(record.title)}. Liquid model: {one_line(record.model)}. "
        f"Wall {record.radius * MM:.4g}{BOUND}mm{inner}, mean depth {record.mean_depth * MM:.4g}{BOUND}mm, "
        f"whirl amplitude {record.whirl_amplitude * MM:.4g}{BOUND}mm; spin {_speed(record.spin)}, "
        f"whirl {_speed(record.whirl_speed)}, {drum}."
    )


def describe_notes(record: Wave) -> str:
    """Notes as one sentence, empty if there are none."""
    return f" Notes: {'; '.join(map(one_line, record.notes))}." if record.notes else ""


def describe_depths(factor: float) -> str:
    """How depths are drawn, in words."""
    if factor == 1.0:
        return "Walls and depth of the layer to scale"
    return f"Depth of the layer drawn {TIMES}{BOUND}{factor:g}, walls to scale"


def _speed(rate: float) -> str:
    return f"{signed(rate)}{BOUND}rad/s ({signed(rate * RPM)}{BOUND}rpm)"
