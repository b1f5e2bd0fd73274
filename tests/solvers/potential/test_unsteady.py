"""The exact wave in time: steady waves come back, small ones go as fast as they should, budgets close."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest

from fluid import waves
from fluid import whirl as small
from meshes.errors import InputError
from solvers.potential.in_time import Steps, advance
from solvers.potential.steady import forced, linear_detuning
from solvers.potential.unsteady import (
    Push,
    Surface,
    force,
    invariants,
    node_angles,
    rates,
    resampled,
    seen,
    started,
    still,
)
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


@kills("solvers.potential.unsteady:_wall_force", "-change - 0.5", "change - 0.5")
@kills("solvers.potential.unsteady:_wall_force", "1j * flow.waves.odd", "0.9j * flow.waves.odd")
@kills(
    "solvers.potential.unsteady:_wall_force",
    "0.5 * np.square(sliding / opened)",
    "0.4 * np.square(sliding / opened)",
)
@kills("solvers.potential.unsteady:_wall_force", "1.0 / np.sinh(inner[1:-1])", "1.0 / np.tanh(inner[1:-1])")
@kills("solvers.potential.unsteady:_field", "- 2.0 * spin", "- 1.9 * spin")
def test_pressure_and_momentum_give_one_force() -> None:
    """Of a steady wave, along the deflection: no friction, no torque, no phase."""
    for layer, ratio, whirl in FORCED:
        wave = forced(layer, (1.0 - 1.0 / ratio) ** 2, whirl * layer)
        push = abs(wave.whirl) * ratio**2
        ratio_found = force(started(wave, ratio - 1.0, 128).state, complex(push)) / (math.pi * push)
        assert ratio_found == pytest.approx(wave.force_ratio, abs=1e-11)


@kills("solvers.potential.unsteady:_moved", "flow.opened @ slide - flow.steep @ climb", "flow.opened @ slide")
@kills("solvers.potential.unsteady:_moved", "flow.steep * slide + flow.opened", "flow.opened")
@kills("solvers.potential.unsteady:_moved", "0.5 * inner / metric", "0.6 * inner / metric")
@kills("solvers.potential.unsteady:started", "0.5 * slip", "0.4 * slip")
def test_a_steady_wave_stays_with_its_whirl() -> None:
    """After a turn of the whirl round the drum it is where it began, by steps of 1e-12."""
    for layer, ratio, whirl in FORCED[:2]:
        slip, wave = ratio - 1.0, forced(layer, (1.0 - 1.0 / ratio) ** 2, whirl * layer)
        begin, push = started(wave, slip, 128), abs(wave.whirl) * ratio**2
        end = advance(begin, 2.0 * math.pi / abs(slip), turning(push, slip)).surface
        np.testing.assert_allclose(end.height, begin.height, atol=1e-12)
        np.testing.assert_allclose(end.potential, begin.potential, atol=1e-12)


def test_twins() -> None:
    """One shape stands in two whirls, behind the drum and ahead of it: 0.7 and 1.75 times its speed."""
    wave = forced(0.1, (1.0 - 1.0 / 0.7) ** 2, 0.005)
    for ratio in (0.7, 1.75):
        slip, push = ratio - 1.0, abs(wave.whirl) * ratio**2
        begin = started(wave, slip, 128)
        end = advance(begin, 1.0, turning(push, slip)).surface
        found = force(end.state, push * cmath.exp(1j * slip)) / (math.pi * push * cmath.exp(1j * slip))
        assert found == pytest.approx(wave.force_ratio, abs=1e-10)


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
            table.append([2.0 * np.mean(side * shape) for side in change.reshape(2, count) for shape in pair])
    found = np.sort(np.abs(np.linalg.eigvals(np.array(table).T).imag))
    ahead, behind = waves.free_wave_frequencies(crests, -math.log1p(-layer), 1.0)
    wanted = np.sort(np.abs([ahead, ahead, behind, behind]).ravel())
    np.testing.assert_allclose(found, wanted, rtol=1e-8)
    assert linear_detuning(layer, crests) == pytest.approx((wanted[0] / (crests - wanted[0])) ** 2, rel=1e-12)


@kills("solvers.potential.unsteady:invariants", "0.125 * spin**2", "0.12 * spin**2")
@kills("solvers.potential.unsteady:invariants", "turning + 0.25", "turning - 0.25")
@kills("solvers.potential.unsteady:_momentum", "-2.0 * np.pi", "2.0 * np.pi")
@kills("solvers.potential.unsteady:_wall_force", "+ along", "+ 0.5 * along")
def test_budgets() -> None:
    """What a force does to the invariants, and the force by momentum, by central differences in time."""
    step, begin, push = 1e-4, waved(0.3), 0.02 - 0.03j
    parts = [begin]
    for _ in range(4):
        parts.append(advance(parts[-1], step, lambda t: push, Steps(64, 64)).surface)
    kept = [invariants(part.state) for part in parts]
    volume = kept[2].volume
    # Fourth order of 1e-4: rounding of 1e-16/1e-4 is what is left.
    slopes = np.array([1.0, -8.0, 0.0, 8.0, -1.0]) / (12.0 * step)
    centres = np.array([at.centre for at in kept])
    momentum = slopes @ centres
    power = slopes @ np.array([at.energy for at in kept])
    torque = slopes @ np.array([at.angular_momentum for at in kept])
    # The momentum from the potential, and from the centre of mass.
    assert kept[2].momentum == pytest.approx(momentum, abs=1e-10)
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


@kills(
    "solvers.potential.unsteady:_limited",
    "-= friction * flow.potential",
    "-= 0.5 * friction * flow.potential",
)
@pytest.mark.parametrize("layer", [0.1, 0.6])
def test_friction_takes_small_waves_as_the_linear_theory_says(layer: float) -> None:
    """Rates of small y and phi under -k grad phi have its decay and its frequency, at any depth."""
    count, size, rate = 32, 1e-6, 0.2
    rest, u, table = still(layer, count), 2.0 * np.pi * np.arange(count) / count, []
    for part in range(2):
        for wave in (np.cos(u), np.sin(u)):
            bump = np.zeros(2 * count)
            bump[part * count : (part + 1) * count] = size * wave
            ahead, behind = (rates(rest.state + way * bump, 0j, 0.0, rate) for way in (1.0, -1.0))
            change = ((ahead - behind) / (2.0 * size)).reshape(2, count)
            table.append([2.0 * np.mean(side * shape) for side in change for shape in (np.cos(u), np.sin(u))])
    found = np.linalg.eigvals(np.array(table).T)
    square = (1.0 - layer) ** 2
    pair = small.damped_waves((1.0 - square) / (1.0 + square), 1.0, rate)
    # e^{i s t}: a slip's imaginary part is the decay; each wave comes with its conjugate.
    wanted = [1j * complex(slip) for slip in pair]
    for value in wanted:
        assert np.abs(found - value).min() < 1e-8 and np.abs(found - value.conjugate()).min() < 1e-8


@kills("solvers.potential.unsteady:force", "by_pressure + friction", "by_pressure - friction")
def test_the_drum_holds_what_friction_takes() -> None:
    """Pressure and what the drum gives the liquid make Newton's law for it, in a motion of no symmetry."""
    step, begin, push, rate = 1e-4, waved(0.3), 0.02 - 0.03j, 0.3
    parts = [begin]
    for _ in range(4):
        moment = advance(parts[-1], step, lambda t: push, Steps(64, 64, friction=rate))
        parts.append(moment.surface)
    kept = [invariants(part.state) for part in parts]
    slopes = np.array([1.0, -8.0, 0.0, 8.0, -1.0]) / (12.0 * step)
    change = complex(slopes @ np.array([at.momentum for at in kept]))
    middle = kept[2]
    by_momentum = -(change + 2j * middle.momentum - middle.centre - middle.volume * push)
    # Rounding of 1e-16/1e-4, and steps of 1e-13 over as much.
    assert force(parts[2].state, push, rate) == pytest.approx(by_momentum, abs=1e-9)
    energy = slopes @ np.array([at.energy for at in kept])
    turned = slopes @ np.array([at.angular_momentum for at in kept])
    work = (push.conjugate() * middle.momentum).real - 2.0 * rate * middle.kinetic
    twist = (middle.centre.conjugate() * push).imag - rate * middle.turning
    assert (energy, turned) == pytest.approx((work, twist), abs=1e-9)


