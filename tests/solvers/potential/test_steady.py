"""Exact steady waves: closed forms, small waves, and figures of two other codes for the same equations."""

from __future__ import annotations

import math

import numpy as np
import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as some

from fluid import waves
from meshes.errors import InputError
from solvers.potential.steady import (
    SteadyWave,
    _equations,
    at_rest,
    follow,
    forced,
    free,
    linear_detuning,
    on_nodes,
    solve,
)
from solvers.potential.strip import nodes
from tests.mutants import kills
from validation.study import data


def detuning(whirl_ratio: float) -> float:
    return (1.0 - 1.0 / whirl_ratio) ** 2


# --- the equations ---


def test_bernoulli_in_the_frame_of_the_wave() -> None:
    """Seen from the wave all that has Omega and s apart makes (Omega + s)^2, by computer algebra."""
    x, y, spin, s, ux, uy, whole = sympy.symbols("x y Omega s u v Q", real=True)
    square = x**2 + y**2
    # Velocity in the drum from the one seen from the wave, which turns at s; psi + s r^2/2 = Q.
    wx, wy = ux - s * y, uy + s * x
    psi = whole - s * square / 2
    phi_t = -s * (wy * x - wx * y)
    drum = phi_t + (wx**2 + wy**2) / 2 + 2 * spin * psi - spin**2 * square / 2
    wave = (ux**2 + uy**2) / 2 - (spin + s) ** 2 * square / 2 + 2 * spin * whole
    assert sympy.simplify(drum - wave) == 0
    # Sign of the Coriolis term: e_z x grad(phi) = grad(psi) for W = phi + i psi.
    potential = sympy.expand((x + sympy.I * y) ** 3)
    phi, stream = sympy.re(potential), sympy.im(potential)
    assert sympy.simplify(-sympy.diff(phi, y) - sympy.diff(stream, x)) == 0
    assert sympy.simplify(sympy.diff(phi, x) - sympy.diff(stream, y)) == 0


@kills(
    "solvers.potential.steady:_equations",
    "d_square = np.diag(-2.0 * square)",
    "d_square = np.diag(2.0 * square)",
)
@kills("solvers.potential.steady:_equations", "np.diag(2.0 * kinetic)", "np.diag(kinetic)")
@kills("solvers.potential.steady:_equations", "np.diag(square + whirl", "np.diag(square - whirl")
@kills("solvers.potential.steady:_equations", "at.mean * 2.0 * square * opened", "at.mean * square * opened")
@kills("solvers.potential.steady:_linear", "operator + np.outer(slope @ y, mean)", "operator")
@pytest.mark.parametrize(("crests", "cluster"), [(1, 1.0), (1, 0.5), (3, 0.6)])
def test_jacobian(crests: int, cluster: float) -> None:
    """By central differences of 1e-6, whose error is 1e-12 of third derivatives and 1e-10 of rounding."""
    at, wanted = nodes(16, crests, cluster), {"crest": 1.1, "height": 0.2}
    surface = 0.223 + 0.02 * np.cos(crests * at.u) + 0.003 * np.cos(2 * crests * at.u)
    state = np.concatenate((surface, [0.3, 0.1, 0.01]))
    jacobian = _equations(at, 0.2, state, wanted)[1]
    for k, bump in enumerate(1e-6 * np.eye(state.size)):
        ahead, behind = (_equations(at, 0.2, state + way * bump, wanted)[0] for way in (1.0, -1.0))
        np.testing.assert_allclose(jacobian[:, k], (ahead - behind) / 2e-6, atol=2e-8)


# --- closed forms ---


@kills("solvers.potential.steady:SteadyWave.force_ratio", "1.0 + self.centre", "1.0 - self.centre")
@pytest.mark.parametrize("whirl", [0.5, 0.9, 0.99])
def test_synchronous_whirl_is_a_circle(whirl: float) -> None:
    """About the axis of spin, so that the liquid pulls as a full chamber does; at last nearly dry."""
    wave = forced(0.1, 0.0, 0.1 * whirl)
    # At 0.99 the spectrum ends at 1e-8, and its square is what the force lacks.
    assert wave.converged and wave.force_ratio == pytest.approx(1.0, abs=1e-13 if whirl < 0.95 else 1e-10)
    place = np.exp(-wave.surface + 1j * wave.angle)
    assert np.abs(np.abs(place + 0.1 * whirl) - 0.9).max() < (1e-13 if whirl < 0.95 else 1e-9)
    assert (wave.crest, wave.trough) == pytest.approx((1.0 + whirl, 1.0 - whirl), abs=1e-10)


