"""The balls of a scene: how they rest at each speed, where a run-up finds them, what results keep of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import fields, replace
from typing import TypeVar

import numpy as np

from leblanc.core.notes import Note
from leblanc.liquid.choose import Prepared, axial_gravity, carried_from, choose_all, prepare
from leblanc.liquid.validity import doubts
from leblanc.scene.inputs import input_rows
from leblanc.scene.races import BallRace
from leblanc.scene.scene import Scene
from leblanc.studies.balls import notes
from leblanc.studies.balls.answer import BallsAnswer
from leblanc.studies.balls.races import GravityOnBalls, RaceOfBalls, StuckBalls
from leblanc.studies.balls.states import liquid_beside, own_family
from leblanc.studies.closed_forms.study import closed_forms
from leblanc.studies.loads.answer import MachineLoads
from leblanc.studies.loads.study import loaded_machine, loads_over_speed, with_bearing_life
from leblanc.studies.run import notes as response_notes
from leblanc.studies.volume.study import volumes_over_speed
from meshes.arrays import Array, Complex, Index
from meshes.errors import InputError
from solvers.liquid_model import ROUNDING, LiquidModel
from solvers.rotor.balls.balancers import BallRace as Race
from solvers.rotor.balls.balancers import with_balls_at
from solvers.rotor.balls.charts import stable_bands
from solvers.rotor.balls.families import Member, growth_ranges
from solvers.rotor.balls.states import RotorWithBalls, turning
from solvers.rotor.balls.steady import BallKind
from solvers.rotor.balls.swing import gravity_swing, holding, swing_power
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import RotorSystem
from solvers.rotor.vibration import orbit
from solvers.runup.balls import Balls
from solvers.synchronous.balls import in_step, wet_states
from solvers.synchronous.errors import GravityError, LinearError, error_estimate, machine_errors
from solvers.synchronous.response import response

_STARTS, _FOUND = 64, 0.9  # from which balls that stick are let go; share that must come to a stop
_UNLIKE = 1e-9  # of its mass, by which a ball differs from the next: what rounding does in a long run
APART = 0.1  # rad between balls at the bottom of a race whose diameter the scene does not say


def races_shown(scene: Scene) -> tuple[RaceOfBalls, ...]:
    """The races of a scene as results keep them."""
    return tuple(
        RaceOfBalls(race.count, race.capacity / race.count, race.plane, race.radius, race.diameter)
        for race in scene.balls
    )


def started_balls(scene: Scene) -> Balls:
    """The balls of a scene where a run-up begins."""
    places: list[float] = []
    shares: list[float] = []
    for race in scene.balls:
        places += _places(race)
        shares += [1.0 if race.start == "spread" else 0.0] * race.count
    return Balls(tuple(_apart(race.race()) for race in scene.balls), tuple(places), tuple(shares))


def _apart(race: Race) -> Race:
    """A race whose balls are not quite alike: two that meet with one speed would move as one for ever.

    Real balls touch before and are pushed apart; these part where being together is not stable.
    """
    masses = tuple(mass * (1.0 + _UNLIKE * k) for k, mass in enumerate(race.masses))
    return replace(race, masses=masses)


def _places(race: BallRace) -> list[float]:
    """Angle of each ball from the first direction, against which gravity acts, rad."""
    if race.start == "spread":
        return [race.start_angle + 2.0 * math.pi * k / race.count for k in range(race.count)]
    apart = APART if race.diameter is None else 2.0 * math.asin(0.5 * race.diameter / race.radius)
    return [math.pi + apart * (k - 0.5 * (race.count - 1)) for k in range(race.count)]


def run_balls(scene: Scene, families: bool = True, edges: bool = True) -> BallsAnswer:
    """States in which the balls of a scene rest in the drum, at each of its speeds [theory: races, eq. 5-8].

    `families`: look for the least and the largest growth rate over families of states; `edges`: solve the
    speeds between which the balanced state is stable.
    """
    if not scene.balls:
        raise InputError("chambers", len(scene.chambers), "with one of kind balls for this")
    liquid, model = liquid_beside(scene)
    machine = replace(prepare(scene.without_balls()), scene=scene)
    rotor, system, speed, gravity = machine.rotor, machine.system, machine.speed, machine.axial_gravity
    races = [race.race() for race in scene.balls]
    place = scene.fills[0].chamber.plane if scene.fills else scene.balls[0].plane
    found = wet_states(system, scene.fills, races, speed, gravity, model)
    way = orbit(system, found.states.coordinates, place)
    lost = found.states.kind == BallKind.NONE
    without = response(rotor, scene.fills, speed, gravity, model, position=place)
    answer = BallsAnswer(
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
        liquid_model=liquid if any(fill.volume > 0.0 for fill in scene.fills) else "",
        tolerance=scene.model.tolerance,
    )
    if families:
        answer = replace(answer, growth_range=_growth_range(scene, system, races, answer, model))
    if edges:
        answer = replace(answer, balanced_bands=_balanced_bands(scene, system, answer))
    if scene.fills:
        paths = found.states.coordinates[np.arange(speed.size), answer.chosen]
        moved = [np.abs(orbit(system, paths, fill.chamber.plane).forward) for fill in scene.fills]
        volumes = volumes_over_speed(scene.fills, speed, np.stack(moved), gravity)
        answer = replace(answer, wall_volumes=volumes)
    if any(answer.sticking):
        answer = replace(answer, stuck=stuck_balls(machine, races, model, place))
    answer, waves = _estimated(machine, races, answer)
    answer = replace(answer, loads=_loads(scene, answer))
    alike = turning(system) is not None
    return replace(answer, notes=_run_notes(scene, answer, alike, waves))


def _balanced_bands(
    scene: Scene, system: RotorSystem, answer: BallsAnswer
) -> tuple[tuple[float, float], ...] | None:
    """Bands of speed in which the balanced state is stable; None for a family, and on unlike supports."""
    states, (low, high) = answer.states, (float(answer.speed.min()), float(answer.speed.max()))
    family = (states.dimension > 0) & (states.kind == BallKind.BALANCED)
    if low == high or family.any() or turning(system) is None:
        return None
    return tuple(stable_bands(own_family(scene), np.array([low, high]), 0.0)[1])


def _growth_range(
    scene: Scene, system: RotorSystem, races: list[Race], answer: BallsAnswer, model: LiquidModel
) -> Array:
    """Least and largest growth over the family of each state reported, 1/s, shape (s, 2)."""
    found = np.repeat(answer.growth[:, None], 2, axis=1)
    rows, chosen, states = np.arange(answer.speed.size), answer.chosen, answer.states
    still = states.still[rows, chosen]
    # All members of a family that only turns in the drum are alike.
    wide = np.flatnonzero((answer.family_dimension > 0) & still.any(axis=1))
    gravity, members = axial_gravity(scene), []
    for k in wide.tolist():
        speed, own = float(answer.speed[k]), chosen[k]
        machine = RotorWithBalls(in_step(system, scene.fills, speed, gravity, model), tuple(races))
        places, coordinates = states.places[k, own], states.coordinates[k, own]
        members.append(Member(machine, speed, places, coordinates, still[k]))
    if members:
        ranges = growth_ranges(members)
        found[wide, 0] = np.fmin(found[wide, 0], ranges[:, 0])
        found[wide, 1] = np.fmax(found[wide, 1], ranges[:, 1])
    return found


def _estimated(
    machine: Prepared, races: list[Race], answer: BallsAnswer
) -> tuple[BallsAnswer, GravityError | None]:
    """The same with what its states leave out: errors of the liquid's model, gravity across the axis."""
    error = in_range = captured_from = waves = None
    if answer.liquid_model:
        linear = answer.liquid_model == "linear"
        error, waves = liquid_errors(machine, races, answer.ball_angle, answer.position, linear)
    if machine.across_gravity > 0.0:
        # Where balls are pressed to their races all round in spite of gravity.
        in_range = np.square(machine.speed) * min(race.radius for race in races) > machine.across_gravity
        if answer.liquid_model:
            (choice,) = choose_all([replace(machine, scene=machine.scene.without_balls())])
            in_range, captured_from = in_range & choice.in_range, choice.captured_from
    coordinates = answer.states.coordinates[np.arange(answer.speed.size), answer.chosen]
    swing = gravity_on_balls(machine, races, answer.ball_angle, coordinates, answer.position)
    answer = replace(answer, error_estimate=error, in_range=in_range)
    return replace(answer, capture_speed=captured_from, gravity=swing), waves


