"""The emulator against functions that are known: its error, and what it says of its error."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import qmc

from leblanc.studies.sweep.emulator import Emulator, emulate
from meshes.errors import InputError
from tests.mutants import kills

NAMES = ("rotor.mass", "chambers.0.volume")
LOW, HIGH = np.array([1.0, 1e-5]), np.array([3.0, 1e-3])


def known(values: np.ndarray) -> np.ndarray:
    """A positive function, smooth in the first value and in the logarithm of the second."""
    return 1e-3 / (values[:, 0] + 0.3 * np.sin(np.log(values[:, 1])))


def drawn(count: int, seed: int) -> np.ndarray:
    """Values over both ranges, the second one evenly over its logarithm."""
    unit = qmc.LatinHypercube(2, rng=np.random.default_rng(seed)).random(count)
    return np.stack([LOW[0] + unit[:, 0] * (HIGH - LOW)[0], LOW[1] * (HIGH / LOW)[1] ** unit[:, 1]], axis=1)


def inside(emulator: Emulator, values: np.ndarray) -> np.ndarray:
    return np.clip(values, emulator.low, emulator.high)


@kills(
    "leblanc.studies.sweep.emulator:Emulator.predict",
    "(np.exp(mean), np.exp(mean) * deviation)",
    "(mean, deviation)",
)
@kills(
    "leblanc.studies.sweep.emulator:Emulator.predict", "self.centre + self.scale * mean", "self.centre + mean"
)
@kills(
    "leblanc.studies.sweep.emulator:_on_unseen",
    "missed[fold == k] = mean - standard",
    "missed[fold == k] = 0.1 * mean - 0.1 * standard",
)
@kills(
    "leblanc.studies.sweep.emulator:_on_unseen", "points[fold != k], standard[fold != k]", "points, standard"
)
@kills("leblanc.studies.sweep.emulator:emulate", "size = scale if positive else 1.0", "size = 1.0")
@kills(
    "leblanc.studies.sweep.emulator:_unit", "np.log(np.maximum(values[:, wide], 1e-300))", "values[:, wide]"
)
@kills(
    "leblanc.studies.sweep.emulator:emulate",
    "np.log(output[taken]) if positive else",
    "output[taken] if positive else",
)
def test_error_is_that_of_unseen_samples() -> None:
    """On fresh samples the error is what cross-validation says, and the claimed deviation covers it."""
    values = drawn(120, 1)
    emulator = emulate(NAMES, values, known(values), seed=2)
    fresh = inside(emulator, drawn(2000, 3))
    output, deviation = emulator.predict(fresh)
    np.testing.assert_allclose(emulator.output(fresh), output, rtol=1e-12)
    off = output / known(fresh) - 1.0
    # A fold learns from four fifths of the samples, so it does no better than all of them together; with an
    # error that falls as the distance to the fifth (twice the smoothness), the distance being the root of one
    # over the samples in two dimensions, it is 1.25**2.5 = 1.7 times worse; outliers among 120 do the rest.
    assert 0.2 < np.sqrt(np.mean(off**2)) / emulator.error.root_mean_square < 2.0
    assert emulator.error.root_mean_square < 0.01 * emulator.error.spread
    assert emulator.error.root_mean_square < emulator.error.largest < emulator.error.spread
    np.testing.assert_allclose(emulator.error.spread, np.std(np.log(known(values))), rtol=1e-12)
    assert 0.85 < emulator.error.within_two <= 1.0
    assert np.mean(np.abs(off) <= 2.0 * deviation / output) > 0.85
    assert emulator.positive and emulator.wide.tolist() == [False, True]


def test_samples_are_met() -> None:
    """At a sample the process gives the sample, to the noise it allows itself."""
    values = drawn(60, 4)
    emulator = emulate(NAMES, values, known(values))
    output, _ = emulator.predict(values)
    np.testing.assert_allclose(output, known(values), rtol=5e-3)


def test_signs() -> None:
    """An output of both signs is emulated as it is, its error measured by its spread."""
    x = np.linspace(0.0, 1.0, 30)[:, None]
    emulator = emulate(["x"], x, 4.0 * np.cos(5.0 * x[:, 0]))
    output, deviation = emulator.predict(np.array([[0.123], [0.777]]))
    np.testing.assert_allclose(output, 4.0 * np.cos(5.0 * np.array([0.123, 0.777])), atol=0.02)
    assert not emulator.positive and emulator.error.spread == 1.0 and np.all(deviation < 0.1)


def test_a_kink_is_told_by_the_error() -> None:
    """The bend of a law is rounded off; the cross-validated error grows with it and is still honest."""
    values = drawn(120, 1)
    bent = np.maximum(known(values), 5e-4)
    smooth, kinked = emulate(NAMES, values, known(values)), emulate(NAMES, values, bent)
    assert kinked.error.root_mean_square > 2.0 * smooth.error.root_mean_square
    fresh = inside(kinked, drawn(2000, 3))
    off = kinked.predict(fresh)[0] / np.maximum(known(fresh), 5e-4) - 1.0
    assert 0.2 < np.sqrt(np.mean(off**2)) / kinked.error.root_mean_square < 2.0


def test_same_seed_same_emulator() -> None:
    values = drawn(50, 5)
    first, again = (emulate(NAMES, values, known(values), seed=3) for _ in range(2))
    at = inside(first, drawn(10, 6))
    np.testing.assert_array_equal(first.predict(at)[0], again.predict(at)[0])
    assert first.error == again.error


def test_samples_without_output_are_left_out() -> None:
    values = drawn(60, 7)
    output = known(values)
    output[::6] = np.nan
    assert emulate(NAMES, values, output).error.samples == 50


@pytest.mark.parametrize(
    ("change", "field"),
    [
        (lambda v, y: (v[:10], y[:10]), "samples"),
        (lambda v, y: (v, np.full_like(y, 2.0)), "output"),
        (lambda v, y: (np.stack([v[:, 0], np.ones(len(v))], axis=1), y), "chambers.0.volume"),
        (lambda v, y: (v, np.full_like(y, np.nan)), "samples"),
    ],
)
def test_what_tells_nothing_is_refused(change, field: str) -> None:  # type: ignore[no-untyped-def]
    values = drawn(40, 8)
    with pytest.raises(InputError) as caught:
        emulate(NAMES, *change(values, known(values)))
    assert caught.value.field == field


def test_no_guess_outside_the_samples() -> None:
    values = drawn(40, 9)
    emulator = emulate(NAMES, values, known(values))
    with pytest.raises(InputError, match="inside the range") as caught:
        emulator.predict(np.array([[2.0, 5e-3]]))
    assert caught.value.field == "chambers.0.volume"
