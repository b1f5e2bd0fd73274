"""Cage of a rolling bearing, from the velocities of its parts."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from meshes.errors import InputError
from solvers.rotor.system import cage_speed
from tests.mutants import kills


@kills(
    "solvers.rotor.system:cage_speed",
    "1.0 - ball * np.cos(angle) / pitch",
    "1.0 + ball * np.cos(angle) / pitch",
)
@kills(
    "solvers.rotor.system:cage_speed",
    "1.0 - ball * np.cos(angle) / pitch",
    "1.0 - ball * np.sin(angle) / pitch",
)
def test_rolling() -> None:
    """A ball that rolls on both tracks: its points of contact move with the rings."""
    shaft, pitch, ball, angle = 2 * math.pi * 20.0, 28.5e-3, 6.75e-3, 0.3
    inner = 0.5 * (pitch - ball * math.cos(angle))
    outer = 0.5 * (pitch + ball * math.cos(angle))
    cage = float(cage_speed(shaft, pitch, ball, angle))
    # Spin of the ball about its own axis from the outer contact, which stands still; then the inner one.
    spin = cage * outer / (0.5 * ball)
    assert cage * inner + spin * 0.5 * ball == pytest.approx(shaft * inner, rel=1e-14)


@given(ratio=st.floats(0.0, 0.99), angle=st.floats(0.0, 1.5), speed=st.floats(-1e4, 1e4))
def test_between_none_and_half(ratio: float, angle: float, speed: float) -> None:
    found = float(cage_speed(speed, 1.0, ratio, angle))
    assert 0.0 <= abs(found) <= 0.5 * abs(speed)


def test_the_special_case_of_the_source_needs_small_balls() -> None:
    # [DR18, eq. 10]: n_s/2 for a contact angle of 0.
    assert float(cage_speed(1000.0, 1.0, 0.0)) == 500.0
    assert float(cage_speed(1000.0, 28.5, 6.75)) == pytest.approx(381.579, rel=1e-5)


@pytest.mark.parametrize("wrong", [(1.0, 0.0, 0.0), (1.0, 1.0, 1.0), (1.0, 1.0, -0.1), (1.0, 1.0, 0.1, 2.0)])
def test_bad_bearing(wrong: tuple[float, ...]) -> None:
    with pytest.raises(InputError):
        cage_speed(*wrong)
