"""Whirl modes of a rotor that moves in one plane with its layers: all roots of a characteristic polynomial.

Many points at once, by Aberth's simultaneous iteration. The polynomial is in the slip s; with laminar
friction, whose drag goes with sqrt(i s), in that root, and zeros count whose real part is positive
[theory: whirl, eq. 13].
"""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fluid.whirl import damped_waves, plate_rate, plate_terms, stokes_rate
from meshes.arrays import Array, Complex, Flags

_CHUNK = 4096  # points whose arrays fit the processor's cache
_THREADS = 4
_FEW = 128  # points up to which all pairs of roots are worked out in one step
_SWEEPS = 90
_CHECK = 2  # sweeps between looks at who is done
_OWN = 24  # sweeps of modes with floor and lid at their own frequency
_STEP, _NEAR = 1e-7, 1e-5  # of the root, of the distance to the next: a step after which a root is exact
_ROUGH = 3e-2  # of both: after which it may be followed to where floor and lid have its own frequency
_EPS = float(np.finfo(float).eps)
_TINY = 1e-290


@dataclass(frozen=True)
class PlanarProblem:
    """A rotor with layers at p points, each a machine of its own at its own spin; g layers."""

    mass: Array  #: M with all liquid that has no free surface, kg, shape (p,)
    stiffness: Array  #: K, N/m, and C, N s/m, shape (p,)
    damping: Array
    spin: Array  #: Omega, rad/s, shape (p,), above 0
    liquid: Array  #: of each layer as in `fluid.whirl.Layer`, shape (g, p)
    layer_tanh: Array
    rate: Array
    stokes: Array
    lids: Array

    def part(self, which: slice | Flags | NDArray[np.intp]) -> PlanarProblem:
        """The same at some of the points."""
        return PlanarProblem(
            self.mass[which],
            self.stiffness[which],
            self.damping[which],
            self.spin[which],
            self.liquid[:, which],
            self.layer_tanh[:, which],
            self.rate[:, which],
            self.stokes[:, which],
            self.lids[:, which],
        )


@dataclass(frozen=True)
class Modes:
    """Whirl modes, m of them at p points."""

    #: s = omega - Omega, rad/s, e^{i s t} in the drum; nan where a point has fewer modes, shape (m, p)
    slip: Complex
    rounding: Array  #: bound of what rounding has done to each, rad/s, shape (m, p)
    converged: Flags  #: shape (p,)


@dataclass(frozen=True)
class _Scaled:
    """The problem over Omega and M: polynomial coefficients, shape (p,) and (g, p)."""

    stiffness: Array
    damping: Array
    mass: Array
    tanh: Array
    plain: Complex  #: 2 T + i k of linear friction
    linear: Complex  #: the same with floor and lid; of each root, shape (g, m, p)
    bent: Complex  #: its slope over s
    stokes: Array
    lids: Array
    coupling: Array
    laminar: bool


def planar_modes(problem: PlanarProblem) -> Modes:
    """All modes of the rotor and its layers [theory: whirl, eq. 8].

    2 + 2 g of them; with laminar friction up to twice as many.
    """
    points = problem.spin.size
    chunks = [problem.part(slice(i, i + _CHUNK)) for i in range(0, points, _CHUNK)]
    if len(chunks) == 1:
        return _chunk(chunks[0])
    # Each chunk is work on long arrays, which lets other threads run; their number changes no digit.
    with ThreadPoolExecutor(max_workers=min(_THREADS, os.cpu_count() or 1)) as pool:
        parts = list(pool.map(_chunk, chunks))
    return Modes(
        np.concatenate([part.slip for part in parts], axis=1),
        np.concatenate([part.rounding for part in parts], axis=1),
        np.concatenate([part.converged for part in parts]),
    )


