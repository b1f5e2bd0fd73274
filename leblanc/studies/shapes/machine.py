"""A machine in steady rotation as a picture draws it, its liquid at rest in the drum."""

from __future__ import annotations

import cmath
import math

import numpy as np

from fluid.fill import Fill
from leblanc.results.drawn import DrawnLiquid, Liquid, MachineMotion, MachineView, Scale
from leblanc.results.response import RunResult
from leblanc.scene.scene import JeffcottRotor, Scene, Speeds, dry_rotor
from leblanc.studies.choose import choose, liquid_models
from leblanc.studies.prepare import axial_gravity
from leblanc.studies.run import run_scene
from leblanc.studies.shapes.bodies import bodies_at_rest, is_cut, wall_is_dry
from leblanc.studies.shapes.layer import body_at_rest
from leblanc.studies.shapes.scale import drawn_volume, scale_of
from meshes.arrays import Complex
from meshes.errors import InputError
from solvers.rotor.vibration import orbit
from solvers.statics.hydrostatics import optimal_volume
from solvers.synchronous.response import response

GAP = 0.25  # between chambers moved apart, over the wider one's radius


def machine_motion(scene: Scene, speed: float | None = None) -> MachineMotion:
    """Answer of a scene at one speed, or at all its own.

    Parameters
    ----------
    scene : the machine, no exciter
    speed : spin speed, rad/s; the scene's speeds if None

    Raises
    ------
    InputError : a speed that is not above 0, an exciter, a liquid model that does not answer this
    """
    require_rotor(scene)
    if speed is not None:
        if not (math.isfinite(speed) and speed > 0.0):
            raise InputError("--speed", speed, "a finite number above 0")
        scene = scene.altered(speeds=Speeds.at(speed))
    record = run_scene(scene)
    places, moved = places_of(scene)
    found = record.response.deflection
    deflection = np.where(np.isfinite(found), found, np.nan)[:, None]
    if record.motion is not None and scene.fills:
        at = record.motion.chamber_forward
        deflection = np.where(np.isfinite(at), at, np.nan)
    elif scene.fills:
        deflection = np.repeat(deflection, len(scene.fills), axis=1)
    gravity, lean = axial_gravity(scene), _lean(scene, record)
    return MachineMotion(record, scene.fills, places, moved, gravity, deflection, lean)


def require_rotor(scene: Scene) -> None:
    """The scene has a rotor that whirls, and not a table with balls.

    Raises
    ------
    InputError : it is an exciter
    """
    if scene.rotor.kind == "exciter":
        allowed = "jeffcott, two_plane or tub for this; of an exciter only --screenshot shows a picture"
        raise InputError("rotor.kind", "exciter", allowed)


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


def machine_view(scene: Scene, speed: float | None = None, factor: float | None = None) -> MachineView:
    """A scene's machine at one speed and its liquid as drawn.

    Parameters
    ----------
    scene : the machine, no exciter
    speed : rad/s; the last of its speeds if None
    factor : of the deflection as drawn; chosen if None

    Raises
    ------
    InputError : a value out of its range, an exciter

    Examples
    --------
    >>> from leblanc.scene.scene import load_scene
    >>> view = machine_view(load_scene("examples/runup.toml"), speed=24.0)
    >>> view.liquid.scale.in_words()
    'Everything to scale.'
    """
    motion = machine_motion(scene, scene.speeds.stop if speed is None else speed)
    return MachineView(motion, drawn_liquid(motion, -1, scale_of(motion, factor)))


def drawn_liquid(motion: MachineMotion, index: int, scale: Scale) -> DrawnLiquid:
    """Liquid of a machine at one of its speeds, in equilibrium with the deflection as it is drawn.

    Parameters
    ----------
    motion, index : the machine, which of its speeds
    scale : of deflection and depth
    """
    chambers = range(len(motion.fills))
    return DrawnLiquid(
        scale,
        tuple(_body(motion, k, index, scale) for k in chambers),
        tuple(drawn_volume(fill, scale.depth) for fill in motion.fills),
        dry_walls(motion, index),
        dry_walls(motion, index, scale),
    )


def _body(motion: MachineMotion, k: int, index: int, scale: Scale) -> Liquid:
    """Liquid of a chamber at a speed; None if there is none."""
    fill, speed = motion.fills[k], float(motion.speed[index])
    if fill.volume == 0.0:
        return None
    volume = drawn_volume(fill, scale.depth)
    found = complex(motion.deflection[index, k])
    deflection = scale.deflection * found if cmath.isfinite(found) else 0j
    if is_cut(fill):
        return bodies_at_rest(fill, volume, deflection, speed, motion.gravity)
    return body_at_rest(fill.chamber, volume, deflection, speed, motion.gravity)


def dry_walls(motion: MachineMotion, index: int, scale: Scale | None = None) -> tuple[bool, ...]:
    """Whether the wall of each chamber is dry in part, in truth or as drawn [theory: statics, eq. 8].

    Parameters
    ----------
    motion, index : the machine, which of its speeds
    scale : of the drawing; None for the truth
    """
    factors = scale or Scale()
    moved = factors.deflection * motion.deflection[index]
    speed = float(motion.speed[index])
    return tuple(
        _is_dry(fill, complex(one), drawn_volume(fill, factors.depth), speed, motion.gravity)
        for fill, one in zip(motion.fills, moved, strict=False)
    )


def _is_dry(fill: Fill, moved: complex, volume: float, speed: float, gravity: float) -> bool:
    if fill.volume == 0.0 or not (0.0 < abs(moved) < math.inf):
        return False
    if is_cut(fill):
        return wall_is_dry(fill, volume, moved, speed, gravity)
    return bool(volume < optimal_volume(fill.chamber, abs(moved), speed, gravity))
