"""A run-up in words and tables, on a terminal and as a report."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from leblanc.core.blocks import (
    Block,
    Check,
    Checks,
    Columns,
    Headline,
    Notes,
    Picture,
    Section,
    Table,
    Words,
    check,
)
from leblanc.core.notes import one_line, percent, texts
from leblanc.core.quantities import quantities
from leblanc.core.units import (
    LENGTH,
    MASS,
    MINUS,
    RPM,
    UNBALANCE,
    amplitude_sentence,
    change_words,
    in_peak,
    in_rpm,
    number,
    ranges,
    rpm_bands,
    rpm_range,
    unit_for,
    with_unit,
)
from leblanc.studies.loads.answer import load_table
from leblanc.studies.run.answer import peak
from leblanc.studies.run.notes import CLOSURE
from leblanc.studies.run.words import WHY, of_models
from leblanc.studies.runup.answer import Moment, RunupAnswer
from leblanc.studies.runup.notes import ERROR, SETTLED, RunupCode
from meshes.arrays import Flags
from solvers.runup.runup import EnergyAudit

DRY = 1e-3  # of the layer's mean depth: a wall with less on it counts as dry
MASS_CHANGE = 1e-6  # relative change of a layer's volume to speak of
GAINS = ("unbalance", "drive", "gravity", "captured")  # terms of the energy that bring some in
TERMS = (*GAINS, "support", "friction", "bores", "baffles", "profile", "change", "remainder")
# What the tables of a report say as well.
IN_TABLES = (
    *(RunupCode.LIQUID_MODEL, RunupCode.ROUGH, RunupCode.ENERGY),
    *(RunupCode.PEAK_STEADY, RunupCode.SELF_EXCITED),
)
_CAUSES = {
    "cells": "cells and steps",
    "handover": "pool-annulus transition",
    "rounding": "rounding",
}
_SEEN = 1e-3  # of the amplitude, from which on a part of its error is named
_HERE = "leblanc.studies.runup.figure"


def blocks(answer: RunupAnswer) -> tuple[Block, ...]:
    """What is shown of a run-up, in the order of reading."""
    balance = Picture("runup_energy", "Where the energy of the run-up went", f"{_HERE}:energy_figure")
    figures = [Picture("runup_time", "Run-up over time", f"{_HERE}:time_figure")]
    if answer.loads is not None:
        title = "Clearances and forces on the floor"
        figures.append(Picture("runup_machine", title, f"{_HERE}:loads_figure"))
    results: tuple[Block, ...] = (
        Picture("runup_speed", "Amplitude over speed on the run-up", f"{_HERE}:speed_figure"),
        Columns(
            (moments(answer), Words("", shown="text"), Table(known(answer))),
            (Checks(tuple(checks(answer)), shown="page"),),
        ),
        *([] if answer.loads is None else [load_table(answer.loads)]),
        *([passages(answer)] if answer.passages else []),
        Columns((Table(facts(answer)), energy(answer)), (balance,), shown="page"),
    )
    rest = [note.text for note in answer.notes if note.code not in IN_TABLES]
    return (
        Headline(sentence(answer), about(answer)),
        *([Words(told)] if (told := effect(answer)) else []),
        Section("Results", results, width="120mm"),
        Words(f"\n{amplitude_sentence(answer.plane)}", shown="text"),
        *([] if answer.chamberless else [liquid_model(answer)]),
        Section("Figures", figures, width="138mm"),
        Notes(texts(answer.notes), shown="text"),
        Notes(rest, shown="page"),
    )


def effect(answer: RunupAnswer) -> str:
    """Which way the liquid changes the passage, in one sentence; empty where there is nothing to compare."""
    if answer.bare or answer.chamberless:
        return ""
    way = change_words(answer.crest().amplitude, float(answer.peak_dry["amplitude"]))
    return f"With the liquid {way} on the way up." if way else ""


def about(answer: RunupAnswer) -> str:
    """The machine and its way, in one sentence."""
    balls, races = sum(race.count for race in answer.races), len(answer.races)
    rolling = f", {_several(balls, 'ball')} in {_several(races, 'race')}" if balls else ""
    back = " and back" if answer.turns_back else ""
    if answer.passages:
        last = number(float(answer.speed[-1]) * RPM)
        back = f" and to {last} rpm in {len(answer.passages)} steps"
    low, high = float(answer.speed[0]) * RPM, float(answer.speed.max()) * RPM
    return (
        f"A rotor with a {answer.axis} axis and {_several(len(answer.chambers), 'chamber')}{rolling} goes "
        f"from {number(low)} to {number(high)} rpm{back}, {number(float(answer.time[-1]))} s in all."
    )


def _several(count: int, what: str) -> str:
    return f"{count} {what}{'' if count == 1 else 's'}"


def describe_model(answer: RunupAnswer) -> str:
    """Liquid model of a run-up with its resolution and the turbulence of hydraulic jumps."""
    if answer.model == "linear":
        return f"exact linear theory in time, steps as of {answer.cells} cells"
    shallow = "with dispersion" if answer.dispersion else "without dispersion"
    behind = "" if answer.bore == "none" else f", jumps with {answer.bore}"
    return f"annular long waves in time, {answer.cells} cells, {shallow}{behind}"


def main_moments(answer: RunupAnswer) -> list[tuple[str, Moment]]:
    """The main moments with their labels: the largest amplitudes and the end."""
    found = [("Largest on the way up" if answer.turns_back else "Largest amplitude", answer.crest())]
    if answer.turns_back:
        found.append(("Largest on the way down", answer.crest(back=True)))
    return [*found, ("At the end", answer.moment(-1))]


def steady_peak(answer: RunupAnswer) -> tuple[float, float] | None:
    """Largest amplitude of the steady response, m, and its speed, rad/s; None where there is none."""
    highest = None if answer.steady is None else peak(answer.steady.deflection)
    if answer.steady is None or highest is None:
        return None
    return float(abs(answer.steady.deflection[highest])), float(answer.steady.speed[highest])


def sentence(answer: RunupAnswer) -> str:
    """The largest amplitude, that of the steady response and that at the end; how well they are known."""
    first, *rest = [moment for _, moment in main_moments(answer)]
    steady, highest = "", steady_peak(answer)
    if highest is not None:
        steady = f", where the steady response has {with_unit(highest[0], LENGTH)} at {in_rpm(highest[1])}"
    place = f" {answer.plane}" if answer.plane else ""
    later = zip(["on the way down", "at the end"][-len(rest) :], rest, strict=True)
    known = peak_known(answer)
    return (
        f"The largest amplitude{place} is {_amplitude(answer, first)}{largest_dry(answer)}{steady}; "
        + ", ".join(f"{when} it is {_amplitude(answer, moment)}" for when, moment in later)
        + (f". The largest of all is known to {known}." if known else ".")
        + ("" if answer.chamberless else f" The liquid model holds for {_fair(answer)} of the run.")
    )


def _fair(answer: RunupAnswer) -> str:
    """Share of the samples at which the liquid model holds."""
    share = float(answer.in_range.mean())
    return "all" if share == 1.0 else f"{100.0 * share:.3g} %"


def peak_known(answer: RunupAnswer) -> str:
    """The one error of the run's largest amplitude in words, with its parts; or nothing."""
    parts = {name: size for name, size in answer.peak_error.items() if not math.isnan(size)}
    largest = float(answer.history.largest.max())
    at = float(answer.history.largest_time[np.argmax(answer.history.largest)])
    if not parts or largest == 0.0 or not answer.in_range_at(at):
        return ""
    error = sum(parts.values())
    text = f"\N{PLUS-MINUS SIGN} {with_unit(error, LENGTH)} ({percent(error / largest)})"
    named = [
        f"{_CAUSES[name]} {percent(size / largest)}" for name, size in parts.items() if size > _SEEN * largest
    ]
    return f"{text}: {', '.join(named)}" if len(named) > 1 else text


