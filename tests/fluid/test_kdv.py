"""Coefficients of one family of waves against the long-wave equations they are derived from."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from fluid import waves
from fluid.kdv import (
    KdvCoefficients,
    coefficients,
    decay,
    force_ratio,
    forcing,
    offset,
    validity,
    wave_frequency,
)
from meshes.errors import InputError
from tests.mutants import kills

CASES = [(0.15, 0.135, 40.0), (0.2, 0.199, 90.0), (1.0, 0.3, 3.0)]
FAMILIES = (1, -1)


def flux_jacobian(radius: mpf, spin: mpf, area: mpf, u: mpf) -> list[list[mpf]]:
    """Derivatives of the two long-wave fluxes by A and u, differenced from the fluxes themselves."""

    def log(a: mpf) -> mpf:
        return mp.log(radius / mp.sqrt(radius**2 - 2 * a))

    def volume(a: mpf, v: mpf) -> mpf:
        return radius * v * log(a)

    def head(a: mpf, v: mpf) -> mpf:
        bernoulli = v**2 * radius**2 / (2 * (radius**2 - 2 * a)) + spin**2 * a
        return (bernoulli + 2 * spin * radius * log(a) * v) / radius

    return [[mp.diff(f, (area, u), order) for order in ((1, 0), (0, 1))] for f in (volume, head)]


def characteristic(radius: mpf, spin: mpf, area: mpf, u: mpf, family: int) -> tuple[mpf, mpf]:
    """Wave speed, and du/dA along the simple wave."""
    (a, b), (c, d) = flux_jacobian(radius, spin, area, u)
    speed = (a + d) / 2 + family * mp.sqrt((a - d) ** 2 / 4 + b * c)
    return speed, (speed - a) / b


def steepening_matches(radius: float, surface: float, spin: float, family: int) -> None:
    """alpha is the derivative of the wave speed along the simple wave, at rest."""
    with mp.workdps(40):
        R, a, omega = mpf(radius), mpf(surface), mpf(spin)
        area = (R**2 - a**2) / 2
        speed, slope = characteristic(R, omega, area, mpf(0), family)
        step = area * mpf(10) ** -8

        def along(e: mpf) -> mpf:
            # Along the tangent of the simple wave: its curvature does not touch the first derivative.
            return characteristic(R, omega, area + e, slope * e, family)[0]

        alpha = (along(step) - along(-step)) / (2 * step)
    got = coefficients(radius, surface, spin, family)
    # The central difference errs by 1e-16; the rounding of a grows by 1/(1 - P) in the retrograde family.
    assert got.linear_speed == pytest.approx(float(speed), rel=1e-13)
    assert got.steepening == pytest.approx(float(alpha), rel=1e-12)


def dispersion_matches(radius: float, surface: float, spin: float, family: int) -> None:
    """delta is what the exact frequency lacks of n lambda0, over n^3, for n towards 0."""
    with mp.workdps(60):
        n, log = mpf(10) ** -10, mp.log(mpf(radius) / mpf(surface))
        t = mp.tanh(n * log)
        sigma = mpf(spin) * (t + family * mp.sqrt(t**2 + n * t))
        speed = mpf(spin) * (log + family * mp.sqrt(log**2 + log))
        delta = (speed - sigma / n) / n**2
    # The next term of the expansion is n^2 = 1e-20 smaller.
    assert coefficients(radius, surface, spin, family).dispersion == pytest.approx(float(delta), rel=1e-12)


def forced_response(c: KdvCoefficients, acceleration: float, s: float) -> np.ndarray:
    """(eta, u) of the two linear equations under F cos(theta - s t): amplitudes of e^{i (theta - s t)}."""
    L, R, a = c.layer_log, c.radius, c.surface_radius
    matrix = 1j * np.array([[-s, R * L], [c.spin**2 / R, 2.0 * c.spin * L - s]])
    # f_r = F e^{i (theta - s t)} enters as (a/R) f_r,theta.
    return np.linalg.solve(matrix, np.array([0.0, 1j * a * acceleration / R]))


def families_add_up(radius: float, surface: float, spin: float) -> None:
    """The linear answers q/(lambda0 - s) of both families together are that of the two equations."""
    both = [coefficients(radius, surface, spin, family) for family in FAMILIES]
    for s in (0.0, 0.3 * spin, -0.9 * spin, 1.001 * both[0].linear_speed, 1.001 * both[1].linear_speed):
        exact = forced_response(both[0], 2.0, s)[0]
        # (lambda0 - s) eta' + q sin(xi) = 0, so eta = q cos(xi)/(lambda0 - s).
        summed = sum(float(forcing(c, 2.0)) / (c.linear_speed - s) for c in both)
        # Rounding, multiplied by a thousand at the two resonances.
        assert summed == pytest.approx(exact.real, rel=1e-11)
        assert abs(exact.imag) < 1e-12 * abs(exact)


def resonance_is_projected(radius: float, surface: float, spin: float, family: int) -> None:
    """Next to the resonance the response of the two equations is that of the one family."""
    c = coefficients(radius, surface, spin, family)
    gap = 1e-7 * (c.linear_speed - c.other_speed)
    exact = forced_response(c, 3.0, c.linear_speed + gap)[0].real
    # The other family adds gap/(2 S) = 1e-7 to it, rounding over gap another 1e-9.
    assert float(forcing(c, 3.0)) / -gap == pytest.approx(exact, rel=2e-7)


def friction_is_projected(radius: float, surface: float, spin: float, family: int) -> None:
    """gamma is the decay of the family's free wave under a small linear friction."""
    c = coefficients(radius, surface, spin, family)
    k = 1e-5 * abs(c.linear_speed)
    L, R = c.layer_log, c.radius
    rates = np.linalg.eigvals(
        np.array([[0.0, -1j * R * L], [-1j * c.spin**2 / R, -2j * c.spin * L - k]], dtype=complex)
    )
    rate = rates[np.argmin(np.abs(rates + 1j * c.linear_speed))].real
    # Corrections are of order k^3 in the decay: k^2 relative.
    assert float(decay(c, k)) == pytest.approx(-rate, rel=1e-7)


