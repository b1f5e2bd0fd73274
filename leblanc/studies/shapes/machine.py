"""A machine as a picture draws it: in steady rotation, run up, in a mode of its liquid; tables of balls."""

from __future__ import annotations

import math

import numpy as np
from scipy.spatial import cKDTree

from fluid.fill import Fill
from leblanc.liquid.choose import across_gravity, axial_gravity, choose, liquid_models
from leblanc.plotting.bodies import (
    DrawnLiquid,
    Liquid,
    MachineMotion,
    MachineView,
    ModeView,
    RunupView,
    Scale,
    TableView,
    film_factor,
    rounded_down,
)
from leblanc.scene.rotors import Machine, not_taken
from leblanc.scene.scene import Exciter, JeffcottRotor, Scene, Speeds, Spindle, dry_rotor
from leblanc.studies.run.answer import RunAnswer
from leblanc.studies.run.study import run_scene
from leblanc.studies.runup.answer import RunupAnswer, RunupFrames
from leblanc.studies.runup.study import runup_scene
from leblanc.studies.shapes.balls import drawn_races, ringed, side_by_side
from leblanc.studies.shapes.bodies import is_cut, wall_is_dry
from leblanc.studies.shapes.equilibrium import liquid_at, places_of
from leblanc.studies.shapes.layer import body_of_layer, body_of_pool
from leblanc.studies.shapes.scale import SHOWN, THIN, drawn_volume, given_scale, scale_of, wave_scale
from leblanc.studies.shapes.supports import machine_parts
from meshes.arrays import Array, Complex
from meshes.chamber_section import surface_is_whole
from meshes.errors import InputError
from meshes.liquid_section import LiquidSection
from meshes.refine.waterline import liquid_outside
from meshes.rings.quadrilaterals import ring
from solvers.rotor.exciter.machine import platform_motion, stuck_speeds
from solvers.rotor.vibration import orbit
from solvers.sloshing.modes import SloshingModes, sloshing_modes
from solvers.sloshing.system import condense
from solvers.statics.hydrostatics import optimal_volume
from solvers.synchronous.response import response

TURN = math.radians(18.0)  # most of the drum from one frame of a film to the next

SWING, MOST = 0.35, 100.0  # vibration as drawn over the track's radius, and the largest factor

VISIBLE = 0.04  # a largest deflection smaller than this over the radius is drawn larger

ENOUGH = 0.5  # of the factor that would show the deflection well

MOST_MODES = 40
AROUND_MODE, ACROSS = 120, 4  # elements around and across the layer


def machine_motion(scene: Scene, speed: float | None = None) -> MachineMotion:
    """Answer of a scene at one speed, or at all its own."""
    if isinstance(scene.rotor, Spindle | Machine):
        raise not_taken(scene.rotor.kind)
    if scene.rotor.kind == "exciter":
        raise not_taken("exciter", "; only --screenshot shows a picture of it")
    if speed is not None:
        if not (math.isfinite(speed) and speed > 0.0):
            raise InputError("--speed", speed, "a finite number above 0")
        scene = scene.altered(speeds=Speeds.at(speed))
    result = run_scene(scene)
    places, moved = places_of(scene)
    found = result.response.deflection
    deflection = np.where(np.isfinite(found), found, np.nan)[:, None]
    if result.motion is not None and scene.fills:
        at = result.motion.chamber_forward
        deflection = np.where(np.isfinite(at), at, np.nan)
    elif scene.fills:
        deflection = np.repeat(deflection, len(scene.fills), axis=1)
    gravity, lean = axial_gravity(scene), _lean(scene, result)
    parts = machine_parts(scene, places)
    return MachineMotion(result, scene.fills, places, moved, gravity, deflection, lean, parts)


