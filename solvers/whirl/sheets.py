"""All modes with laminar friction, which goes with the root of the slip, at once: eigenvalues of polynomials.

Another unknown in place of the frequency makes polynomials of the roots. Zeros count for which the roots have
positive real parts: the layer decays away from its wall. None can be missed.
"""

from __future__ import annotations

import numpy as np

from meshes.arrays import Array, Complex
from solvers.whirl.system import CoupledMatrices

_NONE = complex(np.nan, np.nan)


def standing_roots(matrices: CoupledMatrices, drags: Complex, speed: Array) -> Complex:
    """lambda of M z'' + C z' + K z, 1/s, with laminar drags of both senses of circle [theory: whirl, eq. 20].

    Drags (lambda -+ i Omega)^1.5 D, D of circles along and against the spin; with lambda = i Omega (z^2 +
    z^-2)/2 both roots are sqrt(2 i Omega) (z -+ 1/z)/2. nan in place of those on other sheets, shape (n, 8
    N).
    """
    inverse, spin = np.linalg.inv(np.linalg.cholesky(matrices.mass)), speed[:, None, None]
    along, against, damping, stiffness = (
        inverse @ matrix @ inverse.T for matrix in (*drags, matrices.damping, matrices.stiffness)
    )
    # Frequencies over the spin.
    damping, stiffness = damping / spin, stiffness / np.square(spin)
    cube = (2j) ** 1.5 / 8.0 / np.sqrt(spin)
    both, apart = cube * (along + against), cube * (against - along)
    unit = np.eye(len(inverse))
    # Coefficients of z^0 to z^8, times z^4; the last one is -1/4.
    parts: Complex = np.zeros((8, speed.size, *unit.shape), dtype=complex)
    parts[0], parts[2], parts[6] = -0.25 * unit, 0.5j * damping, 0.5j * damping
    parts[4] = stiffness - 0.5 * unit
    parts[7], parts[5], parts[3], parts[1] = both, 3.0 * apart, 3.0 * both, apart
    z = _zeros(np.asarray(4.0 * parts, dtype=complex))
    roots = 0.5 * np.sqrt(2j) * (z - 1.0 / z), 0.5 * np.sqrt(2j) * (z + 1.0 / z)
    shown = (roots[0].real > 0.0) & (roots[1].real > 0.0)
    found = 0.5j * (np.square(z) + 1.0 / np.square(z)) * speed[:, None]
    return np.where(shown, found, _NONE)


def drum_roots(matrices: CoupledMatrices, laminar: Array, speed: Array) -> Complex:
    """lambda of M z'' + C z' + K z with a drag lambda^1.5 S, 1/s: those of a polynomial in sqrt(lambda).

    nan in place of those on other sheets, shape (n, 4 N).
    """
    inverse, spin = np.linalg.inv(np.linalg.cholesky(matrices.mass)), speed[:, None, None]
    drag, damping, stiffness = (
        inverse @ matrix @ inverse.T for matrix in (laminar, matrices.damping, matrices.stiffness)
    )
    parts: Complex = np.zeros((4, *damping.shape), dtype=complex)
    parts[0], parts[2], parts[3] = stiffness / np.square(spin), damping / spin, drag / np.sqrt(spin)
    z = _zeros(-parts)
    return np.where(z.real > 0.0, np.square(z) * speed[:, None], _NONE)


def _zeros(parts: Complex) -> Complex:
    """z with det(z^d - sum parts[k] z^k) = 0, d of them, shape (d, n, N, N); shape (n, d N)."""
    degree, count, size, _ = parts.shape
    state = np.zeros((count, degree * size, degree * size), dtype=complex)
    state[:, :-size, size:] = np.eye((degree - 1) * size)
    state[:, -size:] = np.concatenate(list(parts), axis=2)
    return np.asarray(np.linalg.eigvals(state))
