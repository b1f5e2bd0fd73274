"""`python -m tests.models`: measure every liquid model on two example scenes and keep the results."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import leblanc as lb
from leblanc.scene.examples import example
from leblanc.scene.scene import Scene
from leblanc.studies.compare.answer import ModelAnswer
from leblanc.studies.held.holding import cores
from leblanc.studies.run.answer import RunAnswer
from solvers.synchronous.response import distance
from tests.models import ModelRow, ModelTable, keep
from validation.study import launch

STEADY = ("linear", "kdv", "fem", "statics")
CELLS = (32, 64, 128)
_REPEATS = 3
# Away from the bands in which a whirl grows by itself, where no steady answer is one.
SCENES: dict[str, tuple[dict[str, object], str, str]] = {
    "runup": (
        {"speeds.start": 12.0, "speeds.stop": 21.0, "speeds.count": 7},
        "upright, 115 to 201 rpm, up to the flank of its resonance, where the wall runs dry",
        "statics",
    ),
    "horizontal_rig": (
        {"speeds.start": 40.0, "speeds.stop": 100.0, "speeds.count": 7},
        "lying, 382 to 955 rpm, with gravity's waves in the layer",
        "long_wave",
    ),
}


def measure(name: str) -> ModelTable:
    """All models on one example."""
    change, about, best = SCENES[name]
    scene = example(name).replace(change)
    answers: dict[tuple[str, int | None], ModelAnswer] = {
        (model, None): _least(scene, model) for model in STEADY
    }
    answers |= {
        ("long_wave", cells): _once(scene.replace({"model.cells": cells}), "long_wave") for cells in CELLS
    }
    reference = answers[(best, None if best == "statics" else CELLS[-1])].result
    if reference is None:
        raise RuntimeError(f"{best} does not answer {name}")
    own = 0.0 if best == "statics" else float(np.nanmax(_estimate(reference)))
    rows = tuple(row_of(*key, answer, reference) for key, answer in answers.items())
    return ModelTable(name, about, reference.speed.size, own, rows)


def _least(scene: Scene, model: str) -> ModelAnswer:
    """The quickest of several turns, after one that loads and compiles."""
    found = [_once(scene, model) for _ in range(_REPEATS + 1)][1:]
    return min(found, key=lambda answer: answer.cpu_time or 0.0)


def _once(scene: Scene, model: str) -> ModelAnswer:
    (answer,) = lb.compare(scene, [model], workers=cores()).answers
    return answer


def _estimate(result: RunAnswer) -> np.ndarray:
    found = result.error_estimate
    return np.full(result.speed.shape, np.nan) if found is None else found


def row_of(model: str, cells: int | None, answer: ModelAnswer, reference: RunAnswer | None) -> ModelRow:
    """What the table says of an answer beside the best one."""
    result = answer.result
    if result is None or reference is None:
        raise RuntimeError(f"{model} does not answer: {answer.reason}")
    known = result.converged
    off = distance(result.response, reference.response)[known]
    same = result is reference
    estimate = _estimate(result)[known]
    return ModelRow(
        model=model,
        cells=cells,
        error=float("nan") if same else float(off.max()),
        estimate=float("nan") if np.isnan(estimate).all() else float(np.nanmax(estimate)),
        time=float(answer.cpu_time or 0.0) / result.speed.size,
        lost=int(np.count_nonzero(~known)),
        in_range=float(np.mean(result.in_range)),
    )


def main() -> Iterator[str]:
    """Measure, keep, print."""
    tables = tuple(measure(name) for name in SCENES)
    keep(tables)
    for table in tables:
        yield f"{table.scene}: {table.about}; best to {table.best_error:.2g}"
        for row in table.rows:
            told = f"{row.error:10.2e}{row.estimate:10.2e}{1e3 * row.time:10.3g} ms"
            yield f"  {row.name:22}{told}, no answer at {row.lost} speeds"


if __name__ == "__main__":
    launch(main)
