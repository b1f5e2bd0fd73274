"""Errors of the kept comparisons made again, those of the cases that are cheap."""

from __future__ import annotations

from dataclasses import replace

from leblanc.scene.examples import example
from validation.case import Case, Origin, compare
from validation.trade import kept, names
from validation.trade.cases import questions, refined_to
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
        for question in questions(example(name)):
            before = next(one for one in record(name).comparisons if one.question == question.name)
            kept_errors = {row.label: row.error for row in before.rows}
            fine = refined_to(question, before.reference)
            cheap = [case for case in fine.cases if case.model != "fem" and (case.resolution or 0) <= _CELLS]
            for label, (error, _) in error_table(fine, cheap).items():
                printed = kept_errors[label]
                text = (
                    f"trade/{name}-{question.name}-{label.replace(' ', '-')}",
                    f"validation/trade/{name}.json",
                    f"error of {label}: {name}, {question.name}",
                )
                if max(printed, error) > _ROUNDING:
                    found.append(compare(*text, printed, error, tolerance=_TOLERANCE, origin=_KEPT))
                else:
                    exact = Case(*text, printed, error, "rounding", "agrees", "exact here", origin=_KEPT)
                    found.append(exact)
    for scene, comparison in ((each, one) for each in names() for one in record(each).comparisons):
        beaten, what = comparison.dominated_by, comparison.question
        found.append(
            Case(
                f"trade/{scene}-{what}-default",
                f"validation/trade/{scene}.json",
                f"models and resolutions that beat the default in error and time on {scene}, {what}",
                "none",
                ", ".join(beaten) or "none",
                f"the default's error is {comparison.default.error:.1e}",
                "differs" if beaten else "agrees",
                origin=_KEPT,
            )
        )
    return found


def record(name: str) -> TradeRecord:
    """Kept comparison of a scene as `trade` found it."""
    return replace(record_of(kept(name)), source=f"kept in validation/trade/{name}.json")
