"""The annular long waves as a py-pde equation: exact solutions, the layer's history, what users expect."""

from __future__ import annotations

import copy
import functools
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy
from pde import (
    PDE,
    CallbackTracker,
    CartesianGrid,
    DataTracker,
    FieldCollection,
    FileStorage,
    MemoryStorage,
    ScalarField,
    UnitGrid,
    VectorField,
)
from pde.solvers import registered_solvers
from pde.solvers.base import ConvergenceError

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.liquid import Liquid
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.layer.state import Numerics
from solvers.liquid_model import Whirl, drag_frequency
from solvers.pypde.grid import circle
from solvers.pypde.long_wave import AnnularLongWavePDE, FiniteVolumeSolver
from solvers.pypde.settle import simulate
from tests.mutants import kills
from tests.oracles.bare_layer import BareLayer

SPIN, R, H = 40.0, 0.15, 0.01
OIL = Liquid("oil", 900.0, 1e-3)
EPSILON = float(np.finfo(float).eps)
STILL = Whirl(SPIN, SPIN, 0.0)


def layer(relative_depth: float = 0.1) -> Fill:
    surface = R * (1.0 - relative_depth)
    return Fill(Chamber(R, H), OIL, math.pi * (R**2 - surface**2) * H)


def relative(found: Any, exact: Any) -> float:
    """Largest difference over the largest exact value."""
    return float(np.abs(np.asarray(found) - exact).max() / np.abs(exact).max())


# A manufactured solution, from the equations as the theory page prints them.

MADE = Whirl(SPIN, 30.0, 3e-3, ramp=0.08, gravity=9.81)
MADE_RATE, MADE_STOP = 150.0, 0.06
LAWS = {"none": 0.0, "linear": 3.0, "stokes": 0.0, "quadratic": 0.05}


@functools.cache
def made() -> tuple[Any, dict[str, Any]]:
    """A and q, and for each law the sources they need, of theta and t [theory: long_wave, eq. 1, 4, 8-10]."""
    theta, t = sympy.symbols("theta t", real=True)
    spin, turned = SPIN + MADE_RATE * t, SPIN * t + MADE_RATE * t**2 / 2
    area = R**2 / 10 * (1 + sympy.cos(theta - 12 * t) / 4 + sympy.sin(2 * theta + 5 * t) / 10)
    u = 0.4 * (1.5 + sympy.sin(theta + 9 * t))
    surface = sympy.sqrt(R**2 - 2 * area)
    log, depth, arm = sympy.log(R / surface), R - surface, (R**3 - surface**3) / 3
    part = t / MADE.ramp
    grown = part - sympy.sin(2 * sympy.pi * part) / (2 * sympy.pi)
    # In space the axis is at e^{i omega_w t} and gravity points to -i; the drum has turned.
    push = MADE.speed**2 * MADE.amplitude * grown * sympy.cos(MADE.speed * t - turned - theta)
    push += -MADE.gravity * sympy.sin(theta + turned)
    q = R * u * area - spin * area**2
    flux = u**2 * R**2 / 2 * (log + area / surface**2) + spin**2 * area**2 / 2
    flux += push * (arm - surface * area)
    stokes = sympy.sqrt(OIL.viscosity * drag_frequency(layer(), MADE) / 2) * (1 / depth + 2 / H)
    shears = {
        "none": sympy.Integer(0),
        "linear": LAWS["linear"] * depth * u,
        "stokes": stokes * depth * u,
        "quadratic": LAWS["quadratic"] * u * u,
    }
    mass = sympy.diff(area, t) + sympy.diff(R * u * log, theta)
    turn = sympy.diff(q, t) + sympy.diff(flux, theta) - sympy.diff(push, theta) * arm
    turn += MADE_RATE * R**2 * area
    numeric = functools.partial(sympy.lambdify, (theta, t), modules="numpy", cse=True)
    return numeric((area, q)), {law: numeric((mass, turn + R**2 * shear)) for law, shear in shears.items()}


class Sourced(AnnularLongWavePDE):
    """The equation with the sources of the manufactured solution."""

    def __init__(self, law: str) -> None:
        friction = Friction(law, LAWS[law])
        super().__init__(layer(), MADE, friction=friction, spin_rate=MADE_RATE)
        self.exact, self.sources = made()[0], made()[1][law]

    def evolution_rate(self, state: Any, t: float = 0.0) -> Any:
        rate, theta = super().evolution_rate(state, t), state.grid.axes_coords[0]
        rate.data += self.sources(theta, t)
        return rate


