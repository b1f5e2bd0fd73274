"""The exact wave as a liquid model: what is known of it, and what it says where there is none."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as some

from fluid import waves
from fluid.fill import Fill, Fills
from fluid.liquid import known_liquid
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.liquid_model import LiquidWave, Whirl, Whirls
from solvers.potential import steady
from solvers.potential.model import Potential, PotentialWave
from solvers.potential.steady import Branch, SteadyWave, linear_detuning, on_nodes, solve
from solvers.potential.strip import nodes
from solvers.potential.unsteady import invariants, started
from solvers.synchronous.models import LINEAR, STATICS
from tests.mutants import kills
from validation.study import data

MODEL = Potential()


def filled(layer: float, radius: float = 0.1, height: float = 0.02) -> Fill:
    volume = math.pi * radius**2 * layer * (2.0 - layer) * height
    return Fill(Chamber(radius, height), known_liquid("water"), volume)


def ratio(fill: Fill, whirl: Whirl, wave: LiquidWave) -> complex:
    return complex(wave.answer.unbalance[0]) / (fill.full_mass * whirl.amplitude)


def asked(layer: float, speed: float, share: float, radius: float = 0.1, spin: float = 40.0) -> PotentialWave:
    fill = filled(layer, radius)
    return MODEL.wave(fill, Whirl(spin, speed * spin, share * fill.depth))


TABLE = data("exact_wave.json")  # by two codes that share nothing with this one


@kills("solvers.potential.model:Potential.wave", "finer.centre * radius", "finer.centre")
@kills("solvers.potential.model:_profile", "math.pi if wave.whirl < 0.0 else 0.0", "0.0")
@pytest.mark.parametrize(("radius", "spin"), [(0.1, 40.0), (0.3, 120.0)])
def test_forced(radius: float, spin: float) -> None:
    for row in TABLE["forced"]:
        layer, speed, share = row["depth"], row["whirl_speed"], row["whirl"]
        force, crest, trough = (float(row[key]) for key in ("force", "crest", "trough"))
        fill = filled(layer, radius)
        whirl = Whirl(spin, speed * spin, share * fill.depth)
        wave = MODEL.wave(fill, whirl)
        # The last of twelve digits is not sure; the depth of the fill is known to 1e-15 of its own.
        assert ratio(fill, whirl, wave) == pytest.approx(force, abs=3e-12)
        assert wave.numbers["crest"] == pytest.approx(crest, abs=1e-10)
        assert wave.numbers["trough"] == pytest.approx(trough, abs=1e-10)
        assert wave.answer.converged[0] and wave.branch == Branch.ONE_CREST and wave.mass_error < 1e-12
        assert wave.answer.error[0] < 1e-10
        # The liquid's momentum: its mass times the acceleration of its centre of mass.
        momentum = fill.mass * (whirl.amplitude + complex(wave.answer.offset[0]))
        assert complex(wave.answer.unbalance[0]) == pytest.approx(momentum, rel=1e-11)
        # The surface that is drawn has that centre; the trapezium on its own angles is of second order.
        surface, theta = radius - wave.depth, wave.theta
        around = np.append(theta, theta[0] + 2.0 * math.pi)
        moment = np.append(surface, surface[0])
        moment = (radius**3 - moment**3) / 3.0 * np.cos(around)
        area = fill.volume / fill.chamber.height
        centre = float(np.trapezoid(moment, around)) / area
        assert centre == pytest.approx(wave.answer.offset[0].real, rel=1e-3)


@settings(max_examples=12, deadline=None)
@given(
    layer=some.floats(0.1, 0.7),
    speed=some.one_of(some.floats(0.75, 0.95), some.floats(-3.0, -0.5)),
    share=some.floats(0.001, 0.02),
)
def test_twins(layer: float, speed: float, share: float) -> None:
    """Whirls of one p^2 have one answer: 1/omega_1 + 1/omega_2 = 2/Omega."""
    twin = 1.0 / (2.0 - 1.0 / speed)
    pair = [asked(layer, each, share) for each in (speed, twin)]
    assert pair[0].answer.converged[0] == pair[1].answer.converged[0]
    if pair[0].answer.converged[0]:
        one, two = (wave.answer.unbalance[0] for wave in pair)
        assert one == pytest.approx(two, rel=1e-10, abs=1e-10 * abs(filled(layer).full_mass * share))
        np.testing.assert_allclose(pair[0].depth, pair[1].depth, rtol=1e-10)


def test_synchronous_whirl_is_the_circle_of_the_statics() -> None:
    """One by one and as arrays, and by Newton's method on nodes beside it."""
    fill = filled(0.1)
    for share in (0.02, 0.5, 0.95):
        whirl = Whirl(40.0, 40.0, share * fill.depth)
        wave, circle = MODEL.wave(fill, whirl), STATICS.wave(fill, whirl)
        assert ratio(fill, whirl, wave) == pytest.approx(1.0, abs=1e-13)
        np.testing.assert_allclose(wave.depth, circle.depth, atol=1e-13 * fill.chamber.radius)
        assert wave.answer.offset[0] == pytest.approx(circle.answer.offset[0], rel=1e-12)
        # So near to it that p^2 of 1e-14 changes nothing.
        near = MODEL.wave(fill, Whirl(40.0, 40.0 * (1.0 + 1e-7), share * fill.depth))
        assert ratio(fill, whirl, near) == pytest.approx(1.0, abs=1e-10)
    fills = Fills.of([fill] * 3)
    size = fill.depth * np.array([0.02, 0.95, 1.1])
    whirls = Whirls.synchronous(np.full(3, 40.0), size, np.zeros(3))
    found, exact = MODEL.answer(fills, whirls), STATICS.answer(fills, whirls)
    np.testing.assert_allclose(found.unbalance[:2], exact.unbalance[:2], rtol=1e-12)
    assert found.in_range.tolist() == [True, True, False] and found.dry_patch.tolist() == [False, False, True]


