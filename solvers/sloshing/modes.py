"""Free oscillations of the liquid in a spinning drum of any section.

Fields vary as e^{-i sigma t} in the drum's frame. A mode and its complex conjugate at -sigma are one motion,
written with the sign for which crests run as e^{i n theta}, n > 0: a positive frequency is a prograde wave.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import cholesky, eigh, solve_triangular
from scipy.sparse import coo_array, csc_array
from scipy.sparse.linalg import splu

from meshes.arrays import Array, Complex, Indices
from meshes.errors import InputError, require_positive
from meshes.liquid_section import LiquidSection
from solvers.sloshing.system import Condensed, LiquidSystem, surface_forms

_GAUSS = np.polynomial.legendre.leggauss(8)
HARMONICS = 32  # crests round the drum that are looked for
# Modes nearer to one another than this, over their frequency, count as one frequency.
_ALIKE = 1e-7
# Imbalance of a mode's energies that rounding may leave, on meshes with very small cells.
_RESIDUAL = 1e-7
# Crests that differ by less than this part of their height are equally high: symmetry makes many so.
_TIE = 1e-5


@dataclass(frozen=True, eq=False)
class Spectrum:
    """Modes of a liquid at unit spin, of each pair the one above 0, the slowest ones or all."""

    frequency: Array  #: sigma/Omega, rising, shape (n,)
    #: eta in the condensed unknowns, eta* (B + sigma^2 K) eta = 1, mode by mode, shape (n, unknowns)
    amplitude: Complex


@dataclass(frozen=True, eq=False)
class SloshingModes:
    """Modes of the liquid, by rising size of the frequency; k modes, N nodes, S of them on the surface."""

    spin: float  #: Omega, rad/s
    frequency: Array  #: sigma relative to the drum, prograde positive, rad/s, shape (k,)
    amplitude: Complex  #: displacement's stream function in the condensed unknowns, m^2, shape (k, n)
    psi: Complex  #: stream function on the nodes for a largest displacement of 1 m, m^2/s, shape (k, N)
    displacement: Complex  #: of the surface along the radius, largest 1, shape (k, S)
    surface_nodes: Indices  #: nodes on the surface, shape (S,)
    harmonics: Complex  #: of the displacement, e^{i n theta} for n = -32 ... 32, shape (k, 65)
    crests: Indices  #: the n above 0 with the largest share, shape (k,)
    travelling: Array  #: from 0 for a standing oscillation to 1 for a wave that runs one way, shape (k,)
    multiplicity: Indices  #: number of modes with that frequency, shape (k,)
    residual: Array  #: imbalance of each mode's energies, relative, shape (k,)
    converged: bool  #: whether all residuals are rounding
    circulations: int  #: steady flows left out


def spectrum(system: LiquidSystem) -> Spectrum:
    """All modes by one Hermitian eigenproblem, frequencies real to rounding [theory: sloshing, eq. 11]."""
    n = len(system.inertia)
    root_k, root_b = cholesky(system.inertia, lower=True), cholesky(system.surface, lower=True)
    matrix = np.zeros((2 * n, 2 * n), dtype=complex)
    cross = solve_triangular(root_k, root_b, lower=True).T
    turned = solve_triangular(root_k, solve_triangular(root_k, system.gyration, lower=True).T, lower=True).T
    matrix[:n, n:], matrix[n:, :n] = cross, cross.T
    matrix[n:, n:] = -1j * (turned - turned.T)
    frequency, vectors = eigh(matrix, subset_by_index=(n, 2 * n - 1), overwrite_a=True)
    amplitude = solve_triangular(root_b.T, vectors[:n], lower=False)
    return Spectrum(frequency, np.ascontiguousarray(amplitude.T))


def sloshing_modes(
    system: Condensed, spin: float, count: int = 12, modes: Spectrum | None = None
) -> SloshingModes:
    """Slowest modes in the drum's frame, fewer if the mesh has fewer [theory: sloshing, eq. 10-12].

    `modes` hold at least the first one beyond those counted and all with its frequency; None: all of them,
    for which the system has to be dense.
    """
    require_positive("spin", spin)
    if count < 1 or count != int(count):
        raise InputError("count", count, "a whole number, 1 or more")
    if modes is None:
        assert isinstance(system, LiquidSystem)
        modes = spectrum(system)
    known = modes
    sigma = known.frequency[:count]
    group = _groups(known.frequency)
    kept = np.flatnonzero(group <= group[min(count, len(group)) - 1])
    eta = _told_apart(system, known.amplitude[kept], group[kept])[:count]
    inertia, turned, tension = system.products(eta)
    travel = _with(eta, turned).imag
    residual = _residual(sigma, _with(eta, inertia).real, travel, _with(eta, tension).real)
    sense = np.where(travel < 0.0, -1.0, 1.0)
    eta = np.where(sense[:, None] > 0.0, eta, eta.conj())
    frequency = sense * sigma * spin
    on_nodes = system.on_nodes(eta)
    nodes, xi = surface_displacement(system.section, on_nodes)
    at_crest = xi[np.arange(len(xi)), first_largest(xi)]
    eta, on_nodes, xi = (values / at_crest[:, None] for values in (eta, on_nodes, xi))
    shares = harmonics(system.section, on_nodes, HARMONICS)
    return SloshingModes(
        spin=spin,
        frequency=frequency,
        amplitude=eta,
        psi=-1j * frequency[:, None] * on_nodes,
        displacement=xi,
        surface_nodes=nodes,
        harmonics=shares,
        crests=1 + np.abs(shares[:, HARMONICS + 1 :]).argmax(axis=1),
        travelling=running(system.section, on_nodes),
        multiplicity=np.bincount(group)[group[:count]],
        residual=residual,
        converged=bool(np.all(residual < _RESIDUAL)),
        circulations=system.circulations,
    )


def first_largest(values: Complex) -> Indices:
    """Place of the first of the largest values of each row, of which rounding alone makes one the largest."""
    size = np.abs(values)
    return np.asarray((size >= (1.0 - _TIE) * size.max(axis=1, keepdims=True)).argmax(axis=1))


def _groups(frequency: Array) -> Indices:
    """Number of the cluster of frequencies that each belongs to."""
    apart = np.diff(frequency) > _ALIKE * frequency[1:]
    return np.concatenate([[0], np.cumsum(apart)]).astype(np.int64)


def _with(eta: Complex, product: Complex) -> Complex:
    """Scalar products of rows, shape (k,)."""
    return np.asarray((eta.conj() * product).sum(axis=1))


def _told_apart(system: Condensed, eta: Complex, group: Indices) -> Complex:
    """Within each cluster of equal frequencies the combinations that differ most in their harmonics.

    Any combination is a mode. The first harmonics lie in one mode each: at most two then push the drum.
    """
    found = eta.copy()
    for cluster in np.flatnonzero(np.bincount(group) > 1):
        here = np.flatnonzero(group == cluster)
        shares = harmonics(system.section, system.on_nodes(eta[here]), 8)
        order = np.argsort(np.abs(np.arange(-8, 9) - 0.25))  # 0, 1, -1, 2, -2, ...
        weight = np.empty(17)
        weight[order] = 3.0 ** -np.arange(17)
        weight[8] = 0.0
        energy = eta[here].conj() @ system.products(eta[here])[2].T
        _, mix = eigh((shares.conj() * weight) @ shares.T, 0.5 * (energy + energy.conj().T))
        found[here] = mix[:, ::-1].T @ eta[here]
    return found


def _residual(sigma: Array, kinetic: Array, travel: Array, tension: Array) -> Array:
    """Imbalance of the energies, |sigma^2 k - 2 sigma c - b|/(sigma^2 k + b) [theory: sloshing, eq. 12]."""
    left = np.square(sigma) * kinetic
    return np.asarray(np.abs(left - 2.0 * sigma * travel - tension) / (left + tension))


def surface_displacement(section: LiquidSection, eta: Complex) -> tuple[Indices, Complex]:
    """Nodes on the surface and displacement xi = eta_theta/a along the radius there, m, shape (k, S).

    A smooth function fitted on each stretch of surface [theory: sloshing, eq. 3]. Where the surface meets
    both sides of a baffle it has a node on either side.
    """
    nodes = np.unique(section.surface)
    sides = np.searchsorted(nodes, section.surface)
    x, y = section.points[section.surface[:, 0]].T
    u, v = section.points[section.surface[:, 1]].T
    turn = np.abs(np.arctan2(x * v - y * u, x * u + y * v))
    if section.order == 1:
        mass = np.array([[2.0, 1.0], [1.0, 2.0]]) / 6.0
    else:
        mass = np.array([[4.0, -1.0, 2.0], [-1.0, 4.0, 2.0], [2.0, 2.0, 16.0]]) / 30.0
    width = sides.shape[1]
    entries = (mass * turn[:, None, None]).ravel()
    places = (np.repeat(sides, width, axis=1).ravel(), np.tile(sides, (1, width)).ravel())
    matrix = csc_array(coo_array((entries, places), shape=(len(nodes),) * 2))
    gyration, _ = surface_forms(section)
    slope = (gyration @ eta.T)[nodes] / section.surface_radius
    fitted = splu(matrix).solve(np.concatenate([slope.real, slope.imag], axis=1))
    count = len(eta)
    return nodes, np.asarray((fitted[:, :count] + 1j * fitted[:, count:]).T)


def running(section: LiquidSection, eta: Complex) -> Array:
    """How much of a motion runs round the surface: oint Im(eta* eta_theta) over oint |eta eta_theta|.

    1 for a wave that runs with the spin as e^{i n theta}, 0 for a standing one, -1 against it, shape (k,).
    """
    _, values, slopes = _along_sides(section, eta)
    product = -values.conj() * slopes  # the sides run against the angle
    weight = 0.5 * _GAUSS[1]
    return np.asarray((product.imag @ weight).sum(axis=1) / (np.abs(product) @ weight).sum(axis=1))


def _along_sides(section: LiquidSection, eta: Complex) -> tuple[Array, Complex, Complex]:
    """Angles at the points of Gauss' rule on the sides, values and slopes d/dt, shapes (S, 8), (k, S, 8)."""
    t = 0.5 * (1.0 + _GAUSS[0])
    sides = section.surface
    x, y = section.points[sides[:, 0]].T
    u, v = section.points[sides[:, 1]].T
    turn = np.arctan2(x * v - y * u, x * u + y * v)
    angle = np.arctan2(y, x)[:, None] + turn[:, None] * t
    if section.order == 1:
        shapes, rises = [1.0 - t, t], [np.full_like(t, -1.0), np.ones_like(t)]
    else:
        shapes = [(1.0 - t) * (1.0 - 2.0 * t), t * (2.0 * t - 1.0), 4.0 * t * (1.0 - t)]
        rises = [4.0 * t - 3.0, 4.0 * t - 1.0, 4.0 - 8.0 * t]
    own = eta[:, sides]
    return angle, np.tensordot(own, np.array(shapes), axes=1), np.tensordot(own, np.array(rises), axes=1)


def harmonics(section: LiquidSection, eta: Complex, most: int) -> Complex:
    """Fourier coefficients of the displacement, (1/2 pi) oint xi e^{-i n theta} dtheta, m.

    For n = -most ... most, shape (k, 2 most + 1).
    """
    angle, _, rise = _along_sides(section, eta)
    n = np.arange(-most, most + 1)
    waves = np.exp(-1j * n * angle[:, :, None]) * (0.5 * _GAUSS[1])[:, None]
    # The sides run against the angle.
    total = -np.tensordot(rise, waves, axes=([1, 2], [0, 1]))
    return np.asarray(total / (2.0 * np.pi * section.surface_radius))
