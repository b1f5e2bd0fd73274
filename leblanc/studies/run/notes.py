"""Notes of the response over speed: models and their limits, held motions, walls, meshes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from leblanc.core.notes import Note, NoteCode, percent
from leblanc.core.units import (
    LENGTH,
    RPM,
    VOLUME,
    in_rpm,
    number,
    over_rpm,
    rpm_bands,
    rpm_range,
    with_unit,
)
from leblanc.liquid.choice import HELD_MODELS, Choice, HeldCost
from leblanc.studies.cycles.answer import LargeWhirl
from leblanc.studies.held.answer import Held
from leblanc.studies.loads.answer import BearingLife
from leblanc.studies.run.motion import SelfExcited
from meshes.arrays import Array

if TYPE_CHECKING:
    from solvers.statics.hydrostatics import WallVolumes
    from solvers.synchronous.response import Response


class RunCode(NoteCode):
    """What the notes of a response say."""

    LIQUID_MODEL = "liquid_model"
    TOLERANCE_MISSED = "tolerance_missed"
    NOT_CARRIED = "not_carried"
    LEFT_OUT = "left_out"
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
    ENERGY = "energy"
    LARGE_WHIRL = "large_whirl"
    THICK_WALL_LAYER = "thick_wall_layer"
    UNBALANCE_LEAVES = "unbalance_leaves"
    LOADS = "loads"
    SKIDS = "skids"


_SAME = 1e-6  # relative, up to which two volumes are one
CLOSURE = 1e-3  # of the work: what the energy balance may leave
# What a page that shows the table of models says there already.
OF_MODELS = (RunCode.LIQUID_MODEL, RunCode.TOLERANCE_MISSED)


def liquid_models(choice: Choice) -> Note | None:
    """How many speeds each model answers; None where the scene names the model."""
    if choice.cut:
        name = str(choice.models[0])
        if name not in ("linear", "fem"):
            return None
        way = "finite elements" if name == "fem" else "linear theory of each compartment"
        text = f"Liquid model: {way} for small disturbances; their error is not estimated."
        return Note(RunCode.LIQUID_MODEL, {name: choice.models.size}, text)
    if choice.prescribed:
        return None
    held_model = choice.held_model
    exact, held = (int(np.count_nonzero(choice.models == name)) for name in ("statics", held_model))
    count, told = choice.models.size, f"; long waves integrated in time at {held}" if held else ""
    linear = count - exact - held
    text = (
        f"Liquid model: linear theory at {linear} of {count} speeds, where it is within "
        f"{percent(choice.tolerance)}; exact equilibrium at {exact}{told}."
    )
    if held == count:
        text = f"Liquid model: long waves integrated in time at all {count} speeds."
    data = {"linear": linear, "statics": exact} | ({held_model: held} if held else {})
    return Note(RunCode.LIQUID_MODEL, data, text)


def unbalance_leaves(left: float) -> Note:
    """A steady answer has all of the unbalance, though some leaves with time; `left` is the last share."""
    text = (
        "A part of the unbalance leaves with time; the steady answer has all of it, and the drum its whole "
        f"mass, as at the start. Residual unbalance ratio at the end: {percent(left)}."
    )
    return Note(RunCode.UNBALANCE_LEAVES, {"left": left}, text)


def tolerance_missed(choice: Choice, speed: Array, cost: HeldCost | None = None) -> Note | None:
    """Where the estimated error is larger than the tolerance; None where it is nowhere."""
    missed = choice.missed & choice.in_range
    if choice.cut or not missed.any():
        return None
    (first, last), worst = speed[missed][[0, -1]], choice.error[missed].max()
    size = f"up to {percent(worst)}" if np.isfinite(worst) else "without a bound"
    whose = " of the model asked for" if choice.prescribed else ""
    where = over_rpm(first, last, "between", "and").capitalize()
    limit = percent(choice.tolerance)
    text = f"{where} the estimated error{whose} is {size}, more than the tolerance of {limit}."
    data = {"first": first, "last": last, "error": worst}
    if cost is not None and not cost.asked:
        text += f' [model] held = "auto" holds {cost.speeds} speeds in time, for {cost.words}.'
        data |= {"held_speeds": cost.speeds, "held_seconds": cost.seconds}
    return Note(RunCode.TOLERANCE_MISSED, data, text)


def not_carried(stands: float, carried: float | None = None) -> Note:
    """Gravity across the axis holds the liquid back; speeds in rad/s.

    An annular layer exists above `stands`; from `carried` on the walls drag the liquid round from rest, inf
    where nothing drags on it, None where that is not known.
    """
    data: dict[str, Any] = {"below": stands}
    text = (
        f"An annular layer exists from {in_rpm(stands)} on: below, gravity across the axis keeps the "
        "liquid from riding with the drum: out of range, and it does not count."
    )
    if carried is not None:
        data["carried_from"] = carried if math.isfinite(carried) else None
        text += f" {carried_words(stands, carried)}"
    return Note(RunCode.NOT_CARRIED, data, text)


def carried_words(stands: float, carried: float) -> str:
    """From where on a ring forms from rest, in a sentence; as for `not_carried`."""
    if math.isinf(carried):
        return "From rest it never forms: no friction acts on the liquid."
    if carried <= stands:
        return "From rest it forms from there on too."
    return (
        f"From rest it forms from about {in_rpm(carried)} on, by a balance (slow run-ups: 0.6 to 1.6 times "
        "that): between the two an answer holds for a ring that stands already, as on the way down."
    )


def left_out(curve: Response, stands: float | None) -> Note | None:
    """Speeds that do not count for the largest amplitude; None where all or none of them do.

    Smaller amplitudes without an annular layer are not worth it: `not_carried` has them.
    """
    out = ~curve.holds & ~np.isnan(curve.amplitude)
    if not out.any() or not curve.holds.any() or curve.top is None:
        return None
    below = curve.speed <= (-1.0 if stands is None else stands)
    lost = ~curve.converged & ~below
    reasons = {
        "no annular layer exists": out & below,
        "no converged answer was found": out & lost,
        "the liquid model is out of range": out & ~below & ~lost,
    }
    parts, spans = [], []
    for why, rows in reasons.items():
        # Neighbours of one kind are one range.
        ends = np.flatnonzero(np.diff(np.concatenate([[False], rows, [False]]).astype(int))).reshape(-1, 2)
        own = [(float(curve.speed[a]), float(curve.speed[b - 1])) for a, b in ends.tolist()]
        if own:
            parts.append(f"{rpm_bands(own)}, where {why}")
            spans += own
    most = float(curve.amplitude[out].max())
    if most <= curve.peak.amplitude and not np.any(out & ~below):
        return None
    text = f"The largest amplitude leaves out {'; '.join(parts)} (up to {with_unit(most, LENGTH)} there)."
    beside = bool(out[max(curve.top - 1, 0)] or out[min(curve.top + 1, out.size - 1)])
    if beside:
        text += " It lies at the edge of what is left out: beyond, the amplitude may be larger."
    data = {"spans": tuple(spans), "amplitude": most, "at_edge": beside}
    return Note(RunCode.LEFT_OUT, data, text)


def slow_disturbances(held: Held | None = None) -> Note | None:
    """What the stability of branches of a planar rotor means; None where all motions have shown their own."""
    if held is not None and held.at.all():
        return None
    where = "Branches" if held is None else "Where no motion was integrated in time branches"
    text = f"{where} are evaluated against slow disturbances, the liquid always in equilibrium."
    return Note(RunCode.SLOW_DISTURBANCES, {}, text)


def skids(bearing: str, speed: float, life: BearingLife, k: int) -> Note | None:
    """A bearing that carries less at the last speed than its balls need to roll; None where it does not."""
    load, dry, least, slip = (
        float(each[k, -1]) for each in (life.load, life.load_dry, life.least_load, life.slip)
    )
    if not slip > 0.0:
        return None
    before = float(life.slip_dry[k, -1])
    bare = percent(before) if before > 0.0 else "none"
    text = (
        f"{bearing.capitalize()} carries {number(load)} N at {in_rpm(speed)}. Its balls roll with "
        f"{number(least)} N, 0.01 of its rating: its cage slips by about {percent(slip)}, and wear comes "
        f"before fatigue. Without liquid it carries {number(dry)} N, slip {bare}: the better the balance, "
        "the less the load. A preload or a bearing of a lighter series mends it."
    )
    data = {"bearing": k, "load": load, "load_dry": dry, "least": least, "slip": slip}
    return Note(RunCode.SKIDS, data, text)


STANDS = "Forces on the floor take the cabinet as rigid and standing still on feet that do not pull"


def loads(obstructed: bool = False) -> Note:
    """What forces and clearances leave out."""
    without = "; what rings past baffles and liquid in sections of its own lose is not in the motor's torque"
    return Note(RunCode.LOADS, {"obstructed": obstructed}, f"{STANDS}{without if obstructed else ''}.")


def held_motions(held: Held, speed: Array) -> list[Note]:
    """Number of time-domain states, their error, and their kinds."""
    count, cycles, apart = (int(np.count_nonzero(x)) for x in (held.at, held.limit_cycle, held.hysteresis))
    error, (waves, parts) = held.error[held.at], HELD_MODELS[held.model]
    worst = float(error[~np.isnan(error)].max(initial=0.0))
    size = f"estimated error at most {percent(worst)}" if not np.isnan(error).all() else "error not estimated"
    text = (
        f"Rotor and {waves} integrated in time at {count} of {speed.size} speeds, {held.cells} {parts} "
        f"round each "
        f"wall, {size}. Their largest amplitude is one of the speeds held, among them the peaks of the "
        "steady answer and without liquid."
    )
    if held.model == "potential":
        text += (
            " Friction of the walls is a small force on all the liquid, which damps waves as they do: "
            "nothing lags."
        )
    if held.model == "kdv_held":
        text += (
            " They hold next to a natural wave while the wall stays wet: with linear friction whirls are 1 "
            "to 6 % off those of long waves (`leblanc validate kdv`). Their energy is not balanced."
        )
    if cycles:
        text += f" Limit cycles at {cycles}, {_between(speed[held.limit_cycle])}{_waves_words(held)}."
    if apart:
        text += (
            f" Up and down differ at {apart}, {_between(speed[held.hysteresis])}: amplitudes are those while "
            "the speed rises."
        )
    data = {"held": count, "cells": held.cells, "error": worst, "limit_cycles": cycles, "hysteresis": apart,
        "wave_error": float(held.wave_error[np.isfinite(held.wave_error)].max(initial=0.0)),
        "waves_not_known": int(np.count_nonzero(held.waves_not_known)),
    }  # fmt: skip
    found, lost = [Note(RunCode.HELD, data, text)], held.not_settled
    if lost.any():
        why = held.reason[lost][0] if held.reason.size else ""
        text = (
            f"At {np.count_nonzero(lost)} of the speeds held the motion has not converged in time, "
            f"{_between(speed[lost])}{f': {why}' if why else ''}. Do not rely on the numbers there."
        )
        found.append(Note(RunCode.NOT_SETTLED, {"speed": tuple(speed[lost].tolist())}, text))
    left = float(held.energy_error[~np.isnan(held.energy_error)].max(initial=0.0))
    if left > CLOSURE:
        text = f"The energy balance of the motions held leaves up to {left:.1%} of the work unaccounted for."
        found.append(Note(RunCode.ENERGY, {"energy_error": left}, text))
    return found


def _waves_words(held: Held) -> str:
    """How far long waves are off at the whirls of limit cycles, as the end of a sentence."""
    known = held.wave_error[np.isfinite(held.wave_error)]
    lost = int(np.count_nonzero(held.waves_not_known))
    told = f"; long waves are off by up to {percent(float(known.max()))} there" if known.size else ""
    if not lost:
        return told
    where = f"at {lost} of them" if known.size else "there"
    why = "no smooth wave follows a whirl as large, or baffles stand in the liquid"
    return f"{told}; how far long waves are off is not known {where}: {why}"


def _between(speed: Array) -> str:
    """First and last of some speeds."""
    return over_rpm(float(speed.min()), float(speed.max()), "between", "and")


def one_family(answer: Response) -> Note | None:
    """Meaning of an answer by unidirectional waves alone; None where other models answer."""
    alone = answer.model == "kdv"
    if not alone.any():
        return None
    text = (
        "Liquid model: unidirectional waves alone. Liquid that goes with the drum is held by both families, "
        "so that this is out of range at every speed; the estimated error is the distance from the exact "
        "equilibrium. They hold next to a natural wave: in self-excited whirls (`--cycles`) and in `leblanc "
        "layer`."
    )
    lost = alone & ~answer.converged & np.isfinite(answer.deflection)
    if lost.any():
        text += (
            f" At {np.count_nonzero(lost)} of {lost.size} speeds, {_between(answer.speed[lost])}, it has no "
            "wave that leaves the wall wet. Do not rely on the numbers there."
        )
    return Note(RunCode.ONE_FAMILY, {"lost": tuple(answer.speed[lost].tolist())}, text)


def plane_words(position: float, chambers: bool) -> str:
    """Plane of an amplitude, as it stands wherever one is shown."""
    place = "of chamber 1" if chambers else "of the origin"
    return f"in the plane {place} at {with_unit(position, LENGTH)}"


def plane_label(chambers: bool) -> str:
    """The same for the label of an axis, where there is little room."""
    return " at chamber 1" if chambers else " at the origin"


def plane(position: float, zero: str, chambers: bool, held: bool = False) -> Note:
    """Where the motion of a rotor that tilts is measured."""
    start = "the unbalance" if zero == "unbalance" else zero
    turns = ", of time-domain states as a mean over the turns" if held else ""
    text = (
        f"Amplitude: largest radius of the orbit {plane_words(position, chambers)}{turns}. "
        f"Angles: of its part that turns with the spin, from {start}."
    )
    return Note(RunCode.PLANE, {"position": position}, text)


def against_spin(share: float, speed: float, held: Held | None = None) -> Note:
    """How far the orbit is from a circle."""
    by = "the liquid answers that part by linear theory"
    if held is not None:
        rest = f"; elsewhere {by}" if not held.at.all() else ""
        by = (
            f"where motions were integrated in time the {HELD_MODELS[held.model][0]} answer that part as "
            f"well{rest}"
        )
    text = f"Up to {share:.2g} of the orbit goes against the spin, at {in_rpm(speed)}; {by}."
    return Note(RunCode.AGAINST_SPIN, {"share": share, "speed": speed}, text)


def self_excited(whirl: SelfExcited) -> Note:
    """Self-excited whirl: at which speeds, and how fast it grows at most."""
    theory = f"linear theory of an even layer, liquid friction: {whirl.friction}"
    data: dict[str, object] = {"bands": whirl.bands, "not_known": whirl.not_known}
    lost, unknown = int(np.count_nonzero(np.isnan(whirl.growth))), ""
    if lost:
        between = ", ".join(rpm_range(low, high) for low, high in whirl.not_known)
        where = f", from {between}" if between else ""
        unknown = f" Not known at {lost} of {whirl.growth.size} speeds{where}: do not take it for stable."
    if not whirl.bands:
        elsewhere = "at the other speeds" if lost else "at these speeds"
        text = f"No self-excited whirl {elsewhere} ({theory}).{unknown}"
        if lost == whirl.growth.size:
            text = f"It is not known whether whirl is self-excited ({theory}): do not take it for stable."
        return Note(RunCode.SELF_EXCITED, data, text)
    listed = ", ".join(rpm_range(low, high) for low, high in whirl.bands)
    most, fastest = int(np.nanargmax(whirl.growth)), ""
    if whirl.growth[most] > 0.0:
        growth, turning = float(whirl.growth[most]), float(whirl.whirl_speed[most])
        data |= {"growth": growth, "whirl_speed": turning}
        fastest = f", fastest at {growth:.3g} 1/s, whirling at {in_rpm(turning)}"
    text = f"Self-excited whirl from {listed}{fastest}: unstable there ({theory}).{unknown}"
    return Note(RunCode.SELF_EXCITED, data, text)


def thick_wall_layer(speed: float, limit: float, whole: bool) -> Note:
    """Speeds up to which growth of whirls is out of the range of laminar friction, and its limit."""
    where = "here" if whole else f"below {in_rpm(speed)}"
    text = f"Growth and bands {where} are out of range: a laminar wall layer over {limit:g} of the depth."
    return Note(RunCode.THICK_WALL_LAYER, {"speed": speed, "limit": limit}, text)


def large_whirl(large: LargeWhirl, speed: Array) -> Note | None:
    """How large the self-excited whirl on top of the response becomes; None where there is none."""
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
    """More than one deflection satisfies the balance."""
    which = "largest stable one" if stable else "largest"
    text = (
        f"Several deflections satisfy the balance {over_rpm(first, last, 'between', 'and')}; "
        f"reported is the {which}, where a slow run-up arrives."
    )
    return Note(RunCode.SEVERAL_ANSWERS, {"first": first, "last": last}, text)


def unbounded(wet: float | None, dry: float | None) -> Note:
    """The amplitude has no bound at a speed with or without liquid, rad/s, within the range."""
    found = [(name, speed) for name, speed in (("with", wet), ("without", dry)) if speed is not None]
    where = " and ".join(f"{name} liquid at {speed * RPM:.4g} rpm" for name, speed in found)
    text = f"Nothing damps the resonance {where}: the amplitude has no bound there."
    return Note(RunCode.UNBOUNDED, {"speed": wet, "speed_dry": dry}, text)


def wall(chamber: int, speed: float, volume: float, deflection: float, met: WallVolumes) -> Note:
    """How wet a chamber's wall is at a speed, rad/s, and what more liquid does there.

    Along an upright axis, where the wall is wet at the floor before it is under the lid, more liquid than
    wets it adds to the unbalance until it is wet up to the lid.
    """
    wet, full, inner = float(met.wetting), float(met.full), float(met.inner)
    held, at_floor, to_lid, first = (
        with_unit(each, VOLUME) for each in (volume, wet, full, np.fmin(full, inner))
    )
    upright, reaches = full > wet * (1.0 + _SAME), inner < full or inner < volume
    nothing = "more does nothing"
    if reaches:
        nothing = f"from {with_unit(inner, VOLUME)} on, at the inner wall, more changes its unbalance"
    elif not math.isnan(inner):
        nothing += f" up to {with_unit(inner, VOLUME)}, at the inner wall"
    if volume < wet * (1.0 - _SAME):
        enough = f"{at_floor} wet it{f' at the floor, {to_lid} up to the lid' * upright}"
        has = f"dry in part with {held}: {enough}; then {nothing}"
    elif volume < full * (1.0 - _SAME):
        has = f"wet all round at the floor, not up to the lid, with {held} (from {at_floor} on): "
        has += f"more adds to its unbalance up to {first}; then {nothing}"
    else:
        has = f"wet all round{' up to the lid' * upright} with {held} (from {to_lid} on): {nothing}"
    text = (
        f"Chamber {chamber + 1} at {in_rpm(speed)}, deflection {with_unit(deflection, LENGTH)}: wall {has}."
    )
    data = {"chamber": chamber, "speed": speed, "volume": volume, "enough": wet, "full": full}
    return Note(RunCode.WALL, {**data, "deflection": deflection}, text)


def mesh(chamber: int, finding: str) -> Note:
    """Faults of the mesh of a chamber's section."""
    return Note(RunCode.MESH, {"chamber": chamber}, f"Mesh of chamber {chamber + 1}: {finding}.")
