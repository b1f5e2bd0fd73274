"""Samples: the wanted distributions, evenly spread, each by its number alone."""

from __future__ import annotations

import functools
import math
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from leblanc.scene.scene import load_scene
from leblanc.studies.sweep.plan import (
    Choice,
    Distribution,
    Levels,
    LogNormal,
    Normal,
    Sweep,
    Uniform,
    VariedField,
)
from leblanc.studies.sweep.sampling import sample_rows, sampling_note
from tests.mutants import kills

EXAMPLE = Path(__file__).parents[4] / "examples" / "horizontal_rig.toml"
DESIGNS = ("random", "latin_hypercube", "sobol", "saltelli")


@functools.cache
def base() -> Sweep:
    """A sweep of nothing, to be given fields."""
    table = tomllib.loads(EXAMPLE.read_text(encoding="utf-8"))
    return Sweep("s", "s.toml", table, load_scene(EXAMPLE), "random", 1, 11, ())


def sweep_of(method: str, points: int, *distributions: Distribution, seed: int = 11) -> Sweep:
    fields = tuple(VariedField(f"field.{k}", "1", one) for k, one in enumerate(distributions))
    return replace(base(), method=method, points=points, seed=seed, fields=fields)


@kills("leblanc.studies.sweep.plan:Uniform.at", "(self.high - self.low) * u", "self.high * u")
@kills(
    "leblanc.studies.sweep.plan:Normal.at",
    "self.mean + self.deviation",
    "self.mean - self.deviation",
)
@kills("leblanc.studies.sweep.plan:LogNormal.at", "math.log(self.factor)", "math.log10(self.factor)")
@kills("leblanc.studies.sweep.plan:LogNormal.at", "self.median * np.exp(", "np.exp(")
@kills(
    "leblanc.studies.sweep.plan:Choice.at",
    "np.floor(u * len(self.options))",
    "np.rint(u * len(self.options))",
)
def test_distributions() -> None:
    """Inverse distribution functions against those of scipy, which have other parameters."""
    u = np.linspace(0.0, 1.0, 1001)[1:-1]
    # Two or three operations on numbers of order one: a few rounding errors.
    np.testing.assert_allclose(Uniform(3.0, 12.0).at(u), stats.uniform(3.0, 9.0).ppf(u), rtol=1e-14)
    np.testing.assert_allclose(Normal(5.0, 2.0).at(u), stats.norm(5.0, 2.0).ppf(u), rtol=1e-12, atol=1e-14)
    # exp(log(f) z): rounding of the exponent, |z log f| < 4, is multiplied by it.
    np.testing.assert_allclose(
        LogNormal(2.0, 1.5).at(u), stats.lognorm(math.log(1.5), scale=2.0).ppf(u), rtol=1e-12
    )
    # each option has the same share of u, the first the lowest
    halves = (np.arange(300) + 0.5) / 300.0
    np.testing.assert_array_equal(Choice(("a", "b", "c")).at(halves), np.repeat([0.0, 1.0, 2.0], 100))


@kills(
    "leblanc.studies.sweep.sampling:grid_rows",
    "np.unravel_index(np.arange(start, stop), tuple(level.size for level in levels))",
    'np.unravel_index(np.arange(start, stop), tuple(level.size for level in levels), order="F")',
)
def test_grid() -> None:
    """A grid is the product of its levels, the last field fastest."""
    sweep = sweep_of("grid", 6, Levels(1.0, 2.0, 2), Choice(("a", "b", "c")))
    expected = [[a, b] for a in (1.0, 2.0) for b in (0.0, 1.0, 2.0)]
    np.testing.assert_array_equal(sample_rows(sweep)(0, 6), expected)


@kills("leblanc.studies.sweep.sampling:_saltelli", "taken[-1] = True", "taken[-1] = False")
@kills("leblanc.studies.sweep.sampling:_saltelli", "np.eye(width, dtype=bool)", "~np.eye(width, dtype=bool)")
def test_saltelli_members() -> None:
    """Around one point: A, then A with one field after the other from B, then B."""
    rows = sample_rows(sweep_of("saltelli", 8, *[Uniform(0.0, 1.0)] * 3))(0, 40).reshape(8, 5, 3)
    a, b = rows[:, 0], rows[:, -1]
    assert np.all(a != b)
    for j in range(3):
        expected = a.copy()
        expected[:, j] = b[:, j]
        np.testing.assert_array_equal(rows[:, 1 + j], expected)
    # Both sets fill the cube: in a Sobol sequence of 2^m points each half of each axis holds half of them.
    np.testing.assert_array_equal(np.count_nonzero(np.concatenate([a, b], axis=1) < 0.5, axis=0), 4)


