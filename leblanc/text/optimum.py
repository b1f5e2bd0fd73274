"""An optimum as text, for a terminal."""

from __future__ import annotations

import math

import numpy as np

from leblanc.core.notes import texts
from leblanc.core.units import (
    LENGTH,
    MASS,
    ML,
    UNBALANCE,
    VOLUME,
    amplitude_sentence,
    celsius,
    in_peak,
    in_rpm,
    number,
    unit_for,
    with_unit,
)
from leblanc.results.optimum import ConditionTable, OptimumCode, OptimumResult
from leblanc.studies.run.words import amplitude_place, quality_words

_DIMENSIONS = {dimension.unit.replace("*", " "): dimension for dimension in (LENGTH, MASS, UNBALANCE)}


def describe_optimum(result: OptimumResult) -> list[str]:
    """The answer, what it keeps to, and the closed forms beside it, line by line."""
    return [
        *_answer(result),
        *_constraints(result),
        *_closed_forms(result),
        f"Stability margin over the operating speeds: {number(result.stability_margin)} 1/s"
        + (" (a small whirl grows)" if result.growth > 0.0 else "")
        + (" (whether a small whirl grows is not known)" if math.isnan(result.growth) else ""),
        *_quality(result),
        *_over_conditions(result),
        amplitude_sentence(amplitude_plane(result)),
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
    """The best volumes and what they give, in one sentence."""
    volumes = " and ".join(with_unit(volume, VOLUME) for volume in result.volume.tolist())
    liquid = f"{volumes}, {with_unit(result.mass, MASS)}" if result.volume.any() else "no liquid"
    kept = "" if result.feasible else f" ({result.feasibility.value})"
    if result.unit == "kg":
        both = shown(result.vibration, "m"), shown(result.vibration_baseline, "m")
        gives = f"the amplitude is {both[0]} instead of {both[1]}"
    else:
        gives = f"the {result.meaning} is {shown(result.value, result.unit)}"
        gives += f" instead of {shown(result.baseline, result.unit)}" if result.baseline > 0.0 else ""
    place = amplitude_plane(result) if result.unit in ("m", "kg", "kg m") else ""
    return f"With {liquid}{kept}, {gives}{f' {place}' if place else ''}."


def amplitude_plane(result: OptimumResult) -> str:
    """Plane of the amplitudes, in words; empty for a rotor that moves in one plane."""
    return "" if result.response is None else amplitude_place(result.response)


def nearest(result: OptimumResult) -> str:
    """What is exceeded where no volumes meet every constraint, and by how much."""
    exceeded = [
        f"{name.replace('_', ' ')}: {own.meaning} {shown(own.value, own.unit)}, at most "
        f"{shown(own.limit, own.unit)}"
        for name, own in result.exceeded.items()
    ]
    return f"{result.feasibility.value} ({'; '.join(exceeded)})"


def shown(value: float, unit: str) -> str:
    """A value in the unit that engineers use."""
    dimension = _DIMENSIONS.get(unit)
    if dimension is not None:
        return with_unit(value, dimension)
    if unit == "m/s":
        return f"{number(value * 1e3)} mm/s"
    return f"{number(value)} {unit}" if unit != "1" else number(value)


def _answer(result: OptimumResult) -> list[str]:
    """Volumes, value, what it is without liquid."""
    lines = [f"Objective: {result.objective}, the {result.meaning}"]
    if result.interrupted:
        said = [note.data["searched"] for note in result.notes if note.code is OptimumCode.INTERRUPTED]
        lines.append(f"INTERRUPTED: {'no front' if any(said) else 'the best of what was tried until then'}.")
    if not result.feasible:
        lines.append(f"NOT FEASIBLE: {nearest(result)}.")
    for k, (chamber, volume) in enumerate(zip(result.chambers, result.volume.tolist(), strict=True)):
        share = volume / chamber.capacity
        lines.append(
            f"Chamber {k + 1}: {with_unit(volume, VOLUME)} of {chamber.liquid_name} "
            f"({number(100.0 * share)} % of what it holds)"
        )
    lines.append(f"Value: {shown(result.value, result.unit)}; without liquid {_baseline(result)}")
    lines.append(f"Liquid: {with_unit(result.mass, MASS)}; {result.evaluations} sets of volumes judged")
    if result.unit == "m":
        within = f"{number(100.0 * result.equal_within)} %"
        lines.append(
            f"Values that differ by less than {within} of the best count as equal: this is the least liquid "
            "for them"
        )
    return lines


def _baseline(result: OptimumResult) -> str:
    if result.unit != "kg":
        return shown(result.baseline, result.unit)
    both = f"{shown(result.vibration, 'm')} instead of {shown(result.vibration_baseline, 'm')}"
    return f"{shown(result.baseline, result.unit)}; amplitude {both}"


def quality(result: OptimumResult) -> tuple[str, str] | None:
    """Balance quality at the working speed as label and value; None where it is not known."""
    if result.balance_quality is None or result.balance_quality_dry is None:
        return None
    wet, dry = quality_words(result.balance_quality), quality_words(result.balance_quality_dry)
    return f"Balance quality at {in_rpm(result.working_speed)}", f"{wet}; without liquid {dry}"


def _quality(result: OptimumResult) -> list[str]:
    said = quality(result)
    return [] if said is None else [": ".join(said)]


LISTED = 7  # temperatures, or unbalances, of a table on the terminal


def over_conditions(table: ConditionTable) -> tuple[list[str], list[list[str]]]:
    """Amplitudes, mm, over some of the temperatures and unbalances: head and rows."""
    length = unit_for(LENGTH, *table.amplitude.ravel().tolist(), *table.amplitude_dry.tolist())
    loads = [load_words(size) for size in table.unbalance.tolist()]
    dry = [length.number(size) for size in table.amplitude_dry.tolist()]
    if table.heated:
        rows = [
            [
                celsius(float(table.temperature[k])),
                *(length.number(size) for size in table.amplitude[k].tolist()),
                number(float(table.stability_margin[k])),
            ]
            for k in _some(table.temperature.size)
        ]
        head = [f"Amplitude ({in_peak(length.name)})", *loads, "stability margin (1/s)"]
        return head, [*rows, ["without liquid", *dry, ""]]
    rows = [[loads[k], length.number(float(table.amplitude[0, k])), dry[k]] for k in _some(len(loads))]
    unit = in_peak(length.name)
    return ["Unbalance", f"amplitude ({unit})", f"without liquid ({unit})"], rows


def _some(count: int) -> list[int]:
    """Places of a few lines of a long table, its ends among them."""
    return sorted(set(np.linspace(0, count - 1, LISTED).round().astype(int).tolist()))


def worst_condition(table: ConditionTable) -> str:
    """The condition that decides, in words."""
    k = table.decisive
    heat = f" and {celsius(float(table.condition_temperature[k]))}" if table.heated else ""
    what = "Worst" if table.quantile == 1.0 else f"{number(table.quantile)} quantile"
    both = table.condition_amplitude, table.condition_amplitude_dry
    wet, dry = (with_unit(float(amplitude[k]), LENGTH) for amplitude in both)
    load, count = load_words(table.condition_unbalance[k].tolist()), table.condition_amplitude.size
    return f"{what} of {count} conditions: {wet} at {load}{heat} ({dry} without liquid)"


def load_words(sizes: list[float]) -> str:
    """Unbalances in one unit."""
    unit = unit_for(UNBALANCE, *sizes)
    return f"{', '.join(map(unit.number, sizes))} {unit.name}"


def _over_conditions(result: OptimumResult) -> list[str]:
    """The table over temperature and unbalance, and the condition that decides."""
    if result.robust is None:
        return []
    head, rows = over_conditions(result.robust)
    widths = [max(len(line[k]) for line in (head, *rows)) for k in range(len(head))]
    padded = (
        [cell.rjust(widths[k]) if k else cell.ljust(widths[k]) for k, cell in enumerate(line)]
        for line in (head, *rows)
    )
    return [*("  ".join(line) for line in padded), worst_condition(result.robust)]


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
