"""What a machine is judged by: loads and clearances of a scene's motion, over speed and over time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fluid.fill import Fill
from leblanc.results.machine.loads import MachineLoads
from leblanc.scene.scene import JeffcottRotor, Scene, TubRotor, dry_rotor
from meshes.arrays import Array, Complex, Flags, Index
from solvers.rotor.loads.machine import LoadedMachine
from solvers.rotor.loads.turn import Extremes, damping_power, orbits, turn_extremes
from solvers.runup.loads import drive_torque, path_extremes
from solvers.runup.runup import RunupHistory


def loaded_machine(scene: Scene, fills: Sequence[Fill] | None = None) -> LoadedMachine | None:
    """The machine of a scene with its cabinet, points and bearings; None where it has none of them.

    Parameters
    ----------
    scene : the machine
    fills : in place of the scene's

    Raises
    ------
    InputError : a cabinet that does not stand
    """
    bearings = scene.rotor.bearings if isinstance(scene.rotor, TubRotor) else ()
    if scene.cabinet is None and not scene.points and not bearings:
        return None
    return LoadedMachine(
        dry_rotor(scene),
        tuple(scene.fills if fills is None else fills),
        scene.gravity,
        scene.rotor.axis == "vertical",
        None if scene.cabinet is None else scene.cabinet.standing(),
        tuple(point.moving() for point in scene.points),
        (bearings[0].position, bearings[1].position) if bearings else None,
    )


def loads_over_speed(
    machine: LoadedMachine, speed: Array, coordinates: Complex, asked: Index
) -> MachineLoads:
    """Loads of steady motions, each over its turn [theory: loads, eq. 14-16].

    Parameters
    ----------
    machine : of a scene
    speed : rad/s, shape (k,)
    coordinates : complex amplitudes, shape (k, n)
    asked : which of the speeds are those of the scene
    """
    power = damping_power(machine, coordinates, speed)
    return _loads(
        machine,
        turn_extremes(machine, coordinates, speed),
        *(speed, np.zeros(0), np.zeros(0), power / speed, power),
        np.stack(orbits(machine, coordinates)),
        asked,
    )


def loads_over_time(scene: Scene, machine: LoadedMachine, history: RunupHistory) -> MachineLoads | None:
    """Loads of a run-up, the worst of each interval; None without a path [theory: loads, eq. 14 and 17].

    Parameters
    ----------
    scene, machine : the same machine
    history : its run-up
    """
    if history.path is None:
        return None
    h, plan = history, scene.runup
    motor = plan is not None and plan.motor is not None
    torque = drive_torque(history.path, h.time, h.speed, h.angle, spinning_inertia(scene), motor)
    torque = np.where(_coasting(scene, history), 0.0, torque)
    return _loads(
        machine,
        path_extremes(machine, history.path, h.time, h.captured),
        *(h.speed, h.time, h.angle, torque, torque * h.speed),
        np.zeros((2, 0, len(machine.points))),
        np.arange(h.time.size),
    )


def _coasting(scene: Scene, history: RunupHistory) -> Flags:
    """Where the motor is off, shape (k,)."""
    if scene.programme is None or history.stage is None:
        return np.zeros(history.time.shape, dtype=bool)
    off = np.array([step.kind == "coast" for step in scene.programme.steps])
    return np.asarray(off[history.stage])


def spinning_inertia(scene: Scene) -> float:
    """Moment of inertia of what spins without the liquid, kg m^2; 0 where the scene has none.

    Parameters
    ----------
    scene : the machine
    """
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
        orbit=orbit,
        asked=asked,
    )
