"""Pictures of the liquid's own oscillations: a mode of sloshing in a chamber of the machine."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from fluid.fill import Fill
from leblanc.results.provenance import one_line
from leblanc.scene.scene import Scene
from leblanc.studies.prepare import across_gravity
from leblanc.units import RPM
from leblanc.view.bodies import LiquidBodies
from leblanc.view.film import Film
from leblanc.view.parts import Instant, Picture, Stage
from leblanc.view.scale import Scale, inner_room
from leblanc.view.scene import compose
from leblanc.view.surfaces import LiquidShape
from meshes.arrays import Array, Complex
from meshes.bodies.body import columns
from meshes.chamber_section import surface_is_whole
from meshes.errors import InputError
from meshes.liquid_section import LiquidSection
from meshes.refine.waterline_cut import liquid_outside
from meshes.rings.quadrilaterals import ring
from solvers.sloshing.modes import SloshingModes, sloshing_modes
from solvers.sloshing.system import condense

MOST_MODES = 40
AROUND, ACROSS = 120, 4  # elements around and across the layer
LIFT = 0.6  # of the layer's depth, or of the room inside it: displacement as drawn
ROUND = 48  # frames of a period


@dataclass(frozen=True)
class Mode:
    """One oscillation of the liquid in a spinning chamber, m(t) = Re(mode e^{-i sigma t}).

    Parameters
    ----------
    number : from 1, by rising size of the frequency
    frequency : sigma seen from the drum, with the spin positive, rad/s
    crests : around the drum
    angle : of the rays, rising, rad, shape (n,); two at a baffle
    displacement : of the surface along the radius, its largest size 1, shape (n,)
    fill : the chamber with its liquid
    speed : of the spin, rad/s
    converged : of the solver
    moved : the liquid at rest with the displacement of each of its nodes; None between circular walls
    """

    number: int
    frequency: float
    crests: int
    angle: Array
    displacement: Complex
    fill: Fill
    speed: float
    converged: bool
    moved: tuple[LiquidSection, Complex] | None = None


def solve_mode(scene: Scene, number: int, speed: float | None = None, chamber: int = 1) -> Mode:
    """A mode of the liquid in one chamber of a scene, by finite elements [theory: sloshing, eq. 10-12].

    Parameters
    ----------
    scene : the machine
    number : which mode, from 1 by rising size of the frequency
    speed : spin, rad/s; the scene's last if None
    chamber : which one, from 1

    Raises
    ------
    InputError : no such chamber or mode, no free surface, a speed that is not above 0
    """
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
    section = _liquid(fill)
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
    return Mode(
        number,
        float(modes.frequency[number - 1]),
        int(modes.crests[number - 1]),
        angle,
        modes.displacement[number - 1][nodes],
        fill,
        spin,
        bool(modes.converged),
        None if fill.chamber.section is None else (section, _spread(section, modes, number)),
    )


def _liquid(fill: Fill) -> LiquidSection:
    """Mesh of the liquid at rest."""
    size = fill.surface_radius
    if fill.chamber.section is None:
        return ring(fill.chamber.radius, size, AROUND, ACROSS, baffles=fill.chamber.baffles)
    side = 4.0 * math.pi * size / AROUND  # bisection makes sides up to half as long
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


def _moment(displacement: Complex, phase: float, lift: float) -> Array:
    """Displacement at a phase, m."""
    return np.asarray(lift * (displacement * np.exp(-1j * phase)).real)


def _body_of(mode: Mode, phase: float, lift: float) -> LiquidBodies:
    """Liquid of a mode between walls of any shape."""
    assert mode.moved is not None
    section, displacement = mode.moved
    moved = _moment(displacement, phase, lift)
    away = np.hypot(*section.points.T)
    # As on the surface of a ring: the area per angle swings.
    points = section.points * np.sqrt(1.0 + 2.0 * moved / away)[:, None]
    surface = np.zeros(len(points), dtype=bool)
    surface[section.surface] = True
    height = mode.fill.chamber.height
    full, none = np.full(len(points), height), np.zeros(len(points), dtype=bool)
    body = columns(points, section.cells, full, height, none, surface, layers=1, order=2)
    return LiquidBodies(0j, (body,))


def shape_of(mode: Mode, phase: float, lift: float) -> LiquidShape | LiquidBodies:
    """Liquid of a mode at a phase of its oscillation; the area per angle swings, so that the volume stays.

    Parameters
    ----------
    mode : the oscillation
    phase : sigma t, rad
    lift : largest displacement, m
    """
    if mode.moved is not None:
        return _body_of(mode, phase, lift)
    chamber, size = mode.fill.chamber, mode.fill.surface_radius
    moved = _moment(mode.displacement, phase, lift)
    free = np.sqrt(np.maximum(size**2 + 2.0 * size * moved, chamber.inner_radius**2))
    free = np.minimum(free, chamber.radius)[:, None]
    count = mode.angle.size
    outer, inner = np.full(count, chamber.radius), np.full(count, chamber.inner_radius)
    height = np.repeat(np.array([[0.0, chamber.height]]), count, axis=0)
    return LiquidShape(0j, mode.angle, inner, outer, np.repeat(free, 2, axis=1), height)


def drawn_lift(mode: Mode) -> float:
    """Largest displacement as drawn, m; the true one is any small number.

    Parameters
    ----------
    mode : the oscillation
    """
    return LIFT * min(mode.fill.depth, inner_room(mode.fill))


def mode_picture(scene: Scene, mode: Mode, phase: float = 0.0) -> Picture:
    """Picture of a mode at a phase of its oscillation.

    Parameters
    ----------
    scene : the machine
    mode : the oscillation
    phase : sigma t, rad
    """
    place = 0.0
    lying = scene.rotor.axis == "horizontal"
    stage = Stage((mode.fill,), (place,), lying, Scale(), 0.0, zero="", gravity=not lying)
    sense = "with the spin" if mode.frequency > 0.0 else "against the spin"
    crests = f"{mode.crests} crest{'s' if mode.crests > 1 else ''}"
    if mode.fill.chamber.section is not None:
        crests = f"between walls of its own shape; of its harmonics the strongest has {crests}"
    if mode.fill.chamber.baffles is not None:
        crests = f"between baffles; of its harmonics the strongest has {crests}"
    caption = [
        "The wave is drawn much higher than it is; its true height is any small one.",
        "Seen from the drum.",
    ]
    if across_gravity(scene) > 0.0:
        caption.append("Gravity across the axis is left out.")
    instant = Instant(
        deflection=(0j,),
        lean=0j,
        bodies=(shape_of(mode, phase, drawn_lift(mode)),),
        title=f"{one_line(scene.name)}: sloshing mode {mode.number} at {mode.speed * RPM:.4g} rpm",
        state=f"{crests} around, {sense}\n{abs(mode.frequency):.4g} rad/s seen from the drum",
        caption=" ".join(caption),
    )
    return compose(stage, instant)


def mode_film(scene: Scene, mode: Mode, frames: int = ROUND) -> Film:
    """One period of a mode.

    Parameters
    ----------
    scene, mode : the machine, the oscillation
    frames : of the period
    """
    sense = 1.0 if mode.frequency > 0.0 else -1.0
    # The phase sigma t runs backwards for a wave against the spin.
    return Film(frames, lambda k: mode_picture(scene, mode, sense * 2.0 * math.pi * k / frames))
