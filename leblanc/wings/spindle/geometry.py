"""A spindle unit as a picture draws it: beams in a natural motion, masses, joints and named stations."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import accumulate
from typing import ClassVar

import numpy as np

from leblanc.scene.scene import Scene
from leblanc.scene.spindle import Beam, Spindle, SpindleMass
from leblanc.wings.spindle.study import places_of
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.rotor.shaft.natural import modes

STEEL = 7850.0  # kg/m^3, of the discs that stand for masses
_WIDE = 1.5  # radius of a disc without inertia over the beam's
SHOWN = 0.06  # largest deflection as drawn over the length of the machine
_TOUCH = 1e-9  # m, by which sections that meet may overlap


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

    picture: ClassVar = "leblanc.view.spindle:spindle_picture"
    film: ClassVar = "leblanc.view.spindle:spindle_film"

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


def spindle_view(
    scene: Scene, number: int | None = None, speed: float | None = None, factor: float | None = None
) -> SpindleView:
    """A spindle unit in one of the natural motions of its band."""
    rotor = scene.rotor
    if not isinstance(rotor, Spindle):
        raise InputError("rotor.kind", rotor.kind, "spindle for this")
    if factor is not None and not (math.isfinite(factor) and factor > 0.0):
        raise InputError("--factor", factor, "a finite number above 0")
    if speed is not None and not (math.isfinite(speed) and speed > 0.0):
        raise InputError("--speed", speed, "a finite number above 0")
    machine, band = rotor.machine(), scene.speed_array()
    found = modes(machine, float(band[0]), float(band[-1]))
    if not found:
        raise InputError("speeds.stop", float(band[-1]), "such that a natural frequency lies in the band")
    if speed is not None:
        number = 1 + int(np.argmin([abs(mode.frequency - speed) for mode in found]))
    chosen = 1 if number is None else number
    if not 1 <= chosen <= len(found):
        raise InputError("--mode", chosen, f"a whole number from 1 to {len(found)}, the natural motions here")
    mode, places = found[chosen - 1], places_of(machine)
    sections = [_sections(beam, place) for beam, place in zip(rotor.beams, places, strict=True)]
    levels = levels_of(sections)
    starts = [[place, *(section.end for section in own)] for place, own in zip(places, sections, strict=True)]

    def at(name: str) -> tuple[int, float]:
        beam, station = rotor.station(name)
        return beam, starts[beam][station]

    beams = tuple(
        DrawnBeam(beam.name, own, level, place + along, deflection)
        for beam, own, level, place, (along, deflection) in zip(
            rotor.beams, sections, levels, places, mode.along, strict=True
        )
    )
    length = max(max(row) for row in starts) - min(min(row) for row in starts)
    roles = (("force", rotor.driven), ("measured", rotor.measured), ("wanted", rotor.wanted))
    return SpindleView(
        name=scene.name,
        assumed=bool(scene.assumed),
        number=chosen,
        count=len(found),
        frequency=mode.frequency,
        beams=beams,
        masses=tuple(_disc(part, *at(part.station), sections) for part in rotor.masses),
        joints=tuple(
            DrawnJoint(
                at(joint.station)[0], None if joint.to == "ground" else at(joint.to)[0], at(joint.station)[1]
            )
            for joint in rotor.joints
        ),
        stations=tuple(DrawnStation(name, *at(station)) for name, station in roles),
        factor=SHOWN * length * (1.0 if factor is None else factor),
    )


def _sections(beam: Beam, place: float) -> tuple[DrawnSection, ...]:
    """Sections of a beam along the machine."""
    ends = list(accumulate((section.length for section in beam.sections), initial=place))
    return tuple(
        DrawnSection(ends[k], ends[k + 1], section.diameter, section.bore)
        for k, section in enumerate(beam.sections)
    )


def levels_of(beams: list[tuple[DrawnSection, ...]]) -> list[int]:
    """Level of each beam: on the axis as long as no two would lie in one another, else beside it."""
    levels: list[int] = []
    for own in beams:
        level = 0
        while any(
            other_level == level and not _have_room(own, other)
            for other, other_level in zip(beams, levels, strict=False)
        ):
            level += 1
        levels.append(level)
    return levels


def _have_room(first: tuple[DrawnSection, ...], second: tuple[DrawnSection, ...]) -> bool:
    """Wherever both are, one of them lies inside the other's bore."""
    return all(
        a.diameter <= b.bore or b.diameter <= a.bore
        for a in first
        for b in second
        if min(a.end, b.end) - max(a.start, b.start) > _TOUCH
    )


def _disc(part: SpindleMass, beam: int, place: float, beams: list[tuple[DrawnSection, ...]]) -> DrawnMass:
    """A thin disc of steel with the mass of a body and its inertia across the axis, m R^2/4."""
    wide = 0.5 * _WIDE * max(section.diameter for section in beams[beam])
    radius = 2.0 * math.sqrt(part.inertia / part.mass) if part.inertia > 0.0 else wide
    return DrawnMass(beam, place, radius, part.mass / (STEEL * math.pi * radius**2))
