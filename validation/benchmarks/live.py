"""`python -m validation.benchmarks.live`: answers of one scene whose numbers change, as a slider drives them.

Processor time of `lb.run` and `lb.explain` in a process that has answered before, without files: what a page
reads of the answer is read. With `--beside FOLDER` in turns with another checkout of this package there.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from validation.study import launch, write

ROOT = Path(__file__).resolve().parents[2]
SCENES = {"planar rotor": "horizontal_rig", "tub": "tub", "two planes": "two_plane_rig"}
QUESTIONS = ("run", "explain")
# One call a line of its standard input: question, example, and how often it was called before.
CHILD = """
import json, sys, time
import leblanc as lb
import numpy as np

FIELDS = {
    "horizontal_rig": ("chambers.0.volume", "rotor.unbalance", "speeds.stop"),
    "tub": ("chambers.0.volume", "rotor.unbalance", "speeds.stop"),
    "two_plane_rig": ("chambers.0.volume", "rotor.unbalances.0.size", "speeds.stop"),
}
READ = {
    "run": ("peak", "stable", "whirl_bands"),
    "explain": ("critical_speed_dry", "critical_speed_wet", "captured_from", "layers"),
    "explain, all": ("critical_speed_dry", "layers", "models", "whirl", "cures", "held", "wall_volumes"),
}
unit = np.random.default_rng(0).normal(size=(120, 120))

def value(scene, path):
    for key in path.split("."):
        scene = scene[int(key)] if key.isdigit() else getattr(scene, key)
    return scene

for line in sys.stdin:
    question, name, call = json.loads(line)
    base = lb.example(name)
    path = FIELDS[name][call % 3]
    begin = time.process_time()
    scene = base.replace({path: (1.0 + 1e-4 * (call + 1)) * value(base, path)})
    answer = getattr(lb, question.partition(",")[0])(scene)
    for what in READ[question]:
        getattr(answer, what)
    called = time.process_time()
    np.linalg.eigvals(unit)
    print(json.dumps([called - begin, time.process_time() - called]), flush=True)
"""


class _Tree:
    """A process that answers with the package of one checkout."""

    def __init__(self, folder: Path) -> None:
        threads = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")
        self._process = subprocess.Popen(
            [sys.executable, "-c", CHILD],
            cwd=folder,
            env=os.environ | threads | {"PYTHONPATH": str(folder), "MPLBACKEND": "Agg"},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def seconds(self, question: str, scene: str, call: int) -> tuple[float, float]:
        """Processor time of a call, and of the eigenvalues of a matrix of 120 rows, s."""
        assert self._process.stdin is not None and self._process.stdout is not None
        self._process.stdin.write(json.dumps([question, scene, call]) + "\n")
        self._process.stdin.flush()
        answer, unit = json.loads(self._process.stdout.readline())
        return float(answer), float(unit)

    def close(self) -> None:
        """End it."""
        self._process.communicate()


def main(calls: int = 200, beside: Path | None = None, json: Path | None = None) -> Iterator[str]:
    """Median and 95 % of so many calls each, over eigenvalues of a matrix and over another checkout."""
    trees = [_Tree(ROOT), *([] if beside is None else [_Tree(beside.resolve())])]
    rows: list[dict[str, Any]] = []
    for title, scene in SCENES.items():
        for question in (*QUESTIONS, "explain, all"):
            found: list[list[tuple[float, float]]] = [[] for _ in trees]
            for call in range(-3, calls):  # the first three warm up
                for tree, times in zip(trees, found, strict=True):
                    seconds = tree.seconds(question, scene, call)
                    if call >= 0:
                        times.append(seconds)
            rows.append(_row(title, question, found))
            yield _line(rows[-1])
    for tree in trees:
        tree.close()
    if json is not None:
        write(json, {"calls": calls, "rows": rows})


def _row(title: str, question: str, found: list[list[tuple[float, float]]]) -> dict[str, Any]:
    answers = [[answer for answer, _ in times] for times in found]
    middle = [statistics.median(times) for times in answers]
    late = [statistics.quantiles(times, n=20)[-1] if len(times) > 1 else times[0] for times in answers]
    unit = statistics.median(unit for _, unit in found[0])
    other = {} if len(found) == 1 else {"median_beside": middle[1], "late_beside": late[1]}
    return {"scene": title, "question": question, "median": middle[0], "late": late[0], "unit": unit} | other


def _line(row: dict[str, Any]) -> str:
    text = f"{row['scene']:13}{row['question']:14}{1e3 * row['median']:8.1f} ms"
    text += f", 95 % {1e3 * row['late']:8.1f} ms, {row['median'] / row['unit']:6.1f} eigenvalue problems"
    if "median_beside" in row:
        before = f"{1e3 * row['median_beside']:8.1f} ms, 95 % {1e3 * row['late_beside']:8.1f} ms"
        text += f"; beside {before}: {row['median'] / row['median_beside']:5.2f} of it"
    return text


if __name__ == "__main__":
    launch(main)
