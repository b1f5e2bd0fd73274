"""Figures of a layer's answers: its wave, its film, its whirl periods."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from leblanc.core.notes import one_line
from leblanc.core.units import DEGREE, LENGTH, MINUS, MM, RPM, TIMES, with_unit
from leblanc.plotting.bodies import FILLED, LARGEST_FACTOR, rounded_down
from leblanc.plotting.page import (
    FILM_DPI,
    RIGHT,
    WIDTH,
    Figure,
    Frame,
    fill,
    lay_out,
    number,
    require_film,
    style,
    write_film,
)
from leblanc.studies.layer.answer import FreeWaveAnswer, LayerAnswer, PeriodsAnswer
from leblanc.studies.layer.wave import Wave, WaveFrames
from leblanc.studies.run.figure import STRIP
from meshes.arrays import Array

RAYS = 721  # half a degree apart, closed
DRY = 1e-4  # a film thinner than this, over the mean depth, is drawn as a dry wall
SHOWN = 0.2  # mean depth as drawn, over the wall's radius
MOST_FRAMES = 120  # of a film
TURN = 0.25 * math.pi  # of the deflection from frame to frame: more of it and the eye sees it run backwards
FRAME_RATE = 20  # 1/s; a GIF counts in hundredths of a second

Axes = Any  # matplotlib's, which no module that only draws imports

WALL, LIQUID, SURFACE, FORCE, DEFLECTION = "0.15", "#56B4E9", "#0072B2", "#D55E00", "0.15"
BOUND = "\N{NO-BREAK SPACE}"
REACH = 1.33  # of the drawing, over the wall's radius
ARROW = 0.42  # length of the force's arrow, over the wall's radius
OUTSIDE = (1.08, 1.27)  # ends of the deflection's arrow, over the wall's radius
DRY_BAR = {"color": "0.35", "linewidth": 5, "linestyle": (0, (0.2, 0.3)), "label": "dry patch on the wall"}
MEAN_LINE = {"color": "0.25", "linewidth": 1.0, "linestyle": (0, (5, 2)), "label": "mean depth"}

Show = Callable[[int], None]

TURNED = "#D55E00"

WAVE_FRAME = Frame(left=0.1, top=0.1, between=0.0, below=0.44)
FILM_FRAME = Frame(left=0.1, top=0.28, between=0.0, below=0.26)
TIME_FRAME = Frame(left=0.72, top=0.12, between=0.12, below=0.4)
WAVE_HEIGHT, PROFILE_LEFT, PROFILE_BELOW, ASIDE = 2.75, 3.55, 0.15, 0.15  # inches


def unrolled(theta: Array, depth: Array) -> tuple[Array, Array]:
    """Depth around the wall over angles that rise from -pi to pi, closed.

    Angles in any order, rad, and depth, m, shape (n,); n + 2 of each come back, less those that are there
    twice, the depth linear between the angles given.
    """
    angle = np.mod(theta + math.pi, 2.0 * math.pi) - math.pi
    order = np.argsort(angle, kind="stable")
    angle, depth = angle[order], np.maximum(depth[order], 0.0)
    first, last = angle[0] + 2.0 * math.pi, angle[-1]
    share = (math.pi - last) / (first - last)
    edge = [(1.0 - share) * depth[-1] + share * depth[0]]
    angle, depth = np.concatenate([[-math.pi], angle, [math.pi]]), np.concatenate([edge, depth, edge])
    new = np.concatenate([[True], np.diff(angle) > 0.0])
    return angle[new], depth[new]


def free_surface(
    radius: float, theta: Array, depth: Array, factor: float, inner_radius: float = 0.0
) -> tuple[Array, Array]:
    """Angles from -pi to pi, at most half a degree apart, rad, and the radius of the free surface there, m.

    The wall is to scale, depths grow by a factor; an inner wall cuts what is deeper than the room.
    """
    angle, layer = unrolled(theta, depth)
    fine = np.union1d(angle, np.linspace(-math.pi, math.pi, RAYS))
    return fine, np.maximum(radius - factor * np.interp(fine, angle, layer), inner_radius)


def outline(radius: float, angle: Array, surface: Array) -> tuple[Array, Array]:
    """Closed outline of the liquid as x along angle 0 and y, m, shape (2 m,).

    It runs along the wall with the spin and back along the free surface, both from `free_surface`.
    """
    wall, inner = radius * np.exp(1j * angle), surface * np.exp(1j * angle)
    edge = np.concatenate([wall, inner[::-1]])
    return edge.real, edge.imag


def is_dry(depth: Array, mean_depth: float) -> NDArray[np.bool_]:
    """Stretches where nothing covers the wall; a point that the surface merely touches is none.

    Depths along rising angles, m, shape (..., n), n > 1.
    """
    dry: NDArray[np.bool_] = depth <= DRY * mean_depth
    beside = np.zeros_like(dry)
    beside[..., 1:] |= dry[..., :-1]
    beside[..., :-1] |= dry[..., 1:]
    return dry & beside


def depth_factor(wave: Wave, deepest: float) -> float:
    """Factor that makes a thin layer visible and keeps the deepest place drawn, m, between the walls."""
    if not (deepest > 0.0 and wave.mean_depth > 0.0):
        return 1.0
    # In this order no quotient of a depth near zero overflows.
    fits = FILLED * (wave.radius - wave.inner_radius) / max(deepest, wave.radius / LARGEST_FACTOR)
    shows = SHOWN * wave.radius / max(wave.mean_depth, wave.radius / LARGEST_FACTOR)
    return rounded_down(max(1.0, min(fits, shows)))


def frames(wave: Wave, history: WaveFrames) -> NDArray[np.intp]:
    """Indices over time of a film's frames: all of the history, or as much of its end as the eye can follow.

    They rise, evenly spaced in time as far as the history is, at most 120.
    """
    time, whirl_speed = history.time, abs(wave.seen_from_the_drum)
    span = float(time[-1] - time[0])
    if whirl_speed * span > TURN * (MOST_FRAMES - 1):
        span = TURN * (MOST_FRAMES - 1) / whirl_speed
    wanted = np.linspace(time[-1] - span, time[-1], MOST_FRAMES)
    middle = 0.5 * (time[1:] + time[:-1])
    return np.unique(np.searchsorted(middle, wanted, side="left"))


def draw_annulus(axes: Axes, wave: Wave, factor: float) -> None:
    """Walls, liquid, force, centre of mass, senses of spin and whirl, in the frame of the deflection.

    Parameters
    ----------
    axes : an empty drawing
    wave : what to draw
    factor : of the depth
    """
    walls(axes, wave)
    angle, surface = free_surface(
        wave.radius * MM, wave.theta, wave.depth * MM, factor, wave.inner_radius * MM
    )
    if np.any(wave.depth > 0.0):
        x, y = outline(wave.radius * MM, angle, surface)
        fill(axes, x, y, facecolor=LIQUID, edgecolor="none", label="liquid")
        free = wet_surface(wave, angle, surface, factor)
        axes.plot(free.real, free.imag, color=SURFACE, linewidth=0.8)
    bar = dry_wall(wave, angle, surface, factor)
    if not np.isnan(bar).all():
        axes.plot(bar.real, bar.imag, **DRY_BAR)
    arrow(axes, wave, 1.0, DEFLECTION, wave.towards)
    turning(axes, wave, "spin", 1.0, 135.0)
    if wave.whirl_speed != 0.0:
        name = "whirl" if wave.towards == "deflection" else "wave"
        turning(axes, wave, name, math.copysign(1.0, wave.whirl_speed), 225.0)
    axes.plot([0.0], [0.0], "+", color="black", markersize=9, markeredgewidth=1.2, label="geometric axis")
    if cmath.isfinite(wave.force_ratio) and wave.force_ratio != 0.0:
        _force(axes, wave)
    if cmath.isfinite(wave.offset):
        mass = wave.offset * MM
        mark = {"markerfacecolor": "white", "markeredgecolor": "black", "markersize": 5.0}
        axes.plot([mass.real], [mass.imag], "D", zorder=5, label="liquid's centre of mass", **mark)
    place = {"xycoords": "axes fraction", "textcoords": "offset points", "ha": "center", "va": "top"}
    if wave.towards == "deflection":
        text = f"{describe_force(wave)}\n{describe_offset(wave)}"
        axes.annotate(text, (0.5, 0.0), xytext=(0, -3), **place)


def walls(axes: Axes, wave: Wave) -> None:
    """Walls, and limits that leave room around them.

    Parameters
    ----------
    axes, wave : an empty drawing, what to draw
    """
    circle = np.exp(1j * np.linspace(0.0, 2.0 * math.pi, RAYS))
    for radius in (wave.radius * MM, wave.inner_radius * MM):
        if radius > 0.0:
            axes.plot(radius * circle.real, radius * circle.imag, color=WALL, linewidth=1.4)
    axes.set_xlim(-REACH * wave.radius * MM, REACH * wave.radius * MM)
    axes.set_ylim(-REACH * wave.radius * MM, REACH * wave.radius * MM)
    axes.set_aspect("equal")
    axes.axis("off")


def wet_surface(wave: Wave, angle: Array, surface: Array, factor: float) -> Any:
    """Points of the free surface as drawn, mm, as complex numbers; nan where the wall is dry, shape (m,)."""
    dry = is_dry((wave.radius * MM - surface) / factor, wave.mean_depth * MM)
    return np.where(dry, np.nan, surface * np.exp(1j * angle))


def dry_wall(wave: Wave, angle: Array, surface: Array, factor: float) -> Any:
    """Points just outside the wall, mm, as complex numbers; nan where liquid covers it, shape (m,)."""
    dry = is_dry((wave.radius * MM - surface) / factor, wave.mean_depth * MM)
    return np.where(dry, 1.035 * wave.radius * MM * np.exp(1j * angle), np.nan)


def arrow(axes: Axes, wave: Wave, direction: complex, color: str, label: str) -> Any:
    """Arrow outside the wall, to be moved; as long as the size of its direction, at most 1; none if 0."""
    x, y, head = arrow_ends(wave, direction)
    return _line_with_head(axes, x, y, head, color, label)


def _line_with_head(axes: Axes, x: list[float], y: list[float], head: Any, color: str, label: str) -> Any:
    """Line with a marker at its end; in the legend the marker points to the right."""
    style = {"color": color, "linewidth": 1.6, "markersize": 7.5, "zorder": 4}
    (line,) = axes.plot(x, y, marker=head, markevery=[1], gid=label, **style)
    axes.plot([], [], marker=_head(0.0), label=label, **style)
    return line


def arrow_ends(wave: Wave, direction: complex) -> tuple[list[float], list[float], Any]:
    """x and y of both ends of an arrow, mm, nan if there is no direction; its head as a marker."""
    size, angle = abs(direction), cmath.phase(direction)
    start, stop = OUTSIDE
    ends = np.array([start, start + (stop - start) * size]) * cmath.exp(1j * angle) * wave.radius * MM
    ends = ends if size > 0.0 else np.full(2, complex(math.nan, math.nan))
    return ends.real.tolist(), ends.imag.tolist(), _head(angle)


def _head(angle: float) -> tuple[int, int, float]:
    """Triangle that points along an angle; matplotlib's points up."""
    return (3, 0, math.degrees(angle) - 90.0)


