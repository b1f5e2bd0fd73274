"""The report of `runup`: amplitude on the way, where the energy went, how far the run can be trusted."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from leblanc.core.blocks import Cell
from leblanc.core.notes import one_line, percent
from leblanc.core.page import About, picture, render
from leblanc.core.units import (
    LENGTH,
    MASS,
    MINUS,
    MOST_RANGES,
    RPM,
    in_peak,
    number,
    rpm_bands,
    rpm_range,
    unit_for,
    with_unit,
)
from leblanc.report.page import models, notes
from leblanc.report.parts import Table, doubt, table
from leblanc.results.notes.runup import ERROR, IN_TABLES
from leblanc.results.runup import RunupResult
from leblanc.studies.loads.answer import load_table
from leblanc.studies.run.answer import peak
from leblanc.studies.run.notes import CLOSURE
from leblanc.text.runup import answer, ball_rows, describe_model, largest_dry, rounding
from leblanc.text.runup import moments as main_moments

if TYPE_CHECKING:
    from leblanc.figures.drawing.page import FigureFiles

DRY = 1e-3  # of the layer's mean depth: a wall with less on it counts as dry
MASS_CHANGE = 1e-6  # relative change of a layer's volume to speak of
CURVE = "runup_speed"  # the figure above all tables
BALANCE = "runup_energy"  # the figure beside the table of the energy
TERMS = {
    "unbalance": "work of the unbalance",
    "drive": "work of the drive on the liquid",
    "gravity": "work of gravity",
    "captured": "brought in by capture",
    "support": "heat in the supports",
    "friction": "heat by wall friction",
    "bores": "loss in bores",
    "baffles": "loss at baffles",
    "profile": "missed by the flow's profile",
    "change": "left in rotor and liquid",
}
GAINS = ("unbalance", "drive", "gravity", "captured")


def times(time: NDArray[np.float64], mask: NDArray[np.bool_]) -> str:
    """Times at which a condition holds, in words."""
    if not mask.any():
        return "none"
    if mask.all():
        return "all the time"
    change = np.flatnonzero(np.diff(np.concatenate(([False], mask, [False]))))
    first, last = time[change[::2]], time[change[1::2] - 1]
    if first.size > MOST_RANGES:
        return f"{first.size} times between {first[0]:.3g} and {last[-1]:.3g} s"
    pairs = zip(first.tolist(), last.tolist(), strict=True)
    ends = [(f"{a:.3g}", f"{b:.3g}") for a, b in pairs]
    return "; ".join(f"{a} s" if a == b else f"{a} to {b} s" for a, b in ends)


def moments(result: RunupResult) -> Table:
    """Largest amplitude on the way up and down, that of the steady response, and the end."""
    found = [
        (label, moment.amplitude, moment.speed, number(moment.time)) for label, moment in main_moments(result)
    ]
    bare = result.peak_dry
    if largest_dry(result):
        found.insert(1, (result.without.capitalize(), bare["amplitude"], bare["speed"], number(bare["time"])))
    highest = None if result.steady is None else peak(result.steady.deflection)
    if result.steady is not None and highest is not None:
        size = float(abs(result.steady.deflection[highest]))
        found.append(("Largest of the steady response", size, float(result.steady.speed[highest]), ""))
    unit = unit_for(LENGTH, *(size for _, size, _, _ in found))
    rows = [(label, unit.number(size), number(speed * RPM), time) for label, size, speed, time in found]
    return table("", ("", f"amplitude ({in_peak(unit.name)})", "at (rpm)", "after (s)"), rows)


def passages(result: RunupResult) -> Table:
    """The steps of a programme with the largest amplitude of each; no rows for a run-up."""
    unit = unit_for(LENGTH, *(passage.amplitude for passage in result.passages))
    head = (
        "Step",
        "",
        "ends after (s)",
        f"largest amplitude ({in_peak(unit.name)})",
        "at (rpm)",
        result.without,
    )
    rows = [
        (
            f"{passage.step}",
            passage.text,
            number(passage.end),
            unit.number(passage.amplitude),
            number(passage.speed * RPM),
            unit.number(passage.amplitude_dry),
        )
        for passage in result.passages
    ]
    return table("", head, rows)


def facts(result: RunupResult) -> list[tuple[str, str]]:
    """The end of the run, its resolution and its errors: label and value."""
    mass = float(result.layer_mass.sum())
    where = "none"
    if mass > 0.0:
        place = result.liquid_position[-1]
        angle = number(math.degrees(math.atan2(place.imag, place.real)))
        where = f"{with_unit(abs(place), LENGTH)} off the axis at {angle} deg"
    liquid = [("Mass of the liquid", with_unit(mass, MASS)), ("Its centre of mass at the end", where)]
    return [
        *ball_rows(result),
        *([] if result.chamberless else liquid),
        ("Phase of the deflection at the end", f"{number(math.degrees(float(result.phase[-1])))} deg"),
        ("Resolution", f"{result.cells} cells, {result.steps} steps, {result.time.size} samples kept"),
        ("Error by half the cells, of the largest", _share(result.error_estimate)),
        ("Error of model and steps", _share(result.model_error)),
        *([] if result.spread is None else [("By rounding alone", rounding(result))]),
        ("Energy not accounted for, of the work", _share(result.energy.closure)),
        *([] if result.chamberless else [("Largest change of a layer's mass", _share(result.mass_error))]),
    ]


def _share(value: float) -> str:
    return "not known" if math.isnan(value) else f"{number(100.0 * value)} %"


def energy(result: RunupResult) -> Table:
    """The balance of energy, and each term over the work that the closure is measured by."""
    audit = result.energy
    values = asdict(audit)
    work = audit.scale

    def row(label: str, value: float) -> tuple[str, str, str]:
        return label, number(value), number(100.0 * value / work) if work > 0.0 else ""

    rows = [
        row(("+ " if name in GAINS else f"{MINUS} ") + text, values[name])
        for name, text in TERMS.items()
        if name != "baffles" or audit.baffles != 0.0
    ]
    rows.append(row("= not accounted for", audit.remainder))
    if audit.motor != 0.0:
        who = "drag on the coasting drum" if result.passages else "the motor"
        rows.append((f"besides, work of {who}", number(audit.motor), ""))
    return table("", ("Energy", "J", "% of the work"), rows)


def checks(result: RunupResult) -> Table:
    """Where the run is not what it seems, each with the times or the size, those marked."""
    history, faults = result.history, "; ".join(result.faults)
    found = [
        ("Stopped before its end", one_line(history.reason) or "no", not history.converged),
        ("Energy or deflection not physical", one_line(faults) or "no", bool(faults)),
    ]
    if not result.chamberless:
        loose = ~result.in_range
        found.append(("Liquid model out of range", times(result.time, loose), bool(loose.any())))
    for k, chamber in enumerate(result.chambers):
        if chamber.volume == 0.0:
            continue
        name = "Liquid" if len(result.chambers) == 1 else f"Liquid of chamber {k + 1}"
        loose, depth = ~result.captured[:, k], chamber.radius - chamber.mean_surface_radius
        found.append((f"{name} not carried round", times(result.time, loose), bool(loose.any())))
        dry = ~loose & (np.nan_to_num(result.depth_min[:, k], nan=math.inf) <= DRY * depth)
        found.append((f"{name} leaves a wall dry", times(result.time, dry), bool(dry.any())))
    bands = "not examined" if result.bands is None else rpm_bands(result.bands) or "none"
    rough = not result.error_estimate <= ERROR
    mass = _size(f"Mass changed above {number(100.0 * MASS_CHANGE)} %", result.mass_error, MASS_CHANGE)
    return table(
        "",
        ("Limits of the answer", ""),
        [(label, Cell(text, warning=bad)) for label, text, bad in found]
        + [
            ("Self-excited whirl, linear theory", Cell(bands, warning=bool(result.bands))),
            (
                f"Error above {number(100.0 * ERROR)} % or unknown",
                Cell(_share(result.error_estimate) if rough else "no", warning=rough),
            ),
            _size(f"Energy lost above {number(100.0 * CLOSURE)} %", result.energy_error, CLOSURE),
            *([] if result.chamberless else [mass]),
        ],
    )


def _size(label: str, value: float, most: float) -> tuple[str, Cell]:
    """A size that should stay below a limit."""
    bad = not value <= most
    return label, Cell(_share(value) if bad else "no", warning=bad)


def events(result: RunupResult) -> Table:
    """When liquid began and ceased to ride with the drum."""
    rows = [
        (
            number(each.time),
            number(each.speed * RPM),
            f"chamber {each.chamber + 1}: {'captured' if each.captured else 'falls back'}",
        )
        for each in result.transfers
    ]
    return table("", ("Time (s)", "speed (rpm)", "liquid"), rows[:12])


def why(result: RunupResult) -> Table:
    """The liquid model of the run, its error and the reason for it."""
    span = rpm_range(float(result.speed.min()), float(result.speed.max())).removesuffix(" rpm")
    error = "not known" if math.isnan(result.model_error) else percent(result.model_error)
    resolved = result.cells, result.dispersion, result.bore
    text, taken = one_line(result.model_reason), describe_model(result.model, *resolved)
    reason = f"{text[:1].upper()}{text[1:]} Taken as {taken}."
    head = ("Speeds (rpm)", "Model", "Estimated error", "Why")
    return table("", head, [(span, result.model, error, reason)], sentences=True)


def write_runup_report(result: RunupResult, what: About, figures: Sequence[FigureFiles], path: Path) -> None:
    """Write the report."""
    balls = sum(race.count for race in result.races)
    rolling = f", {balls} ball{'' if balls == 1 else 's'} in {len(result.races)} race"
    rolling = f"{rolling}{'' if len(result.races) == 1 else 's'}" if balls else ""
    count, low, high = len(result.chambers), float(result.speed[0]) * RPM, float(result.speed.max()) * RPM
    back = " and back" if result.turns_back else ""
    if result.passages:
        back = f" and to {number(float(result.speed[-1]) * RPM)} rpm in {len(result.passages)} steps"
    machine = (
        f"A rotor with a {result.axis} axis and {count} chamber{'' if count == 1 else 's'}{rolling} goes "
        f"from {number(low)} to {number(high)} rpm{back}, {number(float(result.time[-1]))} s in all."
    )
    parts = {
        "title": "Run-up in time",
        "answer": answer(result),
        "doubt": doubt(checks(result)),
        "machine": machine,
        "moments": moments(result),
        "passages": passages(result),
        "loads": result.loads and load_table(result.loads),
        "facts": table("", (), facts(result)),
        "energy": energy(result),
        "checks": checks(result),
        "events": events(result),
        "balance": [picture(files) for files in figures if files.name == BALANCE],
        "curve": [picture(files) for files in figures if files.name == CURVE],
        "pictures": [picture(files) for files in figures if files.name not in (CURVE, BALANCE)],
        "why": None if result.chamberless else why(result),
        "models": [] if result.chamberless else models((result.model,)),
        "remarks": notes([note.text for note in result.notes if note.code not in IN_TABLES]),
    }
    render("runup", what, parts, path, "leblanc.report")
