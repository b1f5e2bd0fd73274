"""Wrong formulas of liquids and balancers, evaluated as published and as derived [theory: errata]."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from fluid.printed import (
    dry_volume_as_printed,
    dry_volume_frozen_angle,
    liquid_angle_as_printed,
    liquid_volume_by_lens,
    optimal_volume_as_printed,
    optimal_volume_by_lens,
    optimal_volume_disc_corrected,
)
from fluid.upright import free_surface_term
from meshes.chamber import Chamber
from solvers.rotor.vector_model import balance_angles, balance_residual
from validation.case import Case, Claims

CLAIMS = Claims("errata")

GRAVITY = 9.81

# Where the formulas of the liquid are compared. The sources evaluate none of them, so any chamber would do.
_CHAMBER = Chamber(radius=0.2, height=0.05)
_SPEED = 90.0
_ECCENTRICITY = 0.001


def cases() -> Iterator[Case]:
    """Errata of the optimal volume, the liquid's angle, the stability of the upright axis and amplitudes."""
    at = (_CHAMBER, _ECCENTRICITY, _SPEED, GRAVITY)
    corrected = optimal_volume_disc_corrected(*at)
    yield CLAIMS.case(
        "dr-eq-18",
        optimal_volume_by_lens(*at),
        printed=optimal_volume_as_printed(*at),
        note=f"moment about the rotation axis: {corrected * 1e6:.1f} ml; a disc still stands for a lens",
    )
    near = _CHAMBER.radius - _ECCENTRICITY
    far = math.sqrt(2.0 * GRAVITY * _CHAMBER.height / _SPEED**2 + near**2)
    s = near + far
    yield CLAIMS.case(
        "dr-eq-18-moment",
        _polar_moment_about_axis(0.5 * s, 0.5 * (far - near)) / (math.pi * s**4),
        printed=3.0 / 32.0,
        note=f"about a point of the rim it is {_polar_moment_about_axis(0.5, 0.5) / math.pi:.5f}",
    )
    # The waterline on the floor crosses the wall half way between its near and its far point.
    constant = _SPEED**2 / (2.0 * GRAVITY) * _CHAMBER.radius**2
    there = (_CHAMBER, constant, _ECCENTRICITY, _SPEED, GRAVITY)
    frozen = f"repaired, the angle frozen at the floor: {dry_volume_frozen_angle(*there) * 1e6:.2f} ml"
    printed = dry_volume_as_printed(*there)
    yield CLAIMS.case("dr-eq-20", liquid_volume_by_lens(*there), printed=printed, note=frozen)
    yield from (_upright_angle(), _oblate())
    lag, ratio = math.radians(30.0), 0.8
    pair = liquid_angle_as_printed(lag, ratio), float(balance_angles(lag, ratio)[1])
    left, right = (abs(float(balance_residual(angle, lag, ratio))) for angle in pair)
    for name, source in (("dr-eq-25", "DR18, eq. 25"), ("dg-eq-4", "DG21, eq. 4")):
        words = {"name": name, "source": source, "left": left, "right": right}
        yield CLAIMS.case("liquid-angle", pair[1], printed=pair[0], **words)
    yield from _artificial_unbalance()
    yield _kinetic_energy()


def _polar_moment_about_axis(radius: float, distance: float) -> float:
    """Polar moment of a disc about an axis at that distance from its centre, by quadrature."""
    node, weight = np.polynomial.legendre.leggauss(4)
    r = 0.5 * radius * (1.0 + node)
    angle = 2.0 * np.pi * np.arange(8) / 8
    # Trapezoid and Gauss points are exact for these polynomials.
    squared = (distance + r[:, None] * np.cos(angle)) ** 2 + (r[:, None] * np.sin(angle)) ** 2
    return float(np.sum(0.5 * radius * weight * r * squared.mean(axis=1)) * 2.0 * np.pi)


def _upright_angle() -> Case:
    """DR18, eq. 22 for the upright axis, its integral over the angle taken of 1 as it stands."""
    density, constant = 998.2, -0.8 * _SPEED**2 / (2.0 * GRAVITY) * _CHAMBER.radius**2
    node, weight = np.polynomial.legendre.leggauss(8)
    low, high = np.sqrt(
        np.minimum(
            2.0 * GRAVITY / _SPEED**2 * np.array([-constant, _CHAMBER.height - constant]), _CHAMBER.radius**2
        )
    )
    r = 0.5 * (low + high) + 0.5 * (high - low) * node
    bracket = _SPEED**2 / GRAVITY**2 * (0.5 * _SPEED**2 * r**2 + GRAVITY * constant) + 1.0
    printed = (
        density * GRAVITY * 2.0 * math.pi * float(np.sum(0.5 * (high - low) * weight * bracket**2 * r**3))
    )
    return CLAIMS.case(
        "dr-eq-22",
        float(free_surface_term(_CHAMBER, 0.0, constant, _SPEED, GRAVITY, density)),
        printed=printed,
    )


def _oblate() -> Case:
    """Largest height over radius of a solid cylinder whose axis has the larger moment of inertia."""
    import sympy as sp

    height, r, phi, z = sp.symbols("height r phi z", positive=True)
    difference = sp.integrate(
        ((r * sp.cos(phi)) ** 2 - z**2) * r, (r, 0, 1), (phi, 0, 2 * sp.pi), (z, -height / 2, height / 2)
    )
    (limit,) = (root for root in sp.solve(difference, height) if root.is_positive)
    return CLAIMS.case("dr-oblate", float(limit), limit >= 10)


def _artificial_unbalance() -> Iterator[Case]:
    """DG21, section 4: amplitude of a body on springs far above resonance, and the largest at any speed."""
    tub, drum, eccentricity = 48.2, 12.5, 14.8e-3
    springs, dampers = (
        2 * 6.0e3 * math.sin(math.radians(75.0)) ** 2,
        2 * 175.0 * math.sin(math.radians(70.0)) ** 2,
    )
    mass, unbalance = tub + drum, 1800e-6
    speed = np.geomspace(0.1, 1e4, 4001)
    response = speed**2 / np.abs(springs - mass * speed**2 + 1j * dampers * speed)
    far = float(response[-1])
    note = (
        f"m_2 e = {drum * eccentricity * 1e6:.0f} g mm of the same paper gives "
        f"{drum * eccentricity * far * 1e3:.2f} mm far above resonance"
    )
    for key, meaning, factor in (
        ("far", "far above resonance", far),
        ("peak", "at the worst speed", float(response.max())),
    ):
        yield CLAIMS.case("dg-section-4", unbalance * factor, key=key, meaning=meaning, note=note)


def _kinetic_energy() -> Case:
    """FF20, eq. 10: coefficient of y eta_G in the energy of translation over M omega^2/2."""
    import sympy as sp

    x, y, xi, eta = sp.symbols("x y xi eta")
    energy = sp.Poly((x + xi) ** 2 + (y + eta) ** 2, x, y, xi, eta)
    printed = sp.Poly(x**2 + y**2 + 2 * (x * xi + 2 * y * eta) + xi**2 + eta**2, x, y, xi, eta)
    return CLAIMS.case(
        "ff-eq-10", float(energy.coeff_monomial(y * eta)), printed=float(printed.coeff_monomial(y * eta))
    )
