"""What the notes of layers and baffles say, and the numbers that a model of a layer rests on."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass

from fluid.fill import Fill
from leblanc.core.notes import Note, NoteCode, percent
from leblanc.core.units import LENGTH, with_unit
from solvers.layer.places import is_smeared


class LayerCode(NoteCode):
    """What the notes of a layer say."""

    NO_ANSWER = "no_answer"
    OUT_OF_RANGE = "out_of_range"
    INNER_WALL = "inner_wall"
    AGAINST_WHIRL = "against_whirl"
    DRY_WALL = "dry_wall"
    LEE_WAVES = "lee_waves"
    NO_SMOOTH_WAVE = "no_smooth_wave"
    NO_EXACT_WAVE = "no_exact_wave"
    TWO_GRIDS = "two_grids"
    FRICTION_FREQUENCY = "friction_frequency"


@dataclass(frozen=True)
class Number:
    """A dimensionless number and the range in which the model holds."""

    name: str  #: what it is
    meaning: str
    value: float  #: not finite where it has no bound or was not found
    least: float | None  #: the model's range; None where it sets none
    most: float | None
    in_range: bool  #: the value is within

    def __str__(self) -> str:
        least, most = self.least or 0.0, math.inf if self.most is None else self.most
        allowed = f"at least {least:g}" if math.isinf(most) else f"{least:g} to {most:g}"
        return f"{self.meaning} = {self.value:.2g}, the model's range is {allowed}"


def no_answer(reason: str) -> Note:
    """Why there is no answer, or none to rely on."""
    return Note(LayerCode.NO_ANSWER, {}, reason)


def out_of_range(numbers: tuple[Number, ...]) -> tuple[Note, ...]:
    """The numbers that are out of their range, a note for each."""
    return tuple(
        Note(LayerCode.OUT_OF_RANGE, asdict(number), str(number)) for number in numbers if not number.in_range
    )


def inner_wall() -> Note:
    """The surface reaches the inner wall."""
    return Note(LayerCode.INNER_WALL, {}, "the surface reaches the inner wall")


def against_whirl(share: float) -> Note:
    """The liquid answers against the whirl as well, at a share of its answer with the whirl."""
    text = f"the liquid also answers against the whirl, {share:.3g} times as strongly"
    return Note(LayerCode.AGAINST_WHIRL, {"share": share}, text)


def dry_wall() -> Note:
    """The wall is dry in part."""
    return Note(LayerCode.DRY_WALL, {}, "the wall is dry in part")


def lee_waves() -> Note:
    """Shorter waves ride on the wave of the whirl."""
    return Note(LayerCode.LEE_WAVES, {}, "shorter waves ride on the wave, as they do in the lee of a whirl")


def no_smooth_wave(whirl: float, largest: float, fold: bool) -> Note:
    """The whirl is larger than any up to which a smooth steady wave follows it, both over the mean depth.

    Above the resonance such waves end at a fold, below it the flow chokes.
    """
    way = "it turns back" if fold else "the flow chokes"
    text = f"no smooth steady wave follows a whirl as it grows to {whirl:.2g} of the mean depth: "
    text += f"without friction {way} at {largest:.2g}"
    return Note(LayerCode.NO_SMOOTH_WAVE, {"whirl": whirl, "largest": largest, "fold": fold}, text)


def no_exact_wave(reason: str) -> Note:
    """Another model answers: no fully nonlinear wave was found where the analytical check has one."""
    return Note(LayerCode.NO_EXACT_WAVE, {}, f"no smooth fully nonlinear wave was found: {reason}")


def two_grids(gap: float) -> Note:
    """The whirl is larger than smooth waves follow: the error is that between two grids."""
    text = (
        "without friction no smooth steady wave follows so large a whirl: this one is as steep as the cells "
    )
    text += f"let it be, and the force on half as many differs by {percent(gap)}"
    return Note(LayerCode.TWO_GRIDS, {"gap": gap}, text)


def friction_frequency(frequency: float, alone: bool) -> Note:
    """The one frequency seen from the drum, rad/s, that laminar friction takes under gravity across the axis.

    Alone: nothing else moves; else it is a mean of that of the whirl and that of gravity.
    """
    of = "gravity, which turns in the drum" if alone else "whirl and gravity, weighted with their energies"
    text = f"laminar friction is that of {frequency:.4g} rad/s seen from the drum, the frequency of {of}"
    return Note(LayerCode.FRICTION_FREQUENCY, {"frequency": frequency}, text)


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


def slowed_by(fills: Sequence[Fill]) -> str:
    """What makes the waves of a machine slow, after a colon; empty where nothing does."""
    counts = [fill.chamber.baffles.count for fill in fills if fill.chamber.baffles is not None]
    return f": {max(counts)} baffles by finite elements" if counts else ""


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
