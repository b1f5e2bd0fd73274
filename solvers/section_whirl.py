"""Self-excited whirl of a planar rotor whose chambers have baffles, in the frame of the drum.

With springs alike in all directions the drum's frame has constant coefficients whatever the section. The
coordinates are the deflection of the axis and the motions of each chamber's liquid; all goes as e^{lambda t}.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag

from solvers.rotor.jeffcott import Jeffcott
from solvers.section_layer import SectionLayer
from solvers.whirl_system import CoupledMatrices, SystemModes, linear_modes

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

_TURN = np.array([[0.0, -1.0], [1.0, 0.0]])  # a quarter turn with the spin
SLOW = 0.3  # frequency of slow waves over the spin
_FOLLOWED = 6  # modes at a speed whose laminar friction is computed at their own frequency
_STEPS = 30
_HAIR = 3e-14 * (1.0 + 1.0j)
_SETTLED = 1e-12  # relative step at which a mode is found
_RESOLVED = 1e-11  # of the frequencies, below which growth is rounding


@dataclass(frozen=True, eq=False)
class DrumMatrices:
    """M z'' + (C + sqrt(lambda) S) z' + K z = 0 at n speeds [theory: sections, eq. 3].

    Parameters
    ----------
    mass : symmetric, positive definite, shape (N, N)
    damping, stiffness : shape (n, N, N)
    laminar : S, symmetric, shape (N, N)
    """

    mass: Array
    damping: Array
    stiffness: Array
    laminar: Array


def drum_matrices(rotor: Jeffcott, layers: Sequence[SectionLayer], speed: Array) -> DrumMatrices:
    """Rotor and liquid as one linear system in the frame of the drum [theory: sections, eq. 3].

    Parameters
    ----------
    rotor : its mass includes that of liquid without a free surface
    layers : of its chambers
    speed : Omega, rad/s, shape (n,)
    """
    heavy = rotor.mass + sum(one.density * one.liquid.liquid_area for one in layers)
    pull = -np.hstack([np.zeros((2, 0)), *(one.density * one.liquid.moment for one in layers)])

    def parts(name: str) -> Array:
        return np.asarray(block_diag(*(one.density * getattr(one.liquid, name) for one in layers)))

    inertia, gyration, surface = parts("inertia"), parts("gyration"), parts("surface")
    rate = block_diag(*(one.density * one.rate * one.liquid.inertia for one in layers))
    laminar = block_diag(np.zeros((2, 2)), *(one.density * one.laminar for one in layers))
    spin = speed[:, None, None]
    mass = np.block([[heavy * np.eye(2), pull], [pull.T, inertia]])
    twist = np.block([[heavy * _TURN, _TURN @ pull], [pull.T @ _TURN, gyration]])
    steady = block_diag(rotor.damping * np.eye(2), rate)
    spread = np.block([[-heavy * np.eye(2), -pull], [-pull.T, surface]])
    support = np.zeros_like(mass)
    support[:2, :2] = rotor.stiffness * np.eye(2)
    turned = np.zeros_like(mass)
    turned[:2, :2] = rotor.damping * _TURN
    return DrumMatrices(
        mass=mass,
        damping=2.0 * spin * twist + steady,
        stiffness=np.square(spin) * spread + spin * turned + support,
        laminar=laminar,
    )


def drum_modes(rotor: Jeffcott, layers: Sequence[SectionLayer], speed: Array) -> SystemModes:
    """Whirl modes in the drum's frame: all of them without laminar friction, with it those that grow most.

    Parameters
    ----------
    rotor, layers, speed : as for `drum_matrices`

    Returns
    -------
    Modes; `sense` tells which way they go round as seen from the drum.
    """
    system = drum_matrices(rotor, layers, speed)
    circles = _circles(layers)
    if not np.any(system.laminar):
        return linear_modes(CoupledMatrices(system.mass, system.damping, system.stiffness), circles)
    first = system.damping + np.sqrt(0.5 * SLOW * speed)[:, None, None] * system.laminar
    started = roots(CoupledMatrices(system.mass, first, system.stiffness))
    damping, stiffness = system.damping[:, None], system.stiffness[:, None]

    def terms(root: Complex) -> tuple[Complex, Complex]:
        at = root[..., None, None]
        # Of both roots the one whose layer dies out away from the wall.
        drag = np.sqrt(at) * system.laminar
        matrix = at * (at * system.mass + damping + drag) + stiffness
        return matrix, 2.0 * at * system.mass + damping + 1.5 * drag

    return most_growing(MostGrowing(started, np.abs(started.imag), circles, terms), speed)


def roots(matrices: CoupledMatrices) -> Complex:
    """All lambda of M z'' + C z' + K z = 0, shape (n, 2 N)."""
    size = len(matrices.mass)
    state = np.zeros((len(matrices.damping), 2 * size, 2 * size))
    state[:, :size, size:] = np.eye(size)
    state[:, size:, :size] = -np.linalg.solve(matrices.mass, matrices.stiffness)
    state[:, size:, size:] = -np.linalg.solve(matrices.mass, matrices.damping)
    return np.asarray(np.linalg.eigvals(state), dtype=complex)