def check_manufactured(law: str = "linear", cells: tuple[int, ...] = (64, 128)) -> None:
    """Second order in space, with every force at work: whirl, ramp, gravity, changing spin, friction."""
    eq, errors = Sourced(law), []
    for n in cells:
        grid = circle(n)
        theta = grid.axes_coords[0]
        state = eq.start(grid)
        state.data[:] = eq.exact(theta, 0.0)
        # Error in time below 1e-7 of the state.
        final = eq.solve(state, MADE_STOP, solver="scipy", method="RK45", rtol=1e-7, atol=1e-11, tracker=None)
        exact = eq.exact(theta, MADE_STOP)
        errors.append([np.abs(final.data[k] - e).mean() / np.abs(e).mean() for k, e in enumerate(exact)])
        # Curvature of the modes 1 and 2 over 128 cells: (2 2 pi/128)^2/4 = 2.4e-3 of their share, 0.1 in A.
        assert errors[-1][0] < 2.4e-4 * (128 / n) ** 2
        assert errors[-1][1] < 2.4e-3 * (128 / n) ** 2
    orders = -np.diff(np.log2(errors), axis=0)
    # Seen: 2.05 ... 2.45, from above as the limiter's clipping at the extrema fades.
    # A little below two where the limiter clips extrema of one of the waves.
    assert np.all(orders > 1.9) and np.all(orders < 2.6), orders


@pytest.mark.parametrize("law", LAWS)
def test_manufactured_solution_is_met_with_second_order(law: str) -> None:
    check_manufactured(law, (32, 64, 128))


# The layer's own history.

DRIVEN = Whirl(SPIN, 28.0, 2e-3, ramp=0.3, gravity=0.5)


def check_history(law: str = "stokes", dispersion: bool = True) -> None:
    """Stopping where the bare kernel does, the solver takes the same steps: they agree to rounding."""
    fill, cells, periods = layer(), 48, 3
    friction = Friction(law, 0.02 if law == "quadratic" else 1.0)
    numerics = Numerics(cells, dispersion=dispersion)
    bare = BareLayer(fill, DRIVEN, friction, numerics)
    sums, masses = [], []
    places, moving = [], []
    eq = AnnularLongWavePDE(fill, DRIVEN, friction=friction, dispersion=dispersion)
    for period in range(periods + 1):
        if period:
            sums.append(bare.advance()[0])
            masses.append(2.0 * math.pi * bare.area.mean())
        lever = (1.0 - np.power(1.0 - 2.0 * bare.area, 1.5)) / 3.0
        middle = 2.0 * math.pi * (np.arange(cells) + 0.5) / cells
        seen = np.exp(1j * (middle - bare.drive.slip * bare.time))
        places.append(complex(lever @ seen / bare.area.sum()))
        state = eq.start(circle(cells))
        state.data[0], state.data[1] = bare.area * R**2, bare.momentum * SPIN * R**4
        rate = eq.evolution_rate(state, bare.time / SPIN).data[0] / (SPIN * R**2)
        moved = complex((rate * np.sqrt(1.0 - 2.0 * bare.area)) @ seen / bare.area.sum())
        moving.append(moved - 1j * bare.drive.slip * places[-1])
    answer = simulate(fill, DRIVEN, periods * DRIVEN.period, friction, numerics)
    stop, storage = periods * DRIVEN.period, MemoryStorage()
    final = eq.solve(eq.start(circle(cells)), stop, tracker=[storage.tracker(DRIVEN.period)])
    seen = np.mod(final.grid.axes_coords[0] - DRIVEN.slip * stop + math.pi, 2.0 * math.pi)
    # Times in seconds, not over Omega: other roundings, 1e3 steps of them, grown by the limiter's switches.
    assert np.abs(eq.depth(final)[np.argsort(seen)] - answer.depth).max() < 1e-11 * fill.depth
    assert np.abs(answer.depth - fill.depth).max() > 0.02 * fill.depth
    assert np.abs(R * bare.profile() - answer.depth).max() < 1e-11 * fill.depth
    # Loads of each period: pressure over that of a full drum, offset, turning.
    length, full = DRIVEN.period * SPIN, math.pi * DRIVEN.amplitude / R * (DRIVEN.speed / SPIN) ** 2
    pressure = np.array([complex(s.force_x, s.force_y) for s in sums]) / (length * full)
    moved = np.array([complex(s.offset_x, s.offset_y) for s in sums]) * R / length
    turned = np.array([s.turning for s in sums]) * SPIN / length
    # The liquid's momentum: what pushes it, the centripetal and the Coriolis part, what its velocity gains.
    push, whirl = np.array([complex(s.push_x, s.push_y) for s in sums]) / length, DRIVEN.speed / SPIN
    inertia = push + whirl**2 * moved / R - 2j * whirl * np.diff(places) / length - np.diff(moving) / length
    for found, exact in (
        (answer.pressure_ratio, pressure), (answer.offset, moved), (answer.mean_rotation, turned),
        (answer.force_ratio, np.array(masses) * inertia / full),
    ):  # fmt: skip
        assert np.abs(found - exact).max() < 1e-10 * np.abs(exact).max()


