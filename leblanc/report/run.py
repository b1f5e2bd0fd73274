"""The report of `run`: amplitude with and without liquid, where the answer holds, figures, models and why."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from leblanc.report.layout import figure_width
from leblanc.report.page import About, models, notes, why, write_page
from leblanc.report.parts import Cell, Table, picture, table
from leblanc.results.provenance import one_line
from leblanc.results.record import StudyRecord, models_used, peak
from leblanc.scene.scene import Scene
from leblanc.studies.choose import choose
from leblanc.text.models import ModelSpan, fidelity_notes, model_spans
from leblanc.text.numbers import NOT_FOUND, number, ranges
from leblanc.units import MM, RPM

if TYPE_CHECKING:
    from leblanc.figures.page import FigureFiles

AGAINST = 0.5  # from here on a whirl counts as one with or against the spin
SHOWN = 4  # figures, of which the phase stands in its own file only; with more, all


@dataclass(frozen=True)
class Comparison:
    """With liquid, without, and their ratio, as printed."""

    label: str
    wet: str
    dry: str
    ratio: str


def comparisons(record: StudyRecord) -> list[Comparison]:
    """Largest and last amplitude, and the critical speed of a planar rotor, with and without liquid.

    Parameters
    ----------
    record : the study
    """
    r = record.response
    wet, dry = peak(record.amplitude), peak(record.amplitude_dry)
    at_wet, at_dry = (NOT_FOUND if i is None else number(r.speed[i] * RPM) for i in (wet, dry))
    found = [
        _compared("Largest amplitude (mm)", record, wet, dry),
        Comparison("at the speed (rpm)", at_wet, at_dry, ""),
        _compared(f"Amplitude at {number(r.speed[-1] * RPM)} rpm (mm)", record, -1, -1),
    ]
    if record.motion is None:
        with_liquid, without = record.critical_speed_wet, record.critical_speed_dry
        words = number(with_liquid * RPM), number(without * RPM), number(with_liquid / without)
        found.append(Comparison("Critical speed (rpm)", *words))
    return found


def _compared(label: str, record: StudyRecord, wet: int | None, dry: int | None) -> Comparison:
    """Amplitudes at two places in the list of speeds."""
    with_liquid = math.nan if wet is None else float(record.amplitude[wet])
    without = math.nan if dry is None else float(record.amplitude_dry[dry])
    comparable = without > 0.0 and math.isfinite(without) and math.isfinite(with_liquid)
    ratio = number(with_liquid / without) if comparable else ""
    return Comparison(label, number(with_liquid * MM), number(without * MM), ratio)


def facts(record: StudyRecord) -> list[tuple[str, str]]:
    """What else a reader wants to know: label and value.

    Parameters
    ----------
    record : the study
    """
    r = record.response
    where = NOT_FOUND if math.isnan(r.liquid_offset[-1]) else "none"
    if r.liquid_offset[-1] > 0.0:
        angle = number(math.degrees(r.liquid_angle[-1]))
        where = f"{number(r.liquid_offset[-1] * MM)} mm off the axis at {angle} deg"
    return [
        ("Mass of the liquid", f"{number(record.liquid_mass * 1e3)} g"),
        (f"Its centre of mass at {number(r.speed[-1] * RPM)} rpm", where),
        *_vibration(record),
    ]


def _vibration(record: StudyRecord) -> list[tuple[str, str]]:
    """Critical speeds and natural frequencies; "b" marks a whirl against the spin."""
    if record.motion is None:
        return []

    def listed(speeds: tuple[tuple[float, float], ...]) -> str:
        words = [f"{number(speed * RPM)}" + (" b" if sense < -AGAINST else "") for speed, sense in speeds]
        return ", ".join(words) + " rpm" if words else "none"

    at_rest = [
        f"{number(one.frequency / (2.0 * math.pi))} ({one.damping_ratio:.2g})" for one in record.motion.modes
    ]
    return [
        ("Critical speeds with liquid", listed(record.motion.critical_speeds_wet)),
        ("Critical speeds without liquid", listed(record.motion.critical_speeds_dry)),
        ("Natural frequencies at rest (damping ratios)", ", ".join(at_rest) + " Hz"),
    ]


def checks(record: StudyRecord, tolerance: float | None = None) -> Table:
    """Where the answer is not what it seems: each check with the speeds that fail it, those marked.

    Parameters
    ----------
    record : the study
    tolerance : relative error that the scene allows; None leaves that check out
    """
    r = record.response
    found = [
        ("Not converged", ranges(r.speed, ~r.converged), bool((~r.converged).any())),
        ("Liquid model out of range", ranges(r.speed, ~r.in_range), bool((~r.in_range).any())),
    ]
    if record.capture_speed is not None:
        loose = r.speed <= record.capture_speed
        edge = f" (below {number(record.capture_speed * RPM)} rpm)" if loose.any() else ""
        found.append(("Liquid not carried round", f"{ranges(r.speed, loose)}{edge}", bool(loose.any())))
    if tolerance is not None and record.error_estimate is not None:
        missed = ~(record.error_estimate <= tolerance)
        label = f"Error above {number(100.0 * tolerance)} % or unknown"
        found.append((label, ranges(r.speed, missed), bool(missed.any())))
    found.append(("Wall dry in part", ranges(r.speed, r.dry_patch), bool(r.dry_patch.any())))
    found.append(("Answer unstable", ranges(r.speed, ~r.stable), bool((~r.stable).any())))
    if record.whirl is not None:
        words = [f"{low * RPM:.5g} to {high * RPM:.5g} rpm" for low, high in record.whirl.bands]
        lost = np.isnan(record.whirl.growth)
        words += [f"not found at {ranges(r.speed, lost)}"] if lost.any() else []
        found.append(("Self-excited whirl", ", ".join(words) or "none", bool(words)))
    infinite = np.isinf(record.amplitude)
    if infinite.any():
        found.append(("Amplitude infinite", ranges(r.speed, infinite), True))
    return table(
        "", ("Limits of the answer", "at"), [(label, Cell(text, warning=bad)) for label, text, bad in found]
    )


def machine(record: StudyRecord) -> str:
    """What was studied, in one sentence.

    Parameters
    ----------
    record : the study
    """
    r = record.response
    count = len(record.chambers)
    volume = number(sum(chamber.volume for chamber in record.chambers) * 1e6)
    liquids = " and ".join(dict.fromkeys(one_line(c.liquid_name) for c in record.chambers))
    chambers = f"{count} chambers, together" if count > 1 else "one chamber"
    carries = f"{chambers} with {volume} ml of {liquids}" if count else "no chamber"
    speeds = f"at {number(r.speed[0] * RPM)} rpm"
    if r.speed.size > 1:
        speeds = (
            f"from {number(r.speed[0] * RPM)} to {number(r.speed[-1] * RPM)} rpm in {r.speed.size} speeds"
        )
    return f"A rotor with a {record.axis} axis that carries {carries}, {speeds}."


def remarks(record: StudyRecord, elsewhere: Sequence[str] = ()) -> list[str]:
    """Notes of the record and what its numbers themselves ask a reader to bear in mind.

    Parameters
    ----------
    record : the study
    elsewhere : notes that the page has in another place
    """
    r, found = record.response, notes(record.notes, elsewhere)
    highest = peak(record.amplitude)
    if highest is None:
        found.append("No answer was found at any speed.")
    elif r.speed.size > 1 and r.speed[highest] in (r.speed.min(), r.speed.max()):
        found.append("The largest amplitude lies at an end of the range of speeds.")
    if highest is not None and not r.in_range[highest]:
        found.append("The largest amplitude lies where the liquid model is out of range.")
    if record.motion is not None and any(way < -AGAINST for _, way in record.motion.critical_speeds_dry):
        found.append("Critical speeds marked b belong to whirl against the spin.")
    if not r.in_range[-1]:
        found.append("At the last speed the liquid model is out of range.")
    return found


def alts(record: StudyRecord) -> dict[str, str]:
    """What each figure shows, with the numbers a reader would take from it.

    Parameters
    ----------
    record : the study
    """
    largest, at, last, *_ = comparisons(record)
    told = dict(facts(record))
    centre = next(value for label, value in told.items() if label.startswith("Its centre"))
    return {
        "amplitude": f"Curves of the amplitude over speed: largest {largest.wet} mm at {at.wet} rpm with "
        f"liquid, {largest.dry} mm at {at.dry} rpm without.",
        "liquid": "Curves of the distance and the angle of the liquid's centre of mass over speed; at the "
        f"last speed: {centre}.",
        "phase": "Curves of the angle from the unbalance to the deflection over speed, with and without "
        "liquid.",
        "chamber": "Drawing of each chamber with its liquid, seen along the axis, at the largest deflection, "
        f"{largest.wet} mm, and at the last speed, {last.wet} mm.",
        "campbell": "Curves of the natural frequencies without liquid over speed.",
    }


def write_run_report(
    scene: Scene, record: StudyRecord, what: About, figures: Sequence[FigureFiles], path: Path
) -> None:
    """Write the report of a scene's response, with the reasons for its models.

    Parameters
    ----------
    scene, record : the machine and its response
    what, figures, path : as for `write_summary`
    """
    choice, speed = choose(scene), scene.speed_array()
    spans, said = model_spans(choice, speed), fidelity_notes(choice, speed)
    write_summary(record, what, figures, path, spans, scene.model.tolerance, said)


def write_summary(
    record: StudyRecord,
    what: About,
    figures: Sequence[FigureFiles],
    path: Path,
    spans: Sequence[ModelSpan] = (),
    tolerance: float | None = None,
    elsewhere: Sequence[str] = (),
) -> None:
    """Write the report: one page for a simple machine.

    Parameters
    ----------
    record : the study
    what : it is about
    figures : in the order of the page
    path : the file to write or replace
    spans : which model answers where, and why
    tolerance : relative error that the scene allows
    elsewhere : notes that the spans say as well
    """
    shown = [one for one in figures if len(figures) > SHOWN or one.name != "phase"]
    words = alts(record)
    names = models_used(record.response)
    parts: Mapping[str, object] = {
        "title": "Response to the unbalance over speed",
        "machine": machine(record),
        "comparisons": table(
            "",
            ("", "with liquid", "without", "ratio"),
            [(one.label, one.wet, one.dry, one.ratio) for one in comparisons(record)],
        ),
        "facts": table("", (), facts(record)),
        "checks": checks(record, tolerance),
        "pictures": [picture(one, words.get(one.name, one.title)) for one in shown],
        "why": why(spans) if spans else _used(record, names),
        "models": models(names),
        "remarks": remarks(record, elsewhere),
    }
    write_page("run", what, {**parts, "figure_width": figure_width(what, parts)}, path)


def _used(record: StudyRecord, names: Sequence[str]) -> Table:
    """The models and their speeds, where no reasons are known."""
    r = record.response
    return table("", ("Model", "Speeds"), [(name, ranges(r.speed, r.model == name)) for name in names], True)
