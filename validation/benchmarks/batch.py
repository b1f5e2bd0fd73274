"""`python -m validation.benchmarks.batch`: run-ups a minute, all different, over cells and threads.

The machine of examples/runup.toml with its unbalance, volume and friction drawn anew for each run. Each takes
all its samples in one compiled call, which lets other threads run; no answer depends on its companions.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np

from fluid.friction.laws import Friction, FrictionLaw
from leblanc.scene.examples import example
from leblanc.studies.drives import drive_of, rotor_in_time
from solvers.runup.ensemble import EnsembleTask, run_member
from solvers.runup.long_wave import couple
from solvers.runup.runup import RunupNumerics
from validation.study import launch

_CELLS, _THREADS = (32, 64, 128), (1, 2)


def tasks(count: int, cells: int, seed: int = 1) -> list[EnsembleTask]:
    """Run-ups of one machine whose numbers depend on seed and run alone."""
    scene = example("runup")
    assert scene.runup is not None
    system, drive = rotor_in_time(scene), drive_of(scene.runup, scene.rotor)
    found = []
    for k in range(count):
        draw = np.random.default_rng([seed, k])
        fills = tuple(
            replace(fill, volume=fill.volume * float(draw.uniform(0.6, 1.4))) for fill in scene.fills
        )
        moved = replace(system, unbalance=system.unbalance * draw.uniform(0.5, 1.5))
        friction = Friction(FrictionLaw.LINEAR, float(draw.uniform(0.3, 1.0)))
        numerics = RunupNumerics(cells=cells, companion=False)
        found.append(EnsembleTask(moved, fills, drive, friction, 0.0, numerics, couple))
    return found


def main(runs: int = 24) -> Iterator[str]:
    """Run-ups a minute of so many runs, after one to warm up; and whether threads change any digit."""
    for cells in _CELLS:
        some, peaks = tasks(runs, cells), []
        run_member(some[0])
        for threads in _THREADS:
            begin, used = time.perf_counter(), time.process_time()
            with ThreadPoolExecutor(threads) as pool:
                members = list(pool.map(run_member, some))
            lasted, used = time.perf_counter() - begin, time.process_time() - used
            peaks.append([float(member.largest.max()) for member in members])
            yield (
                f"{cells} cells, {threads} threads: {60.0 * runs / lasted:6.0f} run-ups a minute, "
                f"{used / runs:.3f} s of processor time each"
            )
        yield f"{cells} cells: the same digits with any number of threads: {peaks[0] == peaks[1]}"


if __name__ == "__main__":
    launch(main)
