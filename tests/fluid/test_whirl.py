"""The layer with friction: collocated equations of motion, Newton's law, the wall layer, limits."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import linalg

from fluid.fill import Fill
from fluid.friction.laws import Friction, stokes_coefficient
from fluid.liquid import Liquid
from fluid.waves import force_ratio, free_wave_frequencies, offset_ratio
from fluid.whirl import (
    Layer,
    covering_speed,
    damped_waves,
    is_full,
    layer_rate,
    offset_with_friction,
    plane_layer,
    plate_rate,
    plate_terms,
    steady_rate,
    stokes_rate,
    wall_share,
    wave_function,
)
from meshes.chamber import Chamber
from meshes.rings.quadrilaterals import ring
from solvers.sloshing.forced import mode_damping
from solvers.sloshing.modes import sloshing_modes
from solvers.sloshing.system import condense
from tests.fluid.test_waves import POINTS, layer_system
from tests.mutants import kills
from tests.oracles.exact import force_with_friction

RADIUS, SPIN = 0.15, 40.0
WATER = Liquid("water", 1000.0, 1e-6)


def tanh_of(a: float) -> float:
    return (RADIUS**2 - a**2) / (RADIUS**2 + a**2)


def dragged(a: float, rate: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Collocated momentum, continuity and surface, with the drag -k u in both momentum equations."""
    static, inertia, forcing = layer_system(a, RADIUS, 1, SPIN)
    drag = rate * inertia
    drag[2 * POINTS :] = 0.0
    return static + drag, inertia, forcing


@kills("fluid.whirl:wave_function", "- 2.0 * t * omega - 1j", "+ 2.0 * t * omega - 1j")
@kills("fluid.whirl:wave_function", "- 1j * np.asarray(rate)) - t", "+ 1j * np.asarray(rate)) - t")
@kills("fluid.whirl:wave_function", "np.asarray(rate)) - t * np.square", "np.asarray(rate)) + t * np.square")
@kills("fluid.whirl:offset_with_friction", "share = 0.5 * (1.0 - np", "share = 0.5 * (1.0 + np")
@kills("fluid.whirl:offset_with_friction", "-share * np.square(omega)", "share * np.square(omega)")
def test_offset() -> None:
    """Against the equations of motion on Chebyshev points, nothing assumed irrotational."""
    for a in (0.135, 0.1, 0.03):
        for rate in (0.0, 3.0, 60.0):
            for whirl in (30.0, -25.0, 52.0 - 4.0j):
                slip = whirl - SPIN
                static, inertia, forcing = dragged(a, rate)
                answer = np.linalg.solve(static + 1j * slip * inertia, whirl**2 * forcing)
                # d = -xi/(kappa - 1); the collocation has some ten digits.
                wanted = -answer[-1] / ((RADIUS / a) ** 2 - 1.0)
                found = offset_with_friction(tanh_of(a), SPIN, whirl, rate)
                np.testing.assert_allclose(found, wanted, rtol=1e-7)


@kills("fluid.whirl:damped_waves", "t * omega + 0.5j", "t * omega + 1.0j")
@kills(
    "fluid.whirl:damped_waves",
    "np.square(centre) + t * np.square(omega)",
    "np.square(centre) - t * np.square(omega)",
)
def test_free_waves() -> None:
    """Eigenvalues of the collocated equations; their decay k/2 in a thin layer."""
    for a, rate in ((0.135, 3.0), (0.1, 8.0), (0.05, 60.0)):
        static, inertia, _ = dragged(a, rate)
        sigma = linalg.eigvals(static, -1j * inertia)
        sigma = sigma[np.isfinite(sigma)]
        for wave in damped_waves(tanh_of(a), SPIN, rate):
            assert np.min(np.abs(sigma - wave)) < 1e-6 * SPIN
            assert abs(wave_function(tanh_of(a), SPIN, wave, rate)) < 1e-12 * SPIN**2
    for t in (1e-4, 1e-6):
        # The two differ from k/2 by T/sqrt(T^2 + T), about sqrt(T), of it and by the square of k.
        for wave in damped_waves(t, SPIN, 1e-3):
            assert wave.imag == pytest.approx(0.5e-3, rel=2.0 * math.sqrt(t) + 1e-3)
    forward, backward = damped_waves(0.2, SPIN, 0.0)
    expected = free_wave_frequencies(1, math.atanh(0.2), SPIN)
    np.testing.assert_allclose([forward, backward], expected, rtol=1e-14)