@kills("fluid.kdv:force_ratio", "(1.0 + np.asarray(liquid_offset", "(1.0 - np.asarray(liquid_offset")
@kills("fluid.kdv:force_ratio", "2.0 * c.mean_area / c.radius**2", "c.mean_area / c.radius**2")
def test_synchronous_whirl_is_static() -> None:
    """At s = 0 both families together displace the layer as statics does, and the force is m_f omega^2 w0."""
    radius, surface, spin, w0 = 0.15, 0.135, 40.0, 1e-4
    kappa = (radius / surface) ** 2
    xi = 2.0 * np.pi * np.arange(16) / 16
    share, total = [], 0.0
    for family in FAMILIES:
        c = coefficients(radius, surface, spin, family)
        eta = float(forcing(c, spin**2 * w0)) / c.linear_speed * np.cos(xi)
        share.append(complex(offset(c, eta)).real / w0)
        total = total + complex(offset(c, eta))
    assert total == pytest.approx(w0 / (kappa - 1.0), rel=1e-13)
    assert complex(force_ratio(c, total, w0)) == pytest.approx(1.0, rel=1e-13)
    # The prograde family alone: 35 % of the truth, the retrograde 65 %.
    assert share[0] * (kappa - 1.0) == pytest.approx(0.3456, abs=1e-4)
    assert share[1] * (kappa - 1.0) == pytest.approx(0.6544, abs=1e-4)


