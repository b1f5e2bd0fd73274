"""Charts of stability of ball balancers.

The long rotor of `leblanc validate two_plane` over speed and damping of its supports, the dimensionless
machine of the literature [RCFW08] over speed, unbalance and damping, and both kinds of states of the rotor of
`examples/balls.toml`. The source prints curves, of which no numbers are at hand.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array
from solvers.rotor.balls.balancers import BallRace
from solvers.rotor.balls.charts import Chart, Crossing, Machine, State, stability_chart
from solvers.rotor.balls.stability import balanced_stability
from solvers.rotor.balls.two_plane_balance import dynamic_balancing, of_two_planes
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import RotorSystem
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from validation.cases.two_plane.damping import DAMPINGS, SIDES, damped, edge
from validation.cases.two_plane.machine import BALLS, LONG, RACES
from validation.page import Figure, Table, page
from validation.study import launch, shown

# Of the reference machine: J_t, J_p, static unbalance and couple, a ball, its place, drag over mass.
ACROSS, ALONG, SMALL, BALL, PLACE, DRAG = 3.25, 0.5, 5e-5, 1e-4, 2.0, 0.01
DAMPING, PHASE = 0.02, 1.0
_MOST = 1.9e-4  # of the unbalances on the chart; from 1.912e-4 on the balls do not suffice


def reference(
    small: float = SMALL, damping: float = DAMPING, drag: float = DRAG, alike: bool = True
) -> tuple[RotorSystem, tuple[BallRace, ...]]:
    """Dimensionless rotor of [RCFW08] with two races of two balls, lengths over the races' radius.

    k_11 = 1 and k_22 = 9 are springs of 1/2 at +-3, unlike: 5 and 45 in the second direction; the couple is
    (J_t - J_p) times the misalignment. `small` is eps of the mass's eccentricity and chi of the misalignment,
    `damping` c of the supports over their stiffness, `drag` that of the race over a ball's mass, as read
    here.
    """
    half = ACROSS - ALONG
    unbalances = (
        PlaneUnbalance(0.0, small),
        PlaneUnbalance(1.0, 0.5 * half * small, PHASE),
        PlaneUnbalance(-1.0, 0.5 * half * small, PHASE + np.pi),
    )
    supports = (Support(3.0, 0.5, 0.5 * damping), Support(-3.0, 0.5, 0.5 * damping))
    system = TwoPlane(1.0, ACROSS, ALONG, supports, unbalances).system()
    if not alike:
        stiffness = np.diag([1.0, 5.0, 45.0, 9.0])
        system = replace(system, stiffness=stiffness, damping=damping * stiffness)
    races = tuple(BallRace(z, 1.0, (BALL, BALL), drag * BALL, 1.0) for z in (PLACE, -PLACE))
    return system, races


def reference_charts() -> tuple[Chart, Chart]:
    """Reference machine over speed and unbalance, and over speed and damping of the supports."""

    def unbalanced(speed: float, share: float) -> Machine:
        return Machine(*reference(1e-5 * max(share, 0.0)), speed)

    def held(speed: float, damping: float) -> Machine:
        return Machine(*reference(damping=damping), speed)

    speeds = np.linspace(0.4, 4.0, 41)
    return (
        stability_chart(unbalanced, speeds, np.linspace(0.1, 1e5 * _MOST, 21)),
        stability_chart(held, speeds, np.linspace(1e-3, 0.2, 21)),
    )


def state_charts() -> tuple[Chart, Chart, Chart]:
    """Rotor of `examples/balls.toml` over speed, rad/s, and what two balls hold over the unbalance.

    The balanced state, both balls together behind the unbalance, and both together near its other side.
    """

    def family(speed: float, ratio: float) -> Machine:
        mass = ratio * 6e-4 / (2.0 * 0.065)
        race = BallRace(0.0, 0.065, (mass, mass), 0.1)
        return Machine(Jeffcott(4.0, 4.4e4, 84.0, 6e-4).system(), (race,), speed)

    ratios, enough = np.linspace(0.21, 2.17, 16), np.linspace(1.0, 2.17, 12)
    slow, fast = np.linspace(40.0, 104.0, 25), np.linspace(104.0, 250.0, 25)
    return (
        stability_chart(family, np.linspace(40.0, 250.0, 50), enough),
        stability_chart(family, slow, ratios, State([-1.1, -1.1])),
        stability_chart(family, fast, ratios, State([-2.3, -2.3])),
    )


def reference_growth(speeds: ArrayLike, alike: bool = True, drag: float = DRAG) -> Array:
    """Largest growth rate of the balanced reference machine; speeds over the natural frequency."""
    system, races = reference(alike=alike, drag=drag)
    found = [balanced_stability(system, races, speed).growth for speed in np.asarray(speeds).tolist()]
    return np.array(found)


def bands(speeds: Array, growth: Array) -> list[tuple[float, float]]:
    """Speeds between which a disturbance decays, to the step of the rising speeds."""
    found: list[tuple[float, float]] = []
    for speed, rate in zip(speeds.tolist(), growth.tolist(), strict=True):
        if rate >= 0.0:
            continue
        last = found[-1] if found else None
        if last is not None and np.isclose(last[1], speed, rtol=0.0, atol=1.5 * (speeds[1] - speeds[0])):
            found[-1] = (last[0], speed)
        else:
            found.append((speed, speed))
    return found


def _draw(axes: Any, chart: Chart, scale: float = 1.0) -> None:
    """Stable ground hatched, edges as lines that differ by their dashes."""
    # Between two values the growth is nearly straight where it passes 0.
    growth = np.ma.masked_invalid(chart.growth.T)
    axes.contourf(
        chart.first, scale * chart.second, growth, levels=[-1e9, 0.0], colors=["0.9"], hatches=["///"]
    )
    looks = {Crossing.HOPF: ("C0", "-", "a pair of roots"), Crossing.ZERO: ("C3", "--", "one root at 0")}
    known: set[str] = set()
    for curve in chart.edges:
        color, dashes, label = looks[curve.kind]
        shown = f"_{label}" if label in known else label
        known.add(label)
        axes.plot(curve.first, scale * curve.second, color=color, linestyle=dashes, label=shown)
    axes.set(xlim=(chart.first[0], chart.first[-1]), ylim=(scale * chart.second[0], scale * chart.second[-1]))


def damping_figure() -> Figure:
    """Where balls balance the long rotor over speed and damping, with motions in time on both sides."""

    def family(speed: float, power: float) -> Machine:
        return Machine(damped(LONG, 10.0**power).system(), RACES, speed)

    chart = stability_chart(family, np.linspace(30.0, 110.0, 25), np.linspace(-0.6, 4.2, 25))
    text = (
        "Balanced state of the long rotor with two ball balancers, by the roots of small motions: stable "
        "where hatched. Rotor of 10 kg, balls of 15 g, drag of the races 0.3 N s/m. Made-up machine."
    )
    with page([2.9], text, left=0.7, below=0.5) as (figure, [[axes]]):
        _draw(axes, chart)
        above = dynamic_balancing(of_two_planes(LONG, BALLS), 1.0).above
        axes.axvline(above, color="0.25", linestyle=":", linewidth=1.4, label="conditions of FF20")
        for share, mark, label in zip(
            SIDES, ("x", "o"), ("in time: grows", "in time: dies out"), strict=True
        ):
            speeds = [share * edge(damping) for damping in DAMPINGS]
            axes.plot(speeds, np.log10(DAMPINGS), mark, color="black", markerfacecolor="none", label=label)
        ticks = [0, 1, 2, 3, 4]
        axes.set_yticks(ticks, [f"{10**tick:g}" for tick in ticks])
        axes.set(xlabel="Speed (rad/s)", ylabel="Damping of each support (N s/m)")
        axes.text(82.0, 2.6, "balanced", bbox={"facecolor": "white", "edgecolor": "none"})
        axes.text(33.0, 2.6, "not balanced", bbox={"facecolor": "white", "edgecolor": "none"})
    return figure


def reference_figure() -> Figure:
    """Reference machine over speed and unbalance, and over speed and damping."""
    charts = reference_charts()
    text = (
        "Balanced state of the dimensionless rotor with two races of two balls of RCFW08, by the roots of "
        "small motions: stable where hatched. Left: damping 0.02. Right: both unbalances 5e-5. Drag of the "
        "races over a ball's mass 0.01; supports alike in both directions."
    )
    with page([2.7], text, (2,), left=0.7, below=0.5, apart=0.65) as (figure, [panels]):
        for axes, chart in zip(panels, charts, strict=True):
            _draw(axes, chart)
            axes.set_xlabel("Speed over natural frequency of shift (\N{EN DASH})")
        panels[0].set_ylabel("Unbalances, 10\N{SUPERSCRIPT MINUS}\N{SUPERSCRIPT FIVE} (\N{EN DASH})")
        panels[1].set_ylabel("Damping over stiffness (\N{EN DASH})")
    return figure


def unlike_figure() -> Figure:
    """Reference machine on unlike supports over speed and damping."""

    def held(speed: float, damping: float) -> Machine:
        return Machine(*reference(damping=damping, alike=False), speed)

    chart = stability_chart(held, np.linspace(1.0, 6.0, 41), np.linspace(2e-3, 0.2, 21))
    text = (
        "Balanced state of the dimensionless rotor of RCFW08 on supports of 5 and 45 in one "
        "direction, 1 and 9 in the other, by the multipliers of half a turn: stable where "
        "hatched. Unbalances 5e-5, drag of the races over a ball's mass 0.01."
    )
    with page([2.9], text, left=0.7, below=0.5) as (figure, [[axes]]):
        _draw(axes, chart)
        axes.set_xlabel("Speed over natural frequency of shift (\N{EN DASH})")
        axes.set_ylabel("Damping over stiffness (\N{EN DASH})")
    return figure


def states_figure() -> Figure:
    """Balanced state and balls together, over speed and what the balls hold."""
    balanced, slow, fast = state_charts()
    text = (
        "Two balls on the rotor of examples/balls.toml, critical speed 105 rad/s: states by "
        "the roots of small motions, stable where hatched. Left: balls that take all unbalance "
        "away. Right: both in one place, where they stay below the critical speed, and above "
        "it if they do not suffice; between the dashed curves no such state exists."
    )
    with page([2.7], text, (2,), left=0.7, top=0.35, below=0.5, apart=0.65) as (figure, [panels]):
        _draw(panels[0], balanced)
        _draw(panels[1], slow)
        _draw(panels[1], fast)
        words = (
            ("balanced", ((145.0, 0.6, "not enough balls"), (80.0, 1.6, "unstable"), (180.0, 1.6, "stable"))),
            ("both balls together", ((65.0, 1.3, "stable"), (107.0, 1.9, "none"), (190.0, 1.6, "unstable"))),
        )
        for axes, (name, places) in zip(panels, words, strict=True):
            for x, y, word in places:
                axes.text(
                    x, y, word, ha="center", bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.5}
                )
            axes.set(xlim=(balanced.first[0], balanced.first[-1]), ylim=(slow.second[0], slow.second[-1]))
            axes.set(xlabel="Speed (rad/s)", ylabel="Capacity over unbalance (\N{EN DASH})", title=name)
    return figure


def table() -> Table:
    """Bands of speed in which the balanced reference machine is stable."""
    speeds, rows = np.linspace(0.2, 8.0, 391), []
    for drag in (0.01, 1.0, 100.0):
        found = [bands(speeds, reference_growth(speeds, alike, drag)) for alike in (True, False)]
        rows.append((f"{drag:g}", *(", ".join(f"{a:.2f} to {b:.2f}" for a, b in each) for each in found)))
    head = ("drag over a ball's mass", "supports alike", "supports 5 and 45 in one direction")
    return Table(head, tuple(rows))


if __name__ == "__main__":
    figures = {"balls_damping": damping_figure, "balls_reference": reference_figure}
    launch(shown(table, **figures, balls_unlike=unlike_figure, balls_charts=states_figure))
