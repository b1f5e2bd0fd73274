"""An optimum as text, for a terminal."""

from __future__ import annotations

import math

from leblanc.results.base import texts
from leblanc.results.optimum import OptimumResult
from leblanc.text.numbers import number
from leblanc.text.run import amplitude_place
from leblanc.units import LENGTH, MASS, ML, UNBALANCE, VOLUME, in_rpm, with_unit

_DIMENSIONS = {dimension.unit.replace("*", " "): dimension for dimension in (LENGTH, MASS, UNBALANCE)}


def describe_optimum(result: OptimumResult) -> list[str]:
    """The answer, what it keeps to, and the closed forms beside it, line by line.

    Parameters
    ----------
    result : the optimum
    """
    return [
        *_answer(result),
        *_constraints(result),
        *_closed_forms(result),
        f"Stability margin over the operating speeds: {number(result.stability_margin)} 1/s"
        + (" (a small whirl grows)" if result.growth > 0.0 else ""),
        *([f"Amplitudes are those {place}."] if (place := amplitude_plane(result)) else []),
        *texts(result.notes),
        *_to_paste(result),
    ]


def summary(result: OptimumResult) -> list[tuple[str, str]]:
    """The main numbers of an optimum, as labels and values."""
    pairs = zip(result.chambers, result.volume.tolist(), strict=True)
    return [
        ("Objective", f"{result.objective}, the {result.meaning}"),
        *(
            (f"Chamber {k + 1}", f"{with_unit(volume, VOLUME)} of {chamber.liquid_name}")
            for k, (chamber, volume) in enumerate(pairs)
        ),
        ("Value", f"{shown(result.value, result.unit)}; without liquid {_baseline(result)}"),
        ("Constraints", result.feasibility.value),
    ]


def answer(result: OptimumResult) -> str:
    """The best volumes and what they give, in one sentence.

    Parameters
    ----------
    result : the optimum
    """
    volumes = " and ".join(with_unit(volume, VOLUME) for volume in result.volume.tolist())
    liquid = f"{volumes}, {with_unit(result.mass, MASS)}" if result.volume.any() else "no liquid"
    kept = "" if result.feasible else f" ({result.feasibility.value})"
    if result.unit == "kg":
        both = shown(result.vibration, "m"), shown(result.vibration_baseline, "m")
        gives = f"the amplitude is {both[0]} instead of {both[1]}"
    else:
        gives = f"the {result.meaning} is {shown(result.value, result.unit)}"
        gives += f" instead of {shown(result.baseline, result.unit)}" if result.baseline > 0.0 else ""
    return f"With {liquid}{kept}, {gives}{f' {place}' if (place := amplitude_plane(result)) else ''}."


def amplitude_plane(result: OptimumResult) -> str:
    """Plane of the amplitudes, in words; empty for a rotor that moves in one plane.

    Parameters
    ----------
    result : the optimum
    """
    return "" if result.response is None else amplitude_place(result.response)


def shown(value: float, unit: str) -> str:
    """A value in the unit that engineers use."""
    dimension = _DIMENSIONS.get(unit)
    if dimension is not None:
        return with_unit(value, dimension)
    return f"{number(value)} {unit}" if unit != "1" else number(value)


def _answer(result: OptimumResult) -> list[str]:
    """Volumes, value, what it is without liquid."""
    lines = [f"Objective: {result.objective}, the {result.meaning}"]
    if not result.feasible:
        lines.append(f"NOT FEASIBLE: {result.feasibility.value}.")
    for k, (chamber, volume) in enumerate(zip(result.chambers, result.volume.tolist(), strict=True)):
        share = volume / chamber.capacity
        lines.append(
            f"Chamber {k + 1}: {with_unit(volume, VOLUME)} of {chamber.liquid_name} "
            f"({number(100.0 * share)} % of what it holds)"
        )
    lines.append(f"Value: {shown(result.value, result.unit)}; without liquid {_baseline(result)}")
    lines.append(f"Liquid: {with_unit(result.mass, MASS)}; {result.evaluations} sets of volumes judged")
    return lines


def _baseline(result: OptimumResult) -> str:
    if result.unit != "kg":
        return shown(result.baseline, result.unit)
    both = f"{shown(result.vibration, 'm')} instead of {shown(result.vibration_baseline, 'm')}"
    return f"{shown(result.baseline, result.unit)}; amplitude {both}"


def _constraints(result: OptimumResult) -> list[str]:
    """One line each."""
    lines = []
    for name, constraint in result.constraints.items():
        mark = "kept" if constraint.satisfied else "EXCEEDED"
        lines.append(
            f"Constraint {name}: {constraint.meaning} {shown(constraint.value, constraint.unit)}, "
            f"at most {shown(constraint.limit, constraint.unit)}: {mark}"
        )
    return lines


def _closed_forms(result: OptimumResult) -> list[str]:
    """The volumes that wet the wall of each chamber."""
    lines = []
    for k, form in enumerate(result.closed_form):
        full = (
            "its wall is never wet up to the lid"
            if math.isinf(form.full_volume)
            else f"{with_unit(form.full_volume, VOLUME)} wet it up to the lid, and more adds nothing"
        )
        lines.append(
            f"Closed form, chamber {k + 1}, {with_unit(form.deflection, LENGTH)} at {in_rpm(form.speed)}: "
            f"{with_unit(form.optimal_volume, VOLUME)} just cover the wall "
            f"({number(100.0 * form.unbalance_share)} % of the largest unbalance); {full}"
        )
    return lines


def _to_paste(result: OptimumResult) -> list[str]:
    """Lines for the scene file."""
    volumes = ", ".join(f'"{volume * ML:.6g} ml"' for volume in result.volume.tolist())
    return [f"For the scene, chamber by chamber: volume = {volumes}"]