def _amplitude(answer: RunupAnswer, moment: Moment) -> str:
    """Amplitude of one moment and its speed; whether it can be believed."""
    size = f"{with_unit(moment.amplitude, LENGTH)} at {in_rpm(moment.speed)}"
    return f"{size}{'' if answer.in_range_at(moment.time) else ' (out of range)'}"


def largest(answer: RunupAnswer) -> str:
    """The largest amplitude on the way up and where it was, as figures say it."""
    top, where = answer.crest(), f" {answer.plane}" if answer.plane else ""
    return f"{with_unit(top.amplitude, LENGTH)} at {in_rpm(top.speed)}{where}"


def largest_dry(answer: RunupAnswer) -> str:
    """The largest amplitude on the way up without liquid, as it follows that with liquid; or nothing."""
    top = answer.peak_dry
    if math.isnan(top["amplitude"]) or answer.bare:
        return ""
    return f", {answer.without} {with_unit(top['amplitude'], LENGTH)} at {in_rpm(top['speed'])}"


def moments(answer: RunupAnswer) -> Table:
    """Largest amplitude on the way up and down, that of the steady response, and the end."""
    found = [
        (
            label if answer.in_range_at(moment.time) else f"{label} (out of range)",
            moment.amplitude,
            moment.speed,
            number(moment.time),
        )
        for label, moment in main_moments(answer)
    ]
    if largest_dry(answer):
        bare = answer.peak_dry
        found.insert(1, (answer.without.capitalize(), bare["amplitude"], bare["speed"], number(bare["time"])))
    if (highest := steady_peak(answer)) is not None:
        found.append(("Largest of the steady response", *highest, ""))
    unit = unit_for(LENGTH, *(size for _, size, _, _ in found))
    rows = [(label, unit.number(size), number(speed * RPM), time) for label, size, speed, time in found]
    return Table(rows, ("", f"amplitude ({in_peak(unit.name)})", "at (rpm)", "after (s)"))


