"""`python -m validation.benchmarks.batch`: run-ups a minute, all different, over cells and threads.

The machine of examples/runup.toml with its unbalance, volume and friction drawn anew for each run. Each takes
all its samples in one compiled call, which lets other threads run; no answer depends on its companions.
`--arrays`: as one array program by jax (extra `gpu`) over cells and lanes, beside the compiled steps.
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
from solvers.runup.machine import Ramp
from solvers.runup.runup import RunupNumerics
from validation.study import launch

_CELLS, _THREADS = (32, 64, 128), (1, 2)
_LANES, _FEW = (32, 64), 4


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


def beside_arrays(cells: int, lanes: int) -> str:
    """Run-ups by an array program that fills its lanes once, and the first few by the compiled steps."""
    from solvers.runup.arrays import runups

    some = tasks(lanes, cells)
    few, brief = some[:_FEW], replace(some[0], drive=Ramp(5.0, 100.0, 8.0, 1e-3))
    run_member(few[0])
    runups([brief], lanes)  # compiles
    begin, used = time.perf_counter(), time.process_time()
    runs = runups(some, lanes)
    lasted, used = time.perf_counter() - begin, (time.process_time() - used) / lanes
    alone = time.process_time()
    members = [run_member(task) for task in few]
    alone = (time.process_time() - alone) / len(few)
    apart = max(
        abs(run.largest.max() / member.largest.max() - 1.0)
        for run, member in zip(runs, members, strict=False)
    )
    rounds = [run.rounds for run in runs]
    busy = np.mean(rounds) / max(rounds)
    return (
        f"{cells} cells, {lanes} lanes: {60.0 * lanes / lasted:6.0f} run-ups a minute, {used:.3f} s of "
        f"processor time each, {used / alone:.2f} times that of the compiled steps; peaks apart by "
        f"{apart:.0e}; lanes at work {busy:.1%} of the time"
    )


def main(runs: int = 24, arrays: bool = False) -> Iterator[str]:
    """Run-ups a minute of so many runs, after one to warm up; and whether threads change any digit."""
    if arrays:
        yield from (beside_arrays(cells, lanes) for cells in _CELLS for lanes in _LANES)
        return
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
