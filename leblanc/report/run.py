"""The reports of `run` (rotors of every kind) and `map`: answer, where it holds, figures, models and why."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from leblanc.core.blocks import Cell
from leblanc.core.page import About, picture, render
from leblanc.core.units import RPM, VOLUME, number, unit_for
from leblanc.report.page import notes
from leblanc.report.parts import Table, doubt, table
from leblanc.results.whirl_map import WhirlMap
from leblanc.studies.run.words import (
    WHIRL,
)
from leblanc.text.whirl_map import answer as whirl_map_answer
from leblanc.text.whirl_map import band_words
from leblanc.text.whirl_map import facts as whirl_map_facts

if TYPE_CHECKING:
    from leblanc.figures.drawing.page import FigureFiles


CYCLES = (
    "Nonlinear long waves that stand in the whirl's frame, rotor and every cell of every layer solved at "
    "once; stability by Floquet multipliers."
)
LISTED = 11  # volumes of the table of bands


def bands(result: WhirlMap) -> Table:
    """Bands of speed in which a whirl grows, for a few volumes spread over the map."""
    rows, unit = [], unit_for(VOLUME, *result.volume.tolist())
    for k in np.unique(np.linspace(0, result.volume.size - 1, LISTED).round().astype(int)).tolist():
        growth = result.growth[k]
        lost = bool(np.isnan(growth).any())
        most = float(np.nanmax(growth)) if not np.isnan(growth).all() else np.nan
        rows.append(
            (
                unit.number(float(result.volume[k])),
                Cell(band_words(result.edges[k]), warning=lost),
                number(most),
            )
        )
    head = (f"Liquid ({unit.name})", "a whirl grows between (rpm)", "largest growth (1/s)")
    return table("", head, rows)


def map_checks(result: WhirlMap) -> Table:
    """Where the map is not what it seems, in shares of its points."""
    lost, out = np.isnan(result.growth), ~result.in_range
    rows = [
        (label, Cell(_share(mask), warning=bool(mask.any())))
        for label, mask in (
            ("Growth not known", lost),
            ("Model out of range", out),
            ("Grows where out of range", out & (result.growth > 0.0)),
        )
    ]
    own = band_words(result.scene_edges)
    rows.append(("Unstable with the scene's volume (rpm)", Cell(own, warning=bool(result.scene_edges))))
    return table("", ("Limits of the answer", "at"), rows)


def _share(mask: np.ndarray) -> str:
    """How many of the points."""
    count = int(np.count_nonzero(mask))
    return f"{count} of {mask.size} points ({number(100.0 * count / mask.size)} %)" if count else "none"


def write_map_report(result: WhirlMap, what: About, figures: Sequence[FigureFiles], path: Path) -> None:
    """Write the report.

    Parameters
    ----------
    result : the map
    what : it is about
    figures : of it
    path : the file to write or replace
    """
    values = dict(whirl_map_facts(result))
    low, high = (number(float(speed) * RPM) for speed in (result.speed[0], result.speed[-1]))
    parts = {
        "title": "Self-excited whirl over speed and volume",
        "machine": f"Whirls that grow by themselves from {low} to {high} rpm, from no liquid to "
        f"{values['Most liquid, all chambers']}.",
        "answer": whirl_map_answer(result),
        "doubt": doubt(map_checks(result)),
        "facts": table("", (), whirl_map_facts(result)),
        "checks": map_checks(result),
        "bands": bands(result),
        "pictures": [picture(figure) for figure in figures],
        "models": [("linear", " ".join(WHIRL)), *([("long_wave", CYCLES)] if result.branches else [])],
        "reason": "No other model answers this for any growth and any whirl speed.",
        "remarks": notes(result.notes),
    }
    render("map", what, parts, path, "leblanc.report")
