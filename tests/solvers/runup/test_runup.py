"""Rotor and liquid layers through time, against exact solutions, balances and other solvers."""

from __future__ import annotations

import math
from dataclasses import fields, replace
from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.liquid import Liquid
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.layer.records import Outcome
from solvers.rotor.jeffcott import Jeffcott
from solvers.runup import long_wave
from solvers.runup.linear import couple_linear
from solvers.runup.long_wave import couple
from solvers.runup.machine import Handover, Motor, Ramp, Reading, RunupModel
from solvers.runup.runup import RunupHistory, RunupNumerics, run_up
from solvers.synchronous.response import response
from tests.mutants import kills
from validation.whirl_in_time import whirl_in_time

WATER = Liquid("water", 1000.0, 1e-6)
# The machine of the run-ups: 30 kg, 25 rad/s, damping ratio 0.06, one chamber of 0.25 m.
MASS, NATURAL, UNBALANCED = 30.0, 25.0, 0.1
ROTOR = Jeffcott(MASS, MASS * NATURAL**2, 2.0 * 0.06 * MASS * NATURAL, UNBALANCED)
CHAMBER = Chamber(0.25, 0.04)
RAMP = Ramp(5.0, 100.0, 8.0, 14.0)
PASSAGE = Ramp(20.137437437437413, 34.52132132132128, 8.0, 1.7979854854854835)  # of the resonance
ALONE = RunupNumerics(companion=False)
BRIEF = RunupNumerics(cells=32, samples=50, companion=False)


def layer(volume: float) -> Fill:
    return Fill(CHAMBER, WATER, volume)


@cache
def run(volume: float, rate: float, cells: int = 64) -> RunupHistory:
    fills = [layer(volume)] if volume else []
    return run_up(ROTOR.system(), fills, RAMP, Friction("linear", rate), 0.0, replace(ALONE, cells=cells))


# --- the rotor alone ---


def dry_reference(ramp: Ramp, rotor: Jeffcott, time: np.ndarray) -> np.ndarray:
    """Deflection of the dry rotor on a ramp that reaches its end, by an independent integrator."""

    def rates(t: float, y: np.ndarray) -> list[float]:
        spin, angle = ramp.start + ramp.rate * t, ramp.start * t + 0.5 * ramp.rate * t * t
        z, v = complex(y[0], y[1]), complex(y[2], y[3])
        force = rotor.unbalance * (spin**2 - 1j * ramp.rate) * complex(math.cos(angle), math.sin(angle))
        a = (force - rotor.damping * v - rotor.stiffness * z) / rotor.mass
        return [v.real, v.imag, a.real, a.imag]

    # At first the rotor is at rest in spite of its unbalance.
    found = solve_ivp(rates, (0.0, time[-1]), [0.0] * 4, "DOP853", time, rtol=1e-11, atol=1e-14)
    return found.y[0] + 1j * found.y[1]


def test_dry_ramp_is_of_second_order() -> None:
    """Error of second order against an independent integrator, lag behind the resonance included."""
    ramp = Ramp(5.0, 60.0, 10.0, 5.5)
    errors = []
    for cells in (64, 128):
        history = run_up(ROTOR.system(), [], ramp, numerics=replace(ALONE, cells=cells, samples=400))
        wanted = dry_reference(ramp, ROTOR, history.time)
        errors.append(np.abs(history.deflection[:, 0] - wanted).max() / np.abs(wanted).max())
    # The trapezium's phase error (Omega tau)^2/12 a radian: Omega tau <= 0.8 * 2 pi/128 for some 20 rad in
    # which the resonance is built up.
    assert errors[1] < 20.0 * (0.8 * 2.0 * math.pi / 128) ** 2 / 12.0
    assert 3.6 < errors[0] / errors[1] < 4.4


def test_dry_energy_closes_to_rounding() -> None:
    history = run(0.0, 0.0)
    # 11000 steps of rounding.
    assert history.audit.closure < 1e-11
    assert history.audit.change == pytest.approx(history.audit.unbalance - history.audit.support, rel=1e-10)


# --- balances ---


@pytest.mark.parametrize("enstrophy", [False, True])
def test_momentum_is_handed_over_to_rounding(enstrophy: bool) -> None:
    """Without support and unbalance the momentum of rotor and liquid stays, whatever the waves do."""
    free = Jeffcott(3.0, 1e-15, 0.0, 0.0)
    machine = couple(free.system(), [layer(8e-4)], 20.0, Friction(), 0.0, 32, False, enstrophy)
    machine.state.rate[:] = 0.05, -0.02

    def momentum() -> np.ndarray:
        velocity = machine.state.rate[:]
        total = free.mass * velocity
        for one, plane, _, relative in machine.measured():
            total = total + plane.T @ (one.mass * plane @ velocity + relative)
        return total

    before = momentum()
    assert machine.advance(0.4, 3.0, 0.8, 10**6) == Outcome.DONE
    # Rounding of some 100 steps.
    np.testing.assert_allclose(momentum(), before, rtol=0.0, atol=1e-12 * np.abs(before).max())


