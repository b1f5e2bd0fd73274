"""Spin programmes against ramps, closed forms of a coasting drum, and an independent integration."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.liquid import Liquid
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.rotor.jeffcott import Jeffcott
from solvers.runup.linear import couple_linear
from solvers.runup.long_wave import couple
from solvers.runup.machine import Ramp, RunupModel
from solvers.runup.programme import FLOOR, Programme, Stage
from solvers.runup.runup import RunupHistory, RunupNumerics, run_up
from tests.mutants import kills

MASS, NATURAL = 30.0, 25.0
ROTOR = Jeffcott(MASS, MASS * NATURAL**2, 2.0 * 0.06 * MASS * NATURAL, 0.1)
STILL = replace(ROTOR, unbalance=0.0)
FILL = Fill(Chamber(0.25, 0.04), Liquid("water", 1000.0, 1e-6), 5e-4)
ALONE = RunupNumerics(cells=64, samples=300, companion=False)


def run(rotor: Jeffcott, drive: Programme | Ramp, *fills: Fill, **changes: object) -> RunupHistory:
    numerics = replace(ALONE, **changes)  # type: ignore[arg-type]
    return run_up(rotor.system(), fills, drive, Friction("linear", 3.0), 0.0, numerics, model=couple_linear)


@kills("solvers.runup.samples:_programme", "(stop - spin) / lasts", "(spin - stop) / lasts")
@kills("solvers.runup.programme:Stage.lasts", "abs(stop - spin) / self.rate", "abs(stop) / self.rate")
def test_a_ramp_and_a_hold_are_a_ramp() -> None:
    """The same speeds in other words, and down again: the same answer to rounding, which 1e4 steps gather."""
    ramp = Ramp(5.0, 60.0, 10.0, 7.0, back=True)
    told = Programme(5.0, (Stage(60.0, 10.0), Stage(duration=1.5), Stage(5.0, duration=5.5)))
    np.testing.assert_allclose(told.corners(), ramp.corners(), rtol=1e-13)
    wanted, found = run(ROTOR, ramp, FILL), run(ROTOR, told, FILL)
    np.testing.assert_allclose(found.time, wanted.time, rtol=1e-12)
    for name in ("speed", "amplitude", "mean_rotation"):
        size = np.abs(getattr(wanted, name)).max()
        np.testing.assert_allclose(getattr(found, name), getattr(wanted, name), rtol=0.0, atol=1e-9 * size)
    assert found.stage is not None
    corners = np.flatnonzero(np.diff(found.stage))
    np.testing.assert_allclose(found.speed[corners], 60.0, rtol=1e-12)
    assert found.stage[-1] == 2


def test_a_drum_that_nothing_brakes_keeps_its_speed() -> None:
    """No drag, liquid or unbalance: to the rounding of a thousand steps, until the time is over."""
    found = run(STILL, Programme(40.0, (Stage(0.0, duration=3.0, free=True),), inertia=0.4))
    np.testing.assert_allclose(found.speed, 40.0, rtol=1e-12)
    assert found.time[-1] == 3.0 and found.converged


@kills("solvers.runup.programme:Programme.drag", "-self.drag_torque - viscous * far", "-self.drag_torque")
@kills("solvers.runup.programme:Programme.drag", "(self.inertia or 0.0) * self.drag_rate", "self.drag_rate")
def test_viscous_drag_is_an_exponential() -> None:
    """Omega = Omega_0 e^(-kt); the midpoint rule's error, (k dt)^2/12 with dt below 0.02 s, is 1e-6."""
    rate = 0.2
    drive = Programme(40.0, (Stage(duration=4.0, free=True),), inertia=0.4, drag_rate=rate)
    found = run(STILL, drive)
    np.testing.assert_allclose(found.speed, 40.0 * np.exp(-rate * found.time), rtol=3e-6)
    kinetic = 0.5 * 0.4 * (found.speed[-1] ** 2 - 40.0**2)
    assert found.audit.motor == pytest.approx(kinetic, rel=1e-6)


