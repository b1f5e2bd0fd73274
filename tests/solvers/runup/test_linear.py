"""Linear layers in time, against eigenvalues, balances and the nonlinear long waves."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.liquid import Liquid
from leblanc.liquid.models import runup_model
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.layer.records import Outcome
from solvers.rotor.jeffcott import Jeffcott
from solvers.runup.linear import couple_linear
from solvers.runup.long_wave import couple
from solvers.runup.machine import Motor, Ramp, RunupModel
from solvers.runup.runup import RunupHistory, RunupNumerics, run_up
from solvers.synchronous.response import response
from solvers.whirl.growth import asynchronous_growth
from tests.mutants import kills

WATER = Liquid("water", 1000.0, 1e-6)
MASS, NATURAL = 30.0, 25.0
# A hundredth of the unbalance of the nonlinear run-ups: waves of a hundredth of the depth.
ROTOR = Jeffcott(MASS, MASS * NATURAL**2, 2.0 * 0.06 * MASS * NATURAL, 1e-3)
FILL = Fill(Chamber(0.25, 0.04), WATER, 5e-4)
RAMP = Ramp(5.0, 60.0, 10.0, 6.0)
ALONE = RunupNumerics(cells=128, samples=600, companion=False)


def run(model: RunupModel, friction: Friction, **changes: object) -> RunupHistory:
    numerics = replace(ALONE, **{"dispersion": model is couple, **changes})  # type: ignore[arg-type]
    return run_up(ROTOR.system(), [FILL], RAMP, friction, 0.0, numerics, model=model)


@pytest.mark.parametrize(
    "friction, apart",
    [
        (Friction("linear", 0.5), 0.02),
        (Friction("linear", 3.0), 0.005),
        (Friction(), 0.005),
        (Friction("stokes"), 0.08),
    ],
)
def test_small_waves_are_those_of_the_long_wave_model(friction: Friction, apart: float) -> None:
    """The same run-up by two models that share no line but the rotor, spin-up of the liquid included.

    Where the liquid lags by a third of the speed the models differ: the long waves keep the vorticity of the
    drum's rotation, the linear layer has that of its own [theory: coupling, eq. 11].
    """
    linear, waves = run(couple_linear, friction), run(couple, friction)
    gap = np.abs(linear.amplitude - waves.amplitude).max() / waves.amplitude.max()
    assert gap < apart
    np.testing.assert_allclose(linear.mean_rotation, waves.mean_rotation, atol=0.02 * 60.0)


def grown(
    spin: float, friction: Friction, duration: float, damping: float = 0.0, liquid: Liquid = WATER
) -> tuple[complex, complex]:
    """Growth and whirl speed of a machine let go, and of its dominant mode by the characteristic equation."""
    chamber = Chamber(0.1, 0.05)
    fill = Fill(chamber, liquid, 0.19 * chamber.capacity)
    mass = fill.full_mass / 0.1
    rotor = Jeffcott(mass, mass, damping * mass, 0.0)
    machine = couple_linear(rotor.system(), [fill], spin, friction, 0.0, 256, False)
    machine.machine.place[0] = 1e-6
    times, seen = np.linspace(0.0, duration, 801)[1:], []
    for stop in times.tolist():
        assert machine.advance(stop, 0.0, 0.8, 10**7) == Outcome.DONE
        seen.append(complex(*machine.machine.place[:2]))
    last = slice(400, None)
    growth = np.polyfit(times[last], np.log(np.abs(seen))[last], 1)[0]
    turning = np.polyfit(times[last], np.unwrap(np.angle(seen))[last], 1)[0]
    wanted, whirl = asynchronous_growth(rotor, [fill], [spin], friction)
    return complex(growth, turning), complex(wanted[0], whirl[0])


@pytest.mark.parametrize("spin, rate, duration", [(1.15, 0.0, 200.0), (1.3, 0.0, 200.0), (1.0, 0.3, 400.0)])
def test_growth_is_that_of_the_characteristic_equation(spin: float, rate: float, duration: float) -> None:
    found, wanted = grown(spin, Friction("linear", rate), duration, 0.04 * (rate > 0.0))
    # The trapezium's phase error (Omega tau)^2/12, tau a fiftieth of a radian: 3e-5; the fit's rest.
    assert found.real == pytest.approx(wanted.real, rel=3e-3)
    assert abs(found.imag) == pytest.approx(abs(wanted.imag), rel=1e-3)


@kills("solvers.runup.linear:_layer", "rate = float(layer_rate(", "assert float(layer_rate(")
def test_laminar_friction_takes_as_much_growth() -> None:
    """Wall, floor and lid with the Coriolis force; without it they have two thirds of the drag."""
    liquid = Liquid("of a test", 1000.0, 1e-7)
    free = grown(1.3, Friction(), 200.0, 0.0, liquid)
    held = grown(1.3, Friction("stokes"), 200.0, 0.0, liquid)
    found, wanted = ((with_ - without).real for with_, without in zip(held, free, strict=True))
    # The rate is that of the slower free wave, and has no inertia: a layer's thickness over the depth, 8 %.
    assert found == pytest.approx(wanted, rel=0.08)


@kills("solvers.runup.linear:LinearCoupled._offset", "first + 1j * second", "first - 1j * second")
def test_hold_comes_to_the_steady_response() -> None:
    """Held at a speed, the synchronous response with the mass of a full drum."""
    drive = Ramp(59.9, 60.0, 1.0, 6.0)
    for law in (Friction("linear", 8.0), Friction("linear", 30.0)):
        history = run_up(ROTOR.system(), [FILL], drive, law, 0.0, ALONE, model=couple_linear)
        found = history.deflection[-1, 0] * np.exp(-1j * history.angle[-1])
        steady = response(ROTOR, [FILL], [60.0], gravity=0.0)
        # The trapezium: (0.8 * 2 pi/128)^2/12.
        assert abs(found - steady.deflection[0]) < 1e-3 * abs(steady.deflection[0])
        place = history.liquid_position[-1] * np.exp(-1j * steady.liquid_angle[0])
        assert place.real == pytest.approx(steady.liquid_offset[0], rel=1e-3)
        assert abs(place.imag) < 2e-3 * place.real


def test_energy_closes_with_the_step() -> None:
    """The balance closes with the square of the step, on a ramp, with gravity and friction."""
    left = []
    for cells in (64, 128):
        rotor = replace(ROTOR, unbalance=0.05)
        machine = couple_linear(rotor.system(), [FILL], 30.0, Friction("linear", 2.0), 3.0, cells, False)
        machine.machine.rate[:2] = 0.05, -0.02
        before = machine.energy()
        assert machine.advance(1.0, 20.0, 0.8, 10**6) == Outcome.DONE
        s = machine.sums
        gained = s.unbalance + s.drive + s.gravity - s.support - s.friction
        left.append(abs(gained - (machine.energy() - before)) / s.unbalance)
    assert left[1] < 1e-3
    assert 3.0 < left[0] / left[1] < 5.0


def test_motor() -> None:
    """A motor spins rotor and liquid: their angular momentum is the integral of its torque."""
    rotor = replace(ROTOR, unbalance=0.0)
    drive = Motor(10.0, 0.5, (0.0, 100.0), (5.0, 5.0), 2.0)
    history = run_up(rotor.system(), [FILL], drive, Friction("linear", 2.0), 0.0, ALONE, model=couple_linear)
    area = 5e-4 / (2.0 * math.pi * 0.04 * 0.25**2)
    inertia = 1000.0 * 0.04 * 2.0 * math.pi * 0.25**4 * area * (1.0 - area)
    own = history.speed + history.mean_rotation[:, 0]
    momentum = 0.5 * (history.speed - 10.0) + inertia * (own - 10.0)
    np.testing.assert_allclose(momentum, 5.0 * history.time, rtol=1e-6, atol=1e-9)
    assert history.audit.motor == pytest.approx(np.trapezoid(5.0 * history.speed, history.time), rel=1e-5)
    assert history.mean_rotation.min() < -1.0


@kills("solvers.runup.state:CoupledRotor.ridden", "RELEASE * self.capture", "self.capture")
def test_capture() -> None:
    """Caught at sqrt(g/a) and let go below; momentum and energy are kept account of."""
    drive = Ramp(3.0, 20.0, 4.0, 5.0, back=True)
    history = run_up(ROTOR.system(), [FILL], drive, Friction("linear", 3.0), 9.81, ALONE, model=couple_linear)
    caught, speed = history.captured[:, 0], math.sqrt(9.81 / FILL.surface_radius)
    assert history.converged
    assert history.speed[caught & (history.time < 5.0)].min() == pytest.approx(speed, rel=0.02)
    back = caught & (history.time > 5.0)
    assert history.speed[back].min() == pytest.approx(0.98 * speed, rel=0.01)
    assert history.audit.closure < 1e-3


@kills("solvers.runup.linear:LinearCoupled.switch", "lost += m.planes[j].T", "lost -= m.planes[j].T")
def test_switching_keeps_the_momentum() -> None:
    """Rotor and liquid keep their momentum when a layer is let go."""
    machine = couple_linear(ROTOR.system(), [FILL], 20.0, Friction("linear", 1.0), 9.81, 64, False)
    machine.machine.rate[:4] = 0.3, -0.2, 0.5, 0.4
    before = MASS * machine.machine.rate[:2] + FILL.mass * (
        machine.machine.rate[:2] + machine.machine.rate[2:4]
    )
    machine.machine.shaft[0].spin = 2.0
    energy = machine.energy()
    brought = machine.switch()
    assert not machine.machine.active.any()
    np.testing.assert_allclose((MASS + FILL.mass) * machine.machine.rate[:2], before, rtol=1e-12)
    assert machine.energy() - energy == pytest.approx(brought, rel=1e-12)


@kills(
    "solvers.runup.linear:LinearCoupled.read",
    "(m.layers.curvature - 1.0) * np.abs(offset)",
    "m.layers.curvature * np.abs(offset)",
)
def test_depths() -> None:
    """A surface shifted by xi moves the liquid's moment by pi a^2 h xi: the offset gives the depths."""
    machine = couple_linear(ROTOR.system(), [FILL], 20.0, Friction(), 0.0, 64, False)
    machine.machine.place[2:4] = 3e-3, 4e-3
    found = machine.read()
    inner = FILL.surface_radius
    shift = 5e-3 * FILL.volume / (math.pi * inner**2 * 0.04)
    assert found.depth_max[0] == pytest.approx(FILL.depth + shift, rel=1e-12)
    assert found.depth_min[0] == pytest.approx(FILL.depth - shift, rel=1e-12)
    assert found.offset[0] == 3e-3 + 4e-3j