def _loads(scene: Scene, answer: BallsAnswer) -> MachineLoads | None:
    """Forces and clearances of the stable states; None where the scene asks for none."""
    machine = loaded_machine(scene)
    if machine is None:
        return None
    coordinates = answer.states.coordinates[np.arange(answer.speed.size), answer.chosen]
    coordinates = np.where(answer.stable[:, None], coordinates, complex(np.nan, np.nan))
    asked = np.arange(answer.speed.size)
    swing = 0.0 if answer.gravity is None else answer.gravity.power
    friction = scene.model.friction
    found = loads_over_speed(machine, friction, answer.speed, coordinates, asked, lost=swing)
    return with_bearing_life(scene, machine, found)


def _run_notes(
    scene: Scene, answer: BallsAnswer, alike: bool, waves: GravityError | None
) -> tuple[Note, ...]:
    """What was assumed, and what is not reported."""
    found = [notes.capacity(answer.can_balance, sum(answer.capacity)), notes.points()]
    if answer.unstable.any():
        first, last = answer.speed[answer.unstable][[0, -1]].tolist()
        found.append(notes.runs_on(first, last, bool(answer.converged[answer.unstable].any())))
    wide = (answer.family_dimension > 0) & answer.converged
    if answer.growth_range is not None and wide.any():
        least, largest = answer.growth_range[wide].min(), answer.growth_range[wide].max()
        first, last = answer.speed[wide][[0, -1]].tolist()
        most = int(answer.family_dimension.max())
        found.append(notes.family(first, last, most, float(least), float(largest)))
    if answer.elsewhere.any():
        first, last = answer.speed[answer.elsewhere][[0, -1]].tolist()
        found.append(notes.elsewhere(first, last))
    if answer.stuck is not None:
        found.append(_sticks(answer, answer.stuck))
    if answer.gravity is not None:
        found.append(_gravity(answer))
    if not alike:
        found.append(notes.uneven_supports())
    if scene.fills:
        found.append(notes.liquid_in_step(answer.liquid_model))
        if answer.capture_speed is not None:
            found.append(response_notes.not_carried(answer.capture_speed, carried_from(scene)))
        if waves is not None and answer.gravity is not None:
            found.append(_waves(answer, waves))
    if any(race.liquid is not None for race in scene.balls):
        found.append(notes.covered())
    if answer.loads is not None:
        found += [response_notes.loads(), notes.loads_of_states()]
    return (*found, *doubts(scene))


