"""What the states of balls leave out: the error of the liquid's model, and gravity across the axis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace
from typing import TypeVar

import numpy as np

from leblanc.liquid.choose import Prepared
from leblanc.studies.balls.races import GravityOnBalls
from meshes.arrays import Array, Complex, Flags, Index
from solvers.liquid_model import ROUNDING
from solvers.rotor.balls.balancers import BallRace, with_balls_at
from solvers.rotor.balls.swing import gravity_swing, swing_power
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import RotorSystem
from solvers.synchronous.errors import GravityError, LinearError, error_estimate, machine_errors

_Errors = TypeVar("_Errors", LinearError, GravityError)


def liquid_errors(
    machine: Prepared, races: Sequence[BallRace], places: Array, position: float, linear: bool
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
    machine: Prepared, races: Sequence[BallRace], places: Array, coordinates: Complex, position: float
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


def carried_balls(machine: Prepared, races: Sequence[BallRace]) -> Flags:
    """Where balls are pressed to their races all round in spite of gravity, shape (s,)."""
    least = min(race.radius for race in races)
    return np.asarray(np.square(machine.speed) * least > machine.across_gravity)
