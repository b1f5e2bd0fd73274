"""Where small whirls of a rotor with layers neither grow nor decay: a branch of limit cycles begins at each.

Every mode is followed over the spin: with several layers the branch of one mode may begin or end inside the
band of another. The friction is that of the waves, a real rate [theory: whirl, eq. 30].
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fluid.whirl import layer_rate
from meshes.arrays import Array, Complex
from solvers.cycles.balance import Circular

_GRID = 201  # spins at which modes are looked at
_ROUNDS = 4  # in which the laminar friction of a mode comes to its slip
_NEUTRAL = 1e-9  # of the spin: a growth below it is that of a mode without any damping


class Edge(NamedTuple):
    """A small whirl that neither grows nor decays."""

    #: spin and whirl_speed: Omega and omega_w, rad/s
    spin: float
    whirl_speed: float
    moved: Complex  #: the rotor's coordinates, largest deflection of a layer's axis 1 m, complex, shape (p,)
    trough: float  #: of the deepest wave over the depth of its layer, for that deflection, 1/m


def small_whirl_edges(machine: Circular, range_: tuple[float, float]) -> tuple[Edge, ...]:
    """All small whirls with the spin that neither grow nor decay, by rising spin."""
    spins = np.linspace(*range_, _GRID)
    found: list[Edge] = []
    last: tuple[Complex, Complex] | None = None
    for k, spin in enumerate(spins.tolist()):
        roots, shapes = _modes(machine, spin, None if last is None else last[0])
        if last is not None:
            before, shapes_before = last
            for i in np.flatnonzero(before.real * roots.real < 0.0).tolist():
                if max(abs(before[i].real), abs(roots[i].real)) < _NEUTRAL * spin:
                    continue
                part = before[i].real / (before[i].real - roots[i].real)
                root = (1.0 - part) * before[i] + part * roots[i]
                at = (1.0 - part) * float(spins[k - 1]) + part * spin
                shape = shapes[:, i] if part > 0.5 else shapes_before[:, i]
                if root.imag > 0.0:
                    found.append(_edge(machine, at, float(root.imag), shape))
        last = roots, shapes
    return tuple(sorted(found, key=lambda edge: edge.spin))


def _modes(machine: Circular, spin: float, before: Complex | None) -> tuple[Complex, Complex]:
    """Roots lambda of all modes at a spin in the order of those before, 1/s, and the rotor's shapes."""
    places = machine.places
    # The friction of each mode has its own slip: all modes are found with that of one, which is kept.
    roots, vectors = _eigen(machine, spin, _rates(machine, spin, -0.15 * spin))
    if any(place.layer.stokes for place in places):
        for i in range(roots.size):
            for _ in range(_ROUNDS):
                near, shapes = _eigen(machine, spin, _rates(machine, spin, roots[i].imag - spin))
                k = int(np.argmin(np.abs(near - roots[i])))
                moved = abs(near[k] - roots[i])
                roots[i], vectors[:, i] = near[k], shapes[:, k]
                if moved < 1e-6 * spin:
                    break
    if before is not None:
        from scipy.optimize import linear_sum_assignment

        _, order = linear_sum_assignment(np.abs(before[:, None] - roots[None, :]))
        roots, vectors = roots[order], vectors[:, order]
    return roots, vectors[: len(machine.mass)]


def _edge(machine: Circular, spin: float, whirl_speed: float, shape: Complex) -> Edge:
    """An edge with its wave, which [theory: whirl, eq. 4] has."""
    sizes = np.array([abs(place.row @ shape) for place in machine.places])
    shape = shape / sizes.max()
    slip = whirl_speed - spin
    rates = _rates(machine, spin, slip)
    troughs = []
    for place, rate, size in zip(machine.places, rates.tolist(), (sizes / sizes.max()).tolist(), strict=True):
        t = place.layer.layer_tanh
        left = slip**2 - 2.0 * t * spin * slip - t * spin**2 - 1j * rate * slip
        # The surface's wave over the offset of the centre of mass is kappa - 1.
        troughs.append(size * whirl_speed**2 * t / abs(left) / place.fill.depth)
    return Edge(spin, whirl_speed, shape, max(troughs))


def _rates(machine: Circular, spin: float, slip: float) -> Array:
    """Friction of each layer without the inertia of wall layers, 1/s."""
    return np.array([layer_rate(place.layer, spin, slip).real for place in machine.places])


def _eigen(machine: Circular, spin: float, rates: Array) -> tuple[Complex, Complex]:
    """Roots and vectors of rotor and layers, the circles of [theory: whirl, eq. 7]."""
    p, count = len(machine.mass), len(machine.places)
    size = p + count
    mass, damping, stiffness = np.zeros((3, size, size), dtype=complex)
    mass[:p, :p] = machine.mass
    damping[:p, :p] = machine.damping + spin * machine.gyroscopic
    stiffness[:p, :p] = machine.stiffness
    for j, (place, rate) in enumerate(zip(machine.places, rates.tolist(), strict=True)):
        row, own, t = place.row, p + j, place.layer.layer_tanh
        mass[:p, :p] += place.mass * np.outer(row.conj(), row)
        mass[:p, own] = place.mass * row.conj()
        mass[own, :p], mass[own, own] = 0.5 * (1.0 - t) * row, 1.0
        damping[own, own] = rate - 2j * (1.0 + t) * spin
        stiffness[own, own] = -(1.0 + t) * spin**2 - 1j * rate * spin
    state = np.zeros((2 * size, 2 * size), dtype=complex)
    state[:size, size:] = np.eye(size)
    state[size:] = -np.linalg.solve(mass, np.hstack([stiffness, damping]))
    roots, vectors = np.linalg.eig(state)
    return roots, vectors
