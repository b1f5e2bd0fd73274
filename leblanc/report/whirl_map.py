"""The report of `map`: where over speed and volume a whirl grows by itself, and how fast."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from leblanc.report.page import About, notes, write_page
from leblanc.report.parts import Cell, Table, picture, table
from leblanc.results.whirl_map import WhirlMap
from leblanc.text.models import WHIRL
from leblanc.text.numbers import number
from leblanc.text.whirl_map import answer, band_words, facts
from leblanc.units import ML, RPM

if TYPE_CHECKING:
    from leblanc.figures.page import FigureFiles

LISTED = 11  # volumes of the table of bands


def bands(result: WhirlMap) -> Table:
    """Bands of speed in which a whirl grows, for a few volumes spread over the map."""
    rows = []
    for k in np.unique(np.linspace(0, result.volume.size - 1, LISTED).round().astype(int)).tolist():
        growth = result.growth[k]
        lost = bool(np.isnan(growth).any())
        most = float(np.nanmax(growth)) if not np.isnan(growth).all() else np.nan
        rows.append(
            (
                number(float(result.volume[k]) * ML),
                Cell(band_words(result.edges[k]), warning=lost),
                number(most),
            )
        )
    head = ("Liquid (ml)", "a whirl grows between (rpm)", "largest growth (1/s)")
    return table("", head, rows)


def checks(result: WhirlMap) -> Table:
    """Where the map is not what it seems, in shares of its points."""
    lost, out = np.isnan(result.growth), ~result.in_range
    rows = [
        (label, Cell(_share(mask), warning=bool(mask.any())))
        for label, mask in (
            ("Modes not found", lost),
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


def write_map_report(result: WhirlMap, what: About, figure: FigureFiles, path: Path) -> None:
    """Write the report.

    Parameters
    ----------
    result : the map
    what : it is about
    figure : of it
    path : the file to write or replace
    """
    told = dict(facts(result))
    low, high = (number(float(speed) * RPM) for speed in (result.speed[0], result.speed[-1]))
    parts = {
        "title": "Self-excited whirl over speed and volume",
        "machine": f"Whirls that grow by themselves from {low} to {high} rpm, from no liquid to "
        f"{told['Most liquid, all chambers']}.",
        "answer": answer(result),
        "facts": table("", (), facts(result)),
        "checks": checks(result),
        "bands": bands(result),
        "pictures": [picture(figure)],
        "models": [("linear", " ".join(WHIRL))],
        "reason": "No other model answers this for any growth and any whirl speed.",
        "remarks": notes(result.notes),
    }
    write_page("map", what, parts, path)
