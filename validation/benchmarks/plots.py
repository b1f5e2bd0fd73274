"""Figures of the benchmarks: error over time of every code, and growth of the cost."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from leblanc.figures.page import Figure, Frame, lay_out, save, style
from validation.benchmarks.growth import Growth
from validation.benchmarks.table import Section, front

_RAISED = str.maketrans("-0123456789", "\u207b\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079")
_FRAME = Frame(left=0.72, top=0.15, between=0.0, below=0.45)
_MARKS = "osD^vP"
_LINES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 3)))


def accuracy_figure(section: Section, directory: Path) -> Path:
    """Error over time, one mark for each sample; what no other setting of its code beats is joined by a line.

    Parameters
    ----------
    section : to draw
    directory : where the PNG and SVG go
    """
    with style():
        figure = Figure()
        axes = figure.add_axes((0, 0, 1, 1))
        for k, code in enumerate(dict.fromkeys(one.code for one in section.samples)):
            mine = [one for one in section.samples if one.code == code and one.error > 0.0]
            best = front(mine)
            look: dict[str, Any] = {"color": f"C{k}", "marker": _MARKS[k % len(_MARKS)]}
            times, errors = ([getattr(one, name) for one in mine] for name in ("seconds", "error"))
            axes.plot(times, errors, linestyle="none", markerfacecolor="white", **look)
            times, errors = ([getattr(one, name) for one in best] for name in ("seconds", "error"))
            line: dict[str, Any] = {"linestyle": _LINES[k % len(_LINES)], "linewidth": 1.1, "label": code}
            axes.plot(times, errors, **line, **look)
        _logarithmic(axes)
        axes.set_xlabel("Time of one answer (s)")
        axes.set_ylabel(f"{section.error[0].upper()}{section.error[1:]} (\N{EN DASH})")
        text = (
            f"{section.title}. One core, best of several repeats taken in turn, without compilation. "
            "Filled: no other setting of that code is both faster and better."
        )
        lay_out(figure, [[axes]], [3.0], _FRAME, text)
    return save(figure, directory, section.name, section.title).png


def _logarithmic(axes: Any) -> None:
    """Both axes, labelled at powers of ten as the house style writes them, upwards at two at least."""
    axes.set_xscale("log")
    axes.set_yscale("log")
    low, high = (math.log10(value) for value in axes.get_ylim())
    if math.floor(high) - math.ceil(low) < 1:
        axes.set_ylim(10.0 ** math.floor(low), 10.0 ** math.ceil(high))
    axes.minorticks_off()
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(_power)


def _power(value: float, _position: int | None = None) -> str:
    return "10" + str(round(math.log10(value))).translate(_RAISED)


def growth_figure(growths: Sequence[Growth], name: str, directory: Path) -> Path:
    """Cost over one number, both logarithmic.

    Parameters
    ----------
    growths : over the same number
    name : stem of the files
    directory : where they go
    """
    with style():
        figure = Figure()
        axes = figure.add_axes((0, 0, 1, 1))
        for k, one in enumerate(growths):
            look: dict[str, Any] = {
                "color": f"C{k}",
                "marker": _MARKS[k % len(_MARKS)],
                "linestyle": _LINES[k % len(_LINES)],
            }
            axes.plot(one.counts, one.seconds, linewidth=1.1, label=one.name, **look)
        _logarithmic(axes)
        counts = sorted({n for one in growths for n in one.counts})
        axes.set_xticks(counts, [str(n) for n in counts])
        over = " or ".join(dict.fromkeys(one.over for one in growths))
        axes.set_xlabel(f"Number of {over} (\N{EN DASH})")
        axes.set_ylabel("Time (s)")
        text = f"Growth of the cost with the number of {over}. One core, best of several repeats."
        lay_out(figure, [[axes]], [2.8], _FRAME, text)
    return save(figure, directory, name, text).png
