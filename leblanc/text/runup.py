"""A run-up as text."""

from __future__ import annotations

import math

import numpy as np

from leblanc.core.notes import percent
from leblanc.core.units import LENGTH, TIME, UNBALANCE, amplitudes_are, in_rpm, number, with_unit
from leblanc.results.notes.runup import SETTLED
from leblanc.results.runup import Moment, RunupResult
from leblanc.studies.run.answer import peak


def describe_model(model: str, cells: int, dispersion: bool, bore: str = "none") -> str:
    """Liquid model of a run-up ("long_wave" or "linear") with its resolution and what bores leave behind."""
    if model == "linear":
        return f"exact linear theory in time, steps as of {cells} cells"
    shallow = "with dispersion" if dispersion else "without dispersion"
    behind = "" if bore == "none" else f", bores with {bore}"
    return f"annular long waves in time, {cells} cells, {shallow}{behind}"


def moments(result: RunupResult) -> list[tuple[str, Moment]]:
    """The main moments with their labels: the largest amplitudes and the end."""
    found = [("Largest on the way up" if result.turns_back else "Largest amplitude", result.crest())]
    if result.turns_back:
        found.append(("Largest on the way down", result.crest(back=True)))
    return [*found, ("At the end", result.moment(-1))]


def answer(result: RunupResult) -> str:
    """The largest amplitude, that of the steady response and that at the end, in one sentence."""
    first, *rest = [moment for _, moment in moments(result)]
    dry = largest_dry(result)
    steady, highest = "", None if result.steady is None else peak(result.steady.deflection)
    if result.steady is not None and highest is not None:
        size = with_unit(float(abs(result.steady.deflection[highest])), LENGTH)
        steady = f", where the steady response has {size} at {in_rpm(float(result.steady.speed[highest]))}"
    place = f" {result.plane}" if result.plane else ""
    later = zip(["on the way down", "at the end"][-len(rest) :], rest, strict=True)
    return (
        f"The largest amplitude{place} is {_amplitude(result, first)}{dry}{steady}; "
        + ", ".join(f"{when} it is {_amplitude(result, moment)}" for when, moment in later)
        + f".{_trust(result)}"
    )


_ROUGH = 0.1  # of an amplitude: an error beyond this is told with its cause
_CAUSES = {"cells": "cells and steps", "handover": "how the liquid becomes a ring"}


def _trust(result: RunupResult) -> str:
    """How well the largest amplitude is known, and for how much of the run the model holds: two sentences."""
    known = peak_known(result)
    first = f" The largest of all is known to {known}." if known else ""
    return first if result.chamberless else f"{first} The liquid model holds for {_fair(result)} of the run."


def _fair(result: RunupResult) -> str:
    """Share of the samples at which the liquid model holds."""
    share = float(result.in_range.mean())
    return "all" if share == 1.0 else f"{100.0 * share:.3g} %"


def peak_known(result: RunupResult) -> str:
    """Error of the run's largest amplitude in words, with its cause where it is large; or nothing."""
    parts = {name: size for name, size in result.peak_error.items() if not math.isnan(size)}
    largest = float(result.history.largest.max())
    if not parts or largest == 0.0:
        return ""
    error = sum(parts.values())
    text = f"\N{PLUS-MINUS SIGN} {with_unit(error, LENGTH)}, {percent(error / largest)}"
    if error <= _ROUGH * largest:
        return text
    worst = max(parts, key=lambda name: parts[name])
    return f"{text}, most of it by {_CAUSES[worst]}"


def _amplitude(result: RunupResult, moment: Moment) -> str:
    """Amplitude of one moment and its speed; whether it can be believed."""
    doubt = "" if result.in_range_at(moment.time) else " (out of range)"
    return f"{_size_and_speed(moment)}{doubt}"


def _size_and_speed(moment: Moment) -> str:
    return f"{with_unit(moment.amplitude, LENGTH)} at {in_rpm(moment.speed)}"


def answer_rows(result: RunupResult) -> list[tuple[str, str]]:
    """The largest amplitudes and that at the end: label and value."""
    rows = [
        (label, f"{_amplitude(result, moment)}, after {with_unit(moment.time, TIME)}")
        for label, moment in moments(result)
    ]
    if known := peak_known(result):
        rows.append(("Largest of all known to", known))
    if not result.chamberless:
        rows.append(("Liquid model holds", f"for {_fair(result)} of the run"))
    if result.spread is not None:
        rows.append(("By rounding alone", rounding(result)))
    if largest_dry(result):
        peak = result.peak_dry
        size, when = with_unit(peak["amplitude"], LENGTH), with_unit(peak["time"], TIME)
        rows.insert(1, (result.without.capitalize(), f"{size} at {in_rpm(peak['speed'])}, after {when}"))
    return rows


def passage_rows(result: RunupResult) -> list[tuple[str, str]]:
    """The largest amplitude of each step of a programme: label and value; none of a run-up."""
    rows = []
    for passage in result.passages:
        moment = Moment(passage.amplitude, passage.speed, passage.time)
        bare = ""
        if not math.isnan(passage.amplitude_dry) and not result.bare:
            bare = f", {result.without} {with_unit(passage.amplitude_dry, LENGTH)}"
        text = f"{_amplitude(result, moment)}{bare}; ends after {with_unit(passage.end, TIME)}"
        rows.append((f"Step {passage.step}, {passage.text}", text))
    return rows


def ball_rows(result: RunupResult) -> list[tuple[str, str]]:
    """What the balls do at the end: label and value; nothing without balls."""
    if not result.races:
        return []
    behind = result.speed[-1] - result.ball_speed[-1]
    size, angle = with_unit(float(result.ball_unbalance[-1]), UNBALANCE), result.ball_unbalance_angle[-1]
    most = with_unit(sum(race.count * race.moment for race in result.races), UNBALANCE)
    rows = [("Unbalance of the balls at the end", f"{size} at {number(math.degrees(angle))} deg, of {most}")]
    worst = float(behind[np.argmax(np.abs(behind))])
    rows.append(("Slowest ball behind the drum at the end", in_rpm(worst)))
    return rows


def rounding(result: RunupResult) -> str:
    """What rounding alone does to the largest amplitude and to that at one time, in words; or nothing."""
    spread = result.spread
    if spread is None:
        return ""
    return (
        f"largest amplitude {_share(spread.peak_spread)}, at one time up to "
        f"{_share(spread.largest_spread)} of it, {spread.members} runs"
    )


def _share(part: float) -> str:
    """As a percentage, or as not worth one."""
    return percent(part) if part >= SETTLED else "unchanged"


def largest(result: RunupResult) -> str:
    """The largest amplitude on the way up and where it was."""
    where = f" {result.plane}" if result.plane else ""
    return f"{_size_and_speed(result.crest())}{where}"


def largest_dry(result: RunupResult) -> str:
    """The largest amplitude on the way up without liquid, as it follows that with liquid; or nothing."""
    peak = result.peak_dry
    if math.isnan(peak["amplitude"]) or result.bare:
        return ""
    return f", {result.without} {with_unit(peak['amplitude'], LENGTH)} at {in_rpm(peak['speed'])}"


def summary(result: RunupResult) -> list[tuple[str, str]]:
    """The main numbers of a run-up, as labels and values."""

    told = describe_model(result.model, result.cells, result.dispersion, result.bore)
    return [
        amplitudes_are(result.plane),
        *answer_rows(result),
        *ball_rows(result),
        *passage_rows(result),
        *([] if result.chamberless else [("Liquid model", told)]),
        ("End", result.reason or "it came to its end"),
    ]
