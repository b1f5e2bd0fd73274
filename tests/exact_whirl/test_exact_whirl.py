"""Edges of the band against exact steady waves, lagging waves against linear theory, what is kept."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from solvers.potential.coupled import advance
from solvers.potential.steady import forced
from solvers.wave_error import force_change, layer_tanh
from tests.exact_whirl import kept
from tests.exact_whirl.__main__ import GROWING, LAYERS, MASS_RATIOS, SETTLING, WAYS, onset_of
from tests.exact_whirl.edges import (
    crest_detuning,
    edge_detunings,
    edge_mass_ratio,
    edge_shift,
    edge_speed,
    soft_mass_ratio,
)
from tests.exact_whirl.figure import alternative, whirl_figure
from tests.exact_whirl.held import CASES
from tests.exact_whirl.held import kept as kept_held
from tests.exact_whirl.in_time import NATURAL, RADIUS, Setting, standing
from tests.exact_whirl.lagging import circles, lagging_wave, onset, small_whirl
from tests.mutants import kills
from tests.oracles.exact import force_with_friction

ROOT = Path(__file__).parents[2]


def _exact_edge(layer: float, mass_ratio: float, whirl: float, detuning: float) -> float:
    """Omega/omega_n of an edge at a whirl over h_0: the extremum over the slip, by five exact waves."""
    slip = math.sqrt(detuning)
    away = slip * np.linspace(-2e-3, 2e-3, 5)
    force = np.array([forced(layer, (slip + d) ** 2, whirl * layer, 96).force_ratio for d in away])
    cubic = np.polyfit(away, (1.0 + slip + away) / np.sqrt(1.0 + mass_ratio * force), 3)
    turns = np.roots(np.polyder(cubic))
    return float(np.polyval(cubic, turns[np.argmin(np.abs(turns))].real))


@kills("tests.exact_whirl.edges:edge_shift", "-0.5 *", "0.5 *")
@kills("tests.exact_whirl.edges:edge_mass_ratio", "-2.0 * slip", "-1.9 * slip")
@pytest.mark.parametrize(
    ("layer", "mass_ratio", "whirl"),
    [(0.1, 0.1, 2e-3), (0.3, 0.1, 1e-3), (0.5, 0.05, 2e-4), (0.7, 0.1, 1e-4)],
)
def test_edges_move_as_exact_waves_have_it(layer: float, mass_ratio: float, whirl: float) -> None:
    """The fourth order is 6e-3 of the second at these whirls; the cubic's own error is below 1e-8."""
    for detuning in edge_detunings(layer, mass_ratio):
        still = float(edge_speed(layer, detuning, mass_ratio))
        shift = float(edge_shift(layer, detuning, mass_ratio)) * whirl**2
        assert _exact_edge(layer, mass_ratio, whirl, detuning) - still == pytest.approx(shift, rel=0.01)


def test_between_the_edges_small_whirls_grow() -> None:
    """By the roots of the linear machine, to a part in ten thousand of the speed."""
    for layer, mass_ratio in ((0.1, 0.1), (0.5, 0.3), (0.9, 1.0)):
        lower, upper = (float(edge_speed(layer, d, mass_ratio)) for d in edge_detunings(layer, mass_ratio))
        growth = [
            small_whirl(layer, mass_ratio, 0.0, 0.0, speed)[0]
            for speed in (lower * 0.9999, lower * 1.0001, upper * 0.9999, upper * 1.0001)
        ]
        assert growth[0] < 1e-6 < growth[1] and growth[3] < 1e-6 < growth[2]


def test_the_upper_edge_never_gives_way_and_the_lower_one_where_it_is_told() -> None:
    """The sign of G's second order is that of p_2^2 - p^2, at any depth."""
    layer = np.linspace(0.01, 0.95, 95)
    second = crest_detuning(layer, 2)
    for factor in (0.3, 0.9, 1.05, 2.0, 20.0):
        assert np.all(np.sign(force_change(layer, factor * second)) == math.copysign(1.0, 1.0 - factor))
    ratio = soft_mass_ratio(layer)
    # Beyond some depth no mass is too large.
    assert np.all(np.diff(ratio[layer < 0.72]) > 0.0) and np.all(ratio[layer > 0.775] < 0.0)
    for h in (0.3, 0.5, 0.7):
        threshold = float(soft_mass_ratio(h))
        for factor, sign in ((0.8, 1.0), (1.2, -1.0)):
            lower, upper = edge_detunings(h, factor * threshold)
            # The lower edge moves up, into the band, where it is soft; the upper one moves up, out of it.
            assert sign * edge_shift(h, lower, factor * threshold) > 0.0
            assert edge_shift(h, upper, factor * threshold) > 0.0
    assert edge_mass_ratio(0.3, edge_detunings(0.3, 0.2)[0]) == pytest.approx(0.2, rel=1e-9)


