"""Errors, front and recommendation from what the cases of a question answered and took."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from validation.trade.answers import FAMILY, HELD, RESPONSE, WAVES, Answer, Case
from validation.trade.cases import Question

_ROUNDING = 1e-12  # relative error of what is called exact
# Least difference of times that counts, relative: the same computation under two names was up to 8 % apart.
_REPRODUCED = 0.1
# Less than the default's cost by this factor is worth a change; cells times steps that take as long as what
# is made besides the steps: a tenth of a second.
_WORTH, _BESIDES = 2.0, 1e6
_LEAST_ORDER = 0.25  # of convergence; what converges slower is not extrapolated
# An order beyond the second may be chance on three meshes; the factor is that of the grid convergence index.
_MOST_ORDER, _SAFETY = 2.0, 1.25


@dataclass(frozen=True)
class Run:
    """What one case answered and took."""

    answer: Answer  #: to the question
    times: tuple[float, ...]  #: CPU times, s
    first: float  #: CPU time of the first piece with imports and compilation, s
    memory: int  #: beyond that of a process with everything loaded, bytes


@dataclass(frozen=True)
class Row:
    """One case beside the others."""

    question: str  #: of the case
    model: str
    resolution: int | None
    variant: str
    used: tuple[str, ...]  #: models that answered
    #: relative to the best answer, of the whole and of the largest amplitude; nan without an answer
    error: float
    peak_error: float
    resolved: bool  #: the error is larger than the reference's own
    time: float  #: least CPU time, s
    #: of the times, the middle one less the least over the least; that of the worst other row where only one
    #: was taken
    spread: float
    repeats: int  #: how many were timed
    first: float  #: see `Run`
    memory: int
    in_range: bool  #: the model says of itself that it holds there
    selectable: bool  #: a scene can name it
    note: str  #: why there is no answer, or empty
    #: largest error that the answer tells of itself, relative; nan where it tells none
    estimate: float = math.nan
    #: of the ripple, over the best answer's amplitude; nan where it is not asked for
    ripple_error: float = math.nan
    work: float = 0.0  #: of the answer
    on_front: bool = False  #: no other row dominates it
    default: bool = False  #: what the scene's default gives; what is advised for its tolerance
    recommended: bool = False

    @property
    def label(self) -> str:
        """A short description."""
        return Case(self.question, self.model, self.resolution, self.variant).label


@dataclass(frozen=True)
class Comparison:
    """The rows of one question."""

    question: str  #: name; what is asked, in words
    about: str
    reference: str  #: label of the best case
    reference_error: float  #: relative, its own
    order: float  #: of its convergence, nan where it is exact or does not converge
    rows: tuple[Row, ...]  #: one for each case, the default first
    dominated_by: tuple[str, ...]  #: labels of the rows that dominate the default
    #: time of the default over that of the row that took the same model and resolution, less 1; nan if there
    #: is none
    overhead: float
    #: largest ripple of the best answer, over its amplitude; nan where it is not asked for
    ripple: float = math.nan

    @property
    def default(self) -> Row:
        """What the scene's default gives."""
        return self.rows[0]

    @property
    def recommended(self) -> Row | None:
        """What is advised; None where it cannot be decided."""
        return next((row for row in self.rows if row.recommended), None)


def compare(question: Question, runs: Mapping[Case, Run], tolerance: float) -> Comparison:
    """Errors, front, default and recommendation from what the cases answered and took."""
    best = runs[question.reference].answer
    own, order = reference_error(question, [runs[case].answer for case in question.ladder])
    spreads = {case: _spread(runs[case].times) for case in question.cases}
    worst = max((x for x in spreads.values() if math.isfinite(x)), default=0.0)
    rows = []
    for case in question.cases:
        run = runs[case]
        error, peak = errors(question.name, run.answer, best)
        spread = spreads[case]
        rows.append(
            Row(
                question=question.name,
                model=case.model,
                resolution=case.resolution,
                variant=case.variant,
                used=run.answer.used,
                error=error,
                peak_error=peak,
                resolved=bool(error > own),
                time=min(run.times),
                spread=spread if math.isfinite(spread) else worst,
                repeats=len(run.times),
                first=run.first,
                memory=run.memory,
                in_range=run.answer.in_range,
                selectable=case.selectable,
                note=run.answer.reason or _other_physics(question, case),
                estimate=run.answer.estimate,
                ripple_error=_ripple_error(run.answer, best),
                work=run.answer.work,
            )
        )
    found = _judged(question, rows, own, order, tolerance)
    if best.ripple is None or best.reason or question.reference.variant != HELD:
        return found
    return replace(found, ripple=float(np.max(best.ripple / best.values)))