@settings(max_examples=25, deadline=None)
@given(
    layer=some.floats(0.02, 0.9),
    speed=some.one_of(some.floats(0.55, 0.95), some.floats(1.1, 3.0), some.floats(-3.0, -0.3)),
)
def test_small_waves_are_those_of_the_linear_theory(layer: float, speed: float) -> None:
    """Force, offset and surface, to the square of the whirl over its distance from the free wave."""
    square = (1.0 - 1.0 / speed) ** 2
    near = min(abs(square / linear_detuning(layer, n) - 1.0) for n in range(1, 40))
    if near < 0.02 or abs(square / linear_detuning(layer) - 1.0) < 0.1:
        return
    fill = filled(layer)
    whirl = Whirl(40.0, 40.0 * speed, 1e-5 * near**2 * fill.depth)
    wave, linear = MODEL.wave(fill, whirl), LINEAR.wave(fill, whirl)
    assert wave.answer.converged[0]
    assert ratio(fill, whirl, wave) == pytest.approx(ratio(fill, whirl, linear), rel=1e-5, abs=1e-5)
    high = np.interp(linear.theta, wave.theta, wave.depth, period=2.0 * math.pi) - fill.depth
    size = float(np.abs(linear.depth - fill.depth).max())
    np.testing.assert_allclose(high, linear.depth - fill.depth, atol=2e-3 * size + 1e-12 * fill.depth)


def test_scaling() -> None:
    """Length, time and density scaled, the answer is the same to rounding."""
    fill, small = filled(0.2), Whirl(40.0, 34.0, 1e-3)
    wave = MODEL.wave(fill, small)
    chamber = Chamber(2.5 * fill.chamber.radius, fill.chamber.height)
    large = Fill(chamber, known_liquid("brine"), 6.25 * fill.volume)
    whirl = Whirl(3.0 * 40.0, 3.0 * 34.0, 2.5e-3)
    other = MODEL.wave(large, whirl)
    assert ratio(large, whirl, other) == pytest.approx(ratio(fill, small, wave), rel=1e-11)
    np.testing.assert_allclose(other.depth, 2.5 * wave.depth, rtol=1e-11)
    assert other.mean_rotation == pytest.approx(3.0 * wave.mean_rotation, rel=1e-9)