def _force(axes: Axes, wave: Wave) -> None:
    """Arrow from the geometric axis in the direction of the force."""
    angle = cmath.phase(wave.force_ratio)
    tip = ARROW * wave.radius * MM * cmath.exp(1j * angle)
    _line_with_head(axes, [0.0, tip.real], [0.0, tip.imag], _head(angle), FORCE, "force on the drum")


def turning(axes: Axes, wave: Wave, name: str, sense: float, middle: float) -> None:
    """Named arc with a head.

    Parameters
    ----------
    axes, wave : the drawing, what to draw
    name : written beside it
    sense, middle : 1 counter-clockwise, -1 clockwise; angle of its middle, deg
    """
    sweep = np.radians(middle + sense * np.linspace(-19.0, 19.0, 30))
    arc = 1.15 * wave.radius * MM * np.exp(1j * sweep)
    axes.plot(arc.real, arc.imag, color="0.3", linewidth=1.0, gid=name)
    axes.annotate(
        *("", (arc[-1].real, arc[-1].imag)),
        xytext=(arc[-3].real, arc[-3].imag),
        arrowprops={"arrowstyle": "-|>", "color": "0.3", "linewidth": 1.0, "shrinkA": 0, "shrinkB": 0},
    )
    place = 1.22 * wave.radius * MM * cmath.exp(1j * math.radians(middle))
    align = "bottom" if place.imag > 0.0 else "top"
    axes.text(place.real, place.imag, name, fontsize=7, color="0.3", ha="right", va=align)