@kills("solvers.runup.programme:Programme._coast", "steady + rate * stop", "steady + stop")
@kills("solvers.runup.programme:Programme._coast", "(spin + steady / rate)", "spin")
@kills("solvers.runup.programme:Programme._coast", "spin - steady * stage.duration", "spin")
@kills("solvers.runup.samples:_coast", "machine.spin > stop", "machine.spin < stop")
def test_a_coast_ends_where_it_is_said_to() -> None:
    """To a speed, then for a time; the estimate of its corners is exact here, nothing else brakes.

    A coast ends within 1e-6 of its speed, above or below; the midpoint rule adds as much.
    """
    stages = (Stage(12.0, duration=60.0, free=True), Stage(duration=0.8, free=True), Stage(20.0, 8.0))
    for torque, rate in ((2.0, 0.0), (0.0, 0.3), (1.5, 0.2)):
        drive = Programme(40.0, stages, 0.4, torque, rate)
        found, (times, speeds) = run(STILL, drive), drive.corners()
        assert found.stage is not None and found.converged
        ends = np.append(np.flatnonzero(np.diff(found.stage)), found.time.size - 1)
        np.testing.assert_allclose(found.time[ends], times[1:], rtol=1e-4)
        np.testing.assert_allclose(found.speed[ends], speeds[1:], rtol=1e-5)


def test_a_coast_comes_to_a_stand() -> None:
    """At the floor, where the next stage begins; one that takes longer than it may ends with its time."""
    stop, go = Stage(0.0, duration=60.0, free=True), Stage(20.0, 10.0)
    found = run(STILL, Programme(0.0, (go, stop, go), inertia=0.4, drag_torque=2.0))
    assert found.converged and found.speed[0] == FLOOR * 20.0
    assert found.speed.min() == pytest.approx(FLOOR * 20.0, rel=1e-5)
    assert found.speed[-1] == pytest.approx(20.0, rel=1e-12)
    cut = run(STILL, Programme(20.0, (replace(stop, duration=2.0),), inertia=0.4, drag_torque=1.0))
    assert cut.time[-1] == 2.0 and cut.speed[-1] == pytest.approx(15.0, rel=1e-6)


def test_liquid_brakes_and_the_energy_closes() -> None:
    """Through the resonance without a motor: what the drum gives is what drag, liquid and whirl take."""
    stages = (Stage(60.0, duration=2.0), Stage(duration=1.0), Stage(10.0, duration=60.0, free=True))
    drive, parts = Programme(20.0, stages, 0.4, 0.5, 0.02), []
    for cells in (64, 128):
        found = run(ROTOR, drive, FILL, cells=cells)
        free = np.flatnonzero(found.stage == 2)
        lost = 0.5 * 0.4 * (found.speed[free[0] - 1] ** 2 - found.speed[-1] ** 2)
        assert found.converged and found.audit.closure < 1e-3
        assert lost > -found.audit.motor > 0.0
        parts.append((found.time[-1], found.largest[free].max(), found.audit.motor))
    # Second order in the step: half the cells are four times as far, a third of this tolerance.
    np.testing.assert_allclose(parts[0], parts[1], rtol=5e-3)


@pytest.mark.parametrize("model", [couple_linear, couple])
def test_what_the_drum_gives_goes_into_drag_and_liquid(model: RunupModel) -> None:
    """Without unbalance the drum's own energy is what drag takes, less what the liquid brings or takes.

    A ramp leaves the liquid behind; coasting, the drum first drags it on and is then driven by it. Each is a
    midpoint rule of the same steps; long waves hand the spin over within the square of its change in a step.
    """
    stages = (Stage(60.0, duration=1.0), Stage(10.0, duration=60.0, free=True))
    drive, friction = Programme(20.0, stages, 0.2, 1.0, 0.02), Friction("linear", 1.0)
    found = run_up(STILL.system(), [FILL], drive, friction, 0.0, ALONE, model=model)
    free = np.flatnonzero(found.stage == 1)
    given = run_up(
        STILL.system(), [FILL], replace(drive, stages=stages[:1]), friction, 0.0, ALONE, model=model
    )
    on_liquid = found.audit.drive - given.audit.drive
    change = 0.5 * 0.2 * (found.speed[-1] ** 2 - found.speed[free[0] - 1] ** 2)
    assert change == pytest.approx(found.audit.motor - on_liquid, rel=1e-6)
    assert found.mean_rotation[free[0], 0] < -1.0 and found.mean_rotation[-1, 0] > 0.1


def test_a_coast_far_slower_than_its_steps() -> None:
    """A step takes 3e-7 of the spin, less than rotor and layers agree within: it falls all the same."""
    drive, numerics = Programme(40.0, (Stage(duration=2.0, free=True),), 0.4, 4e-4), replace(ALONE, cells=512)
    found = run_up(STILL.system(), [], drive, numerics=numerics)
    # Rounding of 10^4 steps, each 1e-16 of the spin.
    assert found.speed[-1] - 40.0 == pytest.approx(-2.0 * 4e-4 / 0.4, rel=1e-7)