@kills("fluid.kdv:offset", "eta * np.exp(1j * angle)", "eta * np.exp(-1j * angle)")
@kills("fluid.kdv:offset", "c.surface_radius / c.mean_area * first", "c.radius / c.mean_area * first")
def test_moment_of_the_layer() -> None:
    """The offset is the first moment of the liquid, here by quadrature over the layer."""
    c = coefficients(0.15, 0.135, 40.0, -1)
    xi = 2.0 * np.pi * np.arange(64) / 64
    eta = 1e-6 * c.mean_area * (np.cos(xi - 0.7) + 0.3 * np.cos(2.0 * xi))
    r_s = np.sqrt(c.radius**2 - 2.0 * (c.mean_area + eta))
    nodes, weights = np.polynomial.legendre.leggauss(8)
    r = 0.5 * (c.radius + r_s) + 0.5 * (c.radius - r_s) * nodes[:, None]
    inner = 0.5 * (c.radius - r_s) * np.sum(weights[:, None] * r**2, axis=0)
    moment, area = np.mean(inner * np.exp(1j * xi)), np.mean(c.mean_area + eta)
    # What is left out is eta/a^2 = 1e-7, and 1e-10 of rounding of the moment against its parts.
    assert complex(offset(c, eta)) == pytest.approx(complex(moment / area), rel=1e-6)


CONVENTIONS: dict[str, tuple[float, float, Callable[..., mpf]]] = {
    # u_t as each code writes its right-hand side, from u, u_x, u_xx, u_xxx.
    "py-pde": (-6.0, 1.0, lambda u, u1, u2, u3: 6 * u * u1 - u3),
    "dedalus": (1.0, -2e-4, lambda u, u1, u2, u3: 0 * u2 + mpf("2e-4") * u3 - u * u1),
    "exponax": (-6.0, 1.0, lambda u, u1, u2, u3: -(-6 * u * u1) - u3),
}


def convention_maps(name: str, family: int) -> None:
    """Our solitary wave, rescaled [theory: kdv, eq. 14], solves the equation as the other code states it."""
    p, d, right_hand_side = CONVENTIONS[name]
    c = coefficients(0.15, 0.135, 40.0, family)
    angle_scale = float(np.cbrt(d / c.dispersion))
    field_scale = c.steepening * angle_scale / p
    height = 0.1 * c.mean_area
    speed, width = c.steepening * height / 3.0, math.sqrt(c.steepening * height / (12.0 * c.dispersion))
    with mp.workdps(40):

        def u(x: mpf, t: mpf) -> mpf:
            return mpf(field_scale) * mpf(height) * mp.sech(width * (x / mpf(angle_scale) - speed * t)) ** 2

        for place in (-1.0, 0.2, 0.6):
            x = mpf(place) * mpf(angle_scale) / mpf(width)
            space = [mp.diff(u, (x, mpf(0)), (k, 0)) for k in range(4)]
            left, right = mp.diff(u, (x, mpf(0)), (0, 1)), right_hand_side(*space)
            # Scales and speeds are rounded floats.
            assert abs(left - right) < mpf(10) ** -13 * abs(left)


@kills("fluid.kdv:wave_frequency", "n * (c.linear_speed - c.dispersion", "n * (c.linear_speed + c.dispersion")
def test_frequency_solves_the_equation() -> None:
    """eta ~ exp(i n theta - i omega t) solves eta_t + lambda0 eta_theta + delta eta_3theta = 0."""
    for family in FAMILIES:
        c = coefficients(0.15, 0.135, 40.0, family)
        n = np.arange(-4.0, 5.0)
        omega = wave_frequency(n, c, whitham=False)
        left = -1j * omega + c.linear_speed * 1j * n + c.dispersion * (1j * n) ** 3
        assert np.max(np.abs(left)) < 1e-12 * np.max(np.abs(omega))


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("case", CASES)
def test_coefficients_follow_from_the_long_wave_equations(
    case: tuple[float, float, float], family: int
) -> None:
    steepening_matches(*case, family)
    dispersion_matches(*case, family)
    resonance_is_projected(*case, family)
    friction_is_projected(*case, family)


