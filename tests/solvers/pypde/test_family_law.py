"""One family of waves in a synchronous whirl: its law against closed forms, single waves, its own slope."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from fluid.fill import Fill, Fills
from fluid.friction.laws import Friction
from fluid.liquid import known_liquid
from meshes.chamber import Chamber
from solvers.liquid_model import Whirl, Whirls
from solvers.pypde.family_law import family_law
from solvers.pypde.models import OneFamily
from tests.mutants import kills

R, H, SPIN = 0.15, 0.02, 40.0


def layer(depth: float, inner: float = 0.0) -> Fill:
    """A ring of liquid, its depth over the wall's radius given."""
    surface = R * (1.0 - depth)
    volume = math.pi * (R**2 - surface**2) * H
    return Fill(Chamber(R, H, inner_radius=inner), known_liquid("water"), volume)


def small_share(depth: float) -> float:
    """Part of the exact offset that the retrograde family brings up, KdV, of a wave of no height.

    lambda_+/(lambda_+ - lambda_-) of the two families of long waves, times lambda_-/(lambda_- - delta).
    """
    log = -math.log1p(-depth)
    root = math.sqrt(log * log + log)
    delta = log**3 / 3.0 * (1.0 - (2.0 * log + 1.0) / (2.0 * root))
    return (log + root) / (2.0 * root) * (log - root) / (log - root - delta)


@kills("solvers.pypde.family_law:family_law", "own * c.other_speed", "c.other_speed")
@kills("solvers.pypde.family_law:family_law", "surface, 1.0, -1)", "surface, 1.0, 1)")
@pytest.mark.parametrize("depth", [1e-3, 0.1, 0.3])
def test_a_small_wave_is_the_part_of_linear_theory(depth: float) -> None:
    """Also of the first wave that is solved: the law is even, its share differs by the square of 1/40."""
    law = family_law(1.0 - depth, False)
    share, slope = law.shares(np.array([0.0, 1.0 / 40.0]))
    assert share[0] == pytest.approx(small_share(depth), rel=1e-11)
    assert slope[0] == share[0]
    assert share[1] == pytest.approx(share[0], rel=1e-3) and share[1] > share[0]
    assert 0.5 < share[0] < 1.0  # both families together are the whole


def without_dispersion(size: float, log: float) -> float:
    """Share of the wave of lambda y + alpha y^2/2 = q cos(xi) + C of mean 0, by quadrature alone."""
    root = math.sqrt(log * log + log)
    speed = log - root
    area = 0.5 * -math.expm1(-2.0 * log)  # A0/R^2
    surface = math.exp(-log)
    bend = 3.0 / surface**2 * (1.0 - (2.0 * log + 1.0) / (2.0 * root)) * area / speed
    force = -log * surface * size / (2.0 * root) / (area * speed)

    def wave(angle: float, level: float) -> float:
        return (math.sqrt(1.0 + 2.0 * bend * (force * math.cos(angle) + level)) - 1.0) / bend

    def mean(level: float) -> float:
        return quad(wave, 0.0, math.pi, args=(level,), epsabs=1e-13)[0]

    # The root stays real down to where the trough of the wave is a corner.
    level = brentq(mean, abs(force) - 0.5 / bend + 1e-12, 1.0, xtol=1e-14)
    first = quad(lambda angle: wave(angle, level) * math.cos(angle), 0.0, math.pi, epsabs=1e-13)[0]
    return first / math.pi * surface / size * 2.0 * area / surface**2


@kills("solvers.pypde.family_law:family_law", "eta.min()) <= -c.mean_area", "eta.min()) <= 0.0")
def test_a_thin_layer_has_the_wave_without_dispersion() -> None:
    """Dispersion is L^2/9 of the steepening, 1e-7 here; the wave ends at a corner, w0 = (pi^2/12) h0."""
    depth = 1e-3
    law, log = family_law(1.0 - depth, False), -math.log1p(-depth)
    for size in (0.1, 0.33, 0.5, 0.66):
        exact = without_dispersion(size * depth, log)
        # A spline through 40 waves to a depth.
        assert law.shares(np.array([size]))[0][0] == pytest.approx(exact, rel=2e-6)
    assert math.pi**2 / 12.0 - 1.0 / 40.0 - 0.01 < law.reach < math.pi**2 / 12.0 + 0.01


