"""Notes of a run-up: the largest amplitude, errors, capture, limits of validity."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from fluid.friction.laws import Friction
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
    from solvers.runup.ensemble import Spread
    from solvers.runup.machine import Transfer
    from solvers.runup.runup import RunupHistory
    from solvers.synchronous.response import Response


SETTLED = 1e-6  # of the largest amplitude: what rounding may change without being spoken of
ERROR = 0.02  # of the largest amplitude: an error estimate to speak of
# Round a wall: on front loaders with 0.2 to 1.4 l in each ring 32 cells change the largest amplitude by up to
# 7 % beside 128 cells, 64 by up to 4 %.
ENOUGH_CELLS = 64


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
    TUMBLES = "tumbles"
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


# What the tables of a report say as well.
IN_TABLES = (
    RunupCode.LIQUID_MODEL,
    RunupCode.ROUGH,
    RunupCode.ENERGY,
    RunupCode.PEAK_STEADY,
    RunupCode.CAPTURED,
    RunupCode.FALLS_BACK,
    RunupCode.SELF_EXCITED,
)


def loads() -> Note:
    """What forces and clearances of a run-up leave out."""
    text = f"{STANDS}; the blow of liquid that is caught or falls is told as an impulse on the bearings."
    return Note(RunupCode.LOADS, {}, text)


def liquid_model(model: str, reason: str) -> Note:
    """Which liquid model the run-up took, and why."""
    return Note(RunupCode.LIQUID_MODEL, {"model": model}, f"Liquid model: {reason}")


def standing(floor: float) -> Note:
    """Below which speed, rad/s, a drum counts as standing."""
    text = f"The programme takes a drum slower than {in_rpm(floor)}, 0.005 of its highest speed, as standing."
    return Note(RunupCode.STANDING, {"floor": floor}, text)


def without_drag() -> Note:
    """A coast without drag."""
    text = (
        "No drag is given: only the liquid and the supports brake the coasting drum; programme.drag_torque "
        "and programme.drag_rate are those of bearings and belt."
    )
    return Note(RunupCode.NO_DRAG, {}, text)


def coast_not_ended(step: int, wanted: float, reached: float, limit: float) -> Note:
    """A coast that its limit of time ended."""
    text = (
        f"Step {step}: the drum coasts for {with_unit(limit, TIME)}, programme.coast_limit, down to "
        f"{in_rpm(reached)} instead of {in_rpm(wanted)}."
    )
    return Note(RunupCode.COAST_NOT_ENDED, {"step": step, "wanted": wanted, "reached": reached}, text)


def stood(step: int, time: float, reached: float) -> Note:
    """A coast that ended with the drum at a stand before its speed was followed down."""
    text = f"Step {step}: the drum stands at {with_unit(time, TIME)}, at once from {in_rpm(reached)}."
    return Note(RunupCode.STOOD, {"step": step, "time": time, "reached": reached}, text)


def motor_limited(step: int, time: float, low: float, high: float, wanted: float | None) -> Note:
    """A step of a programme that asked for more than the motor gives; s, between two speeds, rad/s.

    `wanted` is the speed that was not reached, None where it was.
    """
    text = (
        f"Step {step} asks for more than the motor gives for {with_unit(time, TIME)}, "
        f"{rpm_range(low, high)}: there the speed follows the motor."
    )
    if wanted is not None:
        text += f" It does not come to {in_rpm(wanted)}."
    data = {"step": step, "time": time, "low": low, "high": high, "reached": wanted is None}
    return Note(RunupCode.MOTOR_LIMITED, data, text)


def unbalance_left(share: float) -> Note:
    """How much of the unbalances is left at the end, over what they were at first."""
    text = (
        f"{percent(share)} of the unbalance is left at the end; the mass of what has left still counts as "
        "the drum's, and what leaves takes its momentum along."
    )
    return Note(RunupCode.UNBALANCE_LEFT, {"share": share}, text)


def stopped(reason: str) -> Note:
    """The run did not come to its end."""
    return Note(RunupCode.STOPPED, {}, f"The run stopped: {reason}.")


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
        f"With half the cells the amplitude differs by up to {error:.1%} of its largest: "
        "more cells would sharpen it."
    )
    return Note(RunupCode.ROUGH, {"error": error}, text)


def handover_error(error: float) -> Note | None:
    """What another sensible way of becoming a ring changes; None where it is little, or no liquid does."""
    if not error > ERROR:
        return None
    text = (
        "How liquid becomes a ring is known roughly: if the drum took it along at once, the "
        f"amplitude would differ by up to {error:.1%} of its largest."
    )
    return Note(RunupCode.HANDOVER, {"error": error}, text)


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


def energy_left(closure: float) -> Note | None:
    """What the energy balance leaves over the work; None where that is little."""
    if closure <= CLOSURE:
        return None
    text = f"The energy balance leaves {closure:.1%} of the work unaccounted for."
    return Note(RunupCode.ENERGY, {"closure": closure}, text)


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


def balls_as_points() -> Note:
    """What every motion of balls assumes."""
    text = (
        "The balls are points: they pass through one another, and are always pressed to their race. Their "
        "drag is that of the scene at any speed."
    )
    return Note(RunupCode.BALLS_AS_POINTS, {}, text)


def whirl_beside_balls() -> Note:
    """Whirls that the liquid excites are only in the run itself."""
    text = "Bands of self-excited whirl are not looked for beside balls; the run itself has such whirls."
    return Note(RunupCode.WHIRL_BESIDE_BALLS, {}, text)


def whirl_beside_baffles() -> Note:
    """Bands of whirl are not part of a run-up beside baffles."""
    text = (
        "Bands of self-excited whirl are not examined here beside baffles: `leblanc run` and `leblanc map` "
        "do; the run itself has such whirls."
    )
    return Note(RunupCode.WHIRL_BESIDE_BAFFLES, {}, text)


def not_physical(faults: Sequence[str]) -> Note | None:
    """Violations of the energy balance or of the chamber's walls; None for a sound run."""
    text = f"Not physical: {'; '.join(faults)}."
    return Note(RunupCode.NOT_PHYSICAL, {"faults": list(faults)}, text) if faults else None


