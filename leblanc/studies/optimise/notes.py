"""Notes of a search for volumes or for balls."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING

from leblanc.core.notes import Note, NoteCode
from leblanc.core.units import LENGTH, VOLUME, in_rpm, with_unit

if TYPE_CHECKING:
    from leblanc.studies.optimise.answer import EmulatedAnswer, WettingVolumes


class OptimumCode(NoteCode):
    """What the notes of an optimum say."""

    GIVEN_DEFLECTION = "given_deflection"
    FEW_CELLS = "few_cells"
    NO_DUTY = "no_duty"
    NO_LIMIT = "no_limit"
    NO_RANGE = "no_range"
    TOO_DEEP = "too_deep"
    EMULATED = "emulated"
    LAMINAR = "laminar"
    NO_LIQUID = "no_liquid"
    INTERRUPTED = "interrupted"
    PARTED = "parted"
    AT_EDGE = "at_edge"
    SLOW = "slow"
    UNSTABLE_SPEEDS = "unstable_speeds"


NO_DUTY = Note(
    OptimumCode.NO_DUTY, {}, "No duty cycle is given: the mean is over the scene's speeds, all alike."
)
NO_RANGE = Note(
    OptimumCode.NO_RANGE, {}, "No range is given: taken are unbalances from half to twice the scene's."
)
LAMINAR = Note(
    OptimumCode.LAMINAR,
    {},
    "The scene has no friction, without which every layer makes some small whirl grow: small whirls are "
    "evaluated with the laminar friction of the liquid.",
)


def given_deflection(deflection: float, speed: float, gap: float, forms: Sequence[WettingVolumes]) -> Note:
    """Least volumes that wet the walls; `gap`: largest relative difference to the analytical check."""
    upright = any(form.full_volume > form.optimal_volume * (1.0 + 1e-6) for form in forms)
    full = " and ".join(with_unit(form.full_volume, VOLUME) for form in forms)
    text = (
        f"The deflection is given, {with_unit(deflection, LENGTH)} at {in_rpm(speed)}: the volumes are the "
        "least that leave no part of a wall dry over its whole height; search and analytical check differ by "
        f"{gap:.1e}."
    )
    if upright:
        text += f" Upright the wall is dry above the floor then: up to {full} more adds to the unbalance."
    data = {"deflection": deflection, "speed": speed, "gap": gap}
    return Note(OptimumCode.GIVEN_DEFLECTION, data, text)


def few_cells(few: int, all_of_them: int) -> Note:
    """The search ran run-ups on fewer cells than the scene's."""
    text = (
        f"The search ran the machine up with {few} cells round each wall; the best volumes were run "
        f"again with the scene's {all_of_them}."
    )
    return Note(OptimumCode.FEW_CELLS, {"cells": few, "scene_cells": all_of_them}, text)


def no_limit(limit: float, what: str) -> Note:
    """The vibration limit, m, is taken from what is possible, or from what is without balls."""
    text = f"No vibration limit is given: taken is {with_unit(limit, LENGTH)}, {what}."
    return Note(OptimumCode.NO_LIMIT, {"limit": limit}, text)


def too_deep(chamber: int, limit: float) -> Note:
    """The layer of a chamber, counted from 0, is deeper than a share of its radius."""
    text = f"Out of range: the layer in chamber {chamber + 1} is deeper than {limit:g} of its radius."
    return Note(OptimumCode.TOO_DEEP, {"chamber": chamber + 1, "limit": limit}, text)


def parted(chamber: int, count: int, volume: float) -> Note:
    """Baffles cut the liquid of a chamber into compartments up to some volume, m^3."""
    text = (
        f"Chamber {chamber + 1}: below {with_unit(volume, VOLUME)} its {count} baffles cut the liquid into "
        "compartments. There the steady answer is that of linear theory for small deflections, with an "
        "error that is not known."
    )
    return Note(OptimumCode.PARTED, {"chamber": chamber, "count": count, "volume": volume}, text)


def no_liquid(by_mass: bool, forbidden: tuple[str, ...]) -> Note:
    """The answer is no liquid: it is the least for a limit, or constraints forbid what vibrates less."""
    text = "No liquid is best: whatever was tried vibrates as much or more with it."
    if by_mass:
        text = "The limit is met without liquid."
    elif forbidden:
        names = " or ".join(name.replace("_", " ") for name in forbidden)
        text = f"No liquid is allowed that would help: whatever vibrates less exceeds {names}."
    return Note(OptimumCode.NO_LIQUID, {"by_mass": by_mass, "forbidden": list(forbidden)}, text)


def interrupted(
    evaluations: int, what: str = "sets of volumes", searched: bool = False, limit: str = ""
) -> Note:
    """The search was ended after so many evaluations, by a signal or a limit, or what comes after it was."""
    why = f"STOPPED by the limit of {limit}" if limit else "INTERRUPTED"
    text = f"{why} after {evaluations} {what}: the best of them, not of all that would have been tried."
    if searched:
        text = f"{why} after the search was done: the best volumes stand, the front is missing."
    data = {"evaluations": evaluations, "searched": searched} | ({"limit": limit} if limit else {})
    return Note(OptimumCode.INTERRUPTED, data, text)


def emulated(answer: EmulatedAnswer) -> Note:
    """How far an emulator could have led the search astray."""
    error = answer.error
    text = (
        f"The search asked an emulator of {error.samples} samples, off by {error.root_mean_square:.2g} on "
        f"unseen ones (root mean square; largest {error.largest:.2g}); the best volumes it found were "
        f"evaluated "
        f"by the solvers. By the emulator alone: {with_unit(answer.value, LENGTH)}, give or take "
        f"{with_unit(2.0 * answer.deviation, LENGTH)}."
    )
    return Note(OptimumCode.EMULATED, asdict(answer), text)


def at_edge(paths: tuple[str, ...]) -> Note:
    """A range of the balls ends where the search would go on."""
    text = f"At an end of the range given: {', '.join(paths)}. A wider range may do better."
    return Note(OptimumCode.AT_EDGE, {"paths": list(paths)}, text)


def slow(decay: float) -> Note:
    """Balls that have nothing in reserve come to rest slowly."""
    text = (
        f"Small motions decay with {decay:.3g} 1/s only: balls with hardly more than the unbalance come to "
        "rest slowly. A stability_margin asks for more."
    )
    return Note(OptimumCode.SLOW, {"decay": decay}, text)


def unstable_speeds(first: float, last: float) -> Note:
    """Speeds at which balls find no rest."""
    text = (
        f"With these balls no state is stable at some speeds from {in_rpm(first)} to {in_rpm(last)}: the "
        "balls run, and the amplitude taken there is that with all balls on the heavy side. "
        "A run-up in time shows the motion."
    )
    return Note(OptimumCode.UNSTABLE_SPEEDS, {"first": first, "last": last}, text)
