"""Unbalances that leave with time, against an independent integration and their closed form."""

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
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import Shed
from solvers.runup.linear import couple_linear
from solvers.runup.long_wave import couple
from solvers.runup.machine import Ramp, RunupModel
from solvers.runup.programme import Programme, Stage
from solvers.runup.runup import RunupHistory, RunupNumerics, run_up
from tests.mutants import kills

ROTOR = Jeffcott(30.0, 30.0 * 25.0**2, 2.0 * 0.1 * 30.0 * 25.0, 0.02)
FILL = Fill(Chamber(0.25, 0.04), Liquid("water", 1000.0, 1e-6), 5e-4)
ALONE = RunupNumerics(cells=64, samples=200, companion=False)
WHOLE = ROTOR.system().unbalance


def run(
    sheds: tuple[Shed, ...],
    drive: Ramp | Programme,
    *fills: Fill,
    model: RunupModel = couple_linear,
    **changes: object,
) -> RunupHistory:
    system, numerics = replace(ROTOR.system(), sheds=sheds), replace(ALONE, **changes)  # type: ignore[arg-type]
    return run_up(system, fills, drive, Friction("linear", 5.0), 0.0, numerics, model=model)


@kills("solvers.runup.shedding:Shedding.pieces", "exp(-step / self", "exp(-2.0 * step / self")
@kills("solvers.runup.shedding:Shedding._share", "high - self._above", "self._above - low")
@kills("solvers.runup.shedding:Shedding._share", "low > self._above", "low < self._above")
def test_shares_that_are_left() -> None:
    """Closed form: nothing leaves below the speed, then e^(-t/T), on the way up, held and down.

    On a ramp the time above is exact, the speed being a straight line between two samples.
    """
    drive = Programme(10.0, (Stage(50.0, 20.0), Stage(duration=2.0), Stage(20.0, 30.0)))
    parts = (Shed(0.3 * WHOLE, 1.5, 37.7), Shed(0.2 * WHOLE, 0.7, 50.0), Shed(0.1 * WHOLE, 0.5, 60.0))
    found = run(parts, drive)
    assert found.left is not None
    up, down = (37.7 - 10.0) / 20.0, 4.0 + (50.0 - 37.7) / 30.0
    above = np.clip(found.time, up, down) - up
    # At the speed itself, within 1e-9 of it, water leaves as well.
    np.testing.assert_allclose(found.left[:, 0], np.exp(-above / 1.5), rtol=1e-8)
    held = np.clip(found.time, 2.0, 4.0) - 2.0
    np.testing.assert_allclose(found.left[:, 1], np.exp(-held / 0.7), rtol=1e-8)
    np.testing.assert_array_equal(found.left[:, 2], 1.0)


@kills("solvers.runup.shedding:Shedding._gone", "1.0 - share", "share")
@kills("solvers.runup.state:CoupledRotor.load", "self.machine.unbalance[:] = unbalance", "pass")
@pytest.mark.parametrize("samples", [20, 400])
def test_the_rotor_feels_what_is_left(samples: int) -> None:
    """scipy with U(t) itself, through the resonance and held; the force has no part with the rate of U.

    Pieces of T/1000 at their middle values: 1e-3^2/24 and a ripple far above the resonance; what counts is
    the trapezium's error, as for a whole unbalance: 1e-3.
    """
    time_constant, above = 0.8, 15.0
    found = run(
        (Shed(WHOLE, time_constant, above),), Ramp(10.0, 40.0, 20.0, 3.0), cells=1024, samples=samples
    )

    def rates(time: float, state: np.ndarray) -> np.ndarray:
        spin, gain = min(10.0 + 20.0 * time, 40.0), 20.0 if time < 1.5 else 0.0
        angle = 10.0 * time + 10.0 * time**2 if time < 1.5 else 37.5 + 40.0 * (time - 1.5)
        size = ROTOR.unbalance * math.exp(-max(time - 0.25, 0.0) / time_constant)
        turn = np.array([math.cos(angle), math.sin(angle)])
        force = size * (spin**2 * turn - gain * np.array([-turn[1], turn[0]]))
        rest = -ROTOR.damping * state[2:] - ROTOR.stiffness * state[:2]
        return np.array([*state[2:], *((force + rest) / ROTOR.mass)])

    wanted = solve_ivp(
        rates, (0.0, 3.0), np.zeros(4), t_eval=found.time, rtol=1e-9, atol=1e-12, max_step=0.01
    )
    amplitude = np.hypot(wanted.y[0], wanted.y[1])
    assert np.abs(found.amplitude - amplitude).max() < 2e-3 * amplitude.max()


def all_of_it_leaves(model: RunupModel) -> None:
    """Rotor and liquid come to rest, and the energy closes on the way.

    After 12 time constants 6e-6 is left; the rotor's own motion dies out at 2.5 1/s, for 6 s.
    """
    found = run((Shed(WHOLE, 0.5, 20.0),), Ramp(10.0, 60.0, 50.0, 7.0), FILL, model=model)
    assert found.converged and found.amplitude[-1] < 1e-4 * found.amplitude.max()
    assert found.audit.closure < 2e-3


