"""How the answers of a sweep spread: amplitude over speed, or boxes of the single outputs."""

from __future__ import annotations

from typing import Any

import numpy as np

from leblanc.core.notes import one_line
from leblanc.core.units import MM, MM_PEAK, RPM
from leblanc.plotting.curves import COLUMNS, Span, thin, windows
from leblanc.plotting.page import (
    Caption,
    Figure,
    Frame,
    add_rate_axis,
    add_windows,
    lay_out,
    number,
    style,
)
from leblanc.studies.run.figure import DOWN, DRY, SHARE, UNSTABLE, WET, value_axis, wider_words
from leblanc.studies.run.notes import plane_label
from leblanc.studies.sweep.answer import OverValue, SweepAnswer
from meshes.arrays import Array

Axes = Any  # matplotlib's, which no module that only draws imports

OVER_SPEED = Frame(left=0.72, top=0.46, between=0.12, below=0.42)
OVER_VALUE = Frame(left=0.72, top=0.12, between=0.12, below=0.42)
BOXES = Frame(left=1.85, top=0.12, between=0.45, below=0.42)
FEW = 60  # points that are marked each
PANEL, ROW = 2.9, 0.32  # inches: a panel over speed, a box
WIDE, NARROW = "#BFDCEC", "#7FB9DA"  # tints of the colour with liquid, apart in grey as well
BARE = {"color": DRY, "linewidth": 1.0, "markerfacecolor": "white"}


def sweep_figure(answer: SweepAnswer) -> Figure:
    """Amplitude over the one value of a grid; else over speed with the ranges of the samples, or boxes."""
    with style():
        figure = Figure()
        if answer.over_value is not None:
            figure.alt = answer.over_value.sentence(answer.at_last)
            _over_value(figure, answer, answer.over_value)
        elif answer.speed is not None and answer.speed.size > 1:
            what = "Median and ranges of the amplitude over speed; largest amplitude"
            figure.alt = f"{what}: {answer.spread('peak_amplitude')}."
            _over_speed(figure, answer, answer.speed)
        else:
            what = "Boxes with the quantiles of the amplitudes and of the growth rate"
            figure.alt = f"{what}; amplitude at the last speed: {answer.spread('last_amplitude')}."
            _boxes(figure, answer)
    return figure


def _over_value(figure: Figure, answer: SweepAnswer, over: OverValue) -> None:
    """Last and largest amplitude, with liquid solid, without dashed; where the last is unstable."""
    pairs = [("last_amplitude", answer.at_last, WET)]
    pairs += [("peak_amplitude", "largest", DOWN)] if answer.speeds > 1 else []
    lines = {key: over.outputs[key] * MM for name, _, _ in pairs for key in (name, f"{name}_dry")}
    drawn = thin(np.column_stack([*lines.values()]), COLUMNS)
    x = over.value * over.unit.count
    axes: Any = figure.add_axes((0, 0, 1, 1))
    few = drawn.size <= FEW
    for name, label, colour in pairs:
        for key, dashes in ((name, "solid"), (f"{name}_dry", UNSTABLE)):
            bare = key != name
            mark = {"marker": "o", "markersize": 3.0} if few and not bare else {}
            text = f"{label}, {'without' if bare else 'with'} liquid"
            axes.plot(x[drawn], lines[key][drawn], color=colour, linestyle=dashes, label=text, **mark)
    if over.stable is not None and (known := ~over.stable & np.isfinite(lines["last_amplitude"])).any():
        mark = {"color": "0.15", "marker": "x", "linestyle": "none", "zorder": 3, "clip_on": False}
        axes.plot(x[known], lines["last_amplitude"][known], label=f"unstable {answer.at_last}", **mark)
    top = max((float(line[np.isfinite(line)].max(initial=0.0)) for line in lines.values()), default=0.0)
    axes.set_ylim(0.0, 1.08 * top or 1.0)
    if over.options:
        axes.set_xticks(range(x.size), [one_line(over.text(k)) for k in range(x.size)])
        axes.set_xlim(-0.5, x.size - 0.5)
    else:
        room = 0.02 * (x[-1] - x[0]) or 1.0
        axes.set_xlim(x[0] - room, x[-1] + room)
        axes.xaxis.set_major_formatter(number)
    axes.yaxis.set_major_formatter(number)
    axes.set_xlabel(over.label)
    axes.set_ylabel(_amplitude_label(answer))
    text = f"Amplitude {answer.at_last} over {over.name}."
    if answer.speeds > 1:
        text = f"Amplitude {answer.at_last} and largest amplitude over {over.name}."
    lay_out(figure, [[axes]], [PANEL], OVER_VALUE, _caption(answer, text))


def _amplitude_label(answer: SweepAnswer) -> str:
    place = plane_label("chamber" in answer.plane) if answer.plane else ""
    return f"Amplitude{place} ({MM_PEAK})"


