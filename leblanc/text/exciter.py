"""The answer of a vibrating table with balls as text."""

from __future__ import annotations

import math

from leblanc.core.units import LENGTH, in_rpm, over_rpm, with_unit
from leblanc.results.exciter import ExciterResult
from leblanc.text.numbers import NOT_FOUND, ranges
from leblanc.text.run import Limit

NUMBERS = {
    "smallness": "Share of the balls in the moving mass, over their rolling inertia",
    "drag": "Drag of the balls",
    "unbalance": "Unbalance of the shaft, over that of the balls",
    "damping": "Damping ratio of the platform",
}


def _rpm(speed: float, missing: str = NOT_FOUND) -> str:
    return in_rpm(speed, missing)


def answer(result: ExciterResult) -> str:
    """Up to where the balls stick, in one sentence.

    Parameters
    ----------
    result : the answer
    """
    if not math.isfinite(result.critical):
        return "The balls can stick together at one speed only, whatever the speed of the shaft."
    return (
        f"The balls stick together up to {_rpm(result.critical)} of the shaft, the platform vibrating at two "
        f"frequencies; from {_rpm(result.characteristic[0])} to {_rpm(result.characteristic[2])} they have "
        "three stuck speeds."
    )


def facts(result: ExciterResult) -> list[tuple[str, str]]:
    """Speeds that decide how the table behaves, and its vibration at the last speed: label and value.

    Parameters
    ----------
    result : the answer
    """
    first, through, last = result.characteristic
    none = "none: one stuck speed at every speed"
    three = f"{_rpm(first)} to {_rpm(last)}" if math.isfinite(first) else none
    at = _rpm(float(result.speed[-1]))
    slow = (
        with_unit(float(result.slow[-1]), LENGTH) if result.dual_frequency[-1] else "none: they do not stick"
    )
    return [
        ("Natural frequency of the platform", _rpm(result.machine.natural_frequency)),
        ("Three stuck speeds, shaft from and to", three),
        ("Slowest stuck speed at the resonance, shaft at", _rpm(through, "none")),
        ("Critical speed, up to which the balls stick", _rpm(result.critical, "none")),
        ("The same by the source's regression", _rpm(result.printed_critical, "outside its ranges")),
        (f"Vibration with the balls at {at}", slow),
        (f"Vibration with the shaft at {at}", with_unit(float(result.fast[-1]), LENGTH)),
    ]


def limits(result: ExciterResult) -> list[Limit]:
    """Where the answer is not what it seems: each check with what fails it.

    Parameters
    ----------
    result : the answer
    """
    lost = [check.speed for check in result.checks if not check.converged]
    beyond = ~result.dual_frequency
    outside = not math.isfinite(result.printed_critical)
    return [
        Limit("Time integration not finite", ", ".join(map(in_rpm, lost)) or "none", bool(lost)),
        Limit("Balls do not stick", ranges(result.speed, beyond), bool(beyond.any())),
        Limit("Regression of the source", "outside its ranges" if outside else "inside", outside),
    ]


def alt(result: ExciterResult) -> str:
    """What the figure shows."""
    values = dict(facts(result))
    return (
        "Curves of the speeds at which the balls can stick together and of the platform's two vibrations "
        f"over the shaft's speed; critical speed: {values['Critical speed, up to which the balls stick']}."
    )


def lines(result: ExciterResult) -> list[str]:
    """The answer in a few lines.

    Parameters
    ----------
    result : the answer
    """
    sentences = [f"Natural frequency of the platform: {in_rpm(result.machine.natural_frequency)}"]
    if math.isfinite(result.critical):
        first, _, last = result.characteristic
        sentences += [
            f"Three stuck speeds of the balls {over_rpm(first, last)} of the shaft",
            f"Critical speed, up to which the balls stick together: {in_rpm(result.critical)}",
        ]
    else:
        sentences.append("One stuck speed of the balls at every speed of the shaft")
    for check in result.checks:
        began = f"Integrated at {in_rpm(check.speed)}: balls"
        if not check.holds:
            sentences.append(f"{began} leave")
            continue
        both = ""
        if math.isfinite(check.slow):
            slow, fast = with_unit(check.slow, LENGTH), with_unit(check.fast, LENGTH)
            both = f", platform {slow} with them and {fast} with the shaft"
        sentences.append(f"{began} stay at {in_rpm(check.stuck_speed)}{both}")
    return sentences