def draw_profile(axes: Axes, wave: Wave) -> None:
    """Depth in mm against the angle from the deflection.

    Parameters
    ----------
    axes : an empty plot
    wave : what to draw
    """
    angle, depth = unrolled(wave.theta, wave.depth)
    axes.fill_between(np.degrees(angle), depth * MM, color=LIQUID, alpha=0.45, linewidth=0)
    axes.plot(np.degrees(angle), depth * MM, color=SURFACE, linewidth=1.2, label="depth of the layer")
    dry = is_dry(depth, wave.mean_depth)
    axes.axhline(wave.mean_depth * MM, **MEAN_LINE)
    profile_axis(axes, float(max(depth.max(), wave.mean_depth)) * MM, bool(dry.any()))
    axes.set_xlabel(f"Angle from the {wave.towards}, with the spin (deg)")
    if dry.any():
        bar = np.where(dry, 0.5 * STRIP, np.nan)
        axes.plot(np.degrees(angle), bar, transform=axes.get_xaxis_transform(), **DRY_BAR)


def profile_axis(axes: Axes, top: float, dry: bool) -> None:
    """Limits, mm, and labels of a plot of the depth around the wall; below zero a strip for dry places."""
    top = 1.12 * top if top > 0.0 else 1.0
    axes.set_xlim(-180.0, 180.0)
    axes.set_xticks(np.arange(-180.0, 181.0, 90.0))
    axes.set_ylim(-(STRIP + 0.02) * top if dry else 0.0, top)
    axes.set_ylabel("Depth (mm)")
    axes.tick_params(axis="x", pad=5.0)  # the lowest depth stands beside the first angle