def _chunk(problem: PlanarProblem) -> Modes:
    scaled = _scaled(problem)
    x, converged = _aberth(scaled, _starts(scaled))
    if np.any(scaled.lids > 0.0):
        # Of the roots those that are modes.
        most = max(int((x.real > 0.0).sum(axis=0).max()), 1)
        x = np.take_along_axis(x, np.argsort(-x.real, axis=0)[:most], axis=0)
        before = x
        x, settled = _aberth(scaled, x, x.real > 0.0)
        late = np.flatnonzero(~settled)
        if late.size:
            here = _part(scaled, ~settled)
            x[:, late], settled[late] = _past_cuts(here, x[:, late], before[:, late])
        converged, scaled = converged & settled, _own(scaled, x)
    noise = _rounding(scaled, x)
    if scaled.laminar:
        # s = -i x^2; a root within rounding of the cut decays in any case.
        noise = 2.0 * np.abs(x) * noise
        admitted = x.real > 0.0
        x = np.where(admitted, -1j * np.square(x), complex(np.nan, np.nan))
        more = ((0, 4 + 4 * len(scaled.tanh) - len(x)), (0, 0))
        x, noise = np.pad(x, more, constant_values=complex(np.nan, np.nan)), np.pad(noise, more)
    return Modes(x * problem.spin, noise * problem.spin, converged)


def _scaled(problem: PlanarProblem) -> _Scaled:
    spin, mass = problem.spin, problem.mass
    share, t = problem.liquid / mass, problem.layer_tanh
    # Floor and lid drag on the slower wave, until each mode is known.
    stokes, lids = problem.stokes / np.sqrt(spin), problem.lids / np.sqrt(spin)
    plates = lids * plate_rate(t, 1.0, t - np.sqrt(np.square(t) + t))
    plain = 2.0 * t + 1j * problem.rate / spin
    linear = plain + 1j * plates
    return _Scaled(
        stiffness=problem.stiffness / mass / np.square(spin),
        damping=problem.damping / mass / spin,
        mass=1.0 + share.sum(axis=0),
        tanh=t,
        plain=plain,
        linear=linear,
        bent=np.zeros_like(linear),
        stokes=stokes,
        lids=lids,
        coupling=share * 0.5 * (1.0 - t),
        laminar=bool(np.any(problem.stokes > 0.0)),
    )


def _starts(scaled: _Scaled) -> Complex:
    """The modes as if rotor and layers did not feel one another, off the real axis to break its symmetry."""
    slow, fast = damped_waves(scaled.tanh, 1.0, scaled.linear.imag)
    if scaled.laminar:
        # The laminar drag of a frictionless wave, its part that damps.
        drag = stokes_rate(scaled.stokes, np.abs(np.stack([slow, fast]))).real
        slow = damped_waves(scaled.tanh, 1.0, scaled.linear.imag + drag[0])[0]
        fast = damped_waves(scaled.tanh, 1.0, scaled.linear.imag + drag[1])[1]
    decay = 0.5j * scaled.damping / scaled.mass
    swing = np.sqrt(scaled.stiffness / scaled.mass + np.square(decay))
    rotor = np.stack([decay + swing - 1.0, decay - swing - 1.0])
    s = np.concatenate([rotor, slow, fast])
    push = 0.01 + 0.007 * np.arange(s.shape[0])
    s = s + (1j * push)[:, None] * (1.0 + 0.3j) * np.maximum(np.abs(s), 1e-9)
    if not scaled.laminar:
        return np.asarray(s)
    x = np.sqrt(1j * s)
    return np.concatenate([x, -x])


def _own(scaled: _Scaled, x: Complex, other: Flags | None = None) -> _Scaled:
    """The problem with floor and lid as they drag on each root's own motion, with slopes, shape (g, m, p).

    Where `other` of shape (m, p) is set, the nearer end of a cut has its other root.
    """
    s, t, lids = -1j * np.square(x), scaled.tanh[:, None], scaled.lids[:, None]
    rate, slope = plate_terms(t, 1.0, s)
    if other is not None:
        side = np.where(s.real > 0.0, 1.0, -1.0)
        share = np.where(other, 1.0 + side * t, 0.0)
        one = plate_terms(side, 1.0, s)
        rate, slope = rate - share * one[0], slope - share * one[1]
    linear = scaled.plain[:, None] + 1j * lids * rate
    return replace(scaled, linear=linear, bent=1j * lids * slope)


