"""The answer of a spindle unit as text."""

from __future__ import annotations

import cmath
import math

from leblanc.core.units import LENGTH, in_rpm, number, with_unit
from leblanc.results.spindles.unit import RECIPROCITY, WAYS, SpindleResult
from leblanc.studies.run.words import Limit

PER_NEWTON = 1e9  # nm/N in one m/N
THEORIES = {
    "euler": "bending and distributed mass",
    "rayleigh": "bending, distributed mass and rotary inertia",
    "timoshenko": "bending, shear, distributed mass and rotary inertia",
}
HEAD = (
    "Frequency (Hz)",
    "measured (nm/N)",
    "phase (deg)",
    "wanted (nm/N)",
    "phase (deg)",
    "|W|",
    "phase (deg)",
)


def hertz(rate: float) -> str:
    """A frequency for print.

    Parameters
    ----------
    rate : rad/s
    """
    return f"{number(rate / (2.0 * math.pi))} Hz"


def answer(result: SpindleResult) -> str:
    """Where it resonates and what the housing tells of the tool there, in one or two sentences.

    Parameters
    ----------
    result : the answer
    """
    low, high = result.frequency[0] / (2.0 * math.pi), hertz(float(result.frequency[-1]))
    if not result.modes:
        return f"No natural frequency lies between {number(low)} and {high}."
    every = ", ".join(number(mode.frequency / (2.0 * math.pi)) for mode in result.modes)
    strongest = max(result.modes, key=lambda mode: abs(mode.wanted))
    return (
        f"Natural frequencies between {number(low)} and {high}: {every} Hz. A force of 1 N at "
        f"{result.driven_at} moves {result.wanted_at} most at {hertz(strongest.frequency)}, by "
        f"{with_unit(abs(strongest.wanted), LENGTH)}, "
        f"{number(abs(strongest.wanted / strongest.measured))} times what {result.measured_at} shows."
    )


def facts(result: SpindleResult) -> list[tuple[str, str]]:
    """The first natural frequencies and W there: label and value.

    Parameters
    ----------
    result : the answer
    """
    found = [
        (
            f"Natural frequency {k + 1}",
            f"{hertz(mode.frequency)}, |W| {number(abs(mode.wanted / mode.measured))}",
        )
        for k, mode in enumerate(result.modes[:6])
    ]
    return [*found, ("Natural frequencies in the band", str(len(result.modes))), *cage_rows(result)]


def cage_rows(result: SpindleResult) -> list[tuple[str, str]]:
    """Speed of each cage: label and value; nothing where no balls are given.

    Parameters
    ----------
    result : the answer
    """
    return [(f"Cage of {cage.name}", f"{in_rpm(float(cage.speed[0]))} without slip") for cage in result.cages]


def compliance_rows(result: SpindleResult) -> list[tuple[str, ...]]:
    """Compliances and W at the first frequency, at each natural one and at the last: cells of `HEAD`.

    Parameters
    ----------
    result : the answer
    """
    ends = [(float(result.frequency[k]), result.measured[k], result.wanted[k]) for k in (0, -1)]
    lines = [ends[0], *((mode.frequency, mode.measured, mode.wanted) for mode in result.modes), ends[1]]
    return [
        (number(rate / (2.0 * math.pi)), *_polar(q1, PER_NEWTON), *_polar(q2, PER_NEWTON), *_polar(q2 / q1))
        for rate, q1, q2 in lines
    ]


def _polar(value: complex, unit: float = 1.0) -> tuple[str, str]:
    return number(abs(value) * unit), f"{math.degrees(cmath.phase(value)):.1f}"


def limits(result: SpindleResult) -> list[Limit]:
    """Whether the answer holds what it must: each check with its number.

    Parameters
    ----------
    result : the answer
    """
    ways = result.ways_apart
    told = "not asked: no joint between two beams" if math.isnan(ways) else f"{ways:.1e} apart"
    return [
        Limit(
            "Force and motion exchanged", f"{result.reciprocity:.1e} apart", result.reciprocity > RECIPROCITY
        ),
        Limit("By the reactions in the joints", told, ways > WAYS),
        Limit(
            "Joints take energy at every frequency",
            "yes" if result.least_dissipation >= 0.0 else f"no, by {-result.least_dissipation:.1e}",
            result.least_dissipation < -RECIPROCITY,
        ),
    ]


def remarks(result: SpindleResult) -> list[str]:
    """What a reader must know of the model.

    Parameters
    ----------
    result : the answer
    """
    return [
        f"Beams of round sections with {THEORIES[result.theory]}, solved exactly at each frequency; joints "
        "are springs with dampers.",
        "Motion in one plane; gyroscopic moments of the spinning shaft are left out, as in the source.",
        "Natural frequencies are those without damping; all of the band are found, by counting.",
    ]


def alt(result: SpindleResult) -> str:
    """What the figure shows."""
    return (
        f"Size and phase of the compliances of {result.measured_at} and {result.wanted_at} under a force at "
        f"{result.driven_at}, and of their ratio W, over frequency. {answer(result)}"
    )


def shapes_alt(result: SpindleResult) -> str:
    """What the figure of the shapes shows."""
    every = ", ".join(hertz(mode.frequency) for mode in result.modes)
    return f"Deflection along each beam in the natural motions at {every}."
