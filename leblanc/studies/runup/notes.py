"""Notes of a run-up: what happened, how well it is known, where its models hold."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from leblanc.core.notes import Note, NoteCode, percent
from leblanc.core.units import (
    LENGTH,
    TIME,
    in_rpm,
    number,
    rpm_bands,
    rpm_range,
    small_whirl_friction,
    with_unit,
)
from leblanc.studies.run.answer import peak
from leblanc.studies.run.notes import CLOSURE, STANDS
from meshes.arrays import Flags

if TYPE_CHECKING:
    from fluid.friction.laws import Friction
    from leblanc.scene.programme.table import Programme
    from leblanc.studies.runup.answer import Passage
    from solvers.runup.ensemble import Spread
    from solvers.runup.machine import Transfer
    from solvers.runup.programme import Programme as Stages
    from solvers.runup.runup import RunupHistory
    from solvers.synchronous.response import Response


SETTLED = 1e-6  # of the largest amplitude: what rounding may change without being spoken of
ERROR = 0.02  # of the largest amplitude: an error estimate to speak of
# Round a wall: on front loaders with 0.2 to 1.4 l in each ring 32 cells change the largest amplitude by up to
# 7 % beside 128 cells, 64 by up to 4 %.
ENOUGH_CELLS = 64
FEW = 4  # times that liquid is caught or falls, up to which each is reported
BALLS_REST = 1e-3  # of the spin: balls that pass the drum by less are at rest in it
_REACHED = 1e-4  # of a step's speed, that it counts as reached


class RunupCode(NoteCode):
    """What the notes of a run-up say."""

    LIQUID_MODEL = "liquid_model"
    STOPPED = "stopped"
    ERROR_UNKNOWN = "error_unknown"
    TOO_COARSE = "too_coarse"
    ROUGH = "rough"
    HANDOVER = "handover"
    ROUNDING = "rounding"
    ENERGY = "energy"
    PEAK = "peak"
    PEAK_STEADY = "peak_steady"
    CAPTURED = "captured"
    FALLS_BACK = "falls_back"
    NOT_CARRIED = "not_carried"
    SELF_EXCITED = "self_excited"
    TOO_SLOW = "too_slow"
    INNER_WALL = "inner_wall"
    FULL_GAP = "full_gap"
    TOO_DEEP = "too_deep"
    TOO_HIGH = "too_high"
    STANDING = "standing"
    NO_DRAG = "no_drag"
    COAST_NOT_ENDED = "coast_not_ended"
    STOOD = "stood"
    MOTOR_LIMITED = "motor_limited"
    UNBALANCE_LEFT = "unbalance_left"
    LOADS = "loads"
    BALLS_AS_POINTS = "balls_as_points"
    WHIRL_BESIDE_BALLS = "whirl_beside_balls"
    WHIRL_BESIDE_BAFFLES = "whirl_beside_baffles"
    NOT_PHYSICAL = "not_physical"
    BALLS_RUN = "balls_run"


def happened(
    history: RunupHistory,
    steady: Response | None,
    spread: Spread | None,
    faults: Sequence[str],
    cells: int | None,
) -> Iterator[Note]:
    """What happened, and how well it is known.

    `cells` of a layer that comes from a pool across the axis, None of others.
    """
    if not history.converged:
        yield Note(RunupCode.STOPPED, {}, f"The run stopped: {history.reason}.")
    if (note := numerical_error(history.error_estimate, cells)) is not None:
        yield note
    if (error := history.handover_estimate) > ERROR:
        text = (
            "When liquid becomes a ring is known roughly: with twice the grip of the walls on the liquid at "
            f"the bottom the amplitude at single times differs by up to {percent(error)} of its largest, as "
            "the transition comes earlier."
        )
        yield Note(RunupCode.HANDOVER, {"error": error}, text)
    if spread is not None:
        yield rounding(spread, history)
    if faults:
        yield Note(RunupCode.NOT_PHYSICAL, {"faults": list(faults)}, f"Not physical: {'; '.join(faults)}.")
    if (closure := history.audit.closure) > CLOSURE:
        text = f"The energy balance leaves {closure:.1%} of the work unaccounted for."
        yield Note(RunupCode.ENERGY, {"closure": closure}, text)
    yield largest_amplitude(history, steady)
    for chamber in sorted({transfer.chamber for transfer in history.transfers}):
        own = [transfer for transfer in history.transfers if transfer.chamber == chamber]
        few = len(own) <= FEW
        yield from (capture(each, history) for each in own) if few else [_again_and_again(own)]


def numerical_error(error: float, cells: int | None = None) -> Note | None:
    """Error of the amplitude over its largest, nan where it was not estimated; None where it is small.

    `cells` of a layer that comes from a pool across the axis.
    """
    if math.isnan(error):
        if cells is not None and cells < ENOUGH_CELLS:
            text = (
                f"Too coarse: the error of the amplitude was not estimated, and {cells} cells round a wall "
                "hardly follow liquid from the pool at the bottom to the annular layer. More of them may "
                f"change the largest amplitude by a tenth: take {ENOUGH_CELLS}, or the check."
            )
            return Note(RunupCode.TOO_COARSE, {"cells": cells, "enough": ENOUGH_CELLS}, text)
        return Note(RunupCode.ERROR_UNKNOWN, {}, "The error of the amplitude was not estimated.")
    if error <= ERROR:
        return None
    text = (
        f"With half the cells the amplitude at single times differs by up to {percent(error)} of its "
        "largest: what happens there comes a little earlier or later."
    )
    return Note(RunupCode.ROUGH, {"error": error}, text)


def rounding(spread: Spread, history: RunupHistory) -> Note:
    """What rounding alone does to a run-up, beside its error estimate."""
    width = spread.amplitude_max - spread.amplitude_min
    when = int(np.nanargmax(width))
    data = {
        "members": spread.members,
        "change": spread.change,
        "peak_spread": spread.peak_spread,
        "largest_spread": spread.largest_spread,
        "time": float(history.time[when]),
        "speed": float(history.speed[when]),
    }
    runs = f"over {spread.members} runs with an unbalance within {spread.change:.0e}"
    if spread.largest_spread < SETTLED:
        text = (
            f"Rounding does not matter: {runs} amplitudes differ by {spread.largest_spread:.0e} of the peak."
        )
        return Note(RunupCode.ROUNDING, data, text)
    error = history.error_estimate
    beside = ""
    if not math.isnan(error):
        than = "less" if spread.largest_spread < error else "more"
        beside = f", {than} than the {percent(error)} that half the cells change"
    text = (
        f"By rounding alone, {runs}, the largest amplitude differs by {percent(spread.peak_spread)} and the "
        f"amplitude at one time by up to {percent(spread.largest_spread)} of it, after "
        f"{with_unit(data['time'], TIME)} at {in_rpm(data['speed'])}{beside}."
    )
    return Note(RunupCode.ROUNDING, data, text)


def largest_amplitude(history: RunupHistory, steady: Response | None) -> Note:
    """The largest amplitude beside that of the steady response, where there is one."""
    k = int(np.argmax(history.largest))
    size, speed = float(history.largest[k]), float(history.largest_speed[k])
    data = {"amplitude": size, "speed": speed}
    text = f"Largest amplitude {with_unit(size, LENGTH)} at {in_rpm(speed)}"
    highest = None if steady is None else peak(steady.deflection)
    if steady is None or highest is None:
        return Note(RunupCode.PEAK, data, f"{text}.")
    most, at = float(abs(steady.deflection[highest])), float(steady.speed[highest])
    text = f"{text}; in the steady response it is {with_unit(most, LENGTH)} at {in_rpm(at)}."
    return Note(RunupCode.PEAK_STEADY, data | {"steady_amplitude": most, "steady_speed": at}, text)


def _again_and_again(own: Sequence[Transfer]) -> Note:
    """Liquid of one chamber that is caught and falls many times."""
    first, last, caught = own[0], own[-1], sum(each.captured for each in own)
    speeds, heat = [each.speed for each in own], sum(each.lost for each in own)
    chamber, shape = first.chamber + 1, "a ring" if last.captured else "a pool"
    text = (
        f"Chamber {chamber}: its liquid is caught {caught} times and falls {len(own) - caught} times "
        f"from {first.time:.4g} s to {last.time:.4g} s, at {rpm_range(min(speeds), max(speeds))}; then it is "
        f"{shape}. {number(abs(heat))} J {'become heat' if heat >= 0.0 else 'come from the drum'}."
    )
    data = {"chamber": chamber, "time": last.time, "speed": last.speed, "times": len(own), "lost": heat}
    return Note(RunupCode.CAPTURED if last.captured else RunupCode.FALLS_BACK, data, text)


def capture(transfer: Transfer, history: RunupHistory) -> Note:
    """When the liquid of a chamber became a ring, with its band, or fell, and what was handed over."""
    chamber, speed = transfer.chamber + 1, transfer.speed
    data: dict[str, Any] = {
        "chamber": chamber,
        "time": transfer.time,
        "speed": speed,
        "angular_momentum": transfer.angular_momentum,
        "lost": transfer.lost,
    }
    text = (
        f"Chamber {chamber}: its liquid "
        f"{'becomes an annular layer' if transfer.captured else 'falls back into a pool'} at "
        f"{transfer.time:.4g} s, {in_rpm(speed)}"
    )
    first = next((own for own in history.transfers if own.captured and own.chamber == transfer.chamber), None)
    if transfer is first and history.ring_speed is not None:
        low, high = history.ring_speed[transfer.chamber].tolist()
        if in_rpm(low) != in_rpm(high):
            data["ring_speed"] = (low, high)
            text += f" (at {rpm_range(low, high)} with fewer cells or a firmer grip)"
    if history.handover != "riding":
        heat = f"{number(abs(transfer.lost))} J"
        text += f"; {heat} become heat" if transfer.lost >= 0.0 else f"; the drum gives {heat}"
    code = RunupCode.CAPTURED if transfer.captured else RunupCode.FALLS_BACK
    return Note(code, data, f"{text}.")


def not_carried(chamber: int, speed: float, balance: float) -> Note:
    """Liquid of a chamber that its walls never carry round.

    `balance` is the centrifuging speed by a quasi-steady balance, rad/s; inf where nothing drags on it.
    """
    text = f"Chamber {chamber + 1}: no annular layer has formed by {in_rpm(speed)}: "
    if math.isinf(balance):
        text += "without friction nothing carries the liquid round."
    else:
        text += (
            f"held long enough, it forms from about {in_rpm(balance)} on. Baffles or rough walls lower that."
        )
    return Note(RunupCode.NOT_CARRIED, {"chamber": chamber + 1, "balance": balance}, text)


def self_excited_on_the_way(
    bands: tuple[tuple[float, float], ...], friction: Friction, whirl: tuple[float, float] | None
) -> Note:
    """Speeds of self-excited whirl, rad/s.

    `whirl` is the estimated amplitude of the largest, m, and its spin speed, rad/s.
    """
    listed = rpm_bands(bands)
    law = small_whirl_friction(friction)
    text = f"By linear theory with liquid friction {law}, whirl is self-excited at {listed}."
    found: dict[str, Any] = {"bands": bands}
    if whirl is not None:
        size, speed = whirl
        found |= {"amplitude": size, "speed": speed}
        text += (
            f" Given time, it grows to about {with_unit(size, LENGTH)} at {in_rpm(speed)}, the middle of the "
            "band, by an estimate, and may be carried beyond the band; `leblanc map --cycles` solves for it."
        )
    return Note(RunupCode.SELF_EXCITED, found, text)


def programme_notes(
    plan: Programme, history: RunupHistory, drive: Stages, passages: Sequence[Passage]
) -> Iterator[Note]:
    """What was assumed of a spin programme, and which of its steps did not come to their speeds."""
    floor = drive.floor
    if plan.start < floor or bool((history.speed <= floor * (1.0 + 1e-3)).any()):
        slow = f"slower than {in_rpm(floor)}, 0.005 of its highest speed"
        text = f"The programme takes a drum {slow}, as standing."
        yield Note(RunupCode.STANDING, {"floor": floor}, text)
    if plan.coasts and drive.drag_torque == 0.0 and drive.drag_rate == 0.0:
        text = (
            "No drag is given: only the liquid and the supports brake the coasting drum; "
            "programme.drag_torque and programme.drag_rate are those of bearings and belt."
        )
        yield Note(RunupCode.NO_DRAG, {}, text)
    yield from _limited_steps(history, drive)
    for passage in passages:
        step, stage = plan.steps[passage.step - 1], drive.stages[passage.step - 1]
        if step.kind != "coast":
            continue
        stop, reached = drive.target(stage, passage.speed_begin), passage.speed_end
        lasts, data = passage.end - passage.begin, {"step": passage.step}
        if lasts < (stage.duration or 0.0) * (1.0 - _REACHED) and reached > stop * (1.0 + _REACHED):
            when = with_unit(passage.end, TIME)
            text = f"Step {passage.step}: the drum stands at {when}, at once from {in_rpm(reached)}."
            yield Note(RunupCode.STOOD, data | {"time": passage.end, "reached": reached}, text)
        if step.speed is not None and lasts >= plan.coast_limit:
            text = (
                f"Step {passage.step}: the drum coasts for {with_unit(plan.coast_limit, TIME)}, "
                f"programme.coast_limit, down to {in_rpm(reached)} instead of {in_rpm(stop)}."
            )
            yield Note(RunupCode.COAST_NOT_ENDED, data | {"wanted": stop, "reached": reached}, text)


def _limited_steps(history: RunupHistory, drive: Stages) -> Iterator[Note]:
    """Steps in which the motor gave less than was asked."""
    if history.limited is None or history.stage is None:
        return
    length = np.diff(history.time, prepend=0.0)
    for k in np.unique(history.stage[history.limited]).tolist():
        rows, stop = np.flatnonzero(history.limited & (history.stage == k)), drive.stages[k].stop
        speed = history.speed[np.union1d(rows, rows - 1)]
        low, high, time = float(speed.min()), float(speed.max()), float(length[rows].sum())
        last = float(history.speed[history.stage == k][-1])
        missed = stop is not None and last < stop * (1.0 - _REACHED)
        text = (
            f"Step {k + 1} asks for more than the motor gives for {with_unit(time, TIME)}, "
            f"{rpm_range(low, high)}: there the speed follows the motor."
        )
        if stop is not None and missed:
            text += f" It does not come to {in_rpm(stop)}."
        data = {"step": k + 1, "time": time, "low": low, "high": high, "reached": not missed}
        yield Note(RunupCode.MOTOR_LIMITED, data, text)


def unbalance_left(share: float) -> Note:
    """Residual unbalance ratio at the end."""
    text = (
        f"{percent(share)} residual unbalance ratio at the end; the mass of what has left still counts as "
        "the drum's, and what leaves takes its momentum along."
    )
    return Note(RunupCode.UNBALANCE_LEFT, {"share": share}, text)


def out_of_range(code: RunupCode, chamber: int, holds: Flags, limit: float = math.nan) -> Note | None:
    """At what share of the samples the layer of a chamber does not describe its liquid; None if nowhere.

    The code is TOO_SLOW, INNER_WALL, TOO_DEEP or TOO_HIGH; `limit` the depth over radius, or rise
    over depth, that is too much.
    """
    if holds.all():
        return None
    label, high = f"chamber {chamber + 1}", f"higher than {limit:g} of the depth"
    why = {
        RunupCode.TOO_SLOW: f"the liquid in {label} turns too slowly to stand round the wall against gravity",
        RunupCode.INNER_WALL: f"the surface reaches the inner wall of {label}",
        RunupCode.TOO_DEEP: f"the layer in {label} is deeper than {limit:g} of its radius",
        RunupCode.TOO_HIGH: f"the wave in {label} is {high}, beyond linear theory",
    }[code]
    share = float(1.0 - np.mean(holds))
    text = f"Out of range for {_part(share)} of the samples: {why}."
    return Note(code, {"chamber": chamber + 1, "share": share}, text)


def _part(share: float) -> str:
    """A share above nothing in whole per cent."""
    return f"{share:.0%}" if share >= 0.005 else "less than 1%"


def full_gap(chamber: int, full: Flags) -> Note | None:
    """At what share of the samples the layer of a chamber fills its gap; None if nowhere."""
    if not full.any():
        return None
    share = float(np.mean(full))
    text = (
        f"The liquid in chamber {chamber + 1} fills the gap to its inner wall somewhere in {_part(share)} of "
        "the samples: there it is a full pipe under pressure, and air that it shuts in is let out."
    )
    return Note(RunupCode.FULL_GAP, {"chamber": chamber + 1, "share": share}, text)


def of_balls(history: RunupHistory, filled: bool) -> Iterator[Note]:
    """What was assumed of the balls, beside liquid where a chamber is `filled`, and whether they rest."""
    text = (
        "The balls are points: they pass through one another, and are always pressed to their race. Their "
        "drag is that of the scene at any speed."
    )
    yield Note(RunupCode.BALLS_AS_POINTS, {}, text)
    if filled:
        text = "Bands of self-excited whirl are not looked for beside balls; the run itself has such whirls."
        yield Note(RunupCode.WHIRL_BESIDE_BALLS, {}, text)
    speed = float(history.speed[-1])
    behind = float(np.abs(history.ball_speed[-1] - speed).max())
    if behind > BALLS_REST * speed:
        text = (
            f"At the end a ball still runs in its race, by {in_rpm(behind)} at {in_rpm(speed)} of the drum."
        )
        yield Note(RunupCode.BALLS_RUN, {"behind": behind, "speed": speed}, text)


# What these two leave out.
WHIRL_BESIDE_BAFFLES = Note(
    RunupCode.WHIRL_BESIDE_BAFFLES,
    {},
    "Bands of self-excited whirl are not examined here beside baffles: `leblanc run` and `leblanc map` "
    "do; the run itself has such whirls.",
)
LOADS = Note(
    RunupCode.LOADS,
    {},
    f"{STANDS}; liquid that is caught or falls acts as an impulse on the bearings.",
)
