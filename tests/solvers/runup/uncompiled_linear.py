"""Seeded faults of the linear layers' time step, and their oracles, run as plain Python."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.friction.baffles import baffle_torque
from fluid.friction.laws import Friction
from fluid.friction.pipe import hydraulic_diameter, spin_up_time
from fluid.liquid import Liquid
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.layer.records import Outcome
from solvers.rotor.balls.balancers import BallRace
from solvers.rotor.jeffcott import Jeffcott
from solvers.runup.balls import Balls
from solvers.runup.linear import LinearCoupled, couple_linear, plate_curves
from solvers.runup.steps.linear import plate_drag
from solvers.whirl.growth import asynchronous_growth
from tests.mutants import kills

FILL = Fill(Chamber(0.25, 0.04), Liquid("water", 1000.0, 1e-6), 2e-3)
ROTOR = Jeffcott(3.0, 3.0 * 15.0**2, 6.0, 4e-3)


def machine(cells: int, friction: float = 2.0, gravity: float = 0.0) -> LinearCoupled:
    found = couple_linear(ROTOR.system(), [FILL], 30.0, Friction("linear", friction), gravity, cells, False)
    found.machine.place[:4] = 2e-3, -1e-3, 5e-3, 2e-3
    found.machine.rate[:4] = 0.05, 0.02, -0.1, 0.04
    return found


@kills(
    "solvers.runup.steps.linear:_assemble",
    "2.0 * kappa * (after - before) / dt",
    "0.0 * (after - before) / dt",
)
@kills("solvers.runup.steps.linear:_assemble", "gravity[part] - forces", "-gravity[part] - forces")
@kills(
    "solvers.runup.steps.coupled:load_rotor",
    "first, last = along * turn[1]",
    "first, last = along * turn[0]",
)
@kills("solvers.runup.steps.linear:_carry", "carried * (1.0 - share)", "carried")
@kills("solvers.runup.steps.linear:_tally", "(x * q - y * p)", "(x * p + y * q)")
@kills(
    "solvers.runup.linear:LinearCoupled.energy",
    "0.5 * layer.inertia * m.carried",
    "layer.inertia * m.carried",
)
def test_energy() -> None:
    """The balance closes with the square of the step, spin and friction changing things."""
    left = []
    for cells in (32, 64):
        found = machine(cells, gravity=3.0)
        before = found.energy()
        assert found.advance(0.3, 20.0, 0.8, 10**5) == Outcome.DONE
        s = found.sums
        gained = s.unbalance + s.drive + s.gravity - s.support - s.friction
        left.append(abs(gained - (found.energy() - before)) / abs(s.unbalance))
    assert left[1] < 5e-3
    assert left[1] < 0.4 * left[0]


@kills(
    "solvers.runup.steps.linear:_assemble",
    "mass * (b[0, i] * b[0, k] + b[1, i] * b[1, k])",
    "mass * b[0, i] * b[0, k]",
)
@kills("solvers.runup.steps.linear:_assemble", "4.0 * kappa * whole * sign", "2.0 * kappa * whole * sign")
@kills(
    "solvers.runup.steps.linear:_assemble",
    "whole * friction + 2.0 * kappa",
    "-whole * friction + 2.0 * kappa",
)
@kills("solvers.runup.steps.linear:_assemble", "-2.0 * kappa * whole * whole", "2.0 * kappa * whole * whole")
@kills(
    "solvers.runup.steps.linear:_assemble", "1.0 + kappa + 0.5 * dt * friction", "1.0 + 0.5 * dt * friction"
)
def test_growth() -> None:
    """A machine let go grows, or dies, as its characteristic equation says."""
    for rate in (0.0, 5.0):
        free = Jeffcott(3.0, 3.0 * 15.0**2, 0.0, 0.0)
        found = couple_linear(free.system(), [FILL], 22.0, Friction("linear", rate), 0.0, 32, False)
        found.machine.place[0] = 1e-6
        seen = []
        times = np.linspace(0.0, 3.0, 61)[1:]
        for stop in times.tolist():
            assert found.advance(stop, 0.0, 0.8, 10**5) == Outcome.DONE
            seen.append(complex(*found.machine.place[:2]))
        growth = np.polyfit(times[40:], np.log(np.abs(seen))[40:], 1)[0]
        wanted, _ = asynchronous_growth(free, [FILL], [22.0], Friction("linear", rate))
        assert growth == pytest.approx(wanted[0], rel=0.05, abs=0.02)


@kills(
    "solvers.runup.steps.linear:advance_linear",
    "sums.unbalance -= swing[i] * mean",
    "sums.unbalance += swing[i] * mean",
)
@kills("solvers.runup.steps.linear:_tally", "u + whole * y, v - whole * x", "u - whole * y, v + whole * x")
@kills(
    "solvers.runup.steps.linear:_tally",
    "layer.inertia * spin * gained",
    "layer.inertia * whole * gained",
)
@kills("solvers.runup.steps.linear:_tally", "gravity[0] * u + gravity[1] * v", "gravity[0] * v")
@kills("solvers.runup.steps.linear:_tally", "held * (spin - whole) ** 2", "held * (spin - whole)")
def test_tallies() -> None:
    """Works and heats are the integrals of their powers over what is sampled."""
    found = machine(64, gravity=3.0)
    rows, times = [], np.linspace(0.0, 0.2, 81)
    for stop in times.tolist():
        if stop > 0.0:
            assert found.advance(stop, 20.0, 0.8, 10**5) == Outcome.DONE
        m = found.machine
        v, d, turn = m.rate[:2], m.rate[2:4], np.exp(1j * m.shaft[0].angle)
        force = ((found.spin**2 - 20j) * found.system.unbalance * turn).real
        offset, whole = complex(*m.place[2:4]), m.carried[0]
        slip = complex(*d) - 1j * whole * offset
        kappa, inertia = m.layers[0].curvature, m.layers[0].inertia
        k = m.layers[0].rate
        heat = 2.0 * k * (1.0 + kappa) * abs(slip) ** 2 + inertia * k * (found.spin - whole) ** 2
        gained = k * (found.spin - whole)
        wave = -2.0 * k * (1.0 + kappa) * (np.conj(1j * whole * offset) * slip).real
        swing = (np.conj(offset) * complex(*d)).imag - whole * abs(offset) ** 2
        drive = inertia * found.spin * gained + wave + 2.0 * kappa * 2.0 * gained * swing
        weight = 2.0 * float(m.gravity @ d)
        rows.append((force @ v, v @ found.system.damping @ v, weight, heat, drive))
    wanted = np.trapezoid(np.array(rows).T, times)
    for name, value in zip(("unbalance", "support", "gravity", "friction", "drive"), wanted, strict=True):
        assert found.sums[name] == pytest.approx(value, rel=1e-2, abs=1e-5)


@kills("solvers.runup.steps.linear:advance_linear", "load -= change[i]", "load += change[i]")
@kills(
    "solvers.runup.steps.linear:advance_linear",
    "load += layers[j].inertia * (turning",
    "load -= layers[j].inertia * (turning",
)
@kills("solvers.runup.steps.linear:advance_linear", "sums.motor += dt * spin", "sums.motor += dt")
def test_motor() -> None:
    """Torque of the motor, less what spins the liquid and what the unbalance takes."""
    found = couple_linear(
        replace(ROTOR, unbalance=0.1).system(), [FILL], 30.0, Friction("linear", 2.0), 0.0, 64, False
    )
    found.machine.rate[:4] = 0.05, 0.02, -0.1, 0.04
    found.drive(np.array([[0.0, 80.0], [6.0, 0.0]]), 0.05)
    m = found.machine

    def momentum() -> float:
        turn = np.exp(1j * m.shaft[0].angle)
        cross = m.rate[:2] @ (1j * found.system.unbalance * turn).real
        return float(0.05 * found.spin + m.layers[0].inertia * m.carried[0] + cross)

    before, rows, times = momentum(), [], np.linspace(0.0, 0.1, 41)
    for stop in times.tolist():
        if stop > 0.0:
            assert found.advance(stop, 0.0, 0.8, 10**5) == Outcome.DONE
            m = found.machine
        turn = np.exp(1j * m.shaft[0].angle)
        swung = -found.spin * m.rate[:2] @ (found.system.unbalance * turn).real
        torque = float(np.interp(found.spin, [0.0, 80.0], [6.0, 0.0]))
        rows.append((torque + swung, torque * found.spin))
    push, work = np.trapezoid(np.array(rows).T, times)
    assert momentum() - before == pytest.approx(push, rel=5e-3)
    assert found.sums.motor == pytest.approx(work, rel=1e-3)


@kills("solvers.runup.linear:_layer", "chamber.radius**4 * area * (1.0 - area)", "chamber.radius**4 * area")
def test_inertia() -> None:
    """Moment of inertia of the layer, and the squared ratio of the radii."""
    layer = couple_linear(ROTOR.system(), [FILL], 30.0, Friction(), 0.0, 8, False).machine.layers[0]
    inner = FILL.surface_radius
    assert layer.inertia == pytest.approx(0.5 * FILL.mass * (0.25**2 + inner**2), rel=1e-12)
    assert layer.curvature == pytest.approx((0.25 / inner) ** 2, rel=1e-12)


@kills("solvers.runup.steps.linear:_mean_drag", "lag /= 1.0 + 0.5 * dt * first", "pass")
@kills("solvers.runup.steps.linear:_wall_drag", "rate * layer.sides", "rate")
@kills("solvers.runup.steps.linear:_mean_drag", "0.5 * dt * first", "1.5 * dt * first")
@kills("solvers.layer.drag:mean_rate", "else 1.0)) * last", "else 1.0))")
@kills("solvers.layer.drag:mean_rate", "* beyond * top", "* beyond")
@kills("solvers.runup.linear:_layer", "1.0 / depth + layer.lid", "1.0 / depth")
def test_the_law_of_the_wall_carries_the_layer_along() -> None:
    """From rest in space, by the integral of the channel's law; few long steps, of second order."""
    law = Friction("wall")  # type: ignore[arg-type]
    diameter = float(hydraulic_diameter(FILL.depth, FILL.chamber.height))
    time = float(spin_up_time(0.5, 30.0 * 0.25, diameter, 1e-6))
    left = []
    for cells in (4, 8):
        found = couple_linear(ROTOR.system(), [FILL], 30.0, law, 0.0, cells, False)
        found.machine.carried[:] = 0.0
        assert found.advance(time, 0.0, 0.8, 10**5) == Outcome.DONE
        left.append(abs(found.machine.carried[0] / 30.0 - 0.5))
    # The table's 1e-4, and the square of a step's share of the decay.
    assert left[0] < 5e-3
    assert left[1] < 1.5e-3


