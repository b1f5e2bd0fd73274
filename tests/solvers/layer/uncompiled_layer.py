"""Seeded faults of the compiled finite volumes, and their oracles, run as plain Python.

Compiled code keeps its right lines while a fault is seeded, so these are collected by `test_uncompiled.py`
alone, in a process of its own in which numba compiles nothing.
"""

from __future__ import annotations

from unittest import mock

import mpmath as mp
import numpy as np

from fluid import long_wave as lw
from solvers.layer import finite_volume
from solvers.layer import finite_volume as face_flux
from solvers.layer import state as layer_loads
from solvers.layer import step as forced_layer
from solvers.layer.baffles import COLUMNS, DENSITY, FACE, LOSS, OPEN, TIP
from solvers.layer.inside import NOTHING
from solvers.layer.records import LOADS, Drive, Outcome, Wall, records
from tests.mutants import kills

SPIN, PULL, TURNED = 1.0, 0.1, 0.4


def angles(n: int) -> np.ndarray:
    edge = 2 * np.pi * np.arange(n) / n
    middle = edge + np.pi / n
    return np.stack([np.cos(middle), np.sin(middle), np.cos(edge), np.sin(edge)])


def middles(n: int) -> np.ndarray:
    return 2 * np.pi * (np.arange(n) + 0.5) / n


def rates(
    area: np.ndarray,
    q: np.ndarray,
    euler: float = 0.0,
    dt: float = 0.0,
    dispersion: bool = False,
    pull: float = PULL,
    spin: float = SPIN,
) -> tuple[np.ndarray, np.ndarray, float]:
    n = area.size
    theta, step = middles(n), 2 * np.pi / n
    d_area, d_q = np.empty(n), np.empty(n)
    work = np.zeros((finite_volume.WORK, n + 2 * finite_volume.GHOSTS))
    cell, face = pull * np.cos(theta - TURNED), pull * np.cos(theta - 0.5 * step - TURNED)
    none = np.empty(0)
    fastest = finite_volume.rates(
        *(area, q, none, spin, euler, cell, face, *NOTHING, step, dt, dispersion, work, d_area, d_q, none)
    )
    return d_area, d_q, fastest


def dispersed(area: np.ndarray, q: np.ndarray) -> np.ndarray:
    """What dispersion adds to the rate of q, without what it changes at the faces."""
    with mock.patch.object(finite_volume, "THIRD", 0.0):
        return rates(area, q, dispersion=True)[1] - rates(area, q)[1]