@kills("solvers.potential.steady:SteadyWave.rotation", "potential * steep", "2.0 * potential * steep")
def test_the_mean_rotation_is_that_of_the_wave_in_time() -> None:
    """By the potential on nodes all round, for the steady wave put into the drum."""
    wave, slip = steady.forced(0.1, (1.0 - 1.0 / 0.85) ** 2, 0.01), 0.85 - 1.0
    kept = invariants(started(wave, slip, 256).state)
    assert wave.rotation * slip == pytest.approx(kept.rotation, rel=1e-10)


def test_without_a_whirl() -> None:
    """The limit of the force, the layer at rest."""
    fill = filled(0.1)
    wave = MODEL.wave(fill, Whirl(40.0, 32.0, 0.0))
    kappa = (fill.chamber.radius / fill.surface_radius) ** 2
    assert wave.answer.slope[0] == pytest.approx(fill.full_mass * float(waves.force_ratio(kappa, 0.8)))
    assert wave.answer.unbalance[0] == 0.0 and np.ptp(wave.depth) < 1e-15


# --- where there is no wave ---


@pytest.mark.parametrize(
    ("layer", "speed", "share", "said", "largest"),
    [
        (0.1, 1.3, 0.06, "chokes", 0.0559),
        (0.3, 0.7, 0.02, "natural sloshing wave of 4 crests", 0.0127),
        (0.05, 1.3, 0.02, "fold", 0.001957),
        (0.1, 1.0, 1.2, "dry", 1.0),
    ],
)
def test_no_wave_says_why(layer: float, speed: float, share: float, said: str, largest: float) -> None:
    """No force is owed, and the largest whirl with a wave is told."""
    wave, fill = asked(layer, speed, share), filled(layer)
    assert not wave.answer.converged[0] and said in wave.reason
    assert np.isnan(wave.answer.unbalance[0]) and wave.branch == ""
    assert wave.largest / fill.depth == pytest.approx(largest, rel=2e-3)
    # Just below the largest whirl there is one.
    if share < 1.0:
        assert asked(layer, speed, 0.98 * wave.largest / fill.depth).answer.converged[0]


def test_few_nodes_do_not_pretend() -> None:
    """What 24 nodes cannot carry is not found, and what they can is told with its error."""
    fill = filled(0.1)
    whirl = Whirl(40.0, 34.0, 0.1 * fill.depth)
    few, exact = Potential(24).wave(fill, whirl), MODEL.wave(fill, whirl)
    gap = abs(few.answer.unbalance[0] / exact.answer.unbalance[0] - 1.0)
    # The answer is that of half as many nodes again, whose error is less than the one that is told.
    assert few.answer.converged[0] and gap <= few.answer.error[0] < 1e-3
    assert not Potential(16).free_wave(fill, 40.0, 1.5).converged


# --- free waves ---

FREE = (("0.05", "1.10"), ("0.1", "1.30"), ("0.1", "1.60"), ("0.3", "1.35"), ("0.5", "1.20"))


@kills("solvers.potential.model:Potential.free_wave", "spin * (1.0 + behind)", "spin * behind")
@kills("solvers.potential.model:_crest_number", "math.exp(", "-math.exp(")
def test_free() -> None:
    for depth, height in FREE:
        layer, crest, behind = float(depth), float(height), float(TABLE["free"][depth][height])
        fill = filled(layer)
        wave = MODEL.free_wave(fill, 40.0, crest)
        assert wave.converged and wave.branch == Branch.ONE_CREST
        assert wave.whirl_speed[0] / 40.0 - 1.0 == pytest.approx(behind, abs=4e-12)
        # Of one shape: 1/s_p + 1/s_r = -2/Omega.
        assert sum(40.0 / (speed - 40.0) for speed in wave.whirl_speed) == pytest.approx(-2.0, rel=1e-11)
        assert wave.depth.max() == pytest.approx(crest * fill.depth, rel=1e-12)
        assert wave.mass_error < 1e-12 and wave.error < 1e-9 and 0.0 < wave.crest_number < 1.0


