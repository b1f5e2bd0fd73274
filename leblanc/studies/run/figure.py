"""Figures of a response: amplitude, liquid and phase over speed; Campbell diagram without liquid."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from leblanc.core.units import ML, MM, MM_PEAK, RPM, in_rpm
from leblanc.plotting.curves import (
    NARROW,
    Curves,
    HeldCurves,
    cut,
    gapped,
    joined,
    lonely,
    median_over,
    other_branches,
    prepare,
    speed_limits,
    widened,
    windows,
)
from leblanc.plotting.page import (
    Figure,
    Frame,
    MultipleLocator,
    add_rate_axis,
    add_windows,
    caption,
    lay_out,
    number,
    style,
    zero_of,
)
from leblanc.studies.loads.figure import machine_figure
from leblanc.studies.run.answer import RunAnswer
from leblanc.studies.run.notes import plane_label
from leblanc.studies.run.words import alts, amplitude_place
from meshes.arrays import Array, Flags

Draw = Callable[[Any, Curves, RunAnswer], None]

FRAME = Frame(left=0.72, top=0.46, between=0.12, below=0.42)
SHARE = 0.52  # of the height of a panel that two have each, the whole range and the resonances below it

Axes = Any  # matplotlib's, which no module that only draws imports

WET, DRY, SHADE = "#0072B2", "#D55E00", "0.90"  # after Okabe and Ito: safe for the colour blind
UNSTABLE = (0, (3.5, 1.5))
STRIP = 0.055  # height of the dry-patch strip over that of the axes
FLAT = 100.0  # a peak so many times the usual value flattens all the rest on a linear axis
MARKS = 14  # along a line
OUT_OF_RANGE = "model out of range"

CYCLE = (0, (4, 1, 1, 1))  # dashes of a limit cycle's mean
BAND = {"facecolor": "#CFE3F1", "edgecolor": WET, "hatch": "/////", "linewidth": 0.4}
TURN = {"facecolor": "#DCE9F4", "edgecolor": "none"}
ON_TOP = {"facecolor": "#F3E1EC", "edgecolor": "#AA3377", "hatch": "\\\\\\\\", "linewidth": 0.4}
DOWN = "#009E73"  # after Okabe and Ito
LAYERS = (
    (WET, "solid"),
    ("#E69F00", (0, (5, 1.5))),
    ("#009E73", (0, (3, 1, 1, 1))),
    ("#CC79A7", (0, (1, 1))),
)

# Label, colour and dashes of each volume that the surface meets an edge with.
VOLUMES = (
    ("wets the wall at the floor", WET, "solid"),
    ("first touches lid, or inner wall", "#E69F00", (0, (5, 1.5))),
    ("wets the wall up to the lid", "#009E73", (0, (3, 1, 1, 1))),
)
_PANELS = 4

FORWARD, BACKWARD, STRAIGHT, SPIN = "#0072B2", "#D55E00", "0.35", "0.2"  # after Okabe and Ito
CLEAR = 0.2  # from here on a whirl is drawn as one with or against the spin
HZ = 60.0  # rpm in one hertz
# Colour, dashes and marker of each sense of whirl.
STYLES = (
    ("with the spin", 1.0, FORWARD, "solid", "^"),
    ("against the spin", -1.0, BACKWARD, (0, (5, 1.5)), "v"),
    ("straight-line", 0.0, STRAIGHT, (0, (1, 1.2)), "o"),
)


def loads_figure(result: RunAnswer) -> Figure:
    """Clearances, forces under the feet, margin against walking and torque over speed."""
    assert result.loads is not None
    return machine_figure(result.loads, lambda text: caption(result, text))


def amplitude_figure(result: RunAnswer) -> Figure:
    """Amplitude over speed with and without liquid; one curve of a machine without chambers."""
    text = "Amplitude of the deflection."
    if result.motion is not None:
        text = f"Largest radius of the axis' orbit {amplitude_place(result)}."
        if result.held is None and _elliptic(result).any():
            text += " The band reaches from the least to the largest radius in a turn."
    panels: list[tuple[float, Draw]] = [(2.75, draw_amplitude)]
    if result.held is not None:
        text += (
            " Integrated in time: lines are means over time, the band reaches from the least to the largest."
        )
        if result.held.limit_cycle.any():
            panels.append((1.3, draw_whirl))
            text += " Below: speed at which the axis whirls in space, beside the spin."
    if result.whirl is not None and result.whirl.large is not None and result.whirl.large.branches:
        text += " Self-excited whirl on top: the amplitude beats within the band, without a large unbalance."
    return _over_speed(result, "amplitude", panels, text)


def liquid_figure(result: RunAnswer) -> Figure:
    """Distance and angle of the liquid's centre of mass over speed."""
    panels = [(1.55, draw_offset), (1.55, draw_angle)]
    text = f"Centre of mass of the liquid: distance from the rotation axis, angle from {zero_of(result)}."
    if result.held is not None and np.isfinite(result.held.ripple).any():
        panels.append((1.55, draw_layers))
        text += " Below: each layer's from its chamber's axis, mean and swing, as seen from the drum"
        few = result.held.ripple.shape[1] > len(LAYERS)
        text += f" (the {len(LAYERS)} that swing most)." if few else "."
    return _over_speed(result, "liquid", panels, text)


