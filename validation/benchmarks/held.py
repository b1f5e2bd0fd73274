"""What motions integrated in time take beside what is foretold: `python -m validation.benchmarks.held`.

The motions that `held = "auto"` asks for on the shipped scenes, in one process; all of them with `--liquid`.
From them come the numbers of `solvers.held.cost`. With `--beside FOLDER` in turns with another checkout of
this package there: the ratio of the processor times.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from validation.study import launch

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(variable, "1")

import numpy as np  # noqa: E402

from leblanc.liquid.choose import choose_all, costed, held_at, liquid_models, prepare  # noqa: E402
from leblanc.scene.examples import example  # noqa: E402
from leblanc.studies.held.held import held_machine, hold_speeds  # noqa: E402
from leblanc.studies.held.holding import HERE  # noqa: E402
from meshes.arrays import Array  # noqa: E402
from solvers.held.integrate import compile_kernels, start  # noqa: E402
from solvers.held.state import HoldNumerics  # noqa: E402
from solvers.synchronous.response import response  # noqa: E402
from solvers.whirl.growth import asynchronous_growth  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
SCENES = ("horizontal_rig", "washing_machine", "tub", "two_plane_rig", "runup", "vertical_rig")


@dataclass(frozen=True)
class Cost:
    """Processor time of the motions of a scene, s."""

    scene: str  #: its name
    foretold: Array  #: by each speed on its own, shape (n,)
    taken: Array
    carried: float  #: by motions carried from speed to speed, which nothing foretells

    @property
    def line(self) -> str:
        """A row of the table."""
        ratio = self.foretold / self.taken
        low, middle, high = np.percentile(ratio, (5, 50, 95))
        within = np.mean((ratio > 0.5) & (ratio < 2.0))
        return (
            f"{self.scene:18}{ratio.size:6d}{self.foretold.sum():10.3g}{self.taken.sum():9.3g}"
            f"{self.carried:9.3g}{low:7.2f}{middle:6.2f}{high:6.2f}{within:8.0%}"
        )


def cost(name: str, stride: int = 1, cells: int | None = None, liquid: str | None = None) -> Cost:
    """Compute the time-domain states that `auto` would compute on a scene.

    Of every `stride`-th speed; `cells` and `liquid` ("potential": nonlinear waves, "kdv": those of
    KdV-Burgers) are the scene's if None.
    """
    scene = example(name)
    given = {"cells": cells, "liquid": liquid}
    changes = {"held": "auto"} | {key: value for key, value in given.items() if value is not None}
    machine = prepare(scene.altered(model=scene.model.altered(**changes)))
    growth = asynchronous_growth(machine.rotor, scene.fills, machine.speed, machine.friction)[0]
    choice = costed(machine, choose_all([machine])[0], growth)
    at = np.flatnonzero(held_at(machine.scene, choice, growth))[::stride]
    gravity = machine.axial_gravity
    steady = response(machine.rotor, scene.fills, machine.speed, gravity, liquid_models(choice)).at(at)
    held, numerics = held_machine(machine), HoldNumerics(cells=machine.scene.model.cells)
    compile_kernels(held, start(held, float(steady.speed[0]), numerics))
    marks = [time.process_time()]
    hold_speeds(machine, steady, growth[at], HERE, lambda _: marks.append(time.process_time()))
    taken = np.diff(marks)
    assert choice.holding is not None
    return Cost(name, choice.holding[at], taken[: at.size], float(taken[at.size :].sum()))


def main(
    *scenes: str,
    stride: int = 1,
    cells: int | None = None,
    liquid: Literal["long_wave", "potential", "kdv"] | None = None,
    beside: Path | None = None,
    repeats: int = 1,
) -> Iterator[str]:
    """Table of shipped scenes; parameters as for `cost`. `beside`: another checkout, in turns."""
    if beside is not None:
        given = stride, cells, liquid
        for name in scenes or SCENES:
            rounds = [[_elsewhere(tree, name, *given) for tree in (ROOT, beside)] for _ in range(repeats)]
            ours, other = (statistics.median(each) for each in zip(*rounds, strict=True))
            share = statistics.median(here / there for here, there in rounds)
            yield f"{name:18}{ours:9.4g} s, beside {other:9.4g} s of processor time: {share:.2f} of it"
        return
    yield "foretold and taken, s; each speed's ratio of them: 5 and 50 and 95 in 100; within half and twice"
    yield f"{'scene':18}{'speeds':>6}{'foretold':>10}{'taken':>9}{'carried':>9}{'ratio':>7}"
    for name in scenes or SCENES:
        yield cost(name, stride, cells, liquid).line


CHILD = """
import json, sys
from validation.benchmarks.held import cost
found = cost(*json.loads(sys.argv[1]))
print(found.taken.sum() + found.carried)
"""


def _elsewhere(folder: Path, *given: str | int | None) -> float:
    """Processor time of the motions of a scene by the package of a checkout, in a process of its own, s."""
    tree = str(folder.resolve())
    command = [sys.executable, "-c", CHILD, json.dumps(given)]
    ended = subprocess.run(
        command,
        cwd=tree,
        env=os.environ | {"PYTHONPATH": tree},
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    return float(ended.stdout.split()[-1])


if __name__ == "__main__":
    launch(main)
