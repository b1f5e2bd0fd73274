"""What the best volumes cost to find: processor time of the search for one, two and three chambers.

`python -m validation.benchmarks.optimise` prints a table; times are of one core, with the front left out.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

from leblanc.scene.examples import example
from leblanc.scene.scene import Scene
from leblanc.scene.tasks import DutyPoint, Optimisation
from leblanc.studies.optimise.study import optimise_scene

SCENES = ("runup", "centrifuge", "washing_machine", "horizontal_rig", "vertical_rig")
OBJECTIVES = ("working_speed", "peak", "mean", "least_mass")


@dataclass(frozen=True)
class Cost:
    """One search."""

    scene: str  #: of the optimisation
    chambers: int
    objective: str
    seconds: float  #: of processor time
    judged: int  #: sets of volumes


def measured(name: str, objective: str) -> Cost:
    """Cost of one search; the mean is over four speeds, the peak is the steady one."""
    scene = example(name)
    task = Optimisation(objective=objective, steady=True, duty=_duty(scene), **_limit(scene, objective))
    begin = time.process_time()
    best = optimise_scene(scene, task=task, front=False, response=False)
    seconds = time.process_time() - begin
    return Cost(scene.name, len(scene.fills), objective, seconds, best.evaluations)


def _duty(scene: Scene) -> tuple[DutyPoint, ...]:
    """Mostly the last speed, and the way there."""
    speeds = scene.speeds
    return tuple(
        DutyPoint(speed=speeds.start + share * (speeds.stop - speeds.start), weight=weight)
        for share, weight in ((0.25, 0.1), (0.5, 0.2), (0.75, 0.2), (1.0, 0.5))
    )


def _limit(scene: Scene, objective: str) -> dict[str, float]:
    """Half of what the liquid can do, for the least mass."""
    if objective != "least_mass":
        return {}
    best = optimise_scene(scene.altered(optimise=None), task=Optimisation(), front=False)
    return {"vibration_limit": 0.5 * (best.value + best.baseline)}


def table() -> str:
    """All searches as a table in Markdown."""
    lines = ["| scene | chambers | objective | seconds | sets of volumes |", "|---|---:|---|---:|---:|"]
    for name in SCENES:
        for objective in OBJECTIVES:
            row = measured(name, objective)
            lines.append(
                f"| {row.scene} | {row.chambers} | {row.objective} | {row.seconds:.2f} | {row.judged} |"
            )
            print(lines[-1], flush=True)
    return "\n".join(lines)


def main() -> None:
    """Print the table."""
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1):
        measured("runup", "working_speed")  # imports and caches
        table()


if __name__ == "__main__":
    main()