def passages(answer: RunupAnswer) -> Table:
    """The steps of a programme with the largest amplitude of each."""
    unit = unit_for(LENGTH, *(passage.amplitude for passage in answer.passages))
    size = f"largest amplitude ({in_peak(unit.name)})"
    bare = [] if answer.bare else [answer.without]
    rows = [
        (
            f"{passage.step}",
            passage.text,
            number(passage.end),
            unit.number(passage.amplitude) + ("" if answer.in_range_at(passage.time) else " (out of range)"),
            number(passage.speed * RPM),
            *(unit.number(passage.amplitude_dry) for _ in bare),
        )
        for passage in answer.passages
    ]
    head = ("Step", "", "ends after (s)", size, "at (rpm)", *bare)
    return Table(rows, head, title="Steps of the programme")


def known(answer: RunupAnswer) -> list[tuple[str, str]]:
    """How well the amplitudes are known, and what balls do at the end: label and value."""
    rows = []
    if error := peak_known(answer):
        rows.append(("Largest of all known to", error))
    if not answer.chamberless:
        rows.append(("Liquid model holds", f"for {_fair(answer)} of the run"))
    if answer.spread is not None:
        rows.append(("By rounding alone", rounding(answer)))
    if answer.races:
        size, angle = float(answer.ball_unbalance[-1]), _degrees(answer.ball_unbalance_angle[-1])
        most = with_unit(sum(race.count * race.moment for race in answer.races), UNBALANCE)
        behind = answer.speed[-1] - answer.ball_speed[-1]
        rows += [
            ("Unbalance of the balls at the end", f"{with_unit(size, UNBALANCE)} at {angle}, of {most}"),
            ("Slowest ball behind the drum at the end", in_rpm(float(behind[np.argmax(np.abs(behind))]))),
        ]
    return rows


def facts(answer: RunupAnswer) -> list[tuple[str, str]]:
    """The end of the run, its resolution and its errors: label and value."""
    place, rows = answer.history.liquid_position[-1], []
    if not answer.chamberless:
        off = f"{with_unit(abs(place), LENGTH)} off the axis at {_degrees(np.angle(place))}"
        rows += [
            ("Mass of the liquid", with_unit(float(answer.layer_mass.sum()), MASS)),
            ("Its centre of mass at the end", off if answer.wet else "none"),
        ]
    rows += [
        ("Phase of the deflection at the end", _degrees(answer.phase[-1])),
        ("Resolution", f"{answer.cells} cells, {answer.steps} steps, {answer.time.size} samples kept"),
        ("Error by half the cells, of the largest", _share(answer.error_estimate)),
        ("Error of model and steps", _share(answer.model_error)),
        ("Energy not accounted for, of the work", _share(answer.energy_error)),
    ]
    if not answer.chamberless:
        rows.append(("Largest change of a layer's mass", _share(answer.mass_error)))
    return rows