@pytest.mark.parametrize(
    ("law", "dispersion"), [("none", False), ("linear", False), ("stokes", True), ("quadratic", True)]
)
def test_history_is_the_layers(law: str, dispersion: bool) -> None:
    check_history(law, dispersion)


@kills("solvers.pypde.terms:place_at", "moved - 1j * slip * offset", "moved + 1j * slip * offset")
@kills("solvers.pypde.terms:place_at", "surface_radius(terms, held) * layer_rates", "layer_rates")
def test_the_liquid_moves_as_its_place_says() -> None:
    """A short time moves the centre of mass by the mean of the rates at its ends, a dry patch or not."""
    fill, cells = layer(), 64
    theta = circle(cells).axes_coords[0]
    eq = AnnularLongWavePDE(fill, DRIVEN, dispersion=True)
    for share in (1.0 + 0.3 * np.sin(theta), 2.0 * np.maximum(np.cos(theta), 0.0)):
        depth = share * fill.depth
        state, begin, gaps = eq.start(circle(cells), depth, 0.1 * np.cos(theta), time=0.4), 0.4, []
        first = eq.place(state, begin)
        for length in (4e-4, 2e-4):
            last = eq.place(eq.solve(state, (begin, begin + length), tracker=None), begin + length)
            change = (last.offset - first.offset) / length
            gaps.append(abs(change - 0.5 * (first.rate + last.rate)))
            assert gaps[-1] < 2e-3 * abs(change)
        # The trapezium's error, and Heun's, fall with the square of the time.
        assert gaps[1] < 0.5 * gaps[0]


@kills("solvers.pypde.terms:pressure_force", "terms.fill.chamber.radius**3", "terms.fill.chamber.radius**2")
@kills("solvers.pypde.terms:_rays", "ring(cells)[0] + 1j", "ring(cells)[0] - 1j")
def test_force_and_offset_are_the_layers() -> None:
    """The mean over a period of the force at each instant is what `simulate` reports; the offset as well."""
    fill, whirl, cells = layer(), Whirl(SPIN, 28.0, 3e-4, ramp=0.5), 48
    friction, periods, samples = Friction("linear", 3.0), 6, 48
    answer = simulate(fill, whirl, periods * whirl.period, friction, Numerics(cells))
    eq = AnnularLongWavePDE(fill, whirl, friction=friction)
    loads = DataTracker(lambda state, t: [eq.force(state, t), eq.offset(state)], whirl.period / samples)
    eq.solve(eq.start(circle(cells)), periods * whirl.period, tracker=[loads])
    times, table = np.array(loads.times), np.array(loads.data)
    table *= np.exp(-1j * whirl.slip * times)[:, None]
    last = slice(-samples - 1, None)
    force, offset = np.trapezoid(table[last], times[last], axis=0) / whirl.period
    scale = fill.full_mass * whirl.amplitude * whirl.speed**2
    # A few per cent of a transient are left after six periods, and its mean over steps of a hundredth of a
    # period is off by half a step.
    assert abs(force / scale - answer.pressure_ratio[-1]) < 1e-3 * abs(answer.pressure_ratio[-1])
    assert abs(offset - answer.offset[-1]) < 1e-3 * abs(answer.offset[-1])