def describe_force(wave: Wave) -> str:
    """The force as text, over that of a full drum."""
    force = wave.force_ratio
    if not cmath.isfinite(force):
        return "force not converged"
    sign, size = MINUS if force.imag < 0.0 else "+", f"{abs(force):.4g}{_at_angle(force)}"
    imaginary = f" {sign} {abs(force.imag):.4g}i ({size})" if force.imag != 0.0 else ""
    return f"force coefficient {signed(force.real)}{imaginary}"


def describe_offset(wave: Wave) -> str:
    """The centre of mass as text."""
    if not cmath.isfinite(wave.offset):
        return "centre of mass not found"
    return f"centre of mass {with_unit(abs(wave.offset), LENGTH)}{_at_angle(wave.offset)}"


def _at_angle(value: complex) -> str:
    angle = f"{math.degrees(cmath.phase(value)):.0f}".replace("-0", "0", 1).replace("-", MINUS)
    return f" at {angle}{DEGREE}" if value != 0.0 else ""


def signed(value: float) -> str:
    """Number with four digits and a minus sign of the right width."""
    return f"{value:.4g}".replace("-", MINUS)


def describe_case(wave: Wave) -> str:
    """Title, model, sizes and speeds as text."""
    inner = f", inner wall {_length(wave.inner_radius)}" if wave.inner_radius > 0.0 else ""
    slip = wave.seen_from_the_drum
    drum = (
        f"{signed(slip)}{BOUND}rad/s seen from the drum"
        if slip != 0.0
        else "the deflection at rest in the drum"
    )
    held = wave.towards == "deflection"
    size = f", whirl amplitude {_length(wave.whirl_amplitude)}" if held else ""
    turns = "whirl" if held else f"the {wave.towards} goes round at"
    return (
        f"{one_line(wave.title)}. Liquid model: {one_line(wave.model)}. "
        f"Wall {_length(wave.radius)}{inner}, mean depth {_length(wave.mean_depth)}"
        f"{size}; spin {_speed(wave.spin)}, {turns} {_speed(wave.whirl_speed)}, {drum}."
    )