@pytest.mark.parametrize("case", CASES)
def test_both_families_add_up(case: tuple[float, float, float]) -> None:
    families_add_up(*case)


def test_printed_figures() -> None:
    """R = 0.15 m, h0/R = 0.1, 40 rad/s: ten printed digits."""
    for family, figures in (
        (1, (17.86499447, 18264.20185, 0.0432573)),
        (-1, (-9.43615322, -5095.477568, -0.01206823)),
    ):
        c = coefficients(0.15, 0.135, 40.0, family)
        # Half a unit of the last digit printed.
        for got, printed, half in zip(
            (c.linear_speed, c.steepening, c.dispersion), figures, (5e-9, 5e-6, 5e-8), strict=True
        ):
            assert got == pytest.approx(printed, abs=half)


@given(
    ratio=st.floats(1e-3, 0.9999), spin=st.floats(1.0, 500.0), radius=st.floats(0.01, 2.0)
)  # fmt: skip
@settings(max_examples=40)
def test_families_share_what_they_must(ratio: float, spin: float, radius: float) -> None:
    a = ratio * radius
    plus, minus = (coefficients(radius, a, spin, family) for family in FAMILIES)
    L = plus.layer_log
    assert plus.linear_speed > 0.0 > minus.linear_speed
    # lambda0+ lambda0- = -Omega^2 L, the constant of the characteristic polynomial.
    assert plus.linear_speed * minus.linear_speed == pytest.approx(-(spin**2) * L, rel=1e-12)
    assert plus.other_speed == pytest.approx(minus.linear_speed, rel=1e-9)
    for c in (plus, minus):
        assert c.dispersion / c.steepening == pytest.approx(a**2 * L**3 / 9.0, rel=1e-12)
        assert math.copysign(1.0, c.steepening) == c.family
    # Friction is shared out between the families.
    assert float(decay(plus, 1.0) + decay(minus, 1.0)) == pytest.approx(1.0, rel=1e-9)


@pytest.mark.parametrize("family", FAMILIES)
def test_dispersion_of_both_kinds(family: int) -> None:
    c = coefficients(0.15, 0.135, 40.0, family)
    n = np.arange(-5, 6)
    for whitham in (False, True):
        omega = wave_frequency(n, c, whitham)
        assert np.all(omega == -omega[::-1])
    exact = waves.free_wave_frequencies(np.arange(1, 6), c.layer_log, c.spin)[0 if family == 1 else 1]
    assert np.all(wave_frequency(np.arange(1, 6), c, whitham=True) == exact)
    thin = coefficients(0.15, 0.15 * 0.999, 40.0, family)
    gap = wave_frequency(1, thin, whitham=True) - wave_frequency(1, thin, whitham=False)
    # The next term is smaller than delta by about L^2 = 1e-6; rounding is 1e-15/L^2 = 1e-9 of delta.
    assert abs(float(gap)) < 1e-5 * abs(thin.dispersion)


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("name", CONVENTIONS)
def test_conventions_of_other_codes(name: str, family: int) -> None:
    convention_maps(name, family)


def test_force_near_resonance_is_that_of_the_exact_theory() -> None:
    radius, surface, spin, w0 = 0.15, 0.15 * 0.999, 40.0, 1e-6
    c = coefficients(radius, surface, spin, 1)
    s = 0.9 * c.linear_speed
    xi = 2.0 * np.pi * np.arange(16) / 16
    whirl = spin + s
    eta = float(forcing(c, whirl**2 * w0)) / (c.linear_speed - s) * np.cos(xi)
    kappa = (radius / surface) ** 2
    # Left out: the other family, |s - lambda0|/|s - lambda0'|, 0.1/1.9 in a thin layer.
    left_out = float(validity(c, eta, s).neglected)
    assert left_out == pytest.approx(0.0527, abs=2e-3)
    d = complex(offset(c, eta))
    assert d.real / w0 == pytest.approx(float(waves.offset_ratio(kappa, whirl / spin)), rel=1.5 * left_out)
    got = complex(force_ratio(c, d, w0)).real - (1.0 - 1.0 / kappa)
    exact = float(waves.force_ratio(kappa, whirl / spin)) - (1.0 - 1.0 / kappa)
    assert got == pytest.approx(exact, rel=1.5 * left_out)


