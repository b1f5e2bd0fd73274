"""The exact wave in time: steady waves come back, small ones go as fast as they should, budgets close."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest

from fluid import waves
from meshes.errors import InputError
from solvers.potential.steady import forced, free, linear_detuning
from solvers.potential.unsteady import Push, Surface, advance, force, invariants, rates, started, still
from tests.mutants import kills

FORCED = ((0.1, 1.3, 0.02), (0.1, 0.7, 0.05), (0.3, 0.85, 0.1))


def waved(layer: float, count: int = 64) -> Surface:
    """A state without a symmetry, smooth to rounding on 64 nodes."""
    u = 2.0 * np.pi * np.arange(count) / count
    rest = still(layer, count)
    height = rest.height * (1.0 + 0.05 * np.cos(u) + 0.02 * np.sin(2.0 * u + 0.3))
    return Surface(height, layer * (0.03 * np.sin(u - 0.4) + 0.01 * np.cos(3.0 * u)))


def turning(push: float, slip: float) -> Push:
    """A whirl's force as the drum sees it."""
    return lambda time: push * cmath.exp(1j * slip * time)


def test_rest_stays_rest() -> None:
    for layer in (0.02, 0.3, 0.9):
        assert np.abs(rates(still(layer, 32).state, 0j)).max() < 1e-15


@kills("solvers.potential.unsteady:force", "-change - 0.5", "change - 0.5")
@kills(
    "solvers.potential.unsteady:force",
    "0.5 * np.square(sliding / opened)",
    "0.4 * np.square(sliding / opened)",
)
@kills("solvers.potential.unsteady:force", "1.0 / np.sinh(inner[1:])", "1.0 / np.tanh(inner[1:])")
@kills("solvers.potential.unsteady:_pull", "-2.0 * flow.stream", "-1.9 * flow.stream")
def test_pressure_and_momentum_give_one_force() -> None:
    """Of a steady wave, along the deflection: no friction, no torque, no phase."""
    for layer, ratio, whirl in FORCED:
        wave = forced(layer, (1.0 - 1.0 / ratio) ** 2, whirl * layer)
        push = abs(wave.whirl) * ratio**2
        ratio_found = force(started(wave, ratio - 1.0, 128).state, complex(push)) / (math.pi * push)
        assert ratio_found == pytest.approx(wave.force_ratio, abs=1e-11)


@kills("solvers.potential.unsteady:rates", "flow.opened * slide - flow.steep * climb", "flow.opened * slide")
@kills("solvers.potential.unsteady:rates", "flow.steep * slide + flow.opened", "flow.opened")
@kills("solvers.potential.unsteady:rates", "0.5 * inner / metric", "0.6 * inner / metric")
@kills("solvers.potential.unsteady:started", "0.5 * slip", "0.4 * slip")
def test_a_steady_wave_stays_with_its_whirl() -> None:
    """After a turn of the whirl round the drum it is where it began, by steps of 1e-12."""
    for layer, ratio, whirl in FORCED[:2]:
        slip, wave = ratio - 1.0, forced(layer, (1.0 - 1.0 / ratio) ** 2, whirl * layer)
        begin, push = started(wave, slip, 128), abs(wave.whirl) * ratio**2
        end = advance(begin, 2.0 * math.pi / abs(slip), turning(push, slip))
        np.testing.assert_allclose(end.height, begin.height, atol=1e-12)
        np.testing.assert_allclose(end.potential, begin.potential, atol=1e-12)


def test_twins() -> None:
    """One shape stands in two whirls, behind the drum and ahead of it: 0.7 and 1.75 times its speed."""
    wave = forced(0.1, (1.0 - 1.0 / 0.7) ** 2, 0.005)
    for ratio in (0.7, 1.75):
        slip, push = ratio - 1.0, abs(wave.whirl) * ratio**2
        begin = started(wave, slip, 128)
        end = advance(begin, 1.0, turning(push, slip))
        found = force(end.state, push * cmath.exp(1j * slip)) / (math.pi * push * cmath.exp(1j * slip))
        assert found == pytest.approx(wave.force_ratio, abs=1e-10)


def test_free_waves_of_both_families() -> None:
    """A tall one, a fifth above the layer, back after a turn, ahead of the drum and behind it."""
    wave = free(0.3, 1.2)
    for slip in wave.slip_speeds():
        begin = started(wave, slip, 256)
        end = advance(begin, 2.0 * math.pi / abs(slip))
        np.testing.assert_allclose(end.height, begin.height, atol=1e-10)


