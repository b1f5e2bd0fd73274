"""Notes of baffles: in layers that go through time, and where they close compartments."""

from __future__ import annotations

from collections.abc import Sequence

from fluid.fill import Fill
from leblanc.core.notes import Note, NoteCode, percent
from leblanc.core.units import LENGTH, with_unit
from solvers.layer.places import is_smeared


class BaffleCode(NoteCode):
    """What the notes of baffles say."""

    SMEARED_BAFFLES = "smeared_baffles"
    CLOSED_COMPARTMENTS = "closed_compartments"


def closed_compartments(fill: Fill) -> str:
    """What closed compartments do to the balance, in a sentence; empty where the liquid passes the baffles.

    Theory: sections, eq. 8.
    """
    baffles, chamber = fill.chamber.baffles, fill.chamber
    if baffles is None or fill.compartments < 2:
        return ""
    high, left = chamber.radius - baffles.tip_radius, fill.added_mass / fill.full_mass
    deep = with_unit(fill.depth, LENGTH)
    return (
        f"baffles of {with_unit(high, LENGTH)} are higher than the layer of {deep} and close {baffles.count} "
        "compartments: the liquid cannot gather on one side, its balancing mass is "
        f"{percent(left)} of that in a clear ring"
    )


def compartment_notes(fills: Sequence[Fill]) -> list[Note]:
    """Which chambers hardly balance because their baffles close compartments, equal ones in one sentence."""
    alike: dict[str, list[int]] = {}
    for k, fill in enumerate(fills):
        if said := closed_compartments(fill):
            alike.setdefault(said, []).append(k)
    found = []
    for said, own in alike.items():
        names = f"Chamber{'s' if own[1:] else ''} {' and '.join(str(k + 1) for k in own)}"
        data = {"chambers": tuple(own), "count": fills[own[0]].compartments, "depth": fills[own[0]].depth}
        text = f"{names}: {said}. Lower baffles or more liquid let it pass."
        found.append(Note(BaffleCode.CLOSED_COMPARTMENTS, data, text))
    return found


def smeared_baffles(fills: Sequence[Fill], cells: int | None) -> list[Note]:
    """Which chambers have baffles that are a sink all over the layer, and why."""
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
