"""Notes of a rotor with balls at rest in the drum, and of charts of their stability."""

from __future__ import annotations

import math
from collections.abc import Sequence

from leblanc.core.notes import Note, NoteCode, percent
from leblanc.core.units import LENGTH, UNBALANCE, in_rpm, number, over_rpm, with_unit


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
    LOADS_OF_STATES = "loads_of_states"
    LIQUID_WAVES = "liquid_waves"
    FAMILY = "family"
    ELSEWHERE = "elsewhere"


def capacity(enough: bool, most: float) -> Note:
    """Whether the balls can take the unbalance away; together they hold at most so much, kg m."""
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


def rounded(size: float) -> str:
    """Amplitude of balls that stick, m, in the two digits that a sample of starts gives."""
    return with_unit(float(f"{size:.2g}"), LENGTH)


def sticks(
    speed: float, deflection: float, first: float, band: tuple[float, float, float], lies: bool
) -> Note:
    """What resistance to rolling leaves.

    At the last speed, rad/s: the deflection below which balls stay, m, and 5, 50 and 95 % of the amplitudes,
    m; `first` is the first speed at which a ball can stay, nan for none.
    """
    data = {"speed": speed, "deflection": deflection, "first": first, "band": band}
    why = "gravity across the axis moves the balls in every turn" if lies else ""
    if not math.isfinite(first):
        text = f"The balls resist to rolling, but stick at none of these speeds: {why}."
        return Note(BallCode.STICKS, data, text)
    below = f" Below {in_rpm(first)} {why}, and they do not stick." if why else ""
    text = (
        f"The balls resist to rolling: at {in_rpm(speed)} a ball stays where it is while the deflection "
        f"along its race is below {rounded(deflection)}. Balls let go from places all round leave an "
        f"amplitude of {rounded(band[0])} to {rounded(band[2])} (5 to 95 % of the starts), median "
        f"{rounded(band[1])}.{below} States and growth rates are those without this resistance. A run-up "
        "has it: its balls stick where its way takes them."
    )
    return Note(BallCode.STICKS, data, text)


def lies(rows: Sequence[tuple[float, float, float, float]]) -> Note:
    """Gravity across the axis turns in the drum.

    Each row: speed, rad/s, gravity over the balls' centrifugal acceleration, largest swing of a ball, rad,
    and what it shakes the axis by, m, nan where not known.
    """
    told = []
    for speed, share, swing, moved in dict.fromkeys(rows):
        text = f"at {in_rpm(speed)} it is {percent(share)} of what presses a ball to its race"
        if math.isfinite(swing):
            text += (
                f", balls swing by up to {number(math.degrees(swing))} deg once a turn and shake the axis by "
                f"{with_unit(moved, LENGTH)} with twice the spin"
            )
        told.append(text)
    sizes = f": {'; '.join(told)}" if told else ", and turns in the drum"
    text = f"Gravity across the axis is left out of the states{sizes}. A run-up has all of it."
    return Note(BallCode.LIES, {"rows": tuple(rows)}, text)


def uneven_supports() -> Note:
    """The drum's motion is no circle."""
    text = (
        "The supports differ: balls follow the forward part of the motion, and their small swing with twice "
        "the spin is left out; growth is that over one turn."
    )
    return Note(BallCode.UNEVEN, {}, text)


def liquid_in_step(model: str) -> Note:
    """How the liquid enters the growth."""
    how = "linear theory, a reference mass" if model == "linear" else "its exact equilibrium"
    text = (
        f"In the states the liquid is in {how}. In the growth of small motions it is a mass "
        "in step with the axis: self-excited whirl is reported by the scene without balls."
    )
    return Note(BallCode.LIQUID_IN_STEP, {"model": model}, text)


def runs_on(first: float, last: float, found: bool) -> Note:
    """Speeds at which balls find no rest."""
    told = "What is reported there is the state that small motions leave most slowly; a" if found else "A"
    text = (
        f"{over_rpm(first, last).capitalize()} no state in which all balls rest is stable: they "
        f"run in their races. {told} run-up shows the motion itself."
    )
    return Note(BallCode.RUNS_ON, {"first": first, "last": last}, text)


def family(first: float, last: float, dimension: int, least: float, largest: float) -> Note:
    """More balls than the state needs, between two speeds, rad/s.

    With the largest dimension of the families and the growth over all members, 1/s.
    """
    text = (
        f"{over_rpm(first, last).capitalize()} the balls can stand in infinitely many ways with the same "
        f"deflection (up to {dimension} direction{'' if dimension == 1 else 's'} to move along). Angles and "
        "growth are those of the member that creeping balls come to; over all members growth is from "
        f"{number(least)} to {number(largest)} 1/s."
    )
    data = {"first": first, "last": last, "dimension": dimension, "least": least, "largest": largest}
    return Note(BallCode.FAMILY, data, text)


def elsewhere(first: float, last: float) -> Note:
    """The reported member is not stable, others are."""
    text = (
        f"{over_rpm(first, last).capitalize()} the reported member is not stable, but others with the same "
        "deflection are: balls that leave it can come to rest there. A run-up shows whether they do."
    )
    return Note(BallCode.ELSEWHERE, {"first": first, "last": last}, text)


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
        "Balls that the balance does not need may move freely without unbalancing the rotor: no instability. "
        "Where they can stand in many ways growth is that of an even share; `leblanc run` has its range."
    )
    return Note(BallCode.FREE, {}, text)


def not_there(share: float, state: str) -> Note:
    """Where a chart has no state (balanced, heavy or light) to judge: share of its points."""
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
    """Several numbers vary together."""
    verb = "keeps its" if len(paths) == 2 else "keep their"
    text = f"{', '.join(paths[1:])} {verb} ratio to {paths[0]}."
    return Note(BallCode.IN_RATIO, {"paths": tuple(paths)}, text)


def loads_of_states() -> Note:
    """Of which motion forces and clearances are."""
    text = (
        "Forces and clearances are those of the stable state that is reported, at the speeds of the "
        "scene; where "
        "the balls run they are not known, and a run-up shows them."
    )
    return Note(BallCode.LOADS_OF_STATES, {}, text)


def liquid_waves(speed: float, amplitude: float, ripple: float, liquid: float, worst: float) -> Note:
    """What gravity across the axis does by waves in the liquid, the balls held where they rest.

    At the last speed: change of the amplitude's mean and its ripple, relative, and by how much the liquid's
    centre of mass goes round its mean, m; `worst` is the largest change of the mean at any speed of a stable
    state.
    """
    data = {"amplitude": amplitude, "ripple": ripple, "liquid": liquid, "worst": worst}
    if not math.isfinite(amplitude):
        text = f"What gravity's waves in the liquid do to the state at {in_rpm(speed)} is not known."
        return Note(BallCode.LIQUID_WAVES, data, text)
    text = (
        f"At {in_rpm(speed)} gravity's waves in the liquid change the mean amplitude by {percent(amplitude)} "
        f"and move it up and down by {percent(ripple)}, and the liquid's centre of mass goes round its mean "
        f"in the drum by {with_unit(liquid, LENGTH)}; at the other speeds the mean changes by up to "
        f"{percent(worst)}. These are estimates, with the balls held where they rest."
    )
    return Note(BallCode.LIQUID_WAVES, data, text)
