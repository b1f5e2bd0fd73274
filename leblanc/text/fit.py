"""A fit in words: what was found, how well each value is known."""

from __future__ import annotations

import math

from leblanc.results.fit import FitResult
from leblanc.units import number

HEAD = ("Unknown (SI)", "first guess", "found", "standard error", "of it", "95 % from", "to")


def fit_rows(result: FitResult) -> list[tuple[str, ...]]:
    """One line for each unknown, as `HEAD` heads it.

    Parameters
    ----------
    result : the fit
    """
    found: list[tuple[str, ...]] = []
    columns = (result.first.tolist(), result.value.tolist(), result.std.tolist(), result.interval.tolist())
    for path, first, value, std, ends in zip(result.unknown, *columns, strict=True):
        known = not math.isnan(std)
        bare = path in result.signed  # a position or an angle has no size to compare with
        share = "" if bare else f"{100.0 * std / abs(value):.2g} %" if known else "not told"
        span = [number(end) if math.isfinite(end) else "not told" for end in ends]
        found.append((path, number(first), number(value), number(std) if known else "not told", share, *span))
    return found


def summary(result: FitResult) -> list[tuple[str, str]]:
    """What a notebook shows."""
    pairs = [(row[0], f"{row[2]}, standard error {row[3]}") for row in fit_rows(result)]
    return [*pairs, ("left", left_words(result))]


def left_words(result: FitResult) -> str:
    """What is left between measured and fitted.

    Parameters
    ----------
    result : the fit
    """
    count = sum(part.value.size for part in result.measured)
    return f"{100.0 * result.residual_rms:.2g} % of the measured size, over {count} values"