@pytest.mark.parametrize(("layer", "crests"), [(0.05, 1), (0.3, 1), (0.3, 5), (0.8, 2)])
def test_low_free_waves_are_linear(layer: float, crests: int) -> None:
    """Speed to the square of the height, shape and crest number to its first power."""
    fill, high = filled(layer), 3e-4 * layer**2
    wave, linear = (model.free_wave(fill, 40.0, 1.0 + high, crests) for model in (MODEL, LINEAR))
    assert isinstance(wave.branch, str) and wave.converged
    np.testing.assert_allclose(wave.whirl_speed, linear.whirl_speed, rtol=1e-5)
    assert wave.crest_number == pytest.approx(linear.crest_number, rel=3e-2)
    seen = np.interp(linear.theta, wave.theta, wave.depth, period=2.0 * math.pi)
    np.testing.assert_allclose(seen, linear.depth, atol=0.02 * high * fill.depth)


@kills("solvers.potential.steady:SteadyWave.branch", "not self.single", "False")
def test_the_branch_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """A method with patience comes from a cosine to a wave of one height and another speed, with ripples."""
    wave = MODEL.free_wave(filled(0.05), 1.0, 1.1)
    assert wave.whirl_speed[0] - 1.0 == pytest.approx(-0.186999214546, abs=1e-11)
    assert wave.branch == Branch.ONE_CREST
    assert MODEL.free_wave(filled(0.2), 1.0, 1.05, 5).branch == Branch.MANY_CRESTS
    monkeypatch.setattr(steady, "_ROUNDS", 60)
    monkeypatch.setattr(steady, "_STALLED", math.inf)
    at = nodes(48)
    lifted = -math.log1p(-0.05) + 0.01 * 0.05 / 0.95 * np.cos(at.u)
    wrong = SteadyWave(at, lifted, linear_detuning(0.05), 0.0, 0.05, math.nan, False)
    for count, crest in ((48, 1.01), (48, 1.1), (256, 1.1)):
        wrong = solve(on_nodes(wrong, nodes(count)), {"whirl": 0.0, "crest": crest})
    assert wrong.converged and wrong.tail < 1e-6 and wrong.branch is Branch.LEE_WAVES
    assert wrong.slip_speeds()[1] == pytest.approx(-0.185119524, abs=1e-9)


def test_beyond_the_highest_free_wave() -> None:
    wave = MODEL.free_wave(filled(0.5), 40.0, 1.3)
    assert not wave.converged and "1.23" in wave.reason and math.isnan(wave.whirl_speed[0])


# --- bad input ---


@pytest.mark.parametrize(
    ("field", "call"),
    [
        ("gravity", lambda: MODEL.wave(filled(0.1), Whirl(40.0, 34.0, 1e-4, gravity=9.81))),
        ("volume", lambda: MODEL.wave(filled(1.0), Whirl(40.0, 34.0, 1e-4))),
        ("volume", lambda: MODEL.free_wave(filled(1.0), 40.0, 1.1)),
        ("free", lambda: MODEL.free_wave(filled(0.1), 40.0, 1.0)),
        ("free", lambda: MODEL.free_wave(filled(0.1), 40.0, 10.5)),
        ("free", lambda: LINEAR.free_wave(filled(0.1), 40.0, math.nan)),
        ("mode", lambda: MODEL.free_wave(filled(0.1), 40.0, 1.1, 0)),
        ("cells", lambda: Potential(3)),
        ("cells", lambda: Potential(17).steps),
    ],
)
def test_bad_input(field: str, call: object) -> None:
    with pytest.raises(InputError, match=field):
        call()  # type: ignore[operator]
