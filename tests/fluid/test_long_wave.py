"""The long-wave equations: two forms of one thing, speeds of the Jacobian, circles at rest."""

from __future__ import annotations

import numpy as np
from scipy.integrate import quad

from fluid import long_wave as lw
from fluid.friction import laws as friction
from fluid.waves import free_wave_frequencies
from tests.mutants import kills

AREA = np.array([0.001, 0.05, 0.15, 0.3, 0.45])
VELOCITY = np.array([0.1, -0.05, 0.2, -0.3, 0.05])
SPIN = 1.3


@kills("fluid.long_wave:wall_pressure", "spin * spin * area", "2.0 * spin * spin * area")
@kills("fluid.long_wave:wall_pressure", "2.0 * spin * log", "spin * log")
@kills("fluid.long_wave:wall_pressure", "0.5 * velocity", "velocity")
@kills("fluid.long_wave:wall_pressure", "pull * (1.0 - surface)", "pull * surface")
@kills("fluid.long_wave:wall_pressure", "/ (surface * surface) - 1.0", "/ surface - 1.0")
def test_pressure_of_the_wall_holds_the_liquid_on_its_circles() -> None:
    """dp/dr = (Omega r + u/r)^2/r + f_r from the surface to the wall, with the flow u/r, by quadrature."""
    for area, velocity, pull in zip(AREA, VELOCITY, (0.0, 0.3, -0.2, 0.1, 0.05), strict=True):
        surface = lw.free_surface_radius(area)
        wanted, _ = quad(lambda r, u=velocity, f=pull: (SPIN * r + u / r) ** 2 / r + f, surface, 1.0)
        found = lw.wall_pressure(velocity, lw.layer_log(area), area, surface, SPIN, pull)
        # Quadrature of a smooth function: to rounding of the largest term.
        assert abs(found - wanted) < 1e-12


@kills("fluid.long_wave:layer_log", "-0.5 * np.log1p", "-np.log1p")
@kills("fluid.long_wave:wave_celerity", "turning + carried, np.sqrt", "turning - carried, np.sqrt")
@kills("fluid.long_wave:wave_celerity", "log * whole * whole", "log * spin * spin")
def test_speeds() -> None:
    """Characteristic speeds are the eigenvalues of the flux Jacobian of (A, u)."""
    step = 1e-6
    for area, velocity in zip(AREA, VELOCITY, strict=True):

        def flux(a: float, u: float) -> np.ndarray:
            log, surface = lw.layer_log(a), lw.free_surface_radius(a)
            return np.array([lw.mass_flux(u, log), lw.bernoulli(u, log, a, surface, SPIN, 0.0)])

        jacobian = np.stack(
            [
                (flux(area + step * area, velocity) - flux(area - step * area, velocity)) / (2 * step * area),
                (flux(area, velocity + step) - flux(area, velocity - step)) / (2 * step),
            ],
            axis=1,
        )
        mean, half = lw.wave_celerity(velocity / (1.0 - 2.0 * area), lw.layer_log(area), SPIN)
        # Central differences: 1e-12 truncation, 1e-10 rounding.
        np.testing.assert_allclose(
            np.sort(np.linalg.eigvals(jacobian)), np.sort([mean - half, mean + half]), rtol=1e-7
        )


