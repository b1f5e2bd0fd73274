"""Power of the motor at a constant speed: what supports and liquid turn into heat, by runs in time."""

from dataclasses import replace

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.pool import pool_of, wall_torque
from solvers.held.integrate import hold, start
from solvers.held.state import HeldKind, HeldMachine, HeldState, HoldNumerics
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.loads.machine import LoadedMachine, Point
from solvers.rotor.loads.turn import damping_power, liquid_power, turn_extremes
from solvers.rotor.tub import Mount, Tub
from solvers.runup.linear import couple_linear
from solvers.runup.loads import held_extremes
from solvers.runup.machine import Handover, Ramp
from solvers.runup.runup import EnergyAudit, RunupNumerics, run_up
from solvers.synchronous.response import response
from tests.mutants import kills
from tests.solvers.held.test_integrate import KNOWN, LAG, RIG, SCALE, SMALL, held, whirler
from tests.solvers.layer.two_layer_drums import COMPUTED
from tests.solvers.rotor.loads.test_loads import FILLS, TUB

FRICTION = Friction("linear", 2.0)


def _heats(
    rotor: Jeffcott | Tub, spin: float, durations: tuple[float, float], gravity: float
) -> tuple[float, float, EnergyAudit, EnergyAudit]:
    """Powers by which supports and liquid heat up between two times, by small waves in time."""
    numerics = RunupNumerics(cells=64, samples=50, companion=False, handover=Handover.RIDING)
    first, last = (
        run_up(
            rotor.system(), FILLS, Ramp(spin, 1.0001 * spin, 1e3, duration), FRICTION, gravity, numerics,
            model=couple_linear,
        ).audit
        for duration in durations
    )  # fmt: skip
    span = durations[1] - durations[0]
    return (last.support - first.support) / span, (last.friction - first.friction) / span, first, last


@kills("fluid.whirl:drag_power", "0.5 * layer.mass", "layer.mass")
@kills("fluid.whirl:drag_power", "whirl_speed - np.asarray(spin)", "whirl_speed + np.asarray(spin)")
@kills("solvers.rotor.loads.turn:liquid_power", "0.0 * speed, gravity", "-speed, gravity")
def test_gravity_costs_the_motor_power() -> None:
    """A lying ring that stands: heat of its friction, all of it by the torque of the wall."""
    rotor, spin = Jeffcott(10.0, 1e6, 1e3, 0.0), 30.0
    _, heat, first, last = _heats(rotor, spin, (6.0, 9.0), 9.81)
    machine, none = LoadedMachine(rotor, FILLS), np.zeros((1, 2), dtype=complex)
    found = liquid_power(machine, FRICTION, none, np.array([spin]))[0]
    # The trapezium with 64 steps a turn is right to (2 pi/64)^2/12 of the wave, twice that of its square.
    assert found == pytest.approx(heat, rel=2e-3)
    assert (last.drive - first.drive) / 3.0 == pytest.approx(heat, rel=2e-3)
    assert liquid_power(replace(machine, vertical=True), FRICTION, none, np.array([spin]))[0] == 0.0


@kills("solvers.rotor.loads.turn:liquid_power", "-speed, np.square(speed) * backward", "-speed, backward")
def test_whirl_against_the_spin_costs_the_motor_power() -> None:
    """A tub whose supports differ by direction: motor power is what dampers and liquid turn into heat."""
    spin, round_about = 14.0, Mount((0.0, 0.0, 0.0), along_axes=(300.0, 200.0, 400.0))
    tub = replace(TUB, dampers=(*TUB.dampers, round_about))
    support, heat, first, last = _heats(tub, spin, (15.0, 15.0 + 20.0 * np.pi / spin), 0.0)
    machine = LoadedMachine(tub, FILLS, vertical=True)
    answer = response(tub, FILLS, np.array([spin]), 0.0)
    dampers = damping_power(machine, answer.coordinates, answer.speed)[0]
    liquid = liquid_power(machine, FRICTION, answer.coordinates, answer.speed)[0]
    # The trapezium as above; what friction does to the rotor, k/Omega of the small liquid, is left out.
    assert dampers == pytest.approx(support, rel=3e-3)
    assert liquid == pytest.approx(heat, rel=5e-3)
    work = last.unbalance + last.drive - first.unbalance - first.drive
    assert work / (20.0 * np.pi / spin) == pytest.approx(dampers + liquid, rel=5e-3)


@kills("solvers.rotor.loads.turn:liquid_power", "speed * np.minimum", "np.minimum")
def test_a_pool_costs_what_its_walls_take() -> None:
    """Below the speed at which a ring stands the walls move past the liquid, which gravity holds."""
    rotor, spin = Jeffcott(10.0, 1e6, 1e3, 0.0), 4.0
    machine, none = LoadedMachine(rotor, FILLS), np.zeros((1, 2), dtype=complex)
    pool = pool_of(FILLS[0])
    assert pool is not None
    found = liquid_power(machine, Friction("stokes"), none, np.array([spin]))[0]
    assert found == pytest.approx(spin * float(wall_torque(FILLS[0], pool, Friction("stokes"), spin)))
    sticky = liquid_power(machine, Friction("linear", 1e3), none, np.array([spin]))[0]
    assert sticky == pytest.approx(spin * pool.mass * 9.81 * pool.arm)


