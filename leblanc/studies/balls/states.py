"""The state of rotor and balls that counts at a speed, without all that a result of `run` carries."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from fluid.fill import Fill
from leblanc.liquid.choose import axial_gravity
from leblanc.liquid.models import synchronous_model
from leblanc.scene.scene import Scene, dry_rotor, require_clear
from leblanc.studies.balls.answer import reported_state
from meshes.arrays import Array, Complex, Flags
from meshes.errors import InputError, require_positive
from solvers.liquid_model import LiquidModel
from solvers.rotor.balls.balancers import BallRace
from solvers.rotor.balls.charts import Family, Machine
from solvers.rotor.balls.states import RotorWithBalls
from solvers.rotor.balls.steady import BallKind
from solvers.rotor.system import RotorSystem
from solvers.rotor.vibration import orbit
from solvers.synchronous.balls import in_step, wet_states
from solvers.synchronous.models import STATICS

MODELS = ("statics", "linear")  # of liquid at rest in the drum, with which states of balls are found


@dataclass(frozen=True)
class WorstStates:
    """The worst stable state at each of s speeds; n coordinates."""

    speed: Array  #: rad/s, shape (s,)
    #: of the axis in the plane where it is largest, of those of all chambers, m, shape (s,); where no state
    #: is stable what all balls on the heavy side would make of it
    amplitude: Array
    stable: Flags  #: small motions do not grow, shape (s,)
    growth: Array  #: of small motions, 1/s, infinite where no state was found, shape (s,)
    balanced: Flags  #: the balanced state is stable, whichever is the worst, shape (s,)
    #: of small motions about the balanced state, 1/s, nan where there is none, shape (s,)
    balanced_growth: Array
    coordinates: Complex  #: complex amplitudes of the rotor, shape (s, n)


def planes_of(scene: Scene) -> tuple[float, ...]:
    """Planes of all chambers, the one that `run` reports first, m."""
    return tuple(dict.fromkeys(chamber.plane for chamber in scene.chambers))


def liquid_beside(scene: Scene) -> tuple[str, LiquidModel]:
    """Model of the liquid that rests beside balls, and its name; auto is the exact equilibrium."""
    require_clear(scene, "balls beside liquid")
    name = "statics" if scene.model.liquid == "auto" else scene.model.liquid
    if not scene.fills:
        return name, STATICS
    if name not in MODELS:
        allowed = f"auto, {' or '.join(MODELS)} beside balls; `leblanc runup` takes long waves through time"
        raise InputError("model.liquid", name, allowed)
    return name, synchronous_model(name)


def worst_states(scene: Scene, speed: ArrayLike) -> WorstStates:
    """The stable state of rotor, balls and liquid with the largest amplitude [theory: races, eq. 5-8]."""
    system, spin = dry_rotor(scene).system(), np.asarray(speed, dtype=float)
    races = [race.race() for race in scene.balls]
    model = liquid_beside(scene)[1]
    states = wet_states(system, scene.fills, races, spin, axial_gravity(scene), model).states
    ways = [orbit(system, states.coordinates, plane) for plane in planes_of(scene)]
    sizes = np.max([np.abs(way.forward) + np.abs(way.backward) for way in ways], axis=0)
    chosen = reported_state(states, sizes)
    rows, found = np.arange(spin.size), chosen >= 0
    most = gathered_amplitude(scene, spin)
    if not found.any():
        n = len(system.coordinates)
        nothing, none = np.full(spin.size, np.nan), np.zeros(spin.size, dtype=bool)
        lost = np.full((spin.size, n), complex(np.nan, np.nan))
        return WorstStates(spin, most, none, np.full(spin.size, np.inf), none, nothing, lost)
    rests, stable = states.kind == BallKind.BALANCED, found & states.stable[rows, chosen]
    return WorstStates(
        speed=spin,
        amplitude=np.where(stable, sizes[rows, chosen], most),
        stable=stable,
        growth=np.where(found, states.growth[rows, chosen], np.inf),
        balanced=np.asarray((rests & states.stable).any(axis=1)),
        balanced_growth=np.where(
            rests.any(axis=1), np.where(rests, states.growth, np.inf).min(axis=1), np.nan
        ),
        coordinates=states.coordinates[rows, chosen],
    )


def gathered_amplitude(scene: Scene, speed: Array) -> Array:
    """Amplitude with all balls where they add most to the unbalance [theory: races, eq. 15], m, shape (s,).

    In the plane where it is largest, of those of all chambers. It bounds every motion in which the balls rest
    in the drum; liquid is left out.
    """
    system = dry_rotor(scene).system()
    machine = RotorWithBalls(system, tuple(race.race() for race in scene.balls))
    loads = np.vstack((system.unbalance[None], machine.push))
    each = np.einsum("sij,lj->lsi", machine.compliance(speed), loads)
    found = []
    for plane in planes_of(scene):
        ways = [orbit(system, coordinates, plane) for coordinates in each]
        found.append(np.sum([np.abs(way.forward) + np.abs(way.backward) for way in ways], axis=0))
    return np.asarray(np.max(found, axis=0))


class Parts(NamedTuple):
    """Dry rotor, races, liquid, gravity along the axis and the model of the liquid."""

    system: RotorSystem
    races: tuple[BallRace, ...]
    fills: tuple[Fill, ...]
    gravity: float
    model: LiquidModel

    def at(self, speed: float) -> Machine:
        """The machine at a speed, with the liquid in step [theory: races, eq. 8]."""
        require_positive("speed", speed)  # a curve that is followed may lead out of the chart
        system = in_step(self.system, self.fills, speed, self.gravity, self.model)
        return Machine(system, self.races, speed)


def parts_of(scene: Scene) -> Parts:
    """What a scene's machine is made of at every speed."""
    races = tuple(race.race() for race in scene.balls)
    return Parts(dry_rotor(scene).system(), races, scene.fills, axial_gravity(scene), liquid_beside(scene)[1])


def own_family(scene: Scene) -> Family:
    """The scene's machine at each speed, as it stands."""
    own = parts_of(scene)
    return lambda speed, _: own.at(speed)
