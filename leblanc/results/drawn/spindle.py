"""A spindle unit as a picture draws it: beams in a natural motion, masses, joints and named stations."""

from __future__ import annotations

from dataclasses import dataclass

from meshes.arrays import Array


@dataclass(frozen=True)
class DrawnSection:
    """A round piece of a beam."""

    start: float  #: along the machine, m
    end: float
    diameter: float  #: m
    bore: float


@dataclass(frozen=True)
class DrawnBeam:
    """A beam."""

    name: str  #: of it
    sections: tuple[DrawnSection, ...]  #: from its first station on
    #: 0 on the axis of the first beam; 1 and more stand beside it, as their bore has no room for it
    level: int
    place: Array  #: along the machine, m, and what the natural motion has there, the largest of all 1
    deflection: Array

    @property
    def radius(self) -> float:
        """Of its widest section, m."""
        return 0.5 * max(section.diameter for section in self.sections)


@dataclass(frozen=True)
class DrawnMass:
    """A body on a beam, as a disc of steel with its mass and its inertia."""

    beam: int  #: its number
    place: float  #: along the machine, m
    radius: float  #: of the disc, m
    thickness: float


@dataclass(frozen=True)
class DrawnJoint:
    """A spring between two beams, or to the ground."""

    first: int  #: numbers of the beams; None for the ground
    second: int | None
    place: float  #: along the machine, m


@dataclass(frozen=True)
class DrawnStation:
    """A station with a part in the answer."""

    name: str  #: what happens there
    beam: int  #: its number
    place: float  #: along the machine, m


@dataclass(frozen=True)
class SpindleView:
    """A spindle unit in one of its natural motions."""

    name: str  #: of the scene
    assumed: bool  #: some of its values are
    number: int  #: which natural motion of the band, from 1, and how many there are
    count: int
    frequency: float  #: rad/s
    beams: tuple[DrawnBeam, ...]  #: as drawn
    masses: tuple[DrawnMass, ...]
    joints: tuple[DrawnJoint, ...]
    stations: tuple[DrawnStation, ...]
    factor: float  #: largest deflection as drawn, m; the true one is any small number

    def to_json(self) -> dict[str, object]:
        """What `leblanc view --json` prints of a spindle unit, SI."""
        return {
            "mode": self.number,
            "frequency": self.frequency,
            "beams": [beam.name for beam in self.beams],
            "level": [beam.level for beam in self.beams],
            "largest_deflection_drawn": self.factor,
        }
