"""Notes of a search for the balls of a rotor."""

from __future__ import annotations

from leblanc.core.notes import Note, NoteCode
from leblanc.core.units import LENGTH, in_rpm, with_unit


class DesignCode(NoteCode):
    """What these notes say."""

    NO_RANGE = "no_range"
    NO_LIMIT = "no_limit"
    AT_EDGE = "at_edge"
    SLOW = "slow"
    UNSTABLE_SPEEDS = "unstable_speeds"
    INTERRUPTED = "interrupted"


def no_range() -> Note:
    """The unbalances are half to twice the scene's."""
    text = "No range is given: taken are unbalances from half to twice the scene's."
    return Note(DesignCode.NO_RANGE, {}, text)


def no_limit(limit: float) -> Note:
    """The vibration limit is a hundredth of the amplitude without balls, m."""
    share = f"{with_unit(limit, LENGTH)}, a hundredth of the amplitude without balls"
    return Note(DesignCode.NO_LIMIT, {"limit": limit}, f"No vibration limit is given: taken is {share}.")


def at_edge(paths: tuple[str, ...]) -> Note:
    """A range ends where the search would go on."""
    text = f"At an end of the range given: {', '.join(paths)}. A wider range may do better."
    return Note(DesignCode.AT_EDGE, {"paths": list(paths)}, text)


def slow(decay: float) -> Note:
    """Balls that have nothing in reserve come to rest slowly."""
    text = (
        f"Small motions fade with {decay:.3g} 1/s only: balls with hardly more than the unbalance come to "
        "rest slowly. A stability_margin asks for more."
    )
    return Note(DesignCode.SLOW, {"decay": decay}, text)


def unstable_speeds(first: float, last: float) -> Note:
    """Speeds at which balls find no rest."""
    text = (
        f"With these balls no state is stable at some speeds from {in_rpm(first)} to {in_rpm(last)}: the "
        "balls run, and the amplitude taken there is that with all balls on the heavy side. "
        "A run-up in time shows the motion."
    )
    return Note(DesignCode.UNSTABLE_SPEEDS, {"first": first, "last": last}, text)


def interrupted(evaluations: int) -> Note:
    """The search was interrupted."""
    text = f"INTERRUPTED after {evaluations} designs: this is the best of them, not of all to be tried."
    return Note(DesignCode.INTERRUPTED, {"evaluations": evaluations}, text)
