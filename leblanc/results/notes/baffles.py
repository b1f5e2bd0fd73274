"""Notes of baffles in layers that go through time."""

from __future__ import annotations

from collections.abc import Sequence

from fluid.fill import Fill
from leblanc.results.base import Note, NoteCode
from solvers.layer.places import is_smeared


class BaffleCode(NoteCode):
    """What the notes of baffles say."""

    SMEARED_BAFFLES = "smeared_baffles"


def smeared_baffles(fills: Sequence[Fill], cells: int | None) -> list[Note]:
    """Which chambers have baffles that are a sink all over the layer, and why.

    Parameters
    ----------
    fills : chambers and their liquid
    cells : round each wall; None where the layers are linear
    """
    found = []
    for k, fill in enumerate(fills):
        baffles = fill.chamber.baffles
        if baffles is None or not fill.uneven or not (cells is None or is_smeared(fill, cells)):
            continue
        why = (
            "a linear layer has no places for them, and its waves do not feel them"
            if cells is None
            else f"{cells} cells are fewer than four between two of them"
        )
        plates = f"the resistance of its {baffles.count} baffles"
        text = f"Chamber {k + 1}: {plates} is smeared over the layer: {why}."
        data = {"chamber": k, "count": baffles.count, "cells": cells}
        found.append(Note(BaffleCode.SMEARED_BAFFLES, data, text))
    return found
