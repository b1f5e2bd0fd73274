"""The liquid's answer to a whirl of its drum, for a section of any shape.

Amplitudes go with e^{i s t} in the drum's frame, s the whirl speed in space less the spin. The body force f
is minus the acceleration of the axis; gravity across the axis is one with s = -Omega.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from meshes.arrays import Array, Complex
from meshes.errors import InputError, require_positive
from solvers.sloshing.assembly import wall_points
from solvers.sloshing.modes import Spectrum, spectrum, surface_displacement
from solvers.sloshing.system import LiquidSystem

TURN = np.array([[0.0, -1.0], [1.0, 0.0]])  # a quarter turn with the spin
FORWARD, BACKWARD = np.array([1.0, -1j]), np.array([1.0, 1j])  # amplitudes of circles with e^{i s t}
_UNSEEN = 1e-20  # squared moment of a mode over the largest


@dataclass(frozen=True, eq=False)
class ForcedResponse:
    """Answer of the liquid at some whirl speeds; amplitudes in the plane's two directions.

    Parameters
    ----------
    spin : Omega, rad/s
    slip : s, rad/s, shape (...,)
    tensor : force on the drum over rho h A f, A the area that the wall encloses, shape (..., 2, 2)
    compliance : first moment of the displaced liquid over rho h f, m^2 s^2, shape (..., 2, 2)
    force_ratio : G of a circular whirl w e^{i s t}: F = rho h A omega^2 (G w e^{i s t} + ...), shape (...,)
    counter_ratio : of the circle that answers the other way round, ... + H conj(w) e^{-i s t}; 0 for three or
        more equal sectors, shape (...,)
    """

    spin: float
    slip: Array
    tensor: Complex
    compliance: Complex
    force_ratio: Complex
    counter_ratio: Complex


def forced_response(
    system: LiquidSystem, spin: float, whirl_speed: ArrayLike, modes: Spectrum | None = None
) -> ForcedResponse:
    """Force of the liquid on a whirling drum, a sum over all modes [theory: sloshing, eq. 14-16].

    Parameters
    ----------
    system : the liquid, from `condense`
    spin : Omega, rad/s
    whirl_speed : omega in space, rad/s, shape (...,); 0 serves gravity across the axis, the spin itself a
        synchronous whirl
    modes : `spectrum` of the system, if it is known already

    Returns
    -------
    The response; infinite where the whirl meets a free wave.

    Raises
    ------
    InputError : a spin that is not positive, a whirl speed that is not finite
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

    Also where sigma meets a mode that moves the centre of mass, shape (...,).

    sum p p* sigma_k^(j+1)/(sigma_k - sigma) over both signs of every mode, less what has to cancel for large
    sigma: sum p p* sigma_k = 0.
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
    """Stream function of the displacement under a body force, by one dense solution [theory: sloshing, eq.
    13].

    Parameters
    ----------
    system : the liquid
    spin, slip : Omega and s, rad/s
    force : amplitude of f, m/s^2, shape (2,)

    Returns
    -------
    In the condensed unknowns, m^2, shape (n,).
    """
    matrix = spin**2 * system.surface - slip**2 * system.inertia + 2j * slip * spin * system.gyration
    return np.asarray(np.linalg.solve(matrix, -(system.moment.T @ force)))


def newton_force(system: LiquidSystem, spin: float, slip: float, force: Complex, field: Complex) -> Complex:
    """Force on the drum over rho h from the motion of the liquid's centre of mass [theory: sloshing, eq. 15].

    Parameters
    ----------
    system, spin, slip, force : as for `displacement_field`
    field : what it returns

    Returns
    -------
    Amplitudes in both directions, m^3/s^2, shape (2,).
    """
    change = 1j * slip * np.eye(2) + spin * TURN
    return np.asarray(system.liquid_area * force + change @ change @ (system.moment @ field))


def pressure_force(system: LiquidSystem, spin: float, slip: float, force: Complex, field: Complex) -> Complex:
    """Force on the drum over rho h from the pressure on all walls [theory: sloshing, eq. 17].

    The slope of the pressure along the walls follows from the velocity there, pressure itself where a wall
    meets the free surface. An independent statement of `newton_force`, less accurate.

    Parameters
    ----------
    system, spin, slip, force, field : as for `newton_force`

    Returns
    -------
    Amplitudes in both directions, m^3/s^2, shape (2,).
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
