"""The figures of a run-up: amplitude over speed, everything over time, where the energy went."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from leblanc.core.notes import assumed_words, one_line, percent
from leblanc.core.units import LENGTH, MM, MM_PEAK, RPM, friction_words, with_unit
from leblanc.plotting.curves import gapped, joined, lag_degrees, link, spans, widened
from leblanc.plotting.page import (
    WIDTH,
    Caption,
    Figure,
    Frame,
    lay_out,
    number,
    style,
)
from leblanc.studies.balls.races import in_race
from leblanc.studies.loads.figure import machine_figure
from leblanc.studies.run.figure import DRY, SHADE, UNSTABLE, WET
from leblanc.studies.run.notes import plane_label
from leblanc.studies.runup.answer import RunupAnswer, pieces
from leblanc.studies.runup.words import GAINS, describe_model, largest, largest_dry, terms
from meshes.arrays import Array, Flags

Axes = Any  # matplotlib's, which no module that only draws imports
Line = tuple[Array, Array]

SPEED_FRAME = Frame(left=0.72, top=0.46, between=0.12, below=0.42)
TIME_FRAME = Frame(left=0.72, top=0.12, between=0.1, below=0.4)
ENERGY_FRAME = Frame(left=1.75, top=0.12, between=0.0, below=0.42)
ASIDE = 0.45  # inches, for a second axis on the right
UP, BACK, GAINED, USED = WET, "#56B4E9", WET, DRY
DRY_BACK = "#E69F00"
STEADY, WHIRL, RANGE = "0.45", "#F0E442", "#CC79A7"
BACK_DASHES = (0, (4.0, 1.2, 1.0, 1.2))
ARROWS = 3  # along each way
THIN = 0.015  # of the largest amplitude: a range that hides behind its line
MARKS = 12  # along the run without liquid
FAR = 2.5  # times the largest of the run: a steady peak above it is reported in words and cut by the axes
_RATES = (lambda rpm: rpm / RPM, lambda rate: rate * RPM)  # from rpm to rad/s and back
LAYERS = ((WET, "-"), (DRY, (0, (3.5, 1.5))), ("#009E73", (0, (1, 1.2))))  # colour and line of a chamber


def loads_figure(result: RunupAnswer) -> Figure:
    """Clearances, forces under the feet, margin against walking and torque over time."""
    assert result.loads is not None
    return machine_figure(result.loads, lambda text: caption(result, text))


def speed_figure(result: RunupAnswer) -> Figure:
    """Amplitude over speed with and without liquid, up and back, with the steady branches behind."""
    speed = result.speed * RPM
    every = np.concatenate((speed, result.speed_dry[~np.isnan(result.speed_dry)] * RPM))
    low, high = float(every.min()), float(every.max())
    room = 0.02 * (high - low) if high > low else 1.0
    with style():
        figure = Figure()
        axes: Axes = figure.add_axes((0, 0, 1, 1))
        _shade(axes, result, (low, high))
        top = 1.1 * max(_steady(axes, result), largest_drawn(result) * MM) or 1.0
        scale = ((high - low) or 1.0, top)
        for (label, x, y), look in zip(_ways(result), _LOOKS, strict=True):
            if np.count_nonzero(~np.isnan(y)) > 1:
                dry = "markerfacecolor" in look
                marks = {"markevery": max(1, x.size // MARKS)} if dry else {}
                axes.plot(x, y, label=label, **look, **marks)
                if not dry:
                    for part in np.split(np.arange(x.size), np.flatnonzero(np.isnan(x))):
                        known = part[~np.isnan(x[part])]
                        _arrows(axes, x[known], y[known], scale, look["color"])
        _draw_band(axes, result)
        axes.set_xlim(low - room, high + room)
        axes.set_ylim(0.0, top)
        axes.set_xlabel("Speed (rpm)")
        axes.set_ylabel(_label(result))
        above = axes.secondary_xaxis("top", functions=_RATES)
        above.set_xlabel("Speed (rad/s)")
        for axis in (axes.xaxis, axes.yaxis, above.xaxis):
            axis.set_major_formatter(number)
        where = f" {result.plane}" if result.plane else ""
        text = f"Deflection of the axis{where} while the speed changes; arrows point on in time."
        lay_out(figure, [[axes]], [2.9], SPEED_FRAME, caption(result, text))
        figure.alt = (
            "Curves of the amplitude over speed with and without liquid, the steady branches behind; largest "
            f"{largest(result)}{largest_dry(result)}."
        )
    return figure


_LOOKS: tuple[dict[str, Any], ...] = (
    {"color": UP, "linewidth": 1.6, "zorder": 3.0},
    {"color": BACK, "linewidth": 1.4, "linestyle": BACK_DASHES, "zorder": 2.9},
    {"color": DRY, "linewidth": 1.0, "zorder": 2.5, "marker": "o", "markerfacecolor": "white"},
    {
        **{"color": DRY_BACK, "linewidth": 1.0, "zorder": 2.4, "linestyle": BACK_DASHES},
        **{"marker": "o", "markerfacecolor": "white"},
    },
)


def _ways(result: RunupAnswer) -> list[tuple[str, Array, Array]]:
    """Name, speed in rpm and amplitude in mm on the way up and back, then both without liquid."""
    up = "run-up" if result.turns_back else "run-up and hold"
    bare = f", {result.without}"
    runs = [(False, bare)] if result.bare else [(False, ""), (True, bare)]
    found = []
    for dry, what in runs:
        for name, back in ((up, False), ("run-down", True)):
            _, speed, amplitude = result.curve(back, dry)
            found.append((f"{name}{what}", speed * RPM, amplitude * MM))
    return found + [("", np.empty(0), np.empty(0))] * (len(_LOOKS) - len(found))


def largest_drawn(result: RunupAnswer) -> float:
    """Largest amplitude of the run, with liquid or without, m."""
    ensemble = 0.0 if result.spread is None else float(np.nanmax(result.spread.amplitude_max))
    if result.spread is None and not np.isnan(result.amplitude_error).all():
        ensemble = float(np.nanmax(result.amplitude + result.amplitude_error))
    return max(ensemble, *(float(result.whole_curve(dry)[2].max(initial=0.0)) for dry in (False, True)))


def _draw_band(axes: Axes, result: RunupAnswer, over_time: bool = False) -> None:
    """The range of an ensemble, or else the error of the amplitude, over the speed or over time."""
    spread, error = result.spread, result.amplitude_error
    if spread is not None:
        low, high, look = spread.amplitude_min, spread.amplitude_max, {"alpha": 0.7, "zorder": 2.8}
        label = f"range over {spread.members} runs that differ by rounding"
        label += ", thinner than the line" if spread.largest_spread < THIN else ""
    elif np.isnan(error).all() or float(np.nanmax(error)) < THIN * float(result.amplitude.max()):
        return
    else:
        low, high = np.maximum(result.amplitude - error, 0.0), result.amplitude + error
        label, look = "error by cells, steps and pool-annulus transition", {"alpha": 0.55, "zorder": 2.0}
        if math.isnan(result.handover_estimate):
            label = "error by cells and steps"
    across = result.time if over_time else result.speed * RPM
    for i, part in enumerate(part for way in (~result.falling, result.falling) for part in pieces(way)):
        shown = across[part], low[part] * MM, high[part] * MM
        axes.fill_between(*shown, facecolor=RANGE, linewidth=0, label="_" if i else label, **look)


def _shade(axes: Axes, result: RunupAnswer, limits: tuple[float, float]) -> None:
    """Speeds at which the model is out of range, and those of self-excited whirl."""
    speed = result.speed * RPM
    order = np.argsort(speed, kind="stable")
    for i, (left, right) in enumerate(spans(speed[order], ~result.in_range[order], limits)):
        label = "_" if i else "model out of range"
        axes.axvspan(left, right, color=SHADE, linewidth=0, zorder=0, label=label)
    for i, (left, right) in enumerate(result.bands or ()):
        label = "_" if i else "self-excited whirl (linear theory)"
        look = {"facecolor": WHIRL, "alpha": 0.35, "hatch": "///", "edgecolor": "0.55", "linewidth": 0.0}
        axes.axvspan(left * RPM, right * RPM, zorder=0.5, label=label, **look)


def _steady(axes: Axes, result: RunupAnswer) -> float:
    """Draw branches of the steady response, thin, also without liquid; the largest value to hold, mm.

    A peak far above the run's is given in words instead.
    """
    answer = result.steady
    if answer is None:
        return 0.0
    most, tops = FAR * largest_drawn(result) * MM, [0.0]

    def named(label: str, *lines: Array) -> str:
        top = max(float(line[~np.isnan(line)].max(initial=0.0)) for line in lines)
        if top > most:
            return f"{label} (up to {with_unit(top / MM, LENGTH)})"
        tops.append(top)
        return label

    stable, unstable = steady_lines(answer.speed * RPM, answer.branch_deflection, answer.branch_stable)
    thin = {"color": STEADY, "linewidth": 1.0}
    axes.plot(*stable, **thin, label=named("steady response", stable[1], unstable[1]))
    if not np.isnan(unstable[1]).all():
        axes.plot(*unstable, **thin, linestyle=UNSTABLE, label="steady response, unstable")
    dry = np.abs(np.where(np.isfinite(answer.deflection_dry), answer.deflection_dry, np.nan)) * MM
    dotted = {"color": "0.25", "linewidth": 1.0, "linestyle": (0, (1, 1.5))}
    axes.plot(answer.speed * RPM, dry, **dotted, label=named("steady, without liquid", dry))
    return max(tops)


def steady_lines(rpm: Array, branches: Any, calm: Flags) -> tuple[Line, Line]:
    """Amplitudes of the stable and of the unstable branches as two lines with gaps, rpm and mm."""
    bounded = np.where(np.isfinite(branches), branches, complex(math.nan, math.nan))
    chain, size = link(bounded), np.abs(bounded) * MM
    stable, unstable = [], []
    for branch in range(int(chain.max(initial=-1)) + 1):
        point, column = np.nonzero(chain == branch)
        x, y, good = rpm[point], size[point, column], calm[point, column]
        stable.append((x, np.where(good, y, np.nan)))
        unstable.append((x, np.where(widened(~good), y, np.nan)))
    return joined(stable), joined(unstable)


def _arrows(axes: Axes, x: Array, y: Array, scale: tuple[float, float], color: str) -> None:
    """Heads along a line, evenly spaced over its length on the page."""
    length = np.concatenate(([0.0], np.cumsum(np.hypot(np.diff(x) / scale[0], np.diff(y) / scale[1]))))
    if not length.size or length[-1] <= 0.02:
        return
    for share in (np.arange(ARROWS) + 0.5) / ARROWS:
        head = min(int(np.searchsorted(length, share * length[-1])), x.size - 1)
        tail = max(int(np.searchsorted(length, share * length[-1] - 0.01)) - 1, 0)
        look = {"arrowstyle": "-|>", "color": color, "linewidth": 0.0, "mutation_scale": 11.0}
        look |= {"shrinkA": 0.0, "shrinkB": 0.0}
        axes.annotate("", (x[head], y[head]), xytext=(x[tail], y[tail]), arrowprops=look, zorder=4)


def time_figure(result: RunupAnswer) -> Figure:
    """Speed, amplitude, place of the liquid and depths over time; capture and release marked."""
    panels = [(0.8, _draw_speed), (1.1, _draw_amplitude)]
    if result.races:
        panels.append((1.1, _draw_balls))
    if result.wet:
        panels += [(0.95, _draw_offset), (0.95, _draw_angle), (1.1, _draw_depths)]
    time = result.time
    first, last = float(time[0]), float(time[-1])
    margin = 0.01 * (last - first) if last > first else 0.5
    with style():
        figure = Figure()
        rows: list[list[Axes]] = [[figure.add_axes((0, 0, 1, 1), label=str(i))] for i in range(len(panels))]
        for (axes,), (_, draw) in zip(rows, panels, strict=True):
            draw(axes, result)
            _mark_time(axes, result)
            axes.set_xlim(first - margin, last + margin)
            axes.xaxis.set_major_formatter(number)
            for scale in (axes, *axes.child_axes):
                scale.yaxis.set_major_formatter(number)
            axes.tick_params(labelbottom=axes is rows[-1][0])
        rows[-1][0].set_xlabel("Time (s)")
        text = "The run-up over time; angles in the drum frame from the drum's zero mark"
        text += ", the unbalance." if result.kind == "jeffcott" else "."
        if result.gravity > 0.0:
            text += " Place of the liquid: means over whole turns, in which gravity's share drops out."
        lay_out(figure, rows, [height for height, _ in panels], TIME_FRAME, caption(result, text))
        rolling = ", the balls' angles" if result.races else ""
        figure.alt = (
            f"Curves over time of speed, amplitude{rolling}, the place of the liquid and the depth of its "
            f"layers; largest amplitude {largest(result)}."
        )
        for (axes,) in rows:
            box = axes.get_position()
            axes.set_position((box.x0, box.y0, box.width - ASIDE / WIDTH, box.height))
    return figure


def _mark_time(axes: Axes, result: RunupAnswer) -> None:
    """Times out of range, capture and release."""
    time = result.time
    limits = (float(time[0]), float(time[-1]))
    for i, (left, right) in enumerate(spans(time, ~result.in_range, limits)):
        label = "_" if i else "model out of range"
        axes.axvspan(left, right, color=SHADE, linewidth=0, zorder=0, label=label)
    for i, passage in enumerate(part for part in result.passages if part.text.startswith("coast")):
        label, look = "_" if i else "motor off", {"facecolor": WHIRL, "alpha": 0.25, "linewidth": 0}
        axes.axvspan(passage.begin, passage.end, zorder=0.2, label=label, **look)
    for each in result.transfers:
        dashes = (0, (8, 3)) if each.captured else (0, (2, 2))
        label = "liquid centrifuged" if each.captured else "annulus collapses"
        axes.axvline(each.time, color="0.3", linewidth=0.9, linestyle=dashes, label=label, zorder=1)


def _draw_speed(axes: Axes, result: RunupAnswer) -> None:
    axes.plot(result.time, result.speed * RPM, color="0.15", linewidth=1.2)
    if np.nanmax(np.abs(result.speed_dry - result.speed), initial=0.0) > 1e-3 * float(result.speed.max()):
        axes.plot(result.time, result.speed_dry * RPM, **_bare(result))
    axes.set_ylim(0.0, 1.1 * float(np.nanmax([result.speed, result.speed_dry])) * RPM)
    axes.set_ylabel("Speed (rpm)")
    beside = axes.secondary_yaxis("right", functions=_RATES)
    beside.set_ylabel("(rad/s)")


def _draw_amplitude(axes: Axes, result: RunupAnswer) -> None:
    dry = result.bare
    axes.plot(*_over_time(result, False), color=DRY if dry else UP, linewidth=1.2)
    if not dry and result.history_dry is not None:
        axes.plot(*_over_time(result, True), **_bare(result))
    _draw_band(axes, result, over_time=True)
    axes.set_ylim(0.0, 1.12 * largest_drawn(result) * MM or 1.0)
    axes.set_ylabel(_label(result).replace(" at ", "\nat ", 1))


def _over_time(result: RunupAnswer, dry: bool) -> Line:
    """Time and amplitude, mm."""
    time, _, amplitude = result.whole_curve(dry)
    return time, amplitude * MM


def _bare(result: RunupAnswer) -> dict[str, Any]:
    """Look of the run that it is compared with."""
    return {
        **{"color": DRY, "linewidth": 0.9, "zorder": 1.9, "label": result.without},
        **{"marker": "o", "markersize": 3.0, "markerfacecolor": "white", "markevery": 0.11},
    }


def _label(result: RunupAnswer) -> str:
    """Of an axis of amplitudes."""
    return f"Amplitude{plane_label(chambers=True) if result.plane else ''} ({MM_PEAK})"


def _place(result: RunupAnswer) -> Any:
    """Liquid's centre of mass as it is drawn."""
    return result.mean_position if result.gravity > 0.0 else result.history.liquid_position