def _ripple_error(found: Answer, best: Answer) -> float:
    """Largest difference of two ripples over the best amplitude; nan where one of them is missing."""
    if found.ripple is None or best.ripple is None or found.reason or best.reason:
        return math.nan
    return float(np.max(np.abs(found.ripple - best.ripple) / best.values))


def _judged(question: Question, rows: list[Row], own: float, order: float, tolerance: float) -> Comparison:
    """The comparison with front, default and recommendation marked."""
    advised = recommend(rows, own, tolerance, question.reference.label)
    marked = tuple(
        replace(
            row,
            on_front=math.isfinite(row.error) and not any(dominates(other, row, own) for other in rows),
            default=k == 0,
            recommended=k == advised,
        )
        for k, row in enumerate(rows)
    )
    # The same model at the same resolution, asked for by name.
    twins = [r for r in rows[1:] if r.used == rows[0].used and r.error == rows[0].error]
    twin = min((r.time for r in twins), default=math.nan)
    return Comparison(
        question=question.name,
        about=question.about,
        reference=question.reference.label,
        reference_error=own,
        order=order,
        rows=marked,
        dominated_by=tuple(row.label for row in rows[1:] if dominates(row, rows[0], own)),
        overhead=rows[0].time / twin - 1.0,
    )


def _spread(times: Sequence[float]) -> float:
    """Middle time less the least over the least; nan of a single one."""
    return float(np.median(times) / min(times) - 1.0) if len(times) > 1 else math.nan


def _other_physics(question: Question, case: Case) -> str:
    """Whether a case has a term of its equations more or less than the reference."""
    alone = question.name in (WAVES, FAMILY)  # variants are ways to solve the same equations
    apart = case.model == question.reference.model and case.variant != question.reference.variant
    if alone or not apart:
        return ""
    return "other physics: what is left is a difference of models"


def errors(name: str, found: Answer, best: Answer) -> tuple[float, float]:
    """Error of an answer and of its largest amplitude, relative to the best one's; nan without an answer.

    A response counts by its worst speed, a history by its root mean square.
    """
    if found.reason or best.reason or found.values.shape != best.values.shape:
        return math.nan, math.nan
    gap, size = np.abs(found.values - best.values), np.abs(best.values)
    largest = float(size.max())
    if largest == 0.0:
        return float(gap.max() > 0.0), float(gap.max() > 0.0)
    peak = abs(float(np.abs(found.values).max()) / largest - 1.0)
    if name == RESPONSE:
        # Where nothing moves there is nothing to be wrong about but by as much as moves elsewhere.
        return float(np.max(gap / np.where(size > 0.0, size, largest))), peak
    return float(np.linalg.norm(gap) / np.linalg.norm(size)), peak


def reference_error(question: Question, ladder: Sequence[Answer]) -> tuple[float, float]:
    """Error of the best answer itself, by Richardson's extrapolation, and the order of its convergence.

    With the differences d1 and d2 between three resolutions, finest first, each twice as fine as the next,
    the order is p = log2(d1/d2) and the finest one's error at most 1.25 d2/(2^min(p, 2) - 1). Where the order
    is hardly above zero the largest difference stands for the error; a single answer is exact but for
    rounding.
    """
    if len(ladder) < 3:
        return _ROUNDING, math.nan
    best = ladder[0]
    fine = errors(question.name, ladder[1], best)[0]
    coarse = errors(question.name, ladder[2], ladder[1])[0]
    if not (math.isfinite(fine) and math.isfinite(coarse)):
        return math.nan, math.nan
    if fine <= _ROUNDING:
        return max(fine, _ROUNDING), math.nan
    order = math.log2(coarse / fine) if coarse > 0.0 else 0.0
    if order < _LEAST_ORDER:
        return max(coarse, fine), math.nan
    return max(_SAFETY * fine / (2.0 ** min(order, _MOST_ORDER) - 1.0), _ROUNDING), order


