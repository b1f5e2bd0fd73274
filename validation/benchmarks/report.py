"""All benchmarks in one run, and what is written of them."""

from __future__ import annotations

import importlib
import logging
import platform
import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from types import ModuleType

from validation.benchmarks import growth, layers, ours
from validation.benchmarks.problems import WANTED, distance, steady_problem, travelling_problem
from validation.benchmarks.table import Section, at_equal_error, duration, growth_markdown, markdown
from validation.benchmarks.timing import Answer, Contestant, Sample, measure, version

_MODULE = "validation.benchmarks.peer_"
# Cells of the long-wave runs, of the slow Python kernel, and of the reference.
_CELLS, _SLOW, _REFERENCE = (64, 96, 128, 192, 256, 384, 512), (128,), 2048
_QUICK_CELLS, _QUICK_REFERENCE = (32, 64), 128
_PERIODS, _SETTLED, _QUICK_PERIODS = 100, 40, 4
_TURNS, _QUICK_TURNS = 10.0, 1.0


@dataclass(frozen=True)
class Results:
    """One run of the benchmarks.

    Parameters
    ----------
    versions : of the codes, "not installed" where one is missing
    sections : problems with everybody's samples
    over_cells, over_speeds : growth of the cost
    curve : time of the response at 201 speeds, s
    curve_complete : whether it was followed from end to end
    first : times of the first calls, s
    remarks : ratios and checks in words
    """

    versions: dict[str, str]
    sections: list[Section]
    over_cells: list[growth.Growth]
    over_speeds: list[growth.Growth]
    curve: float
    curve_complete: bool
    first: dict[str, float]
    remarks: list[str]


def collect(peers: tuple[str, ...], quick: bool, repeats: int) -> Results:
    """Run everything.

    Parameters
    ----------
    peers : names of the other codes to run beside
    quick : few settings and small sizes
    repeats : of each sample
    """
    modules = {name: importlib.import_module(_MODULE + name) for name in peers}
    found = {name: version(module.PACKAGE) for name, module in modules.items()}
    versions = {"Python": platform.python_version(), ours.CODE: version(ours.CODE) or "from its folder"}
    versions |= {modules[name].CODE: found[name] or "not installed" for name in peers}
    here = [module for name, module in modules.items() if found[name]]
    missing = [module for name, module in modules.items() if not found[name]]
    # Codes that tell what they do on the terminal.
    logging.disable(logging.WARNING)
    try:
        steady = [_steady(here, missing, quick, repeats, tall) for tall in (False, True)]
        travelling = _travelling(here, missing, quick, repeats)
        layers_found, remarks = _layers(here, missing, quick, repeats)
    finally:
        logging.disable(logging.NOTSET)
    seconds, complete = growth.curve_time()
    return Results(
        versions=versions,
        sections=[*steady, travelling, *layers_found],
        over_cells=growth.over_cells(quick),
        over_speeds=growth.over_speeds(quick),
        curve=seconds,
        curve_complete=complete,
        first=growth.first_calls(),
        remarks=remarks,
    )


def _steady(
    here: list[ModuleType], missing: list[ModuleType], quick: bool, repeats: int, tall: bool
) -> Section:
    problem = steady_problem(tall)
    runs = ours.steady(problem, quick) + _of(here, "steady", lambda module: module.steady(problem, quick))
    kind = "weakly" if tall else "strongly"
    return Section(
        name=f"benchmark_steady_{kind}_damped",
        title=f"Steady wave, {kind} damped: from rest over {problem.time:g} s, or by Newton's method",
        error="error (L2)",
        samples=tuple(measure(runs, lambda answer: distance(answer, problem.exact), repeats, _tell)),
        missing=_named(missing, "steady"),
        target=WANTED,
    )


def _travelling(here: list[ModuleType], missing: list[ModuleType], quick: bool, repeats: int) -> Section:
    turns = _QUICK_TURNS if quick else _TURNS
    problem = travelling_problem(turns)
    runs = ours.travelling(problem, quick) + _of(here, "travelling", lambda m: m.travelling(problem, quick))
    return Section(
        name="benchmark_travelling",
        title=f"Cnoidal wave of the KdV equation after {turns:g} turns",
        error="error (L2)",
        samples=tuple(measure(runs, lambda answer: distance(answer, problem.exact), repeats, _tell)),
        missing=_named(missing, "travelling"),
        target=1e-3,
    )


