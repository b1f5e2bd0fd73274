"""The answers of several liquid models in words."""

from __future__ import annotations

from leblanc.results.base import one_line
from leblanc.results.note import EXACT
from leblanc.results.response import peak
from leblanc.results.several.comparison import Comparison, ModelAnswer
from leblanc.text.numbers import NOT_FOUND, number
from leblanc.units import MM, RPM

HEAD = ("model", "largest amplitude (mm)", "at (rpm)", "difference (%)", "CPU time (s)")
REFUSED = "does not answer"


def rows(found: Comparison) -> list[tuple[str, ...]]:
    """A row of the table for each model, as `HEAD` says.

    Parameters
    ----------
    found : the comparison
    """
    return [_row(found, one) for one in found.answers]


def _row(found: Comparison, one: ModelAnswer) -> tuple[str, ...]:
    if one.result is None or one.cpu_time is None:
        return one.model, REFUSED, "", "", ""
    at, amplitude = peak(one.result.amplitude), one.peak_amplitude
    return (
        one.model,
        NOT_FOUND if amplitude is None else number(amplitude * MM),
        "" if at is None else number(float(one.result.speed[at]) * RPM),
        "reference" if one.model == found.reference else difference(found, one.model),
        f"{one.cpu_time:.2g}",
    )


def difference(found: Comparison, model: str) -> str:
    """Largest difference of a model from the reference, per cent.

    Parameters
    ----------
    found : the comparison
    model : one that answers
    """
    size = found.largest_difference(model)
    if size is None:
        return NOT_FOUND
    return "rounding" if 0.0 < size < EXACT else f"{100.0 * size:.2g}"


def reasons(found: Comparison) -> list[str]:
    """Why models do not answer, a line for each.

    Parameters
    ----------
    found : the comparison
    """
    return [f"{one.model}: {one_line(one.reason)}" for one in found.answers if not one.answered]


def basis(found: Comparison) -> str:
    """What the differences are, in one sentence.

    Parameters
    ----------
    found : the comparison
    """
    return (
        f"Differences are the largest over the speeds, from {found.reference}, as a share of its largest "
        "amplitude."
    )


def summary(found: Comparison) -> list[tuple[str, str]]:
    """Main numbers: label and value.

    Parameters
    ----------
    found : the comparison
    """
    return [("Scene", one_line(found.name)), *((one.model, _told(found, one)) for one in found.answers)]


def _told(found: Comparison, one: ModelAnswer) -> str:
    if one.result is None or one.cpu_time is None:
        return f"{REFUSED}: {one_line(one.reason)}"
    words = [f"{_size(one)} at most"]
    if one.model == found.reference:
        words.append("the reference")
    else:
        size = difference(found, one.model)
        words.append(f"difference {size}{' %' if size[0].isdigit() else ''}")
    return ", ".join([*words, f"{one.cpu_time:.2g} s of processor time"])


def _size(one: ModelAnswer) -> str:
    """Largest amplitude with its unit."""
    return NOT_FOUND if one.peak_amplitude is None else f"{number(one.peak_amplitude * MM)} mm"


def alt(found: Comparison) -> str:
    """What the figure shows and the numbers a reader would take from it.

    Parameters
    ----------
    found : the comparison
    """
    told = [f"{one.model} {_size(one)}" for one in found.answers if one.answered]
    below = "; below, their differences" if len(told) > 1 else ""
    return f"Curves of the amplitude over speed by each liquid model{below}; largest: {', '.join(told)}."
