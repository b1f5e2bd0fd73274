"""Self-excited whirl with baffles: growth over speed and the bands, drawn and as a table.

python -m validation.figures.liquid.baffles --out docs/images
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import NO_FRICTION, Friction, FrictionLaw
from leblanc.figures.drawing.page import Figure, Frame, lay_out, number, save, style
from meshes.baffles import Baffles
from solvers.rotor.jeffcott import Jeffcott
from solvers.whirl.edges import unstable_bands
from solvers.whirl.growth import asynchronous_growth
from validation.cases.rotors.whirl import NATURAL, layered_rotor

_FRAME = Frame(left=0.72, top=0.15, between=0.0, below=0.42)
_ZETA = 0.05
_LAW = Friction(FrictionLaw.STOKES)

SPEEDS = np.linspace(0.3, 2.5, 221)  # over the natural frequency
COUNTS = (1, 2, 3, 4, 6, 8)
DEPTHS = (0.5, 0.75, 0.9, 1.0)


@dataclass(frozen=True)
class Line:
    """Whirl with one set of baffles."""

    count: int  #: baffles; 0 for a clear ring
    depth: float  #: of the layer that they stand in, from the wall; 1 through the surface
    growth: float  #: largest over the speeds, over the natural frequency without liquid
    #: in which a whirl grows without damping, speed over that frequency
    bands: tuple[tuple[float, float], ...]
    damped: tuple[tuple[float, float], ...]  #: the same with a damping ratio of 0.05 and laminar friction


def with_baffles(fill: Fill, count: int, depth: float) -> Fill:
    """The same liquid with baffles over a part of the layer from the wall, 1 through the surface."""
    if count == 0:
        return fill
    tip = 0.0 if depth >= 1.0 else fill.chamber.radius - depth * fill.depth
    return replace(fill, chamber=replace(fill.chamber, baffles=Baffles(count, tip)))


def rotors() -> tuple[Jeffcott, Jeffcott, Fill]:
    """The rotor without and with damping of its support, and the clear layer: m_f/M = 0.1, h0/R = 0.1."""
    free, clear = layered_rotor(0.1, 0.1, 0.0)
    return free, layered_rotor(0.1, 0.1, _ZETA)[0], clear


def table(counts: Sequence[int] = COUNTS, depths: Sequence[float] = DEPTHS) -> list[Line]:
    """Growth rate and bands for some sets of baffles, the clear ring first."""
    free, damped, clear = rotors()
    lines = []
    for count, depth in [(0, 0.0), *((n, d) for n in counts for d in depths)]:
        fill = with_baffles(clear, count, depth)
        growth, _ = asynchronous_growth(free, [fill], NATURAL * SPEEDS)
        lines.append(
            Line(
                count,
                depth,
                float(growth.max()) / NATURAL,
                _bands(free, fill, NO_FRICTION),
                _bands(damped, fill, _LAW),
            )
        )
    return lines


def _bands(rotor: Jeffcott, fill: Fill, friction: Friction) -> tuple[tuple[float, float], ...]:
    (found,) = unstable_bands(rotor, [[fill]], NATURAL * SPEEDS, friction)
    return tuple((low / NATURAL, high / NATURAL) for low, high in found)


def growth_figure() -> Figure:
    """Growth over speed of a damped rotor with none and with four baffles of several depths."""
    _, damped, clear = rotors()
    curves: tuple[tuple[str, int, float, str, Any], ...] = (
        ("no baffles", 0, 0.0, "#0072B2", "-"),
        ("4 baffles, 50 % of the depth", 4, 0.5, "#D55E00", (0, (5, 1.5))),
        ("4 baffles, 75 %", 4, 0.75, "#009E73", (0, (6, 1.5, 1, 1.5))),
        ("4 baffles, 90 %", 4, 0.9, "#CC79A7", (0, (1, 1.2))),
        ("4 baffles through the surface", 4, 1.0, "0.35", (0, (3, 1, 1, 1, 1, 1))),
    )
    with style():
        figure = Figure()
        axes: Any = figure.add_axes((0, 0, 1, 1))
        axes.axhline(0.0, color="0.15", linewidth=0.8)
        for label, count, depth, color, dashes in curves:
            fill = with_baffles(clear, count, depth)
            growth, _ = asynchronous_growth(damped, [fill], NATURAL * SPEEDS, _LAW)
            look = {"color": color, "linestyle": dashes, "linewidth": 1.4, "label": label}
            axes.plot(SPEEDS, growth / NATURAL, **look)
        axes.set_xlim(0.6, 2.4)
        axes.xaxis.set_major_formatter(number)
        axes.yaxis.set_major_formatter(number)
        axes.set_xlabel("Spin speed over the natural frequency without liquid (\N{EN DASH})")
        axes.set_ylabel("Growth over the natural frequency (\N{EN DASH})")
        text = (
            "Growth rate of the small whirl that grows most; above zero it grows by itself. Planar rotor "
            "with one layer, m_f/M = 0.1, h0/R = 0.1, damping ratio of the support "
            f"{_ZETA:g}, laminar friction in water. Linear theory, finite elements."
        )
        lay_out(figure, [[axes]], [2.75], _FRAME, text)
    return figure


def rows(lines: Sequence[Line]) -> list[str]:
    """Rows of a Markdown table."""
    out = [
        "| baffles | of the depth | largest growth, undamped | bands, undamped | bands, damped |",
        "|---|---|---|---|---|",
    ]
    for line in lines:
        free, damped = (_words(bands) for bands in (line.bands, line.damped))
        out.append(f"| {line.count} | {line.depth:.0%} | {line.growth:.4f} | {free} | {damped} |")
    return out


def _words(bands: Sequence[tuple[float, float]]) -> str:
    return ", ".join(f"{low:.4g} to {high:.4g}" for low, high in bands) or "none"


def main(arguments: Sequence[str] | None = None) -> int:
    """Draw the figure and print the table.

    Parameters
    ----------
    arguments : of the command line; None: the process's own
    """
    parser = argparse.ArgumentParser(prog="python -m validation.figures.liquid.baffles", description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("docs/images"), help="folder of the picture")
    parser.add_argument("--table", action="store_true", help="print the table as well")
    chosen = parser.parse_args(arguments)
    chosen.out.mkdir(parents=True, exist_ok=True)
    save(growth_figure(), chosen.out, "whirl_baffles", "Growth with baffles")
    if chosen.table:
        print("\n".join(rows(table())))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
