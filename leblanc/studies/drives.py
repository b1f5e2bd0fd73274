"""How a scene drives its machine through time: run-up or programme, and what leaves its rotor by then."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from leblanc.scene.programme.steps import Step
from leblanc.scene.rotors import AnyRotor, not_taken
from leblanc.scene.scene import MagneticRotor, Programme, Runup, Scene, dry_rotor, require_whirl
from leblanc.scene.unbalances import (
    polar_inertia_of,
    sheds_of,
    unbalance_places_of,
    unbalances_of,
    with_unbalances,
)
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.rotor.loads.frame import frame_of
from solvers.rotor.system import RotorSystem, Shed
from solvers.runup import programme
from solvers.runup.machine import Drive, Handover, Motor, Ramp

if TYPE_CHECKING:
    from solvers.runup.runup import RunupHistory, RunupNumerics


def planned(scene: Scene) -> Runup | Programme:
    """The run-up or the programme of a scene."""
    if isinstance(scene.rotor, MagneticRotor):
        missing = "" if scene.rotor.trial is not None else ", once the scene has that table"
        instead = (
            "; type `leblanc run` in place of `leblanc runup`: it follows [rotor.trial] in time, its "
            f"pulsating speed and its start off the centre{missing}"
        )
        raise not_taken(scene.rotor.kind, instead)
    require_whirl(scene)
    if scene.speed_plan is None:
        allowed = (
            "a table [runup] in the scene with start, stop, duration, and rate or motor, or [programme]; "
            "what `leblanc new` writes has one, commented out"
        )
        raise InputError("runup", "missing", allowed)
    return scene.speed_plan


def drive_of(plan: Runup | Programme, rotor: AnyRotor | None = None) -> Drive:
    """Ramp or motor of a run-up, or the stages of a programme."""
    if isinstance(plan, Programme):
        own = None if rotor is None else polar_inertia_of(rotor)
        inertia = own or None if plan.inertia is None else plan.inertia
        return programme.Programme(
            plan.start,
            tuple(_stage(step, plan.coast_limit) for step in plan.steps),
            inertia,
            plan.drag_torque,
            plan.drag_rate,
            None if plan.motor is None else (plan.motor.speeds, plan.motor.torques),
            plan.coast_limit,
        )
    if plan.motor is not None:
        motor = plan.motor
        return Motor(plan.start, motor.inertia, motor.speeds, motor.torques, plan.duration)
    if plan.rate is None:
        raise InputError("runup.rate", None, "given where there is no motor")
    return Ramp(plan.start, plan.stop, plan.rate, plan.duration, plan.back)


def _stage(step: Step, limit: float) -> programme.Stage:
    """A step of a programme as the solvers take it; a coast to a speed lasts no longer than a limit, s."""
    free = step.kind == "coast"
    return programme.Stage(step.speed, step.rate, limit if free and step.time is None else step.time, free)


def numerics_of(
    plan: Runup | Programme, cells: int | None = None, samples: int | None = None, check: bool = True
) -> RunupNumerics:
    """Resolution of a run-up; the scene's where nothing else is given."""
    from solvers.runup.runup import RunupNumerics

    return RunupNumerics(
        cells=plan.cells if cells is None else cells,
        samples=plan.samples if samples is None else samples,
        dispersion=plan.dispersion,
        enstrophy=plan.bore == "enstrophy",
        handover=Handover(plan.capture),
        companion=check,
    )


def rotor_in_time(scene: Scene) -> RotorSystem:
    """The rotor of a scene without liquid, with what leaves of its unbalances."""
    system, sizes, found = dry_rotor(scene).system(), unbalances_of(scene.rotor), []
    for k, sheds in enumerate(sheds_of(scene.rotor)):
        if sheds is None:
            continue
        alone = [sheds.share * size * (j == k) for j, size in enumerate(sizes)]
        part = scene.altered(rotor=with_unbalances(scene.rotor, alone))
        unbalance, mass, inertia = dry_rotor(part).system().unbalance, None, 0.0
        if sheds.mass is not None:
            mass, inertia = water_mass(scene, k, sheds.mass)
        found.append(Shed(unbalance, sheds.time_constant, sheds.above, mass, inertia))
    return replace(system, sheds=tuple(found)) if found else system


def water_mass(scene: Scene, part: int, mass: float) -> tuple[Array, float]:
    """Mass matrix of the water that leaves with a part of an unbalance, and its inertia about the spin axis.

    It goes round at the radius at which it makes its share of the unbalance, in the plane of that; over a
    turn it counts as a mass on the axis [theory: coupling, eq. 17].

    kg and kg m^2, shape (n, n); kg m^2.
    """
    rotor = dry_rotor(scene)
    frame, sheds = frame_of(rotor, scene.rotor.axis == "vertical"), sheds_of(scene.rotor)[part]
    assert sheds is not None
    moving = frame.moving(frame.on_axis(unbalance_places_of(scene.rotor)[part]))
    radius = sheds.share * unbalances_of(scene.rotor)[part] / mass
    return mass * moving.T @ moving, mass * radius**2


def unbalance_left(scene: Scene, history: RunupHistory) -> Array | None:
    """Sizes of all unbalances over what they were at first, shape (k,); None where none of them leaves."""
    sizes = unbalances_of(scene.rotor)
    pairs = zip(sizes, sheds_of(scene.rotor), strict=True)
    leaving = np.array([size * sheds.share for size, sheds in pairs if sheds is not None])
    if history.left is None or not leaving.size or not sum(sizes) > 0.0:
        return None
    return np.asarray(1.0 - (1.0 - history.left) @ leaving / sum(sizes))
