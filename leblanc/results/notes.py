"""Notes: what a result says besides its numbers, as a code, the numbers of the sentence, and the sentence.

One function a sentence: limits of validity and findings of the response, the run-up and the map.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from fluid.friction import Friction
from leblanc.results.base import Note, NoteCode, percent
from leblanc.results.choice import Choice, HeldCost
from leblanc.results.motion.cycles import LargeWhirl
from leblanc.results.motion.held import HELD_MODEL, Held
from leblanc.results.motion.self_excited import SelfExcited
from leblanc.results.response import peak
from leblanc.units import (
    LENGTH,
    RPM,
    TIME,
    VOLUME,
    friction_words,
    in_rpm,
    number,
    rpm_bands,
    rpm_range,
    with_unit,
)
from meshes.arrays import Array, Flags

if TYPE_CHECKING:
    from solvers.runup.ensemble import Spread
    from solvers.runup.runup import RunupHistory
    from solvers.synchronous.response import Response
    from solvers.whirl.edges import Bands


CLOSURE = 1e-3  # of the work: what the energy balance may leave
SETTLED = 1e-6  # of the largest amplitude: what rounding may change without being spoken of
ERROR = 0.02  # of the largest amplitude: an error estimate to speak of


class RunCode(NoteCode):
    """What the notes of a response say."""

    LIQUID_MODEL = "liquid_model"
    TOLERANCE_MISSED = "tolerance_missed"
    NOT_CARRIED = "not_carried"
    SLOW_DISTURBANCES = "slow_disturbances"
    PLANE = "plane"
    AGAINST_SPIN = "against_spin"
    SELF_EXCITED = "self_excited"
    SEVERAL_ANSWERS = "several_answers"
    UNBOUNDED = "unbounded"
    WALL = "wall"
    MESH = "mesh"
    HELD = "held"
    ONE_FAMILY = "one_family"
    NOT_SETTLED = "not_settled"
    LARGE_WHIRL = "large_whirl"


# What a page that shows the table of models says there already.
OF_MODELS = (RunCode.LIQUID_MODEL, RunCode.TOLERANCE_MISSED)


def liquid_models(choice: Choice) -> Note | None:
    """How many speeds each model answers; None where the scene names the model."""
    if choice.cut:
        text = "Liquid model: finite elements for small disturbances; their error is not estimated."
        return Note(RunCode.LIQUID_MODEL, {"fem": choice.models.size}, text)
    if choice.prescribed:
        return None
    exact, held = (int(np.count_nonzero(choice.models == name)) for name in ("statics", HELD_MODEL))
    count, told = choice.models.size, f"; long waves held in time at {held}" if held else ""
    linear = count - exact - held
    text = (
        f"Liquid model: linear theory at {linear} of {count} speeds, where it is within "
        f"{percent(choice.tolerance)}; exact equilibrium at {exact}{told}."
    )
    if held == count:
        text = f"Liquid model: long waves held in time at all {count} speeds."
    data = {"linear": linear, "statics": exact} | ({HELD_MODEL: held} if held else {})
    return Note(RunCode.LIQUID_MODEL, data, text)


def tolerance_missed(choice: Choice, speed: Array, cost: HeldCost | None = None) -> Note | None:
    """Where the estimated error is larger than the tolerance; None where it is nowhere.

    Parameters
    ----------
    choice : the models
    speed : rad/s, shape (n,)
    cost : of holding motions in time
    """
    missed = choice.missed & choice.in_range
    if choice.cut or not missed.any():
        return None
    (first, last), worst = speed[missed][[0, -1]], choice.error[missed].max()
    size = f"up to {percent(worst)}" if np.isfinite(worst) else "without a bound"
    whose = " of the model asked for" if choice.prescribed else ""
    text = (
        f"Between {number(first * RPM)} and {in_rpm(last)} the estimated error{whose} is {size}, more than "
        f"the tolerance of {percent(choice.tolerance)}."
    )
    data = {"first": first, "last": last, "error": worst}
    if cost is not None and not cost.asked:
        text += f' [model] held = "auto" holds {cost.speeds} speeds in time, for {cost.words}.'
        data |= {"held_speeds": cost.speeds, "held_seconds": cost.seconds}
    return Note(RunCode.TOLERANCE_MISSED, data, text)


def not_carried(below: float) -> Note:
    """Gravity across the axis holds the liquid back.

    Parameters
    ----------
    below : speed above which the liquid rides with the drum, rad/s
    """
    text = (
        f"Below {in_rpm(below)} gravity across the axis keeps the liquid from riding with the drum: "
        "out of range."
    )
    return Note(RunCode.NOT_CARRIED, {"below": below}, text)


def slow_disturbances(held: Held | None = None) -> Note | None:
    """What the stability of branches of a planar rotor means; None where all motions have shown their own.

    Parameters
    ----------
    held : motions held in time, which have shown whether they are stable
    """
    if held is not None and held.at.all():
        return None
    where = "Branches" if held is None else "Where no motion was held in time branches"
    text = f"{where} are judged against slow disturbances, the liquid always in equilibrium."
    return Note(RunCode.SLOW_DISTURBANCES, {}, text)


def held_motions(held: Held, speed: Array) -> list[Note]:
    """How many motions were held in time, how well, and what they came to.

    Parameters
    ----------
    held : the motions
    speed : rad/s, shape (n,)
    """
    count, cycles, apart = (int(np.count_nonzero(x)) for x in (held.at, held.limit_cycle, held.hysteresis))
    error = held.error[held.at]
    worst = float(error[~np.isnan(error)].max(initial=0.0))
    size = f"estimated error at most {percent(worst)}" if not np.isnan(error).all() else "error not estimated"
    text = (
        f"Rotor and long waves held in time at {count} of {speed.size} speeds, {held.cells} cells round each "
        f"wall, {size}."
    )
    if cycles:
        text += f" Limit cycles at {cycles}, {_between(speed[held.limit_cycle])}."
    if apart:
        text += (
            f" Up and down differ at {apart}, {_between(speed[held.hysteresis])}: amplitudes are those while "
            "the speed rises."
        )
    data = {"held": count, "cells": held.cells, "error": worst, "limit_cycles": cycles, "hysteresis": apart}
    found, lost = [Note(RunCode.HELD, data, text)], held.not_settled
    if lost.any():
        why = held.reason[lost][0] if held.reason.size else ""
        text = (
            f"At {np.count_nonzero(lost)} of the speeds held the motion has not settled, "
            f"{_between(speed[lost])}{f': {why}' if why else ''}. Do not rely on the numbers there."
        )
        found.append(Note(RunCode.NOT_SETTLED, {"speed": tuple(speed[lost].tolist())}, text))
    return found


def _between(speed: Array) -> str:
    """First and last of some speeds."""
    low, high = float(speed.min()), float(speed.max())
    return f"at {in_rpm(low)}" if low == high else f"between {number(low * RPM)} and {in_rpm(high)}"


def one_family(answer: Response) -> Note | None:
    """What it means that one family of waves answers alone; None where other models do.

    Parameters
    ----------
    answer : of the machine
    """
    alone = answer.model == "kdv"
    if not alone.any():
        return None
    text = (
        "Liquid model: one family of waves alone. Liquid that goes with the drum is held by both families, "
        "so that this is out of range at every speed; the estimated error is the distance from the exact "
        "equilibrium."
    )
    lost = alone & ~answer.converged & np.isfinite(answer.deflection)
    if lost.any():
        text += (
            f" At {np.count_nonzero(lost)} of {lost.size} speeds, {_between(answer.speed[lost])}, it has no "
            "wave that leaves the wall wet. Do not rely on the numbers there."
        )
    return Note(RunCode.ONE_FAMILY, {"lost": tuple(answer.speed[lost].tolist())}, text)


def plane_words(position: float, chambers: bool) -> str:
    """Plane of an amplitude, as it stands wherever one is shown.

    Parameters
    ----------
    position : of the plane along the axis, m
    chambers : the plane is that of the first chamber; else the one to which positions count
    """
    place = "of chamber 1" if chambers else "of the origin"
    return f"in the plane {place} at {with_unit(position, LENGTH)}"


def plane_label(chambers: bool) -> str:
    """The same for the label of an axis, where there is little room.

    Parameters
    ----------
    chambers : as for `plane_words`
    """
    return " at chamber 1" if chambers else " at the origin"


def plane(position: float, zero: str, chambers: bool, held: bool = False) -> Note:
    """Where the motion of a rotor that tilts is measured.

    Parameters
    ----------
    position : of the plane, m
    zero : what angles count from
    chambers : the plane is that of the first chamber
    held : some motions are held in time
    """
    start = "the unbalance" if zero == "unbalance" else zero
    turns = ", of motions held in time as a mean over the turns" if held else ""
    text = (
        f"Amplitude: largest radius of the orbit {plane_words(position, chambers)}{turns}. "
        f"Angles: of its part that turns with the spin, from {start}."
    )
    return Note(RunCode.PLANE, {"position": position}, text)


def against_spin(share: float, speed: float, held: Held | None = None) -> Note:
    """How far the orbit is from a circle.

    Parameters
    ----------
    share : of the orbit that goes against the spin, at most
    speed : where it does, rad/s
    held : motions held in time, in which the long waves answer that part as well
    """
    by = "the liquid answers that part by linear theory"
    if held is not None:
        rest = f"; elsewhere {by}" if not held.at.all() else ""
        by = f"where motions were held in time the long waves answer that part as well{rest}"
    text = f"Up to {share:.2g} of the orbit goes against the spin, at {in_rpm(speed)}; {by}."
    return Note(RunCode.AGAINST_SPIN, {"share": share, "speed": speed}, text)


def self_excited(whirl: SelfExcited) -> Note:
    """Whether a whirl grows by itself, where, and how fast at most."""
    theory = f"linear theory of an even layer, liquid friction: {whirl.friction}"
    data: dict[str, object] = {"bands": whirl.bands, "not_known": whirl.not_known}
    lost, unknown = int(np.count_nonzero(np.isnan(whirl.growth))), ""
    if lost:
        between = ", ".join(rpm_range(low, high) for low, high in whirl.not_known)
        where = f", from {between}" if between else ""
        unknown = f" Not known at {lost} of {whirl.growth.size} speeds{where}: do not take it for stable."
    if not whirl.bands:
        elsewhere = "at the other speeds" if lost else "at these speeds"
        text = f"No whirl grows by itself {elsewhere} ({theory}).{unknown}"
        if lost == whirl.growth.size:
            text = f"Whether a whirl grows by itself is not known ({theory}): do not take it for stable."
        return Note(RunCode.SELF_EXCITED, data, text)
    listed = ", ".join(rpm_range(low, high) for low, high in whirl.bands)
    most, fastest = int(np.nanargmax(whirl.growth)), ""
    if whirl.growth[most] > 0.0:
        growth, turning = float(whirl.growth[most]), float(whirl.whirl_speed[most])
        data |= {"growth": growth, "whirl_speed": turning}
        fastest = f", fastest at {growth:.3g} 1/s, whirling at {in_rpm(turning)}"
    text = f"A whirl grows by itself from {listed}{fastest}: unstable there ({theory}).{unknown}"
    return Note(RunCode.SELF_EXCITED, data, text)


def large_whirl(large: LargeWhirl, speed: Array) -> Note | None:
    """How large the self-excited whirl on top of the response becomes; None where there is none.

    Parameters
    ----------
    large : the whirls
    speed : of the scene, rad/s, shape (n,)
    """
    if not np.nanmax(large.amplitude, initial=0.0) > 0.0:
        return None
    most = int(np.nanargmax(large.amplitude))
    size, turning = float(large.amplitude[most]), float(large.whirl_speed[most])
    data: dict[str, object] = {"amplitude": size, "speed": float(speed[most]), "whirl_speed": turning}
    kicked = ""
    if large.kicked.any():
        ends = np.flatnonzero(np.diff(np.concatenate([[False], large.kicked, [False]]).astype(int)))
        spans = [(float(speed[k]), float(speed[m - 1])) for k, m in ends.reshape(-1, 2).tolist()]
        data["kicked"] = spans
        kicked = f" Where no small one grows, {rpm_bands(spans)}, a kick starts it or a run-up carries it."
    text = (
        f"Self-excited whirl on top of the response to the unbalance becomes up to {with_unit(size, LENGTH)} "
        f"large, at {in_rpm(speed[most])}, going round at {in_rpm(turning)}. The amplitude beats between the "
        "difference of both and their sum as long as the unbalance moves the axis little beside the depth of "
        f"the layer; a larger one feeds or quenches the whirl.{kicked}"
    )
    return Note(RunCode.LARGE_WHIRL, data, text)


def several_answers(first: float, last: float, stable: bool) -> Note:
    """More than one deflection satisfies the balance.

    Parameters
    ----------
    first, last : speeds between which they do, rad/s
    stable : the largest stable one is reported; else the largest
    """
    which = "largest stable one" if stable else "largest"
    text = (
        f"Several deflections satisfy the balance between {number(first * RPM)} and {in_rpm(last)}; "
        f"reported is the {which}, where a slow run-up arrives."
    )
    return Note(RunCode.SEVERAL_ANSWERS, {"first": first, "last": last}, text)


def unbounded(wet: float | None, dry: float | None) -> Note:
    """The amplitude has no bound at a speed within the range.

    Parameters
    ----------
    wet, dry : speeds with and without liquid, rad/s; None where it has one everywhere
    """
    found = [(name, speed) for name, speed in (("with", wet), ("without", dry)) if speed is not None]
    where = " and ".join(f"{name} liquid at {speed * RPM:.4g} rpm" for name, speed in found)
    text = f"Nothing damps the resonance {where}: the amplitude has no bound there."
    return Note(RunCode.UNBOUNDED, {"speed": wet, "speed_dry": dry}, text)


def wall(chamber: int, speed: float, volume: float, enough: float, deflection: float) -> Note:
    """How much liquid just covers the wall of a chamber.

    Parameters
    ----------
    chamber : its number, from 0
    speed : rad/s
    volume, enough : of the liquid, and what just covers the wall, m^3
    deflection : of the axis there, m
    """
    has = "wet all round" if volume > enough else "dry in part"
    text = (
        f"Chamber {chamber + 1} at {in_rpm(speed)}: wall {has} with {with_unit(volume, VOLUME)}; "
        f"{with_unit(enough, VOLUME)} just cover it, deflection {with_unit(deflection, LENGTH)}."
    )
    data = {"chamber": chamber, "speed": speed, "volume": volume, "enough": enough, "deflection": deflection}
    return Note(RunCode.WALL, data, text)


def mesh(chamber: int, finding: str) -> Note:
    """Faults of the mesh of a chamber's section.

    Parameters
    ----------
    chamber : its number, from 0
    finding : in words
    """
    return Note(RunCode.MESH, {"chamber": chamber}, f"Mesh of chamber {chamber + 1}: {finding}.")


class DoubtCode(NoteCode):
    """What a value of a scene is that is allowed but hardly meant."""

    SIZE = "doubtful_size"
    FILM = "doubtful_film"
    LIQUID = "doubtful_liquid"
    LIQUID_MASS = "doubtful_liquid_mass"
    DAMPING = "doubtful_damping"
    UNBALANCE = "doubtful_unbalance"
    PLACE = "doubtful_place"
    FREE = "free_direction"
    GRAVITY = "doubtful_gravity"
    SPEED = "doubtful_speed"


def doubt(code: DoubtCode, field: str, looks: str, likely: str) -> Note:
    """A value that is hardly meant.

    Parameters
    ----------
    code : what it is
    field : its path in the scene
    looks : what makes it doubtful
    likely : what may have been meant, as it would be written; empty where nothing suggests itself
    """
    meant = f"; did you mean {likely}?" if likely else ""
    return Note(
        code, {"field": field, "likely": likely}, f"Check {field}: {looks}{meant}{'' if meant else '.'}"
    )


class RunupCode(NoteCode):
    """What the notes of a run-up say."""

    LIQUID_MODEL = "liquid_model"
    STOPPED = "stopped"
    ERROR_UNKNOWN = "error_unknown"
    ROUGH = "rough"
    ROUNDING = "rounding"
    ENERGY = "energy"
    PEAK = "peak"
    PEAK_STEADY = "peak_steady"
    CAPTURED = "captured"
    FALLS_BACK = "falls_back"
    SELF_EXCITED = "self_excited"
    TOO_SLOW = "too_slow"
    INNER_WALL = "inner_wall"
    TOO_DEEP = "too_deep"
    TOO_HIGH = "too_high"


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


def liquid_model(model: str, reason: str) -> Note:
    """Which liquid model the run-up took, and why."""
    return Note(RunupCode.LIQUID_MODEL, {"model": model}, f"Liquid model: {reason}")


def stopped(reason: str) -> Note:
    """The run did not come to its end."""
    return Note(RunupCode.STOPPED, {}, f"The run stopped: {reason}.")


def numerical_error(error: float) -> Note | None:
    """Error of the amplitude over its largest; None where it is small."""
    if math.isnan(error):
        return Note(RunupCode.ERROR_UNKNOWN, {}, "The error of the amplitude was not estimated.")
    if error <= ERROR:
        return None
    text = (
        f"With half the cells the amplitude differs by up to {error:.1%} of its largest: "
        "more cells would sharpen it."
    )
    return Note(RunupCode.ROUGH, {"error": error}, text)


def rounding(spread: Spread, history: RunupHistory) -> Note:
    """What rounding alone does to a run-up, beside its error estimate.

    Parameters
    ----------
    spread : over the ensemble
    history : of the unchanged run
    """
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


def capture(chamber: int, captured: bool, time: float, speed: float) -> Note:
    """When the liquid of a chamber, counted from 0, began or ceased to ride with the drum."""
    text = (
        f"Chamber {chamber + 1}: its liquid {'is captured' if captured else 'falls back'} at "
        f"{time:.4g} s, {in_rpm(speed)}."
    )
    code = RunupCode.CAPTURED if captured else RunupCode.FALLS_BACK
    return Note(code, {"chamber": chamber + 1, "time": time, "speed": speed}, text)


def self_excited_on_the_way(
    bands: tuple[tuple[float, float], ...],
    friction: Friction,
    whirl: tuple[float, float] | None = None,
) -> Note | None:
    """Speeds at which whirl grows by itself, rad/s; None where there are none.

    Parameters
    ----------
    bands : of those speeds, rad/s
    friction : of the liquid
    whirl : estimated amplitude of the largest of them, m, and its spin speed, rad/s
    """
    if not bands:
        return None
    listed = rpm_bands(bands)
    law = friction_words(friction)
    text = f"By linear theory with liquid friction {law}, some whirl grows by itself at {listed}."
    found: dict[str, Any] = {"bands": bands}
    if whirl is not None:
        size, speed = whirl
        found |= {"amplitude": size, "speed": speed}
        text += (
            f" Given time, it grows to about {with_unit(size, LENGTH)} at {in_rpm(speed)} by an estimate, "
            "and may be carried beyond the band; `leblanc map --cycles` solves for it."
        )
    return Note(RunupCode.SELF_EXCITED, found, text)


def out_of_range(code: RunupCode, chamber: int, holds: Flags, limit: float = math.nan) -> Note | None:
    """At what share of the samples the layer of a chamber does not describe its liquid; None if nowhere.

    Parameters
    ----------
    code : TOO_SLOW, INNER_WALL, TOO_DEEP or TOO_HIGH
    chamber : index from 0
    holds : where the layer describes the liquid, shape (k,)
    limit : depth over radius, or rise over depth, that is too much
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
    text = f"Out of range for {1.0 - np.mean(holds):.0%} of the samples: {why}."
    return Note(code, {"chamber": chamber + 1, "share": share}, text)