@dataclass(frozen=True, eq=False)
class MostGrowing:
    """What the search for the modes that grow most starts from.

    Parameters
    ----------
    started : lambda with friction at the frequency of slow waves, `SLOW` of the spin, shape (n, m)
    slip : frequency of each over the drum, rad/s, 0 or above, shape (n, m)
    circles : displacements that tell the sense of a whirl, in pairs across the axis, shape (2 c, N)
    terms : T(lambda) and its derivative at points of shape (n, f), shape (n, f, N, N)
    """

    started: Complex
    slip: Array
    circles: Array
    terms: Callable[[Complex], tuple[Complex, Complex]]


def most_growing(search: MostGrowing, speed: Array) -> SystemModes:
    """The modes that grow most, each with laminar friction of its own frequency [theory: sections, eq. 6].

    Parameters
    ----------
    search : where to start from
    speed : Omega, rad/s, shape (n,)
    """
    root = search.started
    # Fast modes have more friction than that of slow waves, in proportion to the root of their frequency.
    more = np.sqrt(np.maximum(search.slip / (SLOW * speed[:, None]), 1.0))
    rate = np.where(root.real < 0.0, root.real * more, root.real)
    oscillating = np.where(root.imag > 1e-9 * speed[:, None], rate, -np.inf)
    most = np.argsort(-oscillating, axis=1)[:, :_FOLLOWED]
    root, shape, found = _followed(
        search.terms, np.take_along_axis(root, most, axis=1), len(search.circles.T)
    )
    along, against = _sizes(search.circles, shape)
    scale = np.abs(root) + speed[:, None]
    return SystemModes(root, np.where(along >= against, 1.0, -1.0), _RESOLVED * scale, found)


def _circles(layers: Sequence[SectionLayer]) -> Array:
    """Displacement of the axis and of each layer's centre, in pairs across the axis."""
    shifts = [one.liquid.moment / one.liquid.liquid_area for one in layers]
    return np.asarray(block_diag(np.eye(2), *shifts))


def _sizes(circles: Array, shape: Complex) -> tuple[Array, Array]:
    """Squared sizes of the circles along and against the spin of modes, shape (n, f) from (n, f, N)."""
    moved = shape @ circles.T
    x, y = moved[..., ::2], moved[..., 1::2]
    along, against = (np.square(np.abs(x + turn * y)).sum(axis=-1) for turn in (1j, -1j))
    return along, against


def _followed(
    terms: Callable[[Complex], tuple[Complex, Complex]], start: Complex, size: int
) -> tuple[Complex, Complex, NDArray[np.bool_]]:
    """Newton's method on each mode with its own laminar friction.

    Parameters
    ----------
    terms : of `MostGrowing`
    start : first values of f modes at each of n speeds, above the real axis, shape (n, f)
    size : N of the matrices

    Returns
    -------
    Modes, shape (n, f); their shapes, (n, f, N); whether they settled, (n, f)
    """
    root = start.astype(complex)
    shape = np.broadcast_to(np.ones(size, dtype=complex) + 0.1j * np.arange(size), (*root.shape, size)).copy()
    found = np.zeros(root.shape, dtype=bool)
    for _ in range(_STEPS):
        # A mode met to rounding makes the matrix singular to rounding, which is wanted; a hair away it is
        # never exactly so.
        near = root * (1.0 + _HAIR)
        matrix, slope = terms(near)
        solved = np.linalg.solve(matrix, slope @ shape[..., None])[..., 0]
        anchor = np.argmax(np.abs(solved), axis=-1)[..., None]
        largest = np.take_along_axis(solved, anchor, -1)
        step = (np.take_along_axis(shape, anchor, -1) / largest)[..., 0]
        root = np.where(found, root, near - step)
        shape = solved / largest
        found = found | (np.abs(step) <= _SETTLED * np.abs(root))
        if found.all():
            break
    return root, shape, found