def stuck_balls(machine: Prepared, races: Sequence[Race], model: LiquidModel, position: float) -> StuckBalls:
    """Amplitudes that balls leave which creep until their resistance holds them [theory: races, eq. 9].

    From the same places all round at each speed; the liquid goes in step with the axis.
    """
    speed, fills, gravity = machine.speed, machine.scene.fills, machine.axial_gravity
    count = sum(len(race.masses) for race in races)
    starts = np.random.default_rng(0).uniform(0.0, 2.0 * math.pi, (_STARTS, count))
    hold = holding(races, speed, machine.across_gravity)
    own = RotorWithBalls(machine.system, tuple(races))
    compliance = own.compliance(speed)
    for k in range(speed.size if fills else 0):
        wet = in_step(machine.system, fills, float(speed[k]), gravity, model)
        compliance[k] = RotorWithBalls(wet, tuple(races)).compliance(speed[k : k + 1])[0]
    each = np.repeat(compliance, _STARTS, axis=0)
    places, stopped = own.stick(each, np.tile(starts, (speed.size, 1)), np.repeat(hold, _STARTS, axis=0))
    size = orbit(machine.system, own.coordinates(each, places), position).amplitude
    sizes = np.where(stopped, size, np.nan).reshape(speed.size, _STARTS)
    # Where balls run in their race they find no place.
    known = np.isfinite(sizes).mean(axis=1) >= _FOUND
    found = np.full((3, speed.size), np.nan)
    found[:, known] = np.nanpercentile(sizes[known], [5.0, 50.0, 95.0], axis=1)
    return StuckBalls(hold, *found)


def _sticks(answer: BallsAnswer, stuck: StuckBalls) -> Note:
    """Balls that resist to rolling: from which speed on they stick, and what they leave at the last."""
    sticks = np.flatnonzero(stuck.sticks)
    first = float(answer.speed[sticks[0]]) if sticks.size else math.nan
    band = float(stuck.low[-1]), float(stuck.median[-1]), float(stuck.high[-1])
    lies = answer.axis == "horizontal"
    return notes.sticks(float(answer.speed[-1]), float(stuck.hold[-1].max()), first, band, lies)


def _gravity(answer: BallsAnswer) -> Note:
    """How much gravity across the axis does, at the last speed and where it does most to balls that rest."""
    assert answer.gravity is not None
    assert answer.in_range is not None
    swing = answer.gravity.ball_swing.max(axis=1)
    worst = np.where(answer.stable & answer.in_range, np.nan_to_num(swing, nan=-1.0), -1.0)
    at = [int(np.argmax(worst)), -1] if worst.max() >= 0.0 else [-1]
    columns = answer.speed, answer.gravity.share, swing, answer.gravity.amplitude
    return notes.lies(list(zip(*(column[at].tolist() for column in columns), strict=True)))


