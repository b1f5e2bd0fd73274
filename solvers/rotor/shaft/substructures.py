"""The way of the source: compliances of free beams by transfer matrices, reactions in the joints.

Products of transfer matrices lose digits as waves grow along a beam, and free beams have rigid motions that
grow without bounds towards rest. This way checks `structure`, which has neither fault, and gives what each
joint carries.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshes.arrays import Array, Complex
from meshes.errors import InputError
from solvers.rotor.shaft.section import transfer_matrices
from solvers.rotor.shaft.structure import Coordinate, Station, Structure


@dataclass(frozen=True)
class Connection:
    """One spring of a joint between two beams, the reaction in which is unknown."""

    first: Coordinate  #: coordinates on which the reaction acts, on the second with the other sign
    second: Coordinate
    flexibility: Complex  #: 1/(k + i omega c), shape (n,)


def connections(structure: Structure, frequency: Array) -> list[Connection]:
    """Springs between beams in the order of the joints, the radial one of a joint before the angular one."""
    found = []
    for joint in structure.joints:
        if joint.second is None:
            continue
        for slope, stiffness in enumerate(joint.dynamic(frequency)):
            if np.any(stiffness != 0.0):
                ends = Coordinate(joint.first, bool(slope)), Coordinate(joint.second, bool(slope))
                found.append(Connection(*ends, 1.0 / stiffness))
    return found


def point_matrices(structure: Structure, station: Station, frequency: Array, spin: float = 0.0) -> Complex:
    """Across a station: its masses and its springs to the ground [theory: spindle, eq. 5].

    Shape (n, 4, 4), for the states (w, theta, M, Q).
    """
    omega = np.asarray(frequency, dtype=float)
    found = np.tile(np.eye(4, dtype=complex), (omega.size, 1, 1))
    for mass in structure.masses:
        if mass.station == station:
            found[:, 3, 0] -= mass.mass * np.square(omega)
            found[:, 2, 1] -= mass.inertia * np.square(omega) - mass.polar_inertia * spin * omega
    for joint in structure.joints:
        if joint.second is None and joint.first == station:
            radial, angular = joint.dynamic(omega)
            found[:, 3, 0] += radial
            found[:, 2, 1] += angular
    return found


def station_matrices(structure: Structure, beam: int, frequency: Array, spin: float = 0.0) -> list[Complex]:
    """From behind the station before to behind each station of a beam; the first is that of its own station.

    Shape (n, 4, 4) each.
    """
    sections = structure.beams[beam]
    found = [point_matrices(structure, (beam, 0), frequency, spin)]
    for k, section in enumerate(sections):
        field = transfer_matrices(section, section.length, frequency, spin)
        found.append(point_matrices(structure, (beam, k + 1), frequency, spin) @ field)
    return found


def free_compliances(structure: Structure, beam: int, frequency: Array, spin: float = 0.0) -> Complex:
    """Compliances of a beam without its joints to other beams [theory: spindle, eq. 7].

    Shape (n, 2 m, 2 m), of its m stations deflection and force before slope and moment; an `InputError` where
    the beam alone moves without bounds.
    """
    steps = station_matrices(structure, beam, frequency, spin)
    size, count = len(steps), np.asarray(frequency).size
    unit = np.zeros((count, 4, 2), dtype=complex)
    unit[:, 3, 0] = unit[:, 2, 1] = -1.0  # a unit force takes from the shear, a unit moment from the moment
    # States behind each station: from the motion of the first end, and from a unit load at each station.
    from_end, from_load = [steps[0][..., :2]], [[unit if j == 0 else 0.0 * unit for j in range(size)]]
    for k in range(1, size):
        from_end.append(steps[k] @ from_end[-1])
        before = [steps[k] @ state for state in from_load[-1]]
        from_load.append([state + unit * (j == k) for j, state in enumerate(before)])
    found = np.empty((count, 2 * size, 2 * size), dtype=complex)
    for j in range(size):
        try:
            start = -np.linalg.solve(from_end[-1][:, 2:], from_load[-1][j][:, 2:])
        except np.linalg.LinAlgError as error:
            text = "one at which each beam alone has an answer"
            raise InputError("frequency", np.asarray(frequency).tolist(), text) from error
        for k in range(size):
            state = from_end[k][:, :2] @ start + from_load[k][j][:, :2]
            found[:, 2 * k : 2 * k + 2, 2 * j : 2 * j + 2] = state
    return found


@dataclass(frozen=True)
class Substructures:
    """The dynamic compliance matrix and what follows from it [theory: spindle, eq. 12-13]."""

    matrix: Complex  #: of the connections, shape (n, c, c)
    #: free motion of the second end of each connection from the first under the unit force, (n, c)
    load: Complex
    reactions: Complex  #: in the connections, shape (n, c)
    motions: tuple[Complex, ...]  #: of each beam, deflection and slope of its stations, shape (n, m, 2) each


def substructures(
    structure: Structure, frequency: Array, driven: Coordinate, spin: float = 0.0
) -> Substructures:
    """Answer to a unit force at `driven` by the compliances of free beams and the reactions between them."""
    omega = np.asarray(frequency, dtype=float).reshape(-1)
    structure.require(driven.station)
    springs = connections(structure, omega)
    if not springs:
        raise InputError("joints", len(structure.joints), "such that one of them joins two beams")
    matrix = np.zeros((omega.size, len(springs), len(springs)), dtype=complex)
    load = np.zeros((omega.size, len(springs)), dtype=complex)
    parts = []
    for beam in range(len(structure.beams)):
        own = free_compliances(structure, beam, omega, spin)
        acting, force = np.zeros((own.shape[-1], len(springs))), np.zeros(own.shape[-1])
        for k, spring in enumerate(springs):
            for end, sign in ((spring.first, 1.0), (spring.second, -1.0)):
                if end.station[0] == beam:
                    acting[2 * end.station[1] + end.slope, k] = sign
        if driven.station[0] == beam:
            force[2 * driven.station[1] + driven.slope] = 1.0
        matrix += acting.T @ own @ acting
        load -= own @ force @ acting
        parts.append((own, acting, force))
    for k, spring in enumerate(springs):
        matrix[:, k, k] += spring.flexibility
    reactions = np.asarray(np.linalg.solve(matrix, load[..., None])[..., 0], dtype=complex)
    motions = [
        (own @ (reactions @ acting.T + force)[..., None])[..., 0].reshape(omega.size, -1, 2)
        for own, acting, force in parts
    ]
    return Substructures(matrix, load, reactions, tuple(motions))
