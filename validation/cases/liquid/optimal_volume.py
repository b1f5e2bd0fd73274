"""Optimal volume: exact, by finite elements, as published; what the source says of it [DR18, eq. 18-19]."""

from __future__ import annotations

from typing import Any

import numpy as np

from fluid.fill import Fill, Fills
from fluid.liquid import known_liquid
from leblanc.core.units import MM
from leblanc.studies.volume.study import answer_volume
from meshes.chamber import Chamber
from solvers.statics.hydrostatics import equilibrium, optimal_volume
from solvers.synchronous.models import Statics
from validation.case import Case, Claims
from validation.page import Figure, logarithmic, page

CLAIMS = Claims("optimal_volume")

_GRAVITY = 9.81
_ML = 1e6
_SETS = (((0.2, 0.05), 90.0), ((0.2, 0.05), 20.0), ((0.05, 0.02), 100.0))


def cases() -> list[Case]:
    """Finite elements against closed form, the printed formula, the layer of 2 e, and the law's bend."""
    found = []
    for (radius, height), speed in _SETS:
        for e in (1e-3, 3e-3, 10e-3):
            answer = answer_volume(radius, height, e, speed, gravity=_GRAVITY)
            at = f"R {radius:g} m, h {height:g} m, {speed:g} rad/s, e {e * 1e3:g} mm"
            words = {"at": at, "key": f"{radius * 1e3:g}-{speed:g}-{e * 1e3:g}"}
            for entry, printed in (("fem", answer.optimal_volume_fem), ("eq18", answer.printed_eq18)):
                if printed is not None:
                    found.append(
                        CLAIMS.case(entry, answer.optimal_volume * _ML, printed=printed * _ML, **words)
                    )
    # At fast spin the layer opposite the dry point is 2 e thick: a crescent between circles of radius R and
    # R - e that touch, whose largest thickness is twice the mean one.
    chamber, e = Chamber(0.2, 0.05), 1e-3
    volume = float(optimal_volume(chamber, e, 1.0, gravity=0.0))
    mean = volume / (np.pi * (2 * chamber.radius - e) * chamber.height)
    found.append(CLAIMS.case("thickness", 2.0 * mean / e))
    # The deflection at which a volume stops to be enough is the one whose optimal volume it is.
    e = 3e-3
    enough = Fill(chamber, known_liquid("water"), float(optimal_volume(chamber, e, 1.0, gravity=0.0)))
    bend = Statics().linear_limit(Fills.of([enough]), np.array([50.0]), np.zeros(1))
    return [*found, CLAIMS.case("bend", float(bend[0]) * 1e3, printed=e * 1e3)]


CHAMBER, GRAVITY = Chamber(0.2, 0.05), 9.81
SPEEDS = (20.0, 90.0)  # rad/s
VOLUMES = (100e-6, 300e-6, 600e-6)  # m^3
_GRAMS = 1e6  # g mm in one kg m
_COLORS = ("#0072B2", "#D55E00", "#009E73")
_DASHES: tuple[Any, ...] = ("-", (0, (5, 1.5)), (0, (6, 1.5, 1, 1.5)))
_MARKS = "os^"


