"""Seeded faults of the comparison of accuracy and cost."""

from __future__ import annotations

from tests.faults import Fault
from tests.validation import test_trade_errors as oracle

_JUDGE, _CASES, _FIGURE = "validation.trade.judge", "validation.trade.cases", "validation.trade.figure"

FAULTS: tuple[Fault, ...] = (
    Fault(_JUDGE, "one.error <= other.error + own", "one.error <= other.error - own", oracle.check_dominates),
    Fault(_JUDGE, "one.time + noise < other.time", "one.time - noise < other.time", oracle.check_dominates),
    Fault(
        _JUDGE,
        "one.spread * one.time, other.spread * other.time,",
        "one.spread * one.time, 0.0 * other.time,",
        oracle.check_dominates,
    ),
    Fault(_JUDGE, "_REPRODUCED * min(", "0.0 * min(", oracle.check_dominates),
    Fault(_JUDGE, "fine / (2.0**order - 1.0)", "fine / 2.0**order", oracle.check_reference_error),
    Fault(_JUDGE, "math.log2(coarse / fine)", "math.log2(fine / coarse)", oracle.check_reference_error),
    Fault(
        _JUDGE,
        "return max(coarse, fine), math.nan",
        "return min(coarse, fine), math.nan",
        oracle.check_reference_error,
    ),
    Fault(
        _JUDGE,
        "np.linalg.norm(gap) / np.linalg.norm(size)",
        "np.linalg.norm(gap) / largest",
        oracle.check_errors,
    ),
    Fault(_JUDGE, "gap / np.where(size > 0.0, size, largest)", "gap / largest", oracle.check_errors),
    Fault(
        _JUDGE,
        "float(found.values.max()) / largest - 1.0",
        "float(found.values[-1]) / largest - 1.0",
        oracle.check_errors,
    ),
    Fault(
        _JUDGE, "np.median(times) / min(times) - 1.0", "max(times) / min(times) - 1.0", oracle.check_compare
    ),
    Fault(
        _JUDGE,
        "overhead=rows[0].time / twin - 1.0",
        "overhead=twin / rows[0].time - 1.0",
        oracle.check_compare,
    ),
    Fault(_JUDGE, "if rows[k].error <= tolerance]", "if rows[k].error >= tolerance]", oracle.check_recommend),
    Fault(_JUDGE, "best = min(within,", "best = max(within,", oracle.check_recommend),
    Fault(_CASES, "_HELD * _capture(scene)", "_capture(scene)", oracle.check_passage),
    Fault(_CASES, "length = (stop - start) / plan.rate", "length = stop / plan.rate", oracle.check_passage),
    Fault(_CASES, "chosen = [top, speed.size - 1]", "chosen = [0]", oracle.check_speeds),
    Fault(_FIGURE, "sum(map(box.overlap, taken))", "0.0 * sum(map(box.overlap, taken))", oracle.check_labels),
)
