"""Errors of the kept comparisons made again, those of the cases that are cheap."""

from __future__ import annotations

from dataclasses import replace

from leblanc.scene.examples import example
from validation.case import Case, Origin, compare
from validation.trade import kept, names
from validation.trade.cases import Question, questions, refined_to
from validation.trade.judge import Comparison
from validation.trade.results import record_of
from validation.trade.trade import TradeRecord, error_table

# Errors are made again on two scenes, up to so many cells.
_KEPT = Origin("second code", "this package, as make trade ran it last")
_SCENES, _CELLS = ("centrifuge", "runup"), 32
# Another order of sums changes an answer by some 1e-13; below that an error is rounding.
_TOLERANCE, _ROUNDING = 1e-6, 1e-11


def cases() -> list[Case]:
    """The kept error beside the one found now, and for each scene whether the default is beaten."""
    found = []
    for name in _SCENES:
        scene = example(name)
        for question in questions(scene):
            found += _errors(name, question)
    return [
        *found,
        *(_default(name, comparison) for name in names() for comparison in record(name).comparisons),
    ]


def _errors(name: str, question: Question) -> list[Case]:
    before = next(one for one in record(name).comparisons if one.question == question.name)
    rows = {row.label: row for row in before.rows}
    question = refined_to(question, before.reference)
    cheap = [case for case in question.cases if case.model != "fem" and (case.resolution or 0) <= _CELLS]
    found = []
    for label, (error, _) in error_table(question, cheap).items():
        found.append(_error(f"{name}-{question.name}", label, name, rows[label].error, error))
    return found


def _error(where: str, label: str, name: str, printed: float, error: float) -> Case:
    """One error as it was kept and as it is now."""
    text = (
        f"trade/{where}-{label.replace(' ', '-')}",
        f"validation/trade/{name}.json",
        f"error of {label}: {where.replace('-', ', ')}",
    )
    if max(printed, error) <= _ROUNDING:
        return Case(*text, printed, error, "rounding", "agrees", "exact here", origin=_KEPT)
    return compare(*text, printed, error, tolerance=_TOLERANCE, origin=_KEPT)


def _default(name: str, comparison: Comparison) -> Case:
    """Whether some other model or resolution is as good and cheaper."""
    beaten = comparison.dominated_by
    return Case(
        f"trade/{name}-{comparison.question}-default",
        f"validation/trade/{name}.json",
        f"models and resolutions that beat the default in error and time on {name}, {comparison.question}",
        "none",
        ", ".join(beaten) or "none",
        f"the default's error is {comparison.default.error:.1e}",
        "differs" if beaten else "agrees",
        origin=_KEPT,
    )


def record(name: str) -> TradeRecord:
    """Kept comparison of a scene as `trade` found it."""
    return replace(record_of(kept(name)), source=f"kept in validation/trade/{name}.json")
