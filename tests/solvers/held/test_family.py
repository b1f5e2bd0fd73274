"""KdV-Burgers held in time: limit cycles, growth, what stands in the drum, gravity, chambers, refusals."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.friction.laws import Friction
from meshes.errors import InputError
from solvers.cycles.balance import circular
from solvers.cycles.branch import Cycle, Follower
from solvers.cycles.family import FamilyWave, disturbances
from solvers.held.convergence import Watch
from solvers.held.family import FamilyMachine, Frozen, _solved, again, begin, march, overdamped
from solvers.held.integrate import hold, start
from solvers.held.state import HeldKind, HeldMachine, HeldState, HoldNumerics
from solvers.layer.records import Outcome
from solvers.rotor.jeffcott import Jeffcott
from solvers.synchronous.response import response
from solvers.waves.modes import joined
from solvers.whirl.growth import asynchronous_growth
from tests.mutants import kills
from tests.solvers.cycles.test_cycles import FRICTION, MU
from tests.solvers.held.test_integrate import RIG, SMALL
from tests.solvers.whirl.test_growth import NATURAL, RADIUS, machine
from validation.cases.liquid.kdv import offset_share

FAMILY = "solvers.held.family:FamilyMachine"
RIDES = np.array([True])


def held(
    rotor: Jeffcott, fill: Fill, spin: float, friction: Friction, kick: float = 0.0, gravity: float = 0.0,
    cells: int = 32, liquid: str = "kdv",
) -> HeldState:  # fmt: skip
    """A planar rotor from its synchronous motion."""
    of, numerics = HeldMachine(rotor.system(), (fill,), friction, gravity, liquid), HoldNumerics(cells=cells)
    steady = response(rotor, [fill], [spin], 0.0).coordinates[0]
    growth = float(asynchronous_growth(rotor, [fill], np.array([spin]), friction)[0][0])
    return hold(of, start(of, spin, numerics, steady, kick), numerics, growth)


@cache
def cycle() -> tuple[Cycle, Follower]:
    """A limit cycle as the branch of KdV-Burgers has it."""
    rotor, fill = machine(MU, 0.1, 0.02)
    pair = circular(rotor.system(), [fill], FRICTION)
    follower = Follower(pair, FRICTION, 48, 1.3 * NATURAL, FamilyWave)
    found = follower.start(np.array([1.0 + 0.0j]), 0.95 * NATURAL, 1.3 * NATURAL, 0.5, 0.22 * NATURAL)
    assert found is not None
    return found, follower


@kills(f"{FAMILY}._linear", "1j * (n * each", "1j * (-n * each")
@kills(f"{FAMILY}.rates", "+ 2j * change", "+ 1j * change")
@kills(f"{FAMILY}.rates", "slower - np.imag", "slower + np.imag")
@kills(f"{FAMILY}.rates", "linear[1] + self.far_decay", "linear[0][:, 0] + self.far_decay")
@kills("solvers.cycles.family:FamilyWave.rates", "posed.other_decay * np.eye(2)", "0.0 * np.eye(2)")
@kills("solvers.cycles.family:FamilyWave.rates", "posed.system.problem.decay * np.eye", "0.0 * np.eye")
@kills("solvers.cycles.family:FamilyWave.rates", "-slope / inertia", "0.5 * -slope / inertia")
@kills("solvers.cycles.family:FamilyWave.rates", "= change", "= 0.8 * change")
@kills("solvers.cycles.family:disturbances", "+ around @ offset", "+ 0.9 * around @ offset")
def test_a_limit_cycle_is_at_rest_in_its_frame_and_disturbed_as_its_branch_says() -> None:
    """The equations as they stand: derivatives of them have the rates of the disturbances."""
    limit, follower = cycle()
    rotor, fill = machine(MU, 0.1, 0.02)
    wave, state = follower.waves[0], limit.state[0]
    assert isinstance(wave, FamilyWave)
    posed = wave.posed(state, limit.given[0])
    assert posed is not None
    own = FamilyMachine(HeldMachine(rotor.system(), (fill,), FRICTION, 0.0, "kdv"), limit.spin, RIDES, 48)
    size, ratio, m = abs(limit.moved[0] * follower.machine.places[0].row[0]), limit.given[0].ratio, wave.modes
    lag, slip = float(state[-1]) / wave.mean, ratio - 1.0
    offset = 0.9 / 0.095 * complex(posed.first).conjugate()
    moving = 1j * ratio * (size * (rotor.mass + fill.mass) + fill.mass * RADIUS * offset)
    plane = size, 0.0, moving.real, moving.imag
    at = np.array([*joined(state[:-1]), posed.other, lag, *plane], dtype=complex)
    diffusion = np.array([posed.system.problem.diffusion])
    frozen = Frozen(np.array([lag]), own.wall(np.array([lag])), diffusion)

    def seen(there: np.ndarray) -> np.ndarray:
        """Rates in the whirl's frame."""
        found, _ = own.rates(0.0, there, frozen)
        found[:m] += 1j * np.arange(1, m + 1) * slip * there[:m]
        found[m] += 1j * slip * there[m]
        for k in (m + 2, m + 4):
            x, y = there[k : k + 2]
            found[k : k + 2] -= ratio * np.array([-y, x])
        return found

    # Newton's method left 1e-6 of the mean area in modes whose rates go up to m times the slip.
    left, unit = np.abs(seen(at)), np.abs(at).copy()
    unit[m + 2 : m + 4], unit[m + 4 :] = size, abs(moving)
    unit[: m + 2] = np.abs(at[: m + 2]).max()
    assert (left / unit).max() < 1e-4
    assert abs(complex(own.rates(0.0, at, frozen)[1][0]) - ratio**2 * size / RADIUS) < 1e-4 * size / RADIUS
    kept = [*range(m + 1), *range(at.size, at.size + m + 1), *range(m + 1, at.size)]
    columns, step = [], 1e-6

    def real(values: np.ndarray) -> np.ndarray:
        return np.concatenate((values.real, values.imag))[kept]

    for k in kept:
        moved = at.copy()
        scale = step * float(unit[k % at.size])
        moved[k % at.size] += scale * (1.0 if k < at.size else 1j)
        columns.append(real(seen(moved) - seen(at)) / scale)
    found = np.linalg.eigvals(np.array(columns).T) * limit.spin
    waves = [one for one in follower.waves if isinstance(one, FamilyWave)]
    for rate in disturbances(follower.machine, waves, limit):
        if rate.real > -0.3 * NATURAL:
            assert np.abs(found - rate).min() < 0.02