@pytest.mark.parametrize("crests", [1, 2, 4])
def test_small_waves(crests: int) -> None:
    """Rates of small y and phi have the linear theory's frequencies as their eigenvalues."""
    layer, count, size = 0.2, 32, 1e-6
    rest, u = still(layer, count), 2.0 * np.pi * np.arange(count) / count
    pair, table = (np.cos(crests * u), np.sin(crests * u)), []
    for part in range(2):
        for wave in pair:
            bump = np.zeros(2 * count)
            bump[part * count : (part + 1) * count] = size * wave
            change = (rates(rest.state + bump, 0j) - rates(rest.state - bump, 0j)) / (2.0 * size)
            table.append([2.0 * np.mean(side * one) for side in change.reshape(2, count) for one in pair])
    found = np.sort(np.abs(np.linalg.eigvals(np.array(table).T).imag))
    ahead, behind = waves.free_wave_frequencies(crests, -math.log1p(-layer), 1.0)
    wanted = np.sort(np.abs([ahead, ahead, behind, behind]).ravel())
    np.testing.assert_allclose(found, wanted, rtol=1e-8)
    assert linear_detuning(layer, crests) == pytest.approx((wanted[0] / (crests - wanted[0])) ** 2, rel=1e-12)


@kills("solvers.potential.unsteady:invariants", "0.125 * whole", "0.12 * whole")
@kills("solvers.potential.unsteady:invariants", "+ 0.25 * whole", "- 0.25 * whole")
def test_what_is_kept() -> None:
    """Without a force, for a motion of no symmetry: volume, energy and angular momentum, over three turns."""
    begin = waved(0.3)
    end = advance(begin, 20.0)
    first, last = invariants(begin.state), invariants(end.state)
    assert np.abs(end.height - begin.height).max() > 1e-2
    for name in ("volume", "energy", "angular_momentum"):
        assert getattr(last, name) == pytest.approx(getattr(first, name), abs=1e-9), name


@kills("solvers.potential.unsteady:force", "+ along", "+ 0.5 * along")
def test_budgets() -> None:
    """What a force does to the invariants, and the force by momentum, by central differences in time."""
    step, begin, push = 1e-4, waved(0.3), 0.02 - 0.03j
    parts = [begin]
    for _ in range(4):
        parts.append(advance(parts[-1], step, lambda t: push))
    kept = [invariants(one.state) for one in parts]
    volume = kept[2].volume
    # Fourth order of 1e-4: rounding of 1e-16/1e-4 is what is left.
    slopes = np.array([1.0, -8.0, 0.0, 8.0, -1.0]) / (12.0 * step)
    centres = np.array([one.centre for one in kept])
    momentum = slopes @ centres
    power = slopes @ np.array([one.energy for one in kept])
    torque = slopes @ np.array([one.angular_momentum for one in kept])
    assert power == pytest.approx((push.conjugate() * momentum).real, abs=1e-10)
    assert torque == pytest.approx((kept[2].centre.conjugate() * push).imag, abs=1e-10)
    # Rounding of 1e-16/1e-8 here.
    second = np.array([-1.0, 16.0, -30.0, 16.0, -1.0]) / (12.0 * step**2) @ centres
    by_momentum = -(second + 2j * momentum - kept[2].centre - volume * push)
    assert force(parts[2].state, push) == pytest.approx(by_momentum, abs=1e-6)


def test_damping_takes_short_waves_alone() -> None:
    u = 2.0 * np.pi * np.arange(96) / 96
    for waves_round, least, most in ((2, 0.999999, 1.0), (31, 0.0, 0.1)):
        state = still(0.3, 96).state
        state[:96] += 1e-8 * np.cos(waves_round * u)
        change = rates(state, 0j, 4.0)[:96] - rates(state, 0j)[:96]
        share = 2.0 * np.mean(change * np.cos(waves_round * u)) / 1e-8
        assert math.exp(share) >= least and math.exp(share) <= most


def test_a_wave_that_breaks_says_so() -> None:
    """Hit so hard that the crest overturns: 64 nodes lose liquid before it does."""
    u = 2.0 * np.pi * np.arange(64) / 64
    hit = Surface(still(0.1, 64).height, 0.2 * np.sin(u))
    with pytest.raises(ArithmeticError, match="the wave breaks"):
        advance(hit, 6.0)


@pytest.mark.parametrize("count", [14, 17])
def test_bad_nodes(count: int) -> None:
    with pytest.raises(InputError, match="height"):
        still(0.1, count)


def test_bad_layer() -> None:
    with pytest.raises(InputError, match="layer"):
        still(1.0, 32)
