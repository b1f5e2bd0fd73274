"""The report of a search for the layout of a tub's mounts: places before and after, and what it gains."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from leblanc.core.units import LENGTH, with_unit
from leblanc.report.page import About, write_page
from leblanc.report.parts import Cell, Table, doubt, picture, table
from leblanc.results.machine.layout import LayoutResult
from leblanc.text.layout import (
    FREQUENCIES,
    MOUNTS,
    PAIR_HEAD,
    answer,
    coupling_rows,
    facts,
    frequency_rows,
    mount_rows,
    remarks,
)

if TYPE_CHECKING:
    from leblanc.figures.drawing.page import FigureFiles


def layout_checks(result: LayoutResult) -> Table:
    """What the layout must keep to."""
    sag = result.constraints["sag"]
    text = f"{with_unit(sag.value, LENGTH)}, at most {with_unit(sag.limit, LENGTH)}"
    rows = [("Sag under the weight", Cell(text, warning=not sag.satisfied))]
    return table("", ("Limits of the answer", ""), rows)


def write_layout_report(
    result: LayoutResult, what: About, figures: Sequence[FigureFiles], path: Path
) -> None:
    """Write the report."""
    about = "for the least couplings of stiffness and damping"
    if result.measure == "separation":
        about = "for natural frequencies far from the running speeds"
    parts = {
        "title": "Layout of springs and dampers",
        "machine": f"Places and directions of {len(result.mounts)} springs and dampers of a tub, searched "
        f"{about}.",
        "answer": answer(result),
        "doubt": doubt(layout_checks(result)),
        "facts": table("", (), facts(result)[4:]),
        "checks": layout_checks(result),
        "mounts": table("Springs and dampers", MOUNTS, mount_rows(result)),
        "couplings": table("Couplings about the centre of mass", PAIR_HEAD, coupling_rows(result)),
        "frequencies": table("Natural frequencies at rest", FREQUENCIES, frequency_rows(result)),
        "pictures": [picture(figure) for figure in figures],
        "remarks": remarks(result),
    }
    write_page("layout", what, parts, path)
