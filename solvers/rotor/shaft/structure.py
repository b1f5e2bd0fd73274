"""Beams of sections, masses on them, joints between them: the machine at one frequency.

A station is where a section begins or ends: (number of the beam, number of the station), both from 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import accumulate, pairwise

import numpy as np

from meshes.arrays import Array, Complex, Index
from meshes.errors import InputError, require_not_negative
from solvers.rotor.shaft.section import Section, stiffness_matrices, transfer_matrices

Station = tuple[int, int]

_BLOCK = 2**22  # numbers of the matrices that are held at once


@dataclass(frozen=True)
class PointMass:
    """A body at a station."""

    station: Station  #: where
    mass: float  #: kg
    inertia: float = 0.0  #: across the axis, kg m^2
    polar_inertia: float = 0.0  #: about the axis, kg m^2, of what spins; 0 for what does not


@dataclass(frozen=True)
class Joint:
    """A spring with a damper between two stations, or between a station and the ground."""

    first: Station  #: what it joins; the ground where the second is None
    second: Station | None
    stiffness: float  #: across the axis, N/m and N s/m
    damping: float = 0.0
    angular_stiffness: float = 0.0  #: N m and N m s
    angular_damping: float = 0.0

    def dynamic(self, frequency: Array, damped: bool = True) -> tuple[Complex, Complex]:
        """k + i omega c across the axis and of the slope, shape (n,) each."""
        rate: Complex = 1j * np.asarray(frequency, dtype=float) * damped
        across: Complex = self.stiffness + rate * self.damping
        turning: Complex = self.angular_stiffness + rate * self.angular_damping
        return across, turning


@dataclass(frozen=True)
class Structure:
    """Beams with what sits on them and what joins them.

    Examples
    --------
    >>> from solvers.rotor.shaft.section import round_section
    >>> shaft = (round_section(0.25, 0.02), round_section(0.25, 0.02))
    >>> pinned = Structure((shaft,), joints=(Joint((0, 0), None, 1e12), Joint((0, 2), None, 1e12)))
    >>> middle = compliances(pinned, np.array([0.0]), [Coordinate((0, 1))], [Coordinate((0, 1))])
    >>> f"{middle[0, 0, 0].real:.3e} m/N"  # L^3/(48 E I) and the shear
    '1.584e-06 m/N'
    """

    beams: tuple[tuple[Section, ...], ...]  #: sections of each beam from its first station on
    masses: tuple[PointMass, ...] = ()  #: at stations
    joints: tuple[Joint, ...] = ()

    def __post_init__(self) -> None:
        if not self.beams or not all(self.beams):
            raise InputError("beams", len(self.beams), "one or more, each of one section or more")
        for mass in self.masses:
            self.require(mass.station)
            for name in ("mass", "inertia", "polar_inertia"):
                require_not_negative(name, getattr(mass, name))
        for joint in self.joints:
            self.require(joint.first)
            if joint.second is not None:
                self.require(joint.second)
            if joint.first == joint.second:
                raise InputError("joint", joint.first, "between two different stations, or to the ground")
            for name in ("stiffness", "damping", "angular_stiffness", "angular_damping"):
                require_not_negative(name, getattr(joint, name))

    def require(self, station: Station) -> None:
        """Raise `InputError` unless the station is there."""
        beam, place = station
        if not (0 <= beam < len(self.beams) and 0 <= place <= len(self.beams[beam])):
            sizes = ", ".join(str(len(sections)) for sections in self.beams)
            raise InputError("station", station, f"(beam, station), the last stations being {sizes}")


@dataclass(frozen=True)
class Coordinate:
    """One motion of a station, and the force or the moment along it."""

    station: Station  #: where
    slope: bool = False  #: the slope and the moment; else the deflection and the force


@dataclass(frozen=True)
class Nodes:
    """Where the pieces of all sections meet, numbered along one beam after the other."""

    pieces: tuple[tuple[int, ...], ...]  #: of how many equal pieces each section of each beam is made

    @property
    def starts(self) -> tuple[int, ...]:
        """First node of each beam, and the number of all nodes."""
        return tuple(accumulate((sum(beam) + 1 for beam in self.pieces), initial=0))

    @property
    def count(self) -> int:
        """Number of nodes."""
        return self.starts[-1]

    def of(self, station: Station) -> int:
        """Node at a station."""
        beam, place = station
        return self.starts[beam] + sum(self.pieces[beam][:place])

    def index(self, coordinate: Coordinate) -> int:
        """Row of a coordinate in the matrices."""
        return 2 * self.of(coordinate.station) + coordinate.slope


def nodes_up_to(structure: Structure, frequency: float, spin: float = 0.0, least: int = 1) -> Nodes:
    """Nodes so close that no piece resonates between clamped ends up to a frequency [theory: spindle, eq. 9].

    At least `least` pieces of each section; an `InputError` from the cutoff of shear waves on.
    """
    largest = max(frequency, 1e-9)
    return Nodes(
        tuple(
            tuple(max(least, section.pieces(largest, spin)) for section in beam) for beam in structure.beams
        )
    )


def dynamic_stiffness(
    structure: Structure, nodes: Nodes, frequency: Array, spin: float = 0.0, damped: bool = True
) -> Complex:
    """Forces on all nodes over their motions, at each frequency [theory: spindle, eq. 10].

    Symmetric, shape (n, 2 nodes, 2 nodes), the deflection of a node before its slope. With a spin the motion
    is a circular whirl, forward where both have one sign.
    """
    omega = np.asarray(frequency, dtype=float)
    size = 2 * nodes.count
    found = np.zeros((omega.size, size, size), dtype=complex)
    for beam, sections in enumerate(structure.beams):
        node = nodes.starts[beam]
        for section, count in zip(sections, nodes.pieces[beam], strict=True):
            length = section.length / count
            piece = stiffness_matrices(transfer_matrices(section, length, omega, spin))
            for _ in range(count):
                here = slice(2 * node, 2 * node + 4)
                found[:, here, here] += piece
                node += 1
    for mass in structure.masses:
        row = 2 * nodes.of(mass.station)
        found[:, row, row] -= mass.mass * np.square(omega)
        turning = mass.inertia * np.square(omega) - mass.polar_inertia * spin * omega
        found[:, row + 1, row + 1] -= turning
    for joint in structure.joints:
        for slope, stiffness in enumerate(joint.dynamic(omega, damped)):
            first = 2 * nodes.of(joint.first) + slope
            found[:, first, first] += stiffness
            if joint.second is not None:
                second = 2 * nodes.of(joint.second) + slope
                found[:, second, second] += stiffness
                found[:, first, second] -= stiffness
                found[:, second, first] -= stiffness
    return found


def scales(matrices: Complex) -> Array:
    """Factors of rows and columns with which forces and moments are of one size, shape (m,)."""
    sizes = np.abs(np.diagonal(matrices, axis1=-2, axis2=-1)).max(axis=0)
    return np.asarray(1.0 / np.sqrt(np.where(sizes > 0.0, sizes, 1.0)))


def compliances(
    structure: Structure,
    frequency: Array,
    motions: list[Coordinate],
    loads: list[Coordinate],
    spin: float = 0.0,
) -> Complex:
    """Motion of some coordinates over a unit force or moment at others [theory: spindle, eq. 10].

    Shape (n, motions, loads): m/N, rad/N, m/(N m) or rad/(N m), for force and motion as e^(i omega t); with a
    spin both turn in one sense. An `InputError` beyond the cutoff, or where the machine without damping
    answers without bounds.
    """
    omega = np.asarray(frequency, dtype=float).reshape(-1)
    if not np.all(np.isfinite(omega)):
        raise InputError("frequency", omega.tolist(), "finite numbers")
    for coordinate in (*motions, *loads):
        structure.require(coordinate.station)
    nodes = nodes_up_to(structure, float(np.abs(omega).max(initial=0.0)), spin)
    rows, columns = ([nodes.index(entry) for entry in part] for part in (motions, loads))
    force = np.zeros((2 * nodes.count, len(loads)))
    force[columns, range(len(loads))] = 1.0
    found = np.empty((omega.size, len(motions), len(loads)), dtype=complex)
    block = max(1, _BLOCK // (2 * nodes.count) ** 2)
    for first, last in pairwise([*range(0, omega.size, block), omega.size]):
        matrices = dynamic_stiffness(structure, nodes, omega[first:last], spin)
        size = scales(matrices)
        scaled = matrices * size[:, None] * size
        try:
            answer = np.linalg.solve(scaled, size[:, None] * force)
        except np.linalg.LinAlgError as error:
            text = "off the natural frequencies of a machine without damping, 0 of a free one among them"
            raise InputError("frequency", omega[first:last].tolist(), text) from error
        found[first:last] = (size[:, None] * answer)[:, rows]
    return found


def motion_at(structure: Structure, nodes: Nodes, motion: Array) -> list[tuple[Array, Array]]:
    """Deflection along each beam.

    Place from the first station, m, and deflection, of each beam, from the motion of all nodes.
    """
    found = []
    for beam, sections in enumerate(structure.beams):
        lengths = [
            section.length / count
            for section, count in zip(sections, nodes.pieces[beam], strict=True)
            for _ in range(count)
        ]
        here: Index = np.arange(nodes.starts[beam], nodes.starts[beam + 1])
        found.append((np.cumsum([0.0, *lengths]), motion[2 * here]))
    return found