def test_steps_are_of_second_order() -> None:
    """The solver's steps approach the same right-hand side integrated to rounding, with their square."""
    fill = layer()
    eq = AnnularLongWavePDE(fill, Whirl(SPIN, 20.0, 1e-4), friction=Friction("linear", 2.0), dispersion=True)
    state = eq.start(circle(32))
    exact = eq.solve(state, 0.1, solver="scipy", method="RK45", rtol=1e-11, atol=1e-15, tracker=None).data
    gaps = [
        np.abs(eq.solve(state, 0.1, courant=c, tracker=None).data[0] - exact[0]).mean()
        for c in (0.4, 0.2, 0.1)
    ]
    orders = -np.diff(np.log2(gaps))
    assert np.all(orders > 1.7) and np.all(orders < 2.3), orders


# Equilibria, conservation, changing spin.


def circle_depth(amplitude: float, surface: float, cells: int) -> np.ndarray:
    """Depth under a circle about the rotation axis, at distance `amplitude` from the drum's."""
    theta = circle(cells).axes_coords[0]
    across = np.sqrt(np.maximum(surface**2 - (amplitude * np.sin(theta)) ** 2, 0.0))
    return np.asarray(np.maximum(R - across + amplitude * np.cos(theta), 0.0))


@kills("solvers.pypde.terms:area_at", "- 0.5 * depth", "- depth")
@kills("solvers.pypde.terms:depth", "return 2.0 * area /", "return area /")
@kills(
    "solvers.pypde.terms:momentum_at",
    "- terms.spin(time) * np.square(area)",
    "+ terms.spin(time) * np.square(area)",
)
def test_synchronous_circle_is_an_equilibrium() -> None:
    """A circle about the rotation axis stays, and pulls as the statics have it."""
    amplitude, surface = 0.006, 0.135
    eq = AnnularLongWavePDE(layer(), Whirl(SPIN, SPIN, amplitude))
    state = eq.start(circle(64), circle_depth(amplitude, surface, 64))
    rate = eq.evolution_rate(state, 0.7).data
    # Rounding of the static head, over a cell's width, some ten operations.
    assert np.abs(rate[0]).max() < 100.0 * EPSILON * SPIN * R**2
    assert np.abs(rate[1]).max() < 100.0 * EPSILON * SPIN**2 * R**4
    # The liquid is the drum's disc less that of the air, which lies off the drum's axis by the deflection.
    mass = OIL.density * H * state[0].integral
    added, air = (OIL.density * math.pi * r**2 * H for r in (R, surface))
    assert abs(mass / (added - air) - 1.0) < 1e-13
    assert abs(eq.force(state, 0.7) / (added * SPIN**2 * amplitude) - 1.0) < 1e-12
    assert abs(eq.offset(state) * mass / (air * amplitude) - 1.0) < 1e-12
    assert np.abs(eq.velocity(state, 0.7)).max() < 1e-12 * SPIN * R
    np.testing.assert_allclose(eq.depth(state), R - eq.surface_radius(state), atol=4.0 * EPSILON * R)


@pytest.mark.parametrize(
    ("options", "amplitude"),
    [
        ({"solver": "euler", "dt": 5e-4}, 0.006),
        ({"solver": "runge-kutta", "dt": 2e-3}, 0.006),
        ({"solver": "finite_volume"}, 0.006),
        # Dry over a third and over half of the wall.
        ({"solver": "finite_volume"}, 0.04),
        ({"solver": "finite_volume"}, 0.1),
    ],
    ids=str,
)
def test_synchronous_circle_stays(options: dict[str, Any], amplitude: float) -> None:
    eq = AnnularLongWavePDE(layer(), Whirl(SPIN, SPIN, amplitude), friction=Friction("linear", 1.0))
    state = eq.start(circle(64), circle_depth(amplitude, R * (0.9 + (amplitude > 0.01) * 0.2), 64))
    assert (state.data[0].min() == 0.0) == (amplitude > 0.01)
    final = eq.solve(state, 0.5, tracker=None, **options)
    # Rounding of some 1e-16 a step, up to 1000 steps.
    assert relative(final.data[0], state.data[0]) < 1e-12


