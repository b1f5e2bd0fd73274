"""Figures of a layer's answers: its wave, its whirl periods."""

from __future__ import annotations

from leblanc.core.units import MM
from leblanc.figures.drawing.page import Figure, lay_out, style
from leblanc.figures.wave import NOTED_LINES, TIME_FRAME, wave_figure
from leblanc.figures.wave import animate as animate  # a film is drawn and written together
from leblanc.studies.layer.answer import FreeWaveAnswer, LayerAnswer, PeriodsAnswer


def layer_figure(result: LayerAnswer | FreeWaveAnswer) -> Figure:
    """The main figure of a layer's answer."""
    return wave_figure(result.wave())


def periods_figure(result: PeriodsAnswer) -> Figure:
    """Force on the drum and mean rotation over the whirl periods of a layer that starts from rest."""
    h, model = result.history, result.case.model
    with style():
        figure = Figure()
        rows = [[figure.add_axes((0, 0, 1, 1), label=name)] for name in ("force", "rotation", "depths")]
        force, rotation, depths = (row[0] for row in rows)
        force.plot(h.time, h.force_ratio.real, marker="o", label="force along the deflection")
        force.plot(h.time, h.force_ratio.imag, marker="s", linestyle="--", label="force 90 deg ahead of it")
        force.set_ylabel("Force ratio (-)")
        rotation.plot(h.time, h.mean_rotation, color="0.15", marker="^", label="mean rotation in the drum")
        rotation.set_ylabel("Rotation (rad/s)")
        depths.plot(h.time, h.depth_max * MM, label="crest")
        depths.plot(h.time, h.depth_min * MM, linestyle="--", label="trough")
        depths.set_ylabel("Depth (mm)")
        depths.set_xlabel("Time (s)")
        for axes in (force, rotation):
            axes.tick_params(labelbottom=False)
        text = f"Means over periods of the whirl seen from the drum. Liquid model: {model}."
        lay_out(figure, rows, [1.5, 1.0, 1.2], TIME_FRAME, text, NOTED_LINES)
        figure.alt = "Curves over time of the force on the drum, the liquid's rotation and its depths."
    return figure