def test_the_error_compares_equal_times() -> None:
    """Two runs whose coasts end at other times: their samples differ, not the times that are compared."""
    stages = (Stage(10.0, duration=60.0, free=True), Stage(40.0, 20.0))
    drive = Programme(60.0, stages, 0.4, 2.0)
    errors = [run(ROTOR, drive, FILL, cells=cells, companion=True).error_estimate for cells in (64, 128)]
    # Second order; the wait for the resonance on the way down shifts with the step.
    assert errors[1] < 0.05 and 2.5 < errors[0] / errors[1] < 6.0


@pytest.mark.parametrize("free", [False, True])
def test_through_the_resonance_as_scipy_has_it(free: bool) -> None:
    """Up with a given speed, down again driven or coasting, by a Runge-Kutta method of order eight.

    Coasting, the spin is an unknown: I Omega' + Re(i U e^(i phi)) . x'' = -T_0 [theory: coupling, eq. 6].
    """
    inertia, drag, size = 0.4, 4.0, ROTOR.unbalance
    down = Stage(10.0, duration=60.0, free=True) if free else Stage(10.0, 10.0)
    drive = Programme(10.0, (Stage(50.0, 20.0), down), inertia, drag)
    found = run(ROTOR, drive, cells=1024)

    def rates(time: float, state: np.ndarray) -> np.ndarray:
        place, rate, angle, spin = state[:2], state[2:4], state[4], state[5]
        turn = np.array([math.cos(angle), math.sin(angle)])
        across = np.array([-turn[1], turn[0]])
        hold = -ROTOR.damping * rate - ROTOR.stiffness * place + size * spin**2 * turn
        gain = 20.0 if time < 2.0 else -10.0
        if not (free and time >= 2.0):
            return np.array([*rate, *((hold + size * gain * -across) / MASS), spin, gain])
        # M x'' = hold - U Omega' across; I Omega' = -T_0 - U across . x''.
        gain = (-drag - size * across @ hold / MASS) / (inertia - size**2 / MASS)
        return np.array([*rate, *((hold - size * gain * across) / MASS), spin, gain])

    state, rows = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 10.0]), []
    for part in (found.time <= 2.0, found.time > 2.0):
        times = found.time[part]
        begin = times[0] if not rows else 2.0
        answer = solve_ivp(
            rates, (begin, times[-1]), state, method="DOP853", t_eval=times, rtol=1e-10, atol=1e-12
        )
        state = answer.y[:, -1]
        rows.append(answer.y)
    wanted = np.concatenate(rows, axis=1)
    # The trapezium's phase error, (dt omega)^2/12 with dt Omega = 0.8 * 2 pi/1024, over 100 rad: 2e-4, and as
    # much again while the steps are as long in angle at a tenth of the speed.
    amplitude = np.hypot(wanted[0], wanted[1])
    assert np.abs(found.amplitude - amplitude).max() < 2e-3 * amplitude.max()
    np.testing.assert_allclose(found.speed, wanted[5], rtol=2e-3)


@pytest.mark.parametrize(
    "field, make",
    [
        ("stages", lambda: Programme(1.0, ())),
        ("stages", lambda: Programme(0.0, (Stage(duration=1.0),))),
        ("inertia", lambda: Programme(1.0, (Stage(duration=1.0, free=True),))),
        ("inertia", lambda: Programme(1.0, (Stage(2.0, 1.0),), inertia=0.0)),
        ("drag_torque", lambda: Programme(1.0, (Stage(2.0, 1.0),), drag_torque=-1.0)),
        ("duration", lambda: Stage(2.0)),
        ("duration", lambda: Stage(rate=2.0)),
        ("duration", lambda: Stage(2.0, 1.0, free=True)),
        ("rate", lambda: Stage(2.0, 1.0, 1.0)),
        ("rate", lambda: Stage(2.0, 0.0)),
        ("stop", lambda: Stage(-2.0, 1.0)),
    ],
)
def test_what_is_no_programme(field: str, make: object) -> None:
    with pytest.raises(InputError) as told:
        make()  # type: ignore[operator]
    assert told.value.field == field


FLAT = ((0.0, 200.0), (2.0, 2.0))


