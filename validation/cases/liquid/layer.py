"""The layer under a whirl against computed two-phase flow (interFoam, volume of fluid) and exact theory.

The reference solves the full plane equations with a gas of density 1 inside the layer; its own accuracy is in
the data file. Case C runs at the retrograde natural wave, where a bore goes round. Of a rotor with its layer
two codes of the same equations stand side by side: py-pde's Runge-Kutta and the compiled steps of run-ups.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fluid.fill import Fill
from fluid.friction.laws import NO_FRICTION, Friction, FrictionLaw
from fluid.liquid import Liquid
from fluid.waves import force_ratio
from meshes.chamber import Chamber
from solvers.layer.records import Outcome
from solvers.layer.state import Numerics
from solvers.liquid_history import LayerHistory
from solvers.liquid_model import Whirl
from solvers.pypde.settle import settle, simulate
from solvers.rotor.jeffcott import Jeffcott
from solvers.runup.long_wave import couple
from validation.case import Case, Claims, Effect
from validation.page import Figure, page
from validation.study import data

CLAIMS = Claims("layer")

_HEIGHT = 0.01  # the flow is plane: any height will do
# Force of the bore over the reference's modulus in the first three whirl periods. From the fourth on the
# reference depends on its mesh by more than a fourth, and is no target: a trend.
_PERIODS, _EARLY, _ROTATION = 3, 0.10, 0.25


def cases() -> list[Case]:
    """Synchronous and linear cases, then the bore with and without dispersion and friction."""
    found: list[Case] = []
    for run in data("openfoam_layer.json")["cases"]:
        found += _bore(run) if "time" in run else [_steady(run)]
    return found


def plane_layer(run: dict[str, Any]) -> Fill:
    """Chamber and liquid of a case of the computed flow."""
    surface = run["radius"] - run["depth"]
    volume = math.pi * (run["radius"] ** 2 - surface**2) * _HEIGHT
    return Fill(Chamber(run["radius"], _HEIGHT), Liquid("water", run["density"], run["viscosity"]), volume)


def _steady(run: dict[str, Any]) -> Case:
    """Force coefficient of a smooth layer; the wall of these runs is frictionless."""
    fill = plane_layer(run)
    whirl = Whirl(run["speed"], run["whirl_speed"], run["whirl_amplitude"])
    reference = complex(*run["force_ratio"])
    plain = complex(settle(fill, whirl).force_ratio[-1])
    whitham = complex(settle(fill, whirl, numerics=Numerics(dispersion=True)).force_ratio[-1])
    exact = float(force_ratio((fill.chamber.radius / fill.surface_radius) ** 2, whirl.speed / whirl.spin))
    off = abs(whitham - reference) / abs(reference)
    return CLAIMS.case(
        "steady",
        whitham.real,
        off <= 0.01,
        key=run["name"],
        ratio=whirl.speed / whirl.spin,
        printed=reference.real,
        difference=(reference.real - whitham.real) / abs(whitham),
        real=plain.real,
        exact=exact,
    )


@cache
def bore_histories() -> dict[str, LayerHistory]:
    """The near-resonant case by four variants of the model, 512 cells each, from rest in the drum."""
    run = bore_reference()
    fill = plane_layer(run)
    whirl = Whirl(run["speed"], run["whirl_speed"], run["whirl_amplitude"], run["ramp"])
    stokes = Friction(FrictionLaw.STOKES)
    # Floor and lid are not in a plane flow: the wall's layer alone.
    variants = {
        "plain": (NO_FRICTION, Numerics(512)),
        "dispersion": (NO_FRICTION, Numerics(512, dispersion=True)),
        "friction": (stokes, Numerics(512)),
        "both": (stokes, Numerics(512, dispersion=True)),
    }
    tall = Fill(Chamber(fill.chamber.radius, 1e3), fill.liquid, fill.volume / _HEIGHT * 1e3)
    duration = (len(run["force_ratio"]) + 0.01) * whirl.period
    return {name: simulate(tall, whirl, duration, *variant) for name, variant in variants.items()}


def bore_reference() -> dict[str, Any]:
    """The near-resonant case of the computed flow."""
    runs: list[dict[str, Any]] = data("openfoam_layer.json")["cases"]
    return next(run for run in runs if "time" in run)


def _bore(run: dict[str, Any]) -> Iterator[Case]:
    """The near-resonant case by four variants; of all but the first periods only the trend is compared."""
    reference = np.array([complex(*pair) for pair in run["force_ratio"]])
    for name, history in bore_histories().items():
        off = np.abs(history.force_ratio - reference) / np.abs(reference)
        early, late = off[:_PERIODS], off[_PERIODS:]
        sizes = (float(np.abs(each[_PERIODS:]).mean()) for each in (reference, history.force_ratio))
        of = {"run": run["name"], "variant": name}
        held, told = bool(np.all(early <= _EARLY)), _percent(early)
        yield CLAIMS.case("force_cases", float(np.max(early)), held, **of, difference=told)
        effect = Effect("mean modulus of the force ratio", *sizes)
        yield CLAIMS.case("late", float(np.max(late)), True, **of, difference=_percent(late), effect=effect)
    # Mean rotation of the last at the reference's times, which lie between the middles of our periods.
    given = np.array(run["mean_rotation"])
    inside = given[:, 0] <= history.time[-1]
    ours = np.interp(given[inside, 0], history.time, history.mean_rotation)
    off = np.abs(ours / given[inside, 1] - 1.0)
    words = {"key": run["name"], "difference": _percent(off)}
    yield CLAIMS.case("mean-rotation", float(off.max()), bool(np.all(off <= _ROTATION)), **words)


def _percent(shares: NDArray[np.float64]) -> str:
    return ", ".join(f"{100 * share:.0f}" for share in shares) + " %"


CELLS = (32, 64, 128)
_SPIN = 40.0  # rad/s
_ROTOR = Jeffcott(3.0, 3.0 * 15.0**2, 4.0, 2e-3)
_LAYER = Fill(Chamber(0.15, 0.05), Liquid("water", 1000.0, 1e-6), 8e-4)
_FRICTION = Friction(FrictionLaw.QUADRATIC, 0.02)
# Of the square of a cell's angle: what second order leaves between two schemes of one equation here.
_SHARE = 0.05


def deflections(cells: int) -> tuple[complex, complex]:
    """Deflection of a rotor with its layer after a turn from rest, by py-pde and by the compiled steps, m.

    py-pde takes the rates of `RotorLayersPDE` with its own Runge-Kutta; the compiled steps are those of a
    run-up, the spin held.
    """
    from solvers.pypde.coupled import RotorLayersPDE

    turn = 2.0 * math.pi / _SPIN
    machine = RotorLayersPDE(_ROTOR.system(), [_LAYER], _SPIN, friction=_FRICTION)
    begin, step = machine.start(cells), turn / (2 * cells)
    found = machine.solve(begin, (0.0, turn), dt=step, tracker=None, solver="runge-kutta")
    kernel = couple(_ROTOR.system(), [_LAYER], _SPIN, _FRICTION, 0.0, cells, False)
    outcome = kernel.advance(turn, 0.0, 0.8, 10**6)
    if outcome is not Outcome.DONE:
        raise RuntimeError(outcome.message)
    return complex(*machine.parts(found)[2]), complex(*kernel.state.place)


def rotor_cases() -> list[Case]:
    """A rotor and its layer together: two codes on three meshes, and the order of their coming together."""
    pairs = {cells: deflections(cells) for cells in CELLS}
    apart = {cells: abs(first - second) / abs(second) for cells, (first, second) in pairs.items()}
    found = [
        CLAIMS.case(
            "rotor-cells",
            1e3 * abs(second),
            apart[cells] <= _SHARE * (2.0 * math.pi / cells) ** 2,
            cells=cells,
            printed=1e3 * abs(first),
            difference=apart[cells],
        )
        for cells, (first, second) in pairs.items()
    ]
    order = math.log2(apart[CELLS[-2]] / apart[CELLS[-1]])
    return [*found, CLAIMS.case("rotor-order", order)]


def all_cases() -> list[Case]:
    """The layer alone, and with its rotor."""
    return [*cases(), *rotor_cases()]


_FLOW = {"color": "black", "marker": "s", "linestyle": "none", "markerfacecolor": "white", "zorder": 4}
# Of the four variants of the bore: colour and line.
_LOOKS: dict[str, tuple[str, str, Any]] = {
    "plain": ("long waves", "#D55E00", (0, (1, 1.2))),
    "dispersion": ("with dispersion", "#E69F00", (0, (6, 1.5, 1, 1.5))),
    "friction": ("with laminar friction", "#009E73", (0, (5, 1.5))),
    "both": ("with both", "#0072B2", "-"),
}
# Of the computed flow: before 1.33 s, and later, where two meshes differ by up to so much.
_SURE, _UNSURE, _UNTIL = 0.03, 0.15, 1.33


def force_figure(cells: int = 64) -> Figure:
    """Force coefficient over whirl ratio where the layer is smooth."""
    runs = [run for run in data("openfoam_layer.json")["cases"] if "time" not in run]
    fill = plane_layer(runs[0])
    kappa = (fill.chamber.radius / fill.surface_radius) ** 2
    ratio = np.linspace(0.4, 1.6, 1201)
    exact = np.asarray(force_ratio(kappa, ratio))
    label = f"long waves with dispersion, {cells} cells"
    text = (
        "Layer of a tenth of the wall's radius of 150 mm, spin 40 rad/s, plane flow, no gravity. The "
        "line has no bound at the two free waves with one crest. Computed flow: interFoam, volume of "
        "fluid, two meshes at 1 and 1.3; without friction on the wall."
    )
    with page([2.9], text) as (figure, [[axes]]):
        # The two natural sloshing waves, where the linear force has no bound, cut the line.
        line = np.where(np.abs(exact) < 8.0, exact, np.nan)
        axes.plot(ratio, line, color="#0072B2", label="exact linear theory")
        for run in runs:
            at = run["whirl_speed"] / run["speed"]
            whirl = Whirl(run["speed"], run["whirl_speed"], run["whirl_amplitude"])
            found = settle(plane_layer(run), whirl, numerics=Numerics(cells, dispersion=True))
            waves = {"color": "#D55E00", "marker": "x", "markersize": 6.0, "linestyle": "none", "zorder": 5}
            axes.plot(at, found.force_ratio[-1].real, **waves, label=label)
            axes.plot(at, run["force_ratio"][0], **_FLOW, label="computed two-phase flow")
        axes.set(xlim=(ratio[0], ratio[-1]), ylim=(-4.0, 5.0))
        axes.set_xlabel("Whirl speed over spin speed (\N{EN DASH})")
        axes.set_ylabel("Force along the deflection over that of a full drum (\N{EN DASH})")
    return figure


def bore_figure() -> Figure:
    """Force, crests and mean rotation of the bore that a whirl at the natural wave's speed drives."""
    text = (
        "A layer of a tenth of the wall's radius of 150 mm, spin 40 rad/s, under a whirl at its "
        "retrograde free wave, whose amplitude rises to a twentieth of the depth in 0.6 s. Means over "
        "periods of the whirl seen from the drum: force over that of a full drum, crest and trough, mean "
        "rotation of the liquid in the drum. Bars: what the computed flow is said to be sure of (3 % "
        "before 1.33 s, 15 % later)."
    )
    with page([1.15, 1.15, 1.0, 1.0], text) as (figure, rows):
        panels = [axes for [axes] in rows]
        _draw_variants(panels)
        _draw_flow(panels)
        labels = ("Force along (\N{EN DASH})", "90\N{DEGREE SIGN} ahead (\N{EN DASH})")
        for axes, name in zip(panels, (*labels, "Depth (mm)", "Rotation (rad/s)"), strict=True):
            axes.set(ylabel=name, xlim=(0.0, 6.8))
            axes.tick_params(labelbottom=axes is panels[-1])
        panels[-1].set_xlabel("Time (s)")
    return figure


