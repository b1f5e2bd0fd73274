"""What a sweep costs: time over the number of workers, memory, the share that is not the answers themselves.

`python -m validation.benchmarks.sweep [--samples N]` prints a table.
"""

from __future__ import annotations

import os
import resource
import tempfile
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from leblanc.scene.examples import example_path
from leblanc.scene.schema.load import read_toml
from leblanc.studies.sweep.plan import Sweep, load_sweep
from leblanc.studies.sweep.study import run_sweep
from validation.study import launch

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


@dataclass(frozen=True)
class Cost:
    """Of one sweep."""

    workers: int  #: local processes; 0 for none but this
    samples: int  #: answered
    seconds: float  #: by the clock
    processor: float  #: seconds of all processes together
    memory: tuple[int, int]  #: largest of any process, and of this one, bytes


def one_speed_study(folder: Path, samples: int) -> Sweep:
    """Horizontal rig at one speed with the exact equilibrium of the liquid; three values vary."""
    import json

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


def cost(samples: int, workers: int) -> Cost:
    """Cost of the study with local worker processes (0: this one), their start and writing included."""
    with tempfile.TemporaryDirectory() as name:
        sweep = one_speed_study(Path(name), samples)
        most = _Watch()
        before, begin = _processor(), time.perf_counter()
        with most:
            run_sweep(sweep, Path(name) / "out", workers)
        seconds = time.perf_counter() - begin
    return Cost(workers, samples, seconds, _processor() - before, (most.any, most.own))


def _processor() -> float:
    """Seconds of processor time of this process and of those it waited for."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(usage.ru_utime + usage.ru_stime for usage in used)


class _Watch:
    """Largest resident memory of this process and of its children while the body runs."""

    def __init__(self) -> None:
        self.any = self.own = 0
        self._end = threading.Event()
        self._thread = threading.Thread(target=self._look, daemon=True)

    def __enter__(self) -> None:
        self._thread.start()

    def __exit__(self, *_: object) -> None:
        self._end.set()
        self._thread.join()

    def _look(self) -> None:
        while not self._end.wait(0.1):
            self.own = max(self.own, _resident(os.getpid()))
            self.any = max(self.any, self.own, *map(_resident, _children(os.getpid())))


def _resident(process: int) -> int:
    """Resident memory, bytes; 0 if it has ended."""
    try:
        pages = Path(f"/proc/{process}/statm").read_text(encoding="ascii").split()[1]
    except (OSError, IndexError):
        return 0
    return int(pages) * os.sysconf("SC_PAGE_SIZE")


def _children(process: int) -> list[int]:
    found = []
    for listed in Path(f"/proc/{process}/task").glob("*/children"):
        try:
            found += [int(child) for child in listed.read_text(encoding="ascii").split()]
        except OSError:  # a thread that has ended
            continue
    return found


def main(samples: int = 100_000) -> Iterator[str]:
    """Table up to this number of samples."""
    yield "| samples | workers | s | processor s | us a sample | largest process, MB | first process, MB |"
    yield "|---|---|---|---|---|---|---|"
    for count, workers in ((samples // 10, 0), (samples, 0), (samples, 1), (samples, 2)):
        found = cost(count, workers)
        any_, own = (size / 1e6 for size in found.memory)
        each = found.processor / count * 1e6
        yield (f"| {count} | {workers} | {found.seconds:.1f} | {found.processor:.1f} | {each:.0f} "
               f"| {any_:.0f} | {own:.0f} |")  # fmt: skip


if __name__ == "__main__":
    launch(main)