def test_every_step_is_written_down() -> None:
    """Steps followed end where the machine stands, whatever the slices; following changes no digit."""
    rotor = Jeffcott(3.0, 3.0 * 15.0**2, 4.0, 2e-3)
    found = []
    for rows in (0, 7, 500):
        machine = couple(rotor.system(), [layer(8e-4)], 20.0, Friction(), 0.0, 32, False)
        machine.follow(rows)
        for stop in (0.15, 0.3):
            assert machine.advance(stop, 0.0, 0.8, 10**6) == Outcome.DONE
        steps = machine.followed()
        assert steps.shape == (machine.sums.steps if rows else 0, 6)
        found.append((machine.state.place.copy(), machine.read().offset, steps))
    (place, offset, _), (_, _, few), (_, _, many) = found
    for other in found[1:]:
        np.testing.assert_array_equal(other[0], place)
    np.testing.assert_array_equal(few, many)
    assert np.all(np.diff(many[:, 0]) > 0.0)
    np.testing.assert_array_equal(many[-1, 2:4], place)
    # The moment is over R^3 and in the drum; the offset is that over the liquid's area, in space.
    fill = layer(8e-4)
    area = fill.volume / (fill.chamber.height * fill.chamber.radius**2)
    seen = complex(*many[-1, 4:]) / area * fill.chamber.radius * np.exp(1j * many[-1, 1])
    np.testing.assert_allclose(seen, offset[0], rtol=1e-9)


def test_energy_closes_with_the_mesh() -> None:
    """What the audit's parts leave vanishes with the square of the step in smooth motion under gravity."""
    rotor = Jeffcott(3.0, 3.0 * 15.0**2, 4.0, 2e-3)
    left = []
    for cells in (32, 64):
        machine = couple(rotor.system(), [layer(8e-4)], 30.0, Friction("quadratic", 0.02), 0.3, cells, False)
        machine.state.rate[:] = 0.02, -0.01
        energy = machine.energy()
        assert machine.advance(0.3, 4.0, 0.4, 10**6) == Outcome.DONE
        sums = machine.sums
        gained = sums.unbalance + sums.drive + sums.gravity
        remainder = gained - sums.support - sums.friction - (machine.energy() - energy)
        # The scheme's own loss and the profile's miss are left out: they too go down with the mesh.
        left.append(abs(remainder) / sums.unbalance)
    assert left[0] < 0.05
    assert left[1] < 0.4 * left[0]


def test_energy_of_a_free_machine_only_falls() -> None:
    """No damping, no friction, no unbalance: what bores and the scheme take is all that is lost."""
    free = Jeffcott(3.0, 3.0 * 15.0**2, 0.0, 0.0)
    machine = couple(free.system(), [layer(8e-4)], 30.0, Friction(), 0.0, 128, False)
    machine.state.place[0] = 2e-3
    reference = couple(free.system(), [layer(8e-4)], 30.0, Friction(), 0.0, 128, False).energy()
    before = machine.energy() - reference
    assert machine.advance(2.0, 0.0, 0.8, 10**6) == Outcome.DONE
    after = machine.energy() - reference
    # The rest of the second order: the scheme may give back what rounding and Heun's method miss.
    assert 0.98 * before < after <= before * (1.0 + 1e-4)


# --- run-ups against figures of another code ---


@pytest.mark.parametrize(
    "volume, rate, peak, at, end",
    [
        (0.0, 0.0, 22.4e-3, 29.9, 3.55e-3),
        (5e-4, 0.5, 18.71e-3, 29.04, 2.75e-3),
        (5e-4, 3.0, 16.88e-3, 28.64, 2.779e-3),
    ],
)
def test_runup_figures(volume: float, rate: float, peak: float, at: float, end: float) -> None:
    """Another code, with a constant rate of friction and the force by the wall's pressure: within 1 %."""
    history = run(volume, rate, 128)
    top = int(history.amplitude.argmax())
    assert history.converged
    assert history.amplitude[top] == pytest.approx(peak, rel=0.01)
    assert history.speed[top] == pytest.approx(at, rel=0.01)
    assert history.amplitude[-1] == pytest.approx(end, rel=0.01)
    assert history.mass_error < 1e-13
    assert history.audit.closure < 1e-3


@kills("solvers.runup.long_wave:couple", "cells if enstrophy else 0", "0")
def test_fluctuations_behind_bores_cut_a_whirl_and_leave_a_resonance() -> None:
    """Another code gives 13.8 mm with 1 l, k = 0.5, where bores without them leave the whirl the largest."""
    for volume, rate, given in ((5e-4, 3.0, None), (1e-3, 0.5, 13.8)):
        law, fine = Friction("linear", rate), replace(ALONE, cells=64 if given else 32)
        runs = [
            run_up(ROTOR.system(), [layer(volume)], RAMP, law, 0.0, replace(fine, enstrophy=with_them))
            for with_them in (False, True)
        ]
        plain, rolling = (1e3 * float(run.largest.max()) for run in runs)
        for run in runs:
            assert run.converged and run.audit.closure < 1e-3 and run.mass_error < 1e-12
        if given is None:
            # By what the other code found for volumes up to this one.
            assert abs(rolling / plain - 1.0) < 5e-3 and rolling != plain
        else:
            assert rolling == pytest.approx(given, rel=0.01) and rolling < 0.9 * plain


