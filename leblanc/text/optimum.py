"""An optimum in words, for a terminal."""

from __future__ import annotations

import math

from leblanc.studies.optimise.optimise import OptimumRecord
from leblanc.text.numbers import number
from leblanc.units import ML, MM, RPM


def describe_optimum(record: OptimumRecord) -> list[str]:
    """The answer, what it keeps to, and the closed forms beside it, line by line.

    Parameters
    ----------
    record : the optimum
    """
    return [
        *_answer(record),
        *_constraints(record),
        *_closed_forms(record),
        f"Stability margin over the operating speeds: {number(-record.growth)} 1/s"
        + (" (a small whirl grows)" if record.growth > 0.0 else ""),
        *record.notes,
        *_to_paste(record),
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


def _answer(record: OptimumRecord) -> list[str]:
    """Volumes, value, what it is without liquid."""
    lines = [f"Objective: {record.objective}, the {record.meaning}"]
    if not record.feasible:
        lines.append("NOT FEASIBLE: no volumes meet every constraint; these exceed them least.")
    for k, (fill, volume) in enumerate(zip(record.scene.fills, record.volume.tolist(), strict=True)):
        share = volume / fill.chamber.capacity
        lines.append(
            f"Chamber {k + 1}: {volume * ML:.5g} ml of {fill.liquid.name} ({share:.3%} of what it holds)"
        )
    lines.append(f"Value: {shown(record.value, record.unit)}; without liquid {_baseline(record)}")
    lines.append(f"Liquid: {record.mass * 1e3:.4g} g; {record.evaluations} sets of volumes judged")
    return lines


def _baseline(record: OptimumRecord) -> str:
    if record.unit != "kg":
        return shown(record.baseline, record.unit)
    both = f"{shown(record.vibration, 'm')} instead of {shown(record.vibration_baseline, 'm')}"
    return f"{shown(record.baseline, record.unit)}; amplitude {both}"


def _constraints(record: OptimumRecord) -> list[str]:
    """One line each."""
    lines = []
    for name, one in record.constraints.items():
        mark = "kept" if one.satisfied else "EXCEEDED"
        lines.append(
            f"Constraint {name}: {one.text} {shown(one.value, one.unit)}, "
            f"at most {shown(one.limit, one.unit)}: {mark}"
        )
    return lines


def _closed_forms(record: OptimumRecord) -> list[str]:
    """The covering volumes of each chamber."""
    lines = []
    for k, one in enumerate(record.covering):
        full = (
            "its wall is never wet up to the lid"
            if math.isinf(one.full_volume)
            else f"{one.full_volume * ML:.5g} ml wet it up to the lid, and more adds nothing"
        )
        lines.append(
            f"Closed form, chamber {k + 1}, {one.deflection * MM:.4g} mm at {one.speed * RPM:.4g} rpm: "
            f"{one.optimal_volume * ML:.5g} ml just cover the wall ({one.share:.1%} of the largest "
            f"unbalance); {full}"
        )
    return lines


def _to_paste(record: OptimumRecord) -> list[str]:
    """Lines for the scene file."""
    volumes = ", ".join(f'"{volume * ML:.6g} ml"' for volume in record.volume.tolist())
    return [f"For the scene, chamber by chamber: volume = {volumes}"]
