import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import linalg

from fluid.waves import (
    capture_speed,
    displacement_ratio,
    force_ratio,
    free_wave_frequencies,
    free_wave_speeds,
    gravity_displacement,
    gravity_offset,
    offset_ratio,
    sector_frequencies,
    wall_drift,
    wall_swing,
)
from meshes.errors import InputError
from tests.mutants import kills
from validation.cases.published.partitions import wave_ratio

POINTS = 24


def chebyshev(a: float, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Nodes from wall to free surface and the differentiation matrix on them."""
    k = np.arange(POINTS)
    x = np.cos(np.pi * k / (POINTS - 1))
    weight = np.where((k == 0) | (k == POINTS - 1), 2.0, 1.0) * (-1.0) ** k
    gap = x[:, None] - x + np.eye(POINTS)
    matrix = np.outer(weight, 1.0 / weight) / gap
    matrix -= np.diag(matrix.sum(axis=1))
    return 0.5 * (radius + a) + 0.5 * (radius - a) * x, matrix * 2.0 / (radius - a)


def layer_system(
    a: float, radius: float, mode: int, spin: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Linear equations of motion: (static + i sigma inertia) (u_r, u_theta, p, xi) = forcing.

    Radial and tangential momentum with Coriolis force and continuity at the nodes, for fields
    e^{i (sigma t - n theta)}; no flow through the wall, the surface moves with the liquid and carries no
    pressure. Nothing is assumed irrotational. The forcing is a unit uniform body force (n = 1).
    """
    r, d = chebyshev(a, radius)
    n, unit, zero = POINTS, np.eye(POINTS), np.zeros((POINTS, POINTS))
    edge = np.zeros((n, 1))
    static = np.block(
        [
            [zero, -2 * spin * unit, d, edge],
            [2 * spin * unit, zero, -1j * mode * unit / r[:, None], edge],
            [d + unit / r[:, None], -1j * mode * unit / r[:, None], zero, edge],
            [np.zeros((1, 3 * n + 1))],
        ]
    ).astype(complex)
    inertia = np.zeros_like(static)
    inertia[:n, :n] = inertia[n : 2 * n, n : 2 * n] = unit
    forcing = np.concatenate((np.ones(n), np.full(n, -1j), np.zeros(n + 1)))
    # The wall takes the place of radial momentum there; the surface pressure that of the same at the surface.
    for row in (0, n - 1):
        static[row], inertia[row], forcing[row] = 0.0, 0.0, 0.0
    static[0, 0] = 1.0
    static[n - 1, 3 * n - 1], static[n - 1, 3 * n] = 1.0, spin**2 * a
    static[3 * n, n - 1], inertia[3 * n, 3 * n] = -1.0, 1.0
    return static, inertia, forcing


def solved_layer(a: float, radius: float, spin: float, s: float) -> tuple[float, float]:
    """Force ratio and surface displacement over the body force, from the equations of motion."""
    static, inertia, forcing = layer_system(a, radius, 1, spin)
    state = linalg.solve(static + 1j * s * inertia, forcing)
    wall_pressure, displacement = state[2 * POINTS], state[3 * POINTS]
    return float((wall_pressure / radius).real), float(displacement.real)


def assert_forced_layer(depth: float, q: float) -> None:
    radius, spin = 0.15, 40.0
    a = radius * (1.0 - depth)
    kappa, s = (radius / a) ** 2, (q - 1.0) * spin
    force, displacement = solved_layer(a, radius, spin, s)
    if q == 0.0:
        # A body force that is fixed in space, as gravity is: displacement per unit of it.
        want = float(gravity_displacement(kappa, spin, 1.0))
    else:
        want = float(displacement_ratio(kappa, q)) / (q * spin) ** 2
    # 24 Chebyshev points resolve 1/r to rounding; the system's condition is about 1e7 there.
    near = max(1.0, abs(float(force_ratio(kappa, q))))
    assert abs(force - float(force_ratio(kappa, q))) <= 1e-8 * near**2
    assert abs(displacement - want) <= 1e-8 * near**2 * abs(want)


@settings(max_examples=40)
@given(depth=st.floats(0.03, 0.7), q=st.floats(-2.0, 3.0).filter(lambda q: min(abs(q), abs(q - 1.0)) > 0.02))
def test_force_and_displacement_solve_the_equations_of_motion(depth: float, q: float) -> None:
    assert_forced_layer(depth, q)


@kills(
    "fluid.waves:force_ratio",
    "_over_resonance(2.0 * np.square(q - 1.0)",
    "_over_resonance(np.square(q - 1.0)",
)
@kills("fluid.waves:_over_resonance", "(1.0 - kappa) * np.square(q) +", "-np.square(q) +")
def test_forced_layers() -> None:
    for depth, q in ((0.1, 0.5), (0.1, 1.3), (0.4, 0.7), (0.3, 2.0), (0.2, 0.0)):
        assert_forced_layer(depth, q)


@kills("fluid.waves:free_wave_frequencies", "root = np.sqrt(t * (t + n))", "root = np.sqrt(t * n)")
@kills("fluid.waves:free_wave_frequencies", "t = np.tanh(n * log)", "t = np.tanh(log)")
@kills("fluid.waves:free_wave_frequencies", "-omega * (n * t)", "omega * (n * t)")
def test_free_waves_solve_the_equations_of_motion(modes: tuple[int, ...] = (1, 2, 5)) -> None:
    """The eigenvalues of the equations of motion hold both free waves of each mode."""
    radius, spin = 0.15, 40.0
    for depth in (0.05, 0.1, 0.5):
        a = radius * (1.0 - depth)
        for mode in modes:
            static, inertia, _ = layer_system(a, radius, mode, spin)
            with np.errstate(all="ignore"):
                sigma = linalg.eigvals(1j * static, inertia)
            sigma = sigma[np.isfinite(sigma)]
            for expected in free_wave_frequencies(mode, -np.log(1.0 - depth), spin):
                # The pencil has infinite eigenvalues, which cost it half of the digits.
                assert np.abs(sigma - expected).min() <= 1e-6 * spin


@given(log=st.floats(1e-3, 5.0), mode=st.integers(1, 40))
def test_free_waves_solve_their_dispersion_relation(log: float, mode: int) -> None:
    prograde, retrograde = free_wave_frequencies(mode, log, 1.0)
    assert prograde > 0.0 > retrograde
    t = np.tanh(mode * log)
    # Vieta: the sum and product of the roots of sigma^2 - 2 T sigma - n T.
    np.testing.assert_allclose(prograde + retrograde, 2 * t, rtol=0, atol=8 * np.finfo(float).eps * prograde)
    np.testing.assert_allclose(prograde * retrograde, -mode * t, rtol=1e-14)


@settings(max_examples=50)
@given(log=st.floats(0.01, 2.0))
def test_the_force_grows_beyond_bounds_at_the_free_waves(log: float) -> None:
    kappa = np.exp(2 * log)
    for speed in free_wave_speeds(1, log, 1.0):
        q = 1.0 + speed
        # A pole of first order: 1/G goes through zero, so halving the distance halves 1/G.
        near, nearer = (1.0 / float(force_ratio(kappa, q + d)) for d in (1e-6, 5e-7))
        assert abs(near) < 1e-3
        # G = 1 + residue/d: the ratio misses 2 by 1/G, and by rounding of D (1e-15) over its change.
        assert near / nearer == pytest.approx(2.0, abs=2 * abs(near) + 1e-7)


def test_thin_layer_waves_do_not_disperse() -> None:
    log = 1e-4
    root = np.sqrt(log**2 + log)
    for mode in (1, 2, 4):
        prograde, retrograde = free_wave_speeds(mode, log, 7.0)
        # tanh(n L) = n L (1 - (n L)^2/3 ...)
        assert prograde == pytest.approx(7.0 * (log + root), rel=(mode * log) ** 2)
        assert retrograde == pytest.approx(7.0 * (log - root), rel=(mode * log) ** 2)


def test_deep_liquid_waves() -> None:
    # a -> 0: T = 1; sigma = Omega (1 +- sqrt(1 + n)).
    np.testing.assert_allclose(free_wave_frequencies(3, np.inf, 2.0), (6.0, -2.0), rtol=1e-15)


@kills(
    "fluid.waves:displacement_ratio",
    "_over_resonance((kappa - 1.0) * np.square(q)",
    "_over_resonance(kappa * np.square(q)",
)
def test_synchronous_whirl() -> None:
    """A circle about the rotation axis, and the added mass of a full drum."""
    kappa = np.array([1.001, 1.2, 3.0])
    np.testing.assert_array_equal(force_ratio(kappa, 1.0), 1.0)
    np.testing.assert_allclose(displacement_ratio(kappa, 1.0), -1.0, rtol=1e-15)
    np.testing.assert_allclose(offset_ratio(kappa, 1.0), 1.0 / (kappa - 1.0), rtol=1e-15)


@kills("fluid.waves:sector_frequencies", "-2j * shared * t", "-1j * shared * t")
@kills("fluid.waves:sector_frequencies", "0.5 * sectors * j", "sectors * j")
@kills("fluid.waves:sector_frequencies", "np.diag(order * t)", "np.diag(t)")
@pytest.mark.parametrize("sectors", [3, 4, 5])
@pytest.mark.parametrize("fill", [0.25, 0.75])
def test_waves_between_walls(sectors: int, fill: float) -> None:
    """Those of elements on a sector, whose slowest wave is off by the square of a cell."""
    log = -0.5 * math.log(1.0 - fill)
    exact, coarse, fine = (
        sector_frequencies(sectors, log)[0],
        *(wave_ratio(sectors, fill, n) for n in (24, 48)),
    )
    # What elements of second order still change is a third of their last change; the series is off by 1e-4.
    assert abs(fine - exact) < abs(fine - coarse) + 2e-4 * exact
    assert abs(fine - exact) < 2e-3 * exact


def test_narrow_sectors_have_deep_waves() -> None:
    """A crest as short as the walls are close knows no Coriolis force: w^2 = m tanh(m L)."""
    found = sector_frequencies(400, 0.2)[0]
    assert found == pytest.approx(math.sqrt(200.0), rel=2e-2)


def test_full_drum_is_a_solid_mass() -> None:
    # a -> 0: 1 - G = 2 (q-1)^2/(kappa (2 (q-1)^2 - q^2)), of the order 1/kappa.
    q = np.array([-1.0, 0.3, 1.7, 2.5])
    np.testing.assert_allclose(force_ratio(1e12, q), 1.0, rtol=0, atol=1e-10)


@kills("fluid.waves:offset_ratio", "-_over_resonance(np.square(q)", "_over_resonance(np.square(q)")
def test_momentum_of_the_liquid() -> None:
    """The force is the liquid's mass times the acceleration of its centre of mass, which the wave moves."""
    q = np.linspace(-2.0, 3.0, 41)
    for kappa in (1.05, 1.2345, 4.0):
        mass = 1.0 - 1.0 / kappa
        offset = offset_ratio(kappa, q)
        # Rounding of G and offset near their pole, where they reach a few hundred.
        np.testing.assert_allclose(force_ratio(kappa, q), mass * (1.0 + offset), rtol=1e-12, atol=1e-12)
        # V offset = -pi a^2 h xi
        np.testing.assert_allclose(
            (kappa - 1.0) * offset, -displacement_ratio(kappa, q), rtol=1e-12, atol=1e-15
        )


@pytest.mark.parametrize(
    ("q", "offset", "force"),
    [(1.0, 4.26017, 0.99939), (0.5, -0.4473, 0.106044), (0.85, 6.31608, 1.38895), (1.3, 9.79667, 2.05048)],
)
def test_volume_of_fluid_simulation(q: float, offset: float, force: float) -> None:
    """Two-dimensional interFoam runs, R = 0.15 m, a = 0.135 m, 40 rad/s; small whirl amplitude."""
    kappa = (0.15 / 0.135) ** 2
    # Two meshes differ by 0.8 % near the wave; the air's inertia adds 0.004 at most, 1.1 % at q = 0.5.
    assert float(offset_ratio(kappa, q)) == pytest.approx(offset, rel=0.01)
    assert float(force_ratio(kappa, q)) == pytest.approx(force, rel=0.012)


@kills("fluid.waves:gravity_offset", "(2.0 * kappa * np.square(omega))", "(kappa * np.square(omega))")
@kills(
    "fluid.waves:gravity_displacement", "-(kappa - 1.0) * gravity_offset", "(kappa - 1.0) * gravity_offset"
)
def test_gravity_is_the_limit_of_a_slow_whirl() -> None:
    """Gravity across the axis: the liquid's weight on the drum, its centre of mass above the axis."""
    kappa, spin, g = np.array([1.05, 1.3, 2.0]), 40.0, 9.81
    # A force fixed in space is the limit of a slow whirl whose acceleration is kept at g: q^2 Omega^2 w0 = g.
    q = 1e-5
    w0 = g / (q * spin) ** 2
    # The next term of the expansion in q is 2 q relative.
    np.testing.assert_allclose(
        gravity_offset(kappa, spin, g), w0 * offset_ratio(kappa, q), rtol=3 * q, atol=0
    )
    np.testing.assert_allclose(
        gravity_displacement(kappa, spin, g), w0 * displacement_ratio(kappa, q), rtol=3 * q, atol=0
    )
    np.testing.assert_allclose(force_ratio(kappa, 0.0), 1.0 - 1.0 / kappa, rtol=1e-15)
    assert np.all(gravity_offset(kappa, spin, g) < 0.0)


@kills("fluid.waves:wall_swing", "/ (kappa * omega)", "/ omega")
def test_gravity_swings_the_liquid_along_the_wall() -> None:
    """What flows through a section of the layer is what its surface takes up: seen from the drum u times the
    mean share of the depth is the speed of the surface, -d xi/dt a = d/dtheta of the flow."""
    kappa, spin, g, radius = 1.3, 40.0, 9.81, 0.15
    inner = radius / math.sqrt(kappa)
    xi = float(gravity_displacement(kappa, spin, g))
    # psi of the wave between the circles, n = 1: its largest u_theta at the wall for a flow of Omega a xi.
    radii = np.linspace(inner, radius, 20_001)
    shape = 1.0 / radius**2 + 1.0 / radii**2
    flow = float(np.trapezoid(shape, radii))
    at_wall = 2.0 / radius**2 * spin * inner * xi / flow
    assert float(wall_swing(kappa, spin, g)) == pytest.approx(at_wall, rel=1e-6)


def stokes_layer_drift(viscosity: float, spin: float, radius: float, swing: float) -> tuple[float, float]:
    """Mean velocity at the edge of the wall's layer by quadratures of its momentum, and of a particle, m/s.

    nu u2'' = mean(w1 du1/dz) for u1 = U (1 - e^(-m z)) e^(i (x/R + Omega t)), u2 = 0 at the wall.
    """
    thickness = math.sqrt(2.0 * viscosity / spin)
    z = np.linspace(0.0, 40.0 * thickness, 40_001)
    m = (1.0 + 1.0j) / thickness
    u1, slope = swing * (1.0 - np.exp(-m * z)), swing * m * np.exp(-m * z)
    w1 = -1j / radius * swing * (z - (1.0 - np.exp(-m * z)) / m)
    force = 0.5 * (w1 * slope.conj()).real
    step = z[1] - z[0]
    below = np.concatenate([[0.0], np.cumsum(0.5 * step * (force[1:] + force[:-1]))])
    shear = (below - below[-1]) / viscosity
    mean = float(np.trapezoid(shear, z))
    # Of a particle the way that it has gone along and off the wall counts as well.
    along = u1[-1] / (1j * spin)
    return mean, mean + 0.5 * float((along.conj() * 1j / radius * u1[-1]).real)


@kills("fluid.waves:wall_drift", "-0.75", "0.75")
@kills("fluid.waves:wall_drift", "-0.75", "-1.25")
@kills("fluid.waves:wall_drift", "np.square(swing) / omega", "swing")
def test_drift_along_the_wall() -> None:
    """The momentum of the wall's layer, of any viscosity: against the spin, 3/4 at a point, 5/4 of a
    particle."""
    radius, kappa, spin, g = 0.05, 1.0 / 0.7, 40.0, 9.81
    swing = float(wall_swing(kappa, spin, g))
    for viscosity in (1e-7, 1e-6):
        mean, particle = stokes_layer_drift(viscosity, spin, radius, swing)
        # The trapezium rule on a thousandth of the layer.
        assert float(wall_drift(radius, kappa, spin, g)) == pytest.approx(mean / radius, rel=1e-5)
        assert particle == pytest.approx(5.0 / 3.0 * mean, rel=1e-5)
    lag = -wall_drift(radius, kappa, spin * np.array([1.0, 2.0]), g) / (spin * np.array([1.0, 2.0]))
    assert lag[0] == pytest.approx(16.0 * lag[1], rel=1e-12)


@kills("fluid.waves:capture_speed", "np.sqrt(g / a)", "np.sqrt(2.0 * g / a)")
def test_capture_speed() -> None:
    """At the capture speed gravity just balances the centrifugal acceleration at the surface."""
    a = np.array([0.02, 0.1, 0.135])
    speed = capture_speed(a, 9.81)
    np.testing.assert_allclose(speed**2 * a, 9.81, rtol=1e-15)


@given(radius=st.floats(0.01, 2.0), ratio=st.floats(0.01, 0.999), g=st.floats(0.1, 100.0))
def test_surface_stays_off_the_wall_at_the_capture_speed(radius: float, ratio: float, g: float) -> None:
    a = ratio * radius
    xi = float(gravity_displacement((radius / a) ** 2, capture_speed(a, g), g))
    # g (R - a)(R + a)/(2 R^2 Omega^2) with Omega^2 = g/a: the depth times a (R + a)/(2 R^2), below 1.
    assert 0.0 < xi < radius - a


@pytest.mark.parametrize(
    ("call", "field"),
    [
        (lambda: free_wave_frequencies(0, 0.1, 1.0), "mode"),
        (lambda: free_wave_frequencies(1, 0.0, 1.0), "layer_log"),
        (lambda: force_ratio(1.0, 0.5), "curvature"),
        (lambda: offset_ratio(np.nan, 0.5), "curvature"),
        (lambda: gravity_offset(1.2, 0.0, 9.81), "spin"),
        (lambda: capture_speed(0.0, 9.81), "free_surface_radius"),
        (lambda: capture_speed(0.1, -1.0), "gravity"),
    ],
)
def test_bad_input(call, field: str) -> None:
    with pytest.raises(InputError) as caught:
        call()
    assert caught.value.field == field


def test_exactly_at_a_free_wave_the_force_is_infinite() -> None:
    # kappa = 2, q = 2: D = -4 + 4.
    assert np.isinf(force_ratio(2.0, 2.0))