def test_a_kick_ends_in_the_limit_cycle_and_the_torques_close() -> None:
    """Amplitude, speed, lag."""
    limit, follower = cycle()
    rotor, fill = machine(MU, 0.1, 0.02)
    found = held(rotor, fill, 1.3 * NATURAL, FRICTION, kick=0.4, cells=48)
    size = abs(limit.moved[0] * follower.machine.places[0].row[0])
    spin = 1.3 * NATURAL
    assert found.kind is HeldKind.LIMIT_CYCLE
    assert limit.spin == pytest.approx(spin)
    assert found.amplitude / size == pytest.approx(1.0, rel=1e-4)
    assert found.whirl_speed == pytest.approx(limit.whirl_speed, rel=1e-4)
    assert found.mean_rotation[0] == pytest.approx(limit.turning[0], rel=2e-3)
    # Rotor and long waves marched in time: 2 to 3 % off, as the branch is.
    assert found.amplitude / fill.depth == pytest.approx(0.5664, rel=0.03)
    assert -found.mean_rotation[0] / NATURAL == pytest.approx(0.2306, rel=0.03)
    # The torque of the wall is the whirl's, which the supports take: each heat is above zero.
    own = FamilyMachine(HeldMachine(rotor.system(), (fill,), FRICTION, 0.0, "kdv"), spin, RIDES, 32)
    lag = -found.mean_rotation / spin
    torque = float(own.wall(lag)[0] * lag[0]) * fill.mass * (RADIUS * spin) ** 2
    support = rotor.damping * (found.whirl_speed * found.amplitude) ** 2
    assert support == pytest.approx(torque * found.whirl_speed, rel=0.01)
    rubbed, waves = torque * lag[0] * spin, torque * (spin * (1.0 - lag[0]) - found.whirl_speed)
    assert min(support, rubbed, waves) > 0.0
    # The equation knows no energy of its waves: no balance is told.
    assert math.isnan(found.heat)
    assert math.isnan(found.energy_error)


