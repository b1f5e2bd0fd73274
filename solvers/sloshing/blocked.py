"""Inertia of the flow that baffles block: what a drum struck into rotation takes along at once."""

from __future__ import annotations

import numpy as np
from scipy.sparse.linalg import splu

from fluid.fill import Fill
from meshes.arrays import Array
from meshes.liquid_section import LiquidSection
from solvers.sloshing.system import stiffness

_AROUND, _ACROSS = 192, 12


def blocked_inertia(section: LiquidSection) -> float:
    """Moment of inertia of the liquid that its walls take along at once, over density and height, m^4.

    The flow has a potential, 0 on the free surface, and the walls' normal velocity [theory: baffles, eq. 14].
    """
    push = _push(section)
    unknown = np.zeros(len(section.points), dtype=bool)
    unknown[section.cells] = True
    unknown[section.surface] = False
    own = np.flatnonzero(unknown)
    factors = splu(
        stiffness(section)[own][:, own].tocsc(),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    potential = factors.solve(push[own])
    return float(push[own] @ potential)


def _push(section: LiquidSection) -> Array:
    """Flux through the walls where the drum turns by 1 rad/s, on the nodes, m^2/s, shape (N,)."""
    point, weight = np.polynomial.legendre.leggauss(4)
    t, weight = 0.5 * (1.0 + point), 0.5 * weight
    if section.order == 1:
        shape, slope = np.array([1.0 - t, t]), np.array([-np.ones_like(t), np.ones_like(t)])
    else:
        shape = np.array([(1.0 - t) * (1.0 - 2.0 * t), t * (2.0 * t - 1.0), 4.0 * t * (1.0 - t)])
        slope = np.array([4.0 * t - 3.0, 4.0 * t - 1.0, 4.0 - 8.0 * t])
    nodes = section.points[section.wall]
    place, along = (np.einsum("kq,skd->sqd", each, nodes) for each in (shape, slope))
    # With the liquid on the left of a side the outer normal times its length is the tangent turned back.
    through = -np.sum(place * along, axis=2) * weight
    found = np.zeros(len(section.points))
    np.add.at(found, section.wall, np.einsum("sq,kq->sk", through, shape))
    return found


def blocked_share(fill: Fill) -> float:
    """Share of a layer's moment of inertia that its baffles take along at once [theory: baffles, eq. 14]."""
    from meshes.rings.quadrilaterals import ring

    radius, inner = fill.chamber.radius, fill.surface_radius
    section = ring(radius, inner, _AROUND, _ACROSS, baffles=fill.chamber.baffles)
    whole = 0.5 * np.pi * (radius**4 - inner**4)
    return blocked_inertia(section) / float(whole)
