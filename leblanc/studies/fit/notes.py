"""What the data of a fit cannot tell, in sentences."""

from __future__ import annotations

import math
from collections.abc import Sequence

from leblanc.core.notes import Note, NoteCode
from leblanc.core.units import number
from meshes.arrays import Array

POOR = 0.3  # of what was measured: more left than that is no noise
LARGE = 0.05  # of what was measured: more noise than that is doubtful
_BOTH = 0.95  # a correlation from which on data tell little more than a combination of two values
_VAGUE = 0.5  # of the value: a standard error at which the data hardly tell it


class FitCode(NoteCode):
    """What the notes of a fit say."""

    AT_BOUND = "at_bound"
    CORRELATED = "correlated"
    VAGUE = "vague"
    NOT_TOLD = "not_told"
    OTHER_MINIMUM = "other_minimum"
    NO_SPREAD = "no_spread"
    SCALE = "scale"
    POOR = "poor"
    PLATEAU = "plateau"
    LOPSIDED = "lopsided"
    FLAT = "flat"
    NOT_REPEATED = "not_repeated"
    LARGE = "large"
    FEW = "few"
    CONVERTED = "converted"


def poor_note(rms: float, reason: str) -> Note:
    """That noise does not explain what is left (rms over that of what was measured), and why, in a clause."""
    text = (
        f"The scene does not meet the data: {100.0 * rms:.2g} % of their size are left, and {reason}. "
        "There are no standard errors."
    )
    return Note(FitCode.POOR, {"residual_rms": rms}, text)


def few_note(rms: float, freedom: int) -> Note:
    """That so few values cannot show whether the residuals are noise."""
    more = f"{freedom} value{'' if freedom == 1 else 's'} more than unknowns"
    text = (
        f"{100.0 * rms:.2g} % of the data's size are left, and {more} cannot show whether that is noise: "
        "state the error of the sensor (--noise) or measure more. There are no standard errors."
    )
    return Note(FitCode.FEW, {"residual_rms": rms, "freedom": freedom}, text)


def large_note(rms: float) -> Note:
    """That the residuals were taken for noise although they are large."""
    text = (
        f"{100.0 * rms:.2g} % of the data's size are left and taken for noise, which is much; state the "
        "error of the sensor (--noise) to have it evaluated."
    )
    return Note(FitCode.LARGE, {"residual_rms": rms}, text)


def repeated_note(searches: int) -> Note:
    """That the best values were found once."""
    text = f"Only one of {searches} searches came to these values: there may be better ones; raise --starts."
    return Note(FitCode.NOT_REPEATED, {"searches": searches}, text)


def plateau_note(path: str, value: float, edge: float, above: bool) -> Note:
    """That every value on one side fits as well."""
    side, bound = ("larger", "lower") if above else ("smaller", "upper")
    text = (
        f"Every {side} {path} fits as well as {number(value)}: the data give a {bound} bound alone, "
        f"{number(edge)}, and there is no standard error."
    )
    return Note(FitCode.PLATEAU, {"path": path, "value": value, "edge": edge}, text)


def lopsided_note(path: str, low: float, high: float) -> Note:
    """That a value may lie much further on one side than on the other."""
    text = (
        f"{path} is known much better on one side than on the other, {number(low)} to {number(high)} with "
        "95 %: there is no standard error."
    )
    return Note(FitCode.LOPSIDED, {"path": path, "low": low, "high": high}, text)


def flat_note(paths: Sequence[str], powers: Sequence[float]) -> Note:
    """That some unknowns are known in a combination only, and which changes leave the data as they are."""
    largest = max(abs(power) for power in powers)
    changes = ", ".join(
        f"{path} by {100.0 * power / largest / 10.0:+.2g} %"
        for path, power in zip(paths, powers, strict=True)
    )
    text = f"The data tell {', '.join(paths)} together only: changing {changes} changes nothing measured."
    return Note(FitCode.FLAT, {"paths": tuple(paths), "powers": tuple(powers)}, text)


def fit_notes(
    unknown: Sequence[str],
    value: Array,
    std: Array,
    correlation: Array,
    at_bound: Sequence[bool],
    shown: Sequence[bool],
    span: Array,
) -> list[Note]:
    """What the data cannot tell of p unknowns, in words; their correlation has shape (p, p).

    `at_bound`: the search ended there; `shown`: another note has said what is not known; `span`: large for an
    unknown of either sign, a length or an angle, nan of others.
    """
    found = []
    told = zip(unknown, value.tolist(), std.tolist(), at_bound, shown, span.tolist(), strict=True)
    for path, size, error, edge, said, large in told:
        if edge:
            text = f"{path} ended at the edge of the search, {number(size)}: the data do not bound it."
            found.append(Note(FitCode.AT_BOUND, {"path": path, "value": size}, text))
        elif said:
            continue
        elif math.isnan(error):
            text = f"The data do not tell {path}: nothing that was measured changes with it alone."
            found.append(Note(FitCode.NOT_TOLD, {"path": path}, text))
        elif not math.isnan(large):
            if error > _VAGUE * large:
                text = f"The data hardly tell {path}: its standard error is {number(error)}."
                found.append(Note(FitCode.VAGUE, {"path": path, "std": error}, text))
        elif error > _VAGUE * abs(size):
            text = f"The data hardly tell {path}: its standard error is {error / abs(size):.0%} of it."
            found.append(Note(FitCode.VAGUE, {"path": path, "share": error / abs(size)}, text))
    for i in range(len(unknown)):
        for j in range(i):
            if abs(correlation[i, j]) > _BOTH:
                way = "product" if correlation[i, j] < 0.0 else "ratio"
                text = (
                    f"{unknown[j]} and {unknown[i]} are identifiable together only (correlation "
                    f"{correlation[i, j]:.3f}): something like their {way} is known, not each of them."
                )
                data = {"paths": (unknown[j], unknown[i]), "correlation": float(correlation[i, j])}
                found.append(Note(FitCode.CORRELATED, data, text))
    return found