@kills(f"{FAMILY}._waves", "self.far_decay * other", "0.0 * other")
@pytest.mark.parametrize(("rate", "part"), [(60.0, 2e-3), (600.0, 1e-2)])
def test_what_stands_in_the_drum_rubs_on_nothing(rate: float, part: float) -> None:
    """Both families together are the exact equilibrium under stiff friction as well.

    Less diffusion and what dispersion changes of the speeds by which friction is shared, which four times
    the spin brings out.
    """
    wanted = response(RIG, [SMALL], [150.0], 0.0)
    found = held(RIG, SMALL, 150.0, Friction("linear", rate), cells=16)
    assert found.kind is not HeldKind.LIMIT_CYCLE
    assert found.amplitude == pytest.approx(abs(wanted.deflection[0]), rel=part)
    assert abs(found.mean_rotation[0]) < 1e-3 * 150.0


@kills("solvers.held.family:begin", "other -= push", "other += push")
def test_steady_waves_of_both_families_stand_in_the_drum() -> None:
    """Without friction the wave against the spin is the steady one of `run`; both are liquid at rest."""
    size, depth = 1e-6, 0.1
    rotor, fill = machine(MU, depth, 0.02)
    of = HeldMachine(rotor.system(), (fill,), Friction(), 0.0, "kdv")
    own = FamilyMachine(of, 130.0, RIDES, 16)
    state = own.rows_of(begin(of, 130.0, 16, np.array([size, -1j * size]), 0.0))
    exact = size / RADIUS / ((1.0 - depth) ** -2 - 1.0)
    near, far = (
        own.lever[0] * part.real / exact for part in (own.parts(state)[0][0, 0], own.parts(state)[1][0])
    )
    assert near == pytest.approx(offset_share(depth, -1), rel=1e-9)
    # Each family goes by its own dispersion of one crest.
    assert near + far == pytest.approx(offset_share(depth, -1) + offset_share(depth, 1), rel=1e-9)
    assert near + far == pytest.approx(1.0, abs=0.01)


@kills(f"{FAMILY}.rates", "- self._springs", "- 1.02 * self._springs")
@pytest.mark.parametrize("ratio", [1.1, 1.2, 1.3])
def test_a_small_whirl_grows_as_linear_theory_says(ratio: float) -> None:
    """In the drum's frame, of rotor, both families and lag."""
    rotor, fill = machine(MU, 0.1, 0.02)
    spin = ratio * NATURAL
    wanted = asynchronous_growth(rotor, [fill], np.array([spin]), FRICTION)[0][0]
    own = FamilyMachine(HeldMachine(rotor.system(), (fill,), FRICTION, 0.0, "kdv"), spin, RIDES, 16)
    m, state = own.modes, np.zeros(own.modes + 6, dtype=complex)
    frozen, columns = own.frozen(state, np.zeros(1)), []
    for k in range(2 * state.size):
        moved = state.copy()
        moved[k % state.size] = 1e-9 * (1.0 if k < state.size else 1j)
        rates = own.rates(0.0, moved, frozen)[0]
        for at in (m + 2, m + 4):
            x, y = moved[at : at + 2]
            rates[at : at + 2] -= [-y, x]
        columns.append(np.concatenate((rates.real, rates.imag)) / 1e-9)
    kept = [*range(m + 1), *range(state.size, state.size + m + 1), *range(m + 1, state.size)]
    found = np.linalg.eigvals(np.array(columns).T[np.ix_(kept, kept)]).real.max() * spin
    assert found == pytest.approx(wanted, rel=0.03)


@kills(f"{FAMILY}.step", "length / 3.0", "length / 4.0")
@kills(f"{FAMILY}.step", "rest(time + length", "rest(time")
def test_steps_are_of_fourth_order() -> None:
    rotor, fill = machine(MU, 0.1, 0.02)
    of = HeldMachine(rotor.system(), (fill,), FRICTION, 9.81, "kdv")
    moment = begin(of, 130.0, 16, np.array([1e-3, -1e-3j]), 0.5)
    own, ends = FamilyMachine(of, 130.0, RIDES, 16), []
    for count in (4, 8, 16):
        state, length = own.rows_of(moment), 1.0 / count
        frozen = own.frozen(state, np.full(1, 0.01))
        for k in range(count):
            state = own.step(k * length, state, frozen, length)[0]
        ends.append(state)
    coarse, fine = (np.abs(end - ends[-1])[: own.modes + 4].max() for end in ends[:2])
    assert 13.0 < coarse / fine < 24.0