def slope(values: np.ndarray) -> np.ndarray:
    """Derivative along the ring, to rounding for smooth values."""
    modes = np.fft.rfft(values) * 1j * np.arange(values.size // 2 + 1)
    return np.fft.irfft(modes, values.size)


def smooth(n: int) -> tuple[np.ndarray, np.ndarray]:
    theta = middles(n)
    return 0.1 + 0.03 * np.cos(theta) + 0.01 * np.sin(2 * theta), 0.05 + 0.04 * np.sin(theta)


@kills("solvers.layer.finite_volume:faded_velocity", "2.0 * (q + spin * square)", "2.0 * (q - spin * square)")
@kills("solvers.layer.finite_volume:_limited", "0.25 + skew, 0.25", "0.5 + skew, 0.5")
@kills("solvers.layer.finite_volume:side", "head[k] + way * half_head[k]", "head[k]")
@kills(
    "solvers.layer.finite_volume:side",
    "_momentum(u, log, a, inverse) + push[i]",
    "_momentum(u, log, a, inverse)",
)
@kills("solvers.layer.finite_volume:side", "= mean - half, mean + half", "= mean - half, mean")
@kills("solvers.layer.finite_volume:hll", "- right * flow_r[i]", "+ right * flow_r[i]")
@kills("solvers.layer.finite_volume:_cells", "work[row, n + i]", "work[row, n + i - 1]")
@kills("solvers.layer.finite_volume:_cells", "work[row, GHOSTS + i]", "work[row, i]")
@kills("solvers.layer.finite_volume:beds", "bed[n] = pull_face[0]", "bed[n] = pull_face[n - 1]")
@kills("solvers.layer.finite_volume:_faces", "2.0 * k - 1.0", "1.0 - 2.0 * k")
@kills("solvers.layer.finite_volume:_gather", "-euler * area[i]", "euler * area[i]")
@kills("solvers.layer.finite_volume:_gather", "(through + within)", "(through - within)")
@kills("solvers.layer.finite_volume:_gather", "(mass[i] - mass[i + 1])", "(mass[i + 1] - mass[i])")
@kills(
    "solvers.layer.finite_volume:_gather",
    "bend[i + GHOSTS] - more * (area_l",
    "bend[i + GHOSTS] + more * (area_l",
)
@kills("solvers.layer.finite_volume:_gather", "0.5 * (held - spin) * (held + spin)", "0.0")
@kills("solvers.layer.finite_volume:_held", "np.maximum(abs(spin), HELD * abs(own))", "abs(spin)")
def test_rates() -> None:
    """A smooth state changes as the equations say, with an error of second order.

    So it does in a drum that hardly turns any more, where the force on the axis is three thousand times as
    strong as the drum's own field would be.
    """
    for spin, faster, pull in ((SPIN, 0.0, PULL), (0.01, 0.9, 0.3), (-0.01, 0.9, 0.3)):
        errors = []
        for n in (48, 192):
            area, u = smooth(n)
            u = u + faster
            r, log = lw.free_surface_radius(area), lw.layer_log(area)
            f_r, f_theta = pull * np.cos(middles(n) - TURNED), -pull * np.sin(middles(n) - TURNED)
            flux = lw.momentum_flux(u, log, area, r**-2.0) + lw.pressure_force(area, r, spin, f_r)
            exact_q = f_theta * (1 - r**3) / 3 - 0.3 * area - slope(flux)
            d_area, d_q, fastest = rates(area, u * area - spin * area**2, euler=0.3, pull=pull, spin=spin)
            missed = d_area + slope(u * log), d_q - exact_q
            errors.append([np.abs(miss).mean() for miss in missed])
            mean, half = lw.wave_celerity(u / r**2, log, spin)
            assert abs(fastest / np.max(np.abs(mean) + half) - 1) < 0.02
        # Of second order a sixteenth is left; at the few extrema of either wave the limiter leaves more.
        assert np.all(np.array(errors[1]) < np.array(errors[0]) / 9.0), errors
        assert max(errors[1]) < 1e-2 * min(np.abs(d_area).mean(), np.abs(d_q).mean()), errors


def rolling_rates(
    area: np.ndarray, q: np.ndarray, energy: np.ndarray, pull: float = PULL, euler: float = 0.0
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rates of A, q and A e."""
    n = area.size
    theta, step = middles(n), 2 * np.pi / n
    found = np.empty((3, n))
    work = np.zeros((finite_volume.WORK, n + 2 * finite_volume.GHOSTS))
    cell, face = pull * np.cos(theta - TURNED), pull * np.cos(theta - 0.5 * step - TURNED)
    finite_volume.rates(*(area, q, energy, SPIN, euler, cell, face, *NOTHING, step, 0.0, False, work, *found))
    return found[0], found[1], found[2]


@kills("solvers.layer.finite_volume:roller_rates", "d_q[i] + euler * a", "d_q[i]")
@kills("solvers.layer.finite_volume:roller_rates", "- radius * pull[i]", "+ radius * pull[i]")
@kills("solvers.layer.finite_volume:roller_rates", "both * (held_r - held_l)", "0.0")
@kills("solvers.layer.finite_volume:_energy_flux", "+ 2.0 * rolling", "")
@kills("solvers.layer.finite_volume:_energy_flux", "spin * mass", "0.0")
def test_fluctuations_take_what_the_mean_flow_loses() -> None:
    """Without decay a bore turns the energy of the mean flow into theirs; a smooth flow loses none."""
    losses, n = [], 96
    with mock.patch.object(finite_volume, "DECAY", 0.0):
        for cells in (n, 2 * n):
            area, u = smooth(cells)
            energy = 0.02 * area**3 * (1.0 + 0.3 * np.cos(middles(cells)))
            rate = rolling_rates(area, u * area - SPIN * area**2, energy, euler=0.3)[2]
            carried = -slope(u * lw.layer_log(area) * energy / area)
            pressed = -2.0 * energy * slope(u * lw.layer_log(area) / area)
            losses.append(np.abs(rate - carried - pressed).mean())
        # The fluctuations themselves are carried by their cells' values: first order.
        assert losses[1] < 0.6 * losses[0] and losses[1] < 0.2 * np.abs(pressed).mean(), losses
        area, u = smooth(n)
        q = u * area - SPIN * area**2
        # A step of depth and speed that is no jump of the equations: fluxes alone decide what is lost.
        area[: n // 2] *= 1.6
        d_area, d_q, gained = rolling_rates(area, q, 0.01 * area**3, euler=0.3)
        made = rolling_rates(area, q, 0.0 * area)[2]
    assert gained.sum() > 0.0
    # A front feeds them in every cell of its own.
    assert made.min() > -0.02 * made.max(), (made.min(), made.max())
    log, r = lw.layer_log(area), lw.free_surface_radius(area)
    v = (q + SPIN * area**2) / area
    f_r = PULL * np.cos(middles(n) - TURNED)
    by_area = v * log * (2.0 * SPIN - v / area) + 0.5 * (v / r) ** 2 + SPIN**2 * area - r * f_r
    lost = by_area @ d_area + (v * log / area) @ (d_q + 0.3 * area)
    assert abs(gained.sum() + lost) < 1e-12 * np.abs(d_q).sum()


@kills("solvers.layer.finite_volume:lifted", "2.0 * area[i] * e", "area[i] * e")
@kills("solvers.layer.finite_volume:lifted", "half * half + 6.0 * e", "half * half")
@kills("solvers.layer.finite_volume:rates", "fluctuations(area, energy, spin, rolling)", "pass")
def test_fluctuations_press() -> None:
    """Their pressure moves no momentum out of the ring, and in it as the equation says."""
    n = 192
    area, u = smooth(n)
    q = u * area - SPIN * area**2
    energy = 0.05 * area**3
    d_area, d_q, _ = rolling_rates(area, q, energy, pull=0.0)
    _, bare_q, _ = rolling_rates(area, q, 0.0 * energy, pull=0.0)
    assert abs(d_q.sum() - bare_q.sum()) < 1e-14 and abs(d_area.sum()) < 1e-14
    assert np.abs(d_q - bare_q + slope(2.0 * energy)).max() < 0.05 * np.abs(slope(2.0 * energy)).max()
    # Waves run faster by them.
    mean, half = lw.wave_celerity(u / (1.0 - 2.0 * area), lw.layer_log(area), SPIN)
    cells = slice(finite_volume.GHOSTS, n + finite_volume.GHOSTS)
    rolling, side = np.zeros(n + 2 * finite_volume.GHOSTS), np.zeros((4, n))
    finite_volume.fluctuations(area, energy, SPIN, rolling)
    side[0], side[2], side[3] = area, mean - half, mean + half
    finite_volume.lifted(rolling[cells], *side, n)
    np.testing.assert_allclose(side[3] - side[2], 2.0 * np.sqrt(half**2 + 0.3 * area**2), rtol=1e-12)
    np.testing.assert_allclose(0.5 * (side[3] + side[2]), mean, atol=1e-14)
    # None come to be in a layer at rest.
    at_rest = np.full(n, 0.1)
    assert np.all(rolling_rates(at_rest, -SPIN * at_rest**2, 0.0 * at_rest, pull=0.0)[2] == 0.0)


@kills("solvers.layer.finite_volume:roller_rates", "0.5 * DECAY * a * 2.0 * e", "DECAY * a * 2.0 * e")
def test_fluctuations_decay() -> None:
    """In a uniform layer at rest alone they die as de/dt = -(C/2) (2 e)^(3/2)/h."""
    area = np.full(16, 0.1)
    e, depth = 1e-3, 1.0 - np.sqrt(0.8)
    rate = rolling_rates(area, -SPIN * area**2, area * e, pull=0.0)[2]
    np.testing.assert_allclose(rate / 0.1, -0.5 * finite_volume.DECAY * (2.0 * e) ** 1.5 / depth, rtol=1e-12)


@kills("solvers.layer.finite_volume:_disperse", "_LESS / (_CONSTANT", "-_LESS / (_CONSTANT")
@kills("solvers.layer.finite_volume:_disperse", "area[i] * log * log", "area[i] * log")
@kills("solvers.layer.finite_volume:_disperse", "- 0.5 * carried * carried", "")
@kills("solvers.layer.finite_volume:_disperse", "+ 2.0 * stretch * stretch", "- 2.0 * stretch * stretch")
@kills(
    "solvers.layer.finite_volume:_disperse", "push[i] -= face[i] * step", "push[i] -= 0.5 * face[i] * step"
)
def test_dispersion() -> None:
    """What dispersion adds solves the smooth equation, to second order."""
    errors = []
    for n in (48, 96):
        area, u = smooth(n)
        r, log = lw.free_surface_radius(area), lw.layer_log(area)
        q = u * area - SPIN * area**2
        head = lw.bernoulli(u, log, area, r, SPIN, PULL * np.cos(middles(n) - TURNED)) - 0.5 * (u / r) ** 2
        added = dispersed(area, q)
        missing, gradient = added / area, slope(head)
        reach = area * log**2
        bend = slope(gradient) + 2.0 * slope(u) ** 2
        left = 15 * added - 6 * slope(reach * slope(missing)) + 5 * slope(reach * bend)
        errors.append(np.abs(left).max() / np.abs(15 * added).max())
    assert errors[1] < 0.3 * errors[0] and errors[1] < 0.02, errors


@kills(
    "solvers.layer.finite_volume:_disperse",
    "push[n] = push[0]\n    for i in range(n):\n        d_q",
    "for i in range(n):\n        d_q",
)
@kills("solvers.layer.finite_volume:_disperse", "if area[i] > DRY else 0.0", "if area[i] > DRY else 1.0")
def test_dispersion_exerts_no_torque() -> None:
    """Nor does it move dry cells, or films beside deep liquid faster than gradients of the head do."""
    rng, n = np.random.default_rng(5), 40
    for thinnest in (-12.0, -6.0, -2.0, -1.0) * 3:
        area = 10.0 ** rng.uniform(thinnest, -0.4, n) * (rng.random(n) > 0.2)
        q = rng.normal(size=n) * area - SPIN * area**2
        added = dispersed(area, q)
        assert np.abs(added).max() > 0.0 and abs(added.sum()) < 1e-14 * np.abs(rates(area, q)[1]).sum()
        assert np.all(added[area == 0.0] == 0.0)
        u = np.where(area > 0.0, q / np.maximum(area, 1e-300) + SPIN * area, 0.0)
        r = np.maximum(lw.free_surface_radius(area), 0.03)
        head = lw.bernoulli(u, -np.log(r), area, r, SPIN, PULL * np.cos(middles(n) - TURNED))
        head -= 0.5 * (u / r) ** 2
        wet = (area > 0.0) & (np.roll(area, 1) > 0.0)
        stretch = 2.0 * np.where(wet, u - np.roll(u, 1), 0.0) ** 2 * n / (2.0 * np.pi)
        steepest = np.abs(np.where(wet, head - np.roll(head, 1), 0.0)).max() * n / (2.0 * np.pi)
        # 5/6 of the gradient, and of the stretching summed up, less a mean of it with weights above zero.
        assert np.all(
            np.abs(added) <= (1.0 + 1e-9) * (5.0 / 3.0 * steepest + 5.0 / 6.0 * stretch.sum()) * area
        )


@kills("solvers.layer.finite_volume:solve_ring", "0.5 / first", "1.0 / first")
@kills("solvers.layer.finite_volume:solve_ring", "diagonal[last] += side[0] * share", "diagonal[last] += 0.0")
@kills("solvers.layer.finite_volume:solve_ring", "share if i == last", "1.0 if i == last")
def test_ring() -> None:
    """The system of the dispersive term, against dense elimination; a ring with gaps as well."""
    n = 9
    for gap in (1.0, 0.0):
        side = 12.0 + 5.0 * np.sin(np.arange(n))
        side[4] *= gap
        diagonal = 1.0 + side + np.roll(side, -1)
        value = np.cos(np.arange(n) ** 2.0)
        matrix = np.diag(diagonal)
        for i in range(n):
            matrix[i, i - 1] -= side[i]
            matrix[i - 1, i] -= side[i]
        found = value.copy()
        finite_volume.solve_ring(diagonal.copy(), np.append(side, side[0]), found, np.empty(n))
        np.testing.assert_allclose(matrix @ found, value, atol=1e-13)


@kills(
    "solvers.layer.finite_volume:beds",
    "np.minimum(pull[i + 1], pull[i + 2])",
    "np.maximum(pull[i + 1], pull[i + 2])",
)
def test_circle() -> None:
    """A circle about the rotation axis with a dry patch stays."""
    n, amplitude, radius = 40, 0.4, 1.1
    theta = middles(n) - TURNED
    surface = np.sqrt(radius**2 - (amplitude * np.sin(theta)) ** 2) - amplitude * np.cos(theta)
    area = 0.5 * np.maximum(1 - np.clip(surface, 0, 1) ** 2, 0)
    assert (area == 0).sum() > 5
    d_area, d_q, _ = rates(area, -SPIN * area**2, pull=amplitude)
    # Rounding of the fluxes over the width of a cell.
    assert np.abs(d_area).max() < 1e-14 and np.abs(d_q).max() < 1e-14


@kills("solvers.layer.finite_volume:log_and_inverse", "begin + 2.0 * z", "begin + z")
@kills("solvers.layer.finite_volume:log_and_inverse", "+ 0.06651188202397319", "+ 0.066")
@kills(
    "solvers.layer.finite_volume:log_and_inverse", "surface >= 0.125 else 16.0", "surface >= 0.125 else 4.0"
)
@kills("solvers.layer.finite_volume:log_and_inverse", "below * quotient", "quotient")
def test_logarithm() -> None:
    """L and 1/r^2 over the whole range of areas, a few roundings from the exact ones."""
    edges = [0.5 * (1.0 - r * r) for r in (0.5, 0.125)]
    area = np.array([1e-13, 1e-12, 1e-5, 0.01, 0.1, 0.3, *np.nextafter(edges, 0), *edges, 0.49, 0.4995])
    radius = [lw.free_surface_radius(a) for a in area]
    found = np.array([face_flux.log_and_inverse(a, r) for a, r in zip(area, radius, strict=True)])
    # Near the axis the radius has lost digits to the area: ln r follows it.
    with mp.workdps(40):
        thin = [float(-mp.log(1 - 2 * mp.mpf(a)) / 2) for a in area]
        deep = [float(-mp.log(r)) for r in radius]
    exact = np.where(area < 0.375, thin, deep)
    np.testing.assert_allclose(found[:, 0], exact, rtol=8e-16)
    np.testing.assert_allclose(found[:, 1], np.array(radius) ** -2.0, rtol=1e-15)
    assert face_flux.log_of_surface(area[3], radius[3]) == found[3, 0]


@kills("solvers.layer.finite_volume:_limited", "least = min(abs(back), abs(ahead))", "least = np.inf")
@kills("solvers.layer.finite_volume:side", "u * a - spin * a * a", "u * a + spin * a * a")
@kills("solvers.layer.finite_volume:hll", "(area_r[i] - area_l[i])", "(area_l[i] - area_r[i])")
@kills("solvers.layer.finite_volume:hll", "both * (q_r[i] - q_l[i])", "both * (q_l[i] - q_r[i])")
@kills("solvers.layer.finite_volume:_gather", "- push_r[i])", "- push_l[i])")
def test_bore() -> None:
    """A bore overshoots nowhere to speak of, and nothing is made or lost."""
    n = 32
    area = np.where(middles(n) < np.pi, 0.14, 0.06)
    q, start = -SPIN * area**2, area
    before, turning = area.sum(), (q + SPIN * area).sum()
    for _ in range(20):
        d_area, d_q, fastest = rates(area, q, pull=0.0)
        assert 0.0 < fastest < 2.0
        dt = 0.4 * 2 * np.pi / n / fastest
        area, q = area + dt * d_area, q + dt * d_q
    # The slopes of two waves, each within its bounds, may add up: 1e-6 above and 1e-5 below.
    assert area.max() <= 0.14 * (1 + 5e-6) and area.min() >= 0.06 * (1 - 5e-5)
    assert np.abs(area - start).max() > 0.03
    assert abs(area.sum() / before - 1) < 1e-14 and abs((q + SPIN * area).sum() / turning - 1) < 1e-13


@kills("solvers.layer.finite_volume:_limited", "half if same else 0.0", "half")
@kills(
    "solvers.layer.finite_volume:half_slopes",
    "_limited(ahead * head_1 - velocity_1",
    "_limited(ahead * head_1 + velocity_1",
)
def test_slopes() -> None:
    """Face values lie between the cells' on both sides; an extremum has none of its own."""
    value, still = np.array([0.0, 1.0, 3.0, 2.0, 2.1, 4.0, 4.0]), np.zeros(7)
    deep, rim = np.full(7, 0.1), lw.free_surface_radius
    head, velocity = np.empty(7), np.empty(7)
    # At the fourth of them half of the central slope, 0.5, is cut back to the lesser difference, 0.1.
    limited = [0.75, 0.0, 0.0, 0.1, 0.0]
    face_flux.half_slopes(
        *(deep, value, still, rim(deep), SPIN, SPIN, 1.0, 0.0, head, velocity, np.empty(7), None, None)
    )
    np.testing.assert_allclose([head[1:6], velocity[1:6]], [limited, np.zeros(5)], atol=1e-14)
    face_flux.half_slopes(
        *(deep, still, value, rim(deep), SPIN, SPIN, 1.0, 0.0, head, velocity, np.empty(7), None, None)
    )
    np.testing.assert_allclose([head[1:6], velocity[1:6]], [np.zeros(5), limited], atol=1e-14)
    deep[5] = 0.0
    face_flux.half_slopes(
        *(deep, value, still, rim(deep), SPIN, SPIN, 1.0, 0.0, head, velocity, np.empty(7), None, None)
    )
    np.testing.assert_allclose(head[1:6], [0.75, 0.0, 0.0, 0.0, 0.0], atol=1e-14)


@kills("solvers.layer.finite_volume:_limited", "near, far = 0.25 + skew", "near, far = 0.25 - skew")
@kills("solvers.layer.finite_volume:_limited", "bend if same else 0.0", "bend")
@kills(
    "solvers.layer.finite_volume:_limited",
    "min(abs(far * back + near * ahead), least)",
    "abs(far * back + near * ahead)",
)
@kills("solvers.layer.finite_volume:half_slopes", "behind * second_bend", "behind * first_bend")
@kills(
    "solvers.layer.finite_volume:half_slopes",
    "(first_bend + second_bend) * share",
    "(first_bend - second_bend) * share",
)
def test_bent_slopes() -> None:
    """A parabola comes back from its means at both faces of a cell; limits are those of the slopes."""
    edges, deep = np.arange(8.0), np.full(7, 0.1)
    rim = lw.free_surface_radius(deep)
    # Means over the cells of (x + 4)^2, of x^2 beyond the summit and of what has none.
    primitive = (edges + 4.0) ** 3 / 3.0
    rising, still = np.diff(primitive), np.zeros(7)
    for value, other in ((rising, still), (still, rising), (rising, -2.0 * rising)):
        wide = np.empty((5, 7))
        face_flux.half_slopes(deep, value, other, rim, SPIN, SPIN, 1.0, 0.0, *wide)
        found = wide[:, 1:6]
        for cells, half, mean in ((value, found[0], found[3]), (other, found[1], found[4])):
            scale = cells[0] / rising[0]
            np.testing.assert_allclose(mean + half, scale * (edges[2:7] + 4.0) ** 2, atol=1e-12)
            np.testing.assert_allclose(mean - half, scale * (edges[1:6] + 4.0) ** 2, atol=1e-12)
    # A face goes no further than the neighbour nearby is, twice the difference allowed; a summit is flat.
    value = np.array([0.0, 1.0, 9.0, 6.0, 6.0, 9.0, 9.0])
    face_flux.half_slopes(deep, value, still, rim, SPIN, SPIN, 1.0, 0.0, *wide)
    np.testing.assert_allclose(found[0], [1.0, 0.0, 0.0, 0.0, 0.0], atol=1e-14)
    np.testing.assert_allclose(found[3], value[1:6], atol=1e-14)
    # Beside a dry cell nothing bends.
    dry = np.array([0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.0])
    face_flux.half_slopes(dry, rising, still, rim, SPIN, SPIN, 1.0, 0.0, *wide)
    assert found[0, 4] == 0.0 and found[3, 4] == rising[5] and found[0, 3] > 0.0


@kills(
    "solvers.layer.finite_volume:half_slopes", "carried, weight = spin * length,", "carried, weight = 0.0,"
)
@kills("solvers.layer.finite_volume:half_slopes", "share = 0.5 * weight", "share = weight")
@kills("solvers.layer.finite_volume:half_slopes", "(ahead * first + behind", "(ahead * first - behind")
@kills("solvers.layer.finite_volume:half_slopes", "(held * held + stiff)", "(spin * spin + stiff)")
def test_waves() -> None:
    """Where one wave ends and the other begins neither has a slope: the waves are those of the equations."""
    area, u, h = 0.1, 0.05, 1e-6

    def fluxes(a: float, v: float) -> np.ndarray:
        log, r = lw.layer_log(a), lw.free_surface_radius(a)
        return np.array([lw.mass_flux(v, log), lw.bernoulli(v, log, a, r, SPIN, 0.0)])

    by_area = (fluxes(area + h, u) - fluxes(area - h, u)) / (2 * h)
    by_velocity = (fluxes(area, u + h) - fluxes(area, u - h)) / (2 * h)
    _, waves = np.linalg.eig(np.stack([by_area, by_velocity], axis=1))
    one, other = waves[1] / waves[0]
    head, velocity, log = np.empty(3), np.empty(3), np.empty(3)
    three, rim = np.full(3, area), lw.free_surface_radius
    # The head is `held`^2 A here.
    for held in (SPIN, 2.0 * SPIN):
        rise = held**2
        for first, second in ((one, other), (other, one)):
            heads, speeds = rise * np.array([-1.0, 0.0, 1.0]), u + np.array([-first, 0.0, second])
            face_flux.half_slopes(
                *(three, heads, speeds, rim(three), SPIN, held, 1.0, 0.0, head, velocity, log, None, None)
            )
            np.testing.assert_allclose([head[1], velocity[1]], 0.0, atol=1e-8)
            # One wave on both sides, three times as steep on one of them, where the other wave comes in.
            heads, speeds = (
                rise * np.array([-1.0, 0.0, 4.0]),
                u + np.array([-first, 0.0, 3.0 * first + second]),
            )
            face_flux.half_slopes(
                *(three, heads, speeds, rim(three), SPIN, held, 1.0, 0.0, head, velocity, log, None, None)
            )
            np.testing.assert_allclose([head[1], velocity[1]], [rise, first], atol=1e-7)


@kills("solvers.layer.finite_volume:_drain", "area[i] / share[i + 1] if", "2.0 * area[i] / share[i + 1] if")
@kills("solvers.layer.finite_volume:_drain", "1 if lost > area[i]", "1 if lost > 9.0 * area[i]")
@kills("solvers.layer.finite_volume:_drain", "if mass[face] > 0.0", "if mass[face] < 0.0")
@kills("solvers.layer.finite_volume:_drain", "kept * (flow[face] - push_l", "1.0 * (flow[face] - push_l")
def test_drain() -> None:
    """No cell loses more than it has, however long the step; the rest flows as it would."""
    n = 16
    area = np.where(np.abs(middles(n) - 3) < 1, 0.2, 0.0)
    area[3] = 1e-4
    q = np.where(area > 0, 0.9 * area, 0.0) - SPIN * area**2
    free = rates(area, q, pull=0.0)[0]
    for dt in (1e-6, 0.3, 3.0):
        held = rates(area, q, dt=dt, pull=0.0)[0]
        assert (area + dt * held).min() > -1e-15 and abs(held.sum()) < 1e-14
        assert dt > 1e-3 or np.array_equal(held, free)
    assert (area + 3.0 * free).min() < -0.01
    # The film that empties leaves none of its momentum behind, nor takes more along than it had.
    d_area, d_q, _ = rates(area, q, dt=3.0, pull=0.0)
    assert area[3] + 3.0 * d_area[3] < 1e-15 and abs(q[3] + 3.0 * d_q[3]) < 1e-3 * q[3]


@kills("solvers.layer.finite_volume:signals", "1.5 * back_r[i] - 0.5 * ahead_r[i]", "back_r[i]")
@kills("solvers.layer.finite_volume:signals", "1.5 * ahead_l[i] - 0.5 * back_l[i]", "ahead_l[i]")
def test_signals() -> None:
    """The front of a layer on a dry bed runs at u + 2 c, the other way at u - 2 c."""
    slow, fast = np.empty(3), np.empty(3)
    area_l, area_r = np.array([0.1, 0.1, 0.0]), np.array([0.1, 0.0, 0.1])
    mean, half = 0.2, 0.5
    back_l, ahead_l = np.array([mean - half, mean - half, 0.0]), np.array([mean + half, mean + half, 0.0])
    back_r, ahead_r = np.array([0.1 - half, 0.0, mean - half]), np.array([0.1 + half, 0.0, mean + half])
    face_flux.signals(area_l, area_r, back_l, back_r, ahead_l, ahead_r, 3, slow, fast)
    np.testing.assert_allclose(slow, [-0.4, -0.3, -0.8], rtol=1e-14)
    np.testing.assert_allclose(fast, [0.7, 1.2, 0.7], rtol=1e-14)


def run(
    area: np.ndarray,
    q: np.ndarray,
    length: float,
    drive: tuple[float, ...] = (0.0, 0.0, 0.0, 1.0, 0.0),
    rub: tuple[int, float, float, bool] = (0, 0.0, 0.0, False),
    courant: float = 0.45,
) -> np.ndarray:
    n, sums = area.size, records(LOADS)

    def offset(a: np.ndarray, time: float) -> complex:
        """Of the centre of mass from the axis, in the frame of the deflection."""
        lever = (1.0 - np.power(1.0 - 2.0 * a, 1.5)) / 3.0
        return complex(lever @ np.exp(1j * (middles(n) - whole.slip * time)) / a.sum())

    def rate(a: np.ndarray, momentum: np.ndarray, time: float) -> complex:
        """Of change of that offset."""
        x, y = forced_layer._whirl(time, whole)
        cell, face, d_area, d_q = np.empty((4, n))
        forced_layer.pull(x, y, angles(n), cell, face)
        work = np.zeros((finite_volume.WORK, n + 2 * finite_volume.GHOSTS))
        none, step = np.empty(0), 2 * np.pi / n
        finite_volume.rates(
            *(a, momentum, none, SPIN, 0.0, cell, face, *NOTHING, step, 0.0, rub[3], work, d_area, d_q, none)
        )
        lever = np.sqrt(1.0 - 2.0 * a) * d_area
        moved = complex(lever @ np.exp(1j * (middles(n) - whole.slip * time)) / a.sum())
        return moved - 1j * whole.slip * offset(a, time)

    spare, whole, wall = forced_layer.scratch(n), Drive(*drive, SPIN), Wall(*rub)
    first, moving = offset(area, 0.0), rate(area, q, 0.0)
    outcome, steps = forced_layer.march(*(area, q, 0.0, length, whole, wall, angles(n), courant, spare, sums))
    assert outcome == Outcome.DONE and steps > 0
    last = offset(area, length)
    ends = (first, last), (moving, rate(area, q, length))
    return layer_loads.means(sums[0], length, 2 * np.pi * area.mean(), drive[3], *ends)


@kills("solvers.layer.step:correct", "0.5 * (q[i] + next_q[i] + dt * rate_q[i])", "next_q[i]")
@kills("solvers.layer.step:advance", "time + dt if stage == 2 else time", "time")
def test_steps() -> None:
    """Second order in time."""
    ends = []
    for courant in (0.4, 0.2, 0.1):
        area, u = smooth(12)
        q = u * area - SPIN * area**2
        run(area, q, 1.0, (0.05, -0.3, 2.0, 0.7, 0.1), courant=courant)
        ends.append(np.concatenate([area, q]))
    coarse, fine = np.abs(ends[0] - ends[1]).max(), np.abs(ends[1] - ends[2]).max()
    assert fine < coarse / 3.0, (coarse, fine)


@kills("solvers.layer.step:advance", "calm(area, q, spin)", "pass")
def test_films_stick() -> None:
    """A uniform film keeps the momentum of its faded velocity alone, a layer keeps all of it."""
    for depth, kept in ((1e-6, 2e-2), (1e-3, 1.0)):
        area, speed = np.full(8, depth), 1e-3
        q = speed * area - SPIN * area**2
        run(area, q, 0.01)
        moved = (q + SPIN * area**2) / area
        assert np.all(moved <= speed * kept * (1.0 + 1e-9)) and (kept < 1.0 or np.all(moved > 0.999 * speed))


@kills("solvers.layer.drag:kept_speed", "kept[i] = 1.0 - x * total", "kept[i] = 1.0 - 2.0 * x * total")
@kills("solvers.layer.drag:kept_speed", "1.0 / (1.0 + kept[i])", "1.0 - 2.0 * kept[i]")
@kills("solvers.layer.step:decelerate", "(q[i] + square)", "(q[i] - square)")
def test_friction() -> None:
    """A layer that turns as a whole slows down as each law says."""
    for law, kept in ((1, np.exp(-0.3 * 0.2)), (3, 1 / (1 + 0.3 * 0.05 / 0.08 * 0.2))):
        area = np.full(8, 0.08)
        q = 0.05 * area - SPIN * area**2
        coefficient = 0.3 * (0.08 / (1 - np.sqrt(0.84)) if law == 1 else 1.0)
        run(area, q, 0.2, rub=(law, coefficient, 0.0, False))
        np.testing.assert_allclose((q + SPIN * area**2) / area, 0.05 * kept, rtol=1e-10)


@kills("solvers.layer.state:means", "- 2j * whirl_speed * drift", "- 1j * whirl_speed * drift")
@kills("solvers.layer.state:means", "+ whirl_speed**2 * moved", "- whirl_speed**2 * moved")
@kills("solvers.layer.step:_cell_loads", "moment_y += lever * sine[i]", "moment_y += lever * cosine[i]")
@kills(
    "solvers.layer.step:_cell_loads",
    "force_y += pressure * sine[i]",
    "force_y -= pressure * sine[i]",
)
@kills(
    "solvers.layer.step:tally",
    "(moment_y * cosine - moment_x * sine)",
    "(moment_y * cosine + moment_x * sine)",
)
@kills(
    "solvers.layer.step:tally", "(force_y * cosine - force_x * sine)", "(force_y * cosine + force_x * sine)"
)
@kills("solvers.layer.step:advance", "(y * cosine - x * sine) * dt", "(y * cosine + x * sine) * dt")
@kills("solvers.layer.step:_cell_loads", "turned += u * log", "turned += log")
@kills("solvers.layer.step:tally", "(1.0 - surface_radius(least))", "(1.0 - surface_radius(largest))")
def test_force() -> None:
    """In a thin layer set in motion gently the liquid's momentum and its pressure give the same force.

    They differ by the square of the depth and by the means' rectangles in time.
    """
    area = np.full(24, 0.01)
    sums = run(area, -SPIN * area**2, 16.0, (1e-5, -0.5, 16.0, 0.5, 0.0), courant=0.3)
    # 0.024 here: of second order in cell and step.
    assert abs(sums[0] - sums[5]) < 0.04 * abs(sums[5])
    rest = 1 - np.sqrt(0.98)
    # From rest the liquid turns with neither sign for long: its mean turning is of second order.
    assert abs(sums[2]) < 1e-4 and 0.99 * rest < sums[3].real < rest < sums[4].real < 1.01 * rest


@kills("solvers.layer.step:_cell_loads", "(1.0 + r + r * r) / 3.0", "(1.0 + r) / 2.0")
def test_synchronous() -> None:
    """Under a synchronous whirl a wet layer pushes like a full drum; midpoints take that to rounding."""
    n, amplitude, radius = 32, 0.1, 0.8
    cosine, sine = angles(n)[:2]
    surface = np.sqrt(radius**2 - (amplitude * sine) ** 2) - amplitude * cosine
    area = 0.5 * (1 - surface**2)
    sums = run(area, -SPIN * area**2, 0.5, (amplitude, 0.0, 0.0, 1.0, 0.0))
    assert abs(sums[0] - np.pi * amplitude) < 1e-12 and abs(sums[5] - np.pi * amplitude) < 1e-12


@kills("solvers.layer.step:centre", "2.0 / 3.0 * a", "1.0 / 3.0 * a")
@kills("solvers.layer.step:centre", "y += moment * angles[1, i]", "y += moment * angles[0, i]")
@kills("solvers.layer.step:centre", "(1.0 + r + r * r)", "(1.0 + r)")
def test_centre() -> None:
    """A wet circle about a point is a full disc less one about that point."""
    n, amplitude, radius = 32, 0.1, 0.8
    theta = middles(n) - 0.9
    surface = np.sqrt(radius**2 - (amplitude * np.sin(theta)) ** 2) - amplitude * np.cos(theta)
    x, y = forced_layer.centre(0.5 * (1 - surface**2), angles(n))
    # The missing disc lies at -amplitude along 0.9.
    assert abs(x + 1j * y - amplitude * radius**2 / (1 - radius**2) * np.exp(0.9j)) < 1e-12


@kills(
    "solvers.layer.step:_whirl",
    "drive.amplitude * drive.whirl * drive.whirl * grown",
    "drive.amplitude * drive.whirl * grown",
)
@kills("solvers.layer.step:_whirl", "time / ramp - np.sin", "time / ramp + np.sin")
@kills(
    "solvers.layer.step:_whirl",
    "- drive.weight * np.cos(drive.spin * time)",
    "+ drive.weight * np.cos(drive.spin * time)",
)
@kills("solvers.layer.step:pull", "y * angles[1, i]", "x * angles[1, i]")
@kills("solvers.layer.step:pull", "y * angles[3, i]", "y * angles[1, i]")
def test_drive() -> None:
    """The ramp's growth, the push against the axis' acceleration, gravity downwards as the drum sees it."""
    slip, ramp, whirl, weight = -0.5, 3.0, 0.6, 0.2
    for time in (0.7, 2.2, 5.0):
        part = min(time / ramp, 1.0)
        grown = part - np.sin(2 * np.pi * part) / (2 * np.pi)
        force = 0.01 * whirl**2 * grown * np.exp(1j * slip * time) - 1j * weight * np.exp(-1j * SPIN * time)
        cell, face, ring = np.empty(5), np.empty(5), angles(5)
        x, y = forced_layer._whirl(time, Drive(0.01, slip, ramp, whirl, weight, SPIN))
        forced_layer.pull(x, y, ring, cell, face)
        assert abs(complex(x, y) - force) < 1e-15
        np.testing.assert_allclose(cell, (force * np.exp(-1j * middles(5))).real, atol=1e-15)
        np.testing.assert_allclose(face, (force * np.exp(-1j * (middles(5) - np.pi / 5))).real, atol=1e-15)


@kills("solvers.layer.finite_volume:plain_rates", "_HEAD, VELOCITY, work, None", "_HEAD, _HEAD, work, None")
@kills("solvers.layer.finite_volume:baffled_rates", "take(plates, step, d_q)", "pass")
@kills(
    "solvers.layer.finite_volume:baffled_rates",
    "work[VELOCITY], work[_HALF_VELOCITY], GHOSTS",
    "work[_HEAD], work[_HALF_HEAD], GHOSTS",
)
def test_rates_of_less_are_the_same_to_the_digit() -> None:
    """Those of a plain ring, and of one with baffles at faces and smeared ones, beside those of any."""
    n = 32
    theta, none = middles(n), np.empty(0)
    area = 0.06 + 0.02 * np.cos(theta) + 0.01 * np.sin(3.0 * theta)
    area[20:24] = 0.0
    q = (0.1 + 0.2 * np.sin(theta)) * area - SPIN * area**2
    cell, face = PULL * np.cos(theta), PULL * np.cos(theta - np.pi / n)
    plates = np.zeros((3, COLUMNS))
    plates[:, FACE], plates[:, TIP], plates[:, LOSS], plates[:, OPEN] = (3, 12, -1), 0.03, -1.0, 1.0
    plates[2, DENSITY] = 8.0 / (2.0 * np.pi)
    pairs = (finite_volume.plain_rates, plates[:0]), (finite_volume.baffled_rates, plates)
    for less, table in pairs:
        found = []
        for function in (less, finite_volume.rates):
            out, work = np.zeros((2, n)), np.zeros((finite_volume.WORK, n + 2 * finite_volume.GHOSTS))
            fastest = function(
                *(area, q, none, SPIN, 0.3, cell, face, table.copy(), 0.1, 64.0, 2.0 * np.pi / n, 0.05),
                *(False, work, *out, none),
            )
            found.append((fastest, out))
        assert found[0][0] == found[1][0] > 0.0
        np.testing.assert_array_equal(found[0][1], found[1][1])
