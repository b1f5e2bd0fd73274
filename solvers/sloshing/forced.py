"""The liquid's answer to a whirl of its drum, for a section of any shape, and the damping of its modes.

Amplitudes go with e^{i s t} in the drum's frame, s the whirl speed in space less the spin. The body force f
is minus the acceleration of the axis, or gravity across it, for which s = -Omega. Damping comes from laminar
layers on walls, baffles, floor and lid.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csr_array

from fluid.friction.laws import decay_rate, edge_weight, layer_thickness, plate_drags, stokes_coefficient
from meshes.arrays import Array, Complex
from meshes.errors import InputError, require_not_negative, require_positive
from meshes.liquid_section import LiquidSection
from solvers.sloshing.modes import SloshingModes, Spectrum, spectrum, surface_displacement
from solvers.sloshing.system import Condensed, LiquidSystem, wall_points

# A wall that turns back on itself so sharply has an edge in the liquid.
_BACK = -0.99


@dataclass(frozen=True)
class ModeDamping:
    """Decay of modes in laminar layers."""

    rate: Array  #: of the amplitude, with the Coriolis force in the layers on floor and lid, 1/s, shape (k,)
    plain_rate: Array  #: without it, as in the friction of the long waves, 1/s, shape (k,)
    #: how much `rate` changes if the flow round edges of baffles is cut off at half or at twice the layer's
    #: thickness, the larger of both, over the rate, shape (k,); 0 without edges
    edge_spread: Array
    thickness: Array  #: of the layer on the walls, m, shape (k,)


def mode_damping(system: Condensed, modes: SloshingModes, viscosity: float, height: float) -> ModeDamping:
    """Damping of each mode, to first order in the thickness of the layers [theory: sloshing, eq. 18-23].

    Laminar: separation at the edges of baffles damps more, and grows with amplitude. An infinite height
    leaves floor and lid out.
    """
    require_not_negative("viscosity", viscosity)
    if height != np.inf:
        require_positive("height", height)
    psi = -1j * modes.frequency[:, None] * modes.amplitude
    inertia, turned, raised = ((psi.conj() * product).sum(axis=1) for product in system.products(psi))
    kinetic, sense, tension = inertia.real, turned.imag, raised.real
    potential = np.square(modes.spin / modes.frequency) * tension
    thickness = layer_thickness(viscosity, modes.frequency)
    half, once, twice = (wall_loss(system.section, modes.psi, part * thickness) for part in (0.5, 1.0, 2.0))
    g = stokes_coefficient(viscosity, modes.frequency)
    plates = plate_drags(viscosity, modes.frequency, modes.spin)

    def rate(wall: Array, floor: Array, lid: Array) -> Array:
        return decay_rate(wall, kinetic, sense, potential, height, (g, floor, lid))

    own = rate(once, *plates)
    spread = np.maximum(rate(half, *plates) - own, own - rate(twice, *plates))
    return ModeDamping(
        rate=own,
        plain_rate=rate(once, g, g),
        edge_spread=np.divide(spread, own, out=np.zeros_like(own), where=own > 0.0),
        thickness=thickness,
    )


def wall_loss(section: LiquidSection, psi: Complex, cut: Array) -> Array:
    """oint |d psi/dn|^2 ds on all walls, cut off at the edges of thin baffles [theory: sloshing, eq. 23].

    Shape (k,), in the units of psi^2/m, of psi on the nodes (k, N) and layers as thick as `cut`, m.
    """
    slope, weight = wall_weights(section, np.asarray(cut)[:, None])
    return np.asarray(np.sum(np.square(np.abs(slope @ psi.T)).T * weight, axis=1))


def wall_weights(section: LiquidSection, cut: Array) -> tuple[csr_array, Array]:
    """Slope along the normal at points on the walls, (Q, N), 1/m, and their lengths, m, (Q,) or (k, Q).

    Cut off at edges of thin baffles by the thickness of the layer, m, shape () or (k, 1).
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
    first, other = leaving[joined], arriving[last[joined]]
    size = np.sqrt(np.square(first).sum(axis=1) * np.square(other).sum(axis=1))
    back = np.sum(first * other, axis=1) < _BACK * size
    return np.asarray(points[wall[joined[back], 0]])


TURN = np.array([[0.0, -1.0], [1.0, 0.0]])  # a quarter turn with the spin
FORWARD, BACKWARD = np.array([1.0, -1j]), np.array([1.0, 1j])  # amplitudes of circles with e^{i s t}
_UNSEEN = 1e-20  # squared moment of a mode over the largest


@dataclass(frozen=True, eq=False)
class ForcedResponse:
    """Answer of the liquid at some whirl speeds; amplitudes in the plane's two directions."""

    spin: float  #: Omega, rad/s
    slip: Array  #: s, rad/s, shape (...,)
    tensor: Complex  #: force on the drum over rho h A f, A the area that the wall encloses, shape (..., 2, 2)
    compliance: Complex  #: first moment of the displaced liquid over rho h f, m^2 s^2, shape (..., 2, 2)
    #: G of a circular whirl w e^{i s t}: F = rho h A omega^2 (G w e^{i s t} + ...), shape (...,)
    force_ratio: Complex
    #: of the circle that answers the other way round, ... + H conj(w) e^{-i s t}; 0 for three or more equal
    #: sectors, shape (...,)
    counter_ratio: Complex


