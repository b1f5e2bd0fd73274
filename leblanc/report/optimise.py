"""The report of `optimise`: the best volumes, what they keep to, what else could be had."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from leblanc.report.page import About, models, notes, why, write_page
from leblanc.report.parts import Cell, Table, picture, table
from leblanc.report.run import checks as response_checks
from leblanc.results.choice import ModelSpan, model_spans
from leblanc.results.response import RunResult
from leblanc.studies.choose import choose
from leblanc.studies.optimise.answers import FilledMachine, with_volumes
from leblanc.studies.optimise.optimise import OptimumRecord
from leblanc.studies.run import run_scene
from leblanc.text.numbers import number
from leblanc.text.optimum import shown
from leblanc.units import ML, MM, RPM
from solvers.synchronous.models import MODEL_NAMES

if TYPE_CHECKING:
    from leblanc.figures.page import FigureFiles
    from leblanc.scene.scene import Scene

LISTED = 12  # points of the front
ASKED = "the scene asks for it; "
ONE_MODEL = (
    "The search takes one model for all volumes, the exact equilibrium unless the scene names another: a "
    "change of model within its tolerance would look like a better volume."
)
RUN_UP = "The objective itself is judged by run-ups in time with this model."


def filled(record: OptimumRecord) -> Scene | None:
    """The scene with the best volumes and the model of the search; None where that gives no steady answer."""
    scene = FilledMachine(record.scene).scene
    if scene.model.liquid not in MODEL_NAMES:
        return None
    return with_volumes(scene, record.volume)


def reasons(record: OptimumRecord, scene: Scene) -> list[ModelSpan]:
    """The model of the search at the scene's speeds, and why.

    Parameters
    ----------
    record : the optimum
    scene : with its volumes and the model of the search, which need not be what the user's scene asks for
    """
    spans = model_spans(choose(scene), scene.speed_array())
    if record.scene.model.liquid != "auto":
        return list(spans)
    return [replace(one, reason=one.reason.removeprefix(ASKED)) for one in spans]


def values(record: OptimumRecord) -> Table:
    """The objective, and the vibration where that is another, with the best volumes and without liquid."""
    rows = [_value("Objective", record.value, record.baseline, record.unit)]
    if record.unit == "kg":
        rows.append(_value("Vibration", record.vibration, record.vibration_baseline, "m"))
    return table("", ("", "best volumes", "no liquid", "ratio"), rows)


def _value(label: str, value: float, baseline: float, unit: str) -> tuple[str, str, str, str]:
    comparable = baseline > 0.0 and math.isfinite(value) and math.isfinite(baseline)
    ratio = number(value / baseline) if comparable else ""
    return label, shown(value, unit), shown(baseline, unit), ratio


def volumes(record: OptimumRecord) -> Table:
    """The answer chamber by chamber, with the closed forms at the deflection it has."""
    rows = []
    for k, (fill, volume) in enumerate(zip(record.scene.fills, record.volume.tolist(), strict=True)):
        row = [
            f"{k + 1}",
            number(volume * ML),
            fill.liquid.name,
            number(100.0 * volume / fill.chamber.capacity),
        ]
        if record.covering:
            form = record.covering[k]
            full = number(form.full_volume * ML) if math.isfinite(form.full_volume) else "never"
            row += [
                number(form.deflection * MM),
                number(form.optimal_volume * ML),
                number(100.0 * form.share),
                full,
            ]
        rows.append(row)
    head = ["Chamber", "best volume (ml)", "liquid", "% of what it holds"]
    if record.covering:
        head += ["deflection (mm)", "just covers the wall (ml)", "% of the effect", "wet to the lid (ml)"]
    return table("", head, rows)


def facts(record: OptimumRecord) -> list[tuple[str, str]]:
    """What else a reader wants to know: label and value.

    Parameters
    ----------
    record : the optimum
    """
    return [
        ("Working speed", f"{number(record.working_speed * RPM)} rpm"),
        ("Mass of the liquid", f"{number(record.mass * 1e3)} g"),
        ("Stability margin at the operating speeds", f"{number(-record.growth)} 1/s"),
        ("Sets of volumes judged", f"{record.evaluations}"),
    ]


def constraints(record: OptimumRecord) -> Table:
    """What the volumes must keep to."""
    rows = []
    for name, one in record.constraints.items():
        verdict = Cell("kept" if one.satisfied else "exceeded", warning=not one.satisfied)
        what = f"{name.replace('_', ' ')}: {one.text}"
        rows.append((what, shown(one.value, one.unit), shown(one.limit, one.unit), verdict))
    return table("", ("Constraint", "value", "at most", "verdict"), rows)


def front(record: OptimumRecord) -> Table:
    """A few points of which none is better than another in everything, by rising mass."""
    edge = record.front
    if edge is None or edge.mass.size == 0:
        return table("", (), ())
    chosen = np.flatnonzero((edge.volume == record.volume).all(axis=1)).tolist()
    spread = np.linspace(0, edge.mass.size - 1, LISTED).round().astype(int)
    kept = np.unique(np.concatenate((spread, np.array(chosen, dtype=int)))).tolist()
    rows = [
        (
            f"{number(float(edge.mass[k]) * 1e3)}{' (chosen)' if k in chosen else ''}",
            ", ".join(number(one * ML) for one in edge.volume[k].tolist()),
            number(float(edge.vibration[k]) * MM),
            number(float(edge.margin[k])),
        )
        for k in kept
    ]
    of = f"Liquid (g), {len(kept)} of {edge.mass.size} points"
    return table("", (of, "volumes (ml)", "vibration (mm)", "stability margin (1/s)"), rows)


def checks(record: OptimumRecord, response: RunResult | None) -> Table:
    """Where the answer is not what it seems: the volumes by themselves, and the machine with them."""
    exceeded = [name.replace("_", " ") for name, one in record.constraints.items() if not one.satisfied]
    growing = record.growth > 0.0
    lost = math.isnan(record.growth)
    rows: list[Sequence[str | Cell]] = [
        ("Constraints exceeded", Cell(", ".join(exceeded) or "none", warning=not record.feasible)),
        (
            "A small whirl grows when operating",
            Cell("not found" if lost else "yes" if growing else "no", warning=growing or lost),
        ),
    ]
    if response is not None:
        rows += response_checks(response).rows
    return table("", ("Limits of the answer", "with the best volumes, at"), rows)


def write_optimise_report(
    record: OptimumRecord, what: About, figures: Sequence[FigureFiles], path: Path
) -> None:
    """Write the report.

    Parameters
    ----------
    record : the optimum
    what : it is about
    figures : of it
    path : the file to write or replace
    """
    scene = filled(record)
    response = None if scene is None else run_scene(scene)
    spans: Sequence[ModelSpan] = ()
    if scene is not None:
        spans = reasons(record, scene)
    in_time = record.objective == "peak" and record.scene.runup is not None and not record.aim.steady
    names = [span.model for span in spans] + (["long_wave"] if in_time else [])
    best = ", ".join(number(one * ML) for one in record.volume.tolist())
    alts = {
        "objective": f"Vibration over the volumes that were tried; the best, {best} ml, gives "
        f"{number(record.vibration * MM)} mm, no liquid {number(record.vibration_baseline * MM)} mm.",
        "front": "Vibration over the mass of liquid for the points that no other beats, with their stability "
        "margins, as in the table.",
    }
    paste = ", ".join(f'"{volume * ML:.6g} ml"' for volume in record.volume.tolist())
    parts = {
        "title": "Best volume of liquid",
        "machine": f"Objective {record.objective}: the {record.meaning}.",
        "values": values(record),
        "facts": table("", (), facts(record)),
        "volumes": volumes(record),
        "constraints": constraints(record),
        "front": front(record),
        "checks": checks(record, response),
        "paste": paste,
        "pictures": [picture(one, alts.get(one.name, "")) for one in figures],
        "why": why(spans) if spans else None,
        "models": models(names),
        "reason": f"{ONE_MODEL} {RUN_UP if in_time else ''}".strip(),
        "remarks": notes(record.notes),
    }
    write_page("optimise", what, parts, path)
