"""The designs of balls that were tried, and what the best of them does over speed."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from leblanc.core.notes import assumed_words, one_line
from leblanc.core.units import MM, MM_PEAK, RPM
from leblanc.plotting.curves import gapped
from leblanc.plotting.page import Caption, Figure, Frame, lay_out, number, style
from leblanc.studies.optimise.balls.answer import BallDesignAnswer
from leblanc.studies.run.figure import DRY, WET
from meshes.arrays import Flags

FRAME = Frame(left=0.72, top=0.14, between=0.14, below=0.42, gaps=(0.14, 0.56))
BEST, BALANCED = "#009E73", "#E4F1EC"
_LOOKS = (  # colour and mark of a number of balls
    ("#0072B2", "o"),
    ("#CC79A7", "s"),
    ("#E69F00", "^"),
    ("#56B4E9", "D"),
    ("0.45", "v"),
)
_FAR = 1.5  # times the amplitude without balls: designs beyond are left out of the picture
_GRAM = 1e3
_MARKS: dict[str, Any] = {"linestyle": "none", "markersize": 2.6}
_STAR: dict[str, Any] = {"marker": "*", "markersize": 12.0, "color": BEST, "markeredgecolor": "black"}
_STAR |= {"linestyle": "none", "zorder": 4}


def design_figure(result: BallDesignAnswer) -> Figure:
    """Amplitude and decay over mass of the designs, amplitude over speed of the best."""
    with style():
        figure = Figure()
        figure.alt = (
            "Amplitude and decay of the designs tried over the mass of all balls, and the amplitude over "
            f"speed with the best of them and without balls. {result.sentence()}"
        )
        names = "designs", "decay", "speed"
        panels: list[Any] = [figure.add_axes((0, 0, 1, 1), label=name) for name in names]
        above, middle, below = panels
        _draw_designs(above, result)
        _draw_decay(middle, result)
        middle.set_xlim(above.get_xlim())
        above.tick_params(labelbottom=False)
        _draw_speeds(below, result)
        for axes in panels:
            axes.xaxis.set_major_formatter(number)
            axes.yaxis.set_major_formatter(number)
        lay_out(figure, [[axes] for axes in panels], [1.8, 1.6, 1.9], FRAME, _caption(result))
    return figure


def _draw_designs(axes: Any, result: BallDesignAnswer) -> None:
    """Designs that keep to all constraints, a mark for each number of balls, and those that do not."""
    tried, top = result.tried, _FAR * result.vibration_without
    within = np.isfinite(tried.vibration) & (tried.vibration <= top)
    kept = within & (tried.excess <= 1e-9)
    mass, size = tried.mass * _GRAM, tried.vibration * MM
    broken = within & ~kept
    if broken.any():
        look = {"marker": "x", "color": "0.7", "label": "breaks a constraint"}
        axes.plot(mass[broken], size[broken], **look, **_MARKS)
    for counts, label, look in _groups(result, kept):
        axes.plot(mass[counts], size[counts], label=label, **look, **_MARKS)
    axes.axhline(result.vibration_without * MM, color=DRY, linestyle=(0, (1, 1.5)), label="without balls")
    if math.isfinite(result.vibration):
        axes.plot([result.mass * _GRAM], [result.vibration * MM], label="best", clip_on=False, **_STAR)
    axes.set_ylim(-0.03 * top * MM, top * MM)
    axes.set_ylabel(f"Amplitude ({MM_PEAK})")


def _draw_decay(axes: Any, result: BallDesignAnswer) -> None:
    """Decay rate of small motions of the same designs, in which designs differ that balance alike."""
    tried = result.tried
    kept = np.isfinite(tried.vibration) & (tried.vibration <= _FAR * result.vibration_without)
    kept &= (tried.excess <= 1e-9) & np.isfinite(tried.growth)
    for counts, _, look in _groups(result, kept):
        axes.plot(tried.mass[counts] * _GRAM, -tried.growth[counts], label="_", **look, **_MARKS)
    if math.isfinite(result.growth):
        axes.plot([result.mass * _GRAM], [result.stability_margin], label="_", **_STAR)
    axes.set_xlabel("Mass of all balls (g)")
    axes.set_ylabel("Decay (1/s)")


def _groups(result: BallDesignAnswer, kept: Flags) -> list[tuple[Flags, str, dict[str, Any]]]:
    """Numbers of balls of the designs, the larger ones together where there are many; how they look."""
    counts = np.unique(result.tried.count[kept]).tolist()
    found: list[tuple[Flags, str, dict[str, Any]]] = []
    for k, (count, (color, mark)) in enumerate(zip(counts, _LOOKS, strict=False)):
        more = k == len(_LOOKS) - 1 and len(counts) > len(_LOOKS)
        own = kept & (result.tried.count >= count if more else result.tried.count == count)
        label = f"{count} balls and more" if more else f"{count} ball{'' if count == 1 else 's'}"
        look = {"color": color, "marker": mark, "markerfacecolor": "none", "markeredgewidth": 0.7}
        found.append((own, label, look))
    return found


def _draw_speeds(axes: Any, result: BallDesignAnswer) -> None:
    """The best balls over the speeds of the scene, and where they balance."""
    run = result.response
    rpm, stable = run.speed * RPM, np.where(run.stable, run.amplitude, np.nan)
    bare = np.where(np.isfinite(run.amplitude_without), run.amplitude_without, np.nan)
    if math.isfinite(run.balanced_from):
        span = run.balanced_from * RPM, float(rpm[-1])
        axes.axvspan(*span, color=BALANCED, zorder=0, label="balanced state stable")
    axes.plot(rpm, bare * MM, color=DRY, linestyle=(0, (4, 2)), linewidth=1.1, label="without balls")
    breaks = np.zeros(max(rpm.size - 1, 0), dtype=bool)
    breaks[np.flatnonzero(run.state[1:] != run.state[:-1])] = True
    axes.plot(*gapped(rpm, stable * MM, breaks), color=WET, linewidth=1.6, label="best balls, stable state")
    axes.axvline(result.working_speed * RPM, color=BEST, linewidth=0.9, label="working speed")
    top = float(np.nanmax(np.concatenate((bare, stable, [0.0]))))
    axes.set_ylim(-0.02 * top * MM, 1.1 * top * MM or 1.0)
    axes.set_xlabel("Speed (rpm)")
    axes.set_ylabel(f"Amplitude ({MM_PEAK})")


def _caption(result: BallDesignAnswer) -> Caption:
    assumed = assumed_words(result.assumed)
    designs = (
        f"Above, designs that were evaluated: {result.meaning}, and the decay of small motions; below, "
        f"the best "
        "over speed."
    )
    return Caption(
        f"{result.sentence()} {designs}",
        f"Scene: {one_line(result.name)}. Objective: {result.objective}. Assumed: {assumed}.",
    )