@kills(
    "solvers.pypde.terms:layer_rates",
    "going, a, q, none, spin, terms.spin_rate",
    "going, a, q, none, spin, 0.0",
)
@kills(
    "solvers.pypde.terms:layer_rates",
    "going, a, q, none, spin, terms.spin_rate",
    "going, a, q, none, spin, -terms.spin_rate",
)
@kills("solvers.pypde.terms:angular_momentum", "* fill.chamber.radius**2 * area", "* area")
def test_spin_up_without_friction_leaves_angular_momentum() -> None:
    """Without friction a drum that spins up leaves the liquid's angular momentum in space as it is."""
    eq = AnnularLongWavePDE(layer(), STILL, spin_rate=30.0)
    depth = 0.015 * (1.0 + 0.2 * np.cos(circle(32).axes_coords[0]))
    for options in ({"solver": "runge-kutta", "dt": 2e-3}, {"solver": "euler", "dt": 1e-3}):
        for state in (eq.start(circle(32)), eq.start(circle(32), depth)):
            before = eq.angular_momentum(state, 0.0)
            final = eq.solve(state, 0.4, tracker=None, **options)
            # Rounding of each of some 400 steps.
            assert abs(eq.angular_momentum(final, 0.4) / before - 1.0) < 400.0 * EPSILON
    # What it is: a rigid ring, rho h_c pi (R^4 - a^4)/2 Omega.
    ring = OIL.density * H * math.pi * (R**4 - (0.9 * R) ** 4) / 2.0
    uniform = eq.start(circle(32))
    assert abs(eq.angular_momentum(uniform, 0.0) / (ring * SPIN) - 1.0) < 1e-13
    # u A = -dOmega A (R^2 - A)/R: all that the drum has gained the liquid lags, spread as 1/r.
    final = eq.solve(uniform, 0.4, solver="runge-kutta", dt=2e-3, tracker=None)
    area = uniform.data[0][0]
    np.testing.assert_allclose(eq.velocity(final, 0.4), -12.0 * (R - area / R), rtol=1e-12)


def test_spin_up_with_friction_tends_to_a_lag() -> None:
    """R A u_t = -rate A (R^2 - A) - R^2 k h u has an exponential as its solution."""
    rate, k, stop = 30.0, 2.0, 0.8
    eq = AnnularLongWavePDE(layer(), STILL, friction=Friction("linear", k), spin_rate=rate)
    state = eq.start(circle(8))
    final = eq.solve(state, stop, solver="runge-kutta", dt=4e-3, tracker=None)
    area, depth = state.data[0][0], layer().depth
    decay = k * depth * R / area
    lag = rate * (R - area / R) / decay
    exact = -lag * -math.expm1(-decay * stop)
    # Runge-Kutta: (decay dt)^4/120 of it.
    np.testing.assert_allclose(eq.velocity(final, stop), exact, rtol=1e-9)


def test_dry_patches_lose_nothing() -> None:
    """A dry patch that goes round: mass to rounding and nothing below zero by the solver's own steps."""
    eq = AnnularLongWavePDE(layer(), Whirl(SPIN, 37.0, 0.04, gravity=2.0), friction=Friction("linear", 1.0))
    state = eq.start(circle(64), circle_depth(0.04, 1.1 * R, 64))
    storage, stop = MemoryStorage(), 2.0
    final = eq.solve(state, stop, tracker=[storage.tracker(0.02)])
    areas = np.array(storage.data)[:, 0]
    assert areas.min() == 0.0 and np.isfinite(final.data).all()
    # It has gone round by 6 rad: over most of the wall there was a time when it was dry.
    assert (areas.min(axis=0) < 1e-3 * R**2).mean() > 0.8
    # One rounding a cell at each of 100 stops, beside those of some 1000 steps.
    assert abs(final[0].integral / state[0].integral - 1.0) < 1e-13


def test_stock_steps_lose_nothing_either() -> None:
    """Beside a dry patch cells fall below zero by what a step takes, but what is there in all stays."""
    eq = AnnularLongWavePDE(layer(), Whirl(SPIN, 37.0, 0.04, gravity=2.0), friction=Friction("linear", 1.0))
    state = eq.start(circle(64), circle_depth(0.04, 1.1 * R, 64))
    final = eq.solve(state, 0.2, solver="runge-kutta", dt=5e-4, tracker=None)
    assert abs(final[0].integral / state[0].integral - 1.0) < 400.0 * EPSILON
    # A front runs at some 20 rad/s: a step takes a tenth of a cell off it.
    assert -0.1 * state.data[0].mean() < final.data[0].min() < 0.0
    assert np.isfinite([eq.force(final, 0.2), eq.offset(final)]).all()
    assert not eq.velocity(final, 0.2)[final.data[0] <= 0.0].any()


# What py-pde users expect.