def linear_layers(wave: float, lag: float, touches: bool, error: float, limits: tuple[float, float]) -> str:
    """What a run with linear layers says of its own error.

    Parameters
    ----------
    wave, lag : rise of the surface over the depth; lag of the liquid over the spin; largest each
    touches : a surface comes to an inner wall
    error : estimated from them; infinite where there is none
    limits : of wave and lag up to which an error is estimated
    """
    size = f"waves reach {percent(wave)} of the depth and the liquid lags by up to {percent(lag)} of the spin"
    if touches:
        return f"{size}, and a surface touches an inner wall, beyond any estimate"
    if math.isfinite(error):
        return f"{size}, an estimated error of {percent(error)} against long waves"
    most = " and ".join(map(percent, limits))
    return f"{size}, beyond the {most} up to which an error is estimated"


class MapCode(NoteCode):
    """What the notes of a map say."""

    OWN_VOLUME = "own_volume"
    QUADRATIC = "quadratic"
    WITHOUT_FRICTION = "without_friction"
    COMMON_FACTOR = "common_factor"
    NOT_HELD = "not_held"
    THICK_WALL_LAYER = "thick_wall_layer"
    NOT_KNOWN = "not_known"
    NO_CYCLES = "no_cycles"
    CYCLES_MISSING = "cycles_missing"
    NO_CIRCLE = "no_circle"
    LAGGING = "lagging"
    DEEP_WHIRL = "deep_whirl"