@kills("fluid.long_wave:mass_flux", "return velocity * log\n", "return velocity * log * 1.01\n")
@kills(
    "fluid.long_wave:momentum_flux",
    "(log + area * inverse)",
    "(log - area * inverse)",
)
@kills("fluid.long_wave:pressure_force", "/ 3.0 - surface * area", "/ 3.0 + surface * area")
@kills(
    "fluid.long_wave:bernoulli", "2.0 * spin * log * velocity - surface", "spin * log * velocity - surface"
)
def test_forms() -> None:
    """q_t from the momentum form is the product rule of the Bernoulli form where the flow is smooth."""
    n = 256
    theta = 2 * np.pi * np.arange(n) / n
    area = 0.1 + 0.02 * np.cos(theta) + 0.01 * np.sin(2 * theta)
    velocity = 0.05 * np.sin(theta) - 0.02
    pull = 0.03 * np.cos(theta)

    def slope(values: np.ndarray) -> np.ndarray:
        return np.fft.irfft(1j * np.arange(n // 2 + 1) * np.fft.rfft(values), n)

    log, surface = lw.layer_log(area), lw.free_surface_radius(area)
    area_rate = -slope(lw.mass_flux(velocity, log))
    velocity_rate = -slope(lw.bernoulli(velocity, log, area, surface, SPIN, pull))
    # q = u A - Omega A^2 by the chain rule.
    by_bernoulli = velocity_rate * area + velocity * area_rate - 2 * SPIN * area * area_rate
    flow = lw.momentum_flux(velocity, log, area, surface**-2.0) + lw.pressure_force(area, surface, SPIN, pull)
    by_momentum = -slope(flow) + slope(pull) * (1 - surface**3) / 3
    np.testing.assert_allclose(by_momentum, by_bernoulli, atol=1e-13)


@kills("fluid.long_wave:static_head", "- surface * pull", "+ surface * pull")
@kills("fluid.long_wave:surface_at_head", "(square - 2.0 * head)", "(square - head)")
def test_circles() -> None:
    """The head of a circle about the rotation axis is constant, and gives the circle back."""
    theta = np.linspace(-np.pi, np.pi, 50)
    for amplitude in (0.01, 0.3):
        surface = np.sqrt(0.8**2 - (amplitude * np.sin(theta)) ** 2) - amplitude * np.cos(theta)
        wet = surface < 1.0
        pull = SPIN**2 * amplitude * np.cos(theta)
        area = 0.5 * (1.0 - surface**2)
        head = lw.static_head(area, surface, SPIN, pull)[wet]
        np.testing.assert_allclose(head, head[0], rtol=1e-13)
        np.testing.assert_allclose(lw.surface_at_head(head, SPIN, pull[wet]), surface[wet], rtol=1e-13)


def test_linear_waves() -> None:
    """Long waves are the exact free waves as n L -> 0, and with the rational dispersion for n L up to 1."""
    depth = 1e-4
    area = depth * (1 - depth / 2)
    log = lw.layer_log(area)
    mean, half = lw.wave_celerity(0.0, log, SPIN)
    exact = free_wave_frequencies(1, log, SPIN)
    np.testing.assert_allclose([mean + half, mean - half], exact, rtol=1e-7)
    x = np.linspace(0.01, 1.0, 50)
    constant, curved, less = lw.PADE
    shrunk = 1.0 - less * x**2 / (constant + curved * x**2)
    np.testing.assert_allclose(shrunk, np.tanh(x) / x, rtol=5e-4)
    # To fourth order in x the two are equal: their difference falls as x^6.
    small = np.array([0.1, 0.2])
    error = np.abs(1.0 - less * small**2 / (constant + curved * small**2) - np.tanh(small) / small)
    assert 5.8 < np.log2(error[1] / error[0]) < 6.1


@kills("fluid.friction.laws:damping_rate", "(1.0 + lid * depth)", "(1.0 + lid)")
@kills("fluid.friction.laws:damping_rate", "abs(velocity) / area", "velocity / area")
@kills("fluid.friction.laws:stokes_coefficient", "0.5 * np.asarray(viscosity", "2.0 * np.asarray(viscosity")
def test_friction_rates() -> None:
    """tau R/(rho u A) of each law, and the Stokes layer's k with floor and lid."""
    depth, area, velocity = 0.2, 0.18, -0.3
    assert friction.damping_rate(friction.NONE, 9.0, 9.0, depth, area, velocity) == 0.0
    assert friction.damping_rate(friction.LINEAR, 0.5, 9.0, depth, area, velocity) == 0.5 * 0.2 / 0.18
    # k h = sqrt(nu |s|/2) (1 + 2 h/h_c), lid = 2 R/h_c.
    np.testing.assert_allclose(
        friction.damping_rate(friction.STOKES, 0.01, 3.0, depth, area, velocity), 0.01 * 1.6 / 0.18
    )
    np.testing.assert_allclose(
        friction.damping_rate(friction.QUADRATIC, 0.1, 0.0, depth, area, velocity), 0.1 * 0.3 / 0.18
    )
    np.testing.assert_allclose(friction.stokes_coefficient(2e-6, [-9.0, 9.0]), 3e-3)