def test_frictionless_layer_does_nothing() -> None:
    dry, wet = run(0.0, 0.0), run(5e-4, 0.0)
    # It is never spun up: its mass alone, 0.5 of 30 kg of which half is felt, is there.
    assert wet.amplitude.max() == pytest.approx(dry.amplitude.max(), rel=0.01)
    assert wet.amplitude[-1] == pytest.approx(dry.amplitude[-1], rel=0.5 * 0.5 / MASS * 1.2)


# --- the steady state, and growth ---


@kills(
    "solvers.runup.runup:RunupHistory.liquid_position", "np.exp(-1j * self.angle)", "np.exp(1j * self.angle)"
)
@kills(
    "solvers.runup.runup:RunupHistory.liquid_position",
    "places @ self.layer_mass",
    "0.5 * places @ self.layer_mass",
)
def test_hold_comes_to_the_steady_response() -> None:
    """Held at a speed, the machine comes to the statics' answer, wet all round and with a dry patch."""
    drive = Ramp(59.9, 60.0, 1.0, 6.0)
    for volume in (5e-5, 5e-4):
        wet = response(ROTOR, [layer(volume)], [60.0], gravity=0.0)
        numerics = replace(ALONE, cells=128, samples=50)
        history = run_up(ROTOR.system(), [layer(volume)], drive, Friction("linear", 8.0), 0.0, numerics)
        found = history.deflection[-1, 0] * np.exp(-1j * history.angle[-1])
        # The static force of 128 cells is within 3e-4 of the full drum's; a dry edge costs their order.
        assert abs(found - wet.deflection[0]) < 2e-3 * abs(wet.deflection[0])
        place = history.liquid_position[-1]
        assert abs(abs(place) - wet.liquid_offset[0]) < 2e-3 * wet.liquid_offset[0]
        # The liquid lies along the deflection, which the unbalance's own direction fixes in the drum.
        assert abs(np.angle(place * np.exp(-1j * wet.liquid_angle[0]))) < 2e-3
        assert (history.depth_min[-1, 0] < 1e-6) == bool(wet.dry_patch[0])


def wolf(spin: float, rate: float = 0.0, zeta: float = 0.0) -> complex:
    """Root with the largest growth, mu = 0.1, h0/R = 0.1: the linear equations of rotor and liquid offset."""
    kappa, mu = 1.0 / 0.81, 0.1
    share = mu * (1.0 - 1.0 / kappa)
    mass = np.array([[1.0 + share, share], [1.0, 1.0 + kappa]], dtype=complex)
    damping = np.diag([2.0 * zeta, -4j * kappa * spin + rate * (1.0 + kappa)])
    stiffness = np.diag([1.0, -2.0 * kappa * spin**2 - 1j * spin * rate * (1.0 + kappa)])
    top = np.hstack((np.zeros((2, 2)), np.eye(2)))
    low = np.hstack((-np.linalg.solve(mass, stiffness), -np.linalg.solve(mass, damping)))
    values = np.linalg.eigvals(np.vstack((top, low)))
    return complex(values[values.real.argmax()])


def thin_layer(mu: float = 0.1, depth: float = 0.1, zeta: float = 0.0) -> tuple[Jeffcott, Fill]:
    """A machine with natural frequency 1 rad/s and that ratio of the full drum's mass to the rotor's."""
    radius, height = 0.1, 0.05
    volume = math.pi * height * radius**2 * (1.0 - (1.0 - depth) ** 2)
    fill = Fill(Chamber(radius, height), WATER, volume)
    mass = fill.full_mass / mu
    return Jeffcott(mass, mass, 2.0 * zeta * mass, 0.0), fill


@pytest.mark.parametrize("spin", [1.15, 1.25, 1.4])
@pytest.mark.parametrize("dispersion, error", [(False, 0.006), (True, 0.002)])
def test_whirl_grows_as_the_linear_theory_says(spin: float, dispersion: bool, error: float) -> None:
    """Long waves run 0.4 % faster than the exact ones, which moves the growth by as much."""
    rotor, fill = thin_layer()
    numerics = RunupNumerics(cells=128, dispersion=dispersion)
    found = whirl_in_time(rotor.system(), [fill], spin, Friction(), 150.0, numerics)
    wanted = wolf(spin)
    assert found.linear
    assert found.growth == pytest.approx(wanted.real, rel=error)
    assert found.whirl_speed == pytest.approx(wanted.imag, rel=1e-3)


@pytest.mark.parametrize("spin", [0.9, 1.0, 1.7])
def test_whirl_dies_outside_the_band_with_liquid_friction(spin: float) -> None:
    rotor, fill = thin_layer(zeta=0.02)
    rate = 0.3
    numerics = RunupNumerics(cells=128, dispersion=True)
    found = whirl_in_time(rotor.system(), [fill], spin, Friction("linear", rate), 250.0, numerics)
    wanted = wolf(spin, rate * 0.1 / 0.095, 0.02)
    assert wanted.real < 0.0
    # The slowest mode stands alone once the others have died; the scheme's own loss adds to its decay.
    assert found.growth == pytest.approx(wanted.real, rel=0.03)


# --- motors, gravity ---