def _over_speed(figure: Figure, answer: SweepAnswer, speed: Array) -> None:
    """Median and two ranges at each speed, and the median without liquid."""
    order = np.argsort(speed, kind="stable")
    wet = answer.over_speed["amplitude"].quantiles[order] * MM
    dry = answer.over_speed["amplitude_dry"].quantiles[order, 2] * MM
    drawn = thin(np.column_stack([wet, dry]), COLUMNS)
    rpm, wet, dry = speed[order][drawn] * RPM, wet[drawn], dry[drawn]
    limits = float(rpm[0]), float(rpm[-1])
    axes: Any = figure.add_axes((0, 0, 1, 1))
    _draw(axes, answer, (rpm, wet, dry), limits)
    add_rate_axis(axes)
    text = "Amplitude of the deflection: median and ranges of the samples at each speed."
    if answer.command_of == "runup":
        text = f"Largest amplitude while the spin is in each of {answer.speeds} bands: median and ranges of "
        text += "the samples that come there."
    spans = windows([(rpm, line) for line in (*wet.T, dry)], limits)
    if not spans:
        axes.set_xlabel("Speed (rpm)")
        lay_out(figure, [[axes]], [PANEL], OVER_SPEED, _caption(answer, text))
        return
    wide = [figure.add_axes((0, 0, 1, 1), label=f"from {number(span[0])} rpm") for span in spans]
    for panel, span in zip(wide, spans, strict=True):
        inside = slice(max(int(np.searchsorted(rpm, span[0])) - 1, 0), int(np.searchsorted(rpm, span[1])) + 1)
        _draw(panel, answer, (rpm[inside], wet[inside], dry[inside]), span)
    heights = (SHARE * PANEL, SHARE * PANEL)
    add_windows(figure, [axes], [wide], heights, _caption(answer, f"{text} {wider_words()}"))


def _draw(axes: Axes, answer: SweepAnswer, lines: tuple[Array, Array, Array], limits: Span) -> None:
    """Ranges and medians over a span of speed: rpm, quantiles with liquid, median without."""
    rpm, wet, dry = lines
    bands = {"linewidth": 0, "zorder": 1.5}
    axes.fill_between(rpm, wet[:, 0], wet[:, 4], color=WIDE, label="5 to 95 % of the samples", **bands)
    axes.fill_between(rpm, wet[:, 1], wet[:, 3], color=NARROW, label="25 to 75 %", **bands)
    axes.plot(rpm, wet[:, 2], color=WET, label="median with liquid")
    every = max(1, rpm.size // 14)
    axes.plot(rpm, dry, label="median without liquid", marker="o", markevery=every, **BARE)
    value_axis(axes, 0.0, [(rpm, line) for line in (*wet.T, dry)])
    axes.set_xlim(*limits)
    axes.set_ylabel(_amplitude_label(answer))
    axes.xaxis.set_major_formatter(number)
    axes.yaxis.set_major_formatter(number)
    axes.yaxis.set_minor_formatter("")


def _boxes(figure: Figure, answer: SweepAnswer) -> None:
    """A box for each amplitude, and one for the growth rate on an axis of its own."""
    last = [("last_amplitude", "with liquid"), ("last_amplitude_dry", "without liquid")]
    if answer.speeds > 1:
        last = [(name, f"at the last speed,\n{text}") for name, text in last]
        peaks = [("peak_amplitude", "with liquid"), ("peak_amplitude_dry", "without liquid")]
        last = [(name, f"largest,\n{text}") for name, text in peaks] + last
    growth = [("peak_growth", "largest growth\nof a whirl")]
    panels = [(last, f"Amplitude ({MM_PEAK})", MM), (growth, "Growth (1/s)", 1.0)]
    rows, heights = [], []
    for outputs, label, unit in panels:
        axes: Any = figure.add_axes((0, 0, 1, 1), label=label)
        for k, (name, _) in enumerate(outputs):
            _box(axes, float(k), answer.outputs[name].quantiles * unit, dry=name.endswith("_dry"))
        axes.set_yticks(range(len(outputs)), [text for _, text in outputs])
        axes.set_ylim(len(outputs) - 0.5, -0.5)
        axes.grid(visible=False, axis="y")
        axes.set_xlabel(label)
        axes.xaxis.set_major_formatter(number)
        rows.append([axes])
        heights.append(ROW * (len(outputs) + 0.3))
    text = "Boxes: 25 to 75 % of the samples, with the median; lines: 5 to 95 %."
    lay_out(figure, rows, heights, BOXES, _caption(answer, text))


def _box(axes: Axes, row: float, quantiles: Array, dry: bool) -> None:
    """Quantiles of one output; nothing where no sample has it."""
    if np.isnan(quantiles).any():
        axes.text(0.5, row, "no values", transform=axes.get_yaxis_transform(), ha="center", va="center")
        return
    low, first, middle, third, high = quantiles.tolist()
    colour = DRY if dry else WET
    axes.plot([low, high], [row, row], color=colour, linewidth=1.0, marker="|", markersize=8.0)
    face = "white" if dry else NARROW
    axes.barh(row, third - first, left=first, height=0.5, facecolor=face, edgecolor=colour, zorder=2)
    axes.plot([middle, middle], [row - 0.25, row + 0.25], color=colour, linewidth=2.0, zorder=3)


def _caption(answer: SweepAnswer, text: str) -> Caption:
    """What is shown, the scene, the samples, what varies."""
    varied = ", ".join(map(one_line, answer.fields))
    return Caption(
        f"{text} Amplitudes {answer.plane}." if answer.plane else text,
        f"Scene: {one_line(answer.scene)}. Samples: {answer.done} of {answer.samples} done, {answer.method}, "
        f"seed {answer.seed}. Varied: {varied}.",
    )