ALL = {"rtol": 1e-8, "atol": 1e-12}
STOCK = {
    # The layer deviates by 1e-5 m^2; its waves turn by 1 rad on the way, the overtones by 3 rad. Fixed steps
    # leave a share (sigma dt)^p of that, sigma = 60 rad/s, p the order;
    "euler": ({"dt": 1e-4}, 6e-3),
    "runge-kutta": ({"dt": 5e-4}, 1e-5),
    "adams-bashforth": ({"dt": 1e-4}, 4e-5),
    "crank-nicolson": ({"dt": 5e-4, "maxiter": 1000, "maxerror": 1e-14}, 9e-4),
    "implicit": ({"dt": 1e-4, "maxiter": 1000, "maxerror": 1e-14}, 6e-3),
    # those that adapt, their tolerance over the deviation, some 50 times.
    "runge-kutta, adaptive": ({"solver": "runge-kutta", "tolerance": 1e-11}, 5e-5),
    "scipy": ({"method": "RK45"} | ALL, 1e-4),
    "scipy, LSODA": ({"solver": "scipy", "method": "LSODA"} | ALL, 1e-4),
    "scipy, BDF": ({"solver": "scipy", "method": "BDF"} | ALL, 1e-4),
}


@functools.cache
def arrived() -> tuple[AnnularLongWavePDE, Any, np.ndarray]:
    """A driven layer with friction, its start, and its deviation from rest after 0.05 s."""
    eq = AnnularLongWavePDE(layer(), Whirl(SPIN, 28.0, 1e-3), friction=Friction("linear", 2.0))
    state = eq.start(circle(16))
    final = eq.solve(state, 0.05, solver="scipy", method="DOP853", rtol=1e-11, atol=1e-15, tracker=None)
    return eq, state, final.data[0] - state.data[0]


@pytest.mark.parametrize("name", STOCK)
def test_stock_solvers_of_py_pde_work_and_agree(name: str) -> None:
    options, allowed = STOCK[name]
    eq, state, exact = arrived()
    final = eq.solve(state, 0.05, tracker=None, **({"solver": name} | options))
    assert relative(final.data[0] - state.data[0], exact) < allowed


def test_solver_is_registered_and_the_default() -> None:
    assert registered_solvers()["finite_volume"] is FiniteVolumeSolver
    eq, state, _ = arrived()
    ways = ({}, {"solver": "finite_volume"}, {"solver": FiniteVolumeSolver}, {"backend": "numpy"})
    found = [eq.solve(state, 0.05, tracker=None, **way).data for way in ways]
    assert all(np.array_equal(found[0], other) for other in found[1:])
    info = eq.diagnostics["solver"]
    assert info["status"] == "finished" and info["steps"] > 0 and info["backend"]["name"] == "numpy"


def test_trackers_and_storage_see_the_layer_at_their_times(tmp_path: Any) -> None:
    eq, state, _ = arrived()
    memory, file = MemoryStorage(), FileStorage(str(tmp_path / "layer.h5"))
    forces, depths = DataTracker(eq.force, 0.007), []
    trackers = [
        memory.tracker(0.01),
        file.tracker(0.01),
        forces,
        CallbackTracker(lambda s, t: depths.append((t, eq.depth(s))), interrupts=[0.0033, 0.021]),
    ]
    final = eq.solve(state, 0.05, tracker=trackers)
    assert list(final.labels) == ["area", "momentum"] and np.array_equal(final["area"].data, final.data[0])
    # Sums of the intervals, rounded.
    np.testing.assert_allclose(memory.times, np.arange(6) * 0.01, rtol=0.0, atol=1e-15)
    np.testing.assert_allclose(forces.times, np.arange(8) * 0.007, rtol=0.0, atol=1e-15)
    np.testing.assert_allclose([t for t, _ in depths], [0.0033, 0.021], rtol=0.0, atol=1e-15)
    assert np.array_equal(memory.data, np.array(file.data)) and len(file) == 6
    assert np.array_equal(memory.data[-1], final.data)
    assert eq.force(memory[3], memory.times[3]) == eq.force(file[3], memory.times[3])
    # A stored state can be taken up again.
    again = eq.solve(memory[3], (memory.times[3], 0.05), tracker=None)
    assert relative(again.data[0], final.data[0]) < 1e-3


