"""The reports of `run`: answer, where it holds, figures, models and why."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from leblanc.core.blocks import Cell
from leblanc.core.page import About, picture, render
from leblanc.core.units import LENGTH, NOT_FOUND, RPM, in_peak, number, ranges, unit_for
from leblanc.report.page import models, notes, why
from leblanc.report.parts import Table, doubt, load_part, table
from leblanc.results.races.states import STATE_NAMES, BallsResult
from leblanc.studies.run.answer import RunResult
from leblanc.studies.run.notes import OF_MODELS, RunCode
from leblanc.studies.run.words import (
    Limit,
    answer,
    comparison_table,
    facts,
    largest_error,
    limits,
    machine,
    remarks,
)
from leblanc.text.closed_forms import HEAD as VECTOR
from leblanc.text.closed_forms import closed_form_rows, vector_rows
from leblanc.text.races.balls import answer as balls_answer
from leblanc.text.races.balls import facts as balls_facts
from leblanc.text.races.balls import limits as balls_limits
from meshes.arrays import Array, Flags, Index

if TYPE_CHECKING:
    from leblanc.figures.drawing.page import FigureFiles


SHOWN = 4  # figures, of which the phase stands in its own file only; with more, all


def response_checks(result: RunResult) -> Table:
    """Where the answer is not what it seems, as a table."""
    rows = [(limit.label, Cell(limit.where, warning=limit.failed)) for limit in limits(result)]
    return table("", ("Limits of the answer", "at"), rows)


def write_run_report(result: RunResult, what: About, figures: Sequence[FigureFiles], path: Path) -> None:
    """Write the report: one page for a simple machine.

    Parameters
    ----------
    result : the response
    what : it is about
    figures : in the order of the page
    path : the file to write or replace
    """
    few = len(figures) <= SHOWN and not result.chamberless
    shown = [figure for figure in figures if not few or figure.name != "phase"]
    elsewhere = (*(OF_MODELS if result.models else ()), RunCode.HELD)
    error = largest_error(result)
    parts = {
        "title": "Response to the unbalance over speed",
        "machine": machine(result),
        "answer": answer(result),
        "doubt": doubt(response_checks(result), f"estimated error {error}" if error else ""),
        "comparisons": table("", *comparison_table(result)),
        "loads": load_part(result.loads),
        "facts": table("", (), facts(result)),
        "closed_forms": closed_form_tables(result),
        "checks": response_checks(result),
        "pictures": [picture(files) for files in shown],
        "why": why(result.models) if result.models else None if result.chamberless else _used(result),
        "models": [] if result.chamberless else models(result.models_used, result.held is not None),
        "held": held_motions(result),
        "remarks": [*notes(result.notes, elsewhere), *remarks(result)],
    }
    render("run", what, parts, path, "leblanc.report")


def closed_form_tables(result: RunResult | BallsResult) -> list[Table]:
    """What closed forms say beside the answer, and the angles of the vector model at some speeds."""
    forms = result.closed_forms
    if forms is None or not (rows := closed_form_rows(forms)):
        return []
    found = [table("", (), [(label.strip().capitalize(), text) for label, text in rows])]
    if forms.vector is not None:
        found.append(table("", VECTOR, vector_rows(result.speed, forms.vector)))
    return found


def held_motions(result: RunResult) -> list[Table]:
    """Limit cycles by ranges of speed, and where the way down differs; nothing where no motion was held."""
    held = result.held
    if held is None:
        return []
    mean, least, largest = result.amplitude, result.amplitude_min, result.amplitude_max
    unit, tables = unit_for(LENGTH, *mean[held.at].tolist()), []

    def size(values: Array) -> str:
        return _extent(values * unit.count)

    cycles = [
        (
            *(_extent(result.speed[part] * RPM), size(mean[part])),
            *(unit.number(float(least[part].min())), unit.number(float(largest[part].max()))),
            _extent(held.whirl_speed[part] * RPM),
        )
        for part in _runs(result.speed, held.limit_cycle)
    ]
    if cycles:
        sizes = (f"{name} ({in_peak(unit.name)})" for name in ("mean amplitude", "least", "largest"))
        tables.append(table("", ("Limit cycles (rpm)", *sizes, "whirl speed (rpm)"), cycles))

    def motion(states: NDArray[np.str_], values: Array) -> str:
        return f"{', '.join(dict.fromkeys(states.tolist()))}, {size(values)}".replace("_", " ")

    apart = [
        (
            _extent(result.speed[part] * RPM),
            motion(held.state[part], mean[part]),
            motion(held.state_down[part], held.amplitude_down[part]),
        )
        for part in _runs(result.speed, held.hysteresis)
    ]
    if apart:
        ways = (f"{way} speed: motion, amplitude ({in_peak(unit.name)})" for way in ("rising", "falling"))
        tables.append(table("", ("Up and down differ (rpm)", *ways), apart))
    return tables


def _runs(speed: Array, mask: Flags) -> list[Index]:
    """Neighbouring speeds at which a condition holds, each run by rising speed."""
    order = np.argsort(speed, kind="stable")
    holds = np.flatnonzero(mask[order])
    return [order[run] for run in np.split(holds, np.flatnonzero(np.diff(holds) > 1) + 1) if run.size]


def _extent(values: Array) -> str:
    """Least and largest of some values; one where they print alike."""
    known = values[np.isfinite(values)]
    if not known.size:
        return NOT_FOUND
    ends = number(float(known.min())), number(float(known.max()))
    return ends[0] if ends[0] == ends[1] else " to ".join(ends)


def _used(result: RunResult) -> Table:
    """The models and their speeds, where no reasons are known."""
    rows = [(name, ranges(result.speed, result.model == name)) for name in result.models_used]
    return table("", ("Model", "Speeds"), rows, True)


def limit_checks(found: Iterable[Limit]) -> Table:
    """Where an answer of a rotor without layers is not what it seems."""
    rows = [(limit.label, Cell(limit.where, warning=limit.failed)) for limit in found]
    return table("", ("Limits of the answer", "at"), rows)


def ball_states(result: BallsResult) -> Table:
    """All states found at a few speeds spread over those of the scene."""
    wanted = np.unique(np.linspace(0, result.speed.size - 1, 6).astype(int)).tolist()
    unit = unit_for(LENGTH, *(size for k in wanted for size in result.sizes[k] if np.isfinite(size)))
    rows = []
    for k in wanted:
        for j in np.flatnonzero(result.states.kind[k]).tolist():
            stable, growth = bool(result.states.stable[k, j]), float(result.states.growth[k, j])
            name = STATE_NAMES[int(result.states.kind[k, j])]
            size = unit.number(float(result.sizes[k, j]))
            rows.append(
                (number(result.speed[k] * RPM), name, size, "yes" if stable else "no", number(growth))
            )
    head = ("Speed (rpm)", "balls", f"amplitude ({in_peak(unit.name)})", "stable", "growth (1/s)")
    return table("States", head, rows)


def write_balls_report(result: BallsResult, what: About, figures: Sequence[FigureFiles], path: Path) -> None:
    """Write the report.

    Parameters
    ----------
    result : the answer
    what : it is about
    figures : of it
    path : the file to write or replace
    """
    low, high = number(float(result.speed[0]) * RPM), number(float(result.speed[-1]) * RPM)
    count = sum(race.count for race in result.races)
    model = (
        "Balls that roll or slide in races on a rotor with all its coordinates: states in which they rest in "
        "the drum, found from starts of many kinds, and the roots of small motions about each."
    )
    parts = {
        "title": "Balls at rest in the drum",
        "machine": f"A rotor with {count} ball{'' if count == 1 else 's'} in {len(result.races)} "
        f"race{'' if len(result.races) == 1 else 's'}, from {low} to {high} rpm in {result.speed.size} "
        "speeds.",
        "answer": balls_answer(result),
        "doubt": doubt(limit_checks(balls_limits(result))),
        "facts": table("", (), balls_facts(result)),
        "states": ball_states(result),
        "loads": load_part(result.loads),
        "closed_forms": closed_form_tables(result),
        "checks": limit_checks(balls_limits(result)),
        "pictures": [picture(figure) for figure in figures],
        "models": [("balls", model)],
        "remarks": [note.text for note in result.notes],
    }
    render("balls", what, parts, path, "leblanc.report")
