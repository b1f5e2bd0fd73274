"""Damping of the liquid's modes by laminar layers on walls, baffles, floor and lid."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from fluid.friction import decay_rate, edge_weight, layer_thickness, plate_drags, stokes_coefficient
from meshes.arrays import Array, Complex
from meshes.errors import require_not_negative, require_positive
from meshes.liquid_section import LiquidSection
from solvers.sloshing.assembly import wall_points
from solvers.sloshing.modes import SloshingModes
from solvers.sloshing.system import LiquidSystem

# A wall that turns back on itself so sharply has an edge in the liquid.
_BACK = -0.99


@dataclass(frozen=True)
class ModeDamping:
    """Decay of modes in laminar layers.

    Parameters
    ----------
    rate : of the amplitude, with the Coriolis force in the layers on floor and lid, 1/s, shape (k,)
    plain_rate : without it, as in the friction of the long waves, 1/s, shape (k,)
    wall_rate : share of walls and baffles in either, 1/s, shape (k,)
    edge_spread : how much `rate` changes if the flow round edges of baffles is cut off at half or at twice
        the layer's thickness, the larger of both, over the rate, shape (k,); 0 without edges
    thickness : of the layer on the walls, m, shape (k,)
    """

    rate: Array
    plain_rate: Array
    wall_rate: Array
    edge_spread: Array
    thickness: Array


def mode_damping(system: LiquidSystem, modes: SloshingModes, viscosity: float, height: float) -> ModeDamping:
    """Damping of each mode, to first order in the thickness of the layers [theory: sloshing, eq. 18-23].

    Parameters
    ----------
    system, modes : the liquid and its modes
    viscosity : kinematic viscosity nu, m^2/s, 0 or above
    height : of the chamber along the axis, m; inf leaves floor and lid out

    Returns
    -------
    The rates; laminar, without separation at the edges of baffles, which damps more and grows with amplitude.

    Raises
    ------
    InputError : a negative viscosity, a height that is not positive
    """
    require_not_negative("viscosity", viscosity)
    if height != np.inf:
        require_positive("height", height)
    psi = -1j * modes.frequency[:, None] * modes.amplitude
    kinetic = np.einsum("ki,ij,kj->k", psi.conj(), system.inertia, psi).real
    sense = np.einsum("ki,ij,kj->k", psi.conj(), system.gyration, psi).imag
    tension = np.einsum("ki,ij,kj->k", psi.conj(), system.surface, psi).real
    potential = np.square(modes.spin / modes.frequency) * tension
    thickness = layer_thickness(viscosity, modes.frequency)
    half, once, twice = (wall_loss(system.section, modes.psi, part * thickness) for part in (0.5, 1.0, 2.0))
    g = stokes_coefficient(viscosity, modes.frequency)
    plates = plate_drags(viscosity, modes.frequency, modes.spin)

    def rate(wall: Array, floor: Array, lid: Array) -> Array:
        return decay_rate(wall, kinetic, sense, potential, height, (g, floor, lid))

    own, nothing = rate(once, *plates), np.zeros_like(g)
    spread = np.maximum(rate(half, *plates) - own, own - rate(twice, *plates))
    return ModeDamping(
        rate=own,
        plain_rate=rate(once, g, g),
        wall_rate=rate(once, nothing, nothing),
        edge_spread=np.divide(spread, own, out=nothing.copy(), where=own > 0.0),
        thickness=thickness,
    )


def wall_loss(section: LiquidSection, psi: Complex, cut: Array) -> Array:
    """oint |d psi/dn|^2 ds on all walls, cut off at the edges of thin baffles [theory: sloshing, eq. 23].

    Parameters
    ----------
    section : the liquid at rest
    psi : on the nodes, shape (k, N)
    cut : thickness of the layer of each, m, shape (k,)

    Returns
    -------
    shape (k,), in the units of psi^2/m
    """
    slope, weight = wall_weights(section, np.asarray(cut)[:, None])
    return np.asarray(np.sum(np.square(np.abs(slope @ psi.T)).T * weight, axis=1))


def wall_weights(section: LiquidSection, cut: Array) -> tuple[csr_array, Array]:
    """Slope along the normal at points on the walls, and their lengths, cut off at edges of thin baffles.

    Parameters
    ----------
    section : the liquid at rest
    cut : thickness of the layer, m, shape () or (k, 1)

    Returns
    -------
    psi at the nodes to its slope, shape (Q, N), 1/m; lengths, shape (Q,) or (k, Q), m.
    """
    walls, edges = wall_points(section), baffle_edges(section)
    if len(edges) == 0:
        return walls.slope, walls.weights
    away = walls.points[:, None] - edges
    distance = np.sqrt(np.square(away).sum(axis=2).min(axis=1))
    return walls.slope, np.asarray(edge_weight(distance, cut) * walls.weights)


def baffle_edges(section: LiquidSection) -> Array:
    """Points in the liquid at which a wall without thickness ends, shape (E, 2), m."""
    wall, points = section.wall, section.points
    start, end = points[wall[:, 0]], points[wall[:, 1]]
    bend = 4.0 * points[wall[:, 2]] - 2.0 * (start + end) if section.order == 2 else np.zeros_like(start)
    leaving, arriving = end - start + bend, end - start - bend
    before = np.full(len(points), -1, dtype=np.int64)
    before[wall[:, 1]] = np.arange(len(wall))
    last = before[wall[:, 0]]
    joined = np.flatnonzero(last >= 0)
    one, other = leaving[joined], arriving[last[joined]]
    size = np.sqrt(np.square(one).sum(axis=1) * np.square(other).sum(axis=1))
    back = np.sum(one * other, axis=1) < _BACK * size
    return np.asarray(points[wall[joined[back], 0]])
