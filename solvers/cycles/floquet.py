"""Stability of a limit cycle against small disturbances: Floquet multipliers [theory: whirl, eq. 27-28].

In the whirl's frame, where the limit cycle stands: one step takes rotor and layers through the time of a
cell, as many steps as cells through a turn of the whirl in the drum.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from meshes.arrays import Array, Complex
from solvers.cycles.balance import Circular
from solvers.cycles.branch import Cycle
from solvers.cycles.wave import Derivatives, StandingWave, Whirling

# Over the spin: what grows faster lives on a kink of the scheme's limiter within a few cells and is no whirl.
_WILD = 0.1
_TURN = 1e-6  # rad, by which a push is turned in a difference
_SMALL = 1e-7  # of the mean area, in differences of the momentum


@dataclass(frozen=True)
class _Follows:
    """A layer in the whirl's frame; 2 n components, lengths over R, times over 1/Omega."""

    step: Array  #: of a disturbance over the time of a cell, its volume left out, shape (2 n, 2 n)
    push: Array  #: by a body force along the deflection and ahead of it, shape (2 n, 2)
    momentum: Array  #: of the liquid relative to the axis, over its mass, along and ahead, shape (2, 2 n)


def disturbance_growth(machine: Circular, waves: Sequence[StandingWave], cycle: Cycle) -> float | None:
    """Growth rate of the disturbance of a limit cycle that grows most, 1/s; None where a layer breaks down.

    A turn of the whole whirl does not count as one.
    """
    parts = []
    layers = zip(waves, cycle.given, cycle.state, cycle.force.tolist(), cycle.derivatives, strict=True)
    for wave, drive, state, force, known in layers:
        found = _follows(wave, drive, state, force, known)
        if found is None:
            return None
        parts.append(found)
    cells, ratio = waves[0].cells, cycle.given[0].ratio
    slip = abs(ratio - 1.0)
    step = _step(machine, parts, ratio, cycle.moved, cycle.spin, 2.0 * math.pi / cells / slip)
    multipliers = np.linalg.eigvals(step)
    multipliers = np.delete(multipliers, np.argmin(np.abs(multipliers - 1.0)))
    rates = np.log(np.maximum(np.abs(multipliers), 1e-300)) * cells * slip / (2.0 * math.pi)
    return float(rates[rates < _WILD].max() * cycle.spin)


def _follows(
    wave: StandingWave, given: Whirling, state: Array, force: complex, known: Derivatives
) -> _Follows | None:
    """A layer's answer to disturbances."""
    n = wave.cells
    # Its time in the drum must not be below 0.
    turn = math.copysign(_TURN, given.ratio - 1.0)
    straight, turned = wave.cell(state, given), wave.cell(state, given, turn)
    if straight is None or turned is None:
        return None
    step = known.state.copy()
    step[:n, :n] -= 1.0 / n
    scale = given.ratio**2
    across = (turned.state - straight.state) / (turn * given.size * scale)
    small = _SMALL * wave.mean
    base = _momentum(state, n)
    changed = (_momentum(state + small * np.eye(2 * n), n) - base) / small
    # The flow's momentum is that of the moving centre of mass, up to the width of the cells.
    offset = given.size * (force / (2.0 * wave.mean) - 1.0)
    changed = changed * (1j * given.ratio * offset / base)
    return _Follows(
        step, np.column_stack([known.given[:, 1] / scale, across]), np.array([changed.real, changed.imag])
    )


def _momentum(state: Array, cells: int) -> Complex:
    """Momentum of the liquid relative to its axis, over its mass and R Omega, complex, shape (...,).

    [theory: coupling, eq. 3], in the drum's axes at the moment the deflection points to the first cell.
    """
    area, momentum = state[..., :cells], state[..., cells:]
    radius = np.sqrt(np.maximum(1.0 - 2.0 * area, 0.0))
    wet = area > 0.0
    velocity = np.divide(momentum, area, out=np.zeros_like(area), where=wet) + area
    flow = -velocity * np.log(np.maximum(radius, 1e-300))
    way = np.exp(2j * math.pi * (np.arange(cells) + 0.5) / cells)
    surface = radius * way
    along = 0.5 * (np.roll(surface, -1, axis=-1) - np.roll(surface, 1, axis=-1))
    lever = (1.0 - radius) * (1.0 + radius + radius**2) / 3.0
    width = 2.0 * math.pi / cells
    total = (flow * along).sum(axis=-1) + 1j * width * (lever * way).sum(axis=-1)
    return np.asarray(total / (width * area.sum(axis=-1)))


def _real(matrix: Complex) -> Array:
    """A complex matrix over real and imaginary parts: all real parts first, shape (2 a, 2 b)."""
    return np.block([[matrix.real, -matrix.imag], [matrix.imag, matrix.real]])


def _step(
    machine: Circular, parts: list[_Follows], ratio: float, moved: Complex, spin: float, time: float
) -> Array:
    """Rotor and layers through the time of a cell: layers one after the other, then place and rate.

    The rotor by the trapezium, in the whirl's frame; its mean acceleration drives the layers.
    """
    p, size = moved.size, len(parts[0].step)
    count = size * len(parts)
    unit = np.eye(p, dtype=complex)
    damping = (machine.damping + spin * machine.gyroscopic) / spin
    stiffness = machine.stiffness / spin**2
    whole = machine.mass.astype(complex)
    carried, pushed = np.zeros((2 * p, count)), np.zeros((count, 2 * p))
    steps = np.zeros((count, count))
    for k, (place, part) in enumerate(zip(machine.places, parts, strict=True)):
        own, row = slice(k * size, (k + 1) * size), place.row[None]
        whole = whole + place.mass * row.conj().T @ row
        way = cmath.exp(1j * cmath.phase(complex(place.row @ moved)))
        radius = place.fill.chamber.radius
        carried[:, own] = _real(place.mass * radius * way * row.conj().T) @ part.momentum
        pushed[own] = part.push @ _real(-row / (way * radius))
        steps[own, own] = part.step
    half = 0.5 * time
    ahead, back = _real((1.0 + 1j * ratio * half) * unit), _real((1.0 - 1j * ratio * half) * unit)
    none, one = np.zeros((2 * p, 2 * p)), np.eye(2 * p)
    inertia, drag, spring = _real(whole), _real(damping), _real(stiffness)
    # Place, rate and mean acceleration at the end, given all at the beginning.
    left = np.block(
        [
            [ahead, -half * one, none],
            [none, ahead, -time * one],
            [half * spring, ahead @ inertia + half * drag, ahead @ carried @ pushed],
        ]
    )
    right = np.block(
        [
            [np.zeros((2 * p, count)), back, half * one],
            [np.zeros((2 * p, count)), none, back],
            [
                back @ carried - ahead @ carried @ steps,
                -half * spring,
                back @ inertia - half * drag,
            ],
        ]
    )
    found = np.linalg.solve(left, right)
    layers = np.column_stack([steps, np.zeros((count, 4 * p))]) + pushed @ found[4 * p :]
    return np.vstack([layers, found[: 4 * p]])
