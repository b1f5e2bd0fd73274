"""Accuracy against cost of every model and resolution on a scene, measured on this machine."""

from __future__ import annotations

import math
import os
import pickle
import subprocess
import sys
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

from leblanc.core.notes import one_line
from leblanc.scene.scene import Scene, require_chambers, require_clear
from validation.trade.answers import Case, answer, taste
from validation.trade.cases import Question, finer, questions
from validation.trade.evaluate import Comparison, Run, compare, decided, errors

Progress = Callable[[str, float], object]

REPEATS = 5
# CPU seconds: beyond the first a run is timed in its own process and once more here, beyond the second only
# there.
_LONG, _LONGER = 0.3, 1.5
_FEW = 1
_SHORT = 0.02  # s; shorter runs are timed several at once
# Cells times steps of a finer reference at most, and with short ladders; by how much they go up where its
# cells are twice as many. Counted, so that no clock decides; some 60 and 20 s.
_MOST, _MOST_QUICK, _GROWTH = 6e8, 2e8, 4.0


@dataclass(frozen=True)
class TradeRecord:
    """What `trade` found."""

    name: str  #: of the scene
    source: str
    assumed: tuple[str, ...]
    digest: str
    tolerance: float  #: relative error that it allows
    comparisons: tuple[Comparison, ...]  #: one for each question


def trade_scene(
    scene: Scene,
    quick: bool = False,
    repeats: int = REPEATS,
    progress: Progress | None = None,
    layer: bool | None = None,
    only: str | None = None,
) -> TradeRecord:
    """Measure every model and resolution on a scene; `only` one question, all if None.

    `progress` is called with what runs and the share that is done; `layer`: one layer alone by every solver
    of py-pde as well, None where the scene asks for waves that py-pde solves.
    """
    require_chambers(scene, "the accuracy and cost of liquid models")
    require_clear(scene, "a comparison of models, most of which know circular walls alone", baffles=True)
    tell = progress or (lambda _, __: None)
    tolerance = scene.model.tolerance
    found = []
    cases = [question for question in questions(scene, quick, layer) if only in (None, question.name)]
    for k, question in enumerate(cases):

        def said(text: str, share: float, k: int = k) -> None:
            tell(text, (k + share) / len(cases))

        runs = measure(question, repeats, said)
        found.append(refine(question, runs, tolerance, _MOST_QUICK if quick else _MOST, said))
    return TradeRecord(
        one_line(scene.name), scene.source, scene.assumed, scene.digest, tolerance, tuple(found)
    )


def refine(
    question: Question, runs: dict[Case, Run], tolerance: float, most: float, progress: Progress
) -> Comparison:
    """Comparison with its reference refined until it decides what to take, or costs more work than `most`."""
    found = compare(question, runs, tolerance)
    while not decided(found, tolerance):
        better = finer(question)
        if better is None or _GROWTH * runs[question.reference].answer.work > most:
            break
        progress(f"{question.name}: {better.reference.label}", 1.0)
        run = alone(question.scene, better.reference)
        if run.answer.reason or runs[question.reference].answer.in_range > run.answer.in_range:
            break  # a finer mesh on which the layer falls is no better answer
        question, runs = better, runs | {better.reference: run}
        found = compare(question, runs, tolerance)
    return found


def error_table(question: Question, cases: Iterable[Case]) -> dict[str, tuple[float, float]]:
    """Errors by label, of the whole and of the largest amplitude, found in this process."""
    best = answer(question.scene, question.reference)
    return {case.label: errors(question.name, answer(question.scene, case), best) for case in cases}


def measure(question: Question, repeats: int, progress: Progress) -> dict[Case, Run]:
    """Run every case: once in a process of its own for its memory, then all in turn here for their time."""
    runs: dict[Case, Run] = {}
    for k, case in enumerate(question.cases):
        progress(f"{question.name}: {case.label}", 0.7 * k / len(question.cases))
        runs[case] = alone(question.scene, case)
    short = [case for case in question.cases if runs[case].times[0] < _LONGER]
    # What is short is timed among its likes alone; a long run is as warm in its own process.
    times = {case: [t for t in runs[case].times if t >= _LONG] for case in short}
    for case in short:
        taste(question.scene, case)
    for turn in range(repeats):
        # To and fro, so that none always follows the same one.
        for case in short[:: 1 if turn % 2 == 0 else -1]:
            if turn >= _FEW and runs[case].times[0] >= _LONG:
                continue
            progress(f"{question.name}: {case.label}, again", 0.7 + 0.3 * turn / repeats)
            times[case].append(_cpu_time(question.scene, case, runs[case].times[0]))
    return {
        case: replace(run, times=tuple(times[case])) if times.get(case) else run for case, run in runs.items()
    }


def alone(scene: Scene, case: Case) -> Run:
    """One case in a process of its own."""
    path = os.pathsep.join(filter(None, sys.path))
    done = subprocess.run(
        [sys.executable, "-P", "-m", "validation.trade.child"],
        input=pickle.dumps((scene, case)),
        capture_output=True,
        env=os.environ | {"PYTHONPATH": path},
        check=False,
    )
    if done.returncode != 0:
        message = done.stderr.decode(errors="replace").strip().splitlines() or ["no message"]
        raise RuntimeError(f"{case.label}: the process ended with {done.returncode}: {message[-1]}")
    found: Run = pickle.loads(done.stdout)
    return found


def _cpu_time(scene: Scene, case: Case, expected: float) -> float:
    """CPU time of one run, short ones as the mean of several."""
    count = max(1, min(50, math.ceil(_SHORT / max(expected, 1e-6))))
    if expected < _LONG:
        answer(scene, case)  # or what ran before, which fills the caches, would count
    begin = time.process_time()
    for _ in range(count):
        answer(scene, case)
    return (time.process_time() - begin) / count
