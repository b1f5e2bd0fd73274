"""Liquid of any section reduced to the few motions that a whirl of its drum drives.

The condensed liquid answers a uniform force over all frequencies; a handful of such answers span what matters
to a rotor. The projection keeps the symmetries of the matrices, hence real frequencies and the energy.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import cholesky, solve_triangular

if TYPE_CHECKING:  # which loads scikit-fem
    from solvers.sloshing_system import LiquidSystem

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

# Frequencies over the spin whose answers are kept, off the real axis where no wave resonates; with them go
# rest and the limit of very fast whirl.
KEPT = (0.2 + 0.08j, 0.45 + 0.12j, 0.75 + 0.15j, 1.1 + 0.2j, 1.6 + 0.4j)
_DISTINCT = 1e-10  # of a new answer that must stand across the others


@dataclass(frozen=True, eq=False)
class ReducedLiquid:
    """K eta'' + 2 Omega C eta' + Omega^2 B eta = -P^T f and Q = -rho P eta, in m motions.

    Parameters
    ----------
    inertia : K, the unit matrix, shape (m, m)
    gyration : C, antisymmetric, shape (m, m)
    surface : B, symmetric, positive definite, shape (m, m)
    moment : P, shape (2, m), m
    motions : what they are in the condensed unknowns, shape (n, m)
    liquid_area, enclosed_area : as in `LiquidSystem`, m^2
    """

    inertia: Array
    gyration: Array
    surface: Array
    moment: Array
    motions: Array
    liquid_area: float
    enclosed_area: float

    def compliance(self, slip_ratio: ArrayLike) -> Complex:
        """First moment of the displaced liquid for a uniform force [theory: sections, eq. 2].

        Parameters
        ----------
        slip_ratio : s/Omega of a force f e^{i s t} in the drum's frame, shape (k,)

        Returns
        -------
        Q Omega^2/(rho h f) over the two directions, shape (k, 2, 2), m^2
        """
        s = np.asarray(slip_ratio, dtype=complex)[:, None, None]
        matrix = -np.square(s) * self.inertia + 2j * s * self.gyration + self.surface
        drive = np.broadcast_to(self.moment.T, (len(s), *self.moment.T.shape))
        return np.asarray(self.moment @ np.linalg.solve(matrix, drive))

    def force_ratio(self, slip_ratio: ArrayLike) -> Array:
        """Force on a drum that whirls in a circle over that of a full one, as far as it turns with the whirl.

        Parameters
        ----------
        slip_ratio : s/Omega, of the whirl as seen from the drum, shape (k,)

        Returns
        -------
        G, shape (k,) [theory: sections, eq. 2]
        """
        s, found = np.asarray(slip_ratio, dtype=float), self.compliance(slip_ratio)
        along, across = found[:, 0, 0] + found[:, 1, 1], found[:, 0, 1] - found[:, 1, 0]
        moved = 0.5 * (along - 1j * across).real
        return np.asarray((self.liquid_area + np.square(1.0 + s) * moved) / self.enclosed_area)


def reduce_liquid(system: LiquidSystem) -> ReducedLiquid:
    """Keep the motions that answer a uniform force [theory: sections, eq. 1].

    Parameters
    ----------
    system : the condensed liquid
    """
    root = cholesky(system.inertia, lower=True)

    def scaled(matrix: Array) -> Array:
        half = solve_triangular(root, matrix, lower=True)
        return np.asarray(solve_triangular(root, half.T, lower=True).T)

    gyration, surface = scaled(system.gyration), scaled(system.surface)
    drive = solve_triangular(root, system.moment.T, lower=True)
    answers = [drive, np.linalg.solve(surface, drive)]
    unit = np.eye(len(drive))
    for s in KEPT:
        answer = np.linalg.solve(-s * s * unit + 2j * s * gyration + surface, drive)
        answers += [answer.real, answer.imag]
    basis = spanned(np.hstack(answers))
    motions = solve_triangular(root.T, basis, lower=False)
    turn, spread = (basis.T @ one @ basis for one in (gyration, surface))
    return ReducedLiquid(
        inertia=np.eye(basis.shape[1]),
        gyration=0.5 * (turn - turn.T),
        surface=0.5 * (spread + spread.T),
        moment=drive.T @ basis,
        motions=np.asarray(motions),
        liquid_area=system.liquid_area,
        enclosed_area=system.enclosed_area,
    )


def spanned(vectors: Any, distinct: float = _DISTINCT) -> Any:
    """Orthonormal columns that span others, but for what rounding and near repetition add.

    Parameters
    ----------
    vectors : real or complex, shape (n, k)
    distinct : part of a vector that must stand across the others

    Returns
    -------
    Shape (n, m), m at most k.
    """
    kept: list[Any] = []
    for vector in vectors.T:
        one = vector / np.linalg.norm(vector)
        for _ in range(2):  # twice is enough
            for other in kept:
                one = one - other * np.vdot(other, one)
        size = float(np.linalg.norm(one))
        if size > distinct:
            kept.append(one / size)
    return np.stack(kept, axis=1)
