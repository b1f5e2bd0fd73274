"""What a scene of kind "magnetic" answers: poles, margins, loads, a trial in time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from leblanc.core.progress import update
from leblanc.wings.magnetic.answer import (
    Controlled,
    Followed,
    LoadAnswer,
    MagneticAnswer,
    MagneticExplanation,
)
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.rotor.magnetic.control import Controller, Uncontrolled
from solvers.rotor.magnetic.linear import Loop, closed_loop, margins, orbit_size
from solvers.rotor.magnetic.machine import MagneticRotor, dimensionless
from solvers.rotor.magnetic.motion import Load, integrate, settling_time

if TYPE_CHECKING:
    from leblanc.scene.magnetic import MagneticRotor as MagneticOfScene
    from leblanc.scene.magnetic import Trial
    from leblanc.scene.scene import Scene

BAND = 0.02  # of the gap, within which the rotor has settled; 4 um of the source's gap, its requirement
_STEPS = 400  # times at which a step is looked at
_PLACES = 91  # up to 0.9 of the gap


def run_magnetic(scene: Scene) -> MagneticAnswer:
    """Answer of a scene of kind "magnetic" over its speeds [theory: magnetic, eq. 19-24]."""
    rotor = rotor_of(scene)
    machine, speed, trial = rotor.machine(), scene.speed_array(), rotor.trial
    loads = loads_of(scene)
    load_speed = float(speed[-1]) if trial is None else trial.speed
    band = BAND * machine.magnets.gap
    found = []
    for controller in rotor.controllers():
        update(what=controller.name)
        found.append(_controlled(machine, controller, speed, loads, load_speed, trial, band))
    return MagneticAnswer(
        **_of(scene),
        machine=machine,
        dimensionless=dimensionless(machine),
        speed=speed,
        controllers=tuple(found),
        loads=tuple(loads.values()),
        load_speed=load_speed,
        band=band,
    )


def explain_magnetic(scene: Scene) -> MagneticExplanation:
    """Numbers that determine how a rotor in magnetic bearings behaves [theory: magnetic, eq. 4-10]."""
    rotor = rotor_of(scene)
    machine, last = rotor.machine(), scene.speeds.stop
    magnets, place = machine.magnets, np.linspace(0.0, 0.9 * machine.magnets.gap, _PLACES)
    currents = np.array([-magnets.limit, 0.0, magnets.limit])[:, None]
    return MagneticExplanation(
        **_of(scene),
        dimensionless=dimensionless(machine),
        current_stiffness=magnets.current_stiffness,
        position_stiffness=magnets.position_stiffness,
        growth=float(closed_loop(machine, Uncontrolled(), last).poles.real.max()),
        holds=float(machine.outward_force(0.0, magnets.limit)),
        reach=machine.reach,
        fastest={
            control.name: float(-closed_loop(machine, control, last).poles.real.min())
            for control in rotor.controllers()
        },
        place=place,
        force=machine.outward_force(place, currents),
    )


def _of(scene: Scene) -> dict[str, Any]:
    """What an answer keeps of its scene."""
    return {
        "name": scene.name,
        "source": scene.source,
        "assumed": scene.assumed,
        "digest": scene.digest,
    }


def loads_of(scene: Scene) -> dict[str, Load]:
    """Loads on the rotor of a scene by their names, gravity among them where it lies across the axis."""
    rotor = rotor_of(scene)
    loads = {f"load {k + 1}": part.load() for k, part in enumerate(rotor.loads)}
    if rotor.axis == "horizontal":
        loads["gravity"] = Load((0.0, -rotor.mass * scene.gravity))
    return loads


def rotor_of(scene: Scene) -> MagneticOfScene:
    """The scene's rotor, which is in magnetic bearings."""
    from leblanc.scene.magnetic import MagneticRotor as OfScene

    if not isinstance(scene.rotor, OfScene):
        raise InputError("rotor.kind", scene.rotor.kind, "magnetic for this")
    return scene.rotor


def _controlled(
    machine: MagneticRotor,
    controller: Controller,
    speed: Array,
    loads: dict[str, Load],
    load_speed: float,
    trial: Trial | None,
    band: float,
) -> Controlled:
    """One controller at all speeds."""
    loops = [closed_loop(machine, controller, float(spin)) for spin in speed]
    edges = [margins(loop) for loop in loops]
    answers = [loop.unbalance() for loop in loops]
    at = closed_loop(machine, controller, load_speed)
    return Controlled(
        name=controller.name,
        poles=np.array([loop.poles for loop in loops]),
        gain_up=np.array([edge.gain_up for edge in edges]),
        gain_down=np.array([edge.gain_down for edge in edges]),
        phase_margin=np.array([edge.phase for edge in edges]),
        delay_margin=np.array([edge.delay for edge in edges]),
        sensitivity=np.array([edge.sensitivity for edge in edges]),
        unbalance=np.array([place[0] for place, _ in answers]),
        amplitude=np.array([orbit_size(place).max() for place, _ in answers]),
        current=np.array([np.abs(current).max() for _, current in answers]),
        loads=tuple(_load(name, load, at) for name, load in loads.items()) if at.stable else (),
        trial=None if trial is None else _followed(machine, controller, trial, tuple(loads.values()), band),
    )


def _load(name: str, load: Load, loop: Loop) -> LoadAnswer:
    """What a load does to a stable loop."""
    place, current = loop.answer(load.size, load.frequency or 0.0)
    peak = math.nan
    if load.frequency is None:
        sizes = np.abs(loop.poles.real)
        times = np.geomspace(1e-2 / sizes.max(), 10.0 / sizes.min(), _STEPS)
        peak = float(orbit_size(loop.step(load.size, times)[0]).max())
    return LoadAnswer(
        name=name,
        frequency=math.nan if load.frequency is None else load.frequency,
        peak=peak,
        settled=float(orbit_size(place).max()),
        current=float(np.abs(current).max()),
    )


def _followed(
    machine: MagneticRotor, controller: Controller, trial: Trial, loads: Sequence[Load], band: float
) -> Followed:
    """The trial in time, and what it shows."""
    place = (*trial.offset, 0.0, 0.0)
    motion = integrate(
        machine, controller, trial.law(), trial.duration, loads, place=place, samples=trial.samples
    )
    later = min((load.start for load in loads if load.start > 0.0), default=math.inf)
    after = motion.time >= later
    distance = motion.distance
    return Followed(
        motion=motion,
        settled=settling_time(motion, band, later),
        after_loads=float(distance[after].max()) if after.any() else math.nan,
        left=float(distance[motion.time >= 0.9 * motion.time[-1]].max()),
        most_current=float(np.abs(motion.current).max()),
    )