@kills("solvers.runup.linear:plate_curves", "(4.0 * math.pi * fill", "(2.0 * math.pi * fill")
@kills("solvers.runup.linear:plate_curves", "baffles.count * middle", "baffles.count")
@kills("solvers.runup.steps.linear:_mean_drag", "0.5 * dt * first", "1.5 * dt * first")
@kills("solvers.runup.steps.linear:_tally", "layer.inertia * blocked", "layer.inertia * held")
@kills("solvers.runup.steps.linear:plate_drag", "return lag *", "return spin *")
def test_smeared_baffles_decelerate_a_lag() -> None:
    """With a constant loss du/dt = -zeta N u|u|/(4 pi R): 1/u rises in a straight line; the heat is told.

    The steps are exact for that law, so that only rounding is left.
    """
    fill = replace(FILL, chamber=Chamber(0.25, 0.04, baffles=Baffles(6, 0.24, loss=2.0)))
    found = couple_linear(ROTOR.system(), [fill], 30.0, Friction(), 0.0, 16, False)
    found.machine.carried[:] = 20.0
    arm = np.sqrt(0.5 * (0.25**2 + fill.surface_radius**2))
    before = found.energy()
    for time in (0.1, 0.7):
        assert found.advance(time, 0.0, 0.8, 10**5) == Outcome.DONE
        risen = 1 / ((30.0 - found.machine.carried[0]) * arm) - 1 / (10.0 * arm)
        assert risen == pytest.approx(2.0 * 6 * time / (4 * np.pi * 0.25), rel=1e-10)
    sums = found.sums
    work = sums.drive + sums.unbalance - sums.support - sums.baffles
    # Linear in each step; the rotor's own balance closes with its square.
    assert sums.friction == 0.0 and sums.baffles > 0.1 * abs(found.energy() - before)
    assert work == pytest.approx(found.energy() - before, rel=1e-2)


