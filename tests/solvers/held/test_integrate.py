"""States held at one speed: the statics where they are stable, limit cycles where they are not."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.liquid import Liquid
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.held.branch import HeldTask, held_branches
from solvers.held.integrate import _resampled, hold, hold_with_error, start
from solvers.held.state import HeldKind, HeldMachine, HeldState, HoldNumerics, Moment
from solvers.layer.inside import full_area
from solvers.pypde import PeriodicNewtonSolver, RotorLayersPDE, run
from solvers.rotor.jeffcott import Jeffcott
from solvers.runup.state import layer_capture
from solvers.sloshing.model import SmallWaves
from solvers.synchronous.response import response
from solvers.whirl.growth import asynchronous_growth
from tests.mutants import kills

WATER = Liquid("water", 1000.0, 1e-6)
RIG = Jeffcott(4.0, 4.0 * 110.0**2, 2.0 * 0.1 * 4.0 * 110.0, 6e-4)
SMALL = Fill(Chamber(0.065, 0.02), WATER, 1e-5)


def held(
    rotor: Jeffcott,
    fill: Fill,
    spin: float,
    friction: Friction,
    numerics: HoldNumerics,
    gravity: float = 0.0,
    kick: float = 0.0,
) -> HeldState:
    """A planar rotor from its synchronous motion."""
    steady = response(rotor, [fill], [spin], 0.0).coordinates[0]
    growth = float(asynchronous_growth(rotor, [fill], np.array([spin]), friction)[0][0])
    machine = HeldMachine(rotor.system(), (fill,), friction, gravity)
    return hold(machine, start(machine, spin, numerics, steady, kick), numerics, growth)


def test_upright_and_stable_it_is_the_statics() -> None:
    """To the mesh: second order in the cell and the step, below 1e-3 at 128 cells."""
    spin, exact = 150.0, abs(response(RIG, [SMALL], [150.0], 0.0).deflection[0])
    errors = []
    for cells in (32, 64, 128):
        numerics = HoldNumerics(cells=cells, tolerance=2e-5)
        found = held(RIG, SMALL, spin, Friction("linear", 3.0), numerics)
        assert found.kind is HeldKind.STEADY
        assert found.mass_error < 1e-12
        assert found.least <= found.amplitude <= found.largest
        assert abs(found.coordinates[0]) == pytest.approx(found.amplitude, rel=1e-4)
        # What of the tolerance of settling the energy still gains: the balance itself is of rounding.
        assert found.energy_error < 2e-5
        errors.append(abs(found.amplitude / exact - 1.0))
    assert errors[2] < 1e-3
    assert errors[2] < 0.45 * errors[1] < 0.45 * 0.45 * errors[0]


@kills("solvers.held.integrate:_march", '"solver": numerics.solver', '"solver": "coupled"')
def test_another_solver_comes_to_the_same_motion(monkeypatch: pytest.MonkeyPatch) -> None:
    """py-pde's Runge-Kutta steps share neither the time scheme nor the coupling with the compiled ones."""
    import solvers.pypde.coupled as road

    called: list[str] = []
    march = road.run
    monkeypatch.setattr(
        "solvers.pypde.coupled.run", lambda *a, **k: called.append(k["solver"]) or march(*a, **k)
    )
    friction, exact = Friction("linear", 60.0), abs(response(RIG, [SMALL], [150.0], 0.0).deflection[0])
    for solver in ("coupled", "runge-kutta"):
        found = held(RIG, SMALL, 150.0, friction, HoldNumerics(cells=8, tolerance=2e-3, solver=solver))
        assert found.settled
        # Second order from 4.5e-3 with 32 cells: 7e-2 with 8.
        assert found.amplitude == pytest.approx(exact, rel=0.07)
    assert called == ["coupled", "runge-kutta"]
    with pytest.raises(InputError, match="solver"):
        held(RIG, SMALL, 150.0, friction, HoldNumerics(cells=8, solver="implicit"))