@kills("solvers.runup.state:CoupledRotor.load", "self.machine.unbalance[:] = unbalance", "pass")
def test_all_of_it_leaves_a_linear_layer() -> None:
    all_of_it_leaves(couple_linear)


@kills("solvers.runup.state:CoupledRotor.load", "self.machine.unbalance[:] = unbalance", "pass")
def test_all_of_it_leaves_long_waves() -> None:
    all_of_it_leaves(couple)


def test_nothing_that_leaves_changes_nothing() -> None:
    """Parts without size, time or speed enough: the same run, bit for bit where no piece is cut."""
    ramp = Ramp(10.0, 40.0, 20.0, 2.0)
    plain, idle = run((), ramp, FILL), run((Shed(WHOLE, 1e6, 90.0),), ramp, FILL)
    np.testing.assert_array_equal(plain.amplitude, idle.amplitude)
    assert plain.left is not None and plain.left.shape == (plain.time.size, 0)


@kills("solvers.runup.state:CoupledRotor.lighten", "-= inertia - self.lost_inertia", "-= 0.0")
@kills("solvers.runup.shedding:Shedding._lost", "inertia += (1.0 - share)", "inertia += share")
@pytest.mark.parametrize("model", [couple_linear, couple])
def test_water_that_leaves_takes_its_momentum_along(model: RunupModel) -> None:
    """A coasting drum that nothing brakes keeps its speed; with steady drag it is slowed ever faster.

    I(t) = I_0 - i (1 - e^(-t/T)): Omega falls by T_0 times the integral of 1/I, in closed form.
    """
    still = replace(ROTOR.system(), unbalance=np.zeros(2, dtype=complex))
    shed = Shed(np.zeros(2, dtype=complex), 1.2, 1.0, np.diag([8.0, 8.0]), 0.25)
    system = replace(still, sheds=(shed,))
    coast = (Stage(duration=1.0, free=True),)
    numerics = replace(ALONE, cells=32)
    free = run_up(system, (), Programme(40.0, coast, 0.4), numerics=numerics, model=model)
    np.testing.assert_allclose(free.speed, 40.0, rtol=1e-12)
    found = run_up(system, (), Programme(40.0, coast, 0.4, 2.0), numerics=numerics, model=model)
    least = 0.4 - 0.25
    integral = 1.2 / least * np.log((least * np.exp(found.time / 1.2) + 0.25) / 0.4)
    # Held for T/1000 at the middle: 1e-3^2/24.
    np.testing.assert_allclose(found.speed, 40.0 - 2.0 * integral, rtol=1e-6)


@kills("solvers.runup.state:CoupledRotor.lighten", "-= mass - gone", "-= 0.0")
@kills("solvers.runup.state:CoupledRotor.lighten", "-0.5 * float(", "0.5 * float(")
@kills("solvers.runup.state:CoupledRotor.lighten", "@ (mass - gone) @", "@ mass @")
@kills("solvers.runup.shedding:Shedding._lost", "mass += (1.0 - share)", "mass += share")
def test_the_lighter_rotor_moves_as_such() -> None:
    """scipy with M(t) and no force of what leaves, through the resonance; the energy closes."""
    time_constant, lost = 0.8, 9.0
    shed = Shed(0.0 * WHOLE, time_constant, 15.0, np.diag([lost, lost]))
    found = run((shed,), Ramp(10.0, 40.0, 20.0, 3.0), cells=1024, samples=400)

    def rates(time: float, state: np.ndarray) -> np.ndarray:
        spin, gain = min(10.0 + 20.0 * time, 40.0), 20.0 if time < 1.5 else 0.0
        angle = 10.0 * time + 10.0 * time**2 if time < 1.5 else 37.5 + 40.0 * (time - 1.5)
        mass = ROTOR.mass - lost * (1.0 - math.exp(-max(time - 0.25, 0.0) / time_constant))
        force = ROTOR.unbalance * (spin**2 - 1j * gain) * np.exp(1j * angle)
        place, rate = complex(*state[:2]), complex(*state[2:])
        faster = (force - ROTOR.damping * rate - ROTOR.stiffness * place) / mass
        return np.array([rate.real, rate.imag, faster.real, faster.imag])

    exact = solve_ivp(rates, (0.0, 3.0), np.zeros(4), t_eval=found.time, rtol=1e-9, atol=1e-13)
    wanted = np.hypot(*exact.y[:2])
    # The trapezium's error, as above.
    assert np.abs(found.amplitude - wanted).max() < 2e-3 * wanted.max()
    whole = run((), Ramp(10.0, 40.0, 20.0, 3.0), cells=1024, samples=400)
    assert np.abs(whole.amplitude - wanted).max() > 0.05 * wanted.max()
    assert found.audit.closure < 1e-9
