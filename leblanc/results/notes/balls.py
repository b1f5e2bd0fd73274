"""Notes of a rotor with balls at rest in the drum."""

from __future__ import annotations

from leblanc.results.base import Note, NoteCode
from leblanc.units import LENGTH, UNBALANCE, in_rpm, with_unit


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
    LOADS_OF_STATES = "loads_of_states"


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


def loads_of_states() -> Note:
    """Of which motion forces and clearances are."""
    text = (
        "Forces and clearances are those of the stable state that is told, at the speeds of the scene; where "
        "the balls run they are not known, and a run-up shows them."
    )
    return Note(BallCode.LOADS_OF_STATES, {}, text)