def balls_run(behind: float, speed: float) -> Note:
    """Balls that have not come to rest in the drum but pass it at a rate, rad/s."""
    text = f"At the end a ball still runs in its race, by {in_rpm(behind)} at {in_rpm(speed)} of the drum."
    return Note(RunupCode.BALLS_RUN, {"behind": behind, "speed": speed}, text)


FEW = 4  # times that liquid is caught or falls and is told of one by one


def captures(transfers: Sequence[Transfer], handover: str) -> list[Note]:
    """When liquid became rings, or fell: each time, or all at once where it happens again and again."""
    found: list[Note] = []
    for chamber in sorted({transfer.chamber for transfer in transfers}):
        own = [transfer for transfer in transfers if transfer.chamber == chamber]
        found += [capture(each, handover) for each in own] if len(own) <= FEW else [_again_and_again(own)]
    return found


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


def capture(transfer: Transfer, handover: str) -> Note:
    """When the liquid of a chamber became a ring, or fell, and what was handed over."""
    chamber, speed = transfer.chamber + 1, transfer.speed
    data = {
        "chamber": chamber,
        "time": transfer.time,
        "speed": speed,
        "angular_momentum": transfer.angular_momentum,
        "lost": transfer.lost,
    }
    text = (
        f"Chamber {chamber}: its liquid {'is captured' if transfer.captured else 'falls back'} at "
        f"{transfer.time:.4g} s, {in_rpm(speed)}"
    )
    if handover != "riding":
        heat = f"{number(abs(transfer.lost))} J"
        text += f"; {heat} become heat" if transfer.lost >= 0.0 else f"; the drum gives {heat}"
    code = RunupCode.CAPTURED if transfer.captured else RunupCode.FALLS_BACK
    return Note(code, data, f"{text}.")


def not_carried(chamber: int, speed: float, balance: float) -> Note:
    """Liquid of a chamber that its walls never carry round.

    `balance` is the speed at which the walls' drag lifts it to the height of the axis, rad/s; inf where none
    does.
    """
    text = f"Chamber {chamber + 1}: up to {in_rpm(speed)} its walls do not carry the liquid round: "
    if math.isinf(balance):
        text += "without friction nothing does."
    else:
        text += f"their drag beats gravity from {in_rpm(balance)} on. Baffles or rough walls would carry it."
    return Note(RunupCode.NOT_CARRIED, {"chamber": chamber + 1, "balance": balance}, text)


def self_excited_on_the_way(
    bands: tuple[tuple[float, float], ...],
    friction: Friction,
    whirl: tuple[float, float] | None = None,
) -> Note | None:
    """Speeds at which whirl grows by itself, rad/s; None where there are none.

    `whirl` is the estimated amplitude of the largest, m, and its spin speed, rad/s.
    """
    if not bands:
        return None
    listed = rpm_bands(bands)
    law = small_whirl_friction(friction)
    text = f"By linear theory with liquid friction {law}, some whirl grows by itself at {listed}."
    found: dict[str, Any] = {"bands": bands}
    if whirl is not None:
        size, speed = whirl
        found |= {"amplitude": size, "speed": speed}
        text += (
            f" Given time, it grows to about {with_unit(size, LENGTH)} at {in_rpm(speed)}, the middle of the "
            "band, by an estimate, and may be carried beyond the band; `leblanc map --cycles` solves for it."
        )
    return Note(RunupCode.SELF_EXCITED, found, text)


def out_of_range(code: RunupCode, chamber: int, holds: Flags, limit: float = math.nan) -> Note | None:
    """At what share of the samples the layer of a chamber does not describe its liquid; None if nowhere.

    The code is TOO_SLOW, TUMBLES, INNER_WALL, TOO_DEEP or TOO_HIGH; `limit` the depth over radius, or rise
    over depth, that is too much.
    """
    if holds.all():
        return None
    label, high = f"chamber {chamber + 1}", f"higher than {limit:g} of the depth"
    why = {
        RunupCode.TOO_SLOW: f"the liquid in {label} turns too slowly to stand round the wall against gravity",
        RunupCode.TUMBLES: f"the liquid in {label} is on its way over the top, neither pool nor ring",
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


def linear_layers(wave: float, lag: float, touches: bool, error: float, limits: tuple[float, float]) -> str:
    """What a run with linear layers says of its own error, infinite where there is no estimate.

    `wave` is the largest rise over depth, `lag` the largest lag over the spin; `limits` up to which an error
    is estimated.
    """
    size = f"waves reach {percent(wave)} of the depth and the liquid lags by up to {percent(lag)} of the spin"
    if touches:
        return f"{size}, and a surface touches an inner wall, beyond any estimate"
    if math.isfinite(error):
        return f"{size}, an estimated error of {percent(error)} against long waves"
    most = " and ".join(map(percent, limits))
    return f"{size}, beyond the {most} up to which an error is estimated"