def test_states_are_made_of_depth_and_velocity() -> None:
    eq = AnnularLongWavePDE(layer(), STILL, spin_rate=5.0)
    grid = circle(16)
    depth = 0.01 + 0.005 * np.cos(grid.axes_coords[0])
    speed = 0.3 * np.sin(grid.axes_coords[0])
    state = eq.start(grid, depth, speed, time=2.0)
    np.testing.assert_allclose(eq.depth(state), depth, rtol=1e-14)
    np.testing.assert_allclose(eq.surface_radius(state), R - depth, rtol=1e-14)
    # The angular momentum of u is what is left of q + Omega A^2, digits of A over those of u.
    np.testing.assert_allclose(eq.velocity(state, 2.0), speed, atol=1e-14)
    uniform = eq.start(grid)
    assert uniform[0].integral == pytest.approx(layer().volume / H, rel=1e-13)
    film = eq.start(grid, 1e-9)
    np.testing.assert_allclose(eq.depth(film), 1e-9, rtol=1e-13)


def test_an_adaptive_stepper_outlasts_steps_far_too_long() -> None:
    """From rest and with a gentle ramp steps grow until a trial leaves no layer: it is taken back."""
    eq = AnnularLongWavePDE(layer(), Whirl(SPIN, 28.0, 1e-3, ramp=3.0))
    state = eq.start(circle(64))
    final = eq.solve(state, 1.0, dt=0.9, solver="runge-kutta", adaptive=True, tolerance=1e-9, tracker=None)
    exact = eq.solve(state, 1.0, tracker=None)
    assert relative(eq.depth(final), eq.depth(exact)) < 1e-2


def test_failure_is_an_exception_with_the_time() -> None:
    # A push of nearly ten times the centrifugal force throws the liquid across the axis.
    wild = AnnularLongWavePDE(layer(0.5), Whirl(SPIN, 70.0, 0.3))
    with pytest.raises(ConvergenceError, match="between t = 0 s and 1 s"):
        wild.solve(wild.start(circle(32)), 1.0, tracker=None)
    assert wild.diagnostics["solver"]["status"] == "lost"
    eq = AnnularLongWavePDE(layer(), Whirl(SPIN, 30.0, 5e-3))
    with pytest.raises(ConvergenceError, match="at t = "):
        eq.solve(eq.start(circle(64)), 5.0, solver="runge-kutta", dt=0.05, tracker=None)
    stopped = AnnularLongWavePDE(layer(), STILL, spin_rate=-50.0)
    with pytest.raises(InputError, match="spins forward"):
        stopped.solve(stopped.start(circle(8)), 1.0, solver="euler", dt=0.01, tracker=None)


def test_the_equation_can_be_copied() -> None:
    eq, state, _ = arrived()
    again = copy.deepcopy(eq)
    assert np.array_equal(again.evolution_rate(state, 0.1).data, eq.evolution_rate(state, 0.1).data)
    _, info = eq.solve(state, 0.01, tracker=None, ret_info=True)
    assert info["solver"]["class"] == "FiniteVolumeSolver"


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"spin_rate": math.inf}, "spin_rate"),
    ],
)
def test_bad_parameters_are_named(change: dict[str, Any], field: str) -> None:
    with pytest.raises(InputError) as caught:
        AnnularLongWavePDE(layer(), STILL, **change)
    assert caught.value.field == field


@pytest.mark.parametrize(
    ("values", "field"),
    [
        ({"depth": -1e-3}, "depth"),
        ({"depth": math.nan}, "depth"),
        ({"depth": R}, "area"),
        ({"depth": 2.0 * R}, "area"),
        ({"velocity": math.inf}, "velocity"),
        ({"grid": UnitGrid([16], periodic=True)}, "grid"),
        ({"grid": CartesianGrid([[0, 2 * math.pi]], 16)}, "grid"),
        ({"grid": CartesianGrid([[0, 2 * math.pi]], 4, periodic=True)}, "grid"),
        ({"grid": UnitGrid([4, 4])}, "grid"),
    ],
)
def test_bad_starts_are_named(values: dict[str, Any], field: str) -> None:
    with pytest.raises(InputError) as caught:
        AnnularLongWavePDE(layer(), STILL).start(**({"grid": circle(16)} | values))
    assert caught.value.field == field


