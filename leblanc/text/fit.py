"""A fit in words: what was found, how well each value is known."""

from __future__ import annotations

import math

from leblanc.core.units import MM, Unit
from leblanc.results.fit import FitResult

HEAD = ("Unknown", "unit", "first guess", "found", "standard error", "of it", "95 % from", "to")


def fit_rows(result: FitResult) -> list[tuple[str, ...]]:
    """One line for each unknown, as `HEAD` heads it."""
    found: list[tuple[str, ...]] = []
    columns = (result.first.tolist(), result.value.tolist(), result.std.tolist(), result.interval.tolist())
    for k, (path, first, value, std, ends) in enumerate(zip(result.unknown, *columns, strict=True)):
        known = not math.isnan(std)
        unit = result.units[k] if result.units else Unit("SI", 1.0)
        bare = path in result.signed  # a position or an angle has no size to compare with
        share = "" if bare else f"{100.0 * std / abs(value):.2g} %" if known else "not told"
        span = [unit.number(end) if math.isfinite(end) else "not told" for end in ends]
        error = unit.number(std) if known else "not told"
        name = " = ".join((path, *result.tied[k])) if result.tied else path
        found.append((name, unit.name, unit.number(first), unit.number(value), error, share, *span))
    return found


def summary(result: FitResult) -> list[tuple[str, str]]:
    """What a notebook shows."""
    pairs = [(row[0], f"{row[3]} {row[1]}, standard error {row[4]}") for row in fit_rows(result)]
    return [*pairs, ("left", left_words(result))]


def left_words(result: FitResult) -> str:
    """What is left between measured and fitted."""
    count = sum(part.value.size for part in result.measured)
    left = f"{100.0 * result.residual_rms:.2g} % of the measured size, over {count} values"
    return f"{left}; {'accepted' if result.accepted else 'not accepted'}"


def noise_words(result: FitResult) -> str:
    """Noise that the values are weighted by."""
    parts = []
    units_of = {part.name: part.unit for part in result.measured}
    for name, size in zip(result.noise.names, result.noise.size, strict=True):
        unit = units_of[name]
        if result.noise.kind == "relative" and unit != "rad":
            parts.append(f"{name} {100.0 * size:.2g} % of each reading")
        elif unit == "m":
            parts.append(f"{name} {float(f'{size * MM:.2g}'):g} mm")
        else:
            parts.append(f"{name} {size:.2g} {unit}".strip())
    given = "as stated" if result.noise.stated else "estimated from the residuals"
    return f"{result.noise.kind}, {given}: " + ", ".join(parts)