@kills("solvers.held.convergence:Watch._left", "each / -math.expm1(self.slowest)", "0.0")
@kills("solvers.held.convergence:Watch._repeating", " and not ripples", "")
def test_gravity_across_leaves_the_mean() -> None:
    """With gravity across the axis the mean of the amplitude is that without, and the liquid ripples.

    The ripple itself is linear theory's; here it is only far above that without gravity.
    """
    spin, friction = 150.0, Friction("linear", 3.0)
    numerics = HoldNumerics(cells=64)
    plain = held(RIG, SMALL, spin, friction, numerics)
    found = held(RIG, SMALL, spin, friction, numerics, gravity=9.81)
    assert found.kind is HeldKind.PERIODIC
    # Second order in the wave that gravity makes: (0.4 mm over 1.2 mm of depth)^2 of the liquid's share.
    assert found.amplitude == pytest.approx(plain.amplitude, rel=2e-3)
    assert found.ripple[0] > 100.0 * plain.ripple[0]


@kills("solvers.held.convergence:Watch._lies", "full, self.lying + 1, 0", "full, 0, 0")
@kills("solvers.held.convergence:Watch._lies", " < -_LIES * spin", " < _LIES * spin")
def test_between_two_walls_a_layer_falls_as_without_an_inner_one() -> None:
    """Where it lies at the bottom, and fills its gap there, it is the mass that never turned with the drum.

    At speeds at which gravity is a tenth of the centrifugal acceleration it fills its gap and rides.
    """
    chamber, numerics = Chamber(0.065, 0.02, 0.055), HoldNumerics(cells=16, turns=64)
    for share, ratio, rides in ((0.4, 1.2, False), (0.95, 3.0, True)):
        fill = Fill(chamber, WATER, share * chamber.capacity)
        machine = HeldMachine(RIG.system(), (fill,), Friction("linear", 1.0), 9.81)
        begin = start(machine, ratio * layer_capture(fill, 9.81), numerics)
        found = hold(machine, begin, numerics)
        assert found.captured.tolist() == [rides]
        if rides:
            assert found.moment.area.max() > full_area(fill) * chamber.radius**2
            continue
        none = np.zeros((0, numerics.cells))
        laid = hold(machine, replace(begin, area=none, momentum=none, layers=found.captured), numerics)
        # What is left of the motion before is below the tolerance of both.
        assert found.settled and laid.settled
        assert found.amplitude == pytest.approx(laid.amplitude, rel=2.0 * numerics.tolerance)


SCALE = 60.0  # omega_n
MU, DEEP, LAG = 0.1, 0.1, 0.03


def whirler(damping: float) -> tuple[Jeffcott, Fill]:
    """A rotor without unbalance with a layer of a tenth of the radius; m_f is a tenth of its mass."""
    chamber = Chamber(0.15, 0.05)
    surface = chamber.radius * (1.0 - DEEP)
    fill = Fill(chamber, WATER, math.pi * (chamber.radius**2 - surface**2) * chamber.height)
    mass = fill.full_mass / MU
    return Jeffcott(mass, mass * SCALE**2, 2.0 * damping * mass * SCALE, 0.0), fill


# W/h0 and whirl speed over omega_n of the coupled march at 128 cells, linear friction 0.03 omega_n.
KNOWN = {1.2: (0.4147, 0.94461), 1.3: (0.5664, 0.95072)}


@kills(
    "solvers.held.convergence:_other_speed",
    "float(speeds[k]) - width, float(speeds[k]) + width",
    "-width, width",
)
@kills("solvers.held.convergence:Watch._elsewhere", "> _ELSEWHERE *", "< _ELSEWHERE *")
@pytest.mark.parametrize("ratio", KNOWN)
def test_a_whirl_that_excites_itself(ratio: float) -> None:
    """Where a small whirl grows the motion is a limit cycle of the size that marching in time has found."""
    rotor, fill = whirler(0.02)
    numerics = HoldNumerics(cells=64)
    found = held(rotor, fill, ratio * SCALE, Friction("linear", LAG * SCALE), numerics, kick=0.1)
    assert found.kind is HeldKind.LIMIT_CYCLE
    size, speed = KNOWN[ratio]
    # 64 against 128 cells: 0.1 % (0.5658 and 0.5664).
    assert found.amplitude / fill.depth == pytest.approx(size, rel=5e-3)
    assert found.whirl_speed / SCALE == pytest.approx(speed, rel=1e-3)
    # A window of turns is long beside a beat; second order in 1/64 of a turn, some times over.
    assert found.energy_error < 1e-2