@pytest.mark.parametrize("friction", [Friction(), Friction("linear", 2.0)])
def test_the_law_is_the_single_wave(friction: Friction) -> None:
    """As `layer` solves it, between the waves of the law; nothing rubs in a wave that stands in the drum."""
    fill, model = layer(0.1), OneFamily(friction)
    for size in (0.11, 0.43, 0.74):
        whirl = Whirl(SPIN, SPIN, size * fill.depth)
        single, many = model.wave(fill, whirl).answer, model.answer(Fills.of([fill]), Whirls.of(whirl))
        assert abs(single.unbalance[0].imag) < 1e-12 * abs(single.unbalance[0])
        assert many.unbalance[0] == pytest.approx(single.unbalance[0], rel=2e-6)
        assert many.offset[0] == pytest.approx(single.offset[0], rel=5e-6)
        assert many.limits["wave_amplitude"] == single.limits["wave_amplitude"]


@kills("solvers.pypde.family_law:FamilyLaw.shares", "share + bend", "share")
@kills("solvers.pypde.family_law:FamilyLaw.steepest", "1.02 * float(max", "0.5 * float(max")
@pytest.mark.parametrize("depth", [1e-3, 0.05, 0.2, 0.3])
def test_the_slope_is_the_derivative_and_has_a_bound(depth: float) -> None:
    fill, model = layer(depth), OneFamily()
    # Not at the waves of the law, where its third derivative jumps, nor at its end, where the slope does.
    size = fill.depth * np.arange(0.003, 1.3, 0.0127)
    size = size[np.abs(size / fill.depth - family_law(1.0 - depth, False).reach) > 2e-4]
    fills, step = Fills.of([fill] * size.size), 1e-5 * fill.depth

    def answer(deflection: np.ndarray) -> np.ndarray:
        still = np.zeros(size.size)
        asked = Whirls.synchronous(np.full(size.size, SPIN), deflection, still)
        return model.answer(fills, asked).unbalance.real

    told = model.answer(fills, Whirls.synchronous(np.full(size.size, SPIN), size, np.zeros(size.size)))
    slope = (answer(size + step) - answer(size - step)) / (2.0 * step)
    np.testing.assert_allclose(told.slope, slope, rtol=1e-6)
    assert np.all(told.slope <= model.steepest(fills))
    # What the solver of all branches rests on: less the liquid's mass it never falls.
    assert np.all(slope >= fill.mass)


def test_the_error_is_the_distance_from_the_exact_pull() -> None:
    """m_f w while the wall is wet, at every speed alike; beyond the last wave nothing is answered."""
    fill = layer(0.1)
    size = fill.depth * np.array([1e-3, 0.5, 0.79, 0.9, 3.0])
    for spin in (5.0, 500.0):
        asked = Whirls.synchronous(np.full(5, spin), size, np.zeros(5))
        found = OneFamily().answer(Fills.of([fill] * 5), asked)
        exact = fill.full_mass * size
        np.testing.assert_allclose(found.error, np.abs(found.unbalance.real / exact - 1.0), rtol=1e-9)
        assert found.error[0] == pytest.approx(0.81 * (1.0 - small_share(0.1)), rel=1e-5)
        assert found.converged.tolist() == [True, True, True, False, False]
        assert found.dry_patch.tolist() == [False, False, False, True, True]
        assert not found.in_range.any() and not found.limits["other_family"].any()


def test_a_full_chamber_has_no_wave_and_a_crest_may_meet_an_inner_wall() -> None:
    full = Fill(Chamber(R, H), known_liquid("water"), Chamber(R, H).capacity)
    size = np.array([1e-3])
    asked = Whirls.synchronous(np.array([SPIN]), size, np.zeros(1))
    found = OneFamily().answer(Fills.of([full]), asked)
    assert found.unbalance[0] == pytest.approx(full.mass * 1e-3, rel=1e-12)
    assert found.converged.all() and found.in_range.all() and found.error[0] < 1e-11
    narrow = layer(0.1, inner=0.88 * R)
    for part, clear in ((0.1, True), (0.6, False)):
        whirl = Whirl(SPIN, SPIN, part * narrow.depth)
        many = OneFamily().answer(Fills.of([narrow]), Whirls.of(whirl))
        single = OneFamily().wave(narrow, whirl).answer
        assert many.limits["inner_wall"][0] == single.limits["inner_wall"][0] == clear


def test_the_exact_dispersion_is_a_law_of_its_own() -> None:
    """sigma(1) in place of lambda - delta; its waves break at lower heights."""
    exact, short = (family_law(0.9, dispersion) for dispersion in (True, False))
    assert exact.shares(np.zeros(1))[0][0] == pytest.approx(small_share(0.1), rel=1e-3)
    assert exact.shares(np.zeros(1))[0][0] != short.shares(np.zeros(1))[0][0]
    assert exact.reach < short.reach
