"""Results of the benchmarks in words and numbers: markdown tables and the ratios that matter."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from validation.benchmarks.growth import Growth
from validation.benchmarks.timing import Sample


@dataclass(frozen=True)
class Section:
    """One problem and everybody's samples.

    Parameters
    ----------
    name : stem of its figure
    title : what was solved
    error : what the error is
    samples : of all codes
    missing : codes that are not installed
    target : error at which the codes are compared
    """

    name: str
    title: str
    error: str
    samples: tuple[Sample, ...]
    missing: tuple[str, ...]
    target: float


def markdown(section: Section, ours: str) -> str:
    """Table of a section, and below it who is how much slower at the target.

    Parameters
    ----------
    section : to show
    ours : the code that the others are compared with
    """
    head = f"## {section.title}\n\n| code | setting | time | {section.error} | first call |\n"
    head += "|---|---|---:|---:|---:|\n"
    rows = [_row(sample) for sample in section.samples]
    rows += [f"| {code} | not installed | | | |" for code in section.missing]
    return head + "\n".join(rows) + "\n\n" + _comparison(section, ours)


def _row(sample: Sample) -> str:
    time = duration(sample.seconds) if math.isfinite(sample.seconds) else sample.note or "failed"
    error = f"{sample.error:.1e}" if math.isfinite(sample.error) else ""
    return f"| {sample.code} | {sample.setting} | {time} | {error} | {duration(sample.first)} |"


def duration(seconds: float) -> str:
    """A time with three digits and its unit."""
    units = (("s", 1.0), ("ms", 1e-3), ("us", 1e-6))
    unit, scale = next((one for one in units if seconds >= one[1]), units[-1])
    return f"{seconds / scale:.3g} {unit}"


def cheapest(samples: Iterable[Sample], code: str, target: float) -> Sample | None:
    """The fastest sample of a code with an error of the target or less; None if there is none."""
    good = [one for one in samples if one.code == code and one.error <= target]
    return min(good, key=lambda one: one.seconds, default=None)


def _comparison(section: Section, ours: str) -> str:
    reference = cheapest(section.samples, ours, section.target)
    if reference is None:
        return f"Within {section.target:g} there is no answer of {ours}.\n"
    text = [f"Cheapest within {section.target:g}: {ours} {duration(reference.seconds)} ({reference.setting})"]
    for code in dict.fromkeys(one.code for one in section.samples):
        other = cheapest(section.samples, code, section.target)
        if code == ours:
            continue
        if other is None:
            text.append(f"{code} does not get there")
        else:
            ratio = other.seconds / reference.seconds
            text.append(f"{code} {duration(other.seconds)} ({other.setting}), {ratio:.3g} times that")
    return "; ".join(text) + ".\n"


def front(samples: Iterable[Sample]) -> list[Sample]:
    """Samples that no other one beats in both time and error, the fastest first."""
    kept: list[Sample] = []
    for one in sorted((s for s in samples if s.error > 0.0), key=lambda s: (s.seconds, s.error)):
        if not kept or one.error < kept[-1].error:
            kept.append(one)
    return kept


def at_equal_error(ours: Iterable[Sample], other: Iterable[Sample]) -> list[tuple[float, float]]:
    """Time of the other code over ours where both have the same error.

    Ours is interpolated along its front in the logarithms of both; beyond it nothing is said.

    Parameters
    ----------
    ours, other : samples of one code each

    Returns
    -------
    Errors and ratios, a pair for each sample of the other code's front that lies within ours
    """
    mine = front(ours)[::-1]
    if len(mine) < 2:
        return []
    errors, times = np.log([one.error for one in mine]), np.log([one.seconds for one in mine])
    within = [one for one in front(other) if mine[0].error <= one.error <= mine[-1].error]
    return [
        (one.error, one.seconds / math.exp(np.interp(math.log(one.error), errors, times))) for one in within
    ]


def growth_markdown(growths: Sequence[Growth]) -> str:
    """Table of costs over one number."""
    counts = sorted({n for one in growths for n in one.counts})
    head = (
        f"| {growths[0].over} | "
        + " | ".join(one.name for one in growths)
        + " |\n|---:"
        + "|---:" * len(growths)
        + "|\n"
    )
    rows = []
    for n in counts:
        cells = [duration(one.seconds[one.counts.index(n)]) if n in one.counts else "" for one in growths]
        rows.append(f"| {n} | " + " | ".join(cells) + " |")
    return head + "\n".join(rows) + "\n"
