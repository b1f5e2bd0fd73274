"""What the height of a wave does to the force, beside exact waves, and the ends of their branches."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as some

from fluid import waves
from solvers.potential.steady import forced, linear_detuning
from solvers.wave_error import (
    detuning_ratio,
    family_error,
    force_change,
    largest_whirl,
    layer_tanh,
    linear_error,
    long_wave_error,
    nonlinearity,
    small_force,
)
from tests.mutants import kills


@given(some.floats(0.01, 0.95), some.floats(-3.0, 3.0).filter(lambda q: abs(q) > 0.05))
def test_a_small_whirl_has_the_linear_force(layer: float, speed: float) -> None:
    """Two closed forms of one number; the error of either is rounding over the distance to the pole."""
    detuning = (1.0 - 1.0 / speed) ** 2
    away = abs(float(detuning_ratio(layer, detuning)) ** 2 - 1.0)
    if away < 1e-6:
        return
    expected = float(waves.force_ratio(1.0 / (1.0 - layer) ** 2, speed))
    # The quotient (1 - a^2)/(T - (1 + T) p^2) loses what kappa - 1 and its detuning lose.
    rounding = 1e-13 / (layer * min(away, 1.0))
    assert float(small_force(layer, detuning)) == pytest.approx(expected, rel=rounding, abs=rounding)
    assert float(detuning_ratio(layer, linear_detuning(layer))) == pytest.approx(1.0, rel=1e-12)


@given(some.floats(0.02, 0.5), some.floats(0.2, 2.5).filter(lambda q: abs(q - 1.0) > 0.05))
@kills("solvers.wave_error:_tanh_change", "square * t * x", "t * x")
@kills("solvers.wave_error:_tanh_change", "np.square(t - (1.0 + t) * x)", "np.square(t - x)")
@kills("solvers.wave_error:long_wave_error", "_CELLS_DISPERSED if dispersion else _CELLS", "_CELLS")
def test_cells_slow_small_waves(layer: float, ratio: float) -> None:
    """By as much as another tanh L would, with the square of the cells."""
    detuning, t, step = ratio**2 * linear_detuning(layer), float(layer_tanh(layer)), 1e-5
    ends = [float(small_force(layer, detuning, t * (1.0 + way * step))) for way in (-1, 1)]
    size = max(1.0, abs(float(small_force(layer, detuning))))
    for dispersion, share in ((True, 1e-3), (False, 1.3e-3)):
        found = [long_wave_error(layer, detuning, 1e-7, dispersion, n) for n in (64, 128, math.inf)]
        # Above are differences of what the model is off by itself: 1e-16 of that over the share.
        wanted = share * abs(ends[1] - ends[0]) / (2.0 * step * size)
        assert float(found[1] - found[2]) == pytest.approx(wanted, rel=1e-4, abs=1e-14)
        assert float(found[0] - found[2]) == pytest.approx(4.0 * wanted, rel=1e-4, abs=1e-14)


@pytest.mark.parametrize(
    ("layer", "ratio", "whirl"),
    [(0.05, 0.5, 0.01), (0.1, 1.4, 0.01), (0.3, 1.3, 0.01), (0.5, 0.6, 0.01), (0.7, 0.97, 5e-4)],
)
@kills("solvers.wave_error:force_change", "- 21.0 * t * t", "- 20.0 * t * t")
@kills("solvers.wave_error:force_change", "- 4.0 * t * (1.0 - t) ** 2", "- 4.0 * t * (1.0 - t)")
@kills("solvers.wave_error:force_change", "first**4 * second", "first**5")
def test_the_height_of_exact_waves(layer: float, ratio: float, whirl: float) -> None:
    """By Newton's method what G has beyond G_0, over the square of the whirl, tends to G_2."""
    detuning = ratio**2 * linear_detuning(layer)
    found = [
        (forced(layer, detuning, size * layer).force_ratio - float(small_force(layer, detuning)))
        / (size * layer / (1.0 - layer)) ** 2
        for size in (whirl, 0.5 * whirl)
    ]
    # The next term goes with the square: a third of the change between the two is left, and its own next one.
    limit = found[1] + (found[1] - found[0]) / 3.0
    left = abs(found[1] - found[0]) * 10.0 * float(nonlinearity(layer, detuning, whirl))
    # Newton's residual of 1e-13 over the whirl, and over its square again.
    rounding = 1e-11 / whirl / (whirl * layer) ** 2 * layer
    assert float(force_change(layer, detuning)) == pytest.approx(limit, abs=left + rounding)
    assert abs(found[1] / limit - 1.0) < 0.02, "small enough for a limit"


