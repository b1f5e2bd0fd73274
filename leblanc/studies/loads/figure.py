"""Clearances, forces under the feet, the margin against walking and the torque of the drive."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from leblanc.core.units import MM, RPM
from leblanc.plotting.page import Caption, Figure, Frame, add_rate_axis, lay_out, number, style
from leblanc.studies.loads.answer import MachineLoads, verdict
from meshes.arrays import Array

Axes = Any  # matplotlib's, which no module that only draws imports

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00")
DASHES = ("-", (0, (4, 1.4)), (0, (1, 1.1)), (0, (5, 1.2, 1, 1.2)))
FRAME = Frame(left=0.72, top=0.46, between=0.12, below=0.42)
OVER_TIME = Frame(left=0.72, top=0.12, between=0.1, below=0.42)
MOST = 8  # points or feet with a line of their own
ROOM = 0.08  # above and below what is drawn


def machine_figure(loads: MachineLoads, caption: Callable[[str], Caption]) -> Figure:
    """Loads and clearances of a machine, panels above one another."""
    panels: list[tuple[float, Callable[[Axes, MachineLoads, Array], None]]] = []
    if loads.points:
        panels.append((1.5, _draw_clearances if loads.clearances else _draw_movements))
    if loads.stands:
        panels += [(1.5, _draw_feet), (1.0, _draw_walking)]
    if (life := loads.bearing_life) is not None:
        panels.append((1.3, _draw_bearings))
        if np.any(life.slip > 0.0) or np.any(life.slip_dry > 0.0):
            panels.append((1.0, _draw_slip))
    panels.append((1.0, _draw_torque))
    across = loads.time if loads.in_time else loads.speed * RPM
    with style():
        figure = Figure()
        rows: list[list[Axes]] = [[figure.add_axes((0, 0, 1, 1), label=str(i))] for i in range(len(panels))]
        for (axes,), (_, draw) in zip(rows, panels, strict=True):
            draw(axes, loads, across)
            room = 0.01 * float(np.ptp(across)) or 0.5
            axes.set_xlim(float(across.min()) - room, float(across.max()) + room)
            axes.xaxis.set_major_formatter(number)
            axes.yaxis.set_major_formatter(number)
            axes.tick_params(labelbottom=axes is rows[-1][0])
        rows[-1][0].set_xlabel("Time (s)" if loads.in_time else "Speed (rpm)")
        if not loads.in_time:
            add_rate_axis(rows[0][0])
        text = "Least clearance, largest force under each foot (thin: at rest) and least margin over a turn."
        if loads.bearing_life is not None:
            text += (
                " Mean load of each bearing (thin: without liquid) beside the least with which balls roll."
            )
        frame = OVER_TIME if loads.in_time else FRAME
        lay_out(figure, rows, [height for height, _ in panels], frame, caption(text))
        figure.alt = f"Curves of clearances, floor forces, margin and torque. {verdict(loads)}".strip()
    return figure


def _look(k: int) -> dict[str, Any]:
    """Colour and dashes of the k-th line."""
    return {
        "color": COLOURS[k % len(COLOURS)],
        "linestyle": DASHES[k % len(DASHES)],
        "linewidth": 1.3,
    }


def _draw_clearances(axes: Axes, loads: MachineLoads, across: Array) -> None:
    known = [k for k, gap in enumerate(loads.gaps) if not math.isnan(gap)]
    for i, k in enumerate(known[:MOST]):
        size = loads.over_turn(loads.worst.clearance[:, k], least=True)
        axes.plot(across, size * MM, label=loads.points[k], **_look(-1 - i))
    _limit(axes, "touches")
    axes.set_ylabel("Clearance (mm)")


def _draw_movements(axes: Axes, loads: MachineLoads, across: Array) -> None:
    for k, name in enumerate(loads.points[:MOST]):
        axes.plot(across, loads.over_turn(loads.worst.moved[:, k]) * MM, label=name, **_look(-1 - k))
    axes.set_ylim(bottom=0.0)
    axes.set_ylabel("Movement (mm)")


def _draw_feet(axes: Axes, loads: MachineLoads, across: Array) -> None:
    for k, rest in enumerate(loads.rest[:MOST].tolist()):
        look = _look(k)
        axes.plot(across, loads.over_turn(loads.worst.floor_force[:, k]), label=f"foot {k + 1}", **look)
        axes.axhline(rest, color=look["color"], linewidth=0.5, zorder=1)
    axes.set_ylabel("Floor force (N)")


def _draw_walking(axes: Axes, loads: MachineLoads, across: Array) -> None:
    w = loads.worst
    lines: tuple[tuple[str, Array, dict[str, Any]], ...] = (
        ("lift-off", w.lift_off, {"color": "0.45", "linewidth": 0.9}),
        ("slip", w.slip, {"color": "0.45", "linewidth": 0.9, "linestyle": (0, (2, 1.5))}),
        ("margin against walking", w.walking, {"color": "0.15", "linewidth": 1.4}),
    )
    for label, values, look in lines:
        axes.plot(across, 100.0 * loads.over_turn(values, least=True), label=label, **look)
    _limit(axes, "walks")
    axes.set_ylim(top=104.0)
    axes.set_ylabel("Margin (%)")


def _draw_bearings(axes: Axes, loads: MachineLoads, across: Array) -> None:
    life, rpm = loads.bearing_life, across[loads.asked]
    assert life is not None
    for k, name in enumerate(loads.bearings):
        look = _look(k)
        axes.plot(rpm, life.load[k], label=f"{name}", **look)
        axes.plot(rpm, life.load_dry[k], color=look["color"], linewidth=0.5, zorder=1)
    least = life.least_load[np.isfinite(life.least_load)]
    axes.axhline(float(least.max()), color="0.15", linewidth=0.9, linestyle=(0, (2, 1.5)), label="least load")
    axes.set_yscale("log")
    axes.set_ylabel("Bearing load (N)")


def _draw_slip(axes: Axes, loads: MachineLoads, across: Array) -> None:
    life, rpm = loads.bearing_life, across[loads.asked]
    assert life is not None
    for k in range(len(loads.bearings)):
        look = _look(k)
        axes.plot(rpm, 100.0 * life.slip[k], **look)
        axes.plot(rpm, 100.0 * life.slip_dry[k], color=look["color"], linewidth=0.5, zorder=1)
    axes.set_ylim(bottom=0.0)
    axes.set_ylabel("Cage slip (%)")


def _draw_torque(axes: Axes, loads: MachineLoads, across: Array) -> None:
    axes.plot(across, loads.torque, color="0.15", linewidth=1.2)
    axes.set_ylabel("Torque (N m)")


def _limit(axes: Axes, label: str) -> None:
    """A line at 0 and, where something is below it, what that means."""
    low, high = axes.get_ylim()
    low = min(low, -ROOM * high)
    axes.axhspan(low, 0.0, color="#D55E00", alpha=0.15, linewidth=0, label=f"{label} below 0", zorder=0)
    axes.set_ylim(low, high)