def _past_cuts(scaled: _Scaled, x: Complex, before: Complex) -> tuple[Complex, Flags]:
    """Roots that the cuts of floor and lid are in the way of, and the points where all are known.

    From those `before`, in g = sqrt(i (s -+ 2 Omega)) of the nearer end, where there is no cut; a root with
    Re g < 0 is no mode, as its layers would not decay away from the wall.
    """
    value, slope = _polynomial(_own(scaled, x), x)
    lost = (before.real > 0.0) & ~(np.abs(value) <= _STEP * np.abs(slope * x))
    row, column = np.nonzero(lost)
    here, s = _part(scaled, column), -1j * np.square(before[row, column])[None]
    end = np.where(s.real > 0.0, 2.0, -2.0)
    g, moved = np.sqrt(1j * (s - end)), np.zeros_like(s)
    for _ in range(_OWN):
        root = np.sqrt(1j * end + np.square(g))
        value, slope = _polynomial(_own(here, root, g.real < 0.0), root)
        bottom = slope * g
        moved = np.divide(value * root, bottom, out=np.zeros_like(g), where=np.abs(bottom) > _TINY)
        g = g - moved
    settled = (np.abs(moved) <= _STEP * np.abs(g))[0]
    x = x.copy()
    x[row, column] = np.where(settled & (g.real > 0.0)[0], np.sqrt(1j * end + np.square(g))[0], -1.0)
    known = np.ones(x.shape[1], dtype=bool)
    known[column[~settled]] = False
    return x, known


def _polynomial(scaled: _Scaled, x: Complex) -> tuple[Complex, Complex]:
    """P and dP/dx, both over a positive number that keeps high powers in range [theory: whirl, eq. 8]."""
    s, ds = (-1j * x * x, -2j * x) if scaled.laminar else (x, np.ones_like(x))
    omega = 1.0 + s
    value = scaled.stiffness + omega * (1j * scaled.damping - scaled.mass * omega)
    slope = (1j * scaled.damping - 2.0 * scaled.mass * omega) * ds
    quartic = np.square(np.square(omega))
    steep = 4.0 * omega * omega * omega * ds
    many, square = len(scaled.tanh) > 1, x * x
    unit = 1.0 / (1.0 + np.square(s.real) + np.square(s.imag)) if many else 1.0
    if many:
        quartic, steep = quartic * unit, steep * unit
    free: Complex | float = 1.0
    free_slope: Complex | float = 0.0
    layers = scaled.tanh, scaled.linear, scaled.bent, scaled.stokes, scaled.coupling
    for t, b, c, drag, pull in zip(*layers, strict=True):
        rest = s - b
        wave, bend = s * rest - t, (s + rest - s * c) * ds
        if scaled.laminar:
            wave, bend = wave - drag * (square * x), bend - 3.0 * drag * square
        if many:
            wave, bend = wave * unit, bend * unit
        slope = slope * wave + value * bend + pull * (steep * free + quartic * free_slope)
        value = value * wave + pull * (quartic * free)
        free_slope, free = free_slope * wave + free * bend, free * wave
    return value, slope


def _noise(scaled: _Scaled, x: Complex) -> Array:
    """Error of the value of `_polynomial` by rounding, to first order [theory: whirl, eq. 15].

    That of each factor by the terms it is the sum of; the others scale it.
    """
    s = -1j * x * x if scaled.laminar else x
    size = np.abs(s)
    omega, largest = 1.0 + s, 1.0 + size
    value = scaled.stiffness + omega * (1j * scaled.damping - scaled.mass * omega)
    error = scaled.stiffness + largest * (scaled.damping + scaled.mass * largest)
    quartic, steep = np.square(np.square(omega)), np.square(np.square(largest))
    free, free_error = np.ones_like(x), np.zeros(x.shape)
    for t, b, drag, pull in zip(scaled.tanh, scaled.linear, scaled.stokes, scaled.coupling, strict=True):
        wave, terms = s * (s - b) - t, size * (size + np.abs(b)) + t
        if scaled.laminar:
            wave, terms = wave - drag * x * x * x, terms + drag * size * np.sqrt(size)
        error = error * np.abs(wave) + np.abs(value) * terms + pull * steep * (np.abs(free) + free_error)
        value = value * wave + pull * quartic * free
        free_error, free = free_error * np.abs(wave) + np.abs(free) * terms, free * wave
        if len(scaled.tanh) > 1:
            unit = 1.0 / (1.0 + np.square(size))
            value, error, free, free_error = value * unit, error * unit, free * unit, free_error * unit
    return np.asarray(10.0 * _EPS * error)


