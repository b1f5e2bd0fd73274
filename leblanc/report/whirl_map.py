"""The report of `map`: where over speed and volume a whirl grows by itself, and how fast."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from leblanc.report.page import About, notes, write_page
from leblanc.report.parts import Cell, Table, picture, table
from leblanc.text.models import WHIRL
from leblanc.text.numbers import number
from leblanc.units import ML, RPM

if TYPE_CHECKING:
    from leblanc.figures.page import FigureFiles
    from leblanc.studies.whirl_map import StabilityRecord
    from solvers.whirl.edges import Bands

LISTED = 11  # volumes of the table of bands
MOST_BANDS = 4  # listed one by one


def band_words(bands: Bands) -> str:
    """Ranges of speed in which a whirl grows."""
    words = [f"{low * RPM:.5g} to {high * RPM:.5g}" for low, high in bands]
    if len(words) > MOST_BANDS:
        return f"{len(words)} bands between {bands[0][0] * RPM:.5g} and {bands[-1][1] * RPM:.5g}"
    return "; ".join(words) or "none"


def facts(record: StabilityRecord) -> list[tuple[str, str]]:
    """What the map says in numbers: label and value.

    Parameters
    ----------
    record : the map
    """
    growth, size = record.growth, record.growth.size
    unstable = growth > 0.0
    fastest, turning = "none grows", "none grows"
    if unstable.any():
        row, column = np.unravel_index(int(np.nanargmax(growth)), growth.shape)
        speed, volume = float(record.speed[column]), float(record.volume[row])
        at = f"{number(speed * RPM)} rpm, {number(volume * ML)} ml"
        fastest = f"{number(float(growth[row, column]))} 1/s at {at}"
        turning = f"{number(float(record.whirl_speed[row, column]) / speed)} of the spin"
    return [
        ("Volumes by speeds", f"{record.volume.size} by {record.speed.size}"),
        ("Most liquid, all chambers", f"{number(float(record.volume[-1]) * ML)} ml"),
        ("A whirl grows at", f"{number(100.0 * float(np.count_nonzero(unstable)) / size)} % of the points"),
        ("Fastest growth", fastest),
        ("That whirl's speed in space", turning),
        (
            f"Bands with the scene's {number(record.scene_volume * ML)} ml (rpm)",
            band_words(record.scene_edges),
        ),
        ("Friction of the liquid", record.friction),
        ("Support", record.damping),
    ]


def bands(record: StabilityRecord) -> Table:
    """Bands of speed in which a whirl grows, for a few volumes spread over the map."""
    rows = []
    for k in np.unique(np.linspace(0, record.volume.size - 1, LISTED).round().astype(int)).tolist():
        growth = record.growth[k]
        lost = bool(np.isnan(growth).any())
        most = float(np.nanmax(growth)) if not np.isnan(growth).all() else np.nan
        rows.append(
            (
                number(float(record.volume[k]) * ML),
                Cell(band_words(record.edges[k]), warning=lost),
                number(most),
            )
        )
    head = ("Liquid (ml)", "a whirl grows between (rpm)", "largest growth (1/s)")
    return table("", head, rows)


def checks(record: StabilityRecord) -> Table:
    """Where the map is not what it seems, in shares of its points."""
    lost, out = np.isnan(record.growth), ~record.in_range
    rows = [
        (label, Cell(_share(mask), warning=bool(mask.any())))
        for label, mask in (
            ("Modes not found", lost),
            ("Model out of range", out),
            ("Grows where out of range", out & (record.growth > 0.0)),
        )
    ]
    own = band_words(record.scene_edges)
    rows.append(("Unstable with the scene's volume (rpm)", Cell(own, warning=bool(record.scene_edges))))
    return table("", ("Limits of the answer", "at"), rows)


def _share(mask: np.ndarray) -> str:
    """How many of the points."""
    count = int(np.count_nonzero(mask))
    return f"{count} of {mask.size} points ({number(100.0 * count / mask.size)} %)" if count else "none"


def write_map_report(record: StabilityRecord, what: About, figure: FigureFiles, path: Path) -> None:
    """Write the report.

    Parameters
    ----------
    record : the map
    what : it is about
    figure : of it
    path : the file to write or replace
    """
    told = dict(facts(record))
    low, high = (number(float(one) * RPM) for one in (record.speed[0], record.speed[-1]))
    alt = (
        f"Map of the growth rate over speed and liquid, and of the whirl's speed where one grows; one grows "
        f"at {told['A whirl grows at']}, fastest: {told['Fastest growth']}."
    )
    parts = {
        "title": "Self-excited whirl over speed and volume",
        "machine": f"Whirls that grow by themselves from {low} to {high} rpm, from no liquid to "
        f"{told['Most liquid, all chambers']}.",
        "facts": table("", (), facts(record)),
        "checks": checks(record),
        "bands": bands(record),
        "pictures": [picture(figure, alt, record.notes)],
        "models": [("linear", " ".join(WHIRL))],
        "reason": "It is the only model that answers this for any growth and any whirl speed; the response "
        "to an unbalance (leblanc run) and the run-up in time take others.",
        "remarks": notes(record.notes),
    }
    write_page("map", what, parts, path)
