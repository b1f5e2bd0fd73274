"""An optimum as text, for a terminal."""

from __future__ import annotations

import math

from leblanc.results.base import texts
from leblanc.results.optimum import OptimumResult
from leblanc.text.numbers import number
from leblanc.units import ML, MM, RPM


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
        + (" (a small whirl grows)" if result.growth > 0.0 else "")
        + (" (whether a small whirl grows is not known)" if math.isnan(result.growth) else ""),
        *texts(result.notes),
        *_to_paste(result),
    ]


def summary(result: OptimumResult) -> list[tuple[str, str]]:
    """The main numbers of an optimum, as labels and values."""
    pairs = zip(result.chambers, result.volume.tolist(), strict=True)
    return [
        ("Objective", f"{result.objective}, the {result.meaning}"),
        *(
            (f"Chamber {k + 1}", f"{number(volume * ML)} ml of {chamber.liquid_name}")
            for k, (chamber, volume) in enumerate(pairs)
        ),
        ("Value", f"{shown(result.value, result.unit)}; without liquid {_baseline(result)}"),
        ("Constraints", result.feasibility.value),
    ]


def shown(value: float, unit: str) -> str:
    """A value in the unit that engineers use."""
    if unit == "m":
        return f"{number(value * MM)} mm"
    if unit == "kg":
        return f"{number(value * 1e3)} g"
    if unit == "kg m":
        return f"{number(value * 1e6)} g mm"
    return f"{number(value)} {unit}" if unit != "1" else number(value)


def _answer(result: OptimumResult) -> list[str]:
    """Volumes, value, what it is without liquid."""
    lines = [f"Objective: {result.objective}, the {result.meaning}"]
    if not result.feasible:
        lines.append(f"NOT FEASIBLE: {result.feasibility.value}.")
    for k, (chamber, volume) in enumerate(zip(result.chambers, result.volume.tolist(), strict=True)):
        share = volume / chamber.capacity
        lines.append(
            f"Chamber {k + 1}: {volume * ML:.5g} ml of {chamber.liquid_name} ({share:.3%} of what it holds)"
        )
    lines.append(f"Value: {shown(result.value, result.unit)}; without liquid {_baseline(result)}")
    lines.append(f"Liquid: {result.mass * 1e3:.4g} g; {result.evaluations} sets of volumes judged")
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
            else f"{form.full_volume * ML:.5g} ml wet it up to the lid, and more adds nothing"
        )
        lines.append(
            f"Closed form, chamber {k + 1}, {form.deflection * MM:.4g} mm at {form.speed * RPM:.4g} rpm: "
            f"{form.optimal_volume * ML:.5g} ml just cover the wall ({form.unbalance_share:.1%} of the "
            f"largest unbalance); {full}"
        )
    return lines


def _to_paste(result: OptimumResult) -> list[str]:
    """Lines for the scene file."""
    volumes = ", ".join(f'"{volume * ML:.6g} ml"' for volume in result.volume.tolist())
    return [f"For the scene, chamber by chamber: volume = {volumes}"]