def _draw_offset(axes: Axes, result: RunupAnswer) -> None:
    offset = np.abs(_place(result)) * MM
    axes.plot(result.time, offset, color=UP, linewidth=1.2)
    axes.set_ylim(0.0, 1.12 * float(offset.max()) or 1.0)
    axes.set_ylabel("Liquid offset\n(mm)")


def _draw_angle(axes: Axes, result: RunupAnswer) -> None:
    place = _place(result)
    angle = lag_degrees(np.angle(place), np.where(result.in_range, np.abs(place), 0.0))
    step = np.diff(angle)
    turns = np.abs(np.where(np.isnan(step), 0.0, step)) > 180.0
    axes.plot(*gapped(result.time, angle, turns), color=UP, linewidth=1.2)
    known = angle[~np.isnan(angle)]
    low, high = min(-180.0, known.min(initial=0.0)) - 10.0, max(0.0, known.max(initial=-180.0)) + 10.0
    axes.set_ylim(low, high)
    axes.set_yticks([tick for tick in (-270.0, -180.0, -90.0, 0.0, 90.0) if low <= tick <= high])
    axes.set_ylabel("Liquid angle\n(deg)")


def _draw_balls(axes: Axes, result: RunupAnswer) -> None:
    """Angle of each ball in the drum from -180 to 180 deg, a look for each race; gaps where it goes round."""
    race = in_race(result.races)
    for j, way in enumerate(result.ball_angle.T):
        color, dashes = LAYERS[race[j] % len(LAYERS)]
        angle = np.degrees(np.angle(np.exp(1j * way)))
        # A ball that passes more than half a turn between two samples is no line.
        broken = (np.abs(np.diff(angle)) > 180.0) | (np.abs(np.diff(way)) > np.pi)
        name = "balls" if len(result.races) == 1 else f"balls of race {race[j] + 1}"
        label = "_" if race[j] in race[:j] else name
        axes.plot(
            *gapped(result.time, angle, broken), color=color, linestyle=dashes, linewidth=0.9, label=label
        )
    axes.set_ylim(-190.0, 190.0)
    axes.set_yticks([-180.0, -90.0, 0.0, 90.0, 180.0])
    axes.set_ylabel("Angle of balls\n(deg)")