@kills("solvers.held.convergence:Watch._decays", "self.orbit = found", "pass")
def test_unbalance_may_hold_what_would_whirl() -> None:
    """Where linear theory lets a whirl of the even layer grow, unbalance and gravity can keep it down.

    The kick dies: the motion repeats every turn, and is neither a limit cycle nor unsettled. The chambers are
    tall: floor and lid drag on long waves less than on exact ones.
    """
    critical = 1051.0 * math.pi / 30.0
    rotor = Jeffcott(40.0, 40.0 * critical**2, 2.0 * 0.1 * 40.0 * critical, 6e-3)
    fills = tuple(Fill(Chamber(radius, 0.2), WATER, 1e-4) for radius in (0.065, 0.05))
    friction, spin, numerics = Friction("stokes"), 1031.0 * math.pi / 30.0, HoldNumerics(cells=24)
    growth = float(asynchronous_growth(rotor, list(fills), np.array([spin]), friction)[0][0])
    assert growth > 0.0
    machine = HeldMachine(rotor.system(), fills, friction, 9.81)
    steady = response(rotor, list(fills), [spin], 0.0).coordinates[0]
    begin = start(machine, spin, numerics, steady, kick=0.1)
    found = hold(machine, begin, numerics, growth)
    assert found.kind is HeldKind.PERIODIC
    # A periodic motion's extremes do not move with the turns: they are those of one turn.
    assert found.largest - found.least < 1e-3 * found.amplitude
    # The orbit that it decays to is known long before.
    short = hold_with_error(machine, begin, numerics, growth)
    assert short.kind is HeldKind.PERIODIC
    assert 0.9 < abs(short.multipliers[0]) < 1.0
    assert short.turns < 0.5 * found.turns
    assert short.amplitude == pytest.approx(found.amplitude, rel=numerics.tolerance)


@kills("solvers.held.branch:_Chain._may_differ", "return kinds or", "return")
def test_the_way_down_is_another_one() -> None:
    """Beyond the linear edge, 1.4866, the whirl lives on if it is carried up; none starts from rest."""
    rotor, fill = whirler(0.02)
    friction, numerics = Friction("linear", LAG * SCALE), HoldNumerics(cells=24)
    machine = HeldMachine(rotor.system(), (fill,), friction)
    spins = SCALE * np.array([1.3, 1.45, 1.55])
    growth = asynchronous_growth(rotor, [fill], spins, friction)[0]
    tasks = [
        HeldTask(start(machine, spin, numerics, kick=0.1 if grows > 0.0 else 0.0), float(grows))
        for spin, grows in zip(spins.tolist(), growth.tolist(), strict=True)
    ]

    def one_by_one(tasks: Sequence[HeldTask]) -> Iterator[tuple[int, HeldState]]:
        for k, task in enumerate(tasks):
            yield k, hold_with_error(machine, task.begin, numerics, task.slowest)

    found = held_branches(tasks, one_by_one)
    assert found.hysteresis.tolist() == [False, False, True]
    # W/h0 carried up is 0.8126 at 128 cells.
    assert found.up[-1].amplitude / fill.depth == pytest.approx(0.8126, rel=0.02)
    assert found.down[-1].amplitude < 1e-6 * fill.depth


def test_bad_numerics() -> None:
    with pytest.raises(InputError, match="cells"):
        HoldNumerics(cells=4)
    with pytest.raises(InputError, match="courant"):
        HoldNumerics(courant=1.0)
    with pytest.raises(InputError, match="turns"):
        HoldNumerics(turns=3)
    with pytest.raises(InputError, match="tolerance"):
        HoldNumerics(tolerance=0.0)


