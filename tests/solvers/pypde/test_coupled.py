"""Rotor and layers as one py-pde equation: the compiled steps, py-pde's own, and what becomes of a fault."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from pde import ScalarField
from pde.trackers import CallbackTracker

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.liquid import Liquid
from meshes.arrays import Array
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.layer.records import Outcome
from solvers.pypde import CoupledSolver, RotorLayersPDE, TurnTracker, circle, run
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from solvers.runup.long_wave import couple
from tests.mutants import kills

SPIN = 40.0
TURN = 2.0 * math.pi / SPIN
WATER = Liquid("water", 1000.0, 1e-6)
PLANAR = Jeffcott(3.0, 3.0 * 15.0**2, 4.0, 2e-3)
FRICTION = Friction("quadratic", 0.02)


def layer(volume: float = 8e-4, plane: float = 0.0) -> Fill:
    return Fill(Chamber(0.15, 0.05, plane=plane), WATER, volume)


def equation(gravity: float = 0.0, friction: Friction = FRICTION) -> RotorLayersPDE:
    return RotorLayersPDE(PLANAR.system(), [layer()], SPIN, friction=friction, gravity=gravity)


def moving(machine: RotorLayersPDE, cells: int) -> Any:
    """A state in which everything moves."""
    theta = 2.0 * math.pi * (np.arange(cells) + 0.5) / cells
    area = machine.parts(machine.start(cells))[0] * (1.0 + 0.3 * np.cos(theta - 0.4))
    velocity = 0.2 * np.sin(theta)
    momentum = 0.15 * velocity * area - SPIN * np.square(area)
    return machine.start(cells, np.array([2e-3, -1e-3]), np.array([0.03, 0.05]), area, momentum)


@kills("solvers.pypde.coupled:_Layer._momentum_rate", "self.u * d_a / np", "0.0 * d_a / np")
@kills("solvers.pypde.coupled:_Layer._momentum_rate", "changed + 1j * self.spin * relative", "changed")
@kills("solvers.pypde.coupled:RotorLayersPDE.evolution_rate", "damping @ rate", "0.5 * damping @ rate")
@kills("solvers.pypde.coupled:RotorLayersPDE.evolution_rate", "layer.inertia @ seen", "0.0 * seen")
@kills("solvers.pypde.coupled:_Layer.accelerate", "d_q -= self.shear", "pass")
def test_the_steps_and_the_rates_agree() -> None:
    """Runge-Kutta on the equation against the coupled steps: they differ by the square of a cell."""
    left = []
    for cells in (32, 64):
        machine = equation(gravity=3.0)
        begin, stretch = moving(machine, cells), (0.0, 0.5 * TURN)
        ours = machine.solve(begin, stretch, tracker=None, solver="coupled")
        dt = TURN / (2 * cells)
        other = machine.solve(begin, stretch, dt=dt, tracker=None, solver="runge-kutta")
        left.append(abs(machine.deflection(ours) - machine.deflection(other))[0] / 2e-3)
        assert left[-1] < 0.02
    # Second order; the limiters cost some of it where the slopes change sign.
    assert left[1] < 0.4 * left[0]


@kills("solvers.pypde.coupled:_Layer._across", "row[OPEN] == 0.0", "row[OPEN] < 0.0")
def test_closed_baffles_in_steps_and_in_rates() -> None:
    """Closed baffles hold the flow of both back: the liquid's momentum is that of what passes nowhere."""
    walled = Fill(Chamber(0.15, 0.05, baffles=Baffles(3, 0.09, first_angle=0.3)), WATER, 8e-4)
    machine = RotorLayersPDE(PLANAR.system(), [walled], SPIN, friction=FRICTION, gravity=3.0)
    begin, stretch = moving(machine, 48), (0.0, 0.25 * TURN)
    ours = machine.solve(begin, stretch, tracker=None, solver="coupled")
    other = machine.solve(begin, stretch, dt=TURN / 96, tracker=None, solver="runge-kutta")
    left = abs(machine.deflection(ours) - machine.deflection(other))[0] / 2e-3
    # 0.004, a quarter of that with 96 cells; of the first order and 0.02 with flow through the walls.
    assert left < 0.008


@kills("solvers.pypde.coupled:_Layer._shear", "lost[wet] = wall_shear", "lost[wet] = 0.0 * wall_shear")
def test_the_law_of_the_wall_in_steps_and_in_rates() -> None:
    """The liquid's lag after a turn from half the spin, by the compiled steps and by Runge-Kutta."""
    machine = equation(friction=Friction("wall"))  # type: ignore[arg-type]
    begin = machine.start(32)
    theta = 2.0 * np.pi * (np.arange(32) + 0.5) / 32
    behind = (0.5 + 0.05 * np.cos(theta)) * SPIN * machine.fills[0].chamber.radius ** 2
    begin[1].data[...] -= behind * begin[0].data
    lag = begin[1].data.sum()
    steps = machine.solve(begin, (0.0, TURN), tracker=None, solver="coupled")
    other = machine.solve(begin, (0.0, TURN), dt=TURN / 64, tracker=None, solver="runge-kutta")
    gained = [end[1].data.sum() - lag for end in (steps, other)]
    # No force turns the layer but the wall's; the waves differ by the square of a cell.
    assert gained[0] > 0.01 * abs(lag)
    assert gained[1] == pytest.approx(gained[0], rel=0.01)