def _layers(
    here: list[ModuleType], missing: list[ModuleType], quick: bool, repeats: int
) -> tuple[list[Section], list[str]]:
    periods, cells = (_QUICK_PERIODS, _QUICK_CELLS) if quick else (_PERIODS, _CELLS)
    problem = layers.LayerProblem(periods)
    # The layer has settled long before the end: the reference need not run so far.
    fine = layers.LayerProblem(periods if quick else _SETTLED)
    reference = layers.answer(fine, _QUICK_REFERENCE if quick else _REFERENCE)
    runs = layers.ours(problem, cells) + _of(
        here, "layers", lambda m: m.layers(problem, cells, () if quick else _SLOW)
    )
    forces: list[float] = []

    def error(found: Answer) -> float:
        forces.append(layers.force_error(found, reference))
        return layers.profile_error(found, reference)

    samples = tuple(measure(runs, error, repeats, _tell))
    left = iter(forces)
    by_force = tuple(one if one.note else replace(one, error=next(left)) for one in samples)
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
    return [one for module in here if hasattr(module, problem) for one in runs(module)]


def _named(missing: list[ModuleType], problem: str) -> tuple[str, ...]:
    return tuple(str(module.CODE) for module in missing if hasattr(module, problem))


def _tell(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def _equal_error(samples: tuple[Sample, ...], name: str) -> list[str]:
    """Ratios of the long-wave runs where both codes have the same error."""
    mine = [one for one in samples if one.code == ours.CODE]
    found = []
    for kernel in ("Fortran", "Python"):
        theirs = [one for one in samples if one.setting.startswith(kernel)]
        ratios = ", ".join(f"{ratio:.2g} at {error:.1e}" for error, ratio in at_equal_error(mine, theirs))
        if ratios:
            found.append(f"Long waves, PyClaw's time ({kernel} kernel) over ours at equal {name}: {ratios}.")
    return found


def write(results: Results, directory: Path, held: str) -> None:
    """Tables and figures of a run.

    Parameters
    ----------
    results : of `collect`
    directory : where `benchmarks.md` and the figures go
    held : how the processor was shared, in words
    """
    from validation.benchmarks.plots import accuracy_figure, growth_figure

    text = [
        "# Results of one run",
        "",
        f"On {held}. " + ", ".join(f"{k} {v}" for k, v in results.versions.items()),
        "",
    ]
    for section in results.sections:
        picture = accuracy_figure(section, directory)
        text += [markdown(section, ours.CODE), f"![{section.title}]({picture.name})", ""]
    text += ["## Single figures", "", *(f"* {one}" for one in [*_figures(results), *results.remarks]), ""]
    for name, rows in (("benchmark_cells", results.over_cells), ("benchmark_speeds", results.over_speeds)):
        picture = growth_figure(rows, name, directory)
        title = "Growth with the number of " + " and ".join(dict.fromkeys(one.over for one in rows))
        text += [f"## {title}", "", growth_markdown(rows), f"![{title}]({picture.name})", ""]
    (directory / "benchmarks.md").write_text("\n".join(text), encoding="utf-8")


def _figures(results: Results) -> list[str]:
    """What has a target."""
    newton = [one for one in results.sections[0].samples if one.setting == "Newton, 128 points"]
    rates = next(one for one in results.over_cells if one.name.endswith("right-hand side"))
    speed = max(n / t / 1e6 for n, t in zip(rates.counts, rates.seconds, strict=True))
    done = "" if results.curve_complete else ", not complete"
    found = [f"Steady wave on 128 points: {duration(one.seconds)}, error {one.error:.1e}." for one in newton]
    found.append(f"Response at 201 whirl speeds: {duration(results.curve)}{done}.")
    found.append(f"Right-hand side of the long waves: up to {speed:.3g} million cells a second.")
    first = ", ".join(f"{name} {duration(t)}" for name, t in results.first.items())
    found.append(f"First long-wave run of a process: {first}.")
    return found