def rounding(answer: RunupAnswer) -> str:
    """What rounding alone does to the largest amplitude and to that at one time, in words."""
    spread = answer.spread
    assert spread is not None
    peaks, widest = (
        percent(part) if part >= SETTLED else "unchanged"
        for part in (spread.peak_spread, spread.largest_spread)
    )
    return f"largest amplitude {peaks}, at one time up to {widest} of it, {spread.members} runs"


def _degrees(angle: float) -> str:
    return f"{number(math.degrees(float(angle)))} deg"


def _share(value: float) -> str:
    return "not known" if math.isnan(value) else f"{number(100.0 * value)} %"


def terms(answer: RunupAnswer) -> list[tuple[str, str, float]]:
    """Terms of the balance of energy: name, what it is in words, J."""
    words = {name: q.name for name, q in quantities(EnergyAudit).items()}
    if answer.races:
        words |= {"drive": "work of the drive on the balls", "friction": "heat by the drag of balls"}
    shown = [name for name in TERMS if name != "baffles" or answer.energy.baffles]
    return [(name, words[name], getattr(answer.energy, name)) for name in shown]


def energy(answer: RunupAnswer) -> Table:
    """The balance of energy, and each term over the work that the closure is measured by."""
    audit = answer.energy
    signs = {"remainder": "="} | dict.fromkeys(GAINS, "+")
    rows = [
        (
            f"{signs.get(name, MINUS)} {text}",
            number(value),
            number(100.0 * value / audit.scale) if audit.scale > 0.0 else "",
        )
        for name, text, value in terms(answer)
    ]
    if audit.motor != 0.0:
        who = "drag on the coasting drum" if answer.passages else "the motor"
        rows.append((f"besides, work of {who}", number(audit.motor), ""))
    return Table(rows, ("Energy", "J", "% of the work"))


def checks(answer: RunupAnswer) -> Iterator[Check]:
    """Where the run is not what it seems, each with the times or the size."""
    history = answer.history

    def at_times(label: str, mask: Flags) -> Check:
        return check(label, ranges(history.time, mask, "s"), bool(mask.any()))

    def above(label: str, value: float, most: float) -> Check:
        bad = not value <= most
        return check(label.format(f"{number(100.0 * most)} %"), _share(value) if bad else "no", bad)

    yield check("Stopped before its end", history.reason or "no", not history.converged)
    yield check(
        "Energy or deflection not physical", "; ".join(answer.violations) or "no", bool(answer.violations)
    )

    if not answer.chamberless:
        yield at_times("Liquid model out of range", ~answer.in_range)
    for k, chamber in enumerate(answer.chambers):
        if chamber.volume == 0.0:
            continue
        of = "" if len(answer.chambers) == 1 else f" of chamber {k + 1}"
        loose, depth = ~history.captured[:, k], chamber.radius - chamber.mean_surface_radius
        yield at_times(f"Annulus{of} not reached from rest", loose)
        dry = ~loose & (np.nan_to_num(history.depth_min[:, k], nan=math.inf) <= DRY * depth)
        yield at_times(f"Liquid{of} leaves a wall dry", dry)
    bands = "not examined" if answer.bands is None else rpm_bands(answer.bands) or "none"
    yield check("Self-excited whirl, linear theory", bands, bool(answer.bands))
    yield above("Error above {} or unknown", answer.error_estimate, ERROR)
    yield above("Energy lost above {}", answer.energy_error, CLOSURE)
    if not answer.chamberless:
        yield above("Mass changed above {}", answer.mass_error, MASS_CHANGE)


def liquid_model(answer: RunupAnswer) -> Section:
    """The liquid model of the run, its error, the reason for it, and what it takes for granted."""
    span = rpm_range(float(answer.speed.min()), float(answer.speed.max())).removesuffix(" rpm")
    error = "not known" if math.isnan(answer.model_error) else percent(answer.model_error)
    text = one_line(answer.model_reason)
    reason = f"{text[:1].upper()}{text[1:]} Taken as {describe_model(answer)}."
    return of_models((answer.model,), Table([(span, answer.model, error, reason)], WHY, sentences=True))
