"""What `trade` prints and writes: the JSON object, the table, the recommendation as text."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields
from typing import Any

from leblanc.core.answer import versions
from leblanc.core.notes import one_line
from validation.study import built, plain
from validation.trade.evaluate import Comparison, Row
from validation.trade.trade import TradeRecord

_KILO, _MEGA = 1e3, 1e6  # milliseconds in a second, bytes in a megabyte
_PER_CENT = 100.0
_EXACT = 1e-11  # own error of the best answer, below which it is rounding

REMARK = (
    "errors and peak errors belong to the scene; times are CPU seconds of one machine: their ratios to the "
    "default's tell more than they do"
)


def trade_json(record: TradeRecord) -> dict[str, Any]:
    """The record as an object for scripts: SI, null for what is not there."""
    rows = [
        plain(row) | {"time_ratio": plain(row.time / comparison.default.time)}
        for comparison in record.comparisons
        for row in comparison.rows
    ]
    return {
        "name": record.name,
        "digest": record.digest,
        "assumed": list(record.assumed),
        "tolerance": record.tolerance,
        "remark": REMARK,
        "versions": versions(),
        "questions": [_question(comparison, record.tolerance) for comparison in record.comparisons],
        "rows": rows,
    }


def record_of(content: Mapping[str, Any]) -> TradeRecord:
    """Record that `trade_json` wrote; it has no path of its scene."""
    found = []
    for question in content["questions"]:
        rows = [row for row in content["rows"] if row["question"] == question["question"]]
        known = question | {key: question[f"default_{key}"] for key in ("dominated_by", "overhead")}
        known["rows"] = [{field.name: row[field.name] for field in fields(Row)} for row in rows]
        found.append(built({field.name: known[field.name] for field in fields(Comparison)}, Comparison))
    told = content["name"], "", tuple(content["assumed"]), content["digest"], content["tolerance"]
    return TradeRecord(*told, tuple(found))


def _question(comparison: Comparison, tolerance: float) -> dict[str, Any]:
    advised, whole = comparison.recommended, plain(comparison)
    return {
        key: whole[key] for key in ("question", "about", "reference", "reference_error", "order", "ripple")
    } | {
        "default_dominated_by": whole["dominated_by"],
        "default_overhead": whole["overhead"],
        "recommended": None if advised is None else advised.label,
        "recommendation": recommendation(comparison, tolerance),
    }


def recommendation(comparison: Comparison, tolerance: float) -> str:
    """What to take for a tolerance, the errors that this rests on, and what it costs, in words."""
    advised, default = comparison.recommended, comparison.default
    kept = f"keep the default, {default.label} (here {', '.join(default.used)})"
    own = f"{_share(comparison.reference_error)} of the reference, {comparison.reference}"
    if advised is None:
        return f"{comparison.question}: {_undecided(comparison, tolerance, kept)}"
    what = kept if advised.default else f"take {advised.label}"
    wrong = f"its error is {error_words(advised, comparison)}"
    if comparison.reference_error > _EXACT:
        wrong = f"its error is {_share(advised.error)}, beside {own}"
        if not advised.resolved:
            wrong = f"its error is below the {own}"
    if advised.error > tolerance:
        why = f"nothing is within {_share(tolerance)}; {wrong}, the least"
    else:
        why = f"{wrong}, within {_share(tolerance)}, and nothing as good is cheaper"
    cost = f"; it takes {_time(advised.time)}"
    if not advised.default:
        gap = error_words(default, comparison)
        cost += f", the default {_time(default.time)} with an error of {gap}"
    warning = "" if advised.in_range else "; it says of itself that it is out of its range"
    return f"{comparison.question}: {what}: {why}{cost}{warning}"


def _undecided(comparison: Comparison, tolerance: float, kept: str) -> str:
    """Why nothing can be advised but the default."""
    default, own = comparison.default, comparison.reference_error
    best = next(row for row in comparison.rows if row.label == comparison.reference)
    if not any(math.isfinite(row.error) for row in comparison.rows):
        why = f": {best.note}" if best.note else ""
        return f"cannot decide: {kept}: the reference, {best.label}, has no answer{why}"
    size = _share(own) if math.isfinite(own) else "an unknown amount"
    off = f"the reference, {best.label}, is itself off by {size}"
    if not own <= tolerance:
        off += f", more than {_share(tolerance)}"
    elif default.error - own <= tolerance:
        off += f", too much to tell whether the default is within {_share(tolerance)}"
    else:
        off += f", and nothing else is known to be within {_share(tolerance)}"
    gap = "no farther is the default"
    if math.isnan(default.error):
        gap = "the default has no answer"
    elif default.resolved:
        gap = f"the default is {_share(default.error)} away from it"
    cost = f"the default takes {_time(default.time)}, the reference {_time(best.time)}"
    return f"cannot decide at this cost: {kept}: {off}; {gap}; {cost}"


def error_words(row: Row, comparison: Comparison) -> str:
    """Error as a share, or that it cannot be distinguished from the best answer's own."""
    if not math.isfinite(row.error):
        return "unknown"
    own = f"below the best answer's own {_share(comparison.reference_error)}"
    return _share(row.error) if row.resolved else own


def _time(seconds: float) -> str:
    return f"{_KILO * seconds:.3g} ms" if seconds < 1.0 else f"{seconds:.3g} s"


def _share(value: float) -> str:
    return f"{_PER_CENT * value:.2g} %"


def trade_lines(record: TradeRecord) -> list[str]:
    """Tables as text, one line each."""
    lines = [one_line(record.name)]
    for comparison in record.comparisons:
        own = f"best: {comparison.reference}"
        if comparison.reference_error > _EXACT:
            own += f", whose own error is some {_share(comparison.reference_error)}"
            converges = math.isfinite(comparison.order)
            own += f" (order {comparison.order:.2g})" if converges else " (it does not converge)"
        rippled = math.isfinite(comparison.ripple)
        if rippled:
            own += f"; its ripple is up to {_share(comparison.ripple)} of the amplitude"
        lines += ["", f"{comparison.question}: {comparison.about}; {own}"]
        width = max(27, *(len(row.label) + 2 for row in comparison.rows))
        ripple = f"{'ripple':>10}" if rippled else ""
        lines.append(
            f"{'model':{width}}{'error':>10}{'peak error':>12}{ripple}{'CPU, ms':>11}{'spread':>8}{'MB':>8}"
        )
        lines += [_line(row, width, rippled) for row in comparison.rows]
        lines.append(recommendation(comparison, record.tolerance))
        if comparison.dominated_by:
            lines.append(f"the default is beaten in both by: {'; '.join(comparison.dominated_by)}")
    return lines


def _line(row: Row, width: int, rippled: bool) -> str:
    """One row of a table; what stands out of the front, the default and the advised one marked."""
    standing = (row.on_front, row.default, row.recommended, not row.in_range)
    names = ("front", "default", "recommended", "out of range")
    marks = [word for word, holds in zip(names, standing, strict=True) if holds]
    error = f"{row.error:.2e}" if row.resolved else ("-" if math.isfinite(row.error) else "none")
    peak, ripple = (f"{x:.2e}" if math.isfinite(x) else "none" for x in (row.peak_error, row.ripple_error))
    peak = f"{peak:>12}" + (f"{ripple:>10}" if rippled else "")
    numbers = f"{error:>10}{peak}{row.time * _KILO:>11.4g}{row.spread:>8.0%}{row.memory / _MEGA:>8.2f}"
    text = "  " + ", ".join(marks) + (f"; {row.note}" if row.note else "")
    return f"{row.label:{width}}{numbers}{text if text.strip(' ;') else ''}"
