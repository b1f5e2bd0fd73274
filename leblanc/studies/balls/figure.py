"""The figure of a rotor with balls: amplitude of the states, and where the balls rest, over speed."""

from __future__ import annotations

from typing import Any

import numpy as np

from leblanc.core.notes import assumed_words, one_line
from leblanc.core.units import MM, MM_PEAK, RPM
from leblanc.plotting.curves import gapped
from leblanc.plotting.page import (
    Caption,
    Figure,
    Frame,
    add_rate_axis,
    lay_out,
    number,
    style,
)
from leblanc.studies.balls.answer import BallsAnswer, alt, sentence
from leblanc.studies.balls.races import in_race
from leblanc.studies.loads.figure import machine_figure
from leblanc.studies.run.figure import DRY, WET

FRAME = Frame(left=0.72, top=0.46, between=0.14, below=0.42)
_RACES = ((WET, "o"), ("#CC79A7", "s"), ("#009E73", "^"))  # colour and mark of a race
_FAR = 1.6  # times the largest of stable states and of the bare rotor: unstable ones above are cut


def balls_figure(result: BallsAnswer) -> Figure:
    """Amplitudes above, angles of the balls in the drum below."""
    with style():
        figure = Figure()
        figure.alt = alt(result)
        above: Any = figure.add_axes((0, 0, 1, 1), label="amplitude")
        below: Any = figure.add_axes((0, 0, 1, 1), label="angles")
        _draw_amplitudes(above, result)
        _draw_angles(below, result)
        low, high = float(result.speed.min()) * RPM, float(result.speed.max()) * RPM
        margin = 0.01 * (high - low) if high > low else 1.0
        for axes in (above, below):
            axes.set_xlim(low - margin, high + margin)
            axes.xaxis.set_major_formatter(number)
            axes.yaxis.set_major_formatter(number)
        above.tick_params(labelbottom=False)
        below.set_xlabel("Speed (rpm)")
        add_rate_axis(above, "Speed (rad/s)")
        zero = "the unbalance" if result.kind == "jeffcott" else "angle 0 of the unbalances"
        text = f"{sentence(result)} Zero mark: {zero}."
        lay_out(figure, [[above], [below]], [2.3, 1.6], FRAME, _caption(result, text))
    return figure


def loads_figure(result: BallsAnswer) -> Figure:
    """Clearances, forces under the feet, margin against walking and torque of stable states over speed."""
    assert result.loads is not None
    return machine_figure(result.loads, lambda text: _caption(result, f"{text} Stable states only."))


def _draw_amplitudes(axes: Any, result: BallsAnswer) -> None:
    """Stable state, unstable ones as small marks, and the rotor without balls."""
    rpm, shown = result.speed * RPM, np.where(result.stable, result.amplitude, np.nan)
    bare = np.where(np.isfinite(result.amplitude_without), result.amplitude_without, np.nan)
    label = "without balls" if result.liquid_mass == 0.0 else "without balls, with liquid"
    axes.plot(rpm, bare * MM, color=DRY, linestyle=(0, (4, 2)), linewidth=1.1, label=label)
    loose = (result.states.kind > 0) & ~result.states.stable
    row, column = np.nonzero(loose)
    if row.size:
        look = {"linestyle": "none", "marker": ".", "markersize": 2.2, "color": "0.55"}
        axes.plot(rpm[row], result.sizes[row, column] * MM, label="unstable states", zorder=1.5, **look)
    jump = np.flatnonzero(result.state[1:] != result.state[:-1])
    breaks = np.zeros(max(rpm.size - 1, 0), dtype=bool)
    breaks[jump] = True
    axes.plot(*gapped(rpm, shown * MM, breaks), color=WET, linewidth=1.6, label="stable state", zorder=3.0)
    high = np.zeros(1)
    if result.stuck is not None and result.stuck.sticks.any():
        found = [
            np.where(result.stuck.sticks, part, np.nan)
            for part in (result.stuck.low, result.stuck.high, result.stuck.median)
        ]
        look = {"color": WET, "alpha": 0.18, "linewidth": 0.0, "zorder": 1.2}
        axes.fill_between(rpm, found[0] * MM, found[1] * MM, label="balls that stick, 5 to 95 %", **look)
        axes.plot(rpm, found[2] * MM, color=WET, linestyle=":", linewidth=1.1, label="their median")
        high = found[1][-1:]
    top = float(np.nanmax(np.concatenate((bare, shown, high, [0.0]))))
    axes.set_ylim(-0.02 * _FAR * top * MM, _FAR * top * MM or 1.0)
    axes.set_ylabel(f"Amplitude ({MM_PEAK})")


def _draw_angles(axes: Any, result: BallsAnswer) -> None:
    """Each ball of the stable state, a mark for each race."""
    rpm, race = result.speed * RPM, in_race(result.races)
    angle = np.degrees(np.where(result.stable[:, None], result.ball_angle, np.nan))
    seen: set[int] = set()
    for j, own in enumerate(race.tolist()):
        color, mark = _RACES[own % len(_RACES)]
        name = "balls, stable state" if len(result.races) == 1 else f"balls of race {own + 1}"
        look = {"linestyle": "none", "marker": mark, "markersize": 2.6, "color": color}
        axes.plot(rpm, angle[:, j], label="_" if own in seen else name, **look)
        seen.add(own)
    axes.set_ylim(-190.0, 190.0)
    axes.set_yticks([-180.0, -90.0, 0.0, 90.0, 180.0])
    axes.set_ylabel("Angle from the\nzero mark (deg)")


def _caption(result: BallsAnswer, text: str) -> Caption:
    assumed = assumed_words(result.assumed)
    count = sum(race.count for race in result.races)
    return Caption(
        text,
        f"Scene: {one_line(result.name)}, {result.axis} axis, {count} ball{'' if count == 1 else 's'}. "
        f"Assumed: {assumed}.",
    )
