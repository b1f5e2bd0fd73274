"""A run-up through a band of self-excited whirl and back, with the limit cycles that it follows.

`python -m validation.cases.rotors.whirl_passage --out docs/images` draws the figure of
docs/howto/stability.md and prints its table.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np

from meshes.arrays import Array
from solvers.cycles.cycles import Branch, LimitCycles, limit_cycles
from solvers.runup.runup import RunupNumerics
from solvers.whirl.edges import unstable_bands
from validation.cases.rotors.whirl import BANDED, NATURAL, banded_rotor, slow_passage
from validation.page import Figure, Table, page
from validation.study import launch, shown
from validation.whirl_in_time import Passage, passage

RATES = (8.0, 4.0, 2.0, 1.0)  # rad/s^2, of the table
DRAWN = 2.0
_RANGE = 100.0, 325.0  # rad/s: beyond the fold where the large whirl ends
_PLACES = ((1.4, False), (1.6, False), (1.6, True), (1.3, True))  # speed over the natural frequency, way down
_UP, _DOWN, _BRANCH = "#0072B2", "#D55E00", "0.35"
_SEED = 1e-3  # of the depth: offset of the rotor's mass
_SEEN = 0.02  # of the depth: the frequency of a smaller whirl is not told from the unbalance


def passed() -> Passage:
    """The run that is drawn: through the band, beyond the fold, and back."""
    return passage(*banded_rotor(), BANDED, _RANGE, DRAWN, RunupNumerics(cells=64), _SEED)


@cache
def cycles() -> LimitCycles:
    """Limit cycles over the speeds of the figure."""
    rotor, fill = banded_rotor()
    return limit_cycles(rotor, [fill], _RANGE, BANDED)


def table() -> Table:
    """Distance of run-ups and run-downs from the branch."""
    found, rows = cycles(), []
    for run in map(slow_passage, RATES):
        sizes = (
            run.at(ratio * NATURAL, back) / found.largest_stable(ratio * NATURAL) - 1.0
            for ratio, back in _PLACES
        )
        rows.append((f"{run.rate:g}", *(f"{size:+.2%}" for size in sizes)))
    heads = (f"{ratio:g}, {'down' if back else 'up'}" for ratio, back in _PLACES)
    return Table(("rate, rad/s^2", *heads), tuple(rows))


def passage_figure() -> Figure:
    """Run-up through a band of self-excited whirl and back, with the limit cycles that it follows."""
    run, found = passed(), cycles()
    rotor, fill = banded_rotor()
    ((band,),) = unstable_bands(rotor, [[fill]], np.linspace(*_RANGE, 401), BANDED)
    text = (
        f"A rotor run up at {run.rate:g} rad/s\N{SUPERSCRIPT TWO} and at once down again, its mass "
        "off the axis by 0.1 % of the depth; behind it the limit cycles by Newton's method. Planar rotor "
        "with one layer, m_f/M = 0.1, h0/R = 0.1, damping ratio 0.02, linear friction 0.03 of the "
        "natural frequency of 100 rad/s. Annular long waves, 64 cells, without dispersion."
    )
    with page([2.4, 1.3], text) as (figure, [[upper], [lower]]):
        panels = upper, lower
        for axes in panels:
            axes.axvspan(
                *(edge / NATURAL for edge in band),
                facecolor="#F0E442", alpha=0.35, hatch="///", edgecolor="0.55", linewidth=0.0,
                label="small whirls grow (linear theory)",
            )  # fmt: skip
        for branch in found.branches:
            _draw_branch(panels, branch, fill.depth)
        for speed, size, turning, color, dashes, label in (
            (run.speed, run.amplitude, run.whirl_speed, _UP, "-", "run-up"),
            (*(run.speed_down, run.amplitude_down, run.whirl_speed_down), _DOWN, (0, (6, 1.5)), "run-down"),
        ):
            look: dict[str, Any] = {"color": color, "linestyle": dashes, "linewidth": 1.3, "label": label}
            upper.plot(speed / NATURAL, size / fill.depth, **look)
            seen = np.where(size > _SEEN * fill.depth, _smooth(turning), np.nan)
            lower.plot(speed / NATURAL, seen / NATURAL, **look)
        upper.set_ylabel("Amplitude over depth (\N{EN DASH})")
        lower.set_ylabel("Whirl speed over\nnatural frequency (\N{EN DASH})")
        lower.set_xlabel("Spin speed over the natural frequency without liquid (\N{EN DASH})")
        upper.tick_params(labelbottom=False)
        for axes in panels:
            axes.set_xlim(_RANGE[0] / NATURAL, _RANGE[1] / NATURAL)
        upper.set_ylim(bottom=0.0)
        lower.set_ylim(0.92, 1.12)
        figure.alt = (
            "Amplitude and whirl speed over spin speed: the run-up leaves rest inside the band, follows the "
            "stable branch beyond the band's upper edge to its fold and falls to rest; the run-down stays at "
            "rest until well inside the band, jumps to the branch at a higher whirl speed and follows it "
            "below the lower edge."
        )
    return figure


def _draw_branch(panels: Sequence[Any], branch: Branch, depth: float) -> None:
    """Stable and unstable whirls of a branch in both panels."""
    rows = branch.amplitude / depth, branch.whirl_speed / NATURAL
    for axes, row in zip(panels, rows, strict=True):
        for stable, dashes, label in (
            (True, "-", "limit cycle, stable"),
            (False, (0, (1.5, 1.5)), "unstable"),
        ):
            # A piece between two whirls is drawn where one of them is of the kind.
            of_kind = branch.stable == stable
            wide = of_kind if stable else of_kind | np.roll(of_kind, 1) | np.roll(of_kind, -1)
            look: dict[str, Any] = {"color": _BRANCH, "linestyle": dashes, "linewidth": 2.6, "alpha": 0.6}
            axes.plot(branch.speed / NATURAL, np.where(wide, row, np.nan), label=label, **look)


def _smooth(values: Array) -> Array:
    """Means over some turns, in which the share of the unbalance drops out."""
    width = 101
    return np.asarray(np.convolve(np.pad(values, width // 2, mode="edge"), np.ones(width) / width, "valid"))


if __name__ == "__main__":
    launch(shown(table, whirl_passage=passage_figure))
