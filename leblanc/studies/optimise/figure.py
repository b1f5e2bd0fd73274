"""What an optimum was chosen from: the objective over the volumes, and the front of what can be had."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from fluid.temperature import CELSIUS
from leblanc.core.notes import assumed_words, one_line, texts
from leblanc.core.units import DEGREE, LENGTH, ML, MM, MM_PEAK, UNBALANCE, VOLUME, in_rpm, unit_for, with_unit
from leblanc.plotting.page import RIGHT, WIDTH, Caption, Figure, Frame, lay_out, number, style
from leblanc.studies.optimise.answer import ConditionTable, OptimumAnswer, load_words
from leblanc.studies.run.notes import plane_label
from meshes.arrays import Array, Flags

Axes = Any  # matplotlib's, which no module that only draws imports

GRAM = 1e3  # grams in one kilogram
FRAME = Frame(left=0.72, top=0.14, between=0.55, below=0.42)
LOW = 1.1  # inches: of a panel that stands below another
HEIGHT, BAR, ROOM = 2.7, 0.13, 0.85  # inches: of a panel, width of a colour bar, room for it
LINE, DRY, BEST, FULL = "#0072B2", "#D55E00", "#009E73", "0.15"
BARE = {"color": DRY, "linewidth": 1.0, "linestyle": (0, (1, 1.5)), "zorder": 1.5}
FAR = 3.0  # times the baseline or the best, beyond which points are left out of the picture
SIZES = (12.0, 130.0)  # of the marks of the front, points squared
MOST_SLICES = 3
DOT = 14.0  # of the marks over two volumes, points squared
LEAST = 1e-4  # of what a chamber holds, below which a map is no longer logarithmic


def conditions_figure(result: OptimumAnswer) -> Figure:
    """Amplitude with the best volumes over temperature, or over the unbalance where no temperature varies."""
    table = result.robust
    assert table is not None
    with style():
        figure = Figure()
        axes = figure.add_axes((0, 0, 1, 1), label="amplitude")
        panels, heights = [[axes]], [HEIGHT]
        if table.temperature.size > 1:
            _draw_over_temperature(axes, table)
            below = figure.add_axes((0, 0, 1, 1), label="margin")
            _draw_margin(below, table)
            panels, heights = [[axes], [below]], [HEIGHT, LOW]
        else:
            _draw_over_unbalance(axes, table)
        _numbered(axes)
        axes.set_ylabel(_vibration_label(result))
        axes.set_ylim(0.0, 1.12 * MM * float(max(table.amplitude_dry.max(), table.amplitude.max())))
        text = (
            "Solid with marks: with the best volumes; dotted: without liquid, at the same unbalances. "
            f"Star: the condition that decides. {table.words()}. "
            f"{_MARGIN if len(panels) > 1 else ''}"
        )
        lay_out(figure, panels, heights, FRAME, _caption(result, text, False))
        figure.alt = (
            f"Vibration with the best volumes and without liquid over "
            f"{'temperature' if table.temperature.size > 1 else 'unbalance'}. {table.words()}."
        )
    return figure


_MARGIN = (
    "Margin: decay of the slowest-decaying small whirl at the operating speeds, by the viscosity there; "
    "below 0 one grows. "
)
_MARKS = ("o", "s", "^")  # of the least, middle and largest unbalance


def _numbered(axes: Axes) -> None:
    for each in (axes.xaxis, axes.yaxis):
        each.set_major_formatter(number)


def _star(axes: Axes, x: float, y: float, label: str, size: float = 12.0) -> None:
    look = {"color": BEST, "marker": "*", "linestyle": "none", "markeredgecolor": "black"}
    axes.plot([x], [y], label=label, markersize=size, zorder=4, clip_on=False, **look)


def _draw_over_temperature(axes: Axes, table: ConditionTable) -> None:
    """A curve for each unbalance, the amplitude without liquid beside it."""
    celsius = table.temperature - CELSIUS
    for j, size in enumerate(table.unbalance.tolist()):
        label = load_words(size)
        look = {"color": LINE, "marker": _MARKS[j % len(_MARKS)], "markersize": 3.5, "markevery": 6}
        axes.plot(celsius, table.amplitude[:, j] * MM, label=label, linewidth=1.2, zorder=2, **look)
        dry = {"label": "without liquid"} if j == 0 else {}
        axes.plot(celsius[[0, -1]], [table.amplitude_dry[j] * MM] * 2, **BARE, **dry)
    k = table.decisive
    at = table.condition_temperature[k] - CELSIUS, table.condition_amplitude[k] * MM
    _star(axes, *at, "decides")
    axes.set_xlabel(f"Temperature ({DEGREE}C)")


def _draw_margin(axes: Axes, table: ConditionTable) -> None:
    """Stability margin over temperature; below 0 a whirl grows."""
    axes.plot(table.temperature - CELSIUS, table.stability_margin, color=LINE, linewidth=1.2, zorder=2)
    axes.axhline(0.0, color=FULL, linewidth=0.8, zorder=1)
    _numbered(axes)
    axes.set_xlabel(f"Temperature ({DEGREE}C)")
    axes.set_ylabel("Margin (1/s)")


def _draw_over_unbalance(axes: Axes, table: ConditionTable) -> None:
    """One curve over the largest of the unbalances, the amplitude without liquid beside it."""
    load = table.unbalance.max(axis=1)
    weight = unit_for(UNBALANCE, *load.tolist())
    unit, name = weight.count, weight.name
    look = {"color": LINE, "marker": "o", "markersize": 3.5, "markevery": 6}
    axes.plot(load * unit, table.amplitude[0] * MM, label="best volumes", linewidth=1.2, zorder=2, **look)
    axes.plot(load * unit, table.amplitude_dry * MM, **BARE, label="without liquid")
    k = table.decisive
    at = table.condition_unbalance[k].max() * unit, table.condition_amplitude[k] * MM
    _star(axes, *at, "decides")
    several = table.unbalance.shape[1] > 1
    axes.set_xlabel(f"{'Largest unbalance' if several else 'Unbalance'} ({name})")


def objective_figure(result: OptimumAnswer) -> Figure:
    """Vibration over the volume of one chamber; a map for two; sections through the best point for more."""
    figure, count = Figure(), result.volume.size
    with style():
        if count == 2:
            axes = figure.add_axes((0, 0, 1, 1))
            _draw_map(figure, axes, result)
            lay_out(figure, [[axes]], [HEIGHT], FRAME, _caption(result, _MAP))
            _make_room(figure, axes)
        else:
            shown = min(count, MOST_SLICES)
            rows = [[figure.add_axes((0, 0, 1, 1), label=str(k))] for k in range(shown)]
            for k, (axes,) in enumerate(rows):
                _draw_section(axes, result, k)
            height, text = (HEIGHT, _CURVE) if count == 1 else (1.5, _SECTIONS)
            lay_out(figure, rows, [height] * shown, FRAME, _caption(result, text))
    best = ", ".join(with_unit(volume, VOLUME) for volume in result.volume.tolist())
    figure.alt = (
        f"Vibration over the volumes that were tried; the best, {best}, gives "
        f"{with_unit(result.vibration, LENGTH)}, no liquid {with_unit(result.vibration_baseline, LENGTH)}."
    )
    return figure


_MOST = "Where several limits are exceeded, a mark names the one exceeded most. "
_CURVE = f"Every volume that was tried. {_MOST}"
_SECTIONS = (
    f"The volumes that were tried, over each chamber's own; the others differ from point to point. {_MOST}"
)
_MAP = (
    f"Every pair of volumes that was tried, coloured by its vibration; nothing is drawn between them. {_MOST}"
)


def front_figure(result: OptimumAnswer) -> Figure:
    """Vibration over the mass of liquid; the size of a mark shows the stability margin."""
    with style():
        figure = Figure()
        axes = figure.add_axes((0, 0, 1, 1))
        _draw_front(axes, result)
        text = (
            "Of these points none is better than another in vibration, mass of liquid and stability margin "
            "at once. The margin is the decay of the slowest-decaying small whirl at the operating "
            "speeds; circles: all decay, the larger the faster; crosses: one grows, the larger the faster. "
        )
        lay_out(figure, [[axes]], [HEIGHT], FRAME, _caption(result, text, False))
        figure.alt = (
            "Vibration over the mass of liquid for the points that no other beats, with their stability "
            "margins, as in the table."
        )
    return figure


def _known(result: OptimumAnswer) -> tuple[Array, Array, list[str]]:
    """Volumes, vibrations and what is exceeded of the points that are sure, or by the emulator."""
    tried = result.candidates
    good = np.isfinite(tried.vibration)
    if result.emulator is None:
        good &= tried.exact
    told = tried.exceeded or tuple("a constraint" if excess > 0.0 else "" for excess in tried.excess)
    points, vibration = tried.volume[good], tried.vibration[good]
    exceeded = [name.replace("_", " ") for name, own in zip(told, good, strict=True) if own]
    if result.sweep is not None and result.volume.size == 1:
        points = np.concatenate((points, result.sweep.volume))
        vibration = np.concatenate((vibration, result.sweep.vibration))
        exceeded += [_NOT_EVALUATED] * result.sweep.mass.size
    return points, vibration, exceeded


_NOT_EVALUATED = "not evaluated"
# Marks of the points that were tried: those that keep to all, then those that exceed something, by its name.
_TRIED, _OVER = "o", ("x", "+", "1", "2", "3", "4")
_OVER_FILLED = ("s", "D", "^", "v", "<", ">")


def _groups(exceeded: list[str], marks: tuple[str, ...]) -> list[tuple[str, str, Flags]]:
    """Mark, label and points of those that keep to all, and of those that exceed each constraint most."""
    names = np.array(exceeded, dtype=object)
    found = [(_TRIED, "tried", names == "")]
    over = sorted({name for name in exceeded if name not in ("", _NOT_EVALUATED)})
    for k, name in enumerate(over):
        found.append((marks[k % len(marks)], f"tried, limit of {name} exceeded", names == name))
    return [group for group in found if group[2].any()]


def _draw_section(axes: Axes, result: OptimumAnswer, k: int) -> None:
    """Vibration over the volume of one chamber."""
    points, vibration, exceeded = _known(result)
    alone = result.volume.size == 1
    volume = points[:, k] * ML
    least = float(volume[volume > 0.0].min(initial=math.inf))
    order = np.argsort(volume, kind="stable")
    volume, vibration, exceeded = volume[order], vibration[order] * MM, [exceeded[i] for i in order.tolist()]
    if alone:
        axes.plot(volume, vibration, color=LINE, linewidth=1.0, zorder=2)
    for mark, label, chosen in _groups(exceeded, _OVER):
        look = {"color": LINE, "linestyle": "none", "markersize": 3.0, "zorder": 2.5}
        axes.plot(
            volume[chosen], vibration[chosen], label=label, marker=mark, markerfacecolor="white", **look
        )
    _marks(axes, result, k)
    top = FAR * max(result.vibration_baseline, result.vibration) * MM
    # From zero, so that a gain is seen as large as it is.
    high = max(min(float(vibration.max(initial=0.0)), top), result.vibration_baseline * MM)
    axes.set_ylim(0.0, 1.08 * high or 1.0)
    if math.isfinite(least):
        _symlog(axes, "x", least, (-0.15 * least, 1.15 * result.chambers[k].capacity * ML))
    axes.minorticks_off()
    _numbered(axes)
    axes.set_xlabel("Liquid (ml)" if alone else f"Liquid in chamber {k + 1} (ml)")
    axes.set_ylabel(_vibration_label(result))


def _marks(axes: Axes, result: OptimumAnswer, k: int) -> None:
    """The best point, the baseline and the analytical checks of one chamber."""
    baseline = result.vibration_baseline * MM
    axes.axhline(baseline, **BARE, label="without liquid")
    _star(axes, result.volume[k] * ML, result.vibration * MM, "best", 11.0)
    if k < len(result.closed_form):
        form = result.closed_form[k]
        dashes = {"color": FULL, "linewidth": 0.9, "zorder": 1.6}
        axes.axvline(
            form.optimal_volume * ML, linestyle=(0, (6, 2)), label="analytical: wetting volume", **dashes
        )
        label = "analytical: full volume, wet to the lid"
        axes.axvline(form.full_volume * ML, linestyle=(0, (1, 1)), label=label, **dashes)


def _draw_map(figure: Figure, axes: Axes, result: OptimumAnswer) -> None:
    """Vibration over the volumes of two chambers: a coloured mark for each pair tried."""
    points, vibration, exceeded = _known(result)
    points, first = np.unique(points, axis=0, return_index=True)
    value, exceeded = vibration[first] * MM, [exceeded[i] for i in first.tolist()]
    capacity = np.array([chamber.capacity for chamber in result.chambers])
    least = LEAST * capacity
    worst = max(result.vibration_baseline, result.vibration) * MM
    low = float(value.min())
    top = 1.03 * worst if worst > 1.03 * low else FAR * low
    order = np.argsort(-value, kind="stable")  # the best lie on top
    drawn = None
    for mark, label, chosen in _groups(exceeded, _OVER_FILLED):
        own = order[chosen[order]]
        drawn = axes.scatter(
            *(points[own].T * ML),
            c=value[own],
            **{"vmin": low, "vmax": top, "cmap": "cividis", "clip_on": False, "zorder": 2.5},
            **{"marker": mark, "s": DOT, "edgecolors": "0.35", "linewidths": 0.25},
        )
        look = {"color": "none", "markeredgecolor": "0.2", "markeredgewidth": 0.7, "markersize": 4.0}
        axes.plot([], [], marker=mark, linestyle="none", label=label, **look)
    first, second = (result.volume * ML).tolist()
    _star(axes, first, second, "best")
    for form, line in zip(result.closed_form, (axes.axvline, axes.axhline), strict=False):
        dashes = {"color": FULL, "linewidth": 0.9, "linestyle": (0, (6, 2)), "zorder": 1.6}
        line(form.optimal_volume * ML, **dashes, label="analytical: wetting volume")
    for k, scale in enumerate(("x", "y")):
        _symlog(axes, scale, least[k] * ML, (0.0, capacity[k] * ML))
    axes.set_xlabel("Liquid in chamber 1 (ml)")
    axes.set_ylabel("Liquid in chamber 2 (ml)")
    if drawn is not None:
        bar = figure.add_axes((0, 0, 1, 1), label="bar")
        more = "max" if value.max() > top else "neither"
        figure.colorbar(
            drawn,
            cax=bar,
            label=_vibration_label(result),
            format=lambda value, _: number(_short(value)),
            extend=more,
        )


def _vibration_label(result: OptimumAnswer) -> str:
    """Of an axis of vibrations, with the plane where a rotor tilts."""
    tilts = result.response is not None and result.response.motion is not None
    return f"Vibration{plane_label(chambers=True) if tilts else ''} ({MM_PEAK})"


def _symlog(axes: Axes, scale: str, least: float, limits: tuple[float, float]) -> None:
    """Logarithmic axis with 0 on it."""
    getattr(axes, f"set_{scale}scale")("symlog", linthresh=least, linscale=0.3)
    getattr(axes, f"set_{scale}lim")(*limits)
    ticks = [0.0, *10.0 ** np.arange(math.ceil(math.log10(least)), 12)]
    getattr(axes, f"set_{scale}ticks")([tick for tick in ticks if tick <= limits[1]])
    axes.minorticks_off()
    getattr(axes, f"{scale}axis").set_major_formatter(number)


def _make_room(figure: Figure, axes: Axes) -> None:
    """Place of the colour bar on the right."""
    box = axes.get_position()
    width = box.width - (ROOM - RIGHT) / WIDTH
    axes.set_position((box.x0, box.y0, width, box.height))
    for bar in figure.axes:
        if bar is not axes:
            bar.set_position((box.x0 + width + 0.1 / WIDTH, box.y0, BAR / WIDTH, box.height))


def _draw_front(axes: Axes, result: OptimumAnswer) -> None:
    """The front, the point chosen, and the machine without liquid."""
    front = result.front
    assert front is not None
    mass, vibration = front.mass * GRAM, front.vibration * MM
    widest = float(np.abs(front.stability_margin).max(initial=0.0))
    share = np.abs(front.stability_margin) / widest if widest > 0.0 else np.zeros_like(front.stability_margin)
    size = SIZES[0] + (SIZES[1] - SIZES[0]) * share
    calm = front.stability_margin >= 0.0
    order = np.lexsort((vibration, mass))
    attained = np.minimum.accumulate(vibration[order])
    look = {"color": "0.75", "linewidth": 0.8, "zorder": 1, "drawstyle": "steps-post"}
    axes.plot(mass[order], attained, label="least with so much liquid at most", **look)
    top = f"margin {number(_short(float(front.stability_margin.max())))} 1/s at most"
    if calm.any():
        look = {"facecolor": "white", "edgecolor": LINE, "linewidths": 1.0, "zorder": 2}
        axes.scatter(mass[calm], vibration[calm], s=size[calm], label=f"no whirl grows; {top}", **look)
    if not calm.all():
        worst = f"a whirl grows, by {number(_short(float(-front.stability_margin.min())))} 1/s at most"
        axes.scatter(
            mass[~calm], vibration[~calm], s=size[~calm], marker="x", color=DRY, label=worst, linewidths=1.0
        )
    axes.axhline(result.vibration_baseline * MM, **BARE, label="without liquid")
    _star(axes, result.mass * GRAM, result.vibration * MM, f"chosen: {result.objective}")
    wet = mass[mass > 0.0]
    if wet.size and wet.max() > 30.0 * wet.min():
        least = float(wet.min())
        _symlog(axes, "x", least, (-0.5 * least, 1.3 * float(wet.max())))
    _numbered(axes)
    # From zero, so that a gain is seen as large as it is.
    axes.set_ylim(0.0, 1.08 * max(float(vibration.max(initial=0.0)), result.vibration_baseline * MM) or 1.0)
    axes.set_xlabel("Liquid (g)")
    axes.set_ylabel(_vibration_label(result))


def _short(value: float) -> float:
    return float(f"{value:.3g}")


def _caption(result: OptimumAnswer, text: str, forms: bool = True) -> Caption:
    """What is shown, the scene, the objective."""
    assumed = assumed_words(result.assumed)
    notes = " ".join(map(one_line, texts(result.notes)))
    vibration = result.meaning if result.unit == "m" else "the amplitude that is limited"
    what = result.constraints["vibration"].meaning if "vibration" in result.constraints else vibration
    at = f"Analytical checks at the deflection of the best point at {in_rpm(result.working_speed)}. "
    at = at if forms and result.closed_form else ""
    place = f" {result.place}" if result.place else ""
    shown = f"{text}Vibration: {what}{place}. Objective: {result.objective}. {at}"
    origin = (
        f"{notes} Scene: {one_line(result.name)}. Friction of the liquid: {result.friction.law}. "
        f"Assumed: {assumed}."
    )
    return Caption(" ".join(shown.split()), " ".join(origin.split()))