def phase_figure(result: RunAnswer) -> Figure:
    """Phase of the deflection over speed with and without liquid."""
    text = f"Angle from {zero_of(result)} to the deflection; a lag is negative."
    return _over_speed(result, "phase", [(2.75, draw_phase)], text)


def _over_speed(result: RunAnswer, name: str, panels: Sequence[tuple[float, Draw]], text: str) -> Figure:
    """Panels above one another that share the speed, in rpm below and in rad/s above."""
    curves = prepare(result)
    with style():
        figure = Figure()
        figure.alt = alts(result)[name]
        rows = []
        for i, (_, draw) in enumerate(panels):
            axes: Any = figure.add_axes((0, 0, 1, 1), label=str(i))
            draw(axes, curves, result)
            _number_axes(axes)
            rows.append([axes])
        for (axes,) in rows[:-1]:
            axes.tick_params(labelbottom=False)
        rows[-1][0].set_xlabel("Speed (rpm)")
        add_rate_axis(rows[0][0])
        heights = [height for height, _ in panels]
        spans = windows([(curves.rpm, curves.amplitude), (curves.rpm, curves.amplitude_dry)], curves.limits)
        if not spans:
            lay_out(figure, rows, heights, FRAME, caption(result, text))
            return figure
        wide: list[list[Axes]] = []
        for i, (_, draw) in enumerate(panels):
            wide.append(
                [figure.add_axes((0, 0, 1, 1), label=f"{i}, part {k + 1}") for k in range(len(spans))]
            )
            for axes, span in zip(wide[-1], spans, strict=True):
                draw(axes, cut(curves, span), result)
                _number_axes(axes)
        rows[-1][0].set_xlabel("")
        for axes in [axes for row in (*rows, *wide) for axes in row]:
            # For a low panel a label of two lines and, where it is lower still, no upright names of ranges.
            axes.set_ylabel(axes.get_ylabel().replace(" (", "\n("))
            if len(rows) > 1:
                for upright in [part for part in axes.texts if part.get_rotation() == 90.0]:
                    upright.remove()
        heights = [SHARE * height for height in heights] * 2
        whole = [axes for (axes,) in rows]
        parts = ", ".join(f"{number(round(low))} to {number(round(high))} rpm" for low, high in spans)
        figure.alt += f" Drawn once more below, wider: {parts}."
        add_windows(figure, whole, wide, heights, caption(result, f"{text} {wider_words()}"))
    return figure


def _number_axes(axes: Axes) -> None:
    """Plain numbers on both axes; angles in eighths of a turn."""
    axes.xaxis.set_major_formatter(number)
    if axes.yaxis.get_label_text().endswith("(deg)"):
        axes.yaxis.set_major_locator(MultipleLocator(45.0))
    else:
        axes.yaxis.set_major_formatter(number)
        axes.yaxis.set_minor_formatter("")


