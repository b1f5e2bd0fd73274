"""What volume and friction do to a run-up: peak and end amplitude of one upright machine.

`python -m validation.figures.rotors.runup_trends --out docs/images` draws its figure and tables of
docs/runup.md.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from leblanc.core.units import LITRE, MM, RPM
from validation.cases.rotors.runup import GIVEN, Point, band, best_volume, run, steady_end, sweep

_LOOKS: tuple[tuple[str, str, Any], ...] = (
    ("#0072B2", "o", "-"),
    ("#D55E00", "s", (0, (5, 1.5))),
    ("#009E73", "^", (0, (1, 1.2))),
    ("#CC79A7", "D", (0, (5, 1.2, 1, 1.2))),
)


def comparison() -> str:
    """The figures given beside those computed, as a table in Markdown."""
    lines = [
        "| water | k, 1/s | peak, mm: given | here | at rad/s: given | here | end, mm: given | here "
        "| error estimate | energy left |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for volume, rate, peak, speed, end in GIVEN:
        found = run(volume, rate, check=volume > 0.0)
        error = "" if math.isnan(found.error) else f"{found.error:.1%}"
        lines.append(
            f"| {volume * LITRE:g} l | {rate:g} | {peak} | {found.peak * MM:.2f} | {speed} "
            f"| {found.peak_speed:.2f} | {end} | {found.last * MM:.3f} | {error} | {found.closure:.0e} |"
        )
    return "\n".join(lines)


def table(points: Sequence[Point]) -> str:
    """Peak and end over volume and friction, as a table in Markdown."""
    rates = list(dict.fromkeys(point.friction for point in points))
    head = " | ".join(f"k = {rate:g}" for rate in rates)
    lines = [f"| water, l | {head} |", "|---|" + "---|" * len(rates)]
    for volume in dict.fromkeys(point.volume for point in points):
        row = [point for point in points if point.volume == volume]
        cells = " | ".join(
            f"{found.peak * MM:.2f} at {found.peak_speed:.1f}; {found.end * MM:.2f}"
            + ("" if found.converged else " (stopped)")
            for found in row
        )
        lines.append(f"| {volume * LITRE:.3g} | {cells} |")
    return "\n".join(lines)


def draw(points: Sequence[Point], dry: Point, directory: Path) -> Path:
    """Trends as PNG and SVG, with the run-up without liquid."""
    from leblanc.figures.drawing.page import Figure, Frame, lay_out, number, save, style

    volumes = list(dict.fromkeys(point.volume for point in points))
    litres = np.array(volumes) * LITRE
    with style():
        figure = Figure()
        panels: list[Any] = [figure.add_axes((0, 0, 1, 1), label=name) for name in "abc"]
        _lines(panels, points)
        panels[0].axhline(dry.peak * MM, **_DRY)
        panels[1].axhline(dry.peak_speed * RPM, **_DRY)
        panels[2].axhline(dry.end * MM, **_DRY)
        panels[2].plot(litres, steady_end(volumes) * MM, color="0.45", linewidth=2.6, alpha=0.6, zorder=1)
        panels[2].plot([], [], color="0.45", linewidth=2.6, alpha=0.6, label="steady response")
        _whirl(panels[1], volumes, points[0].friction)
        least = best_volume(float(steady_end(volumes)[-1])) * LITRE
        dashes = {"color": "0.15", "linewidth": 1.0, "linestyle": (0, (7, 3))}
        for axes in panels:
            axes.axvline(least, **dashes, label=f"{least:.2f} l cover the wall at the final speed")
            axes.set_xscale("log")
            axes.set_xlim(0.92 * litres[0], 1.08 * litres[-1])
            axes.set_xticks([0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 3.0])
            axes.minorticks_off()
            axes.xaxis.set_major_formatter(number)
            axes.yaxis.set_major_formatter(number)
            axes.tick_params(labelbottom=axes is panels[-1])
        for axes, name in zip(panels, ("Peak (mm)", "Speed there (rpm)", "End (mm)"), strict=True):
            axes.set_ylabel(name)
        panels[-1].set_xlabel("Water (l)")
        frame = Frame(left=0.72, top=0.12, between=0.12, below=0.42)
        lay_out(figure, [[axes] for axes in panels], [1.7, 1.4, 1.4], frame, _CAPTION, 8)
    return save(figure, directory, "runup_trends", "Run-up over volume and friction").png


_DRY: dict[str, Any] = {"color": "0.3", "linewidth": 1.0, "linestyle": (0, (1, 1.5)), "label": "no liquid"}
_CAPTION = (
    "Upright Jeffcott rotor, 30 kg, 25 rad/s, damping ratio 0.06, unbalance 0.1 kg m, one chamber of 250 mm "
    "radius and 40 mm height with water, run up from 5 to 100 rad/s at 8 rad/s\N{SUPERSCRIPT TWO} and held, "
    "14 s in all. Above: largest amplitude and the speed at which it occurs; below: mean amplitude over the "
    "last second. Annular long waves in time, 128 cells, linear wall friction of rate k. Shaded: speeds at "
    "which some whirl grows by itself by linear theory with the smallest friction."
)


def _lines(panels: Sequence[Any], points: Sequence[Point]) -> None:
    """One line for each friction in each panel."""
    for (color, mark, dashes), rate in zip(
        _LOOKS, dict.fromkeys(point.friction for point in points), strict=False
    ):
        mine = [point for point in points if point.friction == rate and point.converged]
        x = np.array([point.volume for point in mine]) * LITRE
        look: dict[str, Any] = {"color": color, "marker": mark, "linestyle": dashes, "linewidth": 1.2}
        look |= {"markersize": 3.5, "markerfacecolor": "white", "label": f"k = {rate:g} 1/s"}
        for axes, values in (
            (panels[0], [point.peak * MM for point in mine]),
            (panels[1], [point.peak_speed * RPM for point in mine]),
            (panels[2], [point.end * MM for point in mine]),
        ):
            axes.plot(x, values, **look)


def _whirl(axes: Any, volumes: Sequence[float], friction: float) -> None:
    """Speeds of self-excited whirl over volume, shaded."""
    x = np.geomspace(volumes[0], volumes[-1], 60)
    low, high = band(x.tolist(), friction)
    look = {"facecolor": "#F0E442", "alpha": 0.35, "hatch": "///", "edgecolor": "0.55", "linewidth": 0.0}
    axes.fill_between(x * LITRE, low * RPM, high * RPM, **look, label="self-excited whirl", zorder=0.5)


def main(arguments: list[str] | None = None) -> int:
    """Run the study.

    Parameters
    ----------
    arguments : of the command line; None: the process's own

    Returns
    -------
    Exit code
    """
    parser = argparse.ArgumentParser(
        prog="python -m validation.figures.rotors.runup_trends", description=__doc__
    )
    parser.add_argument("--out", type=Path, required=True, help="folder of the figure")
    parser.add_argument("--workers", type=int, default=2, help="processes [default: 2]")
    chosen = parser.parse_args(arguments)
    points = sweep(workers=chosen.workers)
    draw(points, run(0.0, 0.0), chosen.out)
    print(comparison(), "", table(points), sep="\n")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
