"""A uniform section against the matrix exponential, energy and textbook stiffness."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

from meshes.errors import InputError
from solvers.rotor.shaft.section import (
    SHORT,
    Section,
    round_section,
    shear_coefficient,
    stiffness_matrices,
    transfer_matrices,
)
from tests.mutants import kills

SECTIONS = st.builds(
    Section,
    length=st.floats(0.005, 2.0),
    bending_stiffness=st.floats(1.0, 1e7),
    mass=st.floats(0.01, 300.0),
    rotary_inertia=st.floats(0.0, 0.1),
    shear_flexibility=st.one_of(st.just(0.0), st.floats(1e-12, 1e-6)),
    polar_inertia=st.floats(0.0, 0.2),
)


def by_exponential(section: Section, frequency: float, spin: float) -> np.ndarray:
    """exp(A l) of equation 1 in units of the section, by scipy."""
    bending, length = section.bending_stiffness, section.length
    turning = section.rotary_inertia * frequency**2 - section.polar_inertia * spin * frequency
    change = np.zeros((4, 4))
    change[0, 1], change[0, 3] = 1.0, section.shear_flexibility * bending / length**2
    change[1, 2], change[2, 3] = 1.0, -1.0
    change[2, 1] = -turning * length**2 / bending
    change[3, 0] = -section.mass * frequency**2 * length**4 / bending
    return np.asarray(expm(change))


_AT = "solvers.rotor.shaft.section"


@settings(max_examples=60)
@given(section=SECTIONS, share=st.floats(1e-7, 3.0), spin=st.floats(-2000.0, 2000.0))
def test_against_the_matrix_exponential(section: Section, share: float, spin: float) -> None:
    check_transfer(section, share, spin)


@kills(f"{_AT}:transfer_matrices", "change[..., 2, 3] = sheared, -1.0", "change[..., 2, 3] = sheared, 1.0")
@kills(f"{_AT}:transfer_matrices", "0.25 * np.square(sheared", "0.5 * np.square(sheared")
@kills(f"{_AT}:Section.turning_inertia", "np.square(frequency) - self", "np.square(frequency) + self")
@kills(f"{_AT}:_slope", "power = power * y", "power = power * x")
@kills(f"{_AT}:_slope", "math.factorial(2 * k + odd)", "math.factorial(2 * k)")
def test_one_section_against_the_matrix_exponential() -> None:
    thick = Section(0.3, 2e4, 6.0, 4e-4, 1e-8, 8e-4)
    for share in (1e-3, 0.5, 1.5, 3.0):
        check_transfer(thick, share, 500.0)


def check_transfer(section: Section, share: float, spin: float) -> None:
    # A frequency at which the bending wave number times the length is the share.
    frequency = share**2 / section.length**2 * math.sqrt(section.bending_stiffness / section.mass)
    found = transfer_matrices(section, section.length, np.array([frequency]), spin)[0]
    bending, length = section.bending_stiffness, section.length
    scale = np.array([length, 1.0, bending / length, bending / length**2])
    exact = by_exponential(section, frequency, spin)
    # Both sum numbers of the size of the largest entry of A^2 and of exp(A); squaring A doubles its rounding.
    change = abs(frequency) * (abs(section.polar_inertia * spin) + section.rotary_inertia * frequency)
    size = np.abs(exact).max() * max(1.0, change * length**2 / bending) ** 2
    size *= max(1.0, section.shear_flexibility * bending / length**2)
    assert np.abs(found / scale[:, None] * scale - exact).max() <= 1e-12 * size


@kills(
    f"{_AT}:stiffness_matrices",
    "np.concatenate([-left, right], axis=-2)",
    "np.concatenate([left, right], -2)",
)
def test_static_stiffness_is_that_of_textbooks() -> None:
    section = round_section(0.3, 0.03, 0.01)
    bending, length = section.bending_stiffness, section.length
    phi = 12.0 * bending * section.shear_flexibility / length**2
    first, second = (4.0 + phi) * length**2, (2.0 - phi) * length**2
    exact = np.array(
        [
            [12.0, 6.0 * length, -12.0, 6.0 * length],
            [6.0 * length, first, -6.0 * length, second],
            [-12.0, -6.0 * length, 12.0, -6.0 * length],
            [6.0 * length, second, -6.0 * length, first],
        ]
    )
    exact *= bending / length**3 / (1.0 + phi)
    found = stiffness_matrices(transfer_matrices(section, length, np.zeros(1)))[0]
    # At rest A^4 = 0, the series is exact; what remains are the roundings of one inverse of condition 30.
    assert np.abs(found - exact).max() <= 1e-13 * np.abs(exact).max()


@given(section=SECTIONS, frequency=st.floats(1.0, 1e5), spin=st.floats(-500.0, 500.0))
def test_pieces_are_short(section: Section, frequency: float, spin: float) -> None:
    """No wave of a lower frequency is shorter than the bound on which the pieces rest."""
    try:
        count = section.pieces(frequency, spin)
    except InputError:
        turning = section.rotary_inertia * frequency**2 + section.polar_inertia * abs(spin) * frequency
        assert turning * section.shear_flexibility >= 1.0
        return
    omega = np.linspace(1e-3, 1.0, 50) * frequency
    turning = section.turning_inertia(omega, spin) / section.bending_stiffness
    sheared = section.shear_flexibility * section.mass * omega**2
    root = np.sqrt(0.25 * (sheared - turning) ** 2 + section.mass * omega**2 / section.bending_stiffness)
    wave = np.sqrt(0.5 * (sheared + turning) + root).max()
    assert wave * section.length / count <= SHORT * (1.0 + 1e-12)


def test_shear_coefficient_of_solid_and_thin() -> None:
    # Cowper: 6 (1 + nu)/(7 + 6 nu) of a full circle, 2 (1 + nu)/(4 + 3 nu) of a thin ring.
    assert shear_coefficient(0.0, 0.3) == pytest.approx(7.8 / 8.8, rel=1e-14)
    assert shear_coefficient(1.0 - 1e-9, 0.3) == pytest.approx(2.6 / 4.9, rel=1e-8)


@pytest.mark.parametrize(
    "wrong",
    [
        {"length": 0.0},
        {"diameter": -1.0},
        {"bore": 0.02},
        {"density": math.nan},
        {"poisson_ratio": 0.5},
        {"theory": "best"},
    ],
)
def test_bad_sections(wrong: dict[str, object]) -> None:
    with pytest.raises(InputError):
        round_section(**({"length": 0.1, "diameter": 0.02} | wrong))  # type: ignore[arg-type]