def _lean(scene: Scene, result: RunAnswer) -> Complex:
    """Slope of the axis, from its forward part at two places of the rigid rotor."""
    if isinstance(scene.rotor, JeffcottRotor):
        return np.zeros(result.response.speed.shape, dtype=complex)
    planes = np.array([fill.chamber.plane for fill in scene.fills])
    if planes.size and np.ptp(planes) > 0.0 and result.motion is not None:
        ends = [int(planes.argmin()), int(planes.argmax())]
        low, high = (result.motion.chamber_forward[:, k] for k in ends)
        known = np.isfinite(low) & np.isfinite(high)
        low, high = np.where(known, low, np.nan), np.where(known, high, np.nan)
        return np.asarray((high - low) / np.ptp(planes))
    rotor, models = dry_rotor(scene), liquid_models(choose(scene))
    found = response(rotor, scene.fills, scene.speed_array(), axial_gravity(scene), models)
    system = rotor.system()
    low, high = (orbit(system, found.coordinates, place).forward for place in (-0.5, 0.5))
    known = np.isfinite(low) & np.isfinite(high)
    return np.asarray(np.where(known, high, np.nan) - np.where(known, low, np.nan))


def machine_view(scene: Scene, speed: float | None = None, factor: float | None = None) -> MachineView:
    """A scene's machine at one speed and its liquid as drawn."""
    motion = machine_motion(scene, scene.speeds.stop if speed is None else speed)
    return MachineView(motion, drawn_liquid(motion, -1, scale_of(motion, factor)))


def drawn_liquid(motion: MachineMotion, index: int, scale: Scale) -> DrawnLiquid:
    """Liquid of a machine at one of its speeds, in equilibrium with the deflection as it is drawn."""
    speed, found = float(motion.speed[index]), motion.deflection[index]
    return DrawnLiquid(
        scale,
        tuple(
            liquid_at(fill, complex(found[k]), speed, motion.gravity, scale)
            for k, fill in enumerate(motion.fills)
        ),
        tuple(drawn_volume(fill, scale.depth) for fill in motion.fills),
        dry_walls(motion, index),
        dry_walls(motion, index, scale),
    )


def dry_walls(motion: MachineMotion, index: int, scale: Scale | None = None) -> tuple[bool, ...]:
    """Whether the wall of each chamber is dry in part, in truth or as drawn [theory: statics, eq. 8]."""
    factors = scale or Scale()
    moved = factors.deflection * motion.deflection[index]
    speed = float(motion.speed[index])
    return tuple(
        _is_dry(fill, complex(deflection), drawn_volume(fill, factors.depth), speed, motion.gravity)
        for fill, deflection in zip(motion.fills, moved, strict=False)
    )


def _is_dry(fill: Fill, moved: complex, volume: float, speed: float, gravity: float) -> bool:
    if fill.volume == 0.0 or not (0.0 < abs(moved) < math.inf):
        return False
    if is_cut(fill):
        return wall_is_dry(fill, volume, moved, speed, gravity)
    return bool(volume < optimal_volume(fill.chamber, abs(moved), speed, gravity))


def table_view(scene: Scene, speed: float | None = None) -> TableView:
    """A table with balls at the moment when balls and unbalance both point along the vibration."""
    rotor = scene.rotor
    if not isinstance(rotor, Exciter):
        raise InputError("rotor.kind", rotor.kind, "exciter for this")
    spin = scene.speeds.stop if speed is None else speed
    if not (math.isfinite(spin) and spin > 0.0):
        raise InputError("--speed", spin, "a finite number above 0")
    machine = rotor.machine()
    numbers, unit = machine.dimensionless(), machine.natural_frequency
    stuck = float(stuck_speeds(np.array([spin / unit]), numbers)[0, 0])
    slow, fast = (abs(part) * machine.length for part in platform_motion(numbers, spin / unit, stuck))
    largest, track = slow + fast, rotor.balls.track_radius
    factor = float(f"{rounded_down(min(MOST, SWING * track / largest)):.6g}") if largest > 0.0 else 1.0
    return TableView(
        name=scene.name,
        speed=spin,
        stuck_speed=stuck * unit,
        slow=slow,
        fast=fast,
        track_radius=track,
        balls=rotor.balls.count,
        kind=rotor.balls.name,
        factor=factor,
    )


