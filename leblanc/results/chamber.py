"""A chamber with its liquid, as figures and reports show it."""

from __future__ import annotations

from dataclasses import dataclass

from meshes.baffles import Baffles
from meshes.chamber_section import ChamberSection, layer_depth


@dataclass(frozen=True)
class FilledChamber:
    """One chamber with its liquid.

    Parameters
    ----------
    radius, inner_radius, height, mean_surface_radius : m; the last one of the undisturbed layer
    volume : of the liquid, m^3
    liquid_name : as the scene names it
    plane : position along the axis where that matters, m
    baffles : None without any
    section : None for circular walls
    """

    radius: float
    inner_radius: float
    height: float
    volume: float
    liquid_name: str
    mean_surface_radius: float
    plane: float = 0.0
    baffles: Baffles | None = None
    section: ChamberSection | None = None

    @property
    def least_depth(self) -> float:
        """Depth of the undisturbed layer where it is thinnest, m."""
        area = self.volume / self.height
        if self.section is not None and 0.0 < area < self.section.area:
            return layer_depth(self.section, area)
        return self.radius - self.mean_surface_radius
