"""Values of the machine that two of the fills ask for, and what they say of the other five.

The first and the last fill are fitted, by the ratio of the last to the first; the five between judge. Two
ratios do not tell five values, so the draws that come closest stand for all that the two allow. `python -m
validation.cases.fill_sweep.fitted` draws again, runs all fills with each draw, and keeps the answers.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np

from meshes.arrays import Array
from validation.cases.fill_sweep import machine
from validation.cases.fill_sweep.machine import RANGES, Values
from validation.study import data, launch, read, write

KEPT = Path(__file__).parent / "answers.json"
DRAWS, SEED = 400, 11
# Of the logarithm of a ratio: how far alike runs of the machine are apart. The passages of the five runs that
# get through scatter by 0.13, without any order.
SCATTER = 0.2
NEAREST = 20  # draws that make the band
FINE = 128  # cells of the run that checks
_WEAK, _WEAK_DRAWS = (0.15, 0.25, 0.4, 0.6), 70
_STEPS = 60  # of the search from the nearest draw


@dataclass(frozen=True)
class Answers:
    """What all draws answer: d draws of v values, f fills."""

    values: Array  #: shape (d, v), in the order of `RANGES`
    passage: Array  #: as in `machine.Answer`, shape (d, f)
    speed: Array
    cruise: Array

    def of(self, k: int) -> Values:
        """Values of draw k."""
        return Values(*self.values[k].tolist())


def measured() -> tuple[Array, Array, Array]:
    """Volumes added, ml; largest shaking of the passage and of the cruise over those of the first fill."""
    found = data("fill_sweep.json")
    logs = found["logs"]
    passage, cruise = (np.array(logs[key], dtype=float) for key in ("passage_peak", "cruise_peak"))
    return np.array(found["added_ml"], dtype=float), passage / passage[0], cruise / cruise[0]


def drawn(count: int = DRAWS, seed: int = SEED) -> Array:
    """Latin hypercube of values from their ranges, shape (count, v)."""
    from scipy.stats import qmc

    unit = qmc.LatinHypercube(len(RANGES), rng=np.random.default_rng(seed)).random(count)
    low, high = np.log(np.array(list(RANGES.values()))).T
    return np.asarray(np.exp(low + unit * (high - low)))


def run(values: Array) -> Answers:
    """Every fill with every draw, shape (d, v)."""
    added = measured()[0]
    rows = []
    for k, one in enumerate(values.tolist()):
        found = [machine.answer(Values(*one), ml) for ml in added.tolist()]
        rows.append([[a.passage, a.speed, a.cruise] for a in found])
        if k % 20 == 19:
            print(f"{k + 1} of {len(values)}", flush=True)
    return Answers(values, *np.moveaxis(np.array(rows), 2, 0))


def ratios(answers: Answers) -> tuple[Array, Array]:
    """Passage and cruise over those of the first fill, shapes (d, f)."""
    return answers.passage / answers.passage[:, :1], answers.cruise / answers.cruise[:, :1]


def misfit(answers: Answers) -> Array:
    """Sum of the squares of the fitted fills' residuals over the scatter, shape (d,)."""
    total = np.zeros(len(answers.values))
    for own, seen in zip(ratios(answers), measured()[1:], strict=True):
        total += np.square(np.log(own[:, -1] / seen[-1]) / SCATTER)
    return np.asarray(total)


def nearest(answers: Answers, count: int = NEAREST) -> list[int]:
    """Numbers of the draws that come closest to the fitted fills, the closest first."""
    order: list[int] = np.argsort(misfit(answers), kind="stable").tolist()
    return order[:count]


def bands(answers: Answers, found: Answers) -> tuple[Array, Array]:
    """Least and most of passage and cruise over the first fill, of what comes closest, shapes (2, f)."""
    some = nearest(answers)
    pairs = zip(ratios(answers), ratios(found), strict=True)
    passage, cruise = (np.concatenate([own[some], one]) for own, one in pairs)
    return np.array([passage.min(0), passage.max(0)]), np.array([cruise.min(0), cruise.max(0)])


def search(answers: Answers) -> Array:
    """Values closer still to the fitted fills, from the nearest draw, shape (1, v)."""
    from scipy.optimize import minimize

    low, high = np.log(np.array(list(RANGES.values()))).T
    ends = (0.0, float(measured()[0][-1]))

    def off(logs: Array) -> float:
        values = Values(*np.exp(logs).tolist())
        found = [machine.answer(values, ml) for ml in ends]
        rows = ([a.passage for a in found], [a.speed for a in found], [a.cruise for a in found])
        return float(misfit(Answers(np.exp(logs)[None], *(np.array([row]) for row in rows)))[0])

    begin = np.log(answers.values[nearest(answers, 1)[0]])
    limits = list(zip(low, high, strict=True))
    found = minimize(off, begin, method="Nelder-Mead", bounds=limits, options={"maxfev": _STEPS})
    return np.asarray(np.exp(found.x))[None]


@dataclass(frozen=True)
class Fitted:
    """The machine with the values that the two fills ask for."""

    answers: Answers  #: of its values alone, d = 1
    down: float  #: largest shaking of a coast through the resonance over that of the sprint, first fill
    fine: Array  #: passage of each fill with `FINE` cells over that with the scene's, shape (f,)
    #: passage of the last fill over the largest of the first fill with a motor that is weaker in that run
    #: alone, of some draws, shape (`_WEAK_DRAWS`,)
    weaker: Array


def fit(answers: Answers) -> Fitted:
    """Search, run all fills with the values found, and check the cells."""
    found = run(search(answers))
    values = found.of(0)
    down = machine.coasting(values, 0.0)
    near = down.speed <= machine.PASSED
    back = float(machine.shaking(down)[near].max()) / float(found.passage[0, 0])
    fine = [machine.answer(values, ml, FINE).passage for ml in measured()[0].tolist()]
    return Fitted(found, back, np.array(fine) / found.passage[0], weaker(answers))


def weaker(answers: Answers) -> Array:
    """Effect of another motor in the first run alone, shape (`_WEAK_DRAWS`,)."""
    through = np.flatnonzero(answers.speed[:, -1] > machine.PASSED)[:_WEAK_DRAWS]
    found = []
    for k in through.tolist():
        values = answers.of(k)
        weak = [replace(values, torque=part * values.torque) for part in _WEAK]
        found.append(answers.passage[k, -1] / max(machine.answer(one, 0.0).passage for one in weak))
    return np.array(found)


@dataclass(frozen=True)
class _Kept:
    draws: Answers
    fitted: Fitted


@cache
def kept() -> tuple[Answers, Fitted]:
    """The answers that were kept last, and the machine that was fitted."""
    found = read(KEPT, _Kept)
    return found.draws, found.fitted


def main(draws: int = DRAWS) -> None:
    """Draw, run, keep."""
    answers = run(drawn(draws))
    write(KEPT, _Kept(answers, fit(answers)), digits=6, compact=True)


if __name__ == "__main__":
    launch(main)
