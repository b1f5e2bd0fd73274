"""All benchmarks in one run, the run that is kept with the package, and both in tables, ratios, figures."""

from __future__ import annotations

import importlib
import logging
import math
import platform
import sys
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from leblanc.plotting.page import save_png
from validation.benchmarks import growth, leblanc_codes
from validation.benchmarks.growth import Growth
from validation.benchmarks.problems import (
    WANTED,
    SteadyProblem,
    TravellingProblem,
    distance,
    steady_problem,
    travelling_problem,
)
from validation.benchmarks.timing import Answer, Contestant, Sample, measure, version
from validation.page import Figure, page, power
from validation.study import launch, read, shown
from validation.study import write as write_json

KEPT = Path(__file__).parent / "results.json"


def keep(results: Results, folder: Path = KEPT.parent) -> Path:
    """Write a run beside this module or to another folder."""
    write_json(folder / KEPT.name, results)
    return folder / KEPT.name


def kept_results() -> Results:
    """Run that `keep` wrote beside this module."""
    return read(KEPT, Results)


@dataclass(frozen=True)
class Section:
    """One problem and everybody's samples."""

    name: str  #: stem of its figure
    title: str  #: what was solved
    error: str  #: what the error is
    samples: tuple[Sample, ...]  #: of all codes
    missing: tuple[str, ...]  #: codes that are not installed
    target: float  #: error at which the codes are compared


def markdown(section: Section, ours: str) -> str:
    """Table of a section, and below it how much slower than `ours` the others are at the target."""
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
    unit, scale = next((candidate for candidate in units if seconds >= candidate[1]), units[-1])
    return f"{seconds / scale:.3g} {unit}"


def cheapest(samples: Iterable[Sample], code: str, target: float) -> Sample | None:
    """The fastest sample of a code with an error of the target or less; None if there is none."""
    good = [sample for sample in samples if sample.code == code and sample.error <= target]
    return min(good, key=lambda sample: sample.seconds, default=None)


def _comparison(section: Section, ours: str) -> str:
    reference = cheapest(section.samples, ours, section.target)
    if reference is None:
        return f"Within {section.target:g} there is no answer of {ours}.\n"
    text = [f"Cheapest within {section.target:g}: {ours} {duration(reference.seconds)} ({reference.setting})"]
    for code in dict.fromkeys(sample.code for sample in section.samples):
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
    for sample in sorted((s for s in samples if s.error > 0.0), key=lambda s: (s.seconds, s.error)):
        if not kept or sample.error < kept[-1].error:
            kept.append(sample)
    return kept


def at_equal_error(ours: Iterable[Sample], other: Iterable[Sample]) -> list[tuple[float, float]]:
    """Errors, and time of the other code over ours at equal error, for its samples within our front.

    Ours is interpolated along its front in the logarithms of both; beyond it nothing is compared.
    """
    mine = front(ours)[::-1]
    if len(mine) < 2:
        return []
    errors, times = np.log([sample.error for sample in mine]), np.log([sample.seconds for sample in mine])
    within = [sample for sample in front(other) if mine[0].error <= sample.error <= mine[-1].error]
    return [
        (sample.error, sample.seconds / math.exp(np.interp(math.log(sample.error), errors, times)))
        for sample in within
    ]


def growth_markdown(growths: Sequence[Growth]) -> str:
    """Table of costs over one number."""
    known = [dict(zip(curve.counts, curve.seconds, strict=True)) for curve in growths]
    counts = sorted({n for curve in growths for n in curve.counts})
    rows = [(str(n), *(duration(curve[n]) if n in curve else "" for curve in known)) for n in counts]
    head = (growths[0].over, *(curve.name for curve in growths))
    first, *lines = (f"| {' | '.join(row)} |\n" for row in (head, *rows))
    return "".join([first, "|---:" * len(head) + "|\n", *lines])


_MARKS = "osD^vP"
_LINES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 3)))


def accuracy_figure(section: Section) -> Figure:
    """Error over time, one mark for each sample; a line joins what no other setting of its code beats."""
    text = (
        f"{section.title}. One core, best of several repeats taken in turn, without compilation. "
        "Filled: no other setting of that code is both faster and better."
    )
    with page([3.0], text, below=0.45) as (figure, [[axes]]):
        for k, code in enumerate(dict.fromkeys(sample.code for sample in section.samples)):
            mine = [sample for sample in section.samples if sample.code == code and sample.error > 0.0]
            best = front(mine)
            look: dict[str, Any] = {"color": f"C{k}", "marker": _MARKS[k % len(_MARKS)]}
            times, errors = ([getattr(sample, name) for sample in mine] for name in ("seconds", "error"))
            axes.plot(times, errors, linestyle="none", markerfacecolor="white", **look)
            times, errors = ([getattr(sample, name) for sample in best] for name in ("seconds", "error"))
            line: dict[str, Any] = {"linestyle": _LINES[k % len(_LINES)], "linewidth": 1.1, "label": code}
            axes.plot(times, errors, **line, **look)
        _logarithmic(axes)
        axes.set_xlabel("Time of one answer (s)")
        axes.set_ylabel(f"{section.error[0].upper()}{section.error[1:]} (\N{EN DASH})")
    return figure


