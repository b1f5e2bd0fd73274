"""Self-excited whirl of any rotor whose chambers have baffles, in the standing frame.

A rotor that stands on unlike springs has constant coefficients in the standing frame only, the liquid there
only if it answers alike in all directions: with three baffles or more. Its motions then come in circles, one
complex coordinate each.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from meshes.border import InputError
from solvers.reduced_liquid import KEPT, ReducedLiquid, spanned
from solvers.rotor.system import RotorSystem
from solvers.section_layer import SectionLayer
from solvers.section_whirl import SLOW, MostGrowing, most_growing, roots
from solvers.whirl_system import CoupledMatrices, SystemModes, linear_modes

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Placed = tuple[float, SectionLayer]

_ALIKE = 1e-3  # of the answer, that may go in the other sense: what an uneven mesh makes of even walls
_DISTINCT = 1e-7  # of an answer that must stand across the others
_QUARTER = np.array([[0.0, -1.0], [1.0, 0.0]])  # multiplies by i


@dataclass(frozen=True, eq=False)
class CircleLayer:
    """Layer that answers alike in all directions, in m complex coordinates q.

    q'' + 2 Omega C q' + Omega^2 B q = p* a and Q = -rho h p q, both in the drum's frame, all x + i y
    [theory: sections, eq. 9].

    Parameters
    ----------
    density : rho h, kg/m^2
    liquid_area : m^2
    gyration, surface, laminar : C, B and S, shape (m, m)
    moment : p, shape (m,), m
    rate : k of linear friction, 1/s
    """

    density: float
    liquid_area: float
    gyration: Complex
    surface: Complex
    laminar: Complex
    moment: Complex
    rate: float


def circle_layer(layer: SectionLayer) -> CircleLayer:
    """The motions of a layer that a circular whirl drives [theory: sections, eq. 9].

    Parameters
    ----------
    layer : with motions in two directions

    Raises
    ------
    InputError : it does not answer alike in all directions
    """
    liquid = layer.liquid
    drive = (liquid.moment[0] - 1j * liquid.moment[1])[:, None]
    answers = [drive, np.linalg.solve(liquid.surface, drive)]
    for point in KEPT:
        for s in (point, -point.conjugate()):
            matrix = -s * s * liquid.inertia + 2j * s * liquid.gyration + liquid.surface
            answers.append(np.linalg.solve(matrix, drive))
    basis = spanned(np.hstack(answers), _DISTINCT)
    # What rounding, or an uneven mesh, makes of motions in the other sense stays out.
    x, y = liquid.moment @ basis
    basis = basis[:, np.abs(y + 1j * x) <= _ALIKE * np.abs(x).max()]

    def seen(matrix: Array) -> Complex:
        return np.asarray(basis.conj().T @ matrix @ basis)

    found = CircleLayer(
        density=layer.density,
        liquid_area=liquid.liquid_area,
        gyration=seen(liquid.gyration),
        surface=seen(liquid.surface),
        laminar=seen(layer.laminar),
        moment=np.sqrt(2.0) * (liquid.moment[0] @ basis),
        rate=layer.rate,
    )
    _require_alike(liquid, found)
    return found


def _require_alike(liquid: ReducedLiquid, circle: CircleLayer) -> None:
    """Refuse a liquid that does not answer alike in all directions."""
    s = np.array([0.0, *KEPT])
    matrix = liquid.compliance(s)
    sum_xy, difference = matrix[:, 0, 0] + matrix[:, 1, 1], matrix[:, 0, 0] - matrix[:, 1, 1]
    turned = 0.5 * (sum_xy - 1j * (matrix[:, 0, 1] - matrix[:, 1, 0]))
    counter = 0.5 * (difference + 1j * (matrix[:, 0, 1] + matrix[:, 1, 0]))
    one = np.eye(len(circle.moment))
    at = s[:, None, None]
    motion = -np.square(at) * one + 2j * at * circle.gyration + circle.surface
    answer = np.linalg.solve(
        motion, np.broadcast_to(circle.moment.conj()[:, None], (s.size, one.shape[0], 1))
    )
    off = np.abs((circle.moment @ answer)[..., 0] - turned) + np.abs(counter)
    if (off > _ALIKE * np.abs(turned).max()).any():
        allowed = "3 or more for a rotor that is not planar: fewer answer differently in two directions"
        raise InputError("chambers.baffles.count", "1 or 2", allowed)


@dataclass(frozen=True, eq=False)
class StandingMatrices:
    """M z'' + C z' + K z = 0 at n speeds, and laminar friction beside it.

    Parameters
    ----------
    mass, damping, stiffness : shape (N, N), (n, N, N), (n, N, N)
    laminar : S, shape (N, N)
    quarter : multiplies the liquid's complex coordinates by i, shape (N, N)
    """

    mass: Array
    damping: Array
    stiffness: Array
    laminar: Array
    quarter: Array


def standing_matrices(system: RotorSystem, layers: Sequence[Placed], speed: Array) -> StandingMatrices:
    """Rotor and liquid as one linear system in the standing frame [theory: sections, eq. 10].

    Parameters
    ----------
    system : the dry rotor, with the mass of all liquid that has no free surface
    layers : plane, m, and layer
    speed : Omega, rad/s, shape (n,)
    """
    count, spin = len(system.coordinates), speed[:, None, None]
    circles = [(plane, circle_layer(layer)) for plane, layer in layers]
    size = count + 2 * sum(len(one.moment) for _, one in circles)
    mass, laminar, quarter = np.zeros((3, size, size))
    damping, stiffness = np.zeros((2, speed.size, size, size))
    mass[:count, :count] = system.mass
    damping[:, :count, :count] = system.damping + spin * system.gyroscopic
    stiffness[:, :count, :count] = system.stiffness
    first = count
    for plane, one in circles:
        m, at = len(one.moment), system.at(plane)
        own = slice(first, first + 2 * m)
        first += 2 * m
        pull = -one.density * at.T @ _real(one.moment[None])
        turn, unit = _real(1j * np.eye(m)), one.density * np.eye(2 * m)
        mass[:count, :count] += one.density * one.liquid_area * at.T @ at
        mass[:count, own], mass[own, :count], mass[own, own] = pull, pull.T, unit
        # d/dt - i Omega takes the place of d/dt in what the liquid does in the drum.
        twist, spread = one.density * _real(one.gyration), one.density * _real(one.surface)
        damping[:, own, own] = 2.0 * spin * (twist - one.density * turn) + one.rate * unit
        stiffness[:, own, own] = (
            np.square(spin) * (spread - unit - 2.0 * turn @ twist) - one.rate * one.density * spin * turn
        )
        laminar[own, own], quarter[own, own] = one.density * _real(one.laminar), turn
    return StandingMatrices(mass, damping, stiffness, laminar, quarter)


def standing_modes(system: RotorSystem, layers: Sequence[Placed], speed: Array) -> SystemModes:
    """Whirl modes in the standing frame: all without laminar friction, with it those that grow most.

    Parameters
    ----------
    system, layers, speed : as for `standing_matrices`
    """
    found = standing_matrices(system, layers, speed)
    rows = np.zeros((2 * len(layers), len(found.mass)))
    for k, (plane, _) in enumerate(layers):
        rows[2 * k : 2 * k + 2, : len(system.coordinates)] = system.at(plane)
    own = np.eye(len(found.mass))[len(system.coordinates) :]
    circles = np.concatenate([rows, own])
    if not np.any(found.laminar):
        return linear_modes(CoupledMatrices(found.mass, found.damping, found.stiffness), circles)
    drag = np.sqrt(0.5 * SLOW * speed)[:, None, None] * found.laminar
    slipping = -speed[:, None, None] * found.quarter @ drag
    started = roots(CoupledMatrices(found.mass, found.damping + drag, found.stiffness + slipping))
    # Of the two circles of a mode the one with the spin, which slips less.
    slip = np.abs(np.abs(started.imag) - speed[:, None])
    spin = speed[:, None, None, None]

    def terms(root: Complex) -> tuple[Complex, Complex]:
        at = root[..., None, None]
        # Either sense of circle slips by its own frequency over the drum.
        power, slope = [], []
        for way in (-1j, 1j):
            slip = at + way * spin
            one = np.sqrt(slip)
            power.append(slip * one)
            slope.append(1.5 * one)
        mean, half = (
            (0.5 * (one[0] + one[1]) for one in (power, slope)),
            (-0.5j * (one[0] - one[1]) for one in (power, slope)),
        )
        turned = found.quarter @ found.laminar
        shear, change = (u * found.laminar + v * turned for u, v in zip(mean, half, strict=True))
        damping, stiffness = found.damping[:, None], found.stiffness[:, None]
        matrix = at * (at * found.mass + damping) + stiffness + shear
        return matrix, 2.0 * at * found.mass + damping + change

    return most_growing(MostGrowing(started, slip, circles, terms), speed)


def _real(matrix: Any) -> Array:
    """A complex matrix over real and imaginary parts, shape (r, m) to (2 r, 2 m)."""
    made = np.kron(matrix.real, np.eye(2)) + np.kron(matrix.imag, _QUARTER)
    return np.asarray(made)