def test_stiff_empty_full_and_many() -> None:
    stiff = replace(ROTOR, stiffness=1e15, damping=0.0)
    history = run_up(stiff.system(), [FILL], RAMP, Friction("linear", 1.0), 0.0, ALONE, model=couple_linear)
    assert history.converged and history.amplitude.max() < 3.0 * 1e-3 * 60.0**2 / 1e15
    dry = run_up(ROTOR.system(), [], RAMP, numerics=ALONE, model=couple_linear)
    waves = run_up(ROTOR.system(), [], RAMP, numerics=ALONE)
    np.testing.assert_allclose(dry.deflection, waves.deflection, atol=1e-3 * dry.amplitude.max())
    empty = run_up(ROTOR.system(), [replace(FILL, volume=0.0)], RAMP, numerics=ALONE, model=couple_linear)
    np.testing.assert_allclose(empty.deflection, dry.deflection, atol=1e-12)
    full = replace(FILL, volume=FILL.chamber.capacity)
    solid = run_up(ROTOR.system(), [full], RAMP, numerics=ALONE, model=couple_linear)
    heavy = run_up(
        replace(ROTOR, mass=MASS + full.mass).system(), [], RAMP, numerics=ALONE, model=couple_linear
    )
    np.testing.assert_allclose(solid.deflection, heavy.deflection, atol=1e-12)
    flat = Fill(Chamber(0.25, 0.0025), WATER, 5e-4 / 16.0)
    many = run_up(ROTOR.system(), [flat] * 16, RAMP, Friction("linear", 2.0), 0.0, ALONE, model=couple_linear)
    one = run(couple_linear, Friction("linear", 2.0))
    np.testing.assert_allclose(many.deflection[:, 0], one.deflection[:, 0], atol=1e-10 * one.amplitude.max())


def test_unknown_model_is_refused() -> None:
    with pytest.raises(InputError, match="model"):
        runup_model("kdv")
    assert runup_model("linear") is couple_linear and runup_model("long_wave") is couple