@kills("tests.exact_whirl.lagging:_residual", "friction * slip * potential", "friction * potential")
@kills("tests.exact_whirl.lagging:_residual", "-0.5 * lag", "0.5 * lag")
def test_lagging_waves_have_both_limits() -> None:
    """Small ones that of linear theory, to the square of the whirl; without friction the steady wave."""
    for friction, layer in ((0.03, 0.3), (0.3, 0.1), (0.1, 0.8)):
        found = lagging_wave(layer, 1.0 - 1.0 / 0.75, 1e-6, friction)
        wanted = force_with_friction(float(layer_tanh(layer)), 1.0, 0.75, 0.75 * friction)
        assert found.converged
        # Rounding of the place over the whirl, 1e-16/1e-6, and a hundred times it for the solution.
        assert found.force_ratio == pytest.approx(complex(wanted), abs=1e-7)
    found = lagging_wave(0.3, 1.0 - 1.0 / 0.85, 0.03, 0.0)
    assert found.force_ratio.real == pytest.approx(1.068773056475, abs=1e-10)
    assert abs(found.force_ratio.imag) < 1e-12


def test_an_onset_is_that_of_linear_theory() -> None:
    found = onset(0.1, 0.1, 0.02, 0.03)
    assert found is not None
    assert abs(small_whirl(0.1, 0.1, 0.02, 0.03, found[0])[0]) < 1e-10
    # Friction that has no damped support beside it drives nothing below the band; hardly any mass no whirl.
    assert onset(0.9, 0.01, 0.02, 0.03) is None


@kills(
    "tests.exact_whirl.in_time:standing",
    "lagging_wave(setting.layer, slip",
    "lagging_wave(setting.layer, 0.99 * slip",
)
def test_a_circle_stands_in_time() -> None:
    """Rotor and lagging wave in the coupled machine: over a whirl deflection and place of the liquid stay.

    To 1e-6, which is what the spectrum of 65 nodes leaves out; rotor and wave share no code with the circle.
    """
    found = circles(0.5, 0.05, 0.02, 0.03, (0.001, 0.004))[-1]
    setting = Setting(0.5, 0.05, found.speed, 0.02, 0.03)
    machine, state = standing(setting, found, 128)
    course = advance(machine, state, (0.0, 2.0 * math.pi / found.whirl_speed / NATURAL), 1e-9)
    deflection = np.hypot(course.place[:, 0], course.place[:, 1]) / (found.whirl * setting.layer * RADIUS)
    moment = np.abs(course.moment[:, 0])
    np.testing.assert_allclose(deflection, 1.0, atol=1e-6)
    np.testing.assert_allclose(moment, moment[0], rtol=1e-6)


def test_what_is_kept() -> None:
    results = kept()
    assert [(row.layer, row.mass_ratio) for row in results.onsets] == [
        (h, m) for h in LAYERS for m in MASS_RATIOS
    ]
    assert [(way.layer, way.mass_ratio) for way in results.ways] == list(WAYS)
    assert len(results.settled) == len(SETTLING) and len(results.grown) == len(GROWING)
    for row in results.onsets[30:32]:
        again = onset_of(row.layer, row.mass_ratio)
        assert (again.speed, again.shift) == pytest.approx((row.speed, row.shift), rel=1e-2)
    # Soft without losses is soft with them.
    for row in results.onsets:
        limit = float(soft_mass_ratio(row.layer))
        if (limit < 0.0 or row.mass_ratio < limit) and not math.isnan(row.shift):
            assert row.shift > 0.0
    for found in results.settled:
        (way,) = [w for w in results.ways if w.layer == found.setting.layer]
        wanted = np.interp(
            found.setting.speed, [c.speed for c in way.circles], [c.whirl for c in way.circles]
        )
        # From below and from above a small distance dies out at twice the growth of the small whirl.
        growth = small_whirl(0.5, 0.05, 0.02, 0.03, found.setting.speed)[0]
        dies = math.exp(-2.0 * growth * found.time[-1])
        assert found.ended == "done"
        assert 0.5 * dies < (found.last - wanted) / (found.whirl[0] - wanted) < 2.0 * dies


def test_the_figure_and_the_page_show_it() -> None:
    assert len(whirl_figure().axes) == 2
    assert "Circles" in alternative(kept())
    page = (ROOT / "docs/theory/nonlinear.md").read_text(encoding="utf-8")
    for row in kept().grown:
        assert f"| {row.crest:.3f} | {row.slope:.0f} | {row.crest_number:.2f} |" in page
    held = (ROOT / "docs/models/time_domain.md").read_text(encoding="utf-8")
    found = kept_held()
    assert [(pair.example, pair.rpm) for pair in found] == [case[:2] for case in CASES]
    for pair in found:
        if pair.exact.amplitude is not None and pair.long.amplitude is not None:
            assert f"| {1e3 * pair.exact.amplitude:.5f} | {1e3 * pair.long.amplitude:.5f} |" in held
