"""What a machine is judged by, as a table and a sentence: clearances, feet, walking, parts, motor."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from leblanc.core.units import LENGTH, NOT_FOUND, RPM, in_rpm, number, with_unit
from leblanc.results.machine.loads import MachineLoads, Worst

LITTLE = 0.2  # of the friction or weight at rest: a machine with less is near walking


@dataclass(frozen=True)
class LoadRow:
    """One line of the table."""

    label: str  #: what it is
    size: str  #: its worst, with the unit
    speed: str  #: where that is, rpm and s; no time over speed
    time: str
    remark: str  #: what it is beside
    failed: bool = False  #: it must not be


def load_rows(loads: MachineLoads) -> list[LoadRow]:
    """The worst of each quantity, what matters most first."""
    found = [_clearance(loads, name, worst) for name, worst in loads.clearances.items()]
    if loads.stands:
        walking = loads.walking
        size = _percent(walking.value) if math.isfinite(walking.value) else NOT_FOUND
        text = "100 % at rest; at 0 a foot slips or lifts off"
        found.append(_row("Margin against walking", walking, size, text, walking.value <= 0.0))
        for k, worst in enumerate(loads.feet):
            text = f"{number(float(loads.rest[k]))} N at rest"
            found.append(_row(f"Foot {k + 1}, largest force", worst, _newton(worst), text))
    for k, name in enumerate(loads.points):
        worst = loads.largest(loads.worst.moved[:, k])
        found.append(_row(f"Movement of {name}", worst, _length(worst.value), "from where it rests"))
    for kind in ("spring", "damper", "support", "bearing"):
        found += _strongest(loads, kind)
    found += _blow(loads)
    worst = loads.largest(loads.torque)
    found.append(_row("Motor, torque", worst, _sized(worst.value, "N m"), _share(loads)))
    worst = loads.largest(loads.power)
    found.append(_row("Motor, power", worst, _sized(worst.value, "W"), ""))
    return found


def _blow(loads: MachineLoads) -> list[LoadRow]:
    """The hardest blow of liquid that is caught or falls on a bearing; nothing where there was none."""
    if not loads.bearings or not np.isfinite(loads.impulse).any():
        return []
    k, j = np.unravel_index(np.nanargmax(loads.impulse), loads.impulse.shape)
    time = float(loads.jumps[k])
    worst = Worst(float(loads.impulse[k, j]), float(np.interp(time, loads.time, loads.speed)), time)
    said = f"of liquid that is caught or falls, on {loads.bearings[j]}"
    return [_row("Bearing, hardest blow", worst, f"{number(worst.value)} N s", said)]


def _share(loads: MachineLoads) -> str:
    """What the torque is for."""
    if loads.in_time:
        return "to speed up the drum and the liquid, and for the dampers"
    return "at constant speed, for dampers and liquid"


def _clearance(loads: MachineLoads, name: str, worst: Worst) -> LoadRow:
    gap = float(loads.gaps[loads.points.index(name)])
    touches = worst.value <= 0.0
    text = f"of {with_unit(gap, LENGTH)} at rest" + (": it touches" if touches else "")
    return _row(f"Clearance of {name}", worst, _length(worst.value), text, touches)


def _strongest(loads: MachineLoads, kind: str) -> list[LoadRow]:
    """The part of a kind with the largest force; nothing where there is none."""
    names = loads.bearings if kind == "bearing" else loads.holders
    values = loads.worst.bearing if kind == "bearing" else loads.worst.holder
    found = [(name, loads.largest(values[:, k])) for k, name in enumerate(names) if name.startswith(kind)]
    known = [(name, worst) for name, worst in found if not math.isnan(worst.value)]
    if not known:
        return []
    name, worst = max(known, key=lambda entry: entry[1].value)
    label = f"{kind.capitalize()}, largest force"
    return [_row(label, worst, _newton(worst), f"in {name}" if len(found) > 1 else "")]


def _row(label: str, worst: Worst, size: str, remark: str, failed: bool = False) -> LoadRow:
    time = "" if math.isnan(worst.time) else number(worst.time)
    speed = number(worst.speed * RPM) if math.isfinite(worst.speed) else ""
    return LoadRow(label, size, speed, time, remark, failed)


def _length(value: float) -> str:
    return with_unit(value, LENGTH) if math.isfinite(value) else _sized(value, "")


def _percent(value: float) -> str:
    size = 100.0 * value
    return f"{size:.0f} %" if abs(size) >= 10.0 else f"{number(float(f'{size:.2g}'))} %"


def _newton(worst: Worst) -> str:
    return _sized(worst.value, "N")


def _sized(value: float, unit: str) -> str:
    if math.isnan(value):
        return NOT_FOUND
    return f"{number(value)} {unit}" if math.isfinite(value) else "without bound"


def verdict(loads: MachineLoads) -> str:
    """Whether the machine stays where it is and whole, in a sentence or two; empty where nothing tells."""
    told = []
    if loads.stands and not math.isnan(loads.walking.value):
        left = f"{_percent(loads.walking.value)} of its hold left at {in_rpm(loads.walking.speed)}"
        if loads.walking.value <= 0.0:
            told.append(f"The machine walks: a foot slips or lifts off at {in_rpm(loads.walking.speed)}.")
        elif loads.walking.value < LITTLE:
            told.append(f"The machine is near walking, with {left}.")
        else:
            told.append(f"The machine does not walk: it has {left}.")
    known = {name: worst for name, worst in loads.clearances.items() if not math.isnan(worst.value)}
    touching = [name for name, worst in known.items() if worst.value <= 0.0]
    if touching:
        told.append(f"It touches its housing: {', '.join(touching)}.")
    elif known:
        name = min(known, key=lambda point: known[point].value)
        least = known[name]
        told.append(f"The least clearance is {_length(least.value)}, {name}, at {in_rpm(least.speed)}.")
    return " ".join(told)


def load_table(loads: MachineLoads) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """Head and rows for a terminal."""
    time = ("after (s)",) if loads.in_time else ()
    rows = [
        (row.label, row.size, row.speed, *((row.time,) if time else ()), row.remark)
        for row in load_rows(loads)
    ]
    return ("Machine", "worst", "at (rpm)", *time, ""), rows
