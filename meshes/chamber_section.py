"""Section of a chamber of any shape, and where the free surface of the liquid in it lies at fast spin."""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass, field
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:  # what cuts meshes is loaded where a section is given
    from meshes.liquid_section import LiquidSection
    from meshes.section import Section


# Relative change of the radius over which the length of the free surface is measured, and what of the circle
# may be missing.
_STEP, _WHOLE = 1e-4, 1e-3


@dataclass(frozen=True)
class ChamberSection:
    """Section with a name; two with the same content are equal. Made by `chamber_section`."""

    name: str = field(compare=False)  #: of the file it came from
    digest: str  #: fingerprint of its nodes and triangles
    mesh: Section = field(compare=False, repr=False)  #: the section, about the geometric axis
    #: at the walls of an outline that was meshed for it, m; None for a mesh from a file
    cell_size: float | None = field(default=None, compare=False)

    @property
    def area(self) -> float:
        """Area of the section, m^2."""
        from meshes.section import section_area

        return section_area(self.mesh)

    @property
    def farthest(self) -> float:
        """Distance of the farthest point of the wall from the axis, m."""
        from meshes.refine.waterline import distance_range, monotone_arcs

        arcs = monotone_arcs(self.mesh, (0.0, 0.0))
        return math.sqrt(float(distance_range(arcs, len(self.mesh.triangles))[1].max()))


def chamber_section(name: str, mesh: Section, cell_size: float | None = None) -> ChamberSection:
    """Give a section its name and fingerprint."""
    content = hashlib.sha256()
    for array in (mesh.points.astype("<f8"), mesh.triangles.astype("<i8")):
        content.update(np.ascontiguousarray(array).tobytes())
    return ChamberSection(name, content.hexdigest(), mesh, cell_size)


@lru_cache(maxsize=1024)
def level(section: ChamberSection, liquid_area: float) -> tuple[float, float]:
    """Free surface of an area of liquid, the volume over the height.

    Radius a of the surface, m, and the part of the circle r = a inside the section, 1 if it meets no wall.
    """
    from meshes.refine.waterline import area_outside, surface_radius_of

    radius = surface_radius_of(section.mesh, liquid_area)
    step = min(_STEP, 0.1 * (section.farthest - radius) / radius) * radius
    taken = area_outside(section.mesh, radius - step) - area_outside(section.mesh, radius + step)
    return radius, taken / (4.0 * math.pi * radius * step)


def surface_is_whole(section: ChamberSection, liquid_area: float) -> bool:
    """Whether the free surface is a full circle, which meets no wall."""
    return abs(level(section, liquid_area)[1] - 1.0) < _WHOLE


@lru_cache(maxsize=1024)
def layer_depth(section: ChamberSection, liquid_area: float) -> float:
    """Depth of the layer where it is thinnest: from the free surface to the nearest wall outside it, m."""
    radius, _ = level(section, liquid_area)
    liquid = liquid_of(section, radius)
    wall = liquid.points[np.unique(liquid.wall)]
    return float(np.hypot(*wall.T).min()) - radius


@lru_cache(maxsize=64)
def liquid_of(section: ChamberSection, surface_radius: float) -> LiquidSection:
    """Mesh of the liquid at rest, with curved sides."""
    from meshes.refine.waterline import liquid_outside

    size = min(2.0 * math.pi * surface_radius / 64.0, 0.5 * (section.farthest - surface_radius))
    return liquid_outside(section.mesh, surface_radius, order=2, surface_size=size, wall_size=size)


def rest_offset(section: ChamberSection, liquid_area: float) -> float:
    """Distance of the centre of mass of the liquid at rest from the axis, by its triangles' corners, m."""
    liquid = liquid_of(section, level(section, liquid_area)[0])
    corners = liquid.points[liquid.cells[:, :3]]
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    weight = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    return float(np.hypot(*(weight @ corners.mean(axis=1) / weight.sum())))
