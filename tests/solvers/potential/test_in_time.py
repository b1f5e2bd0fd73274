"""The exact wave driven through time: steady waves come back, what is kept is kept, an end is told."""

from __future__ import annotations

import cmath
import math
from itertools import pairwise

import numpy as np
import pytest

from fluid import whirl
from fluid.fill import Fill
from fluid.liquid import Liquid
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.liquid_model import Whirl, grown
from solvers.potential.in_time import (
    Steps,
    Watch,
    WaveState,
    advance,
    carried,
    course,
    judged,
    watched,
)
from solvers.potential.steady import free
from solvers.potential.unsteady import Surface, force, invariants, node_angles, rates, started, still
from tests.mutants import kills
from tests.oracles.exact import force_with_friction
from tests.solvers.potential.test_unsteady import waved

# --- steps ---


def test_free_waves_of_both_families() -> None:
    """A tall one, a fifth above the layer, back after a turn, ahead of the drum and behind it."""
    wave = free(0.3, 1.2)
    for slip in wave.slip_speeds():
        begin = started(wave, slip, 256)
        end = advance(begin, 2.0 * math.pi / abs(slip), steps=Steps(256, 256)).surface
        np.testing.assert_allclose(end.height, begin.height, atol=1e-10)


@pytest.mark.slow
def test_free_wave_of_five_turns() -> None:
    """512 nodes carry it to the end of its spectrum, and steps of 1e-10 to some 1e-11."""
    wave = free(0.3, 1.2)
    for slip in wave.slip_speeds():
        begin = started(wave, slip, 512)
        end = advance(begin, 10.0 * math.pi / abs(slip), steps=Steps(512, 512))
        assert end.state is WaveState.RESOLVED
        np.testing.assert_allclose(end.surface.height, begin.height, atol=1e-10)


def test_what_is_kept() -> None:
    """Without a force, for a motion of no symmetry: volume, energy and angular momentum, over three turns."""
    begin = waved(0.3)
    end = advance(begin, 20.0, steps=Steps(128, 128))
    first, last = invariants(begin.state), invariants(end.surface.state)
    assert np.abs(end.surface.height[::2] - begin.height).max() > 1e-2
    # 500 steps of 1e-13.
    for name in ("volume", "energy", "angular_momentum"):
        assert getattr(last, name) == pytest.approx(getattr(first, name), abs=2e-12), name
    assert end.extremes.drift < 5e-12 and end.state is WaveState.RESOLVED