def test_motor_runs_up_a_balanced_rotor() -> None:
    """A balanced rotor on a straight torque curve: Omega = Omega_0 + (Omega_1 - Omega_0)(1 - e^{-ct})."""
    rotor = replace(ROTOR, unbalance=0.0)
    drive = Motor(10.0, 0.5, (0.0, 100.0), (50.0, 0.0), 2.0)
    history = run_up(rotor.system(), [], drive, numerics=replace(ALONE, samples=20))
    wanted = 100.0 - 90.0 * np.exp(-history.time)
    # Steps of at most 0.8 * 2 pi/128 rad, trapezium: (tau c)^2/12 of the change.
    np.testing.assert_allclose(history.speed, wanted, rtol=1e-5)
    assert history.audit.motor == pytest.approx(0.25 * (history.speed[-1] ** 2 - 100.0), rel=1e-5)


def test_weak_motor_hangs_at_the_resonance() -> None:
    """The Sommerfeld effect: below the power that the resonance eats, the speed stays there."""
    rotor = replace(ROTOR, damping=0.5 * ROTOR.damping)
    peak = rotor.unbalance / (2.0 * 0.03 * rotor.mass)
    needed = rotor.damping * NATURAL * peak**2
    spins = {}
    for name, torque in (("weak", 0.5 * needed), ("strong", 4.0 * needed)):
        drive = Motor(5.0, 1.0, (0.0, 200.0), (torque, 0.5 * torque), 20.0)
        spins[name] = run_up(rotor.system(), [], drive, numerics=replace(ALONE, samples=400)).speed
    assert 0.8 * NATURAL < spins["weak"][-1] < NATURAL
    assert spins["strong"].max() > 2.0 * NATURAL


@kills(
    "solvers.runup.long_wave:Coupled._rearrange",
    "plane.T @ momentum * gone",
    "plane.T @ momentum * (not gone)",
)
@kills("solvers.runup.long_wave:Coupled.fall", "_AGAIN * max", "1.4 * max")
@kills(
    "solvers.runup.long_wave:Coupled._rearrange", "-self.spin * np.square(self.area[j])", "0.0 * self.area[j]"
)
@kills(
    "solvers.runup.long_wave:Coupled._assemble",
    "mass += weight * plane.T @ plane",
    "mass -= weight * plane.T @ plane",
)
def test_switching_keeps_the_momentum() -> None:
    """Rotor and liquid keep their momentum when a layer is let go, fallen or caught again."""
    for change in ("switch", "fall"):
        machine = couple(ROTOR.system(), [layer(2e-3)], 20.0, Friction("linear", 3.0), 9.81, 32, False)
        machine.state.rate[:] = 0.3, -0.2
        assert machine.advance(0.2, -20.0, 0.8, 10**6) == Outcome.DONE
        total = 2.0
        before = MASS * machine.state.rate[:] + total * machine.state.rate[:]
        (_, _, _, relative) = machine.measured()[0]
        # What is at stake is no rounding: the layer moves in its drum.
        assert np.abs(relative).max() > 1e-2 * np.abs(before).max()
        energy = machine.energy()
        machine.state.shaft[0].spin = 2.0 if change == "switch" else machine.spin
        if change == "switch":
            energy = machine.energy()
            (_, _, _, relative) = machine.measured()[0]
        brought = machine.switch() if change == "switch" else machine.fall(Outcome.AT_AXIS)
        assert not machine.active.any()
        after = (MASS + total) * machine.state.rate[:]
        np.testing.assert_allclose(after, before + relative, atol=1e-13)
        assert machine.energy() - energy == pytest.approx(brought, rel=1e-9)
        fallen = machine.spin
        velocity = machine.state.rate[:].copy()
        machine.state.shaft[0].spin = 1.25 * fallen if change == "fall" else 20.0
        machine.switch()
        assert machine.active.all()
        # Caught liquid is at rest in the drum: no momentum of its own.
        np.testing.assert_allclose(machine.state.rate[:], velocity, atol=1e-13)
        np.testing.assert_allclose(machine.measured()[0][3], 0.0, atol=1e-9)
        assert abs(machine.read().mean_rotation[0]) < 1e-12 * machine.spin


@kills(
    "solvers.runup.long_wave:Coupled._ring_offsets",
    "(1.0 + surface + np.square(surface)) / 3.0",
    "(1.0 + surface) / 2.0",
)
@kills(
    "solvers.runup.long_wave:Coupled._ring_offsets", "1j * (lever @ angles[1])", "1j * (lever @ angles[0])"
)
@kills(
    "solvers.runup.long_wave:Coupled._readings",
    "velocity += spin[:, None, None] * area",
    "velocity -= spin[:, None, None] * area",
)
@kills("solvers.runup.long_wave:Coupled._readings", "1.0 - surface.max(axis=2", "1.0 - surface.min(axis=2")
def test_reading() -> None:
    """Offset, depths and rotation of a layer that is known."""
    machine = couple(ROTOR.system(), [layer(2e-3)], 20.0, Friction(), 0.0, 64, False)
    theta = 2.0 * math.pi * (np.arange(64) + 0.5) / 64
    mean = float(machine.area[0, 0])
    machine.area[0] = mean * (1.0 + 0.1 * np.cos(theta - 0.5))
    machine.momentum[0] = machine.area[0] * (1.5 - 20.0 * machine.area[0])
    machine.state.place[:] = 1e-3, 2e-3
    machine.state.shaft[0].angle = 0.7
    found = machine.read()
    surface = 0.25 * np.sqrt(1.0 - 2.0 * machine.area[0])
    lever = np.sum((0.25**3 - surface**3) / 3.0 * np.exp(1j * theta))
    offset = lever / np.sum((0.25**2 - surface**2) / 2.0) * np.exp(0.7j)
    assert found.offset[0] == pytest.approx(offset, rel=1e-12)
    assert found.deflection[0] == 1e-3 + 2e-3j
    assert found.depth_max[0] == pytest.approx(0.25 - surface.min(), rel=1e-12)
    assert found.depth_min[0] == pytest.approx(0.25 - surface.max(), rel=1e-12)
    # 1.5 rad/s at the wall; over the depth, by L/A, a little more.
    log = np.log(0.25 / surface)
    assert found.mean_rotation[0] == pytest.approx(1.5 * log.sum() / machine.area[0].sum(), rel=1e-12)


