"""The figure of an exciter: stuck speeds of its balls and the vibration of its platform over speed."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from leblanc.figures.page import Figure, FigureFiles, Frame, lay_out, number, save, style
from leblanc.results.provenance import one_line
from leblanc.studies.exciter import ExciterRecord
from leblanc.units import MM, RPM

FRAME = Frame(left=0.72, top=0.46, between=0.14, below=0.42)
TITLE = "Stuck speeds of the balls and vibration of the platform"
_BRANCHES = (
    ("stuck together, slowest", {"color": "C0", "linestyle": "-"}),
    ("middle (unstable)", {"color": "C1", "linestyle": ":"}),
    ("fastest", {"color": "C2", "linestyle": "--"}),
)
_HELD = {"linestyle": "none", "marker": "o", "markerfacecolor": "white", "markeredgecolor": "black"}
_LOST = {"linestyle": "none", "marker": "x", "markeredgecolor": "black", "markersize": 6.0}


def exciter_figure(record: ExciterRecord) -> Figure:
    """Stuck speeds above, slow and fast vibration below, time integrations as marks.

    Parameters
    ----------
    record : the answer
    """
    with style():
        figure = Figure()
        above: Any = figure.add_axes((0, 0, 1, 1), label="stuck")
        below: Any = figure.add_axes((0, 0, 1, 1), label="vibration")
        _draw_stuck(above, record)
        _draw_vibration(below, record)
        low, high = float(record.speed.min()) * RPM, float(record.speed.max()) * RPM
        margin = 0.01 * (high - low) if high > low else 1.0
        for axes in (above, below):
            axes.set_yscale("log")
            axes.set_xlim(low - margin, high + margin)
            axes.xaxis.set_major_formatter(number)
            axes.yaxis.set_major_formatter(number)
            axes.yaxis.set_minor_formatter("")
            _mark_critical(axes, record)
        above.tick_params(labelbottom=False)
        below.set_xlabel("Shaft speed (rpm)")
        rates = above.secondary_xaxis("top", functions=(_to_rate, _to_rpm))
        rates.set_xlabel("Shaft speed (rad/s)")
        rates.xaxis.set_major_formatter(number)
        lay_out(figure, [[above], [below]], [2.3, 1.8], FRAME, _caption(record), most_lines=6)
    return figure


def write_exciter_figure(record: ExciterRecord, directory: Path) -> FigureFiles:
    """Draw the figure and write it as PNG and SVG.

    Parameters
    ----------
    record : the answer
    directory : where the files go; made if it is missing
    """
    return save(exciter_figure(record), directory, "exciter", TITLE)


def _draw_stuck(axes: Any, record: ExciterRecord) -> None:
    """Branches, and where the time integrations stand on them."""
    for column, (label, look) in enumerate(_BRANCHES):
        if np.isfinite(record.stuck[:, column]).any():
            axes.plot(record.speed * RPM, record.stuck[:, column] * RPM, label=label, **look)
    axes.axhline(
        record.machine.natural_frequency * RPM, color="0.45", linewidth=0.7, label="natural frequency"
    )
    _draw_checks(axes, record, "stuck_speed", RPM)
    _draw_lost(axes, record)
    axes.set_ylabel("Speed of the balls (rpm)")


def _draw_vibration(axes: Any, record: ExciterRecord) -> None:
    """Amplitudes with the balls and with the shaft; that of the balls only where they stay."""
    slow = np.where(record.dual_frequency, record.slow, np.nan)
    axes.plot(record.speed * RPM, slow * MM, color="C0", label="slow vibration, with the balls")
    if np.any(record.fast > 0.0):
        look = {"color": "C3", "linestyle": "-."}
        axes.plot(record.speed * RPM, record.fast * MM, label="fast vibration, with the shaft", **look)
    _draw_checks(axes, record, "slow", MM)
    _draw_checks(axes, record, "fast", MM)
    axes.set_ylabel("Amplitude (mm)")


def _draw_checks(axes: Any, record: ExciterRecord, quantity: str, unit: float) -> None:
    """Marks of the time integrations in which the balls stay."""
    mine = [one for one in record.checks if one.holds and math.isfinite(getattr(one, quantity))]
    mine = [one for one in mine if getattr(one, quantity) > 0.0]
    if mine:
        values = [getattr(one, quantity) * unit for one in mine]
        axes.plot([one.speed * RPM for one in mine], values, label="time integration, balls stay", **_HELD)


def _draw_lost(axes: Any, record: ExciterRecord) -> None:
    """Crosses on the slowest branch where the balls leave it or do not come to it."""
    lost = [one.speed for one in record.checks if not one.holds]
    if lost:
        places = np.interp(lost, record.speed, record.stuck[:, 0])
        axes.plot(np.array(lost) * RPM, places * RPM, label="time integration, balls leave", **_LOST)


def _mark_critical(axes: Any, record: ExciterRecord) -> None:
    """Line at the critical speed, hatched beyond."""
    if not math.isfinite(record.critical) or record.critical >= float(record.speed.max()):
        return
    look = {"facecolor": "none", "edgecolor": "0.75", "hatch": "///", "linewidth": 0.0}
    end = axes.get_xlim()[1]
    axes.axvspan(record.critical * RPM, end, label="beyond the critical speed", zorder=0, **look)
    axes.axvline(record.critical * RPM, color="0.25", linewidth=0.9)


def _caption(record: ExciterRecord) -> str:
    numbers, known = record.numbers, record.characteristic
    critical = f"{record.critical * RPM:.0f} rpm" if math.isfinite(record.critical) else "none"
    three = (
        f"Three stuck speeds from {known[0] * RPM:.0f} to {known[2] * RPM:.0f} rpm. "
        if math.isfinite(known[0])
        else "One stuck speed at every shaft speed. "
    )
    start = {
        "released": "platform at rest, balls on their way at the natural frequency",
        "regime": "in the dual-frequency motion",
        "rest": "platform and balls at rest",
    }[record.start.kind]
    assumed = ", ".join(map(one_line, record.assumed)) or "nothing"
    return (
        f"{TITLE}. {three}Critical speed {critical}, started with {start}, "
        f"{record.start.separation:g} rad apart. Lines: lowest order in the balls' share of the mass "
        f"({numbers.smallness:.3g}); drag {numbers.drag:.3g}, unbalance {numbers.unbalance:.3g}, damping "
        f"ratio {numbers.damping:.3g}; no gravity. Scene: {one_line(record.name)}. Assumed: {assumed}."
    )


def _to_rate(rpm: ArrayLike) -> ArrayLike:
    return np.asarray(rpm) / RPM


def _to_rpm(rate: ArrayLike) -> ArrayLike:
    return np.asarray(rate) * RPM