def describe_notes(wave: Wave) -> str:
    """Notes as one sentence, empty if there are none."""
    return f" Notes: {'; '.join(map(one_line, wave.notes))}." if wave.notes else ""


def describe_depths(factor: float) -> str:
    """How depths are drawn, in words."""
    if factor == 1.0:
        return "Walls and depth of the layer to scale"
    return f"Depth of the layer drawn {TIMES}{BOUND}{factor:g}, walls to scale"


def describe_cut(wave: Wave, deepest: float) -> str:
    """That the layer is deeper than the room for it, in words, empty if it is not."""
    if deepest <= wave.radius - wave.inner_radius:
        return ""
    return ", cut at the inner wall, beyond which it would reach"


def _length(length: float) -> str:
    """A length whose unit does not part from it."""
    return with_unit(length, LENGTH).replace(" ", BOUND)


def _speed(rate: float) -> str:
    return f"{signed(rate)}{BOUND}rad/s ({signed(rate * RPM)}{BOUND}rpm)"


def film(left: Axes, right: Axes, wave: Wave, history: WaveFrames) -> Show:
    """Both drawings of a film in the frame of the drum.

    Parameters
    ----------
    left, right : an empty drawing and an empty plot
    wave, history : what to draw

    Returns
    -------
    What sets both to the time of an index.
    """
    chosen = frames(wave, history)
    layers = history.depth[chosen]
    dry = bool(is_dry(layers, wave.mean_depth).any())
    show_annulus = _annulus(left, wave, history, depth_factor(wave, float(layers.max())), dry)
    profile_axis(right, max(float(layers.max()), wave.mean_depth) * MM, dry)
    show_profile = _profile(right, wave, history, dry)
    digits = _digits(history.time[chosen])

    def show(index: int) -> None:
        show_annulus(index)
        show_profile(index)
        left.set_title(f"t = {history.time[index]:.{digits}f} s")

    return show


def _annulus(axes: Axes, wave: Wave, history: WaveFrames, factor: float, dry: bool) -> Show:
    """Draw what is fixed of the annulus, and return what moves the rest."""
    radius, largest = wave.radius * MM, float(np.abs(history.deflection).max())
    walls(axes, wave)
    turning(axes, wave, "spin", 1.0, 135.0)
    axes.plot([0.0], [0.0], "+", color="black", markersize=9, markeredgewidth=1.2, label="geometric axis")
    axes.plot([0.97 * radius], [0.0], "s", color=WALL, markersize=6, zorder=5, label="mark on the drum")
    (liquid,) = axes.fill([0.0], [0.0], facecolor=LIQUID, edgecolor="none", label="liquid")
    (free,) = axes.plot([], [], color=SURFACE, linewidth=0.8)
    (bar,) = axes.plot([], [], **DRY_BAR | ({} if dry else {"label": "_"}))
    deflected = arrow(axes, wave, 0.0, DEFLECTION, wave.towards)

    def show(index: int) -> None:
        depth = history.depth[index] * MM
        angle, surface = free_surface(radius, history.theta, depth, factor, wave.inner_radius * MM)
        liquid.set_xy(np.stack(outline(radius, angle, surface), axis=1))
        wet = wet_surface(wave, angle, surface, factor)
        free.set_data(wet.real, wet.imag)
        edge = dry_wall(wave, angle, surface, factor)
        bar.set_data(edge.real, edge.imag)
        direction = complex(history.deflection[index]) / largest if largest > 0.0 else 0.0
        x, y, head = arrow_ends(wave, direction)
        deflected.set_data(x, y)
        deflected.set_marker(head)

    return show