@kills(
    "solvers.runup.machine:Ramp.corners",
    "self.start + self.rate * rise",
    "self.start + 0.9 * self.rate * rise",
)
@kills("solvers.runup.machine:Ramp.corners", "self.duration + rise, self.start", "self.duration + rise, top")
@kills("solvers.runup.samples:_times", "np.diff(corners[1]) / np.diff(corners[0])", "np.diff(corners[1])")
@kills(
    "solvers.runup.runup:EnergyAudit.remainder",
    "self.gravity + self.captured",
    "self.gravity - self.captured",
)
@kills("solvers.runup.state:CoupledRotor.ridden", "RELEASE * self.capture", "self.capture")
@kills(
    "solvers.runup.state:layer_capture",
    "gravity / fill.surface_radius",
    "gravity / fill.chamber.radius * 0.5",
)
def test_capture_and_release_in_the_balance() -> None:
    """Below sqrt(g/a) the liquid lies at the bottom; the balance of energy goes on through both changes."""
    fill = layer(5e-4)
    speed = math.sqrt(9.81 / fill.surface_radius)
    drive = Ramp(3.0, 20.0, 8.0, 2.5, back=True)
    numerics = replace(ALONE, cells=64, samples=400)
    history = run_up(ROTOR.system(), [fill], drive, Friction("linear", 30.0), 9.81, numerics)
    caught, rising = history.captured[:, 0], history.time < 2.5
    # Samples are a tenth of a rad/s apart.
    assert history.speed[rising & caught].min() == pytest.approx(speed, rel=0.035)
    assert history.speed[~rising & caught].min() == pytest.approx(0.98 * speed, rel=0.015)
    assert history.speed.max() == pytest.approx(20.0, rel=1e-12)
    # What capture brings in, less what release takes, would be seen in a balance that closes to a hundredth:
    # of second order, 6e-3 at 64 cells and 4e-4 at 256.
    assert 2.0 * history.audit.captured > 0.015 * history.audit.unbalance
    assert history.audit.closure < 0.01


@kills("solvers.runup.runup:run_up", "cells=numerics.cells // 2", "cells=numerics.cells")
def test_error_estimate_is_of_the_size_of_the_error() -> None:
    """The estimate is of the size of the error."""
    ramp = Ramp(20.0, 40.0, 20.0, 1.5)
    numerics = RunupNumerics(cells=32, samples=100)
    coarse = run_up(ROTOR.system(), [layer(5e-4)], ramp, Friction("linear", 3.0), 0.0, numerics)
    fine = run_up(
        ROTOR.system(), [layer(5e-4)], ramp, Friction("linear", 3.0), 0.0, replace(numerics, cells=128)
    )
    error = np.abs(coarse.amplitude - fine.amplitude).max() / fine.amplitude.max()
    assert error < coarse.error_estimate < 8.0 * error


def test_liquid_is_captured_and_let_go() -> None:
    """Where it lies before it is caught, and what is recorded of it then."""
    fill = layer(5e-4)
    speed = math.sqrt(9.81 / fill.surface_radius)
    drive = Ramp(3.0, 20.0, 4.0, 5.0, back=True)
    numerics = replace(ALONE, cells=64, samples=1000)
    history = run_up(ROTOR.system(), [fill], drive, Friction("linear", 3.0), 9.81, numerics)
    caught = history.captured[:, 0]
    assert history.converged
    rising = np.gradient(history.speed) > 0.0
    assert history.speed[rising & caught].min() == pytest.approx(speed, rel=0.01)
    assert history.speed[~rising & caught].min() == pytest.approx(0.98 * speed, rel=0.01)
    # Liquid at the bottom fills a segment of the section's share of the circle up to a level; its centroid.
    level = np.linspace(-0.25, 0.25, 200_001)
    width = 2.0 * np.sqrt(np.maximum(0.25**2 - level**2, 0.0))
    filled = np.cumsum(width) * (level[1] - level[0]) <= 5e-4 / 0.04
    centroid = (level * width)[filled].sum() / width[filled].sum()
    assert history.offset[0, 0] == pytest.approx(centroid, rel=1e-4)
    assert np.all(np.isnan(history.depth_max[~caught, 0]))


