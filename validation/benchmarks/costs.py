"""What the law of the wall, the search for best volumes and a sweep cost, each on one core.

    python -m validation.benchmarks.costs --of wall      # time steps of a run-up beside those of Stokes' law
    python -m validation.benchmarks.costs --of optimise  # searches over one, two and three chambers
    python -m validation.benchmarks.costs --of sweep     # over the number of workers; --samples N

Processor time and largest memory of a sweep are those of a process of its own and of its workers.
"""

from __future__ import annotations

import json
import math
import multiprocessing
import resource
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Literal

from fluid.fill import Fill
from fluid.friction.laws import Friction, FrictionLaw
from fluid.liquid import Liquid
from leblanc.scene.examples import example, example_path
from leblanc.scene.schema.load import read_toml
from leblanc.scene.tasks import DutyPoint, Optimisation
from leblanc.studies.optimise.study import optimise_scene
from leblanc.studies.sweep.plan import Sweep, load_sweep
from leblanc.studies.sweep.study import run_sweep
from meshes.chamber import Chamber
from solvers.rotor.jeffcott import Jeffcott
from solvers.runup.long_wave import couple
from validation.study import launch

_FILL = Fill(Chamber(0.25, 0.04), Liquid("water", 1000.0, 1e-6), 8e-4)
_ROTOR = Jeffcott(3.0, 3.0 * 15.0**2, 4.0, 2e-3)
_RATE, _STOP, _CELLS, _WARM = 4.0, 2.0, 128, 0.01
SCENES = ("runup", "centrifuge", "washing_machine", "horizontal_rig", "vertical_rig")
OBJECTIVES = ("working_speed", "peak", "mean", "least_mass")
_DUTY = ((0.25, 0.1), (0.5, 0.2), (0.75, 0.2), (1.0, 0.5))  # share of the range of speeds, weight
_STUDY = """
scene = "scene.toml"
method = "sobol"
samples = {samples}
seed = 11
[vary]
"rotor.mass" = {{ uniform = ["3 kg", "12 kg"] }}
"rotor.unbalance" = {{ lognormal = ["0.6 kg*mm", 1.3] }}
"chambers.0.volume" = {{ uniform = ["2 ml", "200 ml"] }}
"""


def wall(repeats: int = 7) -> Iterator[str]:
    """Least time of a layer step of a run-up from 30 rad/s by law; laws take turns."""
    least = dict.fromkeys((FrictionLaw.STOKES, FrictionLaw.WALL), math.inf)
    for _ in range(repeats):
        for law in least:
            machine = couple(_ROTOR.system(), [_FILL], 30.0, Friction(law), 0.0, _CELLS, False)
            machine.state.rate[:] = 0.02, -0.01
            machine.advance(_WARM, _RATE, 0.8, 10**6)
            before, began = machine.sums.layer_steps, time.perf_counter()
            machine.advance(_STOP, _RATE, 0.8, 10**6)
            took = (time.perf_counter() - began) / (machine.sums.layer_steps - before)
            least[law] = min(least[law], took)
    for law, took in least.items():
        share = took / least[FrictionLaw.STOKES]
        yield f"{law:8} {1e6 * took:.2f} us a layer step, {share:.3f} of Stokes'"


def optimise() -> Iterator[str]:
    """Processor time of searches, without front; the mean is over four speeds, the peak the steady one."""
    search(SCENES[0], OBJECTIVES[0])  # imports and caches
    yield "| scene | chambers | objective | seconds | sets of volumes |"
    yield "|---|---:|---|---:|---:|"
    for name in SCENES:
        yield from (search(name, objective) for objective in OBJECTIVES)


def search(name: str, objective: str) -> str:
    """Row of one search; the least mass is asked for half of what the liquid can do."""
    scene, limit = example(name), {}
    low, high = scene.speeds.start, scene.speeds.stop
    duty = tuple(DutyPoint(speed=low + share * (high - low), weight=weight) for share, weight in _DUTY)
    if objective == "least_mass":
        best = optimise_scene(scene.altered(optimise=None), task=Optimisation(), front=False)
        limit = {"vibration_limit": 0.5 * (best.value + best.baseline)}
    task = Optimisation(objective=objective, steady=True, duty=duty, **limit)
    begin = time.process_time()
    best = optimise_scene(scene, task=task, front=False, response=False)
    seconds = time.process_time() - begin
    return f"| {scene.name} | {len(scene.fills)} | {objective} | {seconds:.2f} | {best.evaluations} |"


def one_speed_study(folder: Path, samples: int) -> Sweep:
    """Horizontal rig at one speed with the exact equilibrium of the liquid; three values vary."""
    table = read_toml(example_path("horizontal_rig"))
    table["speeds"] = {"start": "1500 rpm", "stop": "1500 rpm", "count": 1}
    table["model"]["liquid"] = "statics"
    lines = [f"{key} = {json.dumps(table[key])}" for key in ("name", "source")]
    lines += [f"{key}.{name} = {json.dumps(value)}" for key in ("rotor", "speeds", "model")
              for name, value in table[key].items()]  # fmt: skip
    for chamber in table["chambers"]:
        lines += ["[[chambers]]", *(f"{name} = {json.dumps(value)}" for name, value in chamber.items())]
    (folder / "scene.toml").write_text("\n".join(lines), encoding="utf-8")
    (folder / "study.toml").write_text(_STUDY.format(samples=samples), encoding="utf-8")
    return load_sweep(folder / "study.toml")


def sweep_cost(samples: int, workers: int) -> tuple[float, float, float, float]:
    """Seconds by the clock and of processors, largest memory of any process and of this one, bytes.

    With local worker processes (0: this one alone), their start and writing included.
    """
    with tempfile.TemporaryDirectory() as name:
        study = one_speed_study(Path(name), samples)
        begin, before = time.perf_counter(), time.process_time()
        run_sweep(study, Path(name) / "out", workers)
        seconds = time.perf_counter() - begin
    own, others = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    processor = time.process_time() - before + others.ru_utime + others.ru_stime
    return seconds, processor, 1024.0 * max(own.ru_maxrss, others.ru_maxrss), 1024.0 * own.ru_maxrss


def sweep(samples: int) -> Iterator[str]:
    """Table up to this number of samples."""
    yield "| samples | workers | s | processor s | us a sample | largest process, MB | first process, MB |"
    yield "|---|---|---|---|---|---|---|"
    for count, workers in ((samples // 10, 0), (samples, 0), (samples, 1), (samples, 2)):
        with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as alone:
            seconds, processor, most, own = alone.submit(sweep_cost, count, workers).result()
        each = f"{processor / count * 1e6:.0f} | {most / 1e6:.0f} | {own / 1e6:.0f}"
        yield f"| {count} | {workers} | {seconds:.1f} | {processor:.1f} | {each} |"


def main(of: Literal["wall", "optimise", "sweep"], samples: int = 100_000) -> Iterator[str]:
    """Cost of one of them; samples: of the largest sweep."""
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1):
        yield from sweep(samples) if of == "sweep" else wall() if of == "wall" else optimise()


if __name__ == "__main__":
    launch(main)