def _draw_variants(panels: list[Any]) -> None:
    """Four variants of the long waves."""
    for name, history in bore_histories().items():
        label, color, dashes = _LOOKS[name]
        look = {"color": color, "linestyle": dashes, "linewidth": 1.2}
        force = history.force_ratio
        panels[0].plot(history.time, force.real, **look, label=label)
        panels[1].plot(history.time, force.imag, **look)
        for depth in (history.depth_max, history.depth_min):
            panels[2].plot(history.time, depth * 1e3, **look)
        panels[3].plot(history.time, history.mean_rotation, **look)


def _draw_flow(panels: list[Any]) -> None:
    """The computed flow and how sure it is."""
    run = bore_reference()
    time, force = np.array(run["time"]), np.array([complex(*pair) for pair in run["force_ratio"]])
    off = np.where(time < _UNTIL, _SURE, _UNSURE) * np.abs(force)
    bars = {"color": "black", "linewidth": 0.8, "zorder": 3}
    for axes, part in ((panels[0], force.real), (panels[1], force.imag)):
        axes.vlines(time, part - off, part + off, **bars)
        axes.plot(time, part, **_FLOW, label="computed two-phase flow")
    for key in ("depth_max", "depth_min"):
        panels[2].plot(time, np.array(run[key]) * 1e3, **_FLOW)
    panels[3].plot(*np.array(run["mean_rotation"]).T, **_FLOW)


def bore_summary() -> dict[str, tuple[float, float, float]]:
    """Largest distance of crest and trough from the flow's, mm, and last rotation, rad/s, of each variant.

    Distances keep their sign. First comes the computed flow itself, its rotation at the last common time.
    """
    run = bore_reference()
    flow = np.array(run["mean_rotation"]).T
    found = {}
    for name, history in bore_histories().items():
        off = [
            1e3 * (depth - np.array(run[key]))
            for key, depth in (("depth_max", history.depth_max), ("depth_min", history.depth_min))
        ]
        crest, trough = (float(values[np.argmax(np.abs(values))]) for values in off)
        found[_LOOKS[name][0]] = crest, trough, float(history.mean_rotation[-1])
        last = float(np.interp(history.time[-1], *flow))
    return {"computed flow": (0.0, 0.0, last)} | found