def test_gravity_swings_the_liquid_as_long_waves_do() -> None:
    """One more body force on the waves, no force on the rotor at rest: g/(2 Omega^2) of swing."""
    found = held(RIG, SMALL, 150.0, Friction("linear", 3.0), gravity=9.81, cells=16)
    assert found.kind is HeldKind.PERIODIC
    assert found.ripple[0] == pytest.approx(9.81 / 2.0 / 150.0**2, rel=0.05)
    assert np.abs(found.rest).max() < 1e-3 * found.amplitude


def test_two_chambers_as_one_and_liquid_that_does_not_ride() -> None:
    """Halves of a chamber, side by side, move as the whole; what does not ride is a mass."""
    rotor, fill = machine(MU, 0.1, 0.02)
    half = replace(
        fill, chamber=replace(fill.chamber, height=0.5 * fill.chamber.height), volume=0.5 * fill.volume
    )
    pair = [HeldMachine(rotor.system(), fills, FRICTION, 0.0, "kdv") for fills in ((fill,), (half, half))]
    motion, numerics = np.array([1e-3, -1e-3j]), HoldNumerics(cells=32)
    moments = [start(one, 1.3 * NATURAL, numerics, motion) for one in pair]
    own = [
        FamilyMachine(one, 1.3 * NATURAL, moment.layers, 32)
        for one, moment in zip(pair, moments, strict=True)
    ]
    ends = []
    for one, moment in zip(own, moments, strict=True):
        state, sizes = one.rows_of(moment), np.zeros(len(one.fills))
        for k in range(48):
            state, sizes = one.step(k * math.pi / 24.0, state, one.frozen(state, sizes), math.pi / 24.0)
        ends.append(one.parts(state)[3].real)
    np.testing.assert_allclose(ends[1], ends[0], atol=1e-9 * np.abs(ends[0]).max())
    lying = HeldMachine(rotor.system(), (fill,), FRICTION, 9.81, "kdv")
    moment = begin(lying, 5.0, 32, np.zeros(2, dtype=complex), 0.0)
    assert moment.layers.tolist() == [False]
    assert FamilyMachine(lying, 5.0, moment.layers, 32).whole[0, 0] == pytest.approx(rotor.mass + fill.mass)


def test_another_number_of_modes_and_what_it_refuses() -> None:
    rotor, fill = machine(MU, 0.1, 0.02)
    of = HeldMachine(rotor.system(), (fill,), FRICTION, 0.0, "kdv")
    moment = start(of, 130.0, HoldNumerics(cells=64), np.array([1e-3, -1e-3j]), 0.3)
    fewer = again(of, moment, 32)
    assert fewer.area.mean() == pytest.approx(moment.area.mean(), rel=1e-12)
    np.testing.assert_allclose(fewer.area[0], moment.area[0, ::2], rtol=1e-9)
    np.testing.assert_allclose(fewer.rate, moment.rate, rtol=1e-9)
    for changes, field in (({"solver": "euler"}, "solver"), ({"cells": 33}, "cells")):
        with pytest.raises(InputError) as refused:
            hold(of, moment, HoldNumerics(**changes))  # type: ignore[arg-type]
        assert refused.value.field == field


@kills("solvers.held.family:overdamped", "> 1.0", "> 1e9")
@kills("solvers.held.family:_solved", "np.full(right.shape, np.nan)", "np.full(right.shape, 0.0)")
def test_friction_that_stops_waves_is_out_of_range_and_no_fault() -> None:
    """Far beyond any wave the motion is lost and says so; moderate friction is in range."""
    rotor, fill = machine(MU, 0.1, 0.02)
    spin, none = 1.3 * NATURAL, np.zeros(2, dtype=complex)
    of = [
        HeldMachine(rotor.system(), (fill,), Friction("linear", k * spin), 0.0, "kdv") for k in (0.5, 200.0)
    ]
    assert [overdamped(one, spin) for one in of] == [False, True]
    lost = Outcome.FAMILY_LOST
    first, numerics = begin(of[1], spin, 16, none, 0.1), HoldNumerics(cells=16)
    assert march(of[1], first, numerics, Watch(of[1], first, numerics, 0.0))[1] is lost
    assert np.isnan(_solved(np.zeros((2, 2)), np.ones(2))).all()
