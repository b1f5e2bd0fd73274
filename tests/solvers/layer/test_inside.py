"""A layer that reaches an inner wall, in the compiled steps: its place at rest, its mass, and the slot."""

from __future__ import annotations

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.liquid import Liquid
from meshes.chamber import Chamber
from solvers.layer.inside import NOTHING, OPEN, SLOT_SPEED, Inside, full_area, inside_of
from solvers.layer.records import LOADS, Drive, Outcome, Wall, records
from solvers.layer.state import ring
from solvers.layer.step import centre, march, scratch
from solvers.rotor.jeffcott import Jeffcott
from solvers.runup.long_wave import couple
from tests.mutants import kills

RIM, MEAN, AMPLITUDE = 0.8, 0.12, 0.1


def fill(inner: float = 0.12) -> Fill:
    return Fill(Chamber(0.15, 0.05, inner), Liquid("water", 1000.0, 1e-6), 8e-4)


@kills("solvers.layer.inside:full_area", "0.5 * (1.0 - ratio)", "(1.0 - ratio)")
@kills("solvers.layer.inside:full_area", "inner_radius / fill.chamber.radius", "inner_radius")
def test_the_full_gap() -> None:
    """Its area is half the difference of the squares."""
    assert full_area(fill()) == pytest.approx(0.5 * (1 - 0.8**2), rel=1e-15)
    assert full_area(fill(0.0)) == OPEN
    assert inside_of(fill(), 16).slot == SLOT_SPEED**2 and NOTHING.full == OPEN


def exact_centre() -> float:
    """Centre of mass of liquid between two circles about the drum's axis, its surface a circle off it."""
    theta = 2 * np.pi * (np.arange(20000) + 0.5) / 20000

    def surface(radius: float) -> np.ndarray:
        root = np.sqrt(np.maximum(radius**2 - (AMPLITUDE * np.sin(theta)) ** 2, 0.0))
        return np.clip(root - AMPLITUDE * np.cos(theta), RIM, 1.0)

    low, high = 0.5, 1.3
    for _ in range(60):
        middle = 0.5 * (low + high)
        more = 0.5 * (1 - surface(middle) ** 2).mean() > MEAN
        low, high = (middle, high) if more else (low, middle)
    at = surface(0.5 * (low + high))
    assert (at == RIM).any() and (at < 1.0).all()
    return float(((1 - at**3) / 3 * np.cos(theta)).mean() / MEAN)


def settled(slot: float, cells: int = 64, courant: float = 0.4) -> tuple[complex, float, np.record]:
    """Centre of mass, change of volume and last loads of a layer at rest under a synchronous whirl."""
    area = np.full(cells, MEAN)
    q, loads = -np.square(area), records(LOADS)
    inside = Inside(NOTHING.plates, 0.5 * (1 - RIM**2), slot)
    drive, wall = Drive(AMPLITUDE, 0.0, 30.0, 1.0, 0.0, 1.0), Wall(1, 0.08, 0.0, False)
    for start, stop in ((0.0, 120.0), (120.0, 121.0)):
        loads = records(LOADS)
        done, _ = march(
            *(area, q, start, stop, drive, wall, ring(cells), courant, scratch(cells), loads), inside=inside
        )
        assert done == Outcome.DONE
    return complex(*centre(area, ring(cells))), float(abs(area.mean() / MEAN - 1.0)), loads[0]


@pytest.mark.parametrize("courant", [0.4, 0.8])
def test_at_rest(courant: float) -> None:
    """The exact equilibrium of the annular chamber, to what the slot takes, whatever its speed."""
    exact, found = exact_centre(), {}
    for factor in (1.0, 2.0, 4.0):
        found[factor], lost, _ = settled((factor * SLOT_SPEED) ** 2, courant=courant)
        assert lost < 1e-12
    # The slot takes the head's rise over it, at most 0.05/64 of 0.12; the rest is the cells' and the time's.
    assert abs(found[1.0] - exact) < 0.01 * exact, (found, exact)
    assert abs(found[4.0] - exact) < abs(found[1.0] - exact)
    assert abs(found[4.0] - found[1.0]) < 0.01 * exact


def test_pressure_on_both_walls() -> None:
    """Their force is the liquid's mass times the acceleration of its centre of mass, which is found apart.

    In a whirl with the spin that is m Omega^2 (w + d), for the liquid rests in the drum.
    """
    for factor in (1.0, 2.0):
        found, _, loads = settled((factor * SLOT_SPEED) ** 2)
        mass = 2.0 * np.pi * MEAN
        newton = mass * (AMPLITUDE + found.real)
        # What is left of the waves after 120 rad, and the rim for the slot's own surface: 1e-3 of r in 0.2.
        assert loads.force_x == pytest.approx(newton, rel=1e-2), factor
        assert abs(loads.force_y) < 1e-2 * newton


def test_mass_in_a_run() -> None:
    """A rotor throws its layer against the inner wall: no liquid is lost, the surface stays at it."""
    rotor = Jeffcott(3.0, 3.0 * 30.0**2, 10.0, 4e-3)
    # The gap holds a third more than there is.
    chamber = Chamber(0.15, 0.05, 0.13)
    full = Fill(chamber, Liquid("water", 1000.0, 1e-6), 0.75 * chamber.capacity)
    machine = couple(rotor.system(), [full], 25.0, Friction("linear", 2.0), 0.0, 64, False)
    assert machine.advance(3.0, 2.0, 0.8, 10**6) == Outcome.DONE
    deepest = machine.read().depth_max[0]
    assert 0.02 <= deepest < 0.02 * 1.02
    assert machine.mass_error() < 1e-12
    # Its energy with what the slot holds: the balance closes, and nothing appears in the bores from nowhere.
    assert machine.sums.bores > -1e-3 * (machine.sums.unbalance + machine.sums.support)


@kills("solvers.runup.long_wave:Coupled._pressed", "math.pi * (SLOT", "2.0 * math.pi * (SLOT")
def test_energy_of_what_is_pressed_in() -> None:
    """The work against k (A - A_f), by quadrature."""
    chamber = Chamber(0.15, 0.05, 0.13)
    full = Fill(chamber, Liquid("water", 1000.0, 1e-6), 0.99 * chamber.capacity)
    machine = couple(Jeffcott(3.0, 2700.0, 10.0, 0.0).system(), [full], 25.0, Friction(), 0.0, 64, False)
    before, gap = machine._pressed(), full_area(full)
    assert before == 0.0
    theta = 2.0 * np.pi * (np.arange(64) + 0.5) / 64
    machine.state.area[0] = gap + 0.01 * np.cos(theta)
    more = 0.01 * np.maximum(np.cos(theta), 0.0)
    steps = np.linspace(0.0, 1.0, 2001)
    head = (SLOT_SPEED * 25.0) ** 2 * np.trapezoid(steps[:, None] * more, steps[:, None] * more, axis=0)
    scale = 1000.0 * 0.05 * 0.15**4
    assert machine._pressed() == pytest.approx(scale * head.sum() * 2.0 * np.pi / 64, rel=1e-6)