@kills("solvers.potential.steady:linear_detuning", "share / (crests + share)", "share / (1.0 + share)")
@settings(max_examples=60, deadline=None)
@given(layer=some.floats(0.02, 0.9), crests=some.integers(1, 6))
def test_small_free_waves_are_those_of_the_linear_theory(layer: float, crests: int) -> None:
    flat = at_rest(layer, nodes(16, crests))
    wave = SteadyWave(flat.at, flat.surface, linear_detuning(layer, crests), 0.0, layer, 0.0, True)
    ahead, behind = waves.free_wave_speeds(crests, -math.log1p(-layer), 1.0)
    assert wave.slip_speeds() == pytest.approx((float(ahead), float(behind)), rel=1e-9)


@settings(max_examples=40, deadline=None)
@given(layer=some.floats(0.05, 0.8), ratio=some.one_of(some.floats(0.55, 0.95), some.floats(1.1, 3.0)))
def test_a_small_whirl_pulls_as_the_linear_theory_says(layer: float, ratio: float) -> None:
    """The rest goes with the square of the whirl, and near the free wave with its distance as well."""
    near = abs(detuning(ratio) / linear_detuning(layer) - 1.0)
    if near < 0.1:
        return
    whirl = 1e-5 * layer * near**2
    wave = forced(layer, detuning(ratio), whirl)
    linear = float(waves.force_ratio((1.0 - layer) ** -2, ratio))
    # Rounding of the centre of mass over the whirl: 1e-16/1e-8.
    assert wave.converged and wave.force_ratio == pytest.approx(linear, rel=1e-5, abs=1e-5)


def test_where_the_liquid_does_not_pull() -> None:
    """At p^2 = 1/2 small waves pull nothing, at every depth."""
    for layer in (0.1, 0.3, 0.5):
        # What is left goes with the whirl's square; the centre of mass is known to 1e-16 of it.
        assert abs(forced(layer, 0.5, 1e-5 * layer).force_ratio) < 1e-8


# --- figures of other codes ---

# Of the same equations by two codes that share nothing with this one, one in u and one in clustered nodes.
# The whole tables are held by tests/validation/test_exact_wave.py; here are those that a mutant changes.
TABLE = data("exact_wave.json")


@kills("solvers.potential.steady:_equations", "speed = 0.5 * by_strip", "speed = 0.4 * by_strip")
@kills("solvers.potential.steady:forced", "else -1.0", "else 1.0")
def test_forced() -> None:
    for row in TABLE["forced"]:
        layer = row["depth"]
        wave = forced(layer, detuning(row["whirl_speed"]), row["whirl"] * layer)
        assert wave.converged and wave.single
        # The last of twelve digits is not sure with 64 nodes.
        assert wave.force_ratio == pytest.approx(float(row["force"]), abs=2e-12)
        heights = float(row["crest"]), float(row["trough"])
        assert (wave.crest, wave.trough) == pytest.approx(heights, abs=1e-10)


FREE = (
    ("0.05", "1.02"),
    ("0.05", "1.30"),
    ("0.1", "1.10"),
    ("0.1", "1.60"),
    ("0.3", "1.35"),
    ("0.5", "1.20"),
)


@kills("solvers.potential.steady:refined", "wave.tail > RESOLVED", "wave.tail > 1e-2")
@kills("solvers.potential.steady:free", "0.2 * layer * layer", "0.01")
def test_free() -> None:
    """Also in a thin layer, where waves of many crests are close by, and near the highest wave."""
    for depth, height in FREE:
        layer, crest, speed = float(depth), float(height), float(TABLE["free"][depth][height])
        wave = free(layer, crest)
        assert wave.converged and wave.single and wave.crest == pytest.approx(crest, rel=1e-12)
        ahead, behind = wave.slip_speeds()
        assert behind == pytest.approx(speed, abs=3e-12)
        assert 1.0 / ahead + 1.0 / behind == pytest.approx(-2.0, rel=1e-12)


# h_0/R, crest over h_0 and backward speed near the highest waves, to the digits that are known; and crests on
# either side of the greatest speed.
NEARLY = (
    (0.05, 1.60, -0.21271, 1.5, 1.6),
    (0.1, 1.609, -0.26938, 1.604, 1.613),
    (0.3, 1.378, -0.356305, 1.376, 1.387),
    (0.5, 1.236, -0.39207, 1.230, 1.236),
)


@pytest.mark.parametrize(("layer", "crest", "speed", "below", "above"), NEARLY)
def test_the_highest_wave_is_not_the_fastest(
    layer: float, crest: float, speed: float, below: float, above: float
) -> None:
    """The speed is greatest a little below the highest wave; in the thinnest layer that is further up."""
    assert free(layer, crest).slip_speeds()[1] == pytest.approx(speed, abs=6e-6)
    three = [abs(free(layer, one).slip_speeds()[1]) for one in (below, 0.5 * (below + above), above)]
    assert three[1] > three[0] and (layer < 0.1 or three[1] > three[2])