def wider_words() -> str:
    """What the panels below the whole range are, for the caption."""
    return f"Below, wider: resonances under {100.0 * NARROW:g} % of the axis (half-power band)."


def draw_amplitude(axes: Axes, curves: Curves, result: RunAnswer) -> None:
    """Deflection amplitude with and without liquid, all branches; its range over time where it was held."""
    lines = [(curves.rpm, curves.amplitude), (curves.rpm, curves.amplitude_dry)]
    if curves.held is not None:
        lines += _draw_held(axes, curves, curves.held)
    elif result.motion is not None and (elliptic := _elliptic(result)).any():
        order = np.argsort(result.speed, kind="stable")
        ends = [
            np.where(elliptic, size, np.nan)[order] * MM for size in (result.amplitude_min, result.amplitude)
        ]
        axes.fill_between(
            result.speed[order] * RPM, *ends, **TURN, zorder=1.2, label="least to largest in a turn"
        )
    lines += _draw_on_top(axes, curves, result)
    reported(axes, curves, curves.amplitude, "without liquid" if result.chamberless else "with liquid")
    if not result.chamberless:
        without(axes, curves, curves.amplitude_dry)
    if np.any(np.count_nonzero(curves.chain >= 0, axis=1) > 1):
        thin = {"color": WET, "linewidth": 0.8, "zorder": 1.9}
        stable, unstable = other_branches(curves)
        axes.plot(*stable, **thin, label="other branches, stable")
        axes.plot(*unstable, **thin, linestyle=UNSTABLE, label="other branches, unstable")
    value_axis(axes, room_below(curves), lines, curves.branches.ravel())
    background(axes, curves, result, [curves.amplitude, curves.amplitude_dry])
    axes.set_ylabel(
        f"Amplitude{'' if result.motion is None else plane_label(bool(result.chambers))} ({MM_PEAK})"
    )


_ELLIPTIC = 0.05  # of the largest radius, from which on less in a turn is drawn


def _elliptic(result: RunAnswer) -> Flags:
    """Speeds at which the orbit is no circle, shape (n,)."""
    return np.asarray(result.amplitude - result.amplitude_min > _ELLIPTIC * result.amplitude)


def _draw_held(axes: Axes, curves: Curves, held: HeldCurves) -> list[tuple[Array, Array]]:
    """Least to largest amplitude over time, limit cycles, and the way down; the lines that need room."""
    ends = curves.least, curves.largest
    axes.fill_between(curves.rpm, *ends, **BAND, zorder=1.2, label="least to largest over time")
    if np.isfinite(held.cycle).any():
        axes.plot(
            *(held.rpm, held.cycle, "D"),
            **{"color": WET, "markerfacecolor": "white", "markersize": 4.5, "zorder": 3},
            label="limit cycle, mean",
        )
    if np.isfinite(held.down).any():
        axes.plot(
            *(held.rpm, held.down),
            **{"color": DOWN, "linewidth": 0.9, "marker": "v", "markersize": 3.5, "zorder": 2.5},
            label="while the speed falls",
        )
    return [(curves.rpm, curves.largest), (held.rpm, held.down)]


def _draw_on_top(axes: Axes, curves: Curves, result: RunAnswer) -> list[tuple[Array, Array]]:
    """What the amplitude beats between with self-excited whirl on top; the line that needs room."""
    large = None if result.whirl is None else result.whirl.large
    if large is None:
        return []
    size = large.amplitude if result.held is None else np.where(result.held.at, 0.0, large.amplitude)
    # Next to a speed without it there is none between the two either.
    between = np.where(size > 0.0, size, np.nan) * MM
    whirl = np.interp(curves.rpm, result.speed * RPM, between)
    if not np.isfinite(whirl).any():
        return []
    low, high = np.abs(curves.amplitude - whirl), curves.amplitude + whirl
    axes.fill_between(curves.rpm, low, high, **ON_TOP, zorder=1.1, label="beating with self-excited whirl")
    return [(curves.rpm, high)]


