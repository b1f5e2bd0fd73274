"""Motions that repeat with the turn by Newton's method, beside linear theory and the march."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.liquid import Liquid
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.pypde import PeriodicNewtonSolver, PeriodicOrbit, RotorLayersPDE, run
from solvers.pypde.periodic import _Turns
from solvers.rotor.jeffcott import Jeffcott
from solvers.synchronous.response import response
from solvers.whirl.growth import asynchronous_growth
from tests.mutants import kills

SPIN = 150.0
TURN = 2.0 * math.pi / SPIN
WATER = Liquid("water", 1000.0, 1e-6)
RIG = Jeffcott(4.0, 4.0 * 110.0**2, 2.0 * 0.1 * 4.0 * 110.0, 6e-4)
SMALL = Fill(Chamber(0.065, 0.02), WATER, 1e-5)
FRICTION = Friction("linear", 3.0)


def equation(gravity: float = 0.0, fill: Fill = SMALL, spin: float = SPIN) -> RotorLayersPDE:
    return RotorLayersPDE(RIG.system(), [fill], spin, friction=FRICTION, gravity=gravity)


def found(
    machine: RotorLayersPDE, cells: int, known: PeriodicOrbit | None = None, **options: Any
) -> tuple[Any, PeriodicOrbit]:
    stretch = 0.0, 2.0 * math.pi / machine.spin
    options |= {"solver": "periodic_newton", "known": known}
    state, _ = run(machine, machine.start(cells), stretch, (), **options)
    told = machine.diagnostics["solver"]
    assert "orbit" in told, told["reason"]
    return state, told["orbit"]


@kills("solvers.pypde.periodic:_Turns.put", "data[rows:] = values", "data[rows:] = 0.9 * values")
def test_the_motion_repeats_and_keeps_its_liquid() -> None:
    """A turn by the steps that march leads back to it, to the tolerance over the smallest 1 - multiplier."""
    machine = equation(gravity=9.81)
    state, orbit = found(machine, 32)
    after = machine.solve(state, (0.0, TURN), tracker=None, solver="coupled", follow=8)
    for one, other in zip(machine.parts(state), machine.parts(after), strict=True):
        assert np.abs(one - other).max() < 3e-5 * np.abs(one).max()
    assert orbit.stable is True
    assert orbit.change < 1e-6
    volume = machine.parts(state)[0].sum() * 2.0 * math.pi / 32 * SMALL.chamber.height
    assert volume == pytest.approx(SMALL.volume, rel=1e-12)


def test_upright_it_is_the_statics_and_the_multiplier_that_of_linear_theory() -> None:
    """The circle of the exact equilibrium, and e^(sigma T) of the slowest whirl: second order in the cell."""
    machine = equation()
    exact = response(RIG, [SMALL], [SPIN], 0.0).coordinates[0]
    growth = float(asynchronous_growth(RIG, [SMALL], np.array([SPIN]), FRICTION)[0][0])
    errors, rates = [], []
    for cells in (32, 64):
        state, orbit = found(machine, cells)
        place = machine.parts(state)[2]
        errors.append(np.abs(place - exact.real).max() / np.abs(exact).max())
        rates.append(abs(math.log(abs(orbit.multipliers[0])) / (growth * TURN) - 1.0))
    assert errors[1] < 0.4 * errors[0] < 0.4 * 0.02
    assert rates[1] < 0.5 * rates[0] < 0.5 * 0.2


@kills("solvers.shooting:directions", "/ _DIFFERENCE", "/ (1.1 * _DIFFERENCE)")
def test_multipliers_are_those_of_all_directions() -> None:
    """The leading ones against the eigenvalues of the derivative in every direction, on few cells."""
    machine = equation(gravity=9.81)
    state, orbit = found(machine, 16)
    solver = PeriodicNewtonSolver(machine)
    solver._select_backend(state)
    turns = _Turns(solver, state, 0.0, TURN)
    point = turns.taken(state.data)
    for _ in range(3):  # until the pace of the steps repeats
        image = turns(point)
    turns.begin = turns.machine.state.pace.copy(), turns.machine.state.push.copy()
    image, step = turns(point), 1e-6
    whole = np.stack([(turns(point + step * way) - image) / step for way in np.eye(point.size)], axis=1)
    values = np.linalg.eigvals(whole)
    # That of the liquid's amount is 1: it does not change.
    kept = np.sort(np.abs(values[np.abs(values - 1.0) > 1e-6]))[::-1]
    assert np.abs(orbit.multipliers[:2]) == pytest.approx(kept[:2], abs=1e-3)


@kills("solvers.pypde.periodic:_Turns.finer", "rows - slope", "rows + slope")
def test_a_finer_mesh_has_the_same_wave() -> None:
    """Of a cosine straight lines miss a curve of (pi/32)^2/2 at most, where cells alone miss a slope."""
    machine = equation()
    turns = [_Turns(PeriodicNewtonSolver(machine), machine.start(cells), 0.0, TURN) for cells in (32, 64)]
    points = []
    for each in turns:
        theta = 2.0 * math.pi * (np.arange(each.cells) + 0.5) / each.cells
        area = 1e-4 * (1.0 + 0.3 * np.cos(theta))
        points.append(each.taken(machine.start(each.cells, area=area[None]).data))
    miss = np.abs(turns[1].finer(points[0]) - points[1])[:64] / np.abs(points[1][:64]).max()
    assert miss.max() < 0.005


@kills("solvers.pypde.periodic:_Turns.finer", "math.sqrt(0.5)", "1.0")
def test_from_half_the_cells_it_is_the_same() -> None:
    machine = equation(gravity=9.81)
    alone, orbit = found(machine, 64)
    half = found(machine, 32)[1]
    state, short = found(machine, 64, half)
    none = found(machine, 64, half, judged=False)[1]
    assert none.multipliers.size == 0
    assert none.turns < 0.6 * orbit.turns
    assert short.stable is True
    assert abs(short.multipliers[0]) == pytest.approx(abs(orbit.multipliers[0]), abs=5e-3)
    for one, other in zip(machine.parts(alone), machine.parts(state), strict=True):
        assert np.abs(one - other).max() < 5e-5 * np.abs(one).max()


@kills("solvers.pypde.periodic:_Turns.stirred", "[self.layers * self.cells : 2 * self", "[: self")
def test_closed_baffles_keep_what_is_between_them() -> None:
    parted = Fill(Chamber(0.065, 0.02, baffles=Baffles(2, 0.04)), WATER, 1e-5)
    machine = equation(gravity=2.0, fill=parted)
    state, orbit = found(machine, 32)
    begun = machine.parts(machine.start(32))[0]
    assert orbit.stable is True
    for rows in (slice(0, 16), slice(16, 32)):
        assert machine.parts(state)[0][0, rows].sum() == pytest.approx(begun[0, rows].sum(), rel=1e-10)


def test_what_does_not_repeat_is_a_failure_with_its_reason() -> None:
    """Next to the speed of capture the layer is thrown about, or falls."""
    machine = equation(gravity=9.81, spin=1.02 * math.sqrt(9.81 / SMALL.surface_radius))
    stretch = 0.0, 2.0 * math.pi / machine.spin
    run(machine, machine.start(32), stretch, (), solver="periodic_newton")
    told = machine.diagnostics["solver"]
    assert "orbit" not in told
    assert told["reason"]


def test_faults() -> None:
    machine = equation()
    state = machine.start(16)
    with pytest.raises(InputError, match="t_range"):
        machine.solve(state, (0.0, 2.0 * TURN), tracker=None, solver="periodic_newton")
    with pytest.raises(InputError, match="tolerance"):
        machine.solve(state, (0.0, TURN), tracker=None, solver="periodic_newton", tolerance=0.0)
    with pytest.raises(InputError, match="dt"):
        machine.solve(state, (0.0, TURN), dt=0.1, tracker=None, solver="periodic_newton")
