"""The mass that liquid at rest in its drum adds, by elements, against its closed form."""

from __future__ import annotations

import numpy as np
import pytest

from fluid.fill import Fill, Fills
from fluid.liquid import Liquid
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from solvers.liquid_model import Whirls
from solvers.rotor.jeffcott import Jeffcott
from solvers.sloshing.model import REST_ERROR, SmallWaves
from solvers.synchronous.models import LINEAR
from solvers.synchronous.response import critical_speed, response
from tests.mutants import kills

WATER = Liquid("water", 998.2, 1e-6)
RADIUS = 0.15


def ring(surface: float, baffles: Baffles | None = None) -> Fill:
    """A chamber filled up to a share of its radius."""
    chamber = Chamber(RADIUS, 0.05, baffles=baffles)
    return Fill(chamber, WATER, (1.0 - surface**2) * chamber.capacity)


def off(fill: Fill, cells: int) -> float:
    """Relative difference of the added mass by elements from the closed form [theory: sections, eq. 8]."""
    return float(SmallWaves(cells).added_mass(Fills.of([fill]))[0] / fill.added_mass - 1.0)


@kills("solvers.sloshing.model:SmallWaves._added_mass", "chamber.height * area", "area")
@kills("solvers.sloshing.model:SmallWaves._added_mass", "radius**2 * _ring", "radius * _ring")
@pytest.mark.parametrize("surface", [0.2, 0.9, 0.9999])
def test_the_error_falls_with_the_fourth_power_of_the_cells(surface: float) -> None:
    errors = np.array([off(ring(surface), cells) for cells in (16, 32, 64)])
    order = np.log2(errors[:-1] / errors[1:])
    # Quadratic elements: order 4, reached to a tenth of a per cent a level in such smooth fields.
    assert np.all(np.abs(order - 4.0) < 0.1), order
    # Galerkin: the liquid of the elements is stiffer than the real one.
    assert np.all(errors < 0.0)
    assert 0.0 < abs(off(ring(surface), 96)) < REST_ERROR


def test_compartments() -> None:
    errors = np.array([off(ring(0.9, Baffles(3)), cells) for cells in (24, 48, 96)])
    assert np.all(np.abs(np.log2(errors[:-1] / errors[1:]) - 4.0) < 0.1)
    assert abs(errors[-1]) < 1e-6


def test_the_answer_at_rest_is_that_of_the_elements() -> None:
    """Force, slope and error of a small whirl are those of the added mass found, at any spin."""
    model, fills = SmallWaves(16), Fills.of([ring(0.9)] * 2)
    spin = np.array([30.0, 80.0])
    found = model.answer(fills, Whirls.synchronous(spin, np.full(2, 1e-4), np.zeros(2)))
    added = model.added_mass(fills)
    assert 1e-6 < abs(added[0] / fills.added_mass[0] - 1.0) < 1e-4
    np.testing.assert_allclose(found.slope, added, rtol=0.0)
    np.testing.assert_allclose(found.unbalance, 1e-4 * added, rtol=1e-15)
    np.testing.assert_allclose(found.error, np.abs(added / fills.added_mass - 1.0), rtol=1e-9)


@kills("solvers.synchronous.pairs:pair_machines", "model.added_mass(here)", "here.added_mass")
def test_a_rotor_takes_the_mass_of_the_elements() -> None:
    """With few cells the response and the critical speed are those of a rotor as much lighter."""
    rotor, fill, model = Jeffcott(30.0, 2e4, 60.0, 1e-3), ring(0.9), SmallWaves(8)
    added = float(model.added_mass(Fills.of([fill]))[0])
    speed = np.linspace(10.0, 60.0, 6)
    found = response(rotor, [fill], speed, 0.0, model)
    lighter = rotor.stiffness - (rotor.mass + added) * speed**2 + 1j * rotor.damping * speed
    np.testing.assert_allclose(found.deflection, rotor.unbalance * speed**2 / lighter, rtol=1e-12)
    linear = response(rotor, [fill], speed, 0.0, LINEAR)
    assert np.abs(found.deflection / linear.deflection - 1.0).max() > 1e-4
    expected = np.sqrt(rotor.stiffness / (rotor.mass + added))
    assert critical_speed(rotor, [fill], 0.0, model) == pytest.approx(expected, rel=1e-8)


def test_liquid_without_a_surface_goes_with_its_chamber() -> None:
    chamber = Chamber(RADIUS, 0.05)
    fill = Fill(chamber, WATER, chamber.capacity)
    assert SmallWaves().added_mass(Fills.of([fill]))[0] == fill.added_mass
