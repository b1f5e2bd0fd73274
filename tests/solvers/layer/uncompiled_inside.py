"""A layer that fills its gap, run as plain Python with seeded faults; see `uncompiled_layer`."""

from __future__ import annotations

import numpy as np

from fluid import long_wave as lw
from solvers.layer import finite_volume, step
from solvers.layer.inside import Inside
from solvers.layer.records import LOADS, records
from tests.mutants import kills

SPIN, FULL, SLOT, PULL = 1.3, 0.18, 64.0, 0.15
PIPE = Inside(np.zeros((0, 7)), FULL, SLOT)


def middles(n: int) -> np.ndarray:
    return 2 * np.pi * (np.arange(n) + 0.5) / n


def rates(
    area: np.ndarray, q: np.ndarray, pull: float, inside: Inside = PIPE
) -> tuple[np.ndarray, np.ndarray, float]:
    n = area.size
    step, d_area, d_q = 2 * np.pi / n, np.empty(n), np.empty(n)
    work = np.zeros((finite_volume.WORK, n + 2 * finite_volume.GHOSTS))
    cell, face = pull * np.cos(middles(n)), pull * np.cos(middles(n) - 0.5 * step)
    none = np.empty(0)
    fastest = finite_volume.rates(
        *(area, q, none, SPIN, 0.0, cell, face, *inside, step, 0.0, False, work, d_area, d_q, none)
    )
    return d_area, d_q, fastest


def head_of(area: np.ndarray, pull: np.ndarray) -> np.ndarray:
    return lw.static_head(area, np.sqrt(1 - 2 * area), SPIN, pull) + SLOT * SPIN**2 * np.maximum(
        area - FULL, 0.0
    )


@kills("solvers.layer.finite_volume:primitives", "- full, 0.0)", ", 0.0)")
def test_a_full_gap_rests() -> None:
    """Where the head is one and the same the layer stays, part of it under pressure."""
    n = 64
    pull = PULL * np.cos(middles(n))
    low, high = np.zeros(n), np.full(n, 0.45)
    for _ in range(80):
        middle = 0.5 * (low + high)
        below = head_of(middle, pull) < 0.16 * SPIN**2
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    area = 0.5 * (low + high)
    assert area.min() < 0.9 * FULL and area.max() > FULL
    d_area, d_q, _ = rates(area, -SPIN * area**2, PULL)
    # Beyond the gap the head at faces is a straight line in A: off by the square of what is more, over r^3.
    off = PULL * (area.max() - FULL) ** 2 * 2 * n
    assert np.abs(d_q).max() < max(off, 1e-13) and np.abs(d_area).max() < max(off, 1e-13)