@kills("solvers.runup.samples:_limited", "inertia * asked + load.torque() > given", "False")
@kills("solvers.runup.programme:Programme.net", "np.interp(speeds, *drag)", "0.0")
@kills("solvers.runup.samples:_limited", "gap * rate < 0.0", "gap * rate > 0.0")
def test_a_motor_that_gives_less_than_is_asked() -> None:
    """Spin-up by a constant torque is a straight line, with viscous drag an exponential; then the hold."""
    up, hold = Stage(20.0, rate=100.0), Stage(duration=1.0)
    found = run(STILL, Programme(5.0, (up, hold), inertia=0.4, motor=FLAT))
    assert found.stage is not None and found.limited is not None and found.converged
    rise = found.stage == 0
    np.testing.assert_allclose(found.speed[rise], 5.0 + 5.0 * found.time[rise], rtol=1e-9)
    assert found.time[rise][-1] == pytest.approx(15.0 / 5.0, rel=1e-5)
    assert found.limited[1:][rise[1:]].all() and not found.limited[~rise].any()
    assert found.time[-1] == pytest.approx(4.0, rel=1e-5)
    np.testing.assert_allclose(found.speed[~rise], 20.0, rtol=2e-6)
    # T - T_0 - I k Omega: to (k dt)^2/12 of the midpoint rule.
    found = run(STILL, Programme(5.0, (up,), 0.4, 0.5, 0.05, motor=FLAT))
    last = (2.0 - 0.5) / 0.4 / 0.05
    np.testing.assert_allclose(found.speed, last + (5.0 - last) * np.exp(-0.05 * found.time), rtol=1e-6)


@kills("solvers.runup.samples:_limited", "max(lasts, drive.limit)", "lasts")
def test_a_motor_that_never_gets_there() -> None:
    """Its torque ends at 40 rad/s, an exponential on the way; the stage ends with its limit of time."""
    falling = ((0.0, 40.0), (4.0, 0.0))
    found = run(STILL, Programme(5.0, (Stage(50.0, duration=1.0),), 0.4, motor=falling, limit=6.0))
    assert found.time[-1] == 6.0
    np.testing.assert_allclose(found.speed, 40.0 - 35.0 * np.exp(-0.25 * found.time), rtol=2e-5)


def test_a_strong_motor_changes_nothing() -> None:
    """A curve that is never reached leaves the programme as it is, through the resonance and down."""
    stages = (Stage(50.0, rate=20.0), Stage(duration=1.0), Stage(30.0, rate=40.0))
    plain = run(ROTOR, Programme(5.0, stages, inertia=0.4), FILL)
    found = run(ROTOR, Programme(5.0, stages, inertia=0.4, motor=((0.0, 90.0), (900.0, 900.0))), FILL)
    assert found.limited is not None and not found.limited.any()
    size = plain.amplitude.max()
    np.testing.assert_allclose(
        np.interp(plain.time, found.time, found.amplitude), plain.amplitude, rtol=0.0, atol=1e-3 * size
    )


@kills("solvers.runup.samples:_Load._now", 'sums["unbalance"] + sums["drive"]', 'sums["unbalance"]')
def test_what_a_limited_motor_gives_goes_into_the_drum_and_the_liquid() -> None:
    """Its work is what the drum gains and what whirl and liquid take; what the liquid takes limits it."""
    motor = ((0.0, 200.0), (6.0, 6.0))
    drive = Programme(10.0, (Stage(45.0, rate=30.0),), 0.4, motor=motor)
    numerics, friction = replace(ALONE, cells=32, samples=600), Friction("linear", 3.0)
    found = run_up(ROTOR.system(), (FILL,), drive, friction, 0.0, numerics, model=couple)
    assert found.limited is not None and found.limited[1:].all() and found.converged
    assert found.speed[-1] == pytest.approx(45.0, rel=1e-4)
    audit = found.audit
    # The motor's work is summed with the speed at the beginning of a step: half of its rise, 0.2 of 27 rad/s.
    drum = 0.5 * 0.4 * (found.speed[-1] ** 2 - 10.0**2)
    assert audit.motor - audit.unbalance - audit.drive == pytest.approx(drum, rel=6e-3)
    assert audit.motor == pytest.approx(6.0 * (found.angle[-1] - found.angle[0]), rel=6e-3)
    # Asked is what the drum alone would take of this motor: what the liquid takes besides limits it.
    asks = Programme(10.0, (Stage(45.0, rate=14.0),), 0.4, motor=motor)
    assert run(STILL, asks, FILL).limited[2:].any()  # type: ignore[index]
    assert not run(STILL, asks).limited.any()  # type: ignore[union-attr]
