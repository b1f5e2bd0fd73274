"""`python -m validation.benchmarks.compiling`: what the first use of a command compiles, by function.

A process of its own with an empty cache runs the command; numba says when it begins and ends a function. Its
processor time is its own, without the functions that are compiled on its way. With `--beside FOLDER` another
checkout of this package runs the same next to it.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Literal

from leblanc.scene.examples import example_path
from validation.study import launch, write

ROOT = Path(__file__).resolve().parents[2]
COMMANDS = {
    "runup": ("runup", str(example_path("runup"))),
    "programme": ("runup", str(example_path("programme"))),
    "front_loader": ("runup", str(example_path("front_loader")), "--cells", "32", "--no-check"),
    "layer": (
        *("layer", "--model", "long_wave", "--radius", "0.25 m", "--height", "0.05 m", "--volume", "0.9 l"),
        *("--speed", "400 rpm", "--whirl-speed", "300 rpm", "--whirl-amplitude", "1 mm"),
    ),
}
CHILD = """
import json, sys, time
from numba.core import event

spent, open_ = {}, []

class Heard(event.Listener):
    def on_start(self, it):
        function = it.data["dispatcher"].py_func
        open_.append([f"{function.__module__}:{function.__qualname__}", time.process_time(), 0.0])

    def on_end(self, it):
        name, begin, inner = open_.pop()
        lasted = time.process_time() - begin
        spent[name] = spent.get(name, 0.0) + lasted - inner
        if open_:
            open_[-1][2] += lasted

event.register("numba:compile", Heard())
from leblanc.cli import main
sys.argv = ["leblanc", *json.loads(sys.argv[1])]
try:
    code = main()
except SystemExit as ended:
    code = ended.code
print()
print(json.dumps([code, spent, time.process_time()]))
"""


def main(
    of: Literal["runup", "programme", "front_loader", "layer"] = "runup",
    beside: Path | None = None,
    most: int = 25,
    repeats: int = 1,
    json: Path | None = None,
) -> Iterator[str]:
    """The functions that cost most, and all of them together; least times of some repeats in turns."""
    trees = [ROOT, *([] if beside is None else [beside.resolve()])]
    turns = [[_compiled(tree, COMMANDS[of]) for tree in trees] for _ in range(repeats)]
    found = [_least(runs) for runs in zip(*turns, strict=True)]
    for (spent, whole), tree in zip(found, ("here", "beside"), strict=False):
        total = sum(spent.values())
        yield f"{of}, {tree}: {total:.1f} s of {whole:.1f} s for {len(spent)} functions"
        for name, seconds in sorted(spent.items(), key=lambda one: -one[1])[:most]:
            yield f"  {seconds:7.2f} s  {name}"
    if len(found) == 2:
        ratio = sum(found[0][0].values()) / sum(found[1][0].values())
        yield f"{of}: {ratio:.2f} of the time of the other checkout"
    if json is not None:
        write(json, [{"spent": spent, "whole": whole} for spent, whole in found])


def _least(runs: Sequence[tuple[dict[str, float], float]]) -> tuple[dict[str, float], float]:
    """Least time of each function over some runs, and of the command."""
    spent = {name: min(each[name] for each, _ in runs) for name in runs[0][0]}
    return spent, min(whole for _, whole in runs)


def _compiled(tree: Path, command: tuple[str, ...]) -> tuple[dict[str, float], float]:
    """Processor time of each function, and of the command with all, s."""
    threads = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")
    with tempfile.TemporaryDirectory() as folder:
        own = {"PYTHONPATH": str(tree), "NUMBA_CACHE_DIR": f"{folder}/cache", "MPLBACKEND": "Agg"}
        line = [*command, *(() if command[0] == "layer" else ("--out", f"{folder}/out"))]
        told = subprocess.run(
            [sys.executable, "-c", CHILD, json.dumps(line)],
            cwd=tree,
            env=os.environ | threads | own,
            capture_output=True,
            text=True,
            check=True,
        ).stdout
    answer: list[Any] = json.loads(told.splitlines()[-1])
    if answer[0]:
        raise RuntimeError(f"leblanc {' '.join(line)} ended with {answer[0]}")
    return answer[1], float(answer[2])


if __name__ == "__main__":
    launch(main)
