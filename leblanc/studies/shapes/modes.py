"""A mode of sloshing in a chamber of the machine, as a picture draws it."""

from __future__ import annotations

import math

import numpy as np
from scipy.spatial import cKDTree

from fluid.fill import Fill
from leblanc.results.drawn import ModeView
from leblanc.scene.scene import Scene
from leblanc.studies.prepare import across_gravity
from leblanc.studies.shapes.scale import inner_room
from meshes.arrays import Complex
from meshes.chamber_section import surface_is_whole
from meshes.errors import InputError
from meshes.liquid_section import LiquidSection
from meshes.refine.waterline import liquid_outside
from meshes.rings.quadrilaterals import ring
from solvers.sloshing.modes import SloshingModes, sloshing_modes
from solvers.sloshing.system import condense

MOST_MODES = 40
AROUND, ACROSS = 120, 4  # elements around and across the layer
LIFT = 0.6  # of the layer's depth, or of the room inside it: displacement as drawn


def mode_view(scene: Scene, number: int, speed: float | None = None, chamber: int = 1) -> ModeView:
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
    spin, fill = _checked(scene, number, speed, chamber)
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
    walled = fill.chamber.section is not None
    return ModeView(
        name=scene.name,
        lying=scene.rotor.axis == "horizontal",
        gravity=across_gravity(scene),
        number=number,
        frequency=float(modes.frequency[number - 1]),
        crests=int(modes.crests[number - 1]),
        angle=angle,
        displacement=modes.displacement[number - 1][nodes],
        lift=LIFT * min(fill.depth, inner_room(fill)),
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