def _draw_depths(axes: Axes, result: RunupAnswer) -> None:
    """Largest and least depth of the first layers; filled between."""
    top = 0.0
    for j, (color, dashes) in enumerate(LAYERS[: len(result.chambers)]):
        crest, trough = result.depth_max[:, j] * MM, result.depth_min[:, j] * MM
        axes.fill_between(result.time, trough, crest, color=color, alpha=0.18, linewidth=0)
        label = f"depth, chamber {j + 1}" if len(result.chambers) > 1 else "largest and least depth"
        for y, name in ((crest, label), (trough, "_")):
            axes.plot(result.time, y, color=color, linewidth=0.9, linestyle=dashes, label=name)
        top = max(top, float(np.nan_to_num(crest).max()))
    axes.set_ylim(0.0, 1.12 * top or 1.0)
    axes.set_ylabel("Depth (mm)")


def energy_figure(result: RunupAnswer) -> Figure:
    """Work done and where it went, as bars."""
    rows = terms(result)
    with style():
        figure = Figure()
        axes: Axes = figure.add_axes((0, 0, 1, 1))
        for row, (name, _, value) in enumerate(rows):
            gained = name in GAINS
            look = {"color": GAINED if gained else USED, "label": "brought in" if gained else "used"}
            hatch = None if gained else "//"
            axes.barh(row, value, height=0.62, hatch=hatch, edgecolor="white", linewidth=0.5, **look)
        largest = max(abs(value) for *_, value in rows) or 1.0
        least = min(0.0, *(value for *_, value in rows))
        for row, (*_, value) in enumerate(rows):
            text = f" {value:.3g} J".replace("-", "\N{MINUS SIGN}")
            axes.text(max(value, 0.0) + 0.01 * largest, row, text, va="center", fontsize=7)
        axes.axvline(0.0, color="0.15", linewidth=0.8)
        axes.set_xlim(1.1 * least - 0.01 * largest, 1.2 * largest)
        axes.set_ylim(len(rows) - 0.4, -0.6)
        axes.set_yticks(range(len(rows)), [text for _, text, _ in rows])
        axes.grid(visible=False, axis="y")
        axes.set_xlabel("Energy (J)")
        axes.xaxis.set_major_formatter(number)
        text = f"Energy over the whole run; not accounted for: {result.energy_error:.2%} of the work."
        lay_out(figure, [[axes]], [2.3], ENERGY_FRAME, caption(result, text))
        figure.alt = (
            "Bars of the work done on rotor and liquid and of where it went, as in the table of the energy."
        )
    return figure


def caption(result: RunupAnswer, text: str) -> Caption:
    """What a figure shows, the scene, model, friction, resolution, error and what is assumed."""
    error = result.error_estimate
    size = "not estimated" if math.isnan(error) else f"{error:.1%} of the largest"
    if not math.isnan(result.handover_estimate):
        size += f" by cells and steps, {result.handover_estimate:.1%} by the pool-annulus transition"
    if result.spread is not None:
        size += f"; by rounding alone {percent(result.spread.largest_spread)}"
    assumed = assumed_words(result.assumed)
    stopped = "" if result.converged else f" Stopped: {one_line(result.reason)}."
    return Caption(
        f"{text}{stopped}",
        f"Scene: {one_line(result.name)}, {result.axis} axis. Liquid model: "
        f"{describe_model(result)}; liquid friction: "
        f"{friction_words(result.friction)}. Error of the amplitude: {size}. Assumed: {assumed}.",
    )
