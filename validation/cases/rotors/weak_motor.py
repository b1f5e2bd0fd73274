"""A motor that hangs at the resonance without liquid and gets through with it: the example `weak_motor`.

`python -m validation.cases.rotors.weak_motor --out docs/images` draws the figure of docs/runup.md.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from leblanc.core.units import MM, RPM
from leblanc.scene.examples import example
from leblanc.scene.scene import Scene
from leblanc.studies.runup import runup_scene
from solvers.runup.runup import RunupHistory


def with_and_without(scene: Scene, check: bool = False) -> tuple[RunupHistory, RunupHistory]:
    """Run-up of the machine as it stands, and with its chambers empty; check: estimate the error."""
    empty = scene.altered(chambers=tuple(chamber.holding(0.0) for chamber in scene.liquids))
    wet, dry = (runup_scene(machine, check=check).history for machine in (scene, empty))
    return wet, dry


def draw(wet: RunupHistory, dry: RunupHistory, scene: Scene, directory: Path) -> Path:
    """Speed and amplitude over time as PNG and SVG."""
    from leblanc.figures.drawing.page import Figure, Frame, lay_out, number, save, style

    looks: list[tuple[RunupHistory, dict[str, Any]]] = [
        (wet, {"color": "#0072B2", "linewidth": 1.8, "label": "with liquid"}),
        (dry, {"color": "#D55E00", "linestyle": (0, (5, 1.5)), "label": "without liquid"}),
    ]
    with style():
        figure = Figure()
        upper: Any = figure.add_axes((0, 0, 1, 1), label="speed")
        lower: Any = figure.add_axes((0, 0, 1, 1), label="amplitude")
        for history, look in looks:
            upper.plot(history.time, history.speed * RPM, **look)
            lower.plot(history.time, history.amplitude * MM, **(look | {"linewidth": 1.0, "label": "_"}))
        upper.set_ylabel("Speed (rpm)")
        upper.tick_params(labelbottom=False)
        lower.set_ylabel("Amplitude (mm)")
        lower.set_xlabel("Time (s)")
        for axes in (upper, lower):
            axes.set_xlim(0.0, float(wet.time[-1]))
            axes.set_ylim(bottom=0.0)
            axes.xaxis.set_major_formatter(number)
        motor = scene.runup.motor if scene.runup is not None else None
        torque = f"Torque {motor.torques[0]:g} N m at rest, falling on a straight line; " if motor else ""
        fill = scene.fills[0]
        text = (
            f"Scene: {scene.name}. {torque}{fill.volume * 1e3:g} l of {fill.liquid.name}. Annular long waves "
            "in time, linear wall friction. Every value is assumed."
        )
        lay_out(figure, [[upper], [lower]], [1.6, 1.6], Frame(0.72, 0.12, 0.12, 0.42), text)
    return save(figure, directory, "runup_weak_motor", "A weak motor at the resonance").png


def main(arguments: list[str] | None = None) -> int:
    """Run both and draw.

    Parameters
    ----------
    arguments : of the command line; None: the process's own
    """
    parser = argparse.ArgumentParser(prog="python -m validation.cases.rotors.weak_motor", description=__doc__)
    parser.add_argument("--out", type=Path, required=True, help="folder of the figure")
    chosen = parser.parse_args(arguments)
    scene = example("weak_motor")
    wet, dry = with_and_without(scene)
    draw(wet, dry, scene, chosen.out)
    for name, history in (("with liquid", wet), ("without", dry)):
        print(f"{name}: {history.speed[-1]:.2f} rad/s, {history.amplitude[-1] * MM:.2f} mm at the end")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