@kills(
    "solvers.pypde.coupled:CoupledSolver._load", "area / square, momentum", "area / square, 0.0 * momentum"
)
@kills(
    "solvers.pypde.coupled:CoupledSolver._store",
    "machine.state.rate[:, None]",
    "machine.state.place[:, None]",
)
def test_the_solver_is_the_run_up() -> None:
    """The same steps as those of a run-up at constant spin, to the last digit."""
    machine = equation(gravity=3.0)
    bare = couple(PLANAR.system(), [layer()], SPIN, FRICTION, 3.0, 32, False)
    assert bare.advance(TURN, 0.0, 0.8, 10**6) == Outcome.DONE
    found = machine.solve(machine.start(32), (0.0, TURN), tracker=None, solver="coupled")
    area, momentum, place, rate = machine.parts(found)
    np.testing.assert_array_equal(place, bare.state.place)
    np.testing.assert_array_equal(rate, bare.state.rate)
    # To SI units and back costs a rounding.
    np.testing.assert_allclose(area / 0.15**2, bare.state.area, rtol=1e-15)
    np.testing.assert_allclose(momentum / 0.15**4, bare.state.momentum, rtol=1e-14)


def test_stops_of_trackers_leave_the_steps_alone() -> None:
    """A tracker that only looks costs steps that land on its times, and no digit of what it does not cut."""
    machine, seen = equation(), []
    tracker = CallbackTracker(lambda state, t: seen.append((t, state.data.copy())), interrupts=TURN)
    found = machine.solve(machine.start(32), (0.0, 2.0 * TURN), tracker=[tracker], solver="coupled")
    first = machine.solve(machine.start(32), (0.0, TURN), tracker=None, solver="coupled")
    assert [t for t, _ in seen] == pytest.approx([0.0, TURN, 2.0 * TURN])
    np.testing.assert_array_equal(seen[1][1], first.data)
    np.testing.assert_array_equal(seen[2][1], found.data)


def test_a_tracker_may_move_the_state() -> None:
    """What a tracker writes into the state is what the steps go on from."""
    machine = equation()

    def stop(state: Any, t: float) -> None:
        if t > 0.5 * TURN:
            state.data[-4:] = 0.0

    tracker = CallbackTracker(stop, interrupts=TURN)
    found = machine.solve(machine.start(32), (0.0, 1.001 * TURN), tracker=[tracker], solver="coupled")
    free = machine.solve(machine.start(32), (0.0, 1.001 * TURN), tracker=None, solver="coupled")
    assert abs(machine.deflection(found)[0]) < 0.05 * abs(machine.deflection(free)[0])


@kills("solvers.pypde.coupled:RotorLayersPDE.row", "moment.real, moment.imag", "moment.imag, moment.real")
def test_a_moment_is_written_down_alike() -> None:
    """The row of a state is what the compiled steps keep: time, angle, places, moments of the layers."""
    machine = equation(gravity=3.0)
    followed: list[Array] = []
    tracker = CallbackTracker(
        lambda state, t: followed.append(machine.row(state, t)), interrupts=TURN
    )  # at the start and after the turn
    bare = couple(PLANAR.system(), [layer()], SPIN, FRICTION, 3.0, 32, False)
    bare.follow(4096)
    assert bare.advance(TURN, 0.0, 0.8, 10**6) == Outcome.DONE
    machine.solve(machine.start(32), (0.0, TURN), tracker=[tracker], solver="coupled")
    np.testing.assert_allclose(followed[-1], bare.followed()[-1], rtol=1e-12, atol=1e-15)


def test_turns_of_another_solver() -> None:
    """The moments at which the tracker is called take the place of the steps, and agree with them."""
    machine = equation()
    sizes: dict[str, list[Array]] = {"coupled": [], "runge-kutta": []}
    for solver, kept in sizes.items():
        own = solver == "coupled"

        def enough(steps: Array, layers: Array, state: Any, kept: list[Array] = kept) -> bool:
            kept.append(steps[-1])
            return len(kept) == 2

        tracker = TurnTracker(machine, TURN, enough, 1 if own else 64)
        options = {"follow": 8} if own else {"dt": TURN / 128}
        run(machine, machine.start(32), (0.0, 4.0 * TURN), [tracker], solver=solver, **options)
    ours, other = (np.array(kept) for kept in sizes.values())
    assert ours.shape == other.shape == (2, 6)
    np.testing.assert_allclose(ours[:, 0], other[:, 0], rtol=1e-12)
    # Second order in the cell: 2e-2 of the amplitude at 32 cells in the test of the equation above.
    np.testing.assert_allclose(ours[:, 2:4], other[:, 2:4], atol=0.02 * np.abs(ours[:, 2:4]).max())


