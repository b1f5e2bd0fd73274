"""The report of `runup`: amplitude on the way, where the energy went, how far the run can be trusted."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from leblanc.report.page import About, models, notes, write_page
from leblanc.report.parts import Cell, Table, picture, table
from leblanc.results.notes import percent
from leblanc.results.provenance import one_line
from leblanc.results.response import peak
from leblanc.studies.runup import RunupRecord
from leblanc.text.numbers import MOST_RANGES, number
from leblanc.text.runup import CLOSURE, ERROR, model_words, switches
from leblanc.units import MM, RPM

if TYPE_CHECKING:
    from leblanc.figures.page import FigureFiles

DRY = 1e-3  # of the layer's mean depth: a wall with less on it counts as dry
MASS = 1e-6  # relative change of a layer's volume to speak of
# Of notes that the tables say as well.
REPEATED = (
    "Liquid model: ", "With half the cells", "The energy balance leaves", "in the steady response it is",
    "its liquid is captured", "its liquid falls back", "some whirl grows by itself",
)  # fmt: skip
BALANCE = "runup_energy"  # the figure beside the table of the energy
TERMS = {
    "unbalance": "work of the unbalance",
    "drive": "work of the drive on the liquid",
    "gravity": "work of gravity",
    "captured": "brought in by capture",
    "support": "heat in the supports",
    "friction": "heat by wall friction",
    "bores": "loss in bores",
    "profile": "missed by the flow's profile",
    "change": "left in rotor and liquid",
}
GAINS = ("unbalance", "drive", "gravity", "captured")


def times(time: NDArray[np.float64], mask: NDArray[np.bool_]) -> str:
    """Times at which a condition holds, in words.

    Parameters
    ----------
    time : rising, s, shape (k,)
    mask : the condition, shape (k,)
    """
    if not mask.any():
        return "none"
    if mask.all():
        return "all the time"
    change = np.flatnonzero(np.diff(np.concatenate(([False], mask, [False]))))
    first, last = time[change[::2]], time[change[1::2] - 1]
    if first.size > MOST_RANGES:
        return f"{first.size} times between {first[0]:.3g} and {last[-1]:.3g} s"
    pairs = zip(first.tolist(), last.tolist(), strict=True)
    return "; ".join(f"{a:.3g} s" if a == b else f"{a:.3g} to {b:.3g} s" for a, b in pairs)


def moments(record: RunupRecord) -> Table:
    """Largest amplitude on the way up and down, that of the steady response, and the end."""
    h, last = record.history, record.history.time.size - 1
    found = [("Largest on the way up" if record.turning < last else "Largest amplitude", record.peak())]
    if record.turning < last:
        found.append(("Largest on the way down", record.peak(back=True)))
    found.append(("At the end", last))
    rows = [
        (
            label,
            number(float(h.amplitude[k]) * MM),
            number(float(h.speed[k]) * RPM),
            number(float(h.time[k])),
        )
        for label, k in found
    ]
    highest = None if record.steady is None else peak(record.steady.deflection)
    if record.steady is not None and highest is not None:
        size = float(abs(record.steady.deflection[highest]))
        speed = float(record.steady.speed[highest])
        rows.append(("Largest of the steady response", number(size * MM), number(speed * RPM), ""))
    return table("", ("", "amplitude (mm)", "at (rpm)", "after (s)"), rows)


def facts(record: RunupRecord) -> list[tuple[str, str]]:
    """The end of the run, its resolution and its errors: label and value.

    Parameters
    ----------
    record : the run-up
    """
    h, numerics = record.history, record.numerics
    mass = float(h.layer_mass.sum())
    where = "none"
    if mass > 0.0:
        place = h.liquid_position[-1]
        angle = number(math.degrees(math.atan2(place.imag, place.real)))
        where = f"{number(abs(place) * MM)} mm off the axis at {angle} deg"
    return [
        ("Mass of the liquid", f"{number(mass * 1e3)} g"),
        ("Its centre of mass at the end", where),
        ("Phase of the deflection at the end", f"{number(math.degrees(float(record.phase[-1])))} deg"),
        ("Resolution", f"{numerics.cells} cells, {h.steps} steps, {h.time.size} samples kept"),
        ("Error by half the cells, of the largest", _share(h.error_estimate)),
        ("Error of model and steps", _share(record.model_error)),
        ("Energy not accounted for, of the work", _share(h.audit.closure)),
        ("Largest change of a layer's mass", _share(h.mass_error)),
    ]


def _share(value: float) -> str:
    return "not known" if math.isnan(value) else f"{number(100.0 * value)} %"


def energy(record: RunupRecord) -> Table:
    """The balance of energy, and each term over the work that the closure is measured by."""
    audit = record.history.audit
    values = asdict(audit)
    work = max(abs(audit.unbalance), audit.support + audit.friction + audit.bores)

    def row(label: str, value: float) -> tuple[str, str, str]:
        return label, number(value), number(100.0 * value / work) if work > 0.0 else ""

    rows = [
        row(("+ " if name in GAINS else "\N{MINUS SIGN} ") + text, values[name])
        for name, text in TERMS.items()
    ]
    rows.append(row("= not accounted for", audit.remainder))
    if audit.motor != 0.0:
        rows.append(row("of which the motor did", audit.motor))
    return table("", ("Energy", "J", "% of the work"), rows)


def checks(record: RunupRecord) -> Table:
    """Where the run is not what it seems, each with the times or the size, those marked."""
    h = record.history
    reason = "no" if h.converged else one_line(h.reason)
    found = [
        ("Stopped before its end", reason, not h.converged),
        ("Liquid model out of range", times(h.time, ~record.in_range), bool((~record.in_range).any())),
    ]
    for k, chamber in enumerate(record.chambers):
        if chamber.volume == 0.0:
            continue
        name = "Liquid" if len(record.chambers) == 1 else f"Liquid of chamber {k + 1}"
        loose, depth = ~h.captured[:, k], chamber.radius - chamber.mean_surface_radius
        found.append((f"{name} not carried round", times(h.time, loose), bool(loose.any())))
        dry = ~loose & (np.nan_to_num(h.depth_min[:, k], nan=math.inf) <= DRY * depth)
        found.append((f"{name} leaves a wall dry", times(h.time, dry), bool(dry.any())))
    bands = ", ".join(f"{low * RPM:.4g} to {high * RPM:.4g} rpm" for low, high in record.bands)
    rough = not h.error_estimate <= ERROR
    return table(
        "",
        ("Limits of the answer", ""),
        [(label, Cell(text, warning=bad)) for label, text, bad in found]
        + [
            ("Self-excited whirl, linear theory", Cell(bands or "none", warning=bool(bands))),
            (
                f"Error above {number(100.0 * ERROR)} % or unknown",
                Cell(_share(h.error_estimate) if rough else "no", warning=rough),
            ),
            _size(f"Energy lost above {number(100.0 * CLOSURE)} %", h.audit.closure, CLOSURE),
            _size(f"Mass changed above {number(MASS)}", h.mass_error, MASS),
        ],
    )


def _size(label: str, value: float, most: float) -> tuple[str, Cell]:
    """A size that should stay below a limit."""
    bad = not value <= most
    return label, Cell(_share(value) if bad else "no", warning=bad)


def events(record: RunupRecord) -> Table:
    """When liquid began and ceased to ride with the drum."""
    h = record.history
    rows = [
        (
            number(float(h.time[k])),
            number(float(h.speed[k]) * RPM),
            f"chamber {j + 1}: {'captured' if caught else 'falls back'}",
        )
        for k, j, caught in switches(h)
    ]
    return table("", ("Time (s)", "speed (rpm)", "liquid"), rows[:12])


def why(record: RunupRecord) -> Table:
    """The liquid model of the run, its error and the reason for it."""
    h = record.history
    span = f"{number(float(h.speed.min()) * RPM)} to {number(float(h.speed.max()) * RPM)}"
    error = "not known" if math.isnan(record.model_error) else percent(record.model_error)
    text = one_line(record.model_reason)
    reason = f"{text[:1].upper()}{text[1:]} Taken as {model_words(record.model, record.numerics)}."
    head = ("Speeds (rpm)", "Model", "Estimated error", "Why")
    return table("", head, [(span, record.model, error, reason)], words=True)


def write_runup_report(record: RunupRecord, what: About, figures: Sequence[FigureFiles], path: Path) -> None:
    """Write the report.

    Parameters
    ----------
    record : the run-up
    what : it is about
    figures : of it
    path : the file to write or replace
    """
    h = record.history
    largest = moments(record).rows[0]
    at = f"{largest[1].text} mm at {largest[2].text} rpm"
    alts = {
        "runup_speed": f"Curve of the amplitude over speed with the steady branches behind; largest {at}.",
        "runup_time": "Curves over time of speed, amplitude, the place of the liquid and the depth of its "
        f"layers; largest amplitude {at}.",
        BALANCE: "Bars of the work done on rotor and liquid and of where it went, as in the table of "
        "the energy.",
    }
    count, low, high = len(record.chambers), float(h.speed[0]) * RPM, float(h.speed.max()) * RPM
    back = " and back" if record.turning < h.time.size - 1 else ""
    machine = (
        f"A rotor with a {record.axis} axis and {count} chamber{'' if count == 1 else 's'} goes from "
        f"{number(low)} to {number(high)} rpm{back}, {number(float(h.time[-1]))} s in all."
    )
    parts = {
        "title": "Run-up in time",
        "machine": machine,
        "moments": moments(record),
        "facts": table("", (), facts(record)),
        "energy": energy(record),
        "checks": checks(record),
        "events": events(record),
        "balance": [picture(one, alts[one.name]) for one in figures if one.name == BALANCE],
        "pictures": [picture(one, alts.get(one.name, "")) for one in figures if one.name != BALANCE],
        "why": why(record),
        "models": models((record.model,)),
        "remarks": [line for line in notes(record.notes) if not any(part in line for part in REPEATED)],
    }
    write_page("runup", what, parts, path)
