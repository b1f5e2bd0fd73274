"""A chamber with its liquid, as answers have it."""

from __future__ import annotations

from dataclasses import dataclass

from meshes.baffles import Baffles
from meshes.chamber_section import ChamberSection, layer_depth


@dataclass(frozen=True)
class FilledChamber:
    """One chamber with its liquid."""

    radius: float  #: m; the last one of the undisturbed layer
    inner_radius: float
    height: float
    volume: float  #: of the liquid, m^3
    liquid_name: str  #: as the scene names it
    mean_surface_radius: float
    plane: float = 0.0  #: position along the axis where that matters, m
    baffles: Baffles | None = None  #: None without any
    section: ChamberSection | None = None  #: None for circular walls

    @property
    def least_depth(self) -> float:
        """Depth of the undisturbed layer where it is thinnest, m."""
        area = self.volume / self.height
        if self.section is not None and 0.0 < area < self.section.area:
            return layer_depth(self.section, area)
        return self.radius - self.mean_surface_radius
