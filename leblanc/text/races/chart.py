"""A chart of the stability of balls as text."""

from __future__ import annotations

import math

import numpy as np

from leblanc.core.blocks import Check
from leblanc.core.units import RPM, UNBALANCE, in_rpm, number, rpm_bands, unit_for, with_unit
from leblanc.results.races.chart import BallChart, Curve
from leblanc.studies.run.words import grade

STATES = {
    "balanced": "the balanced state",
    "heavy": "the state with all balls on the heavy side",
    "light": "the state with all balls opposite to the unbalance",
}
CURVES = {
    "hopf": "a pair of roots crosses (Hopf)",
    "zero": "one root passes 0 (fold, branching)",
}
_ENDS = {
    "left": "leaves the chart",
    "closed": "closes",
    "nowhere": "comes to where the state ends",
    "lost": "is lost, as no further point is found",
    "long": "is cut, as it has too many points",
}
HEAD = ("Curve", "speed (rpm)", "value", "frequency in the drum (rpm)", "it ends where it")


def what(result: BallChart) -> str:
    """The number that is varied, as its path; of several the first."""
    more = len(result.paths) - 1
    return result.paths[0] + (f" and {more} more" if more else "")


def answer(result: BallChart) -> str:
    """From which speed on the scene's own value gives a stable state, and what the chart adds."""
    state = STATES[result.state]
    own = ""
    if math.isfinite(result.scene_value):
        own = f", {what(result)} being {with_unit(result.scene_value, result.dimension)}"
    last = in_rpm(float(result.speed[-1]))
    if not result.scene_bands:
        there = "stable at none of these speeds" if np.isfinite(result.scene_growth).any() else "not possible"
        first = f"In the scene as it stands {state} is {there}{own}"
    elif math.isfinite(result.stable_from):
        first = (
            f"In the scene as it stands {state} is stable from {in_rpm(result.stable_from)} to {last}{own}"
        )
    else:
        first = f"In the scene as it stands {state} is stable at {rpm_bands(result.scene_bands)}{own}"
    return f"{first}; over the whole chart it is at {_share(result.stable)} of the points."


def facts(result: BallChart) -> list[tuple[str, str]]:
    """What the chart says in numbers: label and value."""
    unit = unit_for(result.dimension, *result.value[[0, -1]].tolist())
    span = f"{unit.number(float(result.value[0]))} to {unit.text(float(result.value[-1]))}"
    last, growth = in_rpm(float(result.speed[-1])), float(result.scene_growth[-1])
    rows = [
        ("Values by speeds", f"{result.value.size} by {result.speed.size}"),
        ("Over", f"{', '.join(result.paths)}: {span}"),
        ("Stability of", STATES[result.state]),
        ("Stable at", f"{_share(result.stable)} of the points"),
        ("Unstable at", f"{_share(result.growing > 0)} of the points"),
        *([("No such state at", f"{_share(result.missing)} of the points")] if result.missing.any() else []),
    ]
    if result.bounds:
        rows.append(
            ("It begins or ends at", ", ".join(with_unit(x, result.dimension) for x in result.bounds))
        )
    rows += [
        ("Unbalance that the balls of each race hold", _held(result)),
        ("Stable in the scene as it stands", rpm_bands(result.scene_bands) or "at none of these speeds"),
        (
            f"Growth of small motions there at {last}",
            f"{number(growth)} 1/s" if math.isfinite(growth) else "no such state",
        ),
        ("Curves on which the number of growing roots changes", str(len(result.edges)) or "none"),
    ]
    return rows


def curves(result: BallChart) -> list[tuple[str, ...]]:
    """Each curve: what crosses, over which speeds and values, how fast it swings, where it ends."""
    unit = unit_for(result.dimension, *result.value[[0, -1]].tolist())
    rows: list[tuple[str, ...]] = []
    for edge in result.edges:
        low, high = _within(edge.value, result.value)
        slow, fast = _within(edge.speed, result.speed)
        swing = "none" if edge.kind == "zero" else _range(edge.frequency * RPM)
        rows.append(
            (
                CURVES[edge.kind],
                f"{number(slow * RPM)} to {number(fast * RPM)}",
                f"{unit.number(low)} to {unit.text(high)}",
                swing,
                _ends(edge),
            )
        )
    return rows


def limits(result: BallChart) -> list[Check]:
    """Where the chart is not what it seems: each check with what fails it."""
    cut = sum("long" in edge.ends for edge in result.edges)
    stands = math.isfinite(result.stable_from)
    lost = bool(result.missing.any())
    return [
        Check("No such state", f"{_share(result.missing)} of the points" if lost else "none", grade(lost)),
        Check("Curves not followed to their end", str(cut) if cut else "none", grade(cut > 0)),
        Check(
            "Unstable at the last speed in the scene as it stands",
            "no" if stands else "yes",
            grade(not stands),
        ),
    ]


def alt(result: BallChart) -> str:
    """What the figure shows and the numbers a reader would take from it."""
    return (
        f"Chart of stability over speed and {what(result)}: regions that are stable, unstable by the number "
        f"of growing roots, or without such a state, and the curves between them. {answer(result)}"
    )


def _held(result: BallChart) -> str:
    return ", ".join(with_unit(size, UNBALANCE) for size in result.capacity)


def _share(mask: np.ndarray) -> str:
    return f"{number(100.0 * float(np.mean(mask)))} %"


def _within(values: np.ndarray, grid: np.ndarray) -> tuple[float, float]:
    """Least and largest in the chart; the last point of a curve that leaves it lies beyond."""
    return max(float(values.min()), float(grid[0])), min(float(values.max()), float(grid[-1]))


def _range(values: np.ndarray) -> str:
    low, high = number(float(values.min())), number(float(values.max()))
    return low if low == high else f"{low} to {high}"


def _ends(edge: Curve) -> str:
    return " and ".join(dict.fromkeys(_ENDS[end] for end in edge.ends))