@kills("solvers.potential.unsteady:resampled", "0.5 if count > n", "1.0 if count > n")
def test_other_nodes_hold_the_same_wave() -> None:
    """On the nodes that were there the same numbers, between them the series, known here; and back again."""

    def shape(count: int) -> np.ndarray:
        u = 2.0 * np.pi * np.arange(count) / count
        return np.concatenate((0.3 + 0.02 * np.cos(3.0 * u + 0.4) + 0.001 * np.cos(16.0 * u), np.sin(u)))

    for count in (32, 64, 96):
        found = resampled(shape(32), count)
        np.testing.assert_allclose(found, shape(count), atol=1e-15)
    np.testing.assert_allclose(resampled(resampled(shape(64), 128), 64), shape(64), atol=1e-15)


@kills("solvers.potential.unsteady:seen", "gap + np.pi, 2.0", "gap + np.pi, 1.0")
@kills("solvers.potential.unsteady:seen", "flow.depth + np.real", "flow.depth - np.real")
def test_radius_at_angles() -> None:
    """At the nodes' own angles the nodes' own radii; round a synchronous circle its closed form."""
    wave = waved(0.3).state
    radius, _ = seen(wave, node_angles(wave) + 4.0 * np.pi)
    np.testing.assert_allclose(radius, np.exp(-wave[:64]), atol=1e-14)
    theta, push = np.linspace(-7.0, 9.0, 40), 0.05
    circle = started(forced(0.1, 0.0, push), 0.0, 128)
    wanted = np.sqrt(0.81 - np.square(push * np.sin(theta))) - push * np.cos(theta)
    np.testing.assert_allclose(seen(circle.state, theta)[0], wanted, atol=1e-12)


@pytest.mark.parametrize("count", [14, 17])
def test_bad_nodes(count: int) -> None:
    with pytest.raises(InputError, match="height"):
        still(0.1, count)


def test_bad_layer() -> None:
    with pytest.raises(InputError, match="layer"):
        still(1.0, 32)
