"""Frequencies of a rolling bearing from the velocities of its parts, and back from frequencies to it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from meshes.errors import InputError
from solvers.rotor.rolling_bearing import (
    Bearing,
    cage_slip,
    fit_bearing,
    rating_life,
    skidding_slip,
    sliding_speed,
    worn_volume,
)
from solvers.rotor.system import cage_speed
from tests.mutants import kills

_AT = "solvers.rotor.rolling_bearing"


@kills(f"{_AT}:Bearing.orders", "self.balls * (1.0 - cage)", "self.balls * (1.0 + cage)")
@kills(
    f"{_AT}:Bearing.orders",
    "0.5 * (1.0 - (ratio * cosine) ** 2) / ratio",
    "(1.0 - (ratio * cosine) ** 2) / ratio",
)
@given(balls=st.integers(3, 40), ratio=st.floats(0.01, 0.9), angle=st.floats(0.0, 1.5))
def test_rolling_without_slip(balls: int, ratio: float, angle: float) -> None:
    """Velocities at both contacts: the outer one stands still, the inner one moves with the shaft."""
    found = Bearing(balls, ratio, angle).orders()
    cage, spin = found["ftf"], found["bsf"]
    inner, outer = (0.5 * (1.0 + sign * ratio * math.cos(angle)) for sign in (-1.0, 1.0))
    # Seen from the cage the rings turn by -cage and 1 - cage, and the ball with the spin about its own axis.
    assert spin * 0.5 * ratio == pytest.approx(cage * outer, rel=1e-12)
    assert spin * 0.5 * ratio == pytest.approx((1.0 - cage) * inner, rel=1e-9)
    # In one turn of the shaft all balls pass the outer ring cage times, the inner ring 1 - cage times.
    assert found["bpfo"] + found["bpfi"] == pytest.approx(balls, rel=1e-12)
    assert found["bpfo"] == pytest.approx(balls * cage, rel=1e-12)


@kills(f"{_AT}:_orders", "spin = 0.5 * cosine / ratio", "spin = 0.5 / ratio")
@kills(f"{_AT}:_orders", "balls * (1.0 - cage)", "balls * (1.0 + cage)")
def test_one_bearing_there_and_back() -> None:
    check_there_and_back(9, 0.25, 0.7)


@settings(max_examples=15, deadline=None)
@given(balls=st.integers(4, 30), ratio=st.floats(0.1, 0.4), angle=st.floats(0.05, 1.0))
def test_any_bearing_there_and_back(balls: int, ratio: float, angle: float) -> None:
    check_there_and_back(balls, ratio, angle)


def check_there_and_back(balls: int, ratio: float, angle: float) -> None:
    """Four exact frequencies have one bearing."""
    found = fit_bearing(Bearing(balls, ratio, angle).orders())
    assert found.bearing.balls == balls
    assert found.bearing.diameter_ratio == pytest.approx(ratio, rel=1e-5)
    assert found.bearing.contact_angle == pytest.approx(angle, abs=1e-4)
    assert found.residual_rms < 1e-6 < found.next_rms


def test_standard_error_is_that_of_the_noise() -> None:
    """With one relative error of e in FTF of three, the error told is of the size of e times dg/g."""
    orders = Bearing(9, 0.25).orders()
    exact = {name: orders[name] for name in ("ftf", "bpfo", "bpfi")}
    errors = []
    for noise in (1e-4, 1e-3):
        found = fit_bearing(exact | {"ftf": orders["ftf"] * (1.0 + noise)}, 9, 0.0)
        errors.append(found.projected_ratio_std)
        off = abs(found.projected_ratio - 0.25)
        assert 0.1 * off < found.projected_ratio_std < 10.0 * off
    assert errors[1] == pytest.approx(10.0 * errors[0], rel=0.01)  # linear in the noise


def test_slip() -> None:
    """[DR18, eq. 9-10]: the special case takes a rolling cage for one that slips."""
    rolling = Bearing(8, 6.75 / 28.5).orders()["ftf"]
    assert cage_slip(rolling, rolling) == 0.0
    assert cage_slip(0.0, rolling) == 1.0
    assert cage_slip(rolling, 0.5) == pytest.approx(6.75 / 28.5, rel=1e-12)


def test_what_cannot_be_told() -> None:
    with pytest.raises(InputError, match="bsf"):
        fit_bearing({"ftf": 0.4, "bpfo": 3.0})
    with pytest.raises(InputError, match="bpfi"):
        fit_bearing({"ftf": 0.4, "bsf": 2.0})
    with pytest.raises(InputError, match="2 frequencies"):
        fit_bearing({"bpfo": 3.0}, contact_angle=0.0)
    with pytest.raises(InputError, match="one of"):
        fit_bearing({"btf": 3.0})
    with pytest.raises(InputError, match="ftf"):
        fit_bearing({"ftf": -1.0, "bsf": 2.0}, 9)
    for wrong in ((0, 0.2, 0.0), (9, 1.0, 0.0), (9, 0.2, 1.6)):
        with pytest.raises(InputError):
            Bearing(*wrong)
    with pytest.raises(InputError):
        cage_slip(math.nan, 1.0)


@kills(f"{_AT}:rating_life", "** 3", "** 2")
@kills(f"{_AT}:rating_life", "2.0 * np.pi * 1e6", "1e6")
@kills(f"{_AT}:rating_life", "np.divide(c, p", "np.divide(p, c")
def test_rating_life() -> None:
    """A million turns under the rating itself; ten times less load at 1000 rpm: 1e9 turns, 16 667 h."""
    turn = 2.0 * math.pi
    assert float(rating_life(9560.0, 9560.0, turn)) == pytest.approx(1e6, rel=1e-12)
    hours = float(rating_life(9560.0, 956.0, 1000.0 * turn / 60.0)) / 3600.0
    assert hours == pytest.approx(1e9 / (1000.0 * 60.0), rel=1e-12)
    assert math.isinf(rating_life(9560.0, 0.0, 10.0))


@kills(
    f"{_AT}:skidding_slip",
    "1.0 - np.asarray(load) / np.asarray(least)",
    "np.asarray(load) / np.asarray(least)",
)
@kills(f"{_AT}:skidding_slip", "np.asarray(load) / np.asarray(least)", "np.asarray(least) / np.asarray(load)")
@given(load=st.floats(0.0, 1e4), least=st.floats(1.0, 1e3))
def test_skidding_balances_traction_and_drag(load: float, least: float) -> None:
    """The cage turns so fast that its drag, in proportion to its speed, is what the load can drive."""
    slip = float(skidding_slip(load, least))
    assert 0.0 <= slip <= 1.0
    if load >= least:
        assert slip == 0.0
    else:
        assert least * (1.0 - slip) == pytest.approx(load, rel=1e-12, abs=1e-12 * least)
        assert float(skidding_slip(0.5 * load, least)) >= slip


@kills(f"{_AT}:sliding_speed", "pitch - ball", "pitch + ball")
@kills(f"{_AT}:sliding_speed", "0.5 * (pitch", "(pitch")
@given(slip=st.floats(0.0, 1.0), ratio=st.floats(0.05, 0.6), angle=st.floats(0.0, 1.2))
def test_sliding_by_the_velocities(slip: float, ratio: float, angle: float) -> None:
    """A ball rolls on the outer ring at rest, its centre with the late cage: what the inner ring has more."""
    speed, pitch = 100.0, 0.0285
    ball = ratio * pitch
    cage = (1.0 - slip) * float(cage_speed(speed, pitch, ball, angle))
    # The point of the ball on the outer ring stands still, the one on the inner ring moves twice the centre,
    # of which both are as far off.
    at_centre, track = cage * 0.5 * pitch, 0.5 * (pitch - ball * math.cos(angle))
    found = float(sliding_speed(speed, slip, ball, pitch, angle))
    assert found == pytest.approx(speed * track - 2.0 * at_centre, rel=1e-9, abs=1e-12)


@kills(
    f"{_AT}:worn_volume", "np.asarray(load) * np.asarray(distance)", "np.asarray(load) + np.asarray(distance)"
)
def test_wear_of_the_printed_bush() -> None:
    """5.1e-7 mm^3 for a newton and a metre: 100 N over 10 km wear 0.51 mm^3."""
    worn = worn_volume(5.1e-7 * 1e-9, np.array([100.0, 0.0]), 1e4)
    np.testing.assert_allclose(worn, [0.51e-9, 0.0], rtol=1e-12)
