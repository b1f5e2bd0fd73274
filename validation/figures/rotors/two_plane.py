"""Figure of balancing in two planes in time: `python -m validation.figures.rotors.two_plane`."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np

from leblanc.core.units import MM
from leblanc.figures.drawing.page import Figure, Frame, lay_out, number, save, style
from solvers.rotor.balls.balancers import simulate
from solvers.rotor.balls.two_plane_balance import dynamic_balancing, of_two_planes
from solvers.rotor.two_plane import TwoPlane
from validation.cases.two_plane.machine import BALLS, LONG, RACES, SCATTERED, SHORT, bare_deflection

_FRAME = Frame(left=0.74, top=0.3, between=0.42, below=0.45)
_SPEEDS = (30.0, 120.0)
_GAP = 0.25  # inches between the columns


def balls_figure(directory: Path, duration: float = 12.0) -> Path:
    """Deflection at both supports of a long and a short rotor, below and above the resonances."""
    with style():
        figure = Figure()
        rows = []
        for name, rotor in (("long", LONG), ("short", SHORT)):
            row: list[Any] = []
            for speed in _SPEEDS:
                axes: Any = figure.add_axes((0, 0, 1, 1), label=f"{name} {speed}")
                _draw(axes, name, rotor, speed, duration)
                axes.tick_params(labelbottom=name == "short", labelleft=speed == _SPEEDS[0])
                row.append(axes)
            row[0].set_ylabel("Deflection (mm)")
            rows.append(row)
        for axes in rows[-1]:
            axes.set_xlabel("Time (s)")
        text = (
            "Deflection of the axis at its two supports after a start at full speed, with two ball "
            "balancers of two balls each in two planes; balls of 15 g on a radius of 80 mm, rotor of 10 kg "
            "with a static and a couple unbalance. Made-up machine; no gravity."
        )
        lay_out(figure, rows, [1.6, 1.6], _FRAME, text)
        for row in rows:
            for axes in row:
                box = axes.get_position()
                shift = _GAP / 6.3 if axes is row[1] else 0.0
                axes.set_position((box.x0 + shift, box.y0, box.width - _GAP / 6.3, box.height))
    return save(figure, directory, "two_plane_balls", "Two ball balancers in time").png


def _draw(axes: Any, name: str, rotor: TwoPlane, speed: float, duration: float) -> None:
    """One rotor at one speed."""
    system = rotor.system()
    run = simulate(system, RACES, speed, duration, places=SCATTERED, samples=800)
    for k, (support, dashes) in enumerate(zip(rotor.supports, ("-", "--"), strict=True)):
        size = np.abs(run.deflection(system, support.position)) * MM
        axes.plot(
            run.time,
            np.maximum(size, 1e-5),
            color=f"C{k}",
            linestyle=dashes,
            linewidth=1.0,
            label=f"support {k + 1}",
        )
    bare = max(bare_deflection(rotor, support.position, speed) for support in rotor.supports) * MM
    look = {
        "color": "0.25",
        "linestyle": ":",
        "linewidth": 1.2,
        "label": "the larger of both without balancers",
    }
    axes.axhline(bare, **look)
    said = bool(dynamic_balancing(of_two_planes(rotor, BALLS), speed).possible[0])
    verdict = "conditions: yes" if said else "conditions: no"
    axes.set_title(f"{name} rotor, {speed:.0f} rad/s; {verdict}")
    axes.set_yscale("log")
    axes.set_ylim(1e-4, 10.0)
    axes.set_yticks([1e-4, 1e-3, 1e-2, 1e-1, 1.0, 10.0])
    axes.yaxis.set_major_formatter(number)
    axes.yaxis.set_minor_formatter("")
    axes.set_xlim(0.0, duration)


def main() -> None:
    """Draw the figure."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("docs/images"))
    path = balls_figure(parser.parse_args().out)
    path.with_suffix(".svg").unlink()
    print(path)


if __name__ == "__main__":
    main()
