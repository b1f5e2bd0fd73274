"""What a motion is judged to be by its turns, on motions that are written down."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.liquid import Liquid
from meshes.arrays import Array
from meshes.chamber import Chamber
from solvers.held.convergence import _NUDGE, _PROBED, Watch, _limit, _Probe
from solvers.held.integrate import start
from solvers.held.state import HeldKind, HeldMachine, HoldNumerics, Moment, PeriodicMotion
from solvers.rotor.jeffcott import Jeffcott
from solvers.runup.state import WORKS
from tests.mutants import kills

SPIN, SIZE, NUMERICS = 100.0, 1e-3, HoldNumerics(cells=8)


def watch(slowest: float) -> Watch:
    """A planar rotor with one layer, whose slowest motion changes by so much in a turn."""
    fill = Fill(Chamber(0.065, 0.02), Liquid("water", 1000.0, 1e-6), 1e-5)
    machine = HeldMachine(Jeffcott(4.0, 4e4, 40.0, 6e-4).system(), (fill,))
    return Watch(machine, start(machine, SPIN, NUMERICS), NUMERICS, slowest * SPIN / (2.0 * np.pi))


def turns(found: Watch, count: int, lag: float) -> None:
    """So many turns on a circle, each of which ends by a lag behind the one before."""
    for k in range(count):
        place = SIZE * np.exp(-1j * lag * (k + 1))
        found.rows.append(np.array([[0.0, 0.0, place.real, place.imag, 0.0, 0.0]] * 2))
        found.sizes.append((SIZE, SIZE, SIZE))
    found.count = count


@kills("solvers.held.convergence:Watch._bounded", "wobble <= self", "wobble < -self")
@kills("solvers.held.convergence:Watch._elsewhere", "ends[1] - ends[0]", "ends[1]")
def test_what_repeats_is_no_limit_cycle() -> None:
    """A circle that ends where it began waits for its whirl to have grown; one that does not is a whirl."""
    for lag, bounded in ((0.0, False), (0.7, True)):
        found = watch(0.01)
        turns(found, 2 * found.window, lag)
        sizes = np.array(found.sizes)
        assert found._bounded(sizes, SIZE) is bounded


@kills("solvers.held.convergence:Watch._bounded", "self.slowest >= 0.0", "False")
def test_a_whirl_below_the_tolerance_is_none() -> None:
    """Where small motions decay, if it stays as it is: then the motion repeats, within the tolerance."""
    for slowest, rate, repeats in ((-0.01, 0.0, True), (-0.01, 0.01, False), (0.01, 0.0, False)):
        found = watch(slowest)
        turns(found, 2 * found.window, 0.0)
        k = np.arange(2 * found.window)
        beat = 0.3 * NUMERICS.tolerance * SIZE * np.exp(rate * (k - k[-1])) * np.cos(0.7 * k)
        sizes = np.stack([SIZE + beat] * 3, axis=1)
        assert found._bounded(sizes, SIZE) is repeats


@kills("solvers.held.convergence:Watch._bounded", "swings[0] - swings[1]", "0.0")
def test_a_small_whirl_that_still_grows_is_no_cycle_yet() -> None:
    """Its swing is 1e-3 of the amplitude, so that the extremes of two windows look alike within 2 %."""
    for rate, bounded in ((0.0, True), (0.01, False)):
        found = watch(0.01)
        turns(found, 2 * found.window, 0.7)
        k = np.arange(2 * found.window)
        swing = 1e-3 * SIZE * np.exp(rate * (k - k[-1]))
        beat = swing * np.cos(0.7 * k)
        sizes = np.stack([SIZE + beat, SIZE + beat - 0.1 * swing, SIZE + beat + 0.1 * swing], axis=1)
        assert found._bounded(sizes, SIZE) is bounded


@kills("solvers.held.convergence:Watch._left", "self.slowest * self.count <", "0.0 <")
def test_a_whirl_that_has_had_its_time() -> None:
    """Linear growth of more than e^8 that moves nothing: the motion is settled, by a circle or by a whirl."""
    for lag, kind in ((0.0, HeldKind.PERIODIC), (0.7, HeldKind.LIMIT_CYCLE)):
        found = watch(0.2)
        turns(found, 39, lag)
        assert not found._judge()
        turns(found, 41, lag)
        assert found._judge()
        assert found.kind is (HeldKind.STEADY if kind is HeldKind.PERIODIC else kind)


@kills("solvers.held.convergence:Watch._died", "return late <= ", "return late < 0.0 * ")
def test_a_whirl_that_decays_against_linear_theory_has_died() -> None:
    """A beat of a millionth of the amplitude that falls to e^-4 of it in a window; one that stays has not."""
    for rate, died in ((-4.0, True), (0.0, False)):
        found = watch(0.01)
        k = np.arange(2 * found.window)
        beat = 1e-6 * SIZE * np.exp(rate * k / found.window) * np.cos(0.7 * k)
        assert found._died(np.stack([SIZE + beat] * 3, axis=1), SIZE) is died


def marks(modes: int, count: int = 10) -> tuple[list[Array], Array]:
    """States of a linear motion at the ends of turns, and where it is bound for."""
    rng = np.random.default_rng(4)
    cells = 16
    end = rng.uniform(0.5, 1.0, (6, cells))
    end[2:] = end[2:, :1]
    shapes = rng.normal(0.0, 0.05, (modes, 6, cells))
    shapes[:, 0] -= shapes[:, 0].mean(axis=1, keepdims=True)
    shapes[:, 2:] = shapes[:, 2:, :1]
    share = np.array([0.9, -0.7, 0.5, 0.3])[:modes]
    return [end + np.tensordot(share**k, shapes, axes=1) for k in range(count)], end


@kills("solvers.held.convergence:_limit", "states[0] + ", "states[1] + ")
@kills("solvers.held.convergence:_limit", "np.diff(states[:-1], axis=0)", "np.diff(states[1:], axis=0)")
@pytest.mark.parametrize("modes", [1, 2, 4])
def test_where_a_linear_motion_is_bound_for(modes: int) -> None:
    """Reduced rank extrapolation is exact for fewer modes than marks; no liquid is lost."""
    states, end = marks(modes)
    found = _limit(states, 2)
    assert found is not None
    # Singular values below 1e-3 of the largest count as noise: what is left out is below that of the way.
    way = np.abs(states[0] - end).max()
    assert np.abs(found - end).max() < 1e-2 * way
    assert found[0].sum() == pytest.approx(end[0].sum(), rel=1e-12)


def nudged(share: float) -> tuple[Watch, SimpleNamespace, bool]:
    """A guessed orbit, and whether that is enough, after a nudge that changes by a share in a turn."""
    found = watch(-0.05)
    turns(found, 2, 0.0)
    end = np.array([*found.rows[-1][-1, 2:], 1.0, 1.0, 1.0, 1.0])
    pushed = SimpleNamespace(data=np.full((6, 8), 2.0))
    found.probe = _Probe(np.full((6, 8), 1.0), end, list(found.rows), list(found.sizes), HeldKind.PERIODIC)
    enough = False
    for k in range(_PROBED):
        row = found.rows[0].copy()
        row[-1, 2:] = end[:4] + _NUDGE * share**k
        found.rows.append(row)
        enough = found._probed(pushed)
    return found, pushed, enough


@kills("solvers.held.convergence:Watch._probed", "late > soon * _SURE and", "late < soon and")
def test_a_guessed_orbit_that_is_left() -> None:
    """A nudge that grows leaves the orbit for good: the motion goes on by itself, without guesses."""
    found, pushed, enough = nudged(1.05)
    assert not enough
    assert found.probe is None
    assert found.kind is HeldKind.NOT_SETTLED
    assert found.slowest == 0.0
    assert (pushed.data == 2.0).all()


@kills("solvers.held.convergence:Watch._probed", "state.data[...] = probe.state", "pass")
def test_a_guessed_orbit_that_is_kept() -> None:
    """A nudge that dies leads back to the orbit."""
    found, pushed, enough = nudged(0.8)
    assert enough
    assert found.kind is HeldKind.PERIODIC
    assert (pushed.data == 1.0).all()


@kills("solvers.held.convergence:Watch._balance", "self.balances[-turns:]", "self.balances")
@kills("solvers.held.convergence:Watch._balance", 'max(known["bores"], 0.0)', 'known["bores"]')
@kills("solvers.held.convergence:Watch._balance", "max(audit.scale, ", "max(")
@kills("solvers.held.convergence:Watch._balance", "_ROUNDING * turning", "0.0 * turning")
@kills("solvers.held.convergence:Watch._beyond", "size <= wall", "size >= 0.0")
def test_the_balance_of_the_last_turns() -> None:
    """What comes in goes out: gaps, heats below zero and deflections beyond the wall are violations."""
    found = watch(-0.1)
    assert found._balance(2, np.zeros((2, 6))) == {}
    rest = np.array([[0.0, 0.0, SIZE, 0.0, 0.0, 0.0]] * 2)

    def told(**known: float) -> tuple[float, tuple[str, ...]]:
        """Energy error and violations of two such turns, after one that does not count."""
        one = np.array([known.get(name, 0.0) for name in (*WORKS, "change")])
        found.balances = [np.full(one.size, 7.0), one, one]
        answer = found._balance(2, rest)
        return answer["energy_error"], answer["faults"]

    assert told(drive=3.0, support=1.0, friction=1.0, bores=0.5, change=0.5) == (0.0, ())
    # Two of 50 parts are left: within what may be.
    assert told(unbalance=50.0, support=48.0) == (pytest.approx(0.04), ())
    assert told(unbalance=50.0, support=40.0)[0] == pytest.approx(0.2)
    assert "leaves 20 J" in told(unbalance=50.0, support=40.0)[1][0]
    # What the scheme gives is no heat of bores, and is left.
    assert told(drive=1.0, friction=1.5, bores=-0.5)[0] == pytest.approx(0.5 / 1.5)
    assert "supports" in told(unbalance=1.0, friction=1.1, support=-0.1)[1][0]
    # Where nothing moves rounding is no energy.
    error, faults = told(drive=1e-31, change=-1e-31)
    assert error < 1e-12 and faults == ()
    assert found._beyond(rest) == []
    assert "chamber 1" in "; ".join(found._beyond(rest * 0.066 / SIZE))


@kills("solvers.held.convergence:Watch._decays", "falls > _SLOWER * each", "falls > 0.0 * each")
@kills("solvers.held.convergence:Watch._decays", "falls < _FASTER * each", "falls < -1e3")
def test_what_decays_to_an_orbit() -> None:
    """A distance that falls as the multiplier says; not one that falls faster, or that comes to a stop."""
    place, size = np.array([SIZE, 0.0]), 0.99
    moment = Moment(SPIN, place, np.zeros(2), np.zeros((1, 8)), np.zeros((1, 8)), np.ones(1, dtype=bool))
    orbit = PeriodicMotion(moment, None, np.array([size]), 1)
    state = SimpleNamespace(data=np.zeros((6, 8)))
    for rate, stays, decays in ((size, 0.0, True), (0.97, 0.0, False), (size, 1.0, False)):
        found = watch(0.0)
        found.near = lambda _: orbit
        turns(found, 64, 0.0)
        gap = 0.1 * SIZE * (rate ** np.arange(64) + stays) * np.exp(0.7j * np.arange(64))
        ends = SIZE + gap
        found.rows = [np.array([[0.0, 0.0, end.real, end.imag, 0.0, 0.0]] * 2) for end in ends]
        found.sizes = [(SIZE, SIZE - abs(each), SIZE + abs(each)) for each in gap]
        assert found._decays(state) is decays
        assert (found.orbit is orbit) is decays
