"""The slowest modes of the liquid without dense matrices, by Lanczos' method with blocks.

With theta = 1/sigma at unit spin the modes are those of the Hermitian pencil

    theta [B 0; 0 K] (eta, zeta) = [2 i C, K; K, 0] (eta, zeta),    zeta = eta/theta,

whose largest theta are wanted, well apart from the many small ones [theory: sloshing, eq. 11]. K is applied
by a sparse solution inside the liquid, B is a band along the surface. The basis is kept orthogonal to
rounding, and as many vectors go together as stretches of the surface may swing alike, so that no mode of
several equal ones is missed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.linalg import eigh
from scipy.sparse import block_array, csc_array
from scipy.sparse.linalg import splu

from meshes.arrays import Array, Complex
from solvers.sloshing.modes import Spectrum
from solvers.sloshing.system import SurfaceSystem

_BLOCK = 8  # vectors at once, at least
_SETTLED = 1e-10  # residual over theta of a mode that is found
_ROUGH, _WAIT = 1e-6, 4  # residual that is left as it is where that many blocks more have not halved it
_MOST = 1500  # vectors of a basis
_ALIKE = 1e-6  # relative; frequencies nearer than that may be equal
_SMALL = 1e-9  # part of a vector that must stand across the others


@dataclass(frozen=True, eq=False)
class SlowModes:
    """The slowest modes of a liquid."""

    spectrum: Spectrum  #: at least as many as were asked for, and all as fast as the last of those
    converged: bool  #: all of them settled


def surface_solver(system: SurfaceSystem) -> Callable[[Any], Any]:
    """B x = f among motions without circulation, for columns f, shape (n, k)."""
    steady, held = system.steady, system.inertia_times(system.steady)
    # One value of each closed part is 0 at first; then the constant that leaves no circulation is added.
    grounded = np.argmax(steady, axis=0) if steady.shape[1] else np.empty(0, dtype=np.intp)
    free = np.setdiff1d(np.arange(len(steady)), grounded)
    # B = D^T W D with its fluxes g = W D x as unknowns: differences of cells of very unlike width stay exact.
    rise = system.rise[:, free]
    factors = splu(csc_array(block_array([[system.give, -rise], [rise.T, None]])))
    fluxes = system.rise.shape[0]
    strength = np.linalg.inv(steady.T @ held)

    def solve(right: Any) -> Any:
        if np.iscomplexobj(right):
            return solve(right.real) + 1j * solve(right.imag)
        left = right - held @ (strength @ (steady.T @ right))
        found = np.zeros_like(left)
        whole = np.concatenate([np.zeros((fluxes, left.shape[1])), left[free]])
        found[free] = factors.solve(whole)[fluxes:]
        return found - steady @ (strength @ (held.T @ found))

    return solve


def slowest_modes(system: SurfaceSystem, count: int) -> SlowModes:
    """The slowest modes at unit spin; fewer if the mesh has fewer."""
    size = len(system.steady) - system.steady.shape[1]
    block = min(max(_BLOCK, system.pieces + 2), size)
    krylov = _Krylov(system, block)
    wanted = min(count + 1, size)
    left: list[float] = []
    while True:
        krylov.extend()
        theta, vectors, residual = krylov.pairs()
        near = max(int(np.count_nonzero(theta > 0.0)), 1)
        done = krylov.full
        if near >= wanted:
            # All as fast as the last one wanted, and the next one after them.
            last = theta[wanted - 1] * (1.0 - _ALIKE)
            alike = int(np.count_nonzero(theta >= last))
            kept = min(alike + 1, near)
            left.append(float((residual[:kept] / theta[:kept]).max()))
            # Frequencies are right to the square of it; on very uneven meshes rounding leaves more.
            stuck = len(left) > _WAIT and left[-1] <= _ROUGH and left[-1] > 0.5 * left[-1 - _WAIT]
            if (left[-1] <= _SETTLED or stuck) and (alike < near or done):
                return SlowModes(krylov.spectrum(theta[:alike], vectors[:, :alike]), True)
        if done:
            kept = int(np.count_nonzero(theta > 0.0))
            settled = residual[:kept] <= _ROUGH * theta[:kept]
            return SlowModes(krylov.spectrum(theta[:kept], vectors[:, :kept]), bool(settled.all()))


def synchronous_force_ratio(system: SurfaceSystem) -> float:
    """Force on a drum in synchronous whirl over that of a full one, as far as it turns with the whirl.

    The liquid is at rest in the drum then, and B alone counts [theory: sloshing, eq. 13, 15].
    """
    moved = system.moment @ surface_solver(system)(system.moment.T)
    return float(system.liquid_area + 0.5 * np.trace(moved)) / system.enclosed_area


class _Krylov:
    """Orthonormal basis of the pencil's Krylov space and the pencil within it."""

    def __init__(self, system: SurfaceSystem, block: int) -> None:
        self.system, self.solve = system, surface_solver(system)
        self.held = system.inertia_times(system.steady)
        self.strength = np.linalg.inv(system.steady.T @ self.held)
        n = len(system.steady)
        self.most = min(2 * (n - system.steady.shape[1]), _MOST)
        # eta, zeta, and K zeta with B eta, column by column.
        self.eta, self.zeta, self.force, self.weight = (np.zeros((n, 0), dtype=complex) for _ in range(4))
        self.inner = np.zeros((0, 0), dtype=complex)
        self.beyond = np.zeros((0, 0), dtype=complex)
        draw = np.random.default_rng(0)
        start = draw.normal(size=(n, block)) + 1j * draw.normal(size=(n, block))
        eta = self.solve(start)
        zeta = self.solve(start[:, ::-1])
        self.new = eta, zeta, system.inertia_times(zeta)
        self.full = False

    def extend(self) -> None:
        """Take one block more into the basis."""
        eta, zeta, force = self._across(*self.new)
        if eta.shape[1] == 0:
            self.full = True
            return
        old = self.eta.shape[1]
        self.eta, self.zeta = np.hstack([self.eta, eta]), np.hstack([self.zeta, zeta])
        self.force = np.hstack([self.force, force])
        self.weight = np.hstack([self.weight, self.system.surface_times(eta)])
        # The pencil on the new ones.
        inertia = self.system.inertia_times(eta)
        image = self.solve(2j * (self.system.gyration @ eta) + force)
        self.new = image, eta, inertia
        within = self.weight.conj().T @ image + self.force.conj().T @ eta
        grown = np.zeros((self.eta.shape[1],) * 2, dtype=complex)
        grown[:old, :old] = self.inner
        grown[:, old:] = within
        grown[old:, :old] = within[:old].conj().T
        self.inner = grown
        self.full = self.eta.shape[1] >= self.most

    def _across(self, eta: Any, zeta: Any, force: Any) -> tuple[Any, Any, Any]:
        """Orthonormal columns for what of the new ones stands across the basis."""
        scale = 0.0
        for sweep in range(3):  # what the first one leaves of the basis, its division makes larger
            # Rounding brings in circulation, which B does not see.
            round_eta, round_zeta = (self.strength @ (self.held.T @ part) for part in (eta, zeta))
            eta, zeta = eta - self.system.steady @ round_eta, zeta - self.system.steady @ round_zeta
            # In the last sweep anew: the differences have lost digits.
            force = self.system.inertia_times(zeta) if sweep == 2 else force - self.held @ round_zeta
            if sweep == 0:
                scale = float(np.diag(self._products(eta, zeta, force)).real.max())
            along = self.weight.conj().T @ eta + self.force.conj().T @ zeta
            eta, zeta, force = eta - self.eta @ along, zeta - self.zeta @ along, force - self.force @ along
            size, turn = eigh(self._products(eta, zeta, force))
            kept = size > (_SMALL**2 * scale if sweep == 0 else 0.5)
            turn = turn[:, kept] / np.sqrt(size[kept])
            eta, zeta, force = eta @ turn, zeta @ turn, force @ turn
        return eta, zeta, force

    def _products(self, eta: Any, zeta: Any, force: Any) -> Complex:
        """Scalar products of columns with one another."""
        found = eta.conj().T @ (self.system.surface_times(eta)) + zeta.conj().T @ force
        return np.asarray(0.5 * (found + found.conj().T))

    def pairs(self) -> tuple[Array, Complex, Array]:
        """theta, falling; their vectors within the basis; what the pencil leaves of them outside it."""
        theta, vectors = eigh(0.5 * (self.inner + self.inner.conj().T))
        theta, vectors = theta[::-1], vectors[:, ::-1]
        image, eta, inertia = self.new
        # Of the last block alone the image leaves the basis.
        along = self.weight.conj().T @ image + self.force.conj().T @ eta
        left = image - self.eta @ along, eta - self.zeta @ along, inertia - self.force @ along
        sizes = left[0].conj().T @ (self.system.surface_times(left[0])) + left[1].conj().T @ left[2]
        tail = vectors[-image.shape[1] :]
        residual = np.sqrt(np.maximum(np.einsum("ik,ij,jk->k", tail.conj(), sizes, tail).real, 0.0))
        return theta, vectors, residual

    def spectrum(self, theta: Array, vectors: Complex) -> Spectrum:
        """Modes of some of the pairs."""
        eta = self.eta @ vectors
        inertia, surface = self.system.inertia_times(eta), self.system.surface_times(eta)
        sigma = 1.0 / theta
        energy = (eta.conj() * (surface + np.square(sigma) * inertia)).sum(axis=0).real
        return Spectrum(sigma, np.ascontiguousarray((eta / np.sqrt(energy)).T))
