"""Traces of the exciter, critical speed over its numbers: `python -m validation.figures.exciter.traces`."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

from leblanc.figures.drawing.page import Figure, Frame, lay_out, number, save, style
from validation.cases.exciter.traces import DATA, FIGURES, traces

_FRAME = Frame(left=0.72, top=0.2, between=0.3, below=0.45)
_APART = 0.65  # inches between two plots side by side
_LETTERS = {
    "smallness": "\N{GREEK SMALL LETTER EPSILON}",
    "drag": "b",
    "unbalance": "\N{GREEK SMALL LETTER DELTA}",
    "damping": "h",
}
_LOOKS = (("C0", "o", "-"), ("C1", "s", "--"), ("C2", "^", "-."))


def trace_figure(directory: Path) -> Path:
    """Speed of the balls, motion of the platform, and how far the lowest order is off [YF17, fig. 3]."""
    found = traces()
    seen = (found.motion.position, found.motion.velocity, found.motion.acceleration)
    names = ("displacement", "velocity", "acceleration")
    with style():
        figure = Figure()
        panels: list[Any] = [figure.add_axes((0, 0, 1, 1), label=str(k)) for k in range(3)]
        balls, motion, gap = panels
        for k, dashes in enumerate(("-", "--")):
            speed = found.motion.ball_speed[:, k]
            balls.plot(found.turns, speed, color="black", linestyle=dashes, label=f"ball {k + 1}")
        for name, values, lowest, (color, _, dashes) in zip(names, seen, found.lowest, _LOOKS, strict=True):
            motion.plot(found.turns, values, color=color, linestyle=dashes, label=name)
            gap.plot(found.turns, values - lowest, color=color, linestyle=dashes)
        balls.set_ylabel("Ball speed (\N{EN DASH})")
        motion.set_ylabel("Platform (\N{EN DASH})")
        gap.set_ylabel("Gap (\N{EN DASH})")
        gap.set_xlabel("Turns of the balls (\N{EN DASH})")
        for axes in panels:
            axes.set_xlim(0.0, 3.0)
            axes.tick_params(labelbottom=axes is gap)
        text = (
            "Dual-frequency motion at n = 5, eps = 0.01, b = 0.4, delta = 0.25, h "
            "= 0.03, in the machine\u2019s own "
            "units: speed of both balls, motion of the platform, and what it "
            "differs by from the lowest order "
            "(theory: balls, eq. 7), whose phase is fitted."
        )
        lay_out(figure, [[axes] for axes in panels], [1.2, 1.5, 1.2], _FRAME, text)
    return save(figure, directory, "exciter_traces", "Traces of the dual-frequency motion").png


def trend_figure(directory: Path) -> Path:
    """Critical speed over damping, drag and unbalance, from the kept runs [YF17, fig. 5 and 6]."""
    kept = json.loads(DATA.read_text(encoding="utf-8"))["panels"]
    with style():
        figure = Figure()
        rows: list[list[Any]] = []
        for k, (name, panel) in enumerate(zip(FIGURES, kept, strict=True)):
            axes: Any = figure.add_axes((0, 0, 1, 1), label=name)
            apart = _LETTERS[panel["apart"]]
            for other, curve, (color, mark, dashes) in zip(
                panel["others"], panel["curves"], _LOOKS, strict=True
            ):
                axes.plot(panel["values"], curve, color=color, marker=mark, linestyle=dashes)
                axes.annotate(
                    f"{apart} = {other:g}",
                    (panel["values"][-1], curve[-1]),
                    # On panel 5b two curves end close together.
                    xytext=(3, {"C0": 3, "C1": -2}.get(color, 0) if name == "5b" else 0),
                    textcoords="offset points",
                    va="center",
                    fontsize=7,
                )
            low, high = panel["values"][0], panel["values"][-1]
            axes.set_xlim(low - 0.03 * (high - low), high + 0.3 * (high - low))
            axes.set_yscale("log")
            axes.set_yticks([5, 10, 20, 50, 100] if name == "5b" else [5, 7, 10, 15, 20])
            axes.yaxis.set_major_formatter(number)
            axes.yaxis.set_minor_formatter("")
            axes.set_xlabel(f"{panel['along'].capitalize()} {_LETTERS[panel['along']]} (\N{EN DASH})")
            axes.set_title(f"Figure {name}")
            if k % 2 == 0:
                rows.append([])
                axes.set_ylabel("Critical speed n (\N{EN DASH})")
            rows[-1].append(axes)
        text = (
            "Critical speed of the exciter with two balls, released 0.3 rad apart, "
            "no gravity; numbers that are not "
            "on a panel: b = 0.4, h = 0.03, delta = 0.25, and eps = 0.01 (0.005 in 5b)."
        )
        lay_out(figure, rows, [2.0, 2.0], Frame(left=0.6, top=0.25, between=0.75, below=0.45), text)
        for row in rows:
            for axes in row:
                box = axes.get_position()
                shift = 0.5 * _APART / 6.3 if axes is row[1] else 0.0
                axes.set_position((box.x0 + shift, box.y0, box.width - 0.5 * _APART / 6.3, box.height))
    return save(figure, directory, "exciter_trends", "Critical speed over the numbers").png


def main() -> None:
    """Draw both."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("docs/images"))
    out = parser.parse_args().out
    for path in (trace_figure(out), trend_figure(out)):
        path.with_suffix(".svg").unlink()
        print(path)


if __name__ == "__main__":
    main()
