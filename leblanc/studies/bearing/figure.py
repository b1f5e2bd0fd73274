"""Figure of a rolling bearing: its frequencies as lines over those of the shaft."""

from __future__ import annotations

from typing import Any

from leblanc.plotting.page import Caption, Figure, Frame, lay_out, number, style
from leblanc.studies.bearing.answer import HERTZ, NAMES, BearingAnswer, bearing_words, frequency_rows

FRAME = Frame(left=1.3, top=0.15, between=0.1, below=0.42)


def bearing_figure(result: BearingAnswer) -> Figure:
    """Each frequency as a bar, those that were given as marks."""
    hertz = result.speed * HERTZ
    with style():
        figure = Figure()
        figure.alt = "; ".join(f"{row[0]} {row[1]} Hz" for row in frequency_rows(result))
        axes: Any = figure.add_axes((0, 0, 1, 1), label="frequencies")
        names = list(NAMES)
        axes.barh(range(4), [result.orders[name] * hertz for name in names], color="C0", height=0.5)
        axes.set_yticks(range(4), [NAMES[name] for name in names])
        axes.invert_yaxis()
        axes.axvline(hertz, color="0.3", linestyle="--", linewidth=0.9, label="shaft")
        given = [(result.given[name] * hertz, k) for k, name in enumerate(names) if name in result.given]
        if given:
            look = {"marker": "o", "markerfacecolor": "white", "markeredgecolor": "black"}
            axes.plot(*zip(*given, strict=True), linestyle="none", label="given", **look)
        axes.xaxis.set_major_formatter(number)
        axes.set_xlabel("Frequency (Hz)")
        caption = Caption(f"{bearing_words(result)}. Balls that roll without slip, outer ring at rest.")
        lay_out(figure, [[axes]], [1.5], FRAME, caption)
    return figure
