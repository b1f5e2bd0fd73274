"""The figures of results, as PNG and SVG, and films.

Figures are drawn on the object interface: to import pyplot costs more than to draw them all. `page` is the
only door to matplotlib; a figure carries its caption, its alternative text and its size.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

# Names handed on, and their modules, each loaded when its name is first used.
_HOMES = {
    **dict.fromkeys(("FigureFiles", "save", "style"), "leblanc.figures.drawing.page"),
    **dict.fromkeys(
        ("amplitude_figure", "campbell_figure", "liquid_figure", "phase_figure", "write_figures"),
        "leblanc.studies.run.figure",
    ),
    **dict.fromkeys(("animate", "history_figure", "wave_figure"), "leblanc.figures.wave"),
    "chamber_figure": "leblanc.figures.chambers",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)
