"""The report of `optimise`: the best volumes, what they keep to, what else could be had."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from leblanc.core.blocks import Cell
from leblanc.core.notes import texts
from leblanc.core.page import About, picture, render
from leblanc.core.units import LENGTH, MASS, ML, VOLUME, in_rpm, number, unit_for, with_unit
from leblanc.report.page import models, notes, why
from leblanc.report.parts import Table, doubt, table
from leblanc.results.optimum import OptimumResult
from leblanc.studies.loads.answer import load_table
from leblanc.studies.run import words
from leblanc.text.optimum import amplitude_plane, answer, over_conditions, quality, shown, worst_condition

if TYPE_CHECKING:
    from leblanc.figures.drawing.page import FigureFiles

LISTED = 12  # points of the front
ONE_MODEL = (
    "The search takes one model for all volumes, the exact equilibrium unless the scene names another: a "
    "change of model within its tolerance would look like a better volume."
)
RUN_UP = "The objective itself is judged by run-ups in time with this model."


def values(result: OptimumResult) -> Table:
    """The objective, and the vibration where that is another, with the best volumes and without liquid."""
    rows = [_value("Objective", result.value, result.baseline, result.unit)]
    if result.unit == "kg":
        rows.append(_value("Vibration", result.vibration, result.vibration_baseline, "m"))
    return table("", ("", "best volumes", "no liquid", "ratio"), rows)


def _value(label: str, value: float, baseline: float, unit: str) -> tuple[str, str, str, str]:
    comparable = baseline > 0.0 and math.isfinite(value) and math.isfinite(baseline)
    ratio = number(value / baseline) if comparable else ""
    return label, shown(value, unit), shown(baseline, unit), ratio


def volumes(result: OptimumResult) -> Table:
    """The answer chamber by chamber, with the closed forms at the deflection it has."""
    rows = []
    liquid = unit_for(VOLUME, *result.volume.tolist(), *(form.optimal_volume for form in result.closed_form))
    length = unit_for(LENGTH, *(form.deflection for form in result.closed_form))
    for k, (chamber, volume) in enumerate(zip(result.chambers, result.volume.tolist(), strict=True)):
        row = [
            f"{k + 1}",
            liquid.number(volume),
            chamber.liquid_name,
            number(100.0 * volume / chamber.capacity),
        ]
        if result.closed_form:
            form = result.closed_form[k]
            full = liquid.number(form.full_volume) if math.isfinite(form.full_volume) else "never"
            row += [
                length.number(form.deflection),
                liquid.number(form.optimal_volume),
                number(100.0 * form.unbalance_share),
                full,
            ]
        rows.append(row)
    head = ["Chamber", f"best volume ({liquid.name})", "liquid", "% of what it holds"]
    if result.closed_form:
        head += [
            f"deflection ({length.name})",
            f"just covers the wall ({liquid.name})",
            "% of the effect",
            f"wet to the lid ({liquid.name})",
        ]
    return table("", head, rows)


def facts(result: OptimumResult) -> list[tuple[str, str]]:
    """What else a reader wants to know: label and value."""
    return [
        ("Working speed", in_rpm(result.working_speed)),
        ("Mass of the liquid", with_unit(result.mass, MASS)),
        ("Stability margin at the operating speeds", f"{number(result.stability_margin)} 1/s"),
        *(() if (said := quality(result)) is None else (said,)),
        ("Sets of volumes judged", f"{result.evaluations}"),
    ]


def conditions(result: OptimumResult) -> Table:
    """Amplitudes over temperature and unbalance, for the objective robust."""
    return table("", (), ()) if result.robust is None else table("", *over_conditions(result.robust))


def constraints(result: OptimumResult) -> Table:
    """What the volumes must keep to."""
    rows = []
    for name, constraint in result.constraints.items():
        verdict = Cell("kept" if constraint.satisfied else "exceeded", warning=not constraint.satisfied)
        what = f"{name.replace('_', ' ')}: {constraint.meaning}"
        rows.append(
            (
                what,
                shown(constraint.value, constraint.unit),
                shown(constraint.limit, constraint.unit),
                verdict,
            )
        )
    return table("", ("Constraint", "value", "at most", "verdict"), rows)


def front(result: OptimumResult) -> Table:
    """A few points of which none is better than another in everything, by rising mass."""
    edge = result.front
    if edge is None or edge.mass.size == 0:
        return table("", (), ())
    chosen = set(np.flatnonzero((edge.volume == result.volume).all(axis=1)).tolist())
    mass = unit_for(MASS, *edge.mass.tolist())
    liquid = unit_for(VOLUME, *edge.volume.ravel().tolist())
    size = unit_for(LENGTH, *edge.vibration.tolist())
    merged: dict[tuple[str, ...], set[int]] = {}  # points that read alike are told once
    for k in range(edge.mass.size):
        row = (
            mass.number(float(edge.mass[k])),
            ", ".join(liquid.number(volume) for volume in edge.volume[k].tolist()),
            size.number(float(edge.vibration[k])),
            number(float(edge.stability_margin[k])),
        )
        merged.setdefault(row, set()).add(k)
    spread = set(np.linspace(0, len(merged) - 1, LISTED).round().astype(int).tolist())
    rows = [
        (f"{first}{' (chosen)' if own & chosen else ''}", *rest)
        for k, ((first, *rest), own) in enumerate(merged.items())
        if k in spread or own & chosen
    ]
    of = f"Liquid ({mass.name}), {len(rows)} of {len(merged)} points"
    head = (of, f"volumes ({liquid.name})", f"vibration ({size.name})", "stability margin (1/s)")
    return table("", head, rows)


def checks(result: OptimumResult) -> Table:
    """Where the answer is not what it seems: the volumes by themselves, and the machine with them."""
    exceeded = [
        name.replace("_", " ") for name, constraint in result.constraints.items() if not constraint.satisfied
    ]
    growing = result.growth > 0.0
    lost = math.isnan(result.growth)
    rows: list[Sequence[str | Cell]] = [
        ("Constraints exceeded", Cell(", ".join(exceeded) or "none", warning=not result.feasible)),
        (
            "A small whirl grows when operating",
            Cell("not found" if lost else "yes" if growing else "no", warning=growing or lost),
        ),
    ]
    if result.response is not None:
        rows += [
            (one.label, Cell(one.where, warning=bool(one.grade))) for one in words.checks(result.response)
        ]
    return table("", ("Limits of the answer", "with the best volumes, at"), rows)


def write_optimise_report(
    result: OptimumResult, what: About, figures: Sequence[FigureFiles], path: Path
) -> None:
    """Write the report."""
    names = [span.model for span in result.models] + (["long_wave"] if result.in_time else [])
    place = amplitude_plane(result) if result.unit in ("m", "kg", "kg m") else ""
    loads = None if result.response is None else result.response.loads
    paste = ", ".join(f'"{volume * ML:.6g} ml"' for volume in result.volume.tolist())
    parts = {
        "title": "Best volume of liquid",
        "machine": f"Objective {result.objective}: the {result.meaning}{f' {place}' if place else ''}.",
        "answer": answer(result),
        "doubt": doubt(checks(result)),
        "values": values(result),
        "facts": table("", (), facts(result)),
        "volumes": volumes(result),
        "constraints": constraints(result),
        "loads": loads and load_table(loads),
        "front": front(result),
        "conditions": conditions(result),
        "worst": None if result.robust is None else worst_condition(result.robust),
        "checks": checks(result),
        "paste": paste,
        "pictures": [picture(files) for files in figures],
        "why": why(result.models) if result.models else None,
        "models": models(names),
        "reason": f"{ONE_MODEL} {RUN_UP if result.in_time else ''}".strip(),
        "remarks": notes(texts(result.notes)),
    }
    render("optimise", what, parts, path, "leblanc.report")