def draw_whirl(axes: Axes, curves: Curves, result: RunAnswer) -> None:
    """Speed of the whirl of limit cycles in space, and the spin."""
    held = curves.held
    assert held is not None
    axes.plot(
        *(held.rpm, held.whirl, "D"),
        **{"color": WET, "markersize": 4.5, "markerfacecolor": "white"},
        label="limit cycle: whirl",
    )
    axes.plot(curves.limits, curves.limits, color=SPIN, linewidth=0.9, linestyle=(0, (1, 1.2)), label="spin")
    known = np.concatenate([held.whirl[np.isfinite(held.whirl)], curves.limits])
    low, high = min(0.0, float(known.min())), float(known.max())
    axes.set_ylim(1.08 * low - (STRIP + 0.02) * (high - low) * bool(curves.dry_patch), 1.08 * high)
    background(axes, curves, result, [np.full(curves.rpm.shape, np.nan)])
    axes.set_ylabel("Whirl speed (rpm)")


def draw_layers(axes: Axes, curves: Curves, result: RunAnswer) -> None:
    """Each layer's centre of mass off its chamber's axis, mean and swing."""
    held = curves.held
    assert held is not None and result.held is not None
    most = np.max(np.nan_to_num(result.held.ripple), axis=0)
    drawn = np.sort(np.argsort(-most, kind="stable")[: len(LAYERS)]).tolist()
    for k, (color, dashes) in zip(drawn, LAYERS, strict=False):
        mean, swing = held.layer[:, k], held.swing[:, k]
        style = {"color": color, "linestyle": dashes, **_marked(mean, "o")}
        axes.plot(held.rpm, mean, **style, label=f"layer of chamber {k + 1}")
        ends = np.maximum(mean - swing, 0.0), mean + swing
        axes.fill_between(held.rpm, *ends, color=color, alpha=0.15, linewidth=0, zorder=1.2)
        for end in ends:
            axes.plot(held.rpm, end, color=color, linewidth=0.5, zorder=1.9, label="_")
        alone = lonely(mean)
        axes.vlines(held.rpm[alone], *(end[alone] for end in ends), color=color, linewidth=0.9, label="_")
    # Where the models do not hold the swing may be as wide as the chamber.
    kept = ~_within(held.rpm, curves.out_of_range)
    kept = kept if kept.any() else ~kept
    most_seen = [(held.rpm[kept], (held.layer + held.swing)[kept, k]) for k in drawn]
    value_axis(axes, room_below(curves), most_seen)
    background(axes, curves, result, [np.full(curves.rpm.shape, np.nan)])
    axes.set_ylabel("Layer's centre (mm)")


def _within(rpm: Array, spans: Sequence[tuple[float, float]]) -> Flags:
    """Which speeds lie in one of some spans, shape (n,)."""
    found = np.zeros(rpm.shape, dtype=bool)
    for low, high in spans:
        found |= (rpm >= low) & (rpm <= high)
    return found


def draw_offset(axes: Axes, curves: Curves, result: RunAnswer) -> None:
    """Distance of the liquid's centre of mass from the rotation axis."""
    reported(axes, curves, curves.offset, "liquid's centre of mass")
    value_axis(axes, room_below(curves), [(curves.rpm, curves.offset)])
    background(axes, curves, result, [curves.offset])
    axes.set_ylabel("Liquid offset (mm)")


def draw_angle(axes: Axes, curves: Curves, result: RunAnswer) -> None:
    """Angle of the liquid's centre of mass from the unbalance."""
    reported(axes, curves, curves.angle, "liquid's centre of mass")
    angle_axis(axes, curves, [curves.angle])
    background(axes, curves, result, [curves.angle])
    axes.set_ylabel("Liquid angle (deg)")