@kills("solvers.held.integrate:_levelled", 'side="right"', 'side="left"')
@kills("solvers.held.integrate:_levelled", "area + (area.mean() - mean)[where]", "area")
def test_compartments_answer_as_their_elements() -> None:
    """Every compartment begins with its own liquid, however it is resampled, and the mean motion is theirs.

    The layer is a fifth of the radius deep: the mesh errs by 2e-3 at 64 cells, and small waves by the
    deflection over the depth, squared.
    """
    baffles = Baffles(8, 0.02, first_angle=0.1)
    fill = Fill(Chamber(0.065, 0.02, baffles=baffles), WATER, 6e-5)
    steady = response(RIG, [fill], [80.0], 0.0, SmallWaves()).coordinates[0]
    machine = HeldMachine(RIG.system(), (fill,), Friction("linear", 3.0), 0.0)
    begin = start(machine, 80.0, HoldNumerics(cells=64), 5.0 * steady)
    for moment in (begin, _resampled(machine, begin, 32)):
        cells = moment.area.shape[1]
        parts = np.roll(moment.area[0], -round(0.1 * cells / (2 * math.pi))).reshape(8, -1).mean(axis=1)
        np.testing.assert_allclose(parts, parts.mean(), rtol=1e-12)
        assert np.ptp(moment.area) > 1e-3 * moment.area.mean()
    found = hold_with_error(machine, begin, HoldNumerics(cells=64))
    assert found.settled and found.amplitude == pytest.approx(abs(steady[0]), rel=5e-3)
    few = HoldNumerics(cells=32)
    assert math.isnan(hold_with_error(machine, start(machine, 80.0, few), few).error)


def lying(cells: int, rpm: float, tolerance: float = 2e-4) -> tuple[HeldMachine, Moment, HoldNumerics, float]:
    """A rig with a horizontal axis, from its synchronous motion."""
    spin, friction = rpm * math.pi / 30.0, Friction("linear", 3.0)
    growth = float(asynchronous_growth(RIG, [SMALL], np.array([spin]), friction)[0][0])
    machine = HeldMachine(RIG.system(), (SMALL,), friction, 9.81)
    numerics = HoldNumerics(cells=cells, tolerance=tolerance)
    steady = response(RIG, [SMALL], [spin], 0.0).coordinates[0]
    return machine, start(machine, spin, numerics, steady), numerics, growth


@kills("solvers.shooting:fixed_point", "not left > tolerance", "not left > 1e3 * tolerance")
@kills("solvers.pypde.periodic:PeriodicNewtonSolver._orbit", "(_NEAR if known is None else 1.0)", "1e3")
def test_newton_and_the_march_come_to_the_same_motion() -> None:
    """Force of the liquid and rotor to 1e-6, where the march goes on until nothing changes any more."""
    for rpm in (900.0, 1400.0):
        machine, begin, numerics, growth = lying(64, rpm)
        found = hold_with_error(machine, begin, numerics, growth)
        assert found.multipliers.size
        assert abs(found.multipliers[0]) < 1.0
        tight = replace(numerics, tolerance=1e-8)
        marched = hold(machine, begin, tight, growth)
        assert marched.settled and not marched.multipliers.size
        assert found.kind is marched.kind is HeldKind.PERIODIC
        assert found.turns < marched.turns
        # The force on the rotor is the liquid's mass times the acceleration of its centre.
        for one, other in ((found.liquid, marched.liquid), (found.coordinates, marched.coordinates)):
            assert np.abs(one - other).max() < 1e-6 * np.abs(other).max()
        assert found.amplitude == pytest.approx(marched.amplitude, rel=1e-6)


@kills("solvers.shooting:Krylov.stable", "return False", "return True")
def test_a_motion_that_is_not_stable_is_marched() -> None:
    """At 300 rpm gravity throws the layer about, and the motion that repeats loses its stability."""
    machine, begin, numerics, growth = lying(32, 300.0)
    equation = RotorLayersPDE(
        machine.system, machine.fills, begin.spin, friction=machine.friction, gravity=9.81
    )
    run(equation, equation.start(32), (0.0, 2.0 * math.pi / begin.spin), (), solver=PeriodicNewtonSolver.name)
    orbit = equation.diagnostics["solver"]["orbit"]
    assert orbit.stable is False
    assert abs(orbit.multipliers[0]) > 1.0
    found = hold_with_error(machine, begin, numerics, growth)
    assert found.kind is HeldKind.LIMIT_CYCLE
    assert found.multipliers.size == 0