def forced_response(
    system: LiquidSystem, spin: float, whirl_speed: ArrayLike, modes: Spectrum | None = None
) -> ForcedResponse:
    """Force of the liquid on a whirling drum, a sum over all modes [theory: sloshing, eq. 14-16].

    Whirl speeds in space, rad/s: 0 is gravity across the axis, the spin synchronous; inf at a natural wave.
    """
    require_positive("spin", spin)
    omega = np.asarray(whirl_speed, dtype=float)
    if not np.all(np.isfinite(omega)):
        raise InputError("whirl_speed", whirl_speed, "finite")
    known = spectrum(system) if modes is None else modes
    ratio = (omega - spin) / spin
    (pull, first, second), unbounded = _moments_of(known, system.moment, -ratio)
    # -(d/dt + Omega J)^2 of the moment, with the powers of s taken into the sums over modes.
    force = second + 2.0 * 1j * np.matmul(TURN, first) + pull
    area = system.enclosed_area
    tensor = (system.liquid_area * np.eye(2) + force) / area
    circle = tensor @ FORWARD
    onward, counter = 0.5 * (circle @ FORWARD.conj()), 0.5 * (circle @ BACKWARD.conj()).conj()
    both_ways = unbounded[..., None, None]
    return ForcedResponse(
        spin=spin,
        slip=omega - spin,
        tensor=np.where(both_ways, np.inf, tensor),
        compliance=np.where(both_ways, np.inf, pull / spin**2),
        force_ratio=np.where(unbounded, np.inf, onward),
        counter_ratio=np.where(unbounded, np.inf, counter),
    )


def _moments_of(
    modes: Spectrum, moment: Array, sigma: Array | Complex
) -> tuple[list[Complex], NDArray[np.bool_]]:
    """Moment of the displaced liquid over f at unit spin, times 1, sigma and sigma^2, shape (..., 2, 2) each.

    Also where sigma meets a mode that moves the centre of mass, (...,). sum p p* sigma_k^(j+1)/(sigma_k -
    sigma) over both signs of every mode, less what has to cancel for large sigma: sum p p* sigma_k = 0.
    """
    p = modes.amplitude @ moment.T
    both = np.concatenate([modes.frequency, -modes.frequency])
    shares = np.concatenate([p, p.conj()])
    outer = shares[:, :, None] * shares[:, None, :].conj()
    gap = both - sigma[..., None]
    met = gap == 0.0
    gap = np.where(met, 1.0, gap)
    found = [np.tensordot(both**power / gap, outer, axes=1) for power in (1, 2, 3)]
    found[2] = found[2] - np.tensordot(np.square(both), outer, axes=1)
    # A mode that does not move the centre of mass does not show.
    pushed = np.square(np.abs(shares)).sum(axis=1)
    return found, (met & (pushed > _UNSEEN * pushed.max())).any(axis=-1)


def displacement_field(system: LiquidSystem, spin: float, slip: float, force: Complex) -> Complex:
    """Stream function of the displacement by one dense solution, m^2, (n,) [theory: sloshing, eq. 13].

    In the condensed unknowns, for the amplitude of a body force f, m/s^2, shape (2,).
    """
    matrix = spin**2 * system.surface - slip**2 * system.inertia + 2j * slip * spin * system.gyration
    return np.asarray(np.linalg.solve(matrix, -(system.moment.T @ force)))


def newton_force(system: LiquidSystem, spin: float, slip: float, force: Complex, field: Complex) -> Complex:
    """Force on the drum over rho h by the motion of the centre of mass, (2,), m^3/s^2.

    For the field that `displacement_field` returns [theory: sloshing, eq. 15].
    """
    change = 1j * slip * np.eye(2) + spin * TURN
    return np.asarray(system.liquid_area * force + change @ change @ (system.moment @ field))


def pressure_force(system: LiquidSystem, spin: float, slip: float, force: Complex, field: Complex) -> Complex:
    """Force on the drum over rho h by the pressure on all walls, (2,), m^3/s^2 [theory: sloshing, eq. 17].

    The slope of the pressure along the walls follows from the velocity, the pressure itself where a wall
    meets the free surface. An independent statement of `newton_force`, less accurate.
    """
    section, walls = system.section, wall_points(system.section)
    eta = system.on_nodes(field[None])
    rise = walls.along @ force - slip**2 * (walls.slope @ eta[0])
    total = TURN @ ((walls.weights * rise) @ walls.points)
    nodes, xi = surface_displacement(section, eta)
    pressure = np.zeros(len(section.points), dtype=complex)
    pressure[nodes] = -(spin**2) * section.surface_radius * xi[0]
    first = np.intersect1d(section.wall[:, 0], section.surface[:, 1])
    last = np.intersect1d(section.wall[:, 1], section.surface[:, 0])
    ends = pressure[last] @ section.points[last] - pressure[first] @ section.points[first]
    return np.asarray(total - TURN @ ends)