def dominates(row: Row, other: Row, own: float) -> bool:
    """Whether a row is at least as accurate as another and cheaper by more than the times spread.

    Errors closer than the reference's own one count as equal, and so do times within a tenth of each other.
    The same computation under another name dominates nothing: what choosing it costs is the `overhead`.
    """
    if not (math.isfinite(row.error) and math.isfinite(other.error)):
        return math.isfinite(row.error) and not math.isfinite(other.error)
    if (row.used, row.error, row.work) == (other.used, other.error, other.work):
        return False
    noise = _noise(row, other)
    return row.error <= other.error + own and row.time + noise < other.time


def _noise(row: Row, other: Row) -> float:
    """Difference of two times that is no difference, s."""
    return max(row.spread * row.time, other.spread * other.time, _REPRODUCED * min(row.time, other.time))


def advisable(rows: Sequence[Row], reference: str) -> list[int]:
    """Indices of the rows that may be advised: what a scene can name, with its physics, that has answered.

    The reference is none of them: nothing better is there to say how wrong it is.
    """
    return [
        k
        for k, row in enumerate(rows)
        if row.selectable and not row.note and math.isfinite(row.error) and row.label != reference
    ]


def effort(row: Row, default: Row) -> tuple[bool, float]:
    """What a row costs, to be compared with others: counted and not timed, so that an advice is no chance.

    The cells that steps advance, and what is made besides; closed forms cost nothing beside that. Of a layer
    alone the solvers of py-pde, whose steps are not counted, come after our own.
    """
    foreign = row.question in (WAVES, FAMILY) and row.variant != default.variant
    return foreign, row.work + _BESIDES if row.work > 0.0 else 0.0


def recommend(rows: Sequence[Row], own: float, tolerance: float, reference: str) -> int:
    """Index of the row that is advised, the default first; -1 where it cannot be decided.

    A row is within the tolerance where its error and the reference's own one together are, and beyond it
    where its error less the reference's is. Advised is the cheapest within by `effort`, but the default if it
    is within and not twice as dear; where all are beyond, the most accurate, of equals the cheapest. Nothing
    is decided where the reference's own error is larger than the tolerance, where no row is within and one
    may be, and where the reference alone is within.
    """
    known = advisable(rows, reference)
    if not (known and own <= tolerance):
        return -1
    chosen = [k for k in known if rows[k].error + own <= tolerance]
    if not chosen:
        least = min(rows[k].error for k in known)
        if least - own <= tolerance or any(row.label == reference and row.selectable for row in rows):
            return -1
        chosen = [k for k in known if rows[k].error <= least + own]
    best = min(chosen, key=lambda k: effort(rows[k], rows[0]))
    return 0 if 0 in chosen and not _cheaper(rows[best], rows[0], rows[0]) else best


def _cheaper(row: Row, other: Row, default: Row) -> bool:
    """Whether a row costs so much less than another that this is worth a change."""
    (foreign, work), (alien, most) = effort(row, default), effort(other, default)
    return foreign < alien or (foreign == alien and _WORTH * work < most)


def decided(comparison: Comparison, tolerance: float) -> bool:
    """Whether a finer reference could change no advice.

    It could where nothing is advised, and where a cheaper row than the advised one may be within as well.
    """
    advised, own = comparison.recommended, comparison.reference_error
    if advised is None:
        return False
    known = [comparison.rows[k] for k in advisable(comparison.rows, comparison.reference)]
    return not any(
        tolerance - own < row.error <= tolerance + own and _cheaper(row, advised, comparison.default)
        for row in known
    )