def _profile(axes: Axes, wave: Wave, history: WaveFrames, dry: bool) -> Show:
    """Draw what is fixed of the depth around the wall, and return what moves the rest."""
    across = {"transform": axes.get_xaxis_transform()}
    (curve,) = axes.plot([], [], color=SURFACE, linewidth=1.2, label="depth of the layer")
    axes.axhline(wave.mean_depth * MM, **MEAN_LINE)
    style = {"color": DEFLECTION, "linewidth": 1.2, "linestyle": (0, (1, 1.2))}
    (place,) = axes.plot([], [], label=f"angle of the {wave.towards}", **style, **across)
    (bar,) = axes.plot([], [], **DRY_BAR | ({} if dry else {"label": "_"}), **across)
    axes.set_xlabel("Angle from the mark, with the spin (deg)")

    def show(index: int) -> None:
        angle, depth = unrolled(history.theta, history.depth[index])
        curve.set_data(np.degrees(angle), depth * MM)
        bar.set_data(np.degrees(angle), np.where(is_dry(depth, wave.mean_depth), 0.5 * STRIP, np.nan))
        deflection = complex(history.deflection[index])
        there = math.degrees(cmath.phase(deflection)) if deflection != 0.0 else math.nan
        place.set_data([there, there], [0.0, 1.0])

    return show


def _digits(time: Array) -> int:
    """Decimals that distinguish one frame from the next."""
    step = float(np.min(np.diff(time))) if time.size > 1 else 1e-2
    return min(max(0, 1 - math.floor(math.log10(step))), 9)


def describe_film(wave: Wave, history: WaveFrames) -> str:
    """What a film shows and how fast, in words."""
    chosen = frames(wave, history)
    time, whole = history.time[chosen], float(history.time[-1] - history.time[0])
    span = float(time[-1] - time[0])
    part = "" if span >= 0.9 * whole else f" (the last {span:.3g} s of {whole:.3g} s)"
    factor = depth_factor(wave, float(history.depth[chosen].max()))
    drawn = f"{describe_depths(factor)}{describe_cut(wave, float(history.depth[chosen].max()))}"
    held = wave.towards == "deflection"
    arrow_says = "the arrow grows with the deflection" if held else f"the arrow points to a {wave.towards}"
    text = f"Seen from the drum{part}. {drawn}; {arrow_says}."
    if span > 0.0:
        text += f" One second of the film is {span / (time.size - 1) * FRAME_RATE:.3g} s."
        if abs(wave.seen_from_the_drum) * float(np.max(np.diff(time))) > 2.0 * TURN:
            text += " The frames are too far apart to follow the deflection."
    return text


def wave_figure(wave: Wave) -> Figure:
    """The layer seen along the axis and its depth around the wall, in the frame of the deflection."""
    deepest = float(np.max(wave.depth))
    factor = depth_factor(wave, max(deepest, wave.mean_depth))
    with style():
        figure = Figure()
        left, right = (figure.add_axes((0, 0, 1, 1), label=name) for name in ("annulus", "profile"))
        draw_annulus(left, wave, factor)
        draw_profile(right, wave)
        right.yaxis.set_major_formatter(number)
        held = (
            "; arrows show directions, the place of the centre of mass is not exaggerated. "
            "Force coefficient: force over that of a full drum; angles from the deflection, "
            "positive with the spin. "
        )
        said = held if wave.towards == "deflection" else "; no whirl holds it. "
        text = f"{describe_depths(factor)}{describe_cut(wave, deepest)}{said}{describe_case(wave)}"
        text += describe_notes(wave)
        _beside(figure, left, right, WAVE_FRAME, text)
        figure.alt = (
            "The layer seen along the axis and its depth around the wall, "
            f"from {_length(float(np.min(wave.depth)))} to {_length(deepest)}."
        )
    return figure