@kills("solvers.potential.steady:SteadyWave.single", "_RIPPLE", "9.0")
def test_ripples_are_another_branch() -> None:
    """A wave with shorter ones on it is known as such."""
    wave = free(0.1, 1.1)
    rippled = wave.surface + 1e-3 * wave.layer * np.cos(9.0 * wave.at.u)
    assert wave.single
    assert not SteadyWave(wave.at, rippled, wave.detuning, 0.0, wave.layer, math.nan, False).single


def test_the_nodes_decide_the_digits() -> None:
    """A crest near the highest: even nodes lack what crowded ones have, and the spectrum says so."""
    wanted, wave = {"whirl": 0.0, "crest": 1.35}, free(0.3, 1.35)
    even, crowded = (solve(on_nodes(wave, nodes(96, 1, value)), wanted) for value in (1.0, 0.15))
    assert even.tail > 1e-2 and crowded.tail < 1e-5
    errors = [abs(one.slip_speeds()[1] + 0.355520689950) for one in (even, crowded)]
    assert errors[0] > 1e-6 > 1e-9 > errors[1]
    # The liquid at the crest nearly keeps up with the wave.
    assert 0.0 < wave.crest_speed < 0.5 < free(0.3, 1.1).crest_speed < 1.0


@pytest.mark.parametrize("crests", [2, 3, 5])
def test_more_crests(crests: int) -> None:
    """n crests: the drum's section of one of them, whose wave grows faster with its height."""
    wave, lower = (free(0.2, crest, crests) for crest in (1.1, 1.05))
    first = linear_detuning(0.2, crests)
    assert wave.converged and wave.single and wave.centre == 0.0
    # The gain goes with the square of the height.
    gain = (wave.detuning - first) / (lower.detuning - first)
    assert 2.0 < gain < 4.5


FOLDS = ((0.1, 1.05, 0.002810558), (0.1, 1.1, 0.010372250), (0.3, 1.1, 0.015564431), (0.3, 1.3, 0.107335961))


@pytest.mark.parametrize(("layer", "apart", "largest"), FOLDS)
def test_a_whirl_that_grows_holds_no_wave_beyond_the_fold(layer: float, apart: float, largest: float) -> None:
    """By the height of the wave the branch goes on past the largest whirl, which the whirl alone cannot."""
    square = apart**2 * linear_detuning(layer)
    wave = forced(layer, square, 0.02 * largest * layer)
    heights, found = np.linspace(wave.crest - wave.trough, 0.6, 120), []
    for height in heights:
        wave = follow(wave, {"detuning": square, "height": height}, 1)
        found.append(-wave.whirl / layer)
        assert wave.converged and wave.single
        if found[-1] < 0.8 * max(found):
            break
    top = int(np.argmax(found))
    assert 0 < top < len(found) - 1
    # The top of a parabola through three heights.
    bend = np.polyfit(heights[top - 1 : top + 2], found[top - 1 : top + 2], 2)
    assert bend[2] - bend[1] ** 2 / (4.0 * bend[0]) == pytest.approx(largest, rel=2e-5)
    failed = forced(layer, square, 1.02 * largest * layer)
    assert not failed.converged and -failed.whirl / layer < 1.001 * largest


# --- extremes, bad input ---


def test_nearly_full_drums() -> None:
    wave = forced(0.9, detuning(0.7), 0.005)
    assert wave.converged and wave.crest - wave.trough > 0.01 and abs(wave.force_ratio) > 1.0


def test_beyond_the_highest_wave_it_says_so() -> None:
    wave = free(0.5, 1.3)
    assert not wave.converged and np.isfinite(wave.surface).all() and wave.crest < 1.2387 + 2e-4


def test_a_dry_wall_is_outside() -> None:
    assert not forced(0.1, 0.0, 0.11).converged


@pytest.mark.parametrize(
    ("field", "call"),
    [
        ("wanted", lambda: solve(at_rest(0.1, nodes(16)), {"whirl": 0.0})),
        ("wanted", lambda: solve(at_rest(0.1, nodes(16)), {"whirl": 0.0, "speed": 1.0})),
        ("wanted", lambda: follow(at_rest(0.1, nodes(16)), {"whirl": math.nan, "crest": 1.1}, 4)),
        ("layer", lambda: forced(1.0, 0.1, 0.01)),
        ("detuning", lambda: forced(0.1, -0.1, 0.01)),
        ("whirl", lambda: forced(0.1, 0.1, 0.0)),
        ("whirl", lambda: free(0.1, 1.1).force_ratio),
        ("crest", lambda: free(0.1, 1.0)),
    ],
)
def test_bad_input(field: str, call: object) -> None:
    with pytest.raises(InputError, match=field):
        call()  # type: ignore[operator]
