"""The balls of a scene: how they rest at each speed, where a run-up finds them, what results keep of them."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from leblanc.results.base import Note
from leblanc.results.machine.loads import MachineLoads
from leblanc.results.motion.ball_states import BallsResult
from leblanc.results.motion.balls import RaceOfBalls
from leblanc.results.notes import balls as notes
from leblanc.results.notes import response as response_notes
from leblanc.scene.inputs import input_rows
from leblanc.scene.races import BallRace
from leblanc.scene.scene import Scene, require_clear
from leblanc.studies.closed_forms.told import closed_forms
from leblanc.studies.machine import loaded_machine, loads_over_speed
from leblanc.studies.models.choose import prepare
from leblanc.studies.models.validity import doubts
from meshes.errors import InputError
from solvers.rotor.balls.steady import BallKind, RotorWithBalls, turning
from solvers.rotor.vibration import orbit
from solvers.runup.balls import Balls
from solvers.synchronous.balls import wet_states
from solvers.synchronous.response import response

APART = 0.1  # rad between balls at the bottom of a race whose diameter the scene does not say


def races_shown(scene: Scene) -> tuple[RaceOfBalls, ...]:
    """The races of a scene as results keep them.

    Parameters
    ----------
    scene : the machine
    """
    return tuple(
        RaceOfBalls(race.count, race.capacity / race.count, race.plane, race.radius, race.diameter)
        for race in scene.balls
    )


def started_balls(scene: Scene) -> Balls:
    """The balls of a scene where a run-up begins.

    Parameters
    ----------
    scene : the machine
    """
    places: list[float] = []
    shares: list[float] = []
    for race in scene.balls:
        places += _places(race)
        shares += [1.0 if race.start == "spread" else 0.0] * race.count
    return Balls(tuple(race.race() for race in scene.balls), tuple(places), tuple(shares))


def _places(race: BallRace) -> list[float]:
    """Angle of each ball from the first direction, against which gravity acts, rad."""
    if race.start == "spread":
        return [2.0 * math.pi * k / race.count for k in range(race.count)]
    apart = APART if race.diameter is None else 2.0 * math.asin(0.5 * race.diameter / race.radius)
    return [math.pi + apart * (k - 0.5 * (race.count - 1)) for k in range(race.count)]


def run_balls(scene: Scene) -> BallsResult:
    """States in which the balls of a scene rest in the drum, at each of its speeds [theory: races, eq. 5-8].

    Parameters
    ----------
    scene : with races, and chambers with liquid or none

    Raises
    ------
    InputError : no race, a section or baffles that the exact equilibrium of the liquid does not know, a
        liquid model other than that
    """
    if not scene.balls:
        raise InputError("chambers", len(scene.chambers), "with one of kind balls for this")
    require_clear(scene, "balls beside liquid")
    if scene.model.liquid not in ("auto", "statics"):
        raise InputError("model.liquid", scene.model.liquid, "auto or statics beside balls")
    machine = replace(prepare(scene.without_balls()), scene=scene)
    rotor, system, speed, gravity = machine.rotor, machine.system, machine.speed, machine.axial_gravity
    races = [race.race() for race in scene.balls]
    place = scene.fills[0].chamber.plane if scene.fills else scene.balls[0].plane
    found = wet_states(system, scene.fills, races, speed, gravity)
    way = orbit(system, found.states.coordinates, place)
    lost = found.states.kind == BallKind.NONE
    without = response(rotor, scene.fills, speed, gravity, position=place)
    answer = BallsResult(
        name=scene.name,
        source=scene.source,
        assumed=scene.assumed,
        digest=scene.digest,
        inputs=input_rows(scene),
        kind=scene.rotor.kind,
        axis=scene.rotor.axis,
        races=races_shown(scene),
        position=place,
        states=found.states,
        forward=np.where(lost, complex(np.nan, np.nan), way.forward),
        backward=np.where(lost, complex(np.nan, np.nan), way.backward),
        deflection_without=without.deflection,
        amplitude_without=without.amplitude,
        amplitude_dry=without.amplitude_dry,
        liquid=found.liquid.sum(axis=-1),
        liquid_mass=sum(fill.mass for fill in scene.fills),
        dry=found.dry_patch,
        capacity=tuple(race.capacity for race in scene.balls),
        can_balance=RotorWithBalls(system, tuple(races)).balanced() is not None,
        sticking=tuple(race.rolling_resistance * race.radius for race in scene.balls),
        notes=(),
        closed_forms=closed_forms(machine),
    )
    answer = replace(answer, loads=_loads(scene, answer))
    return replace(answer, notes=_run_notes(scene, answer, turning(system) is not None))


def _loads(scene: Scene, answer: BallsResult) -> MachineLoads | None:
    """Forces and clearances of the stable states; None where the scene asks for none."""
    machine = loaded_machine(scene)
    if machine is None:
        return None
    coordinates = answer.states.coordinates[np.arange(answer.speed.size), answer.chosen]
    coordinates = np.where(answer.stable[:, None], coordinates, complex(np.nan, np.nan))
    asked = np.arange(answer.speed.size)
    return loads_over_speed(machine, scene.model.friction, answer.speed, coordinates, asked)


def _run_notes(scene: Scene, answer: BallsResult, alike: bool) -> tuple[Note, ...]:
    """What was assumed, and what is not told."""
    found = [notes.capacity(answer.can_balance, sum(answer.capacity)), notes.points()]
    if answer.unstable.any():
        first, last = answer.speed[answer.unstable][[0, -1]].tolist()
        found.append(notes.runs_on(first, last))
    if any(answer.sticking):
        found.append(notes.sticks(max(answer.sticking)))
    if scene.rotor.axis == "horizontal":
        found.append(notes.lies())
    if not alike:
        found.append(notes.uneven_supports())
    if scene.fills:
        found.append(notes.liquid_in_step())
    if any(race.liquid is not None for race in scene.balls):
        found.append(notes.covered())
    if answer.loads is not None:
        found += [response_notes.loads(), notes.loads_of_states()]
    return (*found, *doubts(scene))
