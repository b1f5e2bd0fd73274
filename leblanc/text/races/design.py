"""The best balls of a rotor as text."""

from __future__ import annotations

import math

from leblanc.core.blocks import Check
from leblanc.core.units import LENGTH, MASS, MM, NOT_FOUND, UNBALANCE, in_rpm, number, with_unit
from leblanc.results.races.design import BallDesignResult, DesignedRace
from leblanc.studies.run.words import grade
from leblanc.text.optimum import shown

Rows = list[tuple[str, str]]

RACE_HEAD = (
    "race",
    "balls",
    "mass of each (g)",
    "diameter (mm)",
    "drag (N s/m)",
    "path's radius (mm)",
    "holds (g mm)",
)


def answer(result: BallDesignResult) -> str:
    """The best balls and what they give, in one sentence."""
    races = " and ".join(_race_words(race) for race in result.races)
    text = f"With {races}, {with_unit(result.mass, MASS)} in all"
    text = f"{text}, the {result.meaning} is {_size(result.vibration)}"
    if not result.feasible:
        return f"No balls within the ranges meet every constraint. Nearest: {text[0].lower()}{text[1:]}."
    return f"{text} in place of {_size(result.vibration_without)} without balls."


def _race_words(race: DesignedRace) -> str:
    size = with_unit(race.mass, MASS)
    if race.sized_by == "diameter" and race.diameter is not None:
        size = with_unit(race.diameter, LENGTH)
    return f"{race.count} ball{'' if race.count == 1 else 's'} of {size}"


def _size(amplitude: float) -> str:
    """An amplitude, or that there is none that stays."""
    return with_unit(amplitude, LENGTH) if math.isfinite(amplitude) else "not known, no state being stable"


def race_rows(result: BallDesignResult, before: bool = False) -> list[tuple[str, ...]]:
    """A row for each race, as `RACE_HEAD` says."""
    races = result.races_before if before else result.races
    return [
        (
            f"{k + 1}",
            f"{race.count}",
            number(race.mass * 1e3),
            "" if race.diameter is None else number(race.diameter * MM),
            number(race.drag),
            number(race.radius * MM),
            number(race.capacity * 1e6),
        )
        for k, race in enumerate(races)
    ]


def facts(result: BallDesignResult) -> Rows:
    """Main numbers: label and value."""
    decay = f"{number(result.stability_margin)} 1/s, with the scene's balls {_decay(result.growth_before)}"
    rows = [
        ("Objective", f"{result.objective}, the {result.meaning}"),
        *((f"Race {k + 1}", _race_words(race)) for k, race in enumerate(result.races)),
        ("Amplitude", _size(result.vibration)),
        ("with the scene's balls", _size(result.vibration_before)),
        ("without balls", _size(result.vibration_without)),
        (
            "Mass of all balls",
            f"{with_unit(result.mass, MASS)}, before {with_unit(result.mass_before, MASS)}",
        ),
        ("Small motions fade with", decay),
        ("Balanced state stable from", in_rpm(result.response.balanced_from)),
        ("Constraints", "every one is met" if result.feasible else f"not met: {nearest(result)}"),
        ("Designs judged", f"{result.evaluations}"),
    ]
    if len(result.unbalances) > 1:
        sizes = result.unbalances.max(axis=1)
        span = f"{with_unit(float(sizes.min()), UNBALANCE)} to {with_unit(float(sizes.max()), UNBALANCE)}"
        rows.insert(1, ("Unbalances", f"{span}, {len(sizes)} conditions"))
    return rows


def _decay(growth: float) -> str:
    return f"{number(-growth)} 1/s" if math.isfinite(growth) else NOT_FOUND


def constraint_rows(result: BallDesignResult) -> list[tuple[str, str, str, str]]:
    """Each constraint: what it is, value, limit, verdict."""
    return [
        (
            f"{name.replace('_', ' ')}: {own.meaning}",
            shown(own.value, own.unit) if math.isfinite(own.value) else NOT_FOUND,
            shown(own.limit, own.unit),
            "kept" if own.satisfied else "EXCEEDED",
        )
        for name, own in result.constraints.items()
    ]


def nearest(result: BallDesignResult) -> str:
    """What is exceeded where no balls meet every constraint."""
    parts = [
        f"{name.replace('_', ' ')}: {own.meaning} "
        f"{shown(own.value, own.unit) if math.isfinite(own.value) else NOT_FOUND}, at most "
        f"{shown(own.limit, own.unit)}"
        for name, own in result.exceeded.items()
    ]
    if not math.isfinite(result.vibration):
        parts.append(f"no state of the balls is stable at {in_rpm(result.working_speed)}")
    return "; ".join(parts)


def paste(result: BallDesignResult) -> list[str]:
    """Keys of each race for the scene file."""
    found = []
    for race in result.races:
        size = f'mass = "{race.mass * 1e3:.6g} g"'
        if race.sized_by == "diameter" and race.diameter is not None:
            size = f'diameter = "{race.diameter * MM:.6g} mm"'
        rest = f'drag = "{race.drag:.6g} N*s/m"', f'radius = "{race.radius * MM:.6g} mm"'
        found.append("; ".join((f"count = {race.count}", size, *rest)))
    return found


def limits(result: BallDesignResult) -> list[Check]:
    """Where the answer is not what it seems: each check with what fails it."""
    exceeded = [name.replace("_", " ") for name in result.exceeded]
    lost = not math.isfinite(result.vibration)
    return [
        Check("Constraints exceeded", ", ".join(exceeded) or "none", grade(bool(exceeded))),
        Check("No stable state where it works", "yes" if lost else "no", grade(lost)),
        Check("Interrupted", "yes" if result.interrupted else "no", grade(result.interrupted)),
    ]


def alt(result: BallDesignResult) -> str:
    """What the figure shows."""
    return (
        "Amplitude and decay of the designs tried over the mass of all balls, and the amplitude over speed "
        f"with the best of them and without balls. {answer(result)}"
    )
