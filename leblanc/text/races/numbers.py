"""A scene with balls in numbers, as text."""

from __future__ import annotations

import math

import numpy as np

from leblanc.core.notes import one_line
from leblanc.core.units import LENGTH, MASS, MM, RPM, UNBALANCE, in_rpm, number, ranges, with_unit
from leblanc.results.races.numbers import BallExplanation, RaceNumbers
from leblanc.text.explanation import machine_rows

Rows = list[tuple[str, str]]

_TURN = 2.0 * math.pi


def race_rows(race: RaceNumbers, last: float) -> Rows:
    """One race with its balls; label and text."""
    held = f"{with_unit(race.capacity, UNBALANCE)} at most"
    if math.isfinite(race.share) and race.share > 0.0:
        held += f", {race.capacity / race.share:.4g} times its share, {with_unit(race.share, UNBALANCE)}"
    rows = [
        ("balls", f"{race.count} of {with_unit(race.mass, MASS)}, in the plane {number(race.plane * MM)} mm")
    ]
    rows.append(("hold", held))
    if race.crowding > 0.0:
        rows.append(("room", f"side by side they take {race.crowding:.3g} of the way round"))
    rows.append(("follow the drum", _fades(race, last)))
    if race.sticking > 0.0:
        rows.append(("stick", f"while the axis moves by less than {with_unit(race.sticking, LENGTH)}"))
    return rows


def _fades(race: RaceNumbers, last: float) -> str:
    if math.isinf(race.fade_time):
        return "never: nothing drags on them"
    turns = race.fade_time * last / _TURN
    return (
        f"their speed against it fades with {number(race.fade_time)} s, {number(turns)} turns at "
        f"{in_rpm(last)}; drag {race.drag:.3g} of mass times critical speed"
    )


def ball_rows(answer: BallExplanation) -> Rows:
    """Whether and from where on the balls balance; label and text."""
    can = "yes" if answer.can_balance else "no"
    rows = [
        (
            "unbalance",
            f"{with_unit(answer.unbalance, UNBALANCE)}; all balls weigh {with_unit(answer.ball_mass, MASS)}",
        ),
        ("can balance it", f"{can}: {answer.reason}"),
    ]
    if answer.can_balance:
        rows.append(("balanced state", _stable_from(answer)))
    if answer.single_plane is not None:
        where = ranges(answer.speed, answer.single_plane)
        rows.append(("one plane", f"light balls balance this plane at {where}"))
    rows += _two_planes(answer)
    return rows


def _stable_from(answer: BallExplanation) -> str:
    known = np.isfinite(answer.growth)
    last = f"at {in_rpm(float(answer.speed[-1]))} small motions "
    rate = float(answer.growth[-1]) if known[-1] else math.nan
    last += (
        "are not known"
        if math.isnan(rate)
        else f"{'grow' if rate > 0.0 else 'fade'} with {number(abs(rate))} 1/s"
    )
    if math.isnan(answer.balanced_from):
        return f"stable at none of the speeds to the end of the scene's; {last}"
    ratio = answer.balanced_from / answer.machine.critical_speed_dry
    return f"stable from {in_rpm(answer.balanced_from)} on, {ratio:.3g} times the critical speed; {last}"


def _two_planes(answer: BallExplanation) -> Rows:
    """Conditions of balancing in two planes, and what these balls do."""
    found = answer.balancing
    if found is None:
        return []
    whole = (
        "not possible at any speed" if math.isinf(found.above) else f"possible above {in_rpm(found.above)}"
    )
    rows = [("two planes", f"{whole}, by the conditions without damping; at the last speed {found.why(-1)}")]
    if found.growth is not None:
        rows.append(("with these balls", f"stable at {ranges(found.speed, found.holds)}"))
    return rows


def facts(answer: BallExplanation) -> Rows:
    """Main numbers of a scene: label and value."""
    last = float(answer.speed[-1])
    return [
        ("Scene", one_line(answer.name)),
        *machine_rows(answer.machine)[:3],
        *ball_rows(answer),
        *(
            (f"race {k + 1}: {label}", text)
            for k, race in enumerate(answer.races)
            for label, text in race_rows(race, last)
        ),
    ]


def alt(answer: BallExplanation) -> str:
    """What the figure shows."""
    if not answer.can_balance:
        return f"No balanced state: {answer.reason}."
    rpm = answer.speed * RPM
    return (
        f"Growth of small motions about the balanced state from {rpm[0]:.4g} to {rpm[-1]:.4g} rpm: "
        f"{_stable_from(answer)}."
    )