def test_frictionless() -> None:
    """The formulas of the inviscid theory."""
    ratio = np.array([-0.5, 0.3, 0.9, 1.0, 1.7])
    for kappa in (1.01, 1.3, 9.0):
        t = (kappa - 1.0) / (kappa + 1.0)
        force = force_with_friction(t, SPIN, ratio * SPIN, 0.0)
        np.testing.assert_allclose(force, force_ratio(kappa, ratio), rtol=1e-12, atol=1e-13)
        offset = offset_with_friction(t, SPIN, ratio * SPIN, 0.0)
        np.testing.assert_allclose(offset, offset_ratio(kappa, ratio), rtol=1e-12)


@given(
    kappa=st.floats(1.0 + 1e-9, 1e6),
    ratio=st.floats(-3.0, 3.0),
    growth=st.floats(0.01, 2.0),
    rate=st.floats(0.0, 10.0),
)
def test_force_is_newtons_law(kappa: float, ratio: float, growth: float, rate: float) -> None:
    """G by the pressure of the wave and the drag on the drum, in kappa, against the offset's acceleration."""
    t = (kappa - 1.0) / (kappa + 1.0)
    omega = ratio - 1j * growth
    s = omega - 1.0
    d = (1.0 - kappa) * omega**2 + 2.0 * kappa * s**2 - 1j * rate * (1.0 + kappa) * s
    numerator = (kappa - 1.0) * (2.0 * s**2 - omega**2 - 1j * rate * (1.0 + kappa) / kappa * s)
    # 1 - omega^2/D cancels where nearly all of the liquid stays behind.
    slack = 1e-12 * (1.0 + abs(omega**2 / (d / kappa)) * t)
    assert abs(force_with_friction(t, 1.0, omega, rate) - numerator / d) <= slack + 1e-9 * abs(numerator / d)


@kills("fluid.whirl:plane_layer", "0.5 * film", "1.0 * film")
@kills("fluid.whirl:plane_layer", "math.sqrt(fill.liquid.viscosity)", "fill.liquid.viscosity")
@kills("fluid.whirl:plane_layer", "film / (2.0 - film)", "film / (2.0 + film)")
@kills("fluid.whirl:wall_share", "crests * (1.0", "(1.0")
@kills("fluid.whirl:wall_share", "(1.0 + layer_tanh) / layer_tanh", "(1.0 - layer_tanh) / layer_tanh")
def test_laws() -> None:
    """Linear: torque of the shear over the angular momentum. Laminar: heat at the wall over the energy."""
    chamber = Chamber(RADIUS, 0.02)
    for share in (1e-9, 0.1, 0.6):
        fill = Fill(chamber, WATER, share * chamber.capacity)
        a, depth = fill.surface_radius, fill.depth
        area = 0.5 * share * RADIUS**2
        layer = plane_layer(fill, Friction("linear", 0.7))
        assert layer is not None
        assert layer.rate == pytest.approx(0.7 * depth * RADIUS / area, rel=1e-12)
        assert layer.layer_tanh == pytest.approx(share / (2.0 - share), rel=1e-12)
        assert layer.mass == pytest.approx(1000.0 * fill.volume)
        layer = plane_layer(fill, Friction("stokes"))
        assert layer is not None and layer.rate == 0.0
        assert layer.lids == pytest.approx(2.0 * 1e-3 / chamber.height, rel=1e-12)
        for slip in (7.0, -7.0):
            k = float(stokes_coefficient(1e-6, slip)) * 4.0 * RADIUS * a**2 / (RADIUS**4 - a**4)
            drag = complex(stokes_rate(layer.stokes, slip))
            # The difference of fourth powers keeps seven digits of a film of 1e-9.
            assert drag.real == pytest.approx(k, rel=1e-6)
            # Inertia: -i k s has the real part k_i s, of the sign of s^2.
            assert drag.imag == pytest.approx(math.copysign(drag.real, slip), rel=1e-12)
        for n in (1, 2, 3):
            # u_r and u_theta go as r^(n - 1) -+ R^(2 n)/r^(n + 1).
            r = a + (RADIUS - a) * (0.5 + 0.5 * np.polynomial.legendre.leggauss(40)[0])
            weight = 0.5 * (RADIUS - a) * np.polynomial.legendre.leggauss(40)[1]
            inner, outer = (r / RADIUS) ** (n - 1), (RADIUS / r) ** (n + 1)
            energy = weight @ ((np.square(inner - outer) + np.square(inner + outer)) * r)
            t_n = math.tanh(n * math.log(RADIUS / a))
            assert wall_share(t_n, n) == pytest.approx(4.0 * RADIUS**2 / energy, rel=1e-6)
    for law in (Friction(), Friction("quadratic", 0.3)):
        layer = plane_layer(fill, law)
        assert layer is not None and layer.rate == layer.stokes == layer.lids == 0.0