def no_cycles(reason: str) -> Note:
    """Why no limit cycle is told.

    Parameters
    ----------
    reason : in words
    """
    return Note(MapCode.NO_CYCLES, {"reason": reason}, f"No limit cycles: {reason}.")


def cycles_missing(reason: str) -> Note:
    """Which limit cycles may be missing among those told.

    Parameters
    ----------
    reason : in words
    """
    return Note(MapCode.CYCLES_MISSING, {"reason": reason}, f"Limit cycles may be missing: {reason}.")


def no_circle() -> Note:
    """Gravity across the axis is left out of limit cycles."""
    text = (
        "Limit cycles are those without gravity across the axis, with which a whirl is no circle: ask for a "
        "held state of `run` where the spin hardly outweighs it."
    )
    return Note(MapCode.NO_CIRCLE, {}, text)


def lagging(largest: float, limit: float) -> Note:
    """Limit cycles whose liquid lags more than the layer's flow describes.

    Parameters
    ----------
    largest : lag over the spin
    limit : of it
    """
    text = (
        f"Limit cycles in which the liquid lags by more than {percent(limit)} of the spin (up to "
        f"{percent(largest)}) are the model's own: its flow has no vorticity."
    )
    return Note(MapCode.LAGGING, {"largest": largest, "limit": limit}, text)