@kills("solvers.runup.steps.linear:plate_drag", "(place - k) * (curve", "0.0 * (curve")
def test_smeared_baffles_follow_the_law() -> None:
    """The torque on a lagging layer is that of the law, the pile-up included; compartments are refused."""
    chamber = Chamber(0.25, 0.04, baffles=Baffles(6, 0.24))
    fill = replace(FILL, chamber=chamber)
    (curve,) = plate_curves([fill])
    inertia = 0.5 * fill.mass * (0.25**2 + fill.surface_radius**2)
    for lag in (0.004, 0.05, 0.301, 0.8):
        torque = inertia * 30.0 * lag * plate_drag(curve, 30.0, 30.0 * lag)
        # Straight lines between 128 lags: of second order, 1e-3 where the loss falls fastest.
        assert torque == pytest.approx(baffle_torque(fill, 30.0, np.array([lag])).torque[0], rel=2e-3)
    assert plate_curves([FILL]).shape == (1, 0) and plate_drag(np.zeros(0), 30.0, 3.0) == 0.0
    closed = replace(FILL, chamber=replace(chamber, baffles=Baffles(6, 0.1)))
    with pytest.raises(InputError, match="compartments"):
        plate_curves([FILL, closed])


RACE = BallRace(0.0, 0.2, (0.1, 0.15), 2.0, carried=0.43, driven=0.46)


