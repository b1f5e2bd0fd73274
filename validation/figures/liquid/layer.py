"""The liquid's force under a whirl: exact linear theory, long waves and computed flow, drawn."""

from __future__ import annotations

from typing import Any

import numpy as np

from fluid.waves import force_ratio
from leblanc.figures.drawing.page import Figure, Frame, lay_out, number, style
from solvers.layer.state import Numerics
from solvers.liquid_model import Whirl
from solvers.pypde.settle import settle
from validation.cases.liquid.layer import bore_histories, bore_reference, plane_layer
from validation.cases.rotors.rigs import data

_FRAME = Frame(left=0.72, top=0.15, between=0.12, below=0.42)
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
    """Force ratio over whirl ratio where the layer is smooth."""
    runs = [run for run in data("openfoam_layer.json")["cases"] if "time" not in run]
    fill = plane_layer(runs[0])
    kappa = (fill.chamber.radius / fill.surface_radius) ** 2
    ratio = np.linspace(0.4, 1.6, 1201)
    exact = np.asarray(force_ratio(kappa, ratio))
    label = f"long waves with dispersion, {cells} cells"
    with style():
        figure = Figure()
        axes: Any = figure.add_axes((0, 0, 1, 1))
        # The two free waves, where the linear force has no bound, cut the line.
        line = np.where(np.abs(exact) < 8.0, exact, np.nan)
        axes.plot(ratio, line, color="#0072B2", label="exact linear theory")
        for run in runs:
            at = run["whirl_speed"] / run["speed"]
            whirl = Whirl(run["speed"], run["whirl_speed"], run["whirl_amplitude"])
            found = settle(plane_layer(run), whirl, numerics=Numerics(cells, dispersion=True))
            waves = {"color": "#D55E00", "marker": "x", "markersize": 6.0, "linestyle": "none", "zorder": 5}
            axes.plot(at, found.force_ratio[-1].real, **waves, label=label)
            axes.plot(at, run["force_ratio"][0], **_FLOW, label="computed two-phase flow")
        axes.set_xlim(ratio[0], ratio[-1])
        axes.set_ylim(-4.0, 5.0)
        axes.xaxis.set_major_formatter(number)
        axes.yaxis.set_major_formatter(number)
        axes.set_xlabel("Whirl speed over spin speed (\N{EN DASH})")
        axes.set_ylabel("Force along the deflection over that of a full drum (\N{EN DASH})")
        text = (
            "Layer of a tenth of the wall's radius of 150 mm, spin 40 rad/s, plane flow, no gravity. The "
            "line has no bound at the two free waves with one crest. Computed flow: interFoam, volume of "
            "fluid, two meshes at 1 and 1.3; without friction on the wall."
        )
        lay_out(figure, [[axes]], [2.9], _FRAME, text)
    return figure


def bore_figure() -> Figure:
    """Force, crests and mean rotation of the bore that a whirl at the free wave's speed drives."""
    with style():
        figure = Figure()
        panels: list[Any] = [figure.add_axes((0, 0, 1, 1), label=name) for name in "abcd"]
        _draw_variants(panels)
        _draw_flow(panels)
        labels = ("Force along (\N{EN DASH})", "90\N{DEGREE SIGN} ahead (\N{EN DASH})")
        for axes, name in zip(panels, (*labels, "Depth (mm)", "Rotation (rad/s)"), strict=True):
            axes.set_ylabel(name)
            axes.set_xlim(0.0, 6.8)
            axes.yaxis.set_major_formatter(number)
            axes.tick_params(labelbottom=axes is panels[-1])
        panels[-1].set_xlabel("Time (s)")
        text = (
            "A layer of a tenth of the wall's radius of 150 mm, spin 40 rad/s, under a whirl at its "
            "retrograde free wave, whose amplitude rises to a twentieth of the depth in 0.6 s. Means over "
            "periods of the whirl seen from the drum: force over that of a full drum, crest and trough, mean "
            "rotation of the liquid in the drum. Bars: what the computed flow is said to be sure of (3 % "
            "before 1.33 s, 15 % later)."
        )
        lay_out(figure, [[axes] for axes in panels], [1.15, 1.15, 1.0, 1.0], _FRAME, text, 5)
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