@kills("fluid.whirl:layer_rate", "layer.lids * plate_rate", "2.0 * layer.lids * plate_rate")
@kills("fluid.whirl:_plates", "first * along + second * against", "second * along + first * against")
@kills("fluid.whirl:steady_rate", "-slower_slip", "slower_slip")
def test_decay_is_that_of_the_modes() -> None:
    """Waves of a ring by elements with the Coriolis force on floor and lid, to first order in friction."""
    height = 0.02
    for a in (0.135, 0.09):
        system = condense(ring(RADIUS, a, 64, 4))
        modes = sloshing_modes(system, SPIN, 4)
        found = mode_damping(system, modes, 1e-6, height)
        for frequency, rate in zip(modes.frequency.tolist(), found.rate.tolist(), strict=True):
            waves = {n: free_wave_frequencies(n, math.log(RADIUS / a), SPIN) for n in (1, 2)}
            n, s = min(
                ((n, float(s)) for n in waves for s in waves[n]), key=lambda wave: abs(wave[1] - frequency)
            )
            if abs(s - frequency) > 1e-4 * SPIN:
                continue  # of more crests
            t = math.tanh(n * math.log(RADIUS / a))
            layer = Layer(1.0, t, 0.0, 1e-3 / RADIUS * wall_share(t, n), 2e-3 / height)
            k = complex(layer_rate(layer, SPIN, s)).real
            # (s - i g)^2 - ... = i k s; four quadratic elements across have the wall's slope to 1e-3.
            assert k * s / (2.0 * (s - t * SPIN)) == pytest.approx(rate, rel=2e-3)
            if n == 1 and s < 0.0:
                steady = complex(steady_rate(layer, SPIN) + stokes_rate(layer.stokes, s))
                assert steady.real == pytest.approx(k, rel=1e-12)


@kills("fluid.whirl:_plates", "0.5 * (1.0 - t), 0.5 * (1.0 + t)", "0.5 * (1.0 - t), 0.5")
@kills("fluid.whirl:_plates", "first * along + second * against", "second * along + first * against")
@kills("fluid.whirl:_plates", "np.sqrt(1j * (s + twice))", "np.sqrt(1j * s)")
def test_floor_and_lid() -> None:
    """Offset with a drag of its own on each circle of the flow, against the equations of motion."""
    lids, momentum = 0.7, slice(0, 2 * POINTS)
    for a in (0.135, 0.1, 0.05):
        for whirl in (30.0, -25.0, 190.0, 52.0 - 4.0j, -60.0 - 2.0j):
            slip = whirl - SPIN
            static, inertia, forcing = dragged(a, 0.0)
            # u + i v as e^{i s t} and its mirror image feel the Coriolis force with and against their turn.
            along, against = (lids * np.sqrt(1j * (slip + turn)) for turn in (2.0 * SPIN, -2.0 * SPIN))
            turned = np.kron([[0.0, 0.5j], [-0.5j, 0.0]], np.eye(POINTS))
            drag = 0.5 * (along + against) * np.eye(2 * POINTS) + (along - against) * turned
            static[momentum, momentum] += inertia[momentum, momentum].diagonal()[:, None] * drag
            answer = np.linalg.solve(static + 1j * slip * inertia, whirl**2 * forcing)
            wanted = -answer[-1] / ((RADIUS / a) ** 2 - 1.0)
            rate = layer_rate(Layer(1.0, tanh_of(a), 0.0, 0.0, lids), SPIN, slip)
            found = offset_with_friction(tanh_of(a), SPIN, whirl, rate)
            np.testing.assert_allclose(found, wanted, rtol=1e-7)