def test_liquid_that_gravity_throws_about_falls_back() -> None:
    """Hardly any friction: the layer caught at the speed of capture collapses; the run goes on without it."""
    ramp = Ramp(8.0, 14.0, 3.0, 2.0)
    numerics = replace(ALONE, cells=32, samples=400)
    history = run_up(ROTOR.system(), [layer(2e-3)], ramp, Friction(), 9.81, numerics)
    assert history.converged
    caught = history.captured[:, 0]
    assert np.isfinite(history.amplitude).all()
    # Caught above sqrt(g/a), and once fallen, not again before a fifth more.
    changes = np.flatnonzero(np.diff(caught.astype(int)) == -1)
    assert changes.size > 0
    for change in changes:
        again = history.speed[change + 1 :][caught[change + 1 :]]
        assert again.size == 0 or again.min() > 1.15 * history.speed[change]


# --- extremes ---


@pytest.mark.parametrize("cells", [16, 32])
def test_rounding_does_not_grow_where_a_trough_falls_dry(cells: int) -> None:
    """Inputs a rounding apart give one answer: films of no mass rule neither the steps nor the motion."""
    found = []
    for unbalance in UNBALANCED * (1.0 + 3e-15 * np.arange(3)):
        rotor = Jeffcott(MASS, MASS * NATURAL**2, 2.0 * 0.06 * MASS * NATURAL, unbalance)
        numerics = RunupNumerics(cells=cells, samples=1000, companion=False)
        found.append(run_up(rotor.system(), [layer(5e-4)], PASSAGE, Friction("linear", 0.5), 0.0, numerics))
    first, *others = found
    # The trough is dry; a step a sample is enough, which it was not for the films that ran away.
    assert np.nanmin(first.depth_min) < 1e-5 * CHAMBER.radius and first.steps == 999
    for other in others:
        # Steps multiply a rounding of 1e-15 by some 1e5 at the drying edge; without the fade, by 1e12.
        assert abs(other.amplitude - first.amplitude).max() < 1e-9 * first.amplitude.max()


def test_stiff_supports_hold_the_rotor() -> None:
    rotor = replace(ROTOR, stiffness=1e15, damping=0.0)
    history = run_up(
        rotor.system(),
        [layer(5e-4)],
        RAMP,
        Friction("linear", 1.0),
        0.0,
        replace(ALONE, cells=32, samples=50),
    )
    assert history.converged
    # Nothing moves but by the unbalance's force over the stiffness, ringing to twice as much.
    assert history.amplitude.max() < 3.0 * UNBALANCED * 100.0**2 / 1e15


def test_no_damping_at_all_stays_finite_on_a_ramp() -> None:
    rotor = replace(ROTOR, damping=0.0)
    history = run_up(
        rotor.system(), [layer(5e-4)], RAMP, Friction(), 0.0, replace(ALONE, cells=32, samples=50)
    )
    assert history.converged
    assert np.isfinite(history.amplitude).all()


@pytest.mark.parametrize("friction", [Friction("linear", 0.2), Friction("linear", 5.0), Friction("wall")])
@pytest.mark.parametrize("tip", [0.0, 0.24, 0.235])
def test_a_drum_that_is_braked_leaves_its_liquid_behind(friction: Friction, tip: float) -> None:
    """Upright, from 80 to 0.5 rad/s in 0.8 s: the run ends well, liquid runs on and makes no energy."""
    chamber = replace(CHAMBER, inner_radius=0.2, baffles=Baffles(8, tip) if tip else None)
    fill, drive = Fill(chamber, WATER, 7e-4), Ramp(0.5, 80.0, 100.0, 1.5, back=True)
    numerics = replace(ALONE, cells=64, samples=400)
    history = run_up(ROTOR.system(), [fill], drive, friction, 0.0, numerics)
    assert history.converged and not history.audit.faults
    # A thousandth of the works is the scheme's with 64 cells.
    assert history.audit.closure < 1e-3 and history.mass_error < 1e-12
    assert history.audit.friction > 0.0 and history.audit.baffles >= 0.0
    own, slowed = history.speed + history.mean_rotation[:, 0], np.diff(history.speed, append=0.0) < 0.0
    # The drum has 100 rad/s^2, which is more than any of these walls; it stands, and its liquid does not.
    assert (own[slowed][-15:] > history.speed[slowed][-15:]).all() and own[-1] > history.speed[-1] + 2.0
    assert own.max() < 1.1 * 80.0


def test_liquid_that_long_plates_throw_to_the_axis_is_told() -> None:
    """Upright, six plates up to a fifth of the radius, stopped in an eighth of a second."""
    chamber = Chamber(0.37, 0.1, baffles=Baffles(6, 0.073))
    fill, drive = Fill(chamber, WATER, 0.0107), Ramp(7.0, 47.0, 320.0, 0.3, back=True)
    numerics = replace(ALONE, cells=48, samples=100)
    history = run_up(ROTOR.system(), [fill], drive, Friction("quadratic", 0.15), 0.0, numerics)
    assert history.outcome is Outcome.AT_AXIS and "towards the axis" in history.reason