def _logarithmic(axes: Any) -> None:
    """Both axes, labelled at powers of ten as the house style writes them, upwards at two at least."""
    axes.set(xscale="log", yscale="log")
    low, high = (math.log10(value) for value in axes.get_ylim())
    if math.floor(high) - math.ceil(low) < 1:
        axes.set_ylim(10.0 ** math.floor(low), 10.0 ** math.ceil(high))
    axes.minorticks_off()
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(power)


def growth_figure(growths: Sequence[Growth]) -> Figure:
    """Cost over one number, both logarithmic."""
    over = " or ".join(dict.fromkeys(curve.over for curve in growths))
    text = f"Growth of the cost with the number of {over}. One core, best of several repeats."
    with page([2.8], text, below=0.45) as (figure, [[axes]]):
        for k, curve in enumerate(growths):
            look: dict[str, Any] = {
                "color": f"C{k}",
                "marker": _MARKS[k % len(_MARKS)],
                "linestyle": _LINES[k % len(_LINES)],
            }
            axes.plot(curve.counts, curve.seconds, linewidth=1.1, label=curve.name, **look)
        _logarithmic(axes)
        counts = sorted({n for curve in growths for n in curve.counts})
        axes.set_xticks(counts, [str(n) for n in counts])
        axes.set(xlabel=f"Number of {over} (\N{EN DASH})", ylabel="Time (s)")
    return figure


_MODULE = "validation.benchmarks.peers."
# Cells of the long-wave runs, of the slow Python kernel, and of the reference.
_CELLS, _SLOW, _REFERENCE = (64, 96, 128, 192, 256, 384, 512), (128,), 2048
_QUICK_CELLS, _QUICK_REFERENCE = (32, 64), 128
_PERIODS, _SETTLED, _QUICK_PERIODS = 100, 40, 4
_TURNS, _QUICK_TURNS = 10.0, 1.0


@dataclass(frozen=True)
class Results:
    """One run of the benchmarks."""

    versions: dict[str, str]  #: of the codes, "not installed" where one is missing
    sections: list[Section]  #: problems with everybody's samples
    over_cells: list[growth.Growth]  #: growth of the cost
    over_speeds: list[growth.Growth]
    curve: float  #: time of the response at 201 speeds, s
    curve_complete: bool  #: whether it was followed from end to end
    first: dict[str, float]  #: times of the first calls, s
    remarks: list[str]  #: ratios and checks in words


def collect(peers: tuple[str, ...], quick: bool, repeats: int) -> Results:
    """Run everything, beside the other codes `peers`."""
    modules = {name: importlib.import_module(_MODULE + name) for name in peers}
    found = {name: version(module.PACKAGE) for name, module in modules.items()}
    versions = {
        "Python": platform.python_version(),
        leblanc_codes.CODE: version(leblanc_codes.CODE) or "from its folder",
    }
    versions |= {modules[name].CODE: found[name] or "not installed" for name in peers}
    here = [module for name, module in modules.items() if found[name]]
    missing = [module for name, module in modules.items() if not found[name]]
    # Codes that tell what they do on the terminal.
    logging.disable(logging.WARNING)
    try:
        waves = []
        for word, tall in (("strongly", False), ("weakly", True)):
            steady = steady_problem(tall)
            title = f"Steady wave, {word} damped: from rest over {steady.time:g} s, or by Newton's method"
            told = {"name": f"benchmark_steady_{word}_damped", "title": title, "target": WANTED}
            waves.append(_wave(here, missing, "steady", steady, quick, repeats, **told))
        turns = _QUICK_TURNS if quick else _TURNS
        title = f"Cnoidal wave of the KdV equation after {turns:g} turns"
        told = {"name": "benchmark_travelling", "title": title, "target": 1e-3}
        waves.append(_wave(here, missing, "travelling", travelling_problem(turns), quick, repeats, **told))
        layers_found, remarks = _layers(here, missing, quick, repeats)
    finally:
        logging.disable(logging.NOTSET)
    seconds, complete = growth.curve_time()
    return Results(
        versions=versions,
        sections=[*waves, *layers_found],
        over_cells=growth.over_cells(quick),
        over_speeds=growth.over_speeds(quick),
        curve=seconds,
        curve_complete=complete,
        first=growth.first_calls(),
        remarks=remarks,
    )


def _wave(
    here: list[ModuleType],
    missing: list[ModuleType],
    kind: str,
    problem: SteadyProblem | TravellingProblem,
    quick: bool,
    repeats: int,
    **told: Any,
) -> Section:
    """Samples of all on a steady or a travelling wave."""
    runs = getattr(leblanc_codes, kind)(problem, quick)
    runs += _of(here, kind, lambda module: list(getattr(module, kind)(problem, quick)))
    samples = measure(runs, lambda answer: distance(answer, problem.exact), repeats, _tell)
    return Section(error="error (L2)", samples=tuple(samples), missing=_named(missing, kind), **told)