def runup_view(scene: Scene, frames: int, factor: float | None = None) -> RunupView:
    """Run a scene up and draw its layers."""
    result = runup_scene(scene, check=False, frames=frames)
    kept = result.frames
    assert kept is not None
    if factor is None:
        widest = max((fill.chamber.radius for fill in ringed(scene).fills), default=0.1)
        scale = runup_scale(widest, result, kept)
    else:
        scale = given_scale(factor, scene.fills, kept.deflection)
    turn, slower = strobe(kept.time, kept.speed)
    rings = ringed(scene)
    none = (None,) * len(scene.balls)
    bodies = tuple(
        tuple(_liquid(fill, scale, kept, k, j, float(turn[k])) for j, fill in enumerate(scene.fills)) + none
        for k in range(kept.time.size)
    )
    places, races = places_of(rings)[0], drawn_races(scene)
    parts = machine_parts(rings, places)
    balls = (
        np.stack([np.interp(kept.time, result.time, np.unwrap(way)) for way in result.ball_angle.T], axis=1)
        if races
        else np.zeros((kept.time.size, 0))
    )
    drawn = np.array([side_by_side(races, row) for row in balls])
    return RunupView(result, kept, rings.fills, places, scale, bodies, turn, slower, parts, races, drawn)


def strobe(time: Array, speed: Array) -> tuple[Array, float]:
    """Turn of the drum in each frame of a film, rad, and how many times slower than in truth it is."""
    steps = 0.5 * (speed[1:] + speed[:-1]) * np.diff(time)
    slower = max(1.0, float(steps.max(initial=0.0)) / TURN)
    # Rounded to two digits for print, upwards.
    slower = float(f"{1.05 * slower:.2g}") if slower > 1.0 else 1.0
    return np.concatenate([[0.0], np.cumsum(steps)]) / slower, slower


def runup_scale(radius: float, result: RunupAnswer, frames: RunupFrames) -> Scale:
    """One factor for deflections and depths, so that a surface round the axis at rest stays so as drawn.

    Where there is no room for it the deflection alone grows, so that the whirl can be seen.
    """
    largest = float(np.abs(frames.deflection).max())
    wanted = min(MOST, SHOWN * radius / largest) if largest > 0.0 else 1.0
    thin = any(c.radius - c.mean_surface_radius < THIN * c.radius for c in result.chambers if c.volume > 0.0)
    both = 1.0
    if result.races and not any(chamber.volume > 0.0 for chamber in result.chambers):
        return Scale(float(f"{rounded_down(max(1.0, wanted)):.6g}"))
    if thin or largest < VISIBLE * radius:
        fits = film_factor(result.chambers, frames.depth, frames.deflection)
        both = float(f"{max(1.0, min(fits, wanted)):.2g}")
    if both > ENOUGH * wanted:
        return Scale(both, both)
    # No room for a layer so much deeper.
    return Scale(float(f"{rounded_down(max(1.0, wanted)):.6g}"), both)


def _liquid(fill: Fill, scale: Scale, frames: RunupFrames, k: int, j: int, turn: float) -> Liquid:
    """Liquid of a chamber in a frame, seen from the drum, which has made that turn."""
    if fill.volume == 0.0:
        return None
    moved, depth = complex(scale.deflection * frames.deflection[k, j]), frames.depth[k, j]
    if np.isnan(depth).any():
        return body_of_pool(fill.chamber, fill.volume, moved, -0.5 * math.pi - turn)
    return body_of_layer(fill.chamber, moved, frames.theta, scale.depth * depth)