@kills("solvers.layer.finite_volume:side", "held * held * full + rim * bed[i]", "held * held * full")
@kills("solvers.layer.finite_volume:side", "0.5 * stiff * (a - full) * (a + full)", "stiff * (a - full)")
@kills("solvers.layer.finite_volume:side", "half * half + 4.0 * log * quick", "half * half")
@kills("solvers.layer.finite_volume:half_slopes", "(held * held + stiff) * length", "held * held * length")
@kills("solvers.layer.finite_volume:_faces", "PRESSED if most(wide)", "1.0 if most(wide)")
def test_waves_of_a_full_gap() -> None:
    """A smooth disturbance under pressure changes by the equations, and its waves are as fast as stated."""
    errors = []
    for n in (48, 96):
        theta = middles(n)
        area, u = FULL + 0.004 + 0.002 * np.cos(theta), 0.02 * np.sin(theta)
        r, log = np.sqrt(1 - 2 * area), lw.layer_log(area)
        f_r, f_theta = PULL * np.cos(theta), -PULL * np.sin(theta)
        pressed = 0.5 * SLOT * SPIN**2 * (area**2 - FULL**2)
        flux = lw.momentum_flux(u, log, area, r**-2.0) + lw.pressure_force(area, r, SPIN, f_r) + pressed
        modes = np.fft.rfft(np.stack([u * log, flux])) * 1j * np.arange(n // 2 + 1)
        exact = -np.fft.irfft(modes, n)
        exact[1] += f_theta * (1 - r**3) / 3
        d_area, d_q, fastest = rates(area, u * area - SPIN * area**2, PULL)
        errors.append([np.abs(d_area - exact[0]).mean(), np.abs(d_q - exact[1]).mean()])
        half = np.sqrt((SPIN * log) ** 2 + log * ((SPIN + u / r**2) ** 2 + 4 * SLOT * SPIN**2))
        told = fastest / finite_volume.PRESSED
        assert abs(told / np.max(np.abs(u / r**2 + SPIN * log) + half) - 1) < 0.01
    # Second order, but for the cells at extrema, more of them on the coarse ring.
    assert np.all(np.array(errors[1]) < np.array(errors[0]) / 2.4), errors
    assert errors[1][1] < 2e-3 * np.abs(exact[1]).max()


@kills("solvers.layer.finite_volume:side", "2.0 * cell_area[k] > full", "cell_area[k] > 0.0")
@kills("solvers.layer.finite_volume:side", "2.0 * cell_area[k] > full", "cell_area[k] > full")
def test_a_thin_cell_fills_no_face() -> None:
    """A cell with less than half of a full gap is deep at a face by its steep bed: its waves are a layer's.

    Its head rises with its own area, as that of an open layer; the state at the face stays that of the head.
    """
    n, u = 2, 0.1
    cells, out = np.array([0.45, 0.55]) * FULL, [np.zeros(n) for _ in range(7)]
    stiff, nothing = SLOT * SPIN**2, np.zeros(n)
    head = np.full(n, 1.1 * SPIN**2 * FULL)
    finite_volume.side(
        cells, head, nothing, u + nothing, nothing, nothing, n, 0, 1.0, SPIN, SPIN, FULL, stiff, *out
    )
    full = FULL + 0.1 * SPIN**2 * FULL / (stiff + SPIN**2)
    np.testing.assert_allclose(out[0], full, rtol=1e-12)
    log, inverse = lw.layer_log(full), 1.0 / (1.0 - 2.0 * full)
    mean, half = lw.wave_celerity(u * inverse, log, SPIN)
    halves = np.array([half, np.sqrt(half**2 + 4.0 * log * stiff)])
    np.testing.assert_allclose(out[5:], [mean - halves, mean + halves], rtol=1e-12)


def test_no_inner_wall() -> None:
    """A gap that is not filled changes nothing, not a digit."""
    n = 32
    area = 0.1 + 0.03 * np.cos(middles(n))
    q = 0.02 * np.sin(middles(n)) * area - SPIN * area**2
    for one, other in zip(
        rates(area, q, 0.05), rates(area, q, 0.05, Inside(PIPE.plates, 1.0, 0.0)), strict=True
    ):
        np.testing.assert_array_equal(one, other)


@kills("solvers.layer.step:_cell_loads", "* (1.0 - r)\n", "\n")
@kills("solvers.layer.step:_cell_loads", "area[i] - full", "area[i] - 0.9 * full")
def test_pressure_of_a_full_gap_on_both_walls() -> None:
    """k (A - A_f) on the outer wall, of the radius 1, and against it on the inner one."""
    n = 32
    theta = middles(n)
    area = FULL + 0.01 * np.cos(theta - 0.4)
    angles, rim = np.stack([np.cos(theta), np.sin(theta)]), np.sqrt(1 - 2 * FULL)
    given = area, -SPIN * area**2, SPIN, 0.0 * area, angles, 1.0, 0.0, 1.0
    loads = []
    for slot in (0.0, SLOT * SPIN**2):
        sums = records(LOADS)[0]
        step.tally(*given, FULL, slot, sums)
        loads.append(complex(sums.force_x, sums.force_y))
    pressure = SLOT * SPIN**2 * np.maximum(area - FULL, 0.0)
    expected = np.sum(pressure * np.exp(1j * theta)) * (1 - rim) * 2 * np.pi / n
    # The slot's surface lies up to 0.01/rim inside the rim.
    assert abs(loads[1] - loads[0] - expected) < 0.06 * abs(expected)
