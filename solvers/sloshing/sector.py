"""A ring with baffles from one of its equal sectors: what a whirling rotor knows of its liquid.

A field that a circular whirl drives turns by -2 pi/n from one sector to the next, of n >= 3: one sector whose
rays are joined by that phase has all of it, in complex unknowns [theory: sections, eq. 11].
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.sparse import coo_array, csc_array, csr_array
from scipy.sparse.linalg import splu

from fluid.friction.laws import edge_weight
from meshes.arrays import Array, Complex, Indices
from meshes.baffles import Baffles
from meshes.rings.quadrilaterals import RingSector, ring_sector
from solvers.sloshing.system import area_within, moment_of, stiffness, surface_forms, wall_points


@dataclass(frozen=True, eq=False)
class SectorSystem:
    """K q'' + 2 Omega C q' + Omega^2 B q = p* a of the whole ring, in complex unknowns q of one sector.

    Q = -rho h p q as x + i y, for an acceleration a of the drum as x + i y.
    """

    sector: RingSector
    count: int  #: n, sectors
    inertia: Complex  #: K, Hermitian, positive definite, shape (m, m), a pure number
    gyration: Complex  #: C, antihermitian
    surface: Complex  #: B, Hermitian, positive definite
    moment: Complex  #: p, shape (m,), m
    liquid_area: float  #: of the liquid, and with the dry middle, m^2
    enclosed_area: float
    joined: csr_array  #: values on the sector's nodes from its unknowns
    inside: Indices  #: unknowns off the surface, and on it
    outside: Indices
    factors: Any  #: of the stiffness inside, and what couples it to the surface
    coupling: csr_array

    def on_nodes(self, motions: Complex) -> Complex:
        """Stream function on the sector's nodes, shape (N, k), of motions (m, k)."""
        values = np.empty((self.joined.shape[1], motions.shape[1]), dtype=complex)
        values[self.outside] = motions
        if self.factors is not None:
            values[self.inside] = -self.factors.solve(self.coupling @ motions)
        return np.asarray(self.joined @ values)

    def slip(self, motions: Complex) -> Slip:
        """What motions (m, k) do along the walls."""
        walls = wall_points(self.sector.section)
        away = walls.points[:, None] - self.sector.edges
        far = np.sqrt(np.square(away).sum(axis=2)).min(axis=1, initial=math.inf)
        along = np.asarray(walls.slope @ self.on_nodes(motions))
        return Slip(along, self.count * walls.weights, far)


@dataclass(frozen=True, eq=False)
class Slip:
    """Displacements along the walls of a ring, at Q points of one sector."""

    along: Complex  #: of each motion, shape (Q, k), 1/m
    length: Array  #: of wall in all sectors that a point stands for, shape (Q,), m
    far: Array  #: distance of the next edge of a baffle in the liquid, shape (Q,), m

    def drag(self, cut: float) -> Complex:
        """Integral of products of motions along all walls, (k, k), 1/m, as `reduced.wall_drag`."""
        weights = self.length * edge_weight(self.far, cut)
        return np.asarray(self.along.conj().T @ (weights[:, None] * self.along))


def condense_sector(radius: float, surface_radius: float, baffles: Baffles) -> SectorSystem:
    """Matrices of the motions that a circular whirl drives, on the free surface of one sector.

    Of a mesh with 64 cells around; three baffles and more.
    """
    sector, count = ring_sector(radius, surface_radius, 64, 4, baffles), baffles.count
    joined, outside = _joined(sector, np.exp(-2j * math.pi / count))
    back = joined.conj().T
    k, c, b = (
        csr_array(count * (back @ form @ joined))
        for form in (stiffness(sector.section), *surface_forms(sector.section))
    )
    inside = np.setdiff1d(np.arange(joined.shape[1]), outside)
    whole, factors = k[outside][:, outside].toarray(), None
    coupling = csr_array(k[inside][:, outside])
    if len(inside):
        factors = splu(
            csc_array(k[inside][:, inside]),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
        whole = whole - coupling.conj().T @ factors.solve(coupling.toarray())
    gyration, surface = (form[outside][:, outside].toarray() for form in (c, b))
    points, walls = sector.section.points, sector.section.wall
    x, y = moment_of(sector.section) @ joined[:, outside]
    ring = walls[: len(sector.section.surface)]
    return SectorSystem(
        sector=sector,
        count=count,
        inertia=0.5 * (whole + whole.conj().T),
        gyration=0.5 * (gyration - gyration.conj().T),
        surface=0.5 * (surface + surface.conj().T),
        moment=np.asarray(count * (x + 1j * y) / math.sqrt(2.0)),
        liquid_area=count * area_within(points, np.concatenate([sector.section.surface, ring])),
        enclosed_area=count * area_within(points, ring),
        joined=joined,
        inside=inside,
        outside=outside,
        factors=factors,
        coupling=coupling,
    )


def _joined(sector: RingSector, phase: complex) -> tuple[csr_array, Indices]:
    """Values on the nodes from unknowns, and which of these are on the surface.

    0 on fixed walls; one value for all of a free baffle; on the second ray what is on the first, turned.
    """
    section = sector.section
    nodes = len(section.points)
    first, second = sector.rays.T
    owner, factor = np.arange(nodes), np.ones(nodes, dtype=complex)
    owner[second], factor[second] = first, phase
    if sector.free:
        plate = first[sector.baffle]
        owner[plate], owner[second[sector.baffle]] = plate[0], plate[0]
    held = np.zeros(nodes, dtype=bool)
    held[section.wall[np.isin(section.wall_piece, np.flatnonzero(section.fixed_piece))]] = True
    free = np.flatnonzero(~held)
    unknowns, number = np.unique(owner[free], return_inverse=True)
    joined = csr_array(coo_array((factor[free], (free, number)), shape=(nodes, unknowns.size)))
    touched = section.surface.ravel()
    outside = np.flatnonzero(np.isin(unknowns, owner[touched[~held[touched]]]))
    return joined, outside