def animate(
    wave: Wave, history: WaveFrames, path: Path, drawn: Callable[[int, int], None] | None = None
) -> int:
    """Write the film of a wave in the frame of the drum, a .gif, .html or with ffmpeg .mp4; its frames.

    Of a long history its end, as much of it as 120 frames can follow. One history gives the same GIF byte for
    byte, as long as the versions of matplotlib and Pillow stay the same.
    """
    require_film(path)
    wave.require_room(history)
    shown = frames(wave, history).tolist()
    return write_film(lambda: _film(wave, history), shown, FRAME_RATE, path, drawn)


def _film(wave: Wave, history: WaveFrames) -> tuple[Figure, Callable[[int], None]]:
    """Figure of a film and what sets it to the time of an index."""
    with style():
        figure = Figure()
        left, right = (figure.add_axes((0, 0, 1, 1), label=name) for name in ("annulus", "profile"))
        show = film(left, right, wave, history)
        right.yaxis.set_major_formatter(number)
        text = f"{describe_film(wave, history)} {describe_case(wave)}"
        _beside(figure, left, right, FILM_FRAME, text)
        # Video codecs halve both sides of a picture for its colours.
        figure.set_size_inches(WIDTH, 2.0 * math.ceil(0.5 * FILM_DPI * figure.get_figheight()) / FILM_DPI)
    return figure, show


def _beside(figure: Figure, left: Axes, right: Axes, frame: Frame, caption: str) -> None:
    """A drawing and a plot side by side, the plot with room for its labels."""
    lay_out(figure, [[left, right]], [WAVE_HEIGHT], frame, caption)
    total, box = figure.get_figheight(), right.get_position()
    x, y = PROFILE_LEFT / WIDTH, box.y0 + PROFILE_BELOW / total
    right.set_position((x, y, 1.0 - RIGHT / WIDTH - x, box.y1 - y))
    place = left.get_position()
    left.set_position((place.x0 - ASIDE / WIDTH, place.y0, place.width, place.height))


def layer_figure(result: LayerAnswer | FreeWaveAnswer) -> Figure:
    """The main figure of a layer's answer."""
    return wave_figure(result.wave())


def periods_figure(result: PeriodsAnswer) -> Figure:
    """Force on the drum and mean rotation over the whirl periods of a layer that starts from rest."""
    h, model = result.history, result.case.model
    with style():
        figure = Figure()
        rows = [[figure.add_axes((0, 0, 1, 1), label=name)] for name in ("force", "rotation", "depths")]
        force, rotation, depths = (row[0] for row in rows)
        force.plot(h.time, h.force_ratio.real, marker="o", label="force along the deflection")
        force.plot(h.time, h.force_ratio.imag, marker="s", linestyle="--", label="force 90 deg ahead of it")
        force.set_ylabel("Force coefficient (-)")
        rotation.plot(h.time, h.mean_rotation, color="0.15", marker="^", label="mean rotation in the drum")
        rotation.set_ylabel("Rotation (rad/s)")
        depths.plot(h.time, h.depth_max * MM, label="crest")
        depths.plot(h.time, h.depth_min * MM, linestyle="--", label="trough")
        depths.set_ylabel("Depth (mm)")
        depths.set_xlabel("Time (s)")
        for axes in (force, rotation):
            axes.tick_params(labelbottom=False)
        text = f"Means over periods of the whirl seen from the drum. Liquid model: {model}."
        lay_out(figure, rows, [1.5, 1.0, 1.2], TIME_FRAME, text)
        figure.alt = "Curves over time of the force on the drum, the liquid's rotation and its depths."
    return figure