def draw_phase(axes: Axes, curves: Curves, result: RunAnswer) -> None:
    """Angle from the unbalance to the deflection, with and without liquid."""
    reported(axes, curves, curves.phase, "without liquid" if result.chamberless else "with liquid")
    if not result.chamberless:
        without(axes, curves, curves.phase_dry)
    angle_axis(axes, curves, [curves.phase, curves.phase_dry])
    background(axes, curves, result, [curves.phase, curves.phase_dry])
    axes.set_ylabel("Phase of the deflection (deg)")


def reported(axes: Axes, curves: Curves, y: Array, label: str) -> None:
    """The branch reported: heavy, dashed where unstable, jumps between branches dotted."""
    jumps = np.diff(curves.reported) != 0
    jumps &= (curves.reported[1:] >= 0) & (curves.reported[:-1] >= 0)
    breaks = jumps | _turns(y)
    unstable = ~curves.stable & ~curves.cycling & ~np.isnan(y)
    x_solid, solid = gapped(curves.rpm, np.where(curves.stable, y, np.nan), breaks)
    axes.plot(x_solid, solid, color=WET, label=label, **_marked(solid, "o"))
    if unstable.any():
        x, dashed = gapped(curves.rpm, np.where(widened(unstable), y, np.nan), breaks)
        style = {"color": WET, "linestyle": UNSTABLE, **_marked(dashed, "s")}
        axes.plot(x, dashed, **style, label=f"{label}, unstable")
    if curves.cycling.any():
        x, dashed = gapped(curves.rpm, np.where(widened(curves.cycling), y, np.nan), breaks)
        style = {"color": WET, "linestyle": CYCLE, **_marked(dashed, "D")}
        axes.plot(x, dashed, **style, label=f"{label}, limit cycle")
    steps = [(curves.rpm[i : i + 2], y[i : i + 2]) for i in np.flatnonzero(jumps & ~_turns(y)).tolist()]
    if steps:
        axes.plot(*joined(steps), color=WET, linewidth=0.9, linestyle=":", label="jump between branches")


def _marked(y: Array, marker: str) -> dict[str, Any]:
    """Marks of a line at the points that it does not reach."""
    dots = np.flatnonzero(lonely(y)).tolist()
    return {"marker": marker, "markevery": dots} if dots else {}


def without(axes: Axes, curves: Curves, y: Array) -> None:
    """The same rotor without liquid: light, with open marks."""
    x, line = gapped(curves.rpm, y, _turns(y))
    known = np.flatnonzero(~np.isnan(line))
    even = np.linspace(*curves.limits, MARKS)[1:-1]
    marks = set(known[np.clip(np.searchsorted(x[known], even), 0, known.size - 1)] if known.size else [])
    marks |= set(np.flatnonzero(lonely(line)))
    axes.plot(
        *(x, line),
        color=DRY,
        linewidth=1.0,
        marker="o",
        markerfacecolor="white",
        markevery=sorted(map(int, marks)) or None,
        label="without liquid",
    )


def _turns(degrees: Array) -> Flags:
    """Steps of more than half a turn: the angle leaves the picture and comes back on its other side."""
    step = np.diff(degrees)
    return np.abs(np.where(np.isnan(step), 0.0, step)) > 180.0


def _critical(result: RunAnswer) -> str:
    """Both critical speeds of the main mode, as one entry of a legend."""
    without = in_rpm(result.critical_speed_dry)
    if result.chamberless:
        return f"critical speed {without}"
    return f"critical speed {in_rpm(result.critical_speed_wet)}, without liquid {without}"


