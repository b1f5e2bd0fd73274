"""What pictures of a machine need of its answer: where every chamber is at some speeds."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fluid.fill import Fill
from leblanc.results.response import RunResult
from leblanc.scene.machine import dry_rotor
from leblanc.scene.scene import JeffcottRotor, Scene, Speeds
from leblanc.studies.choose import choose, liquid_models
from leblanc.studies.prepare import axial_gravity
from leblanc.studies.run import run_scene
from meshes.arrays import Array, Complex
from meshes.errors import InputError
from solvers.rotor.vibration import orbit
from solvers.synchronous.response import response

GAP = 0.25  # between chambers moved apart, over the wider one's radius


@dataclass(frozen=True)
class Sight:
    """A machine at some speeds; s speeds, c chambers. Angles count from the unbalance, in the drum frame.

    Parameters
    ----------
    record : what `run` says of them
    fills : the chambers with their liquid
    places : middle of each chamber along the axis as it is drawn, m
    moved : some of them are drawn apart although the scene gives them one plane
    gravity : along the axis, m/s^2
    deflection : of the axis at each chamber, m, nan where none was found, shape (s, c); shape (s, 1) without
        chambers
    lean : slope of the axis along itself, rad, shape (s,)
    """

    record: RunResult
    fills: tuple[Fill, ...]
    places: tuple[float, ...]
    moved: bool
    gravity: float
    deflection: Complex
    lean: Complex

    @property
    def speed(self) -> Array:
        """Spin speeds, rad/s, shape (s,)."""
        return self.record.response.speed

    @property
    def length(self) -> float:
        """From the first to the last chamber's middle, m."""
        return float(np.ptp(self.places)) if self.places else 0.0


def look_at(scene: Scene, speed: float | None = None) -> Sight:
    """Answer of a scene at one speed, or at all its own.

    Parameters
    ----------
    scene : the machine, no exciter
    speed : spin speed, rad/s; the scene's speeds if None

    Raises
    ------
    InputError : a speed that is not above 0, an exciter, a liquid model that does not answer this
    """
    if speed is not None:
        if not (math.isfinite(speed) and speed > 0.0):
            raise InputError("--speed", speed, "a finite number above 0")
        scene = scene.altered(speeds=Speeds.at(speed))
    record = run_scene(scene)
    places, moved = places_of(scene)
    deflection = np.where(np.isfinite(record.response.deflection), record.response.deflection, np.nan)[
        :, None
    ]
    if record.motion is not None and scene.fills:
        at = record.motion.chamber_forward
        deflection = np.where(np.isfinite(at), at, np.nan)
    elif scene.fills:
        deflection = np.repeat(deflection, len(scene.fills), axis=1)
    return Sight(record, scene.fills, places, moved, axial_gravity(scene), deflection, _lean(scene, record))


def _lean(scene: Scene, record: RunResult) -> Complex:
    """Slope of the axis, from its forward part at two places of the rigid rotor."""
    if isinstance(scene.rotor, JeffcottRotor):
        return np.zeros(record.response.speed.shape, dtype=complex)
    planes = np.array([fill.chamber.plane for fill in scene.fills])
    if planes.size and np.ptp(planes) > 0.0 and record.motion is not None:
        ends = [int(planes.argmin()), int(planes.argmax())]
        low, high = (record.motion.chamber_forward[:, k] for k in ends)
        known = np.isfinite(low) & np.isfinite(high)
        low, high = np.where(known, low, np.nan), np.where(known, high, np.nan)
        return np.asarray((high - low) / np.ptp(planes))
    rotor, models = dry_rotor(scene), liquid_models(choose(scene))
    found = response(rotor, scene.fills, scene.speed_array(), axial_gravity(scene), models)
    system = rotor.system()
    low, high = (orbit(system, found.coordinates, place).forward for place in (-0.5, 0.5))
    known = np.isfinite(low) & np.isfinite(high)
    return np.asarray(np.where(known, high, np.nan) - np.where(known, low, np.nan))


def places_of(scene: Scene) -> tuple[tuple[float, ...], bool]:
    """Middle of each chamber along the axis as drawn, and whether some were moved out of each other.

    A planar rotor's chambers that do not lie inside one another stand one behind the other.

    Parameters
    ----------
    scene : the machine
    """
    chambers = [fill.chamber for fill in scene.fills]
    if not isinstance(scene.rotor, JeffcottRotor):
        return tuple(one.plane for one in chambers), False
    stacks: list[list[int]] = []
    for k in sorted(range(len(chambers)), key=lambda k: -chambers[k].radius):
        for stack in stacks:
            if chambers[k].radius <= chambers[stack[-1]].inner_radius:
                stack.append(k)
                break
        else:
            stacks.append([k])
    places, behind = [0.0] * len(chambers), 0.0
    for stack in stacks:
        height = max(chambers[k].height for k in stack)
        middle = behind - 0.5 * height
        for k in stack:
            places[k] = middle
        behind -= height + GAP * max(one.radius for one in chambers)
    shift = 0.5 * (max(places) + min(places)) if places else 0.0
    return tuple(place - shift for place in places), len(stacks) > 1