@kills("solvers.rotor.loads.turn:liquid_power", "np.where(lies, held, own + drawn)", "own + drawn")
@kills("fluid.pool:_baffle_factor", "0.5 * fill.liquid.density", "fill.liquid.density")
def test_a_pool_under_baffles_beside_computed_flow() -> None:
    """Torque of computed two-phase flow (lying_drum.json, 6 mm, means over 0.6 s) within 35 %; no ring's."""
    rotor, none = Jeffcott(100.0, 1e6, 1e3, 0.0), np.zeros((4, 2), dtype=complex)
    spin = np.array([3.75, 5.0, 6.0, 30.0])
    power = liquid_power(LoadedMachine(rotor, (COMPUTED,)), Friction("quadratic", 0.0025), none, spin)
    assert (power / spin)[:3] == pytest.approx([2.47, 3.63, 4.82], rel=0.35)
    assert power[3] == 0.0


@pytest.mark.parametrize("law", ["none", "stokes", "wall"])
def test_only_friction_takes_power(law: str) -> None:
    """None without friction, more with more viscous liquid."""
    rotor, none = Jeffcott(10.0, 1e6, 1e3, 0.0), np.zeros((1, 2), dtype=complex)
    thick = tuple(Fill(f.chamber, replace(f.liquid, viscosity=1e-4), f.volume) for f in FILLS)
    found = [
        liquid_power(LoadedMachine(rotor, fills), Friction(law), none, np.array([60.0]))[0]
        for fills in (FILLS, thick)
    ]
    assert found == [0.0, 0.0] if law == "none" else found[1] > found[0] > 0.0


def _held(spin: float, gravity: float, cells: int, growth: float) -> HeldState:
    """The small rig held in time."""
    steady = response(RIG, [SMALL], [spin], 0.0).coordinates[0]
    machine, numerics = HeldMachine(RIG.system(), (SMALL,), FRICTION, gravity), HoldNumerics(cells=cells)
    return hold(machine, start(machine, spin, numerics, steady), numerics, growth)


@kills("solvers.held.convergence:Watch._balance", "dissipated * spin /", "dissipated /")
@kills("solvers.pypde.coupled:TurnTracker.handle", 'told["balance"] - self._balance', 'told["balance"]')
def test_heat_of_a_held_motion() -> None:
    """Dampers by the motion, liquid by the closed form of small waves that gravity drives."""
    spin = 60.0
    found = _held(spin, 9.81, 128, -1.0)
    machine = LoadedMachine(RIG, (SMALL,))
    speed = np.array([spin])
    dampers = damping_power(machine, found.coordinates[None], speed)[0]
    liquid = liquid_power(machine, FRICTION, found.coordinates[None], speed)[0]
    assert liquid > 0.1 * dampers
    # g/(Omega^2 a) is 0.043: of the waves' square, 0.002, a few; the mesh of 128 cells as much.
    assert found.heat - dampers == pytest.approx(liquid, rel=2e-2)


@kills("solvers.runup.loads:held_extremes", "np.min if name in LEAST else np.max", "np.min")
@kills("solvers.held.convergence:Watch._path", "range(2, 2 + n)", "range(1, 1 + n)")
def test_the_worst_of_a_held_motion_is_that_of_its_own_turns() -> None:
    """A limit cycle goes farther than its mean motion with the spin, and presses harder on the support."""
    points = (Point("axis", (0.0, 0.0, 0.0), gap=1e-2),)
    rotor, fill = whirler(0.02)
    rotor = replace(rotor, unbalance=2e-4 * rotor.mass)
    spin = next(iter(KNOWN)) * SCALE
    circle = _held(60.0, 0.0, 32, -1.0)
    cycle = held(rotor, fill, spin, Friction("linear", LAG * SCALE), HoldNumerics(cells=32), kick=0.1)
    assert circle.kind is not HeldKind.LIMIT_CYCLE and cycle.kind is HeldKind.LIMIT_CYCLE
    for machine, found in (
        (LoadedMachine(RIG, (SMALL,), gravity=0.0, points=points), circle),
        (LoadedMachine(rotor, (fill,), gravity=0.0, points=points), cycle),
    ):
        worst = held_extremes(machine, found.spin, found.path)
        # 48 steps a turn: between two of them a maximum is missed by (pi/48)^2/2, by the spline by less.
        assert worst.moved[0, 0] == pytest.approx(found.largest, rel=3e-3)
        assert worst.clearance[0, 0] == pytest.approx(1e-2 - found.largest, abs=3e-3 * found.largest)
        mean = turn_extremes(machine, found.coordinates[None], np.array([found.spin]))
        if found is circle:
            np.testing.assert_allclose(worst.holder, mean.holder, rtol=1e-3)
        else:
            assert worst.holder[0, 0] > 2.0 * mean.holder[0, 0]
            assert found.largest > 1.05 * found.least
    nothing = held_extremes(machine, 60.0, np.zeros((0, 3)))
    assert np.isnan(nothing.holder).all()
