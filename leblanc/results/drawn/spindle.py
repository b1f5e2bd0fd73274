"""A spindle unit as a picture draws it: beams in a natural motion, masses, joints and named stations."""

from __future__ import annotations

from dataclasses import dataclass

from meshes.arrays import Array


@dataclass(frozen=True)
class DrawnSection:
    """A round piece of a beam.

    Parameters
    ----------
    start, end : along the machine, m
    diameter, bore : m
    """

    start: float
    end: float
    diameter: float
    bore: float


@dataclass(frozen=True)
class DrawnBeam:
    """A beam.

    Parameters
    ----------
    name : of it
    sections : from its first station on
    level : 0 on the axis of the first beam; 1 and more stand beside it, as their bore has no room for it
    place, deflection : along the machine, m, and what the natural motion has there, the largest of all 1
    """

    name: str
    sections: tuple[DrawnSection, ...]
    level: int
    place: Array
    deflection: Array

    @property
    def radius(self) -> float:
        """Of its widest section, m."""
        return 0.5 * max(section.diameter for section in self.sections)


@dataclass(frozen=True)
class DrawnMass:
    """A body on a beam, as a disc of steel with its mass and its inertia.

    Parameters
    ----------
    beam : its number
    place : along the machine, m
    radius, thickness : of the disc, m
    """

    beam: int
    place: float
    radius: float
    thickness: float


@dataclass(frozen=True)
class DrawnJoint:
    """A spring between two beams, or to the ground.

    Parameters
    ----------
    first, second : numbers of the beams; None for the ground
    place : along the machine, m
    """

    first: int
    second: int | None
    place: float


@dataclass(frozen=True)
class DrawnStation:
    """A station with a part in the answer.

    Parameters
    ----------
    name : what happens there
    beam : its number
    place : along the machine, m
    """

    name: str
    beam: int
    place: float


@dataclass(frozen=True)
class SpindleView:
    """A spindle unit in one of its natural motions.

    Parameters
    ----------
    name : of the scene
    assumed : some of its values are
    number, count : which natural motion of the band, from 1, and how many there are
    frequency : rad/s
    beams, masses, joints, stations : as drawn
    factor : largest deflection as drawn, m; the true one is any small number
    """

    name: str
    assumed: bool
    number: int
    count: int
    frequency: float
    beams: tuple[DrawnBeam, ...]
    masses: tuple[DrawnMass, ...]
    joints: tuple[DrawnJoint, ...]
    stations: tuple[DrawnStation, ...]
    factor: float

    def to_json(self) -> dict[str, object]:
        """What `leblanc view --json` prints of a spindle unit, SI."""
        return {
            "mode": self.number,
            "frequency": self.frequency,
            "beams": [beam.name for beam in self.beams],
            "level": [beam.level for beam in self.beams],
            "largest_deflection_drawn": self.factor,
        }