def volume_figure() -> Figure:
    """Optimal volume over deflection: exact, by finite elements, as published, as corrected."""
    fine, few = np.geomspace(0.3e-3, 30e-3, 61), (1e-3, 3e-3, 10e-3)
    text = (
        "Volume whose paraboloid just touches the near wall at the floor. Chamber of 200 mm radius and "
        "50 mm height, upright. Lines: the closed form; marks: quadratic triangles; crosses: eq. 18 of "
        "DR18 as printed, and with its moment taken about the rotation axis (dotted), which has no "
        "positive value for small deflections at 20 rad/s."
    )
    with page([3.0], text, left=0.75) as (figure, [[axes]]):
        for k, speed in enumerate(SPEEDS):
            exact = np.asarray(optimal_volume(CHAMBER, fine, speed, GRAVITY)) * _ML
            look = {"color": _COLORS[k], "linestyle": _DASHES[k]}
            axes.plot(fine * MM, exact, **look, label=f"exact, {speed:g} rad/s")
            answers = [answer_volume(CHAMBER.radius, CHAMBER.height, e, speed, gravity=GRAVITY) for e in few]
            points = {"linestyle": "none", "color": _COLORS[k], "markerfacecolor": "white"}
            found = [answer.optimal_volume_fem * _ML for answer in answers]
            label = f"elements, {speed:g} rad/s"
            axes.plot(np.array(few) * MM, found, marker=_MARKS[k], **points, label=label)
            _as_printed(axes, speed, k, fine)
        thin = np.pi * CHAMBER.height * (CHAMBER.radius**2 - (CHAMBER.radius - fine) ** 2) * _ML
        axes.plot(fine * MM, thin, color="0.45", linewidth=1.0, linestyle=(0, (1, 1.5)), label="fast spin")
        axes.axhline(CHAMBER.capacity * _ML, color="0.15", linewidth=0.8, label="chamber full")
        logarithmic(axes, x=[0.3, 1.0, 3.0, 10.0, 30.0], y=[10.0**k for k in range(7)])
        axes.set(xlim=(0.3, 30.0), xlabel="Deflection (mm)", ylabel="Optimal volume (ml)")
    return figure


def _as_printed(axes: Any, speed: float, k: int, deflection: Any) -> None:
    """The printed formula and its correction, which still takes a disc for the lens."""
    answers = [
        answer_volume(CHAMBER.radius, CHAMBER.height, float(e), speed, gravity=GRAVITY)
        for e in deflection[::10]
    ]
    some = deflection[::10] * MM
    printed = [np.nan if answer.printed_eq18 is None else answer.printed_eq18 * _ML for answer in answers]
    # At slow spin the disc that stands for the lens leaves a negative volume.
    given = [-1.0 if answer.corrected_eq18 is None else answer.corrected_eq18 * _ML for answer in answers]
    corrected = np.where(np.array(given) > 0.0, given, np.nan)
    dots: dict[str, Any] = {"color": _COLORS[k], "linestyle": (0, (1, 2)), "linewidth": 1.0}
    axes.plot(some, printed, marker="x", **dots, label=f"eq. 18 as printed, {speed:g} rad/s")
    axes.plot(some, corrected, **dots, label=f"eq. 18 corrected, {speed:g} rad/s")


def law_figure() -> Figure:
    """Unbalance of the liquid about the rotation axis over deflection for three volumes, and its bend."""
    water, speed = known_liquid("water"), SPEEDS[-1]
    deflection = np.linspace(0.0, 20e-3, 161)
    text = (
        "First moment of water about the rotation axis, without gravity along it. While the wall is wet "
        "all round every volume acts like a full chamber; marks: the deflection for which the volume is "
        "the optimal one, from where on the near wall is dry. Chamber of 200 mm radius and 50 mm height."
    )
    with page([2.75], text, left=0.75) as (figure, [[axes]]):
        for k, volume in enumerate(VOLUMES):
            state = equilibrium(CHAMBER, volume, deflection, speed, 0.0)
            moment = water.density * np.asarray(state.unbalance()[0]) * _GRAMS
            look = {"color": _COLORS[k], "linestyle": _DASHES[k], "label": f"{volume * _ML:g} ml"}
            axes.plot(deflection * MM, moment, **look)
            fills = Fills.of([Fill(CHAMBER, water, volume)])
            bend = float(Statics().linear_limit(fills, np.array([speed]), np.zeros(1))[0])
            there = water.density * CHAMBER.capacity * bend * _GRAMS
            axes.plot(bend * MM, there, color=_COLORS[k], marker=_MARKS[k], markerfacecolor="white")
        full = water.density * CHAMBER.capacity * deflection * _GRAMS
        dots = {"color": "0.15", "linewidth": 0.9, "linestyle": (0, (1, 1.5))}
        axes.plot(deflection * MM, full, **dots, label="full chamber")
        axes.set(xlim=(0.0, 20.0), ylim=(0.0, 80000.0))
        axes.set(xlabel="Deflection (mm)", ylabel="Unbalance of the liquid (g mm)")
    return figure