def deep_whirl(largest: float) -> Note:
    """Limit cycles about as large as the layer is deep.

    Parameters
    ----------
    largest : amplitude over depth
    """
    text = f"The largest limit cycle is {largest:.2g} times the depth of the layer: walls fall nearly dry."
    return Note(MapCode.DEEP_WHIRL, {"largest": largest}, text)


def growth_not_known(lost: int, points: int) -> Note:
    """Points at which the modes were not found.

    Parameters
    ----------
    lost, points : how many, of how many
    """
    text = f"At {lost} of {points} points the growth is not known: crosses; do not take them for stable."
    return Note(MapCode.NOT_KNOWN, {"lost": lost, "points": points}, text)


def own_volume(volume: float, bands: Bands) -> Note:
    """Where a whirl grows with the volume of the scene.

    Parameters
    ----------
    volume : of liquid in all chambers, m^3
    bands : of speed, rad/s
    """
    with_it = f"With the scene's {with_unit(volume, VOLUME)}"
    text = f"{with_it} no whirl grows by itself at these speeds."
    if bands:
        listed = rpm_bands(bands)
        text = f"{with_it} a whirl grows by itself from {listed}."
    return Note(MapCode.OWN_VOLUME, {"volume": volume, "bands": tuple(bands)}, text)


