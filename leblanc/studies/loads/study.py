"""Loads and clearances of a scene's motion, over speed and over time."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fluid.friction.laws import Friction
from leblanc.scene.scene import JeffcottRotor, Scene, TubRotor, dry_rotor
from leblanc.studies.drives import rotor_in_time
from leblanc.studies.loads.answer import BearingLife, MachineLoads
from meshes.arrays import Array, Complex, Flags, Index
from solvers.held.state import HeldState
from solvers.rotor.loads.machine import LoadedMachine
from solvers.rotor.loads.turn import Extremes, damping_power, joined, liquid_power, orbits, turn_extremes
from solvers.rotor.rolling_bearing import (
    LEAST_LOAD,
    rating_life,
    skidding_slip,
    sliding_speed,
    worn_volume,
)
from solvers.rotor.vibration import unbalance_response
from solvers.runup.loads import bearing_impulses, drive_torque, held_extremes, path_extremes

if TYPE_CHECKING:
    from solvers.runup.runup import RunupHistory

_HOUR = 3600.0  # s


def loaded_machine(scene: Scene) -> LoadedMachine | None:
    """The machine of a scene with its cabinet, points and bearings; None where it has none of them."""
    bearings = scene.rotor.bearings if isinstance(scene.rotor, TubRotor) else ()
    if scene.cabinet is None and not scene.points and not bearings:
        return None
    return LoadedMachine(
        dry_rotor(scene),
        tuple(scene.fills),
        scene.gravity,
        scene.rotor.axis == "vertical",
        None if scene.cabinet is None else scene.cabinet.standing(),
        tuple(point.moving() for point in scene.points),
        (bearings[0].position, bearings[1].position) if bearings else None,
        tuple(race.race() for race in scene.balls),
    )


def loads_over_speed(
    machine: LoadedMachine,
    friction: Friction,
    speed: Array,
    coordinates: Complex,
    asked: Index,
    held: Mapping[float, HeldState] | None = None,
    lost: Array | float = 0.0,
    counts: Flags | None = None,
) -> MachineLoads:
    """Loads of steady motions, each over its turn [theory: loads, eq. 14-16 and 18-19].

    `asked` are the speeds of the scene; `held` time-domain states, whose own turns and heat count there;
    `lost` power besides what supports and liquid take, W; `counts` the speeds of which the worst is taken,
    all if None or none.
    """
    power = steady_power(machine, friction, coordinates, speed) + lost
    worst, states = turn_extremes(machine, coordinates, speed), held or {}
    rows = [worst.at(np.array([k])) for k in range(speed.size)] if states else []
    for k, spin in enumerate(speed.tolist()):
        if spin in states:
            rows[k] = held_extremes(machine, spin, states[spin].path)
            power[k] = states[spin].heat if math.isfinite(states[spin].heat) else power[k]
    found = _loads(
        machine,
        joined(rows) if rows else worst,
        *(speed, np.zeros(0), np.zeros(0), power / speed, power),
        np.stack(orbits(machine, coordinates)),
        asked,
    )
    return found if counts is None or not counts.any() else replace(found, counts=counts)


def with_bearing_life(scene: Scene, machine: LoadedMachine, loads: MachineLoads) -> MachineLoads:
    """Loads over speed with life, slip and wear of the bearings whose rating is given [theory: loads]."""
    bearings = scene.rotor.bearings if isinstance(scene.rotor, TubRotor) else ()
    if all(bearing.dynamic_rating is None for bearing in bearings):
        return loads
    speed = loads.speed[loads.asked]
    bare = replace(machine, fills=(), races=())
    dry = turn_extremes(bare, unbalance_response(machine.rotor.system(), speed), speed).bearing_mean.T
    load = loads.worst.bearing_mean[loads.asked].T
    rating = np.array([[bearing.dynamic_rating or np.nan] for bearing in bearings])
    least = np.broadcast_to(LEAST_LOAD * rating, load.shape)
    slip = skidding_slip(load, least)
    wear = np.full(load.shape, np.nan)
    for k, bearing in enumerate(bearings):
        if bearing.ball_diameter is None or bearing.pitch_diameter is None:
            continue
        sizes = bearing.ball_diameter, bearing.pitch_diameter, bearing.contact_angle
        distance = _HOUR * sliding_speed(speed, slip[k], *sizes)
        wear[k] = worn_volume(bearing.wear_coefficient, load[k], distance)
    life = rating_life(rating, load, speed) / _HOUR
    return replace(loads, bearing_life=BearingLife(load, dry, np.array(least), slip, wear, life))


def steady_power(machine: LoadedMachine, friction: Friction, coordinates: Complex, speed: Array) -> Array:
    """Power of the motor that holds a steady motion [theory: loads, eq. 16 and 18-19]."""
    supports = damping_power(machine, coordinates, speed)
    return supports + liquid_power(machine, friction, coordinates, speed)


def loads_over_time(scene: Scene, machine: LoadedMachine, history: RunupHistory) -> MachineLoads | None:
    """Loads of a run-up, the worst of each interval; None without a path [theory: loads, eq. 14 and 17]."""
    if history.path is None:
        return None
    h, plan = history, scene.runup
    motor = plan is not None and plan.motor is not None
    inertia = spinning_inertia(scene) - _lost_inertia(scene, history)
    torque = drive_torque(history.path, h.time, h.speed, h.angle, inertia, motor)
    if scene.programme is not None:
        drag = spinning_inertia(scene) * scene.programme.drag_rate * h.speed
        torque = torque + scene.programme.drag_torque + drag
    torque = np.where(_coasting(scene, history), 0.0, torque)
    return _loads(
        machine,
        path_extremes(machine, history.path, h.time),
        *(h.speed, h.time, h.angle, torque, torque * h.speed),
        np.zeros((2, 0, len(machine.points))),
        np.arange(h.time.size),
        bearing_impulses(machine, history.path),
        history.path.jumps,
    )


def _lost_inertia(scene: Scene, history: RunupHistory) -> Array:
    """Moment of inertia of the water that has left the drum, kg m^2, shape (k,)."""
    sheds = rotor_in_time(scene).sheds
    if history.left is None or not sheds:
        return np.zeros(history.time.shape)
    return np.asarray((1.0 - history.left) @ np.array([shed.inertia for shed in sheds]))


def _coasting(scene: Scene, history: RunupHistory) -> Flags:
    """Where the motor is off, shape (k,)."""
    if scene.programme is None or history.stage is None:
        return np.zeros(history.time.shape, dtype=bool)
    off = np.array([step.kind == "coast" for step in scene.programme.steps])
    return np.asarray(off[history.stage])


def spinning_inertia(scene: Scene) -> float:
    """Moment of inertia of what spins without the liquid, kg m^2; 0 where the scene has none."""
    rotor = scene.rotor
    if scene.programme is not None and scene.programme.inertia is not None:
        return scene.programme.inertia
    if isinstance(rotor, TubRotor):
        return rotor.drum_polar_inertia
    return 0.0 if isinstance(rotor, JeffcottRotor) else float(getattr(rotor, "polar_inertia", 0.0))


def _loads(
    machine: LoadedMachine,
    worst: Extremes,
    speed: Array,
    time: Array,
    angle: Array,
    torque: Array,
    power: Array,
    orbit: Array,
    asked: Index,
    impulse: Array | None = None,
    jumps: Array | None = None,
) -> MachineLoads:
    """The result, with the names of its parts."""
    cabinet = machine.cabinet
    return MachineLoads(
        speed=speed,
        time=time,
        angle=angle,
        worst=worst,
        rest=np.zeros(0) if cabinet is None else machine.resting.vertical,
        friction=float("nan") if cabinet is None else cabinet.friction,
        holders=tuple(holder.name for holder in machine.holders),
        bearings=("bearing 1", "bearing 2") if machine.bearings is not None else (),
        points=tuple(point.name for point in machine.points),
        gaps=np.array([np.nan if point.gap is None else point.gap for point in machine.points]),
        torque=torque,
        power=power,
        semi_axes=orbit,
        asked=asked,
        impulse=np.zeros((0, 2 if machine.bearings is not None else 0)) if impulse is None else impulse,
        jumps=np.zeros(0) if jumps is None else jumps,
    )