def _layers(
    here: list[ModuleType], missing: list[ModuleType], quick: bool, repeats: int
) -> tuple[list[Section], list[str]]:
    periods, cells = (_QUICK_PERIODS, _QUICK_CELLS) if quick else (_PERIODS, _CELLS)
    problem = leblanc_codes.LayerProblem(periods)
    # The layer has settled long before the end: the reference need not run so far.
    fine = leblanc_codes.LayerProblem(periods if quick else _SETTLED)
    reference = leblanc_codes.answer(fine, _QUICK_REFERENCE if quick else _REFERENCE)
    runs = leblanc_codes.ours(problem, cells) + _of(
        here, "layers", lambda m: m.layers(problem, cells, () if quick else _SLOW)
    )
    forces: list[float] = []

    def error(found: Answer) -> float:
        forces.append(leblanc_codes.force_error(found, reference))
        return leblanc_codes.profile_error(found, reference)

    samples = tuple(measure(runs, error, repeats, _tell))
    left = iter(forces)
    by_force = tuple(sample if sample.note else replace(sample, error=next(left)) for sample in samples)
    title = f"Long waves over {periods} whirl periods at resonance"
    sections, remarks = [], []
    for name, found, target in (("profile", samples, 1e-2), ("force", by_force, 2e-3)):
        text = f"error of the {name}"
        file = f"benchmark_layer_{name}"
        sections.append(Section(file, f"{title}: {name}", text, found, _named(missing, "layers"), target))
        remarks += _equal_error(found, text)
    return sections, remarks


def _of(
    here: list[ModuleType], problem: str, runs: Callable[[ModuleType], list[Contestant]]
) -> list[Contestant]:
    return [program for module in here if hasattr(module, problem) for program in runs(module)]


def _named(missing: list[ModuleType], problem: str) -> tuple[str, ...]:
    return tuple(str(module.CODE) for module in missing if hasattr(module, problem))


def _tell(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def _equal_error(samples: tuple[Sample, ...], name: str) -> list[str]:
    """Ratios of the long-wave runs where both codes have the same error."""
    mine = [sample for sample in samples if sample.code == leblanc_codes.CODE]
    found = []
    for kernel in ("Fortran", "Python"):
        theirs = [sample for sample in samples if sample.setting.startswith(kernel)]
        ratios = ", ".join(f"{ratio:.2g} at {error:.1e}" for error, ratio in at_equal_error(mine, theirs))
        if ratios:
            found.append(f"Long waves, PyClaw's time ({kernel} kernel) over ours at equal {name}: {ratios}.")
    return found


def write(results: Results, directory: Path, sharing: str) -> None:
    """Write `benchmarks.md` and the figures of a run; `sharing` says how the processor was shared."""
    versions = ", ".join(f"{k} {v}" for k, v in results.versions.items())
    text = ["# Results of one run", "", f"On {sharing}. {versions}", ""]
    for section in results.sections:
        picture = save_png(accuracy_figure(section), directory, section.name, section.title)
        text += [markdown(section, leblanc_codes.CODE), f"![{section.title}]({picture.name})", ""]
    text += ["## Single figures", "", *(f"* {line}" for line in [*_figures(results), *results.remarks]), ""]
    for name, rows in (("benchmark_cells", results.over_cells), ("benchmark_speeds", results.over_speeds)):
        title = "Growth with the number of " + " and ".join(dict.fromkeys(row.over for row in rows))
        picture = save_png(growth_figure(rows), directory, name, title)
        text += [f"## {title}", "", growth_markdown(rows), f"![{title}]({picture.name})", ""]
    (directory / "benchmarks.md").write_text("\n".join(text), encoding="utf-8")


def _figures(results: Results) -> list[str]:
    """What has a target."""
    newton = [sample for sample in results.sections[0].samples if sample.setting == "Newton, 128 points"]
    rates = next(curve for curve in results.over_cells if curve.name.endswith("right-hand side"))
    speed = max(n / t / 1e6 for n, t in zip(rates.counts, rates.seconds, strict=True))
    done = "" if results.curve_complete else ", not complete"
    found = [
        f"Steady wave on 128 points: {duration(sample.seconds)}, error {sample.error:.1e}."
        for sample in newton
    ]
    found.append(f"Response at 201 whirl speeds: {duration(results.curve)}{done}.")
    found.append(f"Right-hand side of the long waves: up to {speed:.3g} million cells a second.")
    first = ", ".join(f"{name} {duration(t)}" for name, t in results.first.items())
    found.append(f"First long-wave run of a process: {first}.")
    return found


if __name__ == "__main__":
    results = kept_results()
    accuracy = {section.name: partial(accuracy_figure, section) for section in results.sections}
    cells, speeds = partial(growth_figure, results.over_cells), partial(growth_figure, results.over_speeds)
    launch(shown(**accuracy, benchmark_cells=cells, benchmark_speeds=speeds))