def test_nodes_converge_and_double_by_themselves() -> None:
    """With the end of the spectrum: 64 nodes to 1e-7, 128 to that of the steps; doubling goes there too."""
    ends = {n: advance(waved(0.3), 20.0, steps=Steps(n, n)) for n in (64, 128, 256)}
    finest = ends[256].surface
    off = [np.abs(ends[n].surface.height[:: n // 64] - finest.height[::4]).max() for n in (64, 128)]
    assert 1e-9 < off[0] < 1e-6 and off[1] < 2e-10
    # 64 nodes cannot say that they carry it.
    assert [ends[n].state for n in (64, 128)] == [WaveState.SHORT_WAVES, WaveState.RESOLVED]
    doubled = advance(waved(0.3), 20.0, steps=Steps(64, 256))
    assert doubled.surface.height.size > 64 and doubled.state is WaveState.RESOLVED
    # Doubled when the tail was 1e-8 of the largest wave.
    step = doubled.surface.height.size // 64
    assert np.abs(doubled.surface.height[::step] - finest.height[::4]).max() < 1e-9


def test_doubling_leaves_a_resolved_wave_as_it_was() -> None:
    """Where the spectrum ends at rounding so many nodes and twice as many go the same way."""
    begin = waved(0.3, 128)
    plain, twice = (advance(begin, 1.0, steps=Steps(n, n)).surface for n in (128, 256))
    np.testing.assert_allclose(twice.height[::2], plain.height, atol=1e-13)
    np.testing.assert_allclose(twice.potential[::2], plain.potential, atol=1e-13)


def test_moments_within_steps() -> None:
    """What is taken from within a step is that of a step which ends there."""
    times = np.array([0.3, 0.31, 2.0])
    found = list(course(waved(0.3), times, steps=Steps(128, 128)))
    assert [moment.time for moment in found] == times.tolist()
    for moment in found:
        alone = advance(waved(0.3), moment.time, steps=Steps(128, 128)).surface
        # The formula within is of seventh order, a step 0.26 long.
        np.testing.assert_allclose(moment.surface.height, alone.height, atol=1e-9)


# --- what acts ---


@kills("solvers.potential.in_time:carried", "-math.sin(time)", "math.sin(time)")
def test_gravity_across_the_axis() -> None:
    """Seen in space the centre of mass stands opposite to it: c/g = -a^2/2 of small waves."""
    gravity, ramp, turns = 0.005, 60.0, 4
    push = carried(lambda time: -gravity * float(grown(time, ramp)))
    times = ramp + 2.0 * np.pi * turns * (np.arange(64) + 1.0) / 64
    moments = course(still(0.1, 32), times, push, Steps(32, 64))
    kept = [(moment.time, invariants(moment.surface.state)) for moment in moments]
    mean = np.mean([at.centre / at.volume * cmath.exp(1j * time) for time, at in kept]) / gravity
    # The free waves that the ramp has stirred are 6e-4 of it, over not quite whole turns of theirs.
    assert mean == pytest.approx(-0.405, abs=5e-4)


@kills("solvers.potential.in_time:_changes", "steps.friction)", "0.0)")
def test_a_small_whirl_with_friction_pulls_as_the_linear_theory_says() -> None:
    """The drum's hold on the liquid included; what the ramp has stirred dies as the slower free wave does."""
    layer, rate, size, stop = 0.1, 0.3, 1e-6, 100.0
    square = (1.0 - layer) ** 2
    tanh = (1.0 - square) / (1.0 + square)
    slowest = min(complex(slip).imag for slip in whirl.damped_waves(tanh, 1.0, rate))
    for ratio in (1.3, 0.75):

        def push(time: float, ratio: float = ratio) -> complex:
            return size * ratio**2 * float(grown(time, 20.0)) * cmath.exp(1j * (ratio - 1.0) * time)

        end = advance(still(layer, 32), stop, push, Steps(32, 32, friction=rate)).surface
        found = force(end.state, push(stop), rate) / (math.pi * push(stop))
        wanted = complex(force_with_friction(tanh, 1.0, ratio, rate))
        assert found == pytest.approx(wanted, abs=math.exp(-slowest * (stop - 20.0)))
        assert abs(found - wanted) < 1e-3


@pytest.mark.slow
@kills("solvers.potential.in_time:carried", "-acceleration(time)", "acceleration(time)")
def test_changing_spin() -> None:
    """Long waves in the drum itself, which gains 40 % of its speed, against the exact ones in a steady frame.

    Long waves let the liquid that lags behind its drum turn as 1/r and not as r: their error goes with the
    depth, and that without a change of the spin with its square.
    """
    from solvers.pypde.grid import circle
    from solvers.pypde.long_wave import AnnularLongWavePDE

    stop, rate, ratio, ramp, off = 20.0, 0.02, 1.3, 8.0, []
    for layer in (0.025, 0.0125):
        size = 0.02 * layer
        fill = Fill(Chamber(1.0, 1.0), Liquid("water", 1000.0, 1e-6), math.pi * layer * (2.0 - layer))
        motion = Whirl(1.0, ratio, size, ramp)
        equation = AnnularLongWavePDE(fill, motion, dispersion=True, spin_rate=rate)
        state = equation.start(circle(256))
        options = {"method": "RK45", "rtol": 1e-6, "atol": 1e-9 * layer}
        state = equation.solve(state, stop, solver="scipy", tracker=None, **options)
        by_long_waves = equation.offset(state) * cmath.exp(1j * (1.0 + 0.5 * rate * stop) * stop)

        def acceleration(time: float, size: float = size) -> complex:
            return -size * ratio**2 * float(grown(time, ramp)) * cmath.exp(1j * ratio * time)

        end = advance(still(layer, 32), stop, carried(acceleration), Steps(32, 128))
        kept = invariants(end.surface.state)
        off.append(abs(by_long_waves / (kept.centre / kept.volume * cmath.exp(1j * stop)) - 1.0))
    assert off[0] < 0.2 * 0.025 and off[1] < 0.2 * 0.0125


# --- what is told ---


@kills("solvers.potential.in_time:_crest_number", "opened * moved", "0.9 * opened * moved")
@kills("solvers.potential.in_time:_crest_number", "radius * radius * speed", "radius * speed")
def test_crest_number() -> None:
    """Of a steady wave it is 1 - q/r, q the speed at its crest seen from it; off the nodes as on them."""
    wave = free(0.3, 1.2)
    volume = math.pi * 0.3 * 1.7
    for slip in wave.slip_speeds():
        begin = started(wave, slip, 256)
        wanted = 1.0 - wave.crest_speed / (1.0 - 0.3 * wave.crest)
        for surface in (begin, advance(begin, 0.37, steps=Steps(256, 256)).surface):
            found = watched(surface.state, rates(surface.state, 0j), volume)
            # The spectrum on these nodes ends at 5e-8 of its largest wave.
            assert found.crest_number == pytest.approx(wanted, abs=5e-8)
            # A node is within half a step of the crest, which falls off as 0.2 u^2/2 there.
            assert found.crest == pytest.approx(0.36, abs=2e-5) and found.drift < 1e-11
    # Where there is no crest to speak of there is no number.
    assert watched(still(0.3, 32).state, np.zeros(64), volume).crest_number == 0.0


@kills("solvers.potential.in_time:_crest_number", "closing * y", "0.0 * y")
def test_crest_number_of_a_wave_that_changes() -> None:
    """The speed of its crest by where it was before and after, the liquid's by the slope of the potential."""
    step, places, u = 1e-3, [], 2.0 * np.pi * np.arange(256) / 256
    begin = Surface(still(0.3, 256).height * (1.0 + 0.15 * np.cos(u)), 0.03 * np.sin(u - 0.4))
    for time in (1.0, 1.0 + step, 1.0 + 2.0 * step):
        surface = advance(begin, time, steps=Steps(256, 256)).surface
        near = np.arange(-3, 4) + int(np.argmax(surface.height))
        angle = np.unwrap(node_angles(surface.state)[near % 256])
        middle = angle[3]
        height = np.polynomial.Polynomial.fit(angle - middle, surface.height[near % 256], 6)
        potential = np.polynomial.Polynomial.fit(angle - middle, surface.potential[near % 256], 6)
        top = min((root.real for root in height.deriv().roots()), key=abs)
        places.append((middle + top, potential.deriv()(top) * math.exp(2.0 * height(top)), surface))
    crest = (places[2][0] - places[0][0]) / (2.0 * step)
    _, liquid, surface = places[1]
    found = watched(surface.state, rates(surface.state, 0j), invariants(begin.state).volume).crest_number
    # Differences of second order in 1e-3, of rates of a few per unit of time.
    assert found == pytest.approx(abs(liquid / crest), rel=1e-5) and found > 0.05


def test_slope() -> None:
    """The surface of a wave of one crest in a thin layer rises by dr/(r dx), to the wave's steepness."""
    u = 2.0 * np.pi * np.arange(64) / 64
    state = np.concatenate((0.05 + 1e-3 * np.cos(u), np.zeros(64)))
    wanted = 1e-3 / math.tanh(0.05) * 0.05
    found = watched(state, np.zeros(128), math.pi * (1.0 - math.exp(-0.1))).slope
    # The angle opens by k coth kK of the height: 2 %.
    assert found == pytest.approx(wanted, rel=0.03)


QUIET = Watch(crest=0.1, trough=0.1, crest_number=0.3, slope=0.1, drift=1e-12, tail=1e-9)


@pytest.mark.parametrize(
    ("seen", "nodes", "state"),
    [
        ({}, 128, WaveState.RESOLVED),
        # However full the spectrum is: a crest that is slow does not break.
        ({"tail": 1e-2}, 2048, WaveState.SHORT_WAVES),
        ({"crest_number": 0.7}, 2048, WaveState.RESOLVED),
        # More nodes may carry it yet.
        ({"crest_number": 0.7, "tail": 1e-2}, 512, WaveState.SHORT_WAVES),
        ({"crest_number": 0.7, "tail": 1e-2}, 2048, WaveState.BROKEN),
        ({"slope": 1.6}, 128, WaveState.BROKEN),
        ({"drift": 1e-5}, 128, WaveState.BROKEN),
        ({"drift": math.nan}, 128, WaveState.BROKEN),
    ],
)
def test_states(seen: dict[str, float], nodes: int, state: WaveState) -> None:
    found, reason = judged(Watch(**{**vars(QUIET), **seen}), nodes, 2048)
    assert found is state and bool(reason) == (state is WaveState.BROKEN)


def test_a_crest_may_be_followed_beyond_its_breaking() -> None:
    """Until it overhangs or loses volume, which no number lifts."""
    seen = {**vars(QUIET), "crest_number": 0.9, "tail": 1e-2}
    assert judged(Watch(**seen), 2048, 2048)[0] is WaveState.BROKEN
    assert judged(Watch(**seen), 2048, 2048, math.inf)[0] is WaveState.SHORT_WAVES
    for key, value in (("slope", 1.6), ("drift", 1e-5)):
        assert judged(Watch(**{**seen, key: value}), 2048, 2048, math.inf)[0] is WaveState.BROKEN
    with pytest.raises(InputError, match="breaking"):
        Steps(breaking=0.0)


def test_a_wave_that_breaks_says_so() -> None:
    """Hit so hard that the crest overturns; with more nodes no earlier, and never without a reason."""
    u = 2.0 * np.pi * np.arange(64) / 64
    hit = Surface(still(0.1, 64).height, 0.2 * np.sin(u))
    found = [advance(hit, 6.0, steps=Steps(64, most)) for most in (64, 512)]
    for moment in found:
        assert moment.state is WaveState.BROKEN and moment.reason and moment.time < 6.0
        assert np.isfinite(moment.surface.state).all()
    assert [a.time <= b.time for a, b in pairwise(found)] == [True]


def test_rest_is_resolved() -> None:
    """The spectrum of a layer at rest is rounding, and no reason for more nodes."""
    end = advance(still(0.1, 32), 3.0, steps=Steps(32))
    assert end.state is WaveState.RESOLVED and end.surface.height.size == 32


def test_short_waves_die_by_damping() -> None:
    u = 2.0 * np.pi * np.arange(64) / 64
    rippled = Surface(still(0.3, 64).height + 1e-4 * np.cos(20.0 * u), np.zeros(64))
    plain, damped = (advance(rippled, 30.0, steps=Steps(64, 64, damping)) for damping in (0.0, 3.0))
    assert plain.state is WaveState.SHORT_WAVES and damped.state is WaveState.RESOLVED


@pytest.mark.parametrize(
    ("field", "given"),
    [
        ("nodes", {"nodes": 15}),
        ("nodes", {"nodes": 14}),
        ("most", {"most": 64}),
        ("damping", {"damping": -1.0}),
    ],
)
def test_bad_steps(field: str, given: dict[str, float]) -> None:
    with pytest.raises(InputError, match=field):
        Steps(**given)  # type: ignore[arg-type]