@given(some.floats(0.001, 0.999), some.floats(1e-4, 4.0))
def test_height_raises_the_force_below_two_crests_and_lowers_it_above(layer: float, detuning: float) -> None:
    square = (1.0 - layer) ** 2
    t = (1.0 - square) / (1.0 + square)
    apart = detuning * (1.0 + t + t * t) - t
    first = detuning * (1.0 + t) - t
    if min(abs(apart), abs(first)) > 1e-6:
        assert math.copysign(1.0, float(force_change(layer, detuning))) == -math.copysign(1.0, apart)


@pytest.mark.parametrize(
    ("layer", "ratio", "whirl"),
    [
        *(
            (0.1, 1.05, 0.002810558),
            (0.1, 1.1, 0.010372250),
            (0.1, 1.2, 0.039130892),
            (0.1, 1.3, 0.085666761),
        ),
        *(
            (0.1, 1.5, 0.230884010),
            (0.3, 1.05, 0.004788178),
            (0.3, 1.1, 0.015564431),
            (0.3, 1.2, 0.052327347),
        ),
        *((0.3, 1.3, 0.107335961), (0.3, 1.5, 0.26569846)),
    ],
)
@kills("solvers.wave_error:largest_whirl", "(first - second)", "(first + second)")
@kills("solvers.wave_error:largest_whirl", "np.abs(ratio - 1.0)", "(ratio + 1.0)")
def test_folds_of_exact_waves(layer: float, ratio: float, whirl: float) -> None:
    """Folds found by another code for the exact equations; the fit is right to 1.5 %, at most 7 %."""
    found = float(largest_whirl(layer, ratio**2 * linear_detuning(layer)))
    assert found == pytest.approx(whirl, rel=0.07)


def test_a_thin_layer_chokes_below_its_resonance() -> None:
    """Twice as far from it, four times the whirl; no end is told between the first two resonances."""
    layer = 0.02
    near, far = (float(largest_whirl(layer, r * r * linear_detuning(layer))) for r in (0.9, 0.8))
    assert far == pytest.approx(4.0 * near, rel=1e-9) and near == pytest.approx(math.pi**2 / 1200.0, rel=1e-9)
    between = 0.5 * (linear_detuning(0.5) + linear_detuning(0.5, 2))
    assert float(largest_whirl(0.5, between)) == math.inf


def test_no_estimate_where_there_is_no_wave() -> None:
    detuning = 1.1**2 * linear_detuning(0.1)
    speed = 1.0 / (1.0 + math.sqrt(detuning))
    inside, beyond = 0.009, 0.012
    for whirl, told in ((inside, True), (beyond, False)):
        errors = (
            float(linear_error(0.1, detuning, whirl)), float(long_wave_error(0.1, detuning, whirl, False)),
            float(long_wave_error(0.1, detuning, whirl, True)), family_error(0.1, speed, whirl, False),
        )  # fmt: skip
        assert all(math.isfinite(error) == told for error in errors)
    # At the resonance there is no estimate, or rounding makes one that nobody takes for small.
    assert not float(linear_error(0.1, linear_detuning(0.1), 1e-6)) < 1.0


def test_no_whirl_and_a_synchronous_one_leave_small_errors() -> None:
    """Without height linear theory is exact, and long waves have the error of their dispersion alone."""
    layer, detuning = 0.1, (1.0 - 1.0 / 1.3) ** 2
    assert float(linear_error(layer, detuning, 0.0)) == 0.0
    plain = float(long_wave_error(layer, detuning, 0.0, False))
    log = -math.log1p(-layer)
    assert plain == pytest.approx(
        1.03 * abs(float(small_force(layer, detuning, log) / small_force(layer, detuning)) - 1.0), rel=1e-12
    )
    assert float(long_wave_error(layer, detuning, 0.0, True)) < 1e-4 * plain
    for error in (linear_error(layer, 0.0, 0.5), long_wave_error(layer, 0.0, 0.5, True)):
        assert float(error) < 1e-15