def background(axes: Axes, curves: Curves, result: RunAnswer, lines: list[Array]) -> None:
    """Ranges of speed and marked speeds, behind the lines."""
    low, high = curves.limits
    axes.set_xlim(low, high)
    for i, (left, right) in enumerate(curves.out_of_range):
        label = "_" if i else OUT_OF_RANGE
        axes.axvspan(left, right, color=SHADE, linewidth=0, zorder=0, label=label)
        if right - left > 0.04 * (high - low):
            _name_range(axes, curves, lines, (left, right))
    bars = {"transform": axes.get_xaxis_transform(), "color": "0.35", "linewidth": 5, "zorder": 1}
    for marked, height, dashes, label in (
        (curves.dry_patch, 0.5 * STRIP, (0, (0.2, 0.3)), "dry patch on the wall"),
        (curves.not_converged, 1.0 - 0.5 * STRIP, (0, (1, 0.6)), "not converged"),
    ):
        if marked:
            x, y = joined([(np.array(span), np.full(2, height)) for span in marked])
            axes.plot(x, y, linestyle=dashes, label=label, **bars)
    wet = math.nan if result.chamberless else result.critical_speed_wet
    criticals: tuple[tuple[float, Any, str], ...] = (
        (wet, (0, (6, 1.5, 1, 1.5, 1, 1.5)), WET),
        (result.critical_speed_dry, (0, (6, 1.5, 1, 1.5)), DRY),
    )
    for critical, line, color in criticals:
        if low <= critical * RPM <= high:
            axes.axvline(
                critical * RPM, color=color, linewidth=0.9, linestyle=line, label=_critical(result), zorder=1
            )
    for speed, line, color, label in (
        (result.capture_speed, (0, (8, 3)), "0.3", "annular layer from"),
        (result.carried_from, (0, (2, 2)), "0.3", "annulus reached from rest above"),
    ):
        if speed is not None and low <= speed * RPM <= high:
            text = f"{label} {in_rpm(speed)}"
            axes.axvline(speed * RPM, color=color, linewidth=0.9, linestyle=line, label=text, zorder=1)


def _name_range(axes: Axes, curves: Curves, lines: list[Array], span: tuple[float, float]) -> None:
    """Name a shaded range inside it, in the place that is farthest from the lines."""
    low, high = curves.limits
    left, right = ((edge - low) / (high - low) for edge in span)
    wide = right - left > 0.25
    half_width, half_height = (0.11, 0.02) if wide else (0.02, 0.3)
    columns = np.linspace(left + 0.13, right - 0.13, 3) if wide else [0.5 * (left + right)]
    x = (curves.rpm - low) / (high - low)
    heights = np.concatenate([_height(axes, line) for line in lines])
    rows = (0.96 - STRIP * bool(curves.not_converged), STRIP + 0.04)

    def clearance(place: tuple[float, float]) -> float:
        middle = place[1] + (-half_height if place[1] > 0.5 else half_height)
        near = heights[np.tile(np.abs(x - place[0]) < half_width, len(lines))]
        apart = np.abs(near[~np.isnan(near)] - middle) - half_height
        return float(apart.min(initial=0.2))

    column, row = max(((column, row) for row in rows for column in columns), key=clearance)
    axes.text(
        *(column, row, OUT_OF_RANGE),
        transform=axes.transAxes,
        rotation="horizontal" if wide else "vertical",
        horizontalalignment="center",
        verticalalignment="top" if row > 0.5 else "bottom",
        fontsize=7,
        color="0.3",
        bbox={"facecolor": SHADE, "edgecolor": "none", "pad": 1.0},
        zorder=1.5,
    )


def _height(axes: Axes, y: Array) -> Array:
    """Place of values on their axis, 0 at the bottom and 1 at the top."""
    low, high = axes.get_ylim()
    if axes.get_yscale() == "linear":
        height: Array = (y - low) / (high - low)
    else:
        height = np.log(np.maximum(y, low) / low) / np.log(high / low)
    return height


def room_below(curves: Curves) -> float:
    """Share of the axes' height that the strip of dry patches takes."""
    return STRIP + 0.02 if curves.dry_patch else 0.0