@pytest.mark.parametrize(("rate", "filled", "rotor"), [(5.0, 0.3, 10.0), (8.0, 0.4, 20.0), (12.0, 0.3, 10.0)])
def test_linear_friction_carries_a_pool_on_a_light_rotor(rate: float, filled: float, rotor: float) -> None:
    """Smooth and lying, no inner wall: momentum jumps where the pool comes near to the axis."""
    unit = math.sqrt(9.81 / 0.25)
    stiffness = rotor * (1.5 * unit) ** 2
    system = Jeffcott(rotor, stiffness, 0.3 * rotor * 1.5 * unit, rotor * 5e-4)
    chamber = Chamber(0.25, 0.1)
    fill, drive = Fill(chamber, WATER, filled * chamber.capacity), Ramp(1.0, 5.0 * unit, 4.0, 8.2)
    numerics = replace(ALONE, cells=64, samples=200, handover=Handover.CARRIED)
    history = run_up(system.system(), [fill], drive, Friction("linear", rate), 9.81, numerics)
    assert history.converged and history.captured[-1, 0]
    assert history.audit.closure < 1e-3 and history.mass_error < 1e-12


@pytest.mark.parametrize("rate", [1.0, 1e4])
def test_slow_and_fast_ramps(rate: float) -> None:
    duration = 20.0 if rate == 1.0 else 0.02
    drive = Ramp(20.0, 35.0, rate, duration)
    numerics = RunupNumerics(cells=32, samples=200)
    history = run_up(ROTOR.system(), [layer(5e-4)], drive, Friction("linear", 3.0), 0.0, numerics)
    assert history.converged
    assert math.isfinite(history.error_estimate)
    dry = run_up(ROTOR.system(), [], drive, numerics=numerics)
    steady = response(ROTOR, [layer(5e-4)], np.linspace(20.0, 35.0, 301), gravity=0.0)
    largest = np.abs(steady.deflection).max()
    if rate == 1.0:
        # Slow: it comes close to the steady resonance, from below.
        assert 0.8 * largest < history.amplitude.max() < 1.1 * largest
    else:
        # Fast: no time to be carried away, with liquid or without.
        assert history.amplitude.max() < 0.1 * np.abs(dry.amplitude).max() + 0.1 * largest


def test_empty_and_full_chambers_are_nothing_and_a_mass() -> None:
    numerics = replace(ALONE, cells=16, samples=200)
    dry = run_up(ROTOR.system(), [], RAMP, numerics=numerics)
    empty = run_up(ROTOR.system(), [layer(0.0)], RAMP, numerics=numerics)
    np.testing.assert_array_equal(empty.deflection, dry.deflection)
    full = run_up(ROTOR.system(), [layer(CHAMBER.capacity)], RAMP, numerics=numerics)
    heavy = replace(ROTOR, mass=ROTOR.mass + 1000.0 * CHAMBER.capacity)
    solid = run_up(heavy.system(), [], RAMP, numerics=numerics)
    np.testing.assert_allclose(full.deflection, solid.deflection, rtol=1e-12, atol=1e-15)


def test_chambers_add_up() -> None:
    """Sixteen equal chambers are one of sixteen times the height."""
    ramp = Ramp(20.0, 35.0, 20.0, 1.0)
    numerics = replace(ALONE, cells=16, samples=20)
    flat = Fill(Chamber(0.25, 0.0025), WATER, 5e-4 / 16.0)
    many = run_up(ROTOR.system(), [flat] * 16, ramp, Friction("linear", 2.0), 0.0, numerics)
    one = run_up(ROTOR.system(), [layer(5e-4)], ramp, Friction("linear", 2.0), 0.0, numerics)
    # The rounds end at a disagreement of 1e-6 of the acceleration.
    np.testing.assert_allclose(many.deflection[:, 0], one.deflection[:, 0], atol=1e-6 * one.amplitude.max())
    np.testing.assert_allclose(many.liquid_position, one.liquid_position, atol=1e-6 * 0.25)


def test_one_run_gives_the_same_digits_again() -> None:
    ramp = Ramp(20.0, 35.0, 20.0, 1.0)
    numerics = replace(ALONE, cells=32, samples=20)
    runs = [run_up(ROTOR.system(), [layer(5e-4)], ramp, Friction("stokes"), 0.0, numerics) for _ in range(2)]
    np.testing.assert_array_equal(runs[0].deflection, runs[1].deflection)


@pytest.mark.parametrize("volume, said", [(0.9999 * CHAMBER.capacity, "axis")])
def test_what_cannot_go_on_says_so(volume: float, said: str) -> None:
    history = run_up(
        ROTOR.system(),
        [layer(volume)],
        RAMP,
        Friction("linear", 1.0),
        0.0,
        replace(ALONE, cells=16, samples=20),
    )
    assert not history.converged
    assert said in history.reason
    assert np.isfinite(history.amplitude).all()


@pytest.mark.parametrize(
    "change",
    [{"rate": 0.0}, {"stop": 4.0}, {"duration": -1.0}, {"start": math.nan}],
)
def test_wrong_ramps_are_refused(change: dict[str, float]) -> None:
    with pytest.raises(InputError):
        replace(RAMP, **change)


@pytest.mark.parametrize(
    "change",
    [{"speeds": (0.0,)}, {"speeds": (1.0, 0.0)}, {"inertia": 0.0}, {"torques": (1.0, math.inf)}],
)
def test_wrong_motors_are_refused(change: dict[str, object]) -> None:
    with pytest.raises(InputError):
        replace(Motor(1.0, 1.0, (0.0, 1.0), (1.0, 0.0), 1.0), **change)