def quadratic() -> Note:
    """Quadratic friction does nothing to a small whirl."""
    text = "Quadratic friction vanishes for small motions: the map is that without it. It bounds what grows."
    return Note(MapCode.QUADRATIC, {}, text)


def without_friction() -> Note:
    """The damping of the support alone makes a wave grow."""
    text = (
        "Without liquid friction the support's damping feeds the wave against the spin, whose energy is "
        "negative: a weak growth remains at almost every speed."
    )
    return Note(MapCode.WITHOUT_FRICTION, {}, text)


def common_factor() -> Note:
    """How the volumes of several chambers grow."""
    text = "The volumes of the chambers grow by a common factor until the first is full."
    return Note(MapCode.COMMON_FACTOR, {}, text)


def not_held(share: float, horizontal: bool) -> Note:
    """Points at which the liquid does not lie all round its wall.

    Parameters
    ----------
    share : of the points
    horizontal : the axis lies
    """
    why = "a paraboloid leaves part of a wall dry or reaches an inner wall"
    if horizontal:
        why = "gravity across the axis outweighs the spin"
    text = f"At {100.0 * share:.2g} % of the points {why}: out of range."
    return Note(MapCode.NOT_HELD, {"share": share}, text)


def thick_wall_layer(share: float, limit: float) -> Note:
    """Points at which the laminar layer is thicker than its law allows.

    Parameters
    ----------
    share : of the points
    limit : thickness over the liquid's depth
    """
    text = (
        f"At {100.0 * share:.2g} % of the points the laminar layer at the wall is thicker than {limit:g} of "
        "the liquid's depth: out of range."
    )
    return Note(MapCode.THICK_WALL_LAYER, {"share": share, "limit": limit}, text)
