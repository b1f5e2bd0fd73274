"""Whirl modes of any rotor with layers of laminar friction: a nonlinear eigenproblem.

The drag of an oscillating laminar layer goes with the square root of the slip, so it differs from mode to
mode. The layers are eliminated; the modes are the zeros of a determinant, found together by Aberth's
iteration.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fluid.whirl import Layer, stokes_rate
from meshes.arrays import Array, Complex
from solvers.rotor.system import RotorSystem
from solvers.whirl.system import SystemModes, circles_of, coupled_matrices, linear_modes, sense_of

Placed = tuple[float, Layer]

_EPS = float(np.finfo(float).eps)
_SWEEPS = 100
_STEP = 1e-13  # relative, at which a root counts as found
_GONE = -1e300  # lambda of what has no wave, 1/s
_LEAST = 1e-7  # relative, which noise of the determinant may hide
# Complex displacements along and against the spin from the two real ones, and back.
_CIRCLES = np.array([[1.0, 1.0j], [1.0, -1.0j]], dtype=complex)
_AXES = np.array([[0.5, 0.5], [-0.5j, 0.5j]], dtype=complex)


@dataclass(frozen=True)
class _Eliminated:
    """T(lambda) q = 0 of the rotor with its layers eliminated, at points of shape (n, m).

    Parameters
    ----------
    matrix, slope : T and dT/d lambda, shape (n, m, N, N)
    poles : d log/d lambda of the poles that the elimination brings, shape (n, m)
    along, against : squared size of all circles of the axis and the offsets that go with the spin and against
        it, as Hermitian forms of q, shape (n, m, N, N)
    """

    matrix: Complex
    slope: Complex
    poles: Complex
    along: Complex
    against: Complex


def laminar_modes(system: RotorSystem, layers: Sequence[Placed], speed: Array) -> SystemModes:
    """Modes with laminar friction, whose drag depends on the mode [theory: whirl, eq. 12-14].

    Started from the rotor with its liquid at rest and from the waves of each layer on a drum at rest. Layers
    that are equal have waves against one another that do not move the rotor: these are the free ones.

    Parameters
    ----------
    system, layers, speed : as for `solvers.whirl.system.coupled_matrices`
    """
    groups = _groups(system, layers)
    heavy = system
    for plane, layer in layers:
        at = system.at(plane)
        heavy = replace(heavy, mass=heavy.mass + layer.mass * at.T @ at)
    dry = linear_modes(coupled_matrices(heavy, [], speed), circles_of(heavy, []))
    waves = [_layer_waves(layers[members[0]][1], speed) for members, _ in groups]
    # Off their places, each by its own step, so that no two start alike or on a pole.
    turn = 1j * speed[:, None]
    started = [dry.root * (1.0 + 1e-3 * (1.0 + 0.37j) * (1.0 + np.arange(dry.root.shape[1]) / 3.0))]
    for wave, (_, rank) in zip(waves, groups, strict=True):
        for k in range(rank):
            pushed = turn + (wave - turn) * (1.0 + 1e-3 * (1.0 + 0.37j) * (1.0 + k))
            started += [pushed, pushed.conj()]
    start = np.concatenate(started, axis=1)
    weights = np.ones(len(layers))
    for members, rank in groups:
        weights[members] = rank / len(members)
    modes = _aberth(system, layers, weights, start, speed)
    free = [wave for wave, (members, rank) in zip(waves, groups, strict=True) if rank < len(members)]
    if not free:
        return modes
    more = np.concatenate(free, axis=1)
    gone = np.isnan(more)
    more = np.where(gone, _GONE, more)
    return SystemModes(
        np.concatenate([modes.root, more], axis=1),
        np.concatenate([modes.sense, np.ones(more.shape)], axis=1),
        np.concatenate([modes.rounding, 16.0 * _EPS * (np.abs(more) + speed[:, None])], axis=1),
        np.concatenate([modes.found, ~gone], axis=1),
    )


def _groups(system: RotorSystem, layers: Sequence[Placed]) -> list[tuple[list[int], int]]:
    """Equal layers, and in how many independent ways they move with the rotor."""
    found: dict[tuple[float, float, float], list[int]] = {}
    for j, (_, layer) in enumerate(layers):
        found.setdefault((layer.layer_tanh, layer.rate, layer.stokes), []).append(j)
    ranks = []
    for members in found.values():
        along = np.array([_CIRCLES[0] @ system.at(layers[j][0]) for j in members])
        ranks.append(int(np.linalg.matrix_rank(along)))
    return list(zip(found.values(), ranks, strict=True))


def _layer_waves(layer: Layer, speed: Array) -> Complex:
    """Free waves of a layer with laminar friction, lambda, nan for what has no wave, shape (n, 4).

    Zeros of E in p = sqrt(i s/Omega) with a positive real part [theory: whirl, eq. 13].
    """
    t, rate = layer.layer_tanh, layer.rate / speed
    companion = np.zeros((speed.size, 4, 4), dtype=complex)
    companion[:, 1:, :3] = np.eye(3)
    # p^4 + stokes p^3 + (k - 2 i T) p^2 + T = 0.
    companion[:, 0, 3] = -t
    companion[:, 2, 3] = 2j * t - rate
    companion[:, 3, 3] = -layer.stokes / np.sqrt(speed)
    p = np.linalg.eigvals(companion)
    waves = (np.square(p) + 1j) * speed[:, None]
    return np.where(p.real > 0.0, waves, complex(np.nan, np.nan))


def _aberth(
    system: RotorSystem, layers: Sequence[Placed], weights: Array, start: Complex, speed: Array
) -> SystemModes:
    """Zeros of the determinant from starting values; nan starts stay nan."""
    spin, absent = speed[:, None], np.isnan(start)
    root = np.where(absent, 0.0, start)
    step, last = np.zeros_like(root), np.zeros(root.shape)
    for _ in range(_SWEEPS):
        here = _eliminate(system, layers, weights, root, spin)
        inner = _solve(here.matrix, here.slope)
        slope = np.trace(inner, axis1=-2, axis2=-1) + here.poles
        gap = root[:, :, None] - root[:, None, :]
        other = np.zeros_like(gap)
        np.divide(1.0, gap, out=other, where=(np.abs(gap) > 0.0) & ~absent[:, None, :])
        bottom = slope - other.sum(axis=2)
        last, step = np.abs(step), np.zeros_like(root)
        np.divide(1.0, bottom, out=step, where=(np.abs(bottom) > 0.0) & ~absent)
        root = root - step
        scale = np.abs(root) + spin
        if np.all(np.abs(step) <= _STEP * scale):
            break
    here = _eliminate(system, layers, weights, root, spin)
    # One step of inverse iteration: next to its zero the matrix hardly leaves anything but the mode.
    vector = _solve(here.matrix, np.exp(1j * np.arange(here.matrix.shape[-1]))[:, None])[..., 0]
    vector = vector / np.abs(vector).max(axis=-1, keepdims=True)
    along, against = (
        np.einsum("...i,...ij,...j", vector.conj(), form, vector).real for form in (here.along, here.against)
    )
    found = (np.abs(step) <= _LEAST * scale) & ~absent
    rounding = 16.0 * (_EPS * scale + np.where(found, np.maximum(np.abs(step), last * _LEAST), 0.0))
    # What has no wave decays faster than any that has.
    root = np.where(absent, _GONE, root)
    return SystemModes(root, sense_of(along, against), rounding, found)


def _solve(matrix: Complex, right: Complex) -> Complex:
    """Solution; where the elimination stops, on a root to the last digit, that right next to it."""
    right = np.broadcast_to(right, (*matrix.shape[:-1], right.shape[-1]))
    try:
        return np.asarray(np.linalg.solve(matrix, right))
    except np.linalg.LinAlgError:
        exact = np.linalg.slogdet(matrix)[0] == 0.0
        size = np.where(exact, _EPS * np.abs(matrix).max(axis=(-2, -1)), 0.0)
        return np.asarray(np.linalg.solve(matrix + size[..., None, None] * np.eye(matrix.shape[-1]), right))


def _eliminate(
    system: RotorSystem, layers: Sequence[Placed], weights: Array, root: Complex, spin: Array
) -> _Eliminated:
    """Rotor and layers at values of lambda [theory: whirl, eq. 14]."""
    at, rate = root[..., None, None], spin[..., None, None]
    damping = system.damping + rate * system.gyroscopic
    matrix = at * (at * system.mass + damping) + system.stiffness
    slope = 2.0 * at * system.mass + damping
    poles, forms = np.zeros_like(root), [np.zeros_like(matrix), np.zeros_like(matrix)]
    for (plane, layer), weight in zip(layers, weights, strict=True):
        t, place = layer.layer_tanh, system.at(plane)
        for side, sense in enumerate((1.0, -1.0)):
            circle = _CIRCLES[side] @ place
            shape = np.outer(place.T @ _AXES[:, side], circle)
            turned = root - 1j * sense * spin
            friction = stokes_rate(layer.stokes, -1j * turned)
            # W and its slope, W d = -(1 - T)/2 lambda^2 w.
            wave = root * (root - 2j * sense * (1.0 + t) * spin) - (1.0 + t) * np.square(spin)
            wave = wave + (layer.rate + friction) * turned
            bend = 2.0 * root - 2j * sense * (1.0 + t) * spin + layer.rate + 1.5 * friction
            wave = np.where(wave == 0.0, _EPS * np.square(spin), wave)
            share = 0.5 * (1.0 - t) * np.square(root) / wave
            force = layer.mass * np.square(root) * (1.0 - share)
            change = layer.mass * root * (2.0 - 4.0 * share + root * share * bend / wave)
            matrix = matrix + force[..., None, None] * shape
            slope = slope + change[..., None, None] * shape
            poles += weight * bend / wave
            moved = 1.0 + np.square(np.abs(share))
            forms[side] = forms[side] + moved[..., None, None] * np.outer(circle.conj(), circle)
    return _Eliminated(matrix, slope, poles, *forms)
