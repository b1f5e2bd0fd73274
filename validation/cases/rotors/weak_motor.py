"""A motor that hangs at the resonance without liquid and gets through with it: the example `weak_motor`.

`python -m validation.cases.rotors.weak_motor --out docs/images` draws the figure of docs/howto/runup.md.
"""

from __future__ import annotations

from typing import Any

from leblanc.core.units import MM, RPM
from leblanc.scene.examples import example
from leblanc.scene.scene import Scene
from leblanc.studies.runup.study import runup_scene
from solvers.runup.runup import RunupHistory
from validation.page import Figure, page
from validation.study import launch, shown


def with_and_without(scene: Scene) -> tuple[RunupHistory, RunupHistory]:
    """Run-up of the machine as it stands, and with its chambers empty."""
    empty = scene.altered(chambers=tuple(chamber.holding(0.0) for chamber in scene.liquids))
    wet, dry = (runup_scene(machine, check=False).history for machine in (scene, empty))
    return wet, dry


def motor_figure() -> Figure:
    """A weak motor at the resonance: speed and amplitude over time."""
    scene = example("weak_motor")
    wet, dry = with_and_without(scene)
    motor = scene.runup.motor if scene.runup is not None else None
    torque = f"Torque {motor.torques[0]:g} N m at rest, falling on a straight line; " if motor else ""
    fill = scene.fills[0]
    looks: list[tuple[RunupHistory, dict[str, Any]]] = [
        (wet, {"color": "#0072B2", "linewidth": 1.8, "label": "with liquid"}),
        (dry, {"color": "#D55E00", "linestyle": (0, (5, 1.5)), "label": "without liquid"}),
    ]
    text = (
        f"Scene: {scene.name}. {torque}{fill.volume * 1e3:g} l of {fill.liquid.name}. Annular long waves "
        "in time, linear wall friction. Every value is assumed."
    )
    with page([1.6, 1.6], text, top=0.12) as (figure, [[upper], [lower]]):
        for history, look in looks:
            upper.plot(history.time, history.speed * RPM, **look)
            lower.plot(history.time, history.amplitude * MM, **(look | {"linewidth": 1.0, "label": "_"}))
        upper.set_ylabel("Speed (rpm)")
        upper.tick_params(labelbottom=False)
        lower.set(ylabel="Amplitude (mm)", xlabel="Time (s)")
        for axes in (upper, lower):
            axes.set_xlim(0.0, float(wet.time[-1]))
            axes.set_ylim(bottom=0.0)
    figure.alt = " ".join(
        f"At the end {look['label']} {history.speed[-1]:.2f} rad/s, {history.amplitude[-1] * MM:.2f} mm."
        for history, look in looks
    )
    return figure


if __name__ == "__main__":
    launch(shown(runup_weak_motor=motor_figure))
