"""Notes of a rotor with balls at rest in the drum, and of charts of their stability."""

from __future__ import annotations

from collections.abc import Sequence

from leblanc.results.base import Note, NoteCode
from leblanc.units import LENGTH, UNBALANCE, in_rpm, number, with_unit


class BallCode(NoteCode):
    """What these notes say."""

    CAPACITY = "capacity"
    POINTS = "points"
    STICKS = "sticks"
    LIES = "lies"
    UNEVEN = "uneven_supports"
    LIQUID_IN_STEP = "liquid_in_step"
    COVERED = "covered"
    RUNS_ON = "runs_on"
    FREE = "free_balls"
    NOT_THERE = "not_there"
    BETWEEN_LINES = "between_lines"
    IN_RATIO = "in_ratio"


def capacity(enough: bool, most: float) -> Note:
    """Whether the balls can take the unbalance away.

    Parameters
    ----------
    enough : they can
    most : that they hold all together, kg m
    """
    held = f"All balls on one side make an unbalance of {with_unit(most, UNBALANCE)}"
    text = (
        f"{held}: {'enough' if enough else 'not enough, or not in the right planes,'} to balance the rotor."
    )
    return Note(BallCode.CAPACITY, {"enough": enough, "most": most}, text)


def points() -> Note:
    """What every state of balls assumes."""
    text = (
        "The balls are points that pass through one another, always pressed to their race. Where balls are "
        "together they would in truth lie side by side."
    )
    return Note(BallCode.POINTS, {}, text)


def sticks(deflection: float) -> Note:
    """What resists to rolling leaves a band.

    Parameters
    ----------
    deflection : below which balls stay, m
    """
    text = (
        f"Balls that resist to rolling stay where they are while the axis moves by less than "
        f"{with_unit(deflection, LENGTH)}: any deflection up to that may remain. The states are those "
        "without this resistance."
    )
    return Note(BallCode.STICKS, {"deflection": deflection}, text)


def lies() -> Note:
    """Gravity across the axis turns in the drum."""
    text = "Gravity across the axis is left out: it turns in the drum and swings the balls. A run-up has it."
    return Note(BallCode.LIES, {}, text)


def uneven_supports() -> Note:
    """The drum's motion is no circle."""
    text = (
        "The supports differ: balls follow the forward part of the motion, and their small swing with twice "
        "the spin is left out; growth is that over one turn."
    )
    return Note(BallCode.UNEVEN, {}, text)


def liquid_in_step() -> Note:
    """How the liquid enters the growth."""
    text = (
        "In the states the liquid is in its exact equilibrium. In the growth of small motions it is a mass "
        "in step with the axis: whirls that the liquid itself excites are told by the scene without balls."
    )
    return Note(BallCode.LIQUID_IN_STEP, {}, text)


def runs_on(first: float, last: float) -> Note:
    """Speeds at which balls find no rest.

    Parameters
    ----------
    first, last : of them, rad/s
    """
    text = (
        f"At speeds from {in_rpm(first)} to {in_rpm(last)} no state in which all balls rest is stable: they "
        "run in their races. What is told there is the state that small motions leave most slowly; a run-up "
        "shows the motion itself."
    )
    return Note(BallCode.RUNS_ON, {"first": first, "last": last}, text)


def covered() -> Note:
    """Balls in liquid."""
    text = (
        "Balls in liquid lose the weight of what they displace and take half of that mass along; the liquid "
        "turns with the drum."
    )
    return Note(BallCode.COVERED, {}, text)


def free_balls() -> Note:
    """Which motions of the balls do not count."""
    text = (
        "Balls that the balance does not need may move freely without unbalancing the rotor: no instability."
    )
    return Note(BallCode.FREE, {}, text)


def not_there(share: float, state: str) -> Note:
    """Where a chart has nothing to judge.

    Parameters
    ----------
    share : of the points
    state : balanced, heavy or light
    """
    where = f"At {number(100.0 * share)} % of the points there is no such state: "
    why = (
        "the balls are too light for the unbalance." if state == "balanced" else "the balls stand elsewhere."
    )
    return Note(BallCode.NOT_THERE, {"share": share}, where + why)


def between_lines() -> Note:
    """What a grid can miss."""
    text = (
        "A curve is sought wherever two neighbours of the grid differ and followed from there: one that "
        "passes between the lines of the grid is not seen, and one on which several roots pass at once is "
        "not drawn."
    )
    return Note(BallCode.BETWEEN_LINES, {}, text)


def in_ratio(paths: Sequence[str]) -> Note:
    """Several numbers vary together.

    Parameters
    ----------
    paths : of them
    """
    verb = "keeps its" if len(paths) == 2 else "keep their"
    text = f"{', '.join(paths[1:])} {verb} ratio to {paths[0]}."
    return Note(BallCode.IN_RATIO, {"paths": tuple(paths)}, text)