def test_slope_of_floor_and_lid() -> None:
    """Against a central difference, of second order in the step; at the end of a cut it is finite."""
    for t, slip in ((0.1, 30.0 - 2.0j), (0.7, -95.0 + 4.0j)):
        ends = [plate_rate(t, SPIN, slip + side * 1e-3) for side in (1.0, -1.0)]
        slope = complex(plate_terms(t, SPIN, slip)[1])
        assert slope == pytest.approx(complex(ends[0] - ends[1]) / 2e-3, rel=1e-7)
    assert np.isfinite(plate_terms(0.1, SPIN, np.array([2.0 * SPIN, -2.0 * SPIN]))[1]).all()


@kills("fluid.whirl:stokes_rate", "np.sqrt(1j * np.asarray(slip", "np.sqrt(-1j * np.asarray(slip")
def test_wall_layer() -> None:
    """Shear of a growing oscillation on a wall: u_t + 2 i Omega u = nu u_yy + ... on a fine grid.

    Along the wall without the Coriolis force, on floor and lid as u + i v with it.
    """
    nu, points, spin = 1e-3, 6000, 0.7
    pairs = [(s, turn) for s in (3.0 - 0.4j, -2.0 - 0.1j, 1.0 + 0.3j) for turn in (0.0, 2.0 * spin)]
    for slip, turn in pairs:
        thick = math.sqrt(nu / abs(slip + turn))
        y = np.linspace(0.0, 40.0 * thick, points)
        step = y[1]
        # Velocity relative to the outer flow, -U on the wall.
        band = np.zeros((3, points), dtype=complex)
        band[0, 2:] = band[2, :-2] = nu / step**2
        band[1, 1:-1] = -2.0 * nu / step**2 - 1j * (slip + turn)
        band[1, [0, -1]] = 1.0
        right = np.zeros(points, dtype=complex)
        right[0] = -1.0
        u = linalg.solve_banded((1, 1), band, right)
        shear = nu * (-1.5 * u[0] + 2.0 * u[1] - 0.5 * u[2]) / step
        # Second order: (step/thickness)^2 of some 4e-5.
        drag = math.sqrt(nu) * plate_rate(-1.0, spin, slip) if turn else stokes_rate(math.sqrt(nu), slip)
        assert complex(drag) == pytest.approx(shear, rel=1e-4)


@kills("fluid.whirl:covering_speed", "min(outer, inner)", "max(outer, inner)")
@kills("fluid.whirl:covering_speed", "gravity * chamber.height / min", "2.0 * gravity * chamber.height / min")
def test_covering_speed() -> None:
    """There the paraboloid of the liquid's volume runs through the lid's rim or the inner wall's foot."""
    chamber = Chamber(0.2, 0.05, 0.1)
    for share in (0.02, 0.3, 0.7, 0.95):
        fill = Fill(chamber, WATER, share * chamber.capacity)
        spin = covering_speed(fill, 9.81)
        z = np.linspace(-0.025, 0.025, 2001)
        for gain, fits in ((1.0 + 1e-9, True), (1.0 - 1e-9, False)):
            squared = fill.surface_radius**2 + 2.0 * 9.81 * z / (spin * gain) ** 2
            assert np.trapezoid(math.pi * (0.2**2 - squared), z) == pytest.approx(fill.volume, rel=1e-9)
            assert bool(squared[-1] <= 0.2**2 and squared[0] >= 0.1**2) == fits
    assert covering_speed(fill, 0.0) == covering_speed(Fill(chamber, WATER, 0.0), 9.81) == 0.0


def test_no_layer_without_liquid_or_surface() -> None:
    for chamber in (Chamber(0.1, 0.02), Chamber(0.1, 0.02, 0.04)):
        assert plane_layer(Fill(chamber, WATER, 0.0), Friction()) is None
        full = Fill(chamber, WATER, chamber.capacity)
        assert is_full(full) and plane_layer(full, Friction()) is None
        assert not is_full(Fill(chamber, WATER, 0.999 * chamber.capacity))