def test_bad_states_and_options_are_named() -> None:
    eq, grid = AnnularLongWavePDE(layer(), STILL), circle(16)
    one, line = ScalarField(grid, 1e-3), CartesianGrid([[0, 2 * math.pi]], 16)
    for wrong in (
        one,
        FieldCollection([one.copy()]),
        FieldCollection([one.copy(), VectorField(grid, 0.0)]),
        FieldCollection([ScalarField(grid, 1j), one.copy()]),
    ):
        with pytest.raises(InputError, match="state"):
            eq.evolution_rate(wrong)
    with pytest.raises(InputError, match="grid"):
        eq.depth(FieldCollection([ScalarField(line, 1e-3), ScalarField(line, 0.0)]))
    state = eq.start(grid)
    for options, field in (
        ({"dt": 1e-3}, "dt"),
        ({"courant": 0.0}, "courant"),
        ({"courant": 1.0}, "courant"),
    ):
        with pytest.raises(InputError, match=field):
            eq.solve(state, 1.0, tracker=None, **options)
    with pytest.raises(InputError, match="spin_rate"):
        AnnularLongWavePDE(layer(), STILL, spin_rate=1.0).solve(state, 1.0, tracker=None)
    with pytest.raises(InputError, match="time"):
        eq.solve(state, (-1.0, 1.0), tracker=None)
    # Sources that a subclass adds are not in the compiled steps.
    for other in (PDE({"u": "laplace(u)"}), Sourced("none")):
        with pytest.raises(InputError, match="pde"):
            FiniteVolumeSolver(other)  # type: ignore[arg-type]
    below = state.copy()
    below.data[0, 3] = -1e-9
    with pytest.raises(InputError, match="area"):
        eq.solve(below, 1.0, tracker=None)
    below.data[0, 3] = 0.5 * R**2
    with pytest.raises(InputError, match="area"):
        eq.force(below, 0.0)
    with pytest.raises(InputError, match="area"):
        eq.offset(eq.start(grid, 0.0))
    assert eq.terms.friction == Friction()


def test_the_example_of_the_theory_page(capsys: pytest.CaptureFixture[str]) -> None:
    page = (Path(__file__).parents[3] / "docs" / "theory" / "nonlinear.md").read_text(encoding="utf-8")
    example = page.partition("```python\n")[2].partition("```")[0]
    exec(compile(example, "long_wave.md", "exec"), {})
    words = capsys.readouterr().out.split()
    told = page.partition("It prints ")[2].split()
    assert float(words[0]) == pytest.approx(float(told[0]), abs=5e-4)
    assert float(words[2]) == pytest.approx(float(told[2]), abs=0.05)


@kills(
    "solvers.pypde.terms:body_force", "0.5 * terms.spin_rate * time) * time", "terms.spin_rate * time) * time"
)
@kills("solvers.pypde.terms:body_force", "whirl.speed * time - turned", "whirl.speed * time + turned")
@kills("solvers.pypde.terms:body_force", "- 1j * whirl.gravity", "+ 1j * whirl.gravity")
@kills("solvers.liquid_model:grown", "part - np.sin", "part + np.sin")
@kills("solvers.pypde.terms:body_force", "whirl.speed**2 * amplitude", "whirl.speed * amplitude")
@kills("solvers.pypde.terms:radial_force", "force.imag * table[1], force", "-force.imag * table[1], force")
@kills("solvers.pypde.terms:radial_force", "force.imag * table[3]", "-force.imag * table[3]")
@kills(
    "solvers.pypde.terms:LongWaveTerms.spin",
    "self.whirl.spin + self.spin_rate",
    "self.whirl.spin - self.spin_rate",
)
@kills("solvers.pypde.terms:layer_rates", "d_q -= _shear", "d_q += _shear")
@kills("solvers.pypde.terms:_shear", "* held * u", "* u")
def test_manufactured_solution_with_linear_friction() -> None:
    check_manufactured()


@kills("solvers.pypde.terms:Marcher.__init__", "slip=whirl.slip", "slip=-whirl.slip")
@kills("solvers.pypde.terms:Marcher.__init__", "weight=whirl.gravity / radius", "weight=whirl.gravity")
@kills("solvers.pypde.terms:LongWaveTerms.wall", "_lid(self), self.dispersion)", "0.0, self.dispersion)")
@kills("solvers.pypde.terms:LongWaveTerms.wall", "_lid(self), self.dispersion)", "_lid(self), False)")
@kills("solvers.pypde.terms:load_means", "ends[0].offset / radius, ends[1].offset / radius", "0j, 0j")
@kills("solvers.pypde.terms:load_means", "ends[0].rate / radius, ends[1].rate / radius", "0j, 0j")
@kills("solvers.pypde.terms:load_means", "terms.fill.chamber.height * radius**2", "radius**2")
def test_history_with_stokes_friction() -> None:
    check_history()