def _pairs(x: Complex) -> tuple[Complex, Array]:
    """Sum of 1/(x_i - x_j) over the other roots, and the distance of the nearest, shape (m, p)."""
    if x.shape[1] <= _FEW:
        every = np.arange(x.shape[0])
        gap = x[:, None] - x
        gap[every, every] = np.inf
        if not gap.all():
            gap = np.where(gap == 0.0, np.sign(every[:, None] - every)[:, :, None] * _apart(x)[:, None], gap)
        return (1.0 / gap).sum(axis=1), np.abs(gap).min(axis=1)
    # Of many points each pair is worked out once, in arrays that stay in the cache.
    total, nearest = np.zeros_like(x), np.full(x.shape, np.inf)
    for i in range(1, x.shape[0]):
        gap = x[i] - x[:i]
        gap = np.where(gap == 0.0, _apart(x[i]), gap)
        inverse, size = 1.0 / gap, np.abs(gap)
        total[i] += inverse.sum(axis=0)
        total[:i] -= inverse
        nearest[i] = np.minimum(nearest[i], size.min(axis=0))
        nearest[:i] = np.minimum(nearest[:i], size)
    return total, nearest


def _apart(x: Complex) -> Array:
    """Distance, less than their rounding, by which two iterates that met are moved apart."""
    return np.asarray(_EPS * np.abs(x) + 1e-150)


def _aberth(scaled: _Scaled, x: Complex, modes: Flags | None = None) -> tuple[Complex, Flags]:
    """All roots at all points; points whose roots have converged are left out of further sweeps.

    Of third order: a step well below the distance of the next root leaves its cube over the square of that.
    With `modes`, shape of x, those alone move, each with the drag of its own frequency.
    """
    found, converged = x.copy(), np.zeros(x.shape[1], dtype=bool)
    active = np.arange(x.shape[1])
    fixed = scaled
    rough = modes is None and np.any(scaled.lids > 0.0)
    near, least = (_ROUGH, _ROUGH) if rough else (_NEAR, _STEP)
    for sweep in range(1, (_SWEEPS if modes is None else _OWN) + 1):
        if modes is not None:
            scaled = _own(fixed, x)
        value, slope = _polynomial(scaled, x)
        repulsion, nearest = _pairs(x)
        bottom = slope - value * repulsion
        step = np.zeros_like(x)
        moving = np.abs(bottom) > _TINY
        np.divide(value, bottom, out=step, where=moving if modes is None else moving & modes)
        x = x - step
        if sweep % _CHECK:
            continue
        moved = np.abs(step)
        done = np.asarray(((moved <= near * nearest) & (moved <= least * np.abs(x))).all(axis=0))
        if sweep > 4 * _CHECK and not done.all():
            late = np.flatnonzero(~done)
            noise = _rounding(_part(scaled, ~done), x[:, late])
            done[late] = (moved[:, late] <= 4.0 * noise).all(axis=0)
        found[:, active] = x
        converged[active[done]] = True
        active, x, scaled = active[~done], x[:, ~done], _part(scaled, ~done)
        if modes is not None:
            fixed, modes = _part(fixed, ~done), modes[:, ~done]
        if active.size == 0:
            break
    return found, converged


def _part(scaled: _Scaled, keep: Flags | NDArray[np.intp]) -> _Scaled:
    return _Scaled(
        stiffness=scaled.stiffness[keep],
        damping=scaled.damping[keep],
        mass=scaled.mass[keep],
        tanh=scaled.tanh[:, keep],
        plain=scaled.plain[:, keep],
        linear=scaled.linear[..., keep],
        bent=scaled.bent[..., keep],
        stokes=scaled.stokes[:, keep],
        lids=scaled.lids[:, keep],
        coupling=scaled.coupling[:, keep],
        laminar=scaled.laminar,
    )


def _rounding(scaled: _Scaled, x: Complex) -> Array:
    """How far the rounding of the polynomial may have moved each root [theory: whirl, eq. 15].

    |P(x + e)| is about |P'| e (1 + e/g) with g the distance of the nearest other root.
    """
    noise = _noise(scaled, x)
    slope = np.abs(_polynomial(scaled, x)[1])
    gap = np.maximum(_pairs(x)[1], _EPS * np.abs(x) + _TINY)
    simple = np.full(noise.shape, np.inf)
    np.divide(noise, slope, out=simple, where=slope > 1e-300 * np.maximum(noise, 1.0))
    double = np.sqrt(np.minimum(simple, 1e150)) * np.sqrt(np.minimum(gap, 1e150))
    return np.asarray(np.minimum(simple, double) + _EPS * np.abs(x))