@kills(
    "leblanc.studies.sweep.sampling:sobol_points",
    "engine.random(stop - start - 1)",
    "engine.random(stop - start - 1) ** 2",
)
def test_designs_are_even() -> None:
    """In each stratum of each field one sample; for the Sobol sequence where they are a power of two."""
    for method in ("latin_hypercube", "sobol"):
        rows = sample_rows(sweep_of(method, 64, *[Uniform(0.0, 1.0)] * 4))(0, 64)
        for column in rows.T:
            np.testing.assert_array_equal(np.sort(np.floor(64 * column)), np.arange(64.0))


@given(
    method=st.sampled_from((*DESIGNS, "grid")),
    seed=st.integers(0, 2**63 - 1),
    points=st.integers(1, 60),
    data=st.data(),
)
def test_a_sample_depends_on_its_number_only(
    method: str, seed: int, points: int, data: st.DataObject
) -> None:
    varied: tuple[Distribution, ...] = (Uniform(3.0, 12.0), Normal(0.0, 1.0), Choice((1.0, 2.0, 5.0)))
    if method == "grid":
        varied = Levels(0.0, 1.0, points), Choice((1.0, 2.0))
        points *= 2
    sweep = sweep_of(method, points, *varied, seed=seed)
    rows = sample_rows(sweep)
    whole = rows(0, sweep.samples)
    assert whole.shape == (sweep.samples, len(varied))
    assert np.isfinite(whole).all()
    start = data.draw(st.integers(0, sweep.samples - 1))
    stop = data.draw(st.integers(start + 1, sweep.samples))
    np.testing.assert_array_equal(sample_rows(sweep)(start, stop), whole[start:stop])


@given(u=st.floats(0.0, 1.0), low=st.floats(-1e6, 1e6), width=st.floats(1e-6, 1e6))
def test_every_share_has_a_value(u: float, low: float, width: float) -> None:
    share = np.array([u])
    # a + (b - a) rounds once beyond b at most
    value = Uniform(low, low + width).at(share)[0]
    assert low <= value <= low + width + 4e-16 * (abs(low) + width)
    assert np.isfinite(Normal(low, width).at(share)).all()
    # nine standard deviations at most are reached: 1.5^9 = 38
    assert 0.0 < LogNormal(width, 1.5).at(share)[0] < 100.0 * width
    assert 0.0 <= Choice(("a", "b")).at(share)[0] <= 1.0


@pytest.mark.parametrize("method", ["random", "latin_hypercube", "sobol"])
def test_means_and_deviations_are_those_of_the_distributions(method: str) -> None:
    n = 4096
    rows = sample_rows(sweep_of(method, n, Uniform(3.0, 12.0), Normal(5.0, 2.0), LogNormal(2.0, 1.5)))(0, n)
    spread = math.log(1.5)
    mean = np.array([7.5, 5.0, 2.0 * math.exp(spread**2 / 2.0)])
    deviation = np.array([9.0 / math.sqrt(12.0), 2.0, mean[2] * math.sqrt(math.expm1(spread**2))])
    # Four standard errors of a random sample; even designs are better.
    np.testing.assert_allclose(rows.mean(axis=0), mean, atol=4.0 * float(np.max(deviation)) / math.sqrt(n))
    np.testing.assert_allclose(rows.std(axis=0), deviation, rtol=4.0 * math.sqrt(3.0 / n))


@pytest.mark.parametrize("method", DESIGNS)
def test_another_seed_gives_other_samples(method: str) -> None:
    one, other = (
        sample_rows(sweep_of(method, 16, Uniform(0.0, 1.0), Uniform(0.0, 1.0), seed=seed))(0, 16)
        for seed in (1, 2)
    )
    assert np.all(one != other)


def test_numbers_of_sobol_points_that_cost_evenness_are_named() -> None:
    note = sampling_note(sweep_of("sobol", 1000, Uniform(0.0, 1.0)))
    assert note is not None
    assert "512 or 1024" in note
    assert sampling_note(sweep_of("sobol", 1024, Uniform(0.0, 1.0))) is None
    assert sampling_note(sweep_of("random", 1000, Uniform(0.0, 1.0))) is None
