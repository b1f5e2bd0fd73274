"""What a mode looks like: displacement of the free surface and its harmonics."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csc_array
from scipy.sparse.linalg import splu

from meshes.liquid_section import LiquidSection
from solvers.sloshing_system import surface_forms

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Indices = NDArray[np.int64]

_GAUSS = np.polynomial.legendre.leggauss(8)


def surface_displacement(section: LiquidSection, eta: Complex) -> tuple[Indices, Complex]:
    """Displacement xi = eta_theta/a along the radius, as a smooth function fitted on each stretch of surface.

    [theory: sloshing, eq. 3]. Where the surface meets both sides of a baffle it has a node on either side.

    Parameters
    ----------
    section : the liquid at rest
    eta : stream function of the displacement on the nodes, m^2, shape (k, N)

    Returns
    -------
    Nodes on the surface, shape (S,), and the displacement there, m, shape (k, S).
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

    Parameters
    ----------
    section : the liquid at rest
    eta : stream function of the displacement on the nodes, shape (k, N)

    Returns
    -------
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
    """Fourier coefficients of the displacement, (1/2 pi) oint xi e^{-i n theta} dtheta.

    Parameters
    ----------
    section : the liquid at rest
    eta : stream function of the displacement on the nodes, m^2, shape (k, N)
    most : largest n

    Returns
    -------
    Coefficients for n = -most ... most, m, shape (k, 2 most + 1).
    """
    angle, _, rise = _along_sides(section, eta)
    n = np.arange(-most, most + 1)
    waves = np.exp(-1j * n * angle[:, :, None]) * (0.5 * _GAUSS[1])[:, None]
    # The sides run against the angle.
    total = -np.tensordot(rise, waves, axes=([1, 2], [0, 1]))
    return np.asarray(total / (2.0 * np.pi * section.surface_radius))