@kills("solvers.runup.steps.balls:add_ball", "+ b[1, i] * b[1, k]", "+ 0.0 * b[1, k]")
@kills("solvers.runup.steps.balls:add_ball", "+ b[1, i] * slope_y", "- b[1, i] * slope_y")
@kills("solvers.runup.steps.balls:ball_turned", "- ball.carried * change", "+ ball.carried * change")
@kills("solvers.runup.steps.balls:tally_ball", "(spin - mean) * ball_dragged", "spin * ball_dragged")
@kills("solvers.runup.steps.balls:add_balls", "balls[j], races[j]", "balls[0], races[j]")
@kills("solvers.runup.steps.balls:tally_balls", "change[k], spins, dt, sums", "0.0, spins, dt, sums")
def test_balls_energy() -> None:
    """The balance of rotor, layer and balls closes with the square of the step."""
    left = []
    for cells in (32, 64):
        balls = Balls((RACE,), (0.4, 2.0), (1.0, 0.5))
        made = couple_linear(
            ROTOR.system(), [FILL], 30.0, Friction("linear", 2.0), 3.0, cells, False, balls=balls
        )
        made.machine.rate[:2] = 0.05, -0.02
        before = made.energy()
        assert made.advance(0.25, 20.0, 0.8, 10**6) == Outcome.DONE
        s = made.sums
        gained = s.unbalance + s.drive + s.gravity - s.support - s.friction
        left.append(abs(gained - (made.energy() - before)) / s.drive)
    assert left[1] < 2e-3
    assert 3.0 < left[0] / left[1] < 5.0