def test_validity_numbers() -> None:
    c = coefficients(0.15, 0.135, 40.0, -1)
    eta = c.mean_area * np.array([[0.2, -0.1, 0.0], [1.1, -1.2, 0.1]])
    found = validity(c, eta, np.array([c.linear_speed, c.other_speed]))
    assert found.amplitude == pytest.approx([0.2, 1.2])
    assert found.thinnest == pytest.approx([0.9, -0.2])
    assert found.detuning == pytest.approx([0.0, 1.0])
    assert found.neglected[0] == 0.0
    assert found.neglected[1] > 1e10 or np.isinf(found.neglected[1])


@pytest.mark.parametrize(
    ("field", "call"),
    [
        ("radius", lambda: coefficients(0.0, 0.1, 1.0, 1)),
        ("surface_radius", lambda: coefficients(0.1, 0.1, 1.0, 1)),
        ("spin", lambda: coefficients(0.2, 0.1, math.nan, 1)),
        ("family", lambda: coefficients(0.2, 0.1, 1.0, 0)),
        ("friction_rate", lambda: decay(coefficients(0.2, 0.1, 1.0, 1), -1.0)),
        ("whirl_amplitude", lambda: force_ratio(coefficients(0.2, 0.1, 1.0, 1), 0.0, 0.0)),
    ],
)
def test_bad_input_is_named(field: str, call: Callable[[], object]) -> None:
    with pytest.raises(InputError) as caught:
        call()
    assert caught.value.field == field


@kills("fluid.kdv:coefficients", "root = math.sqrt(log * (log + 1.0))", "root = math.sqrt(log)")
@kills("fluid.kdv:coefficients", "(2.0 * log + 1.0) / (2.0 * root)", "(2.0 * log + 1.0) / root")
@kills("fluid.kdv:coefficients", "-1.0 / (4.0 * root**2 * (1.0 + swing))", "1.0 - 2.0 * swing")
@kills("fluid.kdv:coefficients", "3.0 * spin / surface_radius**2", "3.0 * spin / radius**2")
@kills("fluid.kdv:coefficients", "3.0 * spin / surface_radius**2", "1.5 * spin / surface_radius**2")
@kills("fluid.kdv:coefficients", "log + root if family == 1", "root if family == 1")
@kills("fluid.kdv:coefficients", "-log / (log + root)", "log / (log + root)")
def test_steepening_of_both_families() -> None:
    for family in FAMILIES:
        steepening_matches(0.15, 0.135, 40.0, family)


@kills("fluid.kdv:coefficients", "spin * log**3 / 3.0 * share", "spin * log**3 / 6.0 * share")
@kills("fluid.kdv:coefficients", "spin * log**3 / 3.0 * share", "-spin * log**3 / 3.0 * share")
def test_dispersion_of_the_prograde_family() -> None:
    dispersion_matches(0.15, 0.135, 40.0, 1)


@kills("fluid.kdv:coefficients", "coupling=family * log", "coupling=log")
@kills("fluid.kdv:coefficients", "log * surface_radius / (2.0", "log * radius / (2.0")
def test_resonance_of_the_retrograde_family() -> None:
    resonance_is_projected(0.15, 0.135, 40.0, -1)
    families_add_up(0.15, 0.135, 40.0)


@kills("fluid.kdv:decay", "k * abs(c.linear_speed) /", "k * abs(c.other_speed) /")
def test_friction_of_the_prograde_family() -> None:
    friction_is_projected(0.15, 0.135, 40.0, 1)


def test_conventions_of_dedalus() -> None:
    for family in FAMILIES:
        convention_maps("dedalus", family)