def value_axis(
    axes: Axes, room: float, lines: Sequence[tuple[Array, Array]], others: Array | None = None
) -> None:
    """Limits that hold all lines, from zero up; logarithmic where a linear axis would show a peak alone.

    That is so where the highest peak is more than `FLAT` times the value which the lowest line exceeds over
    half of the speeds, so that points that crowd about a peak do not count for more. `room` below the lines
    is a share of the height.
    """
    every = np.concatenate([y for _, y in lines] + ([] if others is None else [others]))
    known = [(x[y > 0.0], y[y > 0.0]) for x, y in lines if np.any(y > 0.0)]
    if not known:
        axes.set_ylim(-0.1, 1.0)  # a line of zeros stays clear of the frame
        if not np.any(every == 0.0):
            _say_empty(axes)
        return
    positive = every[every > 0.0]
    top = float(positive.max())
    usual = min(median_over(x, y) for x, y in known)
    if top > FLAT * usual:
        low = max(float(positive.min()), 1e-3 * usual) / 1.5
        axes.set_yscale("log", nonpositive="mask")
        axes.set_ylim(low * (low / top) ** room, 2.0 * top)
    else:
        axes.set_ylim(-1.08 * top * room, 1.08 * top)


def angle_axis(axes: Axes, curves: Curves, lines: list[Array]) -> None:
    """Limits from 10 to -190 degrees, wider if a line needs it."""
    every = np.concatenate(lines)
    every = every[~np.isnan(every)]
    low, high = min(-180.0, every.min(initial=0.0)) - 10.0, max(0.0, every.max(initial=-180.0)) + 10.0
    if not every.size:
        _say_empty(axes)
    axes.set_ylim(low - (STRIP + 0.02) * (high - low) * bool(curves.dry_patch), high)


def _say_empty(axes: Axes) -> None:
    box = {"facecolor": "white", "edgecolor": "none"}
    axes.text(0.5, 0.5, "no values", transform=axes.transAxes, horizontalalignment="center", bbox=box)


def campbell_figure(result: RunAnswer) -> Figure:
    """Natural frequencies of the rotor without liquid over its speed."""
    with style():
        figure = Figure()
        figure.alt = alts(result)["campbell"]
        axes: Axes = figure.add_axes((0, 0, 1, 1))
        draw_campbell(axes, result)
        for scale in (axes.xaxis, axes.yaxis):
            scale.set_major_formatter(number)
        add_rate_axis(axes)
        text = "Damped natural frequencies without liquid, by the sense in which the axis goes round."
        lay_out(figure, [[axes]], [2.75], FRAME, caption(result, text))
    return figure


def draw_campbell(axes: Axes, result: RunAnswer) -> None:
    """Natural frequencies over speed, forward and backward distinguished, and where the spin meets them."""
    assert result.motion is not None
    diagram = result.motion.campbell
    rpm, hertz = diagram.spin * RPM, diagram.frequency * RPM / HZ
    overdamped = hertz <= 0.0
    direction = diagram.direction.copy()
    if diagram.spin.size > 1 and diagram.spin[0] == 0.0:
        # At rest modes of one frequency mix at will; turning a little tells them apart.
        direction[0] = direction[1]
    for name, sense, color, dashes, marker in STYLES:
        lines = []
        for k in range(hertz.shape[1]):
            mine = (_sense(direction[:, k]) == sense) & ~overdamped[:, k]
            lines.append(gapped(*_runs(rpm, hertz[:, k], mine)))
        x, y = joined(lines)
        if np.isfinite(y).any():
            axes.plot(x, y, color=color, linestyle=dashes, label=f"whirl {name}")
        met = _sense(diagram.crossing_direction) == sense
        if met.any():
            place = diagram.crossing[met] * RPM
            axes.plot(
                *(place, place / HZ, marker),
                color=color,
                markerfacecolor="white",
                markersize=6,
                zorder=4,
                label=f"spin meets it, {name}",
            )
    top = float(rpm[-1])
    axes.plot([0.0, top], [0.0, top / HZ], color=SPIN, linewidth=0.9, label="once a turn")
    low, high = result.response.speed[[0, -1]] * RPM
    if min(low, high) > 0.02 * top:
        axes.axvspan(
            0.0, min(low, high), color="0.92", linewidth=0, zorder=0, label="below the speeds studied"
        )
    axes.set_xlim(0.0, top)
    axes.set_ylim(0.0, 1.15 * max(float(hertz.max(initial=0.0)), 0.1))
    axes.set_xlabel("Speed (rpm)")
    axes.set_ylabel("Natural frequency (Hz)")