def mode_view(scene: Scene, number: int, speed: float | None = None, chamber: int = 1) -> ModeView:
    """A mode of the liquid in one chamber of a scene, by finite elements [theory: sloshing, eq. 10-12]."""
    spin, fill = _checked(scene, number, speed, chamber)
    section = _liquid_in_mode(fill)
    modes = sloshing_modes(condense(section), spin, number)
    place = np.full(len(section.points), -1)
    place[modes.surface_nodes] = np.arange(modes.surface_nodes.size)
    # Along each side the angle falls from its start to its end.
    sides = place[section.surface][:, [1, 2, 0]] if section.order == 2 else place[section.surface][:, ::-1]
    middle = section.points[section.surface[:, :2]].mean(axis=1)
    order = np.argsort(np.arctan2(middle[:, 1], middle[:, 0]))
    nodes = sides[order].ravel()
    points = section.points[modes.surface_nodes[nodes]]
    # Counted from the first side, so that the seam does not fall within a side.
    angle = np.unwrap(np.arctan2(points[:, 1], points[:, 0]))
    walled = fill.chamber.section is not None
    deeper, lift = wave_scale(fill)
    return ModeView(
        name=scene.name,
        lying=scene.rotor.axis == "horizontal",
        gravity=across_gravity(scene),
        number=number,
        frequency=float(modes.frequency[number - 1]),
        crests=int(modes.crests[number - 1]),
        angle=angle,
        displacement=modes.displacement[number - 1][nodes],
        lift=lift,
        depth_factor=deeper,
        fill=fill,
        speed=spin,
        converged=bool(modes.converged),
        section=section if walled else None,
        section_displacement=_spread(section, modes, number) if walled else None,
    )


def _checked(scene: Scene, number: int, speed: float | None, chamber: int) -> tuple[float, Fill]:
    """Spin and chamber of a mode, once they are found to have one."""
    if not 1 <= number <= MOST_MODES:
        raise InputError("--mode", number, f"a whole number from 1 to {MOST_MODES}")
    if not 1 <= chamber <= len(scene.fills):
        count = len(scene.fills)
        allowed = (
            f"from 1 to {count}, the chambers of this scene" if count else "left out: there is no chamber"
        )
        raise InputError("--chamber", chamber, allowed)
    spin = scene.speeds.stop if speed is None else speed
    if not (math.isfinite(spin) and spin > 0.0):
        raise InputError("--speed", spin, "a finite number above 0")
    fill = scene.fills[chamber - 1]
    size, inner = fill.surface_radius, fill.chamber.inner_radius
    if fill.volume == 0.0 or size <= inner * (1.0 + 1e-9) or size <= 1e-9 * fill.chamber.radius:
        raise InputError("--chamber", chamber, "one with liquid and a free surface")
    shape = fill.chamber.section
    area = fill.volume / fill.chamber.height
    # A baffle without thickness takes nothing from the circle, but leaves no depth.
    if shape is not None and not (surface_is_whole(shape, area) and fill.depth > 1e-6 * size):
        allowed = "one whose free surface meets no wall; `leblanc modes --out` draws the others"
        raise InputError("--chamber", chamber, allowed)
    return spin, fill


def _liquid_in_mode(fill: Fill) -> LiquidSection:
    """Mesh of the liquid at rest."""
    size = fill.surface_radius
    if fill.chamber.section is None:
        return ring(fill.chamber.radius, size, AROUND_MODE, ACROSS, baffles=fill.chamber.baffles)
    side = 4.0 * math.pi * size / AROUND_MODE  # bisection makes sides up to half as long
    return liquid_outside(fill.chamber.section.mesh, size, order=2, surface_size=side, wall_size=2.0 * side)


def _spread(section: LiquidSection, modes: SloshingModes, number: int) -> Complex:
    """Displacement of all nodes, that of the surface fading towards the walls, where there is none.

    Only for the eye: walls stay where they are and cells do not fold.
    """
    surface = modes.surface_nodes
    wall = np.setdiff1d(section.wall, surface)
    below, near = cKDTree(section.points[surface]).query(section.points)
    above, _ = cKDTree(section.points[wall]).query(section.points)
    share = np.divide(above, above + below, out=np.zeros_like(above), where=above + below > 0.0)
    share[wall], share[surface] = 0.0, 1.0
    return np.asarray(share * modes.displacement[number - 1][near])