def test_unknown_friction_is_refused() -> None:
    with pytest.raises(InputError, match="friction"):
        run_up(ROTOR.system(), [layer(5e-4)], RAMP, Friction("honey"))


# --- pictures of the layers ---


@pytest.mark.parametrize("model", [couple, couple_linear])
def test_snapshots_are_of_the_run_itself(model: RunupModel) -> None:
    """They change nothing, stand at recorded times, hold all of the liquid and reach its depths."""
    ramp = Ramp(20.0, 40.0, 20.0, 1.0)
    rotor, fills, friction = ROTOR.system(), [layer(5e-4)], Friction("linear", 3.0)
    plain = run_up(rotor, fills, ramp, friction, 0.0, BRIEF, model=model)
    found = run_up(rotor, fills, ramp, friction, 0.0, BRIEF, model=model, snapshots=np.linspace(0.0, 1.0, 5))
    np.testing.assert_array_equal(found.deflection, plain.deflection)
    assert plain.snapshots is None
    kept = found.snapshots
    assert kept is not None
    assert kept.depth.shape == (5, 1, 32)
    # Half a step between two samples at most.
    np.testing.assert_allclose(found.time[kept.sample], np.linspace(0.0, 1.0, 5), atol=0.5 / 49)
    np.testing.assert_allclose(
        kept.theta, np.mod(2.0 * np.pi * (np.arange(32) + 0.5) / 32 + np.pi, 2 * np.pi) - np.pi
    )
    crest = kept.depth[:, 0].max(axis=1)
    if model is couple:
        np.testing.assert_allclose(crest, found.depth_max[kept.sample, 0], rtol=1e-12)
        area = CHAMBER.radius * kept.depth[:, 0] - 0.5 * kept.depth[:, 0] ** 2
        np.testing.assert_allclose(area.mean(axis=1) * 2.0 * np.pi * CHAMBER.height, 5e-4, rtol=1e-12)
    else:
        # The crest of a cosine is within half a cell of some middle.
        rise, seen = found.depth_max[kept.sample, 0] - fills[0].depth, crest - fills[0].depth
        assert np.all(seen <= rise * (1.0 + 1e-9))
        assert np.all(seen >= rise * math.cos(math.pi / 32) * (1.0 - 1e-9))
        # It stands where the liquid's centre of mass does, in the drum.
        place = found.offset[kept.sample[-1], 0] * np.exp(-1j * found.angle[kept.sample[-1]])
        top = kept.theta[kept.depth[-1, 0].argmax()]
        assert abs(np.angle(np.exp(1j * top) / place)) <= math.pi / 32 * (1.0 + 1e-9)


def test_every_outcome_but_the_end_has_a_reason() -> None:
    assert [bool(outcome.message) for outcome in Outcome] == [
        outcome is not Outcome.DONE for outcome in Outcome
    ]


@pytest.mark.slow
@pytest.mark.parametrize("cells", [128, 256])
def test_a_weak_motor_gets_through_with_dispersion(cells: int) -> None:
    """With dispersion the run comes to its end as without it, on fine cells too."""
    from leblanc.scene.examples import example
    from validation.trade.answers import taken_run

    ends = []
    for dispersion in (False, True):
        history = taken_run(example("weak_motor"), "long_wave", cells, dispersion).history
        assert history.time[-1] == 60.0
        ends.append((history.speed[-1], history.amplitude.max()))
    # What disperses is a part of the waves' height, and that a part of the amplitude.
    np.testing.assert_allclose(ends[1], ends[0], rtol=1e-3)


@kills("solvers.runup.runup:_at_once", "kept + 1", "kept")
@kills("solvers.runup.runup:_at_once", "np.concatenate((own, later))", "np.concatenate((later, own))")
def test_all_samples_at_once_have_the_digits_of_one_by_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two chambers, one of them empty, a ramp and a motor: in one compiled call and leg by leg."""
    fills = [layer(2e-3), layer(0.0)]
    motor = Motor(5.0, 0.5, (0.0, 90.0), (4.0, 1.0), 3.0)
    for drive in (RAMP, motor):
        given = ROTOR.system(), fills, drive, Friction("linear", 1.0), 0.0, replace(ALONE, samples=60)
        at_once = run_up(*given, snapshots=(0.0, 1.0))
        with monkeypatch.context() as patch:
            patch.setattr(long_wave.Coupled, "settled", False)
            one_by_one = run_up(*given, snapshots=(0.0, 1.0))
        assert at_once.steps == one_by_one.steps and at_once.audit == one_by_one.audit
        for name in (each.name for each in fields(Reading)):
            found, wanted = getattr(at_once, name), getattr(one_by_one, name)
            # Sums over many samples at once may take the cells in another order.
            np.testing.assert_allclose(found, wanted, rtol=1e-14, atol=1e-300)
        assert at_once.snapshots is not None and one_by_one.snapshots is not None
        np.testing.assert_array_equal(at_once.snapshots.depth, one_by_one.snapshots.depth)
        np.testing.assert_array_equal(at_once.snapshots.sample, one_by_one.snapshots.sample)
