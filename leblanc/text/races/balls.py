"""The answer of a rotor with balls as text."""

from __future__ import annotations

import math

import numpy as np

from leblanc.core.units import (
    LENGTH,
    MOST_RANGES,
    NOT_FOUND,
    UNBALANCE,
    amplitudes_are,
    in_rpm,
    number,
    ranges,
    rpm_bands,
    with_unit,
)
from leblanc.results.races.states import BallsResult
from leblanc.studies.run.notes import plane_words
from leblanc.studies.run.words import Limit

FAR = math.radians(15.0)  # swing of a ball up to which small swings tell it


def answer(result: BallsResult) -> str:
    """From where on the balls balance the rotor, and what they do at the largest amplitude."""
    bare = int(np.argmax(np.where(np.isfinite(result.amplitude_without), result.amplitude_without, -1.0)))
    without = (
        f"{with_unit(float(result.amplitude_without[bare]), LENGTH)} at {in_rpm(float(result.speed[bare]))}"
    )
    first = "The balls balance the rotor at none of these speeds"
    if math.isfinite(result.balanced_from):
        first = f"From {in_rpm(result.balanced_from)} on the balls balance the rotor"
    if not result.stable.any():
        found = result.converged.any()
        nothing = (
            "no state that creeping balls come to is stable"
            if found
            else "no state of balls at rest was found"
        )
        return f"{first}: {nothing}; without balls the largest amplitude is {without}."
    most = int(np.argmax(np.where(result.stable, result.amplitude, -1.0)))
    peak = f"{with_unit(float(result.amplitude[most]), LENGTH)} at {in_rpm(float(result.speed[most]))}"
    return f"{first}; the largest amplitude of a stable state is {peak}, without balls {without}."


def _balanced_at(result: BallsResult) -> str:
    """Speeds at which the balanced state is stable."""
    bands = result.balanced_bands
    if not bands or len(bands) > MOST_RANGES:
        return ranges(result.speed, result.balanced)
    whole = bands[0][0] <= result.speed.min() and bands[0][1] >= result.speed.max()
    return "all speeds" if whole else rpm_bands(bands)


def facts(result: BallsResult) -> list[tuple[str, str]]:
    """What the balls can hold, where they balance, and the state at the last speed: label and value."""
    last = in_rpm(float(result.speed[-1]))
    held = ", ".join(with_unit(size, UNBALANCE) for size in result.capacity)
    known = bool(result.converged[-1])
    places = ", ".join(number(math.degrees(angle)) for angle in result.ball_angle[-1])
    rows = [
        ("Unbalance that the balls of each race hold", held),
        ("Balanced state stable at", _balanced_at(result)),
        (f"Balls at {last}", f"{result.state[-1]}, at {places} deg" if known else NOT_FOUND),
        (f"Amplitude at {last}", with_unit(float(result.amplitude[-1]), LENGTH)),
        (f"Without balls at {last}", with_unit(float(result.amplitude_without[-1]), LENGTH)),
        (
            f"Growth of small motions at {last}",
            f"{number(float(result.growth[-1]))} 1/s" if known else NOT_FOUND,
        ),
    ]
    if result.growth_range is not None and result.family_dimension[-1] > 0:
        least, largest = map(float, result.growth_range[-1])
        rows.append((f"Growth over the family at {last}", f"{number(least)} to {number(largest)} 1/s"))
    tilts = result.kind != "jeffcott"
    rows.append(amplitudes_are(plane_words(result.position, chambers=True) if tilts else ""))
    if any(result.sticking):
        rows.append(("Balls stay below a deflection of", with_unit(max(result.sticking), LENGTH)))
    return rows


def limits(result: BallsResult) -> list[Limit]:
    """Where the answer is not what it seems: each check with what fails it."""
    several = result.states.stable.sum(axis=1) > 1
    missed = np.zeros(result.speed.shape, dtype=bool)
    if result.error_estimate is not None and result.tolerance is not None:
        missed = result.converged & ~(result.error_estimate <= result.tolerance)
    checks = [
        ("No state found", ~result.converged),
        ("No state is stable", result.unstable & result.converged),
        ("Stable only elsewhere in the family", result.elsewhere),
        ("Several states are stable, the largest is told", several),
        ("More amplitude than without balls", result.amplitude > result.amplitude_without),
    ]
    if result.liquid_model and result.tolerance is not None:
        checks.append((f"Error above {number(100.0 * result.tolerance)} % or unknown", missed))
    if result.gravity is not None and result.in_range is not None:
        far = np.nan_to_num(result.gravity.ball_swing).max(axis=1) > FAR
        checks += [
            ("Gravity outweighs the spin", ~result.in_range),
            (f"Balls swing by more than {number(math.degrees(FAR))} deg", far & result.in_range),
        ]
    return [Limit(label, ranges(result.speed, mask), bool(mask.any())) for label, mask in checks]


def alt(result: BallsResult) -> str:
    """What the figure shows."""
    return (
        "Curves of the amplitude over speed with balls and without, and the angles at which the balls rest "
        f"in the drum. {answer(result)}"
    )