def test_turns_are_handed_on_whole() -> None:
    """Each turn's steps begin where the last one's ended, with the layers at its marks and the state."""
    machine, turns = equation(), []

    def enough(steps: Array, layers: Array, state: Any) -> bool:
        turns.append((steps[0, 0], steps[-1, 0], layers.shape, state.data[-4, 0] - steps[-1, 2]))
        return len(turns) == 3

    tracker = TurnTracker(machine, TURN, enough)
    options = {"solver": "coupled", "follow": 8}
    _, outcome = run(machine, machine.start(16), (0.0, 9.0 * TURN), [tracker], **options)
    assert outcome is Outcome.DONE
    assert len(turns) == 3
    for k, (first, last, shape, gap) in enumerate(turns):
        assert k * TURN < first <= (k + 0.1) * TURN
        assert last == pytest.approx((k + 1) * TURN)
        assert shape == (8, 1, 16)
        assert gap == 0.0


def test_every_turn_has_as_many_steps() -> None:
    """At rest an eighth of a turn is five steps of 0.8 cells, whatever the rounding of the time."""
    machine, steps = RotorLayersPDE(PLANAR.system(), [layer(1e-5)], 157.3), []
    state, turn = machine.start(32), 2.0 * math.pi / 157.3
    for k in range(60):
        stretch = k * turn, (k + 1) * turn
        state = machine.solve(state, stretch, tracker=None, solver="coupled", follow=8)
        steps.append(machine.diagnostics["solver"]["steps"])
    assert set(steps) == {40}


def test_a_rotor_with_two_planes_and_gyroscopic_forces() -> None:
    """Runge-Kutta and the coupled steps agree for chambers in two planes as well."""
    rotor = TwoPlane(
        10.0, 0.5, 0.3, (Support(0.2, 4e4, 50.0), Support(-0.25, 5e4, 50.0)), (PlaneUnbalance(0.1, 1e-2),)
    )
    fills = [layer(plane=0.15), layer(5e-4, plane=-0.1)]
    machine = RotorLayersPDE(rotor.system(), fills, SPIN, friction=FRICTION)
    left = []
    for cells in (32, 64):
        begin, stretch = machine.start(cells, rate=np.array([0.05, 0.0, 0.1, 0.2])), (0.0, 0.5 * TURN)
        ours = machine.solve(begin, stretch, tracker=None, solver="coupled")
        dt = TURN / (2 * cells)
        other = machine.solve(begin, stretch, dt=dt, tracker=None, solver="runge-kutta")
        sizes = np.abs(machine.deflection(ours))
        left.append(np.abs(machine.deflection(ours) - machine.deflection(other)).max() / sizes.max())
    # Second order, as with one layer.
    assert left[0] < 0.1
    assert left[1] < 0.4 * left[0]


def test_liquid_at_the_bottom_is_a_mass() -> None:
    """Liquid that does not ride with the drum has no fields; its mass is the rotor's."""
    slow = RotorLayersPDE(PLANAR.system(), [layer()], 5.0, gravity=9.81)
    assert not slow.layers.any()
    state = slow.start(8, rate=np.array([0.1, 0.0]))
    assert len(state) == 4
    found = slow.solve(state, (0.0, 0.1), tracker=None, solver="coupled")
    heavy = Jeffcott(PLANAR.mass + layer().mass, PLANAR.stiffness, PLANAR.damping, PLANAR.unbalance)
    bare = RotorLayersPDE(heavy.system(), [], 5.0)
    other = bare.solve(bare.start(8, rate=np.array([0.1, 0.0])), (0.0, 0.1), tracker=None, solver="coupled")
    np.testing.assert_allclose(slow.parts(found)[2], bare.parts(other)[2], rtol=1e-12)


def test_faults() -> None:
    machine = equation()
    with pytest.raises(InputError, match="fields of the layers"):
        machine.evolution_rate(ScalarField(circle(8)))
    with pytest.raises(InputError, match="RotorLayersPDE"):
        CoupledSolver(object())  # type: ignore[arg-type]
    with pytest.raises(InputError, match="courant"):
        machine.solve(machine.start(8), 1.0, tracker=None, solver="coupled", courant=2.0)
    with pytest.raises(InputError, match="dt"):
        machine.solve(machine.start(8), 1.0, dt=0.1, tracker=None, solver="coupled")


def test_an_interrupt_stays_one() -> None:
    """py-pde takes a KeyboardInterrupt for an end of the run; whoever asked must hear of it."""
    machine = equation()

    def enough(*_: Any) -> bool:
        raise KeyboardInterrupt

    tracker, options = TurnTracker(machine, TURN, enough), {"solver": "coupled", "follow": 8}
    with pytest.raises(KeyboardInterrupt):
        run(machine, machine.start(16), (0.0, 3.0 * TURN), [tracker], **options)