def volumes_figure(result: RunAnswer) -> Figure:
    """Volumes at which the surface meets an edge of each chamber, over speed, beside what it holds."""
    found, order = result.wall_volumes, np.argsort(result.speed, kind="stable")
    assert found is not None
    upright = result.axial_gravity > 0.0
    rpm, known = result.speed[order] * RPM, np.isfinite(found.full_volume).any(axis=1)
    walled = any(chamber.inner_radius > 0.0 for chamber in result.chambers)
    drawn = np.flatnonzero(known)[:_PANELS].tolist()
    with style():
        figure = Figure()
        rows = []
        for k in drawn:
            axes: Axes = figure.add_axes((0, 0, 1, 1), label=str(k))
            chamber = result.chambers[k]
            full = np.pi * (chamber.radius**2 - chamber.inner_radius**2) * chamber.height * ML
            every = (found.wetting_volume, found.lid_volume, found.full_volume)
            wet, lid, most = (each[k, order] * ML for each in every)
            lines = [(wet, *VOLUMES[0]), (lid, *VOLUMES[1]), (most, *VOLUMES[2])]
            if not upright:
                lines = [
                    (most, "wets the wall", *VOLUMES[2][1:]),
                    (lid, "touches the inner wall", *VOLUMES[1][1:]),
                ]
            for volume, label, color, dashes in lines:
                if np.isfinite(volume).any():
                    axes.plot(rpm, volume, color=color, linestyle=dashes, label=label, **_marked(volume, "o"))
            # What is touched with more than wets the wall to the lid is an inner wall.
            top = np.where(lid > most, lid, full)
            axes.fill_between(rpm, most, top, color=SHADE, linewidth=0, zorder=0.5, label="wet to the lid")
            if chamber.volume > 0.0:
                axes.axhline(chamber.volume * ML, color="black", linewidth=0.9, label="fill")
            positive = np.concatenate([wet[wet > 0.0], most[most > 0.0], [full]])
            low = min(max(float(positive.min()), 1e-4 * full), chamber.volume * ML or full)
            axes.set_yscale("log")
            axes.set_ylim(0.7 * low, full)
            axes.set_xlim(*speed_limits(result.speed))
            axes.set_ylabel("Volume (ml)" if len(result.chambers) == 1 else f"Chamber {k + 1} (ml)")
            _number_axes(axes)
            rows.append([axes])
        for (axes,) in rows[:-1]:
            axes.tick_params(labelbottom=False)
        rows[-1][0].set_xlabel("Speed (rpm)")
        add_rate_axis(rows[0][0])
        text = (
            "Volumes that wet the wall at the deflection of this answer, up to what the chamber holds. "
            f"Where it is wet to the lid more adds nothing{' until it reaches the inner wall' * walled}."
        )
        if len(drawn) < np.count_nonzero(known):
            text += f" Chambers {', '.join(f'{k + 1}' for k in drawn)} of {len(result.chambers)}."
        figure.alt = alts(result)["volumes"]
        lay_out(figure, rows, [2.75 if len(rows) == 1 else 1.6] * len(rows), FRAME, caption(result, text))
    return figure


def _sense(direction: Array) -> Array:
    """1 with the spin, -1 against it, 0 for ellipses that are nearly lines."""
    return np.where(np.abs(direction) < CLEAR, 0.0, np.sign(direction))


def _runs(x: Array, y: Array, mask: np.ndarray) -> tuple[Array, Array, np.ndarray]:
    """The line where the mask holds and one point farther, so that no gap opens where it changes."""
    wide = mask.copy()
    wide[1:] |= mask[:-1]
    shown = np.where(wide & (y > 0.0), y, np.nan)
    return x, shown, np.zeros(x.size - 1, dtype=bool)