def _waves(answer: BallsAnswer, waves: GravityError) -> Note:
    """Effect of gravity's waves in the liquid on the states reported."""
    assert answer.in_range is not None
    worst = float(np.max(waves.amplitude[answer.stable & answer.in_range], initial=0.0))
    amplitude, ripple, liquid = (
        float(size[-1]) for size in (waves.amplitude, waves.ripple, waves.liquid_ripple)
    )
    return notes.liquid_waves(float(answer.speed[-1]), amplitude, ripple, liquid, worst)


_Errors = TypeVar("_Errors", LinearError, GravityError)


def liquid_errors(
    machine: Prepared, races: Sequence[Race], places: Array, position: float, linear: bool
) -> tuple[Array, GravityError]:
    """Estimated error of the motion by the liquid's model, the balls held where they rest.

    Relative, of amplitude and liquid the larger one, shape (s,); what gravity across the axis does, nan where
    there is no state [theory: model_error].
    """
    known = np.flatnonzero(np.isfinite(places).all(axis=1))
    systems = [with_balls_at(machine.system, races, places[k]) for k in known]
    law, waves = _errors(machine, systems, known, position)
    found = np.full(places.shape[0], np.nan)
    found[known] = (law.worst if linear else ROUNDING) + waves.amplitude
    whole = np.full((4, places.shape[0]), np.nan)
    for row, field in zip(whole, fields(GravityError), strict=True):
        row[known] = getattr(waves, field.name)
    return found, GravityError(*whole)


def _errors(
    machine: Prepared, systems: Sequence[RotorSystem], known: Index, position: float
) -> tuple[LinearError, GravityError]:
    """Errors of the machines that the balls make at some speeds."""
    along, across = machine.axial_gravity, machine.across_gravity
    fills, speed = machine.scene.fills, machine.speed[known]
    if isinstance(machine.rotor, Jeffcott):
        count, rotors = len(systems), []
        for system in systems:
            mass, unbalance = float(system.mass[0, 0]), float(abs(system.unbalance[0]))
            rotors.append(replace(machine.rotor, mass=mass, unbalance=unbalance))
        both = np.full(count, along), np.full(count, across)
        return machine_errors([(rotor, fills) for rotor in rotors], np.arange(count), speed, *both)
    parts = [
        error_estimate(system, fills, [spin], along, across, position)
        for system, spin in zip(systems, speed.tolist(), strict=True)
    ]
    laws, waves = [law for law, _ in parts], [wave for _, wave in parts]
    return _joined(LinearError, laws), _joined(GravityError, waves)


def _joined(kind: type[_Errors], parts: Sequence[_Errors]) -> _Errors:
    """Errors of several speeds one after the other."""
    names = [field.name for field in fields(kind)]
    return kind(**{name: np.concatenate([getattr(part, name) for part in parts]) for name in names})


def gravity_on_balls(
    machine: Prepared, races: Sequence[Race], places: Array, coordinates: Complex, position: float
) -> GravityOnBalls | None:
    """How balls that rest in a horizontal drum swing, and what that does [theory: races, eq. 11].

    None where gravity does not act across the axis.
    """
    gravity, speed = machine.across_gravity, machine.speed
    if gravity == 0.0:
        return None
    system = machine.system
    for fill in machine.scene.fills:
        plane = system.at(fill.chamber.plane)
        system = replace(system, mass=system.mass + fill.mass * plane.T @ plane)
    swing, (moved, power) = np.full(places.shape, np.nan), np.full((2, speed.size), np.nan)
    turning = 0.5 * (system.at(position)[0] + 1j * system.at(position)[1])
    back = 0.5 * (system.at(position)[0] - 1j * system.at(position)[1])
    for k in np.flatnonzero(np.isfinite(places).all(axis=1)).tolist():
        found = gravity_swing(system, races, float(speed[k]), places[k], coordinates[k], gravity)
        swing[k], power[k] = np.abs(found.balls), swing_power(races, float(speed[k]), found.balls)
        moved[k] = abs(turning @ found.coordinates) + abs(back @ found.coordinates)
    least = min(race.radius for race in races)
    return GravityOnBalls(gravity / (least * np.square(speed)), swing, moved, power)
