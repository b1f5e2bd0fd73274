"""Outlines of chambers with baffles or a section of their own."""

from __future__ import annotations

import math

import numpy as np
import pytest

from leblanc.liquid.filled import FilledChamber
from leblanc.plotting.chambers import LiquidOutline, bodies, exaggeration, plates, walls
from meshes.baffles import Baffles
from meshes.chamber_section import chamber_section
from meshes.section import Section, annulus, disc

RADIUS, REST, HEIGHT = 0.1, 0.09, 0.02
VOLUME = math.pi * (RADIUS**2 - REST**2) * HEIGHT
CUT = FilledChamber(RADIUS, 0.0, HEIGHT, VOLUME, "water", REST, baffles=Baffles(4))
LOW = FilledChamber(RADIUS, 0.0, HEIGHT, VOLUME, "water", REST, baffles=Baffles(4, 0.095))


def area(body: LiquidOutline) -> float:
    return 0.5 * sum(float(np.sum((z.conj() * np.roll(z, -1)).imag)) for z in body.liquid.loops)


@pytest.mark.parametrize("centre", [0.0 + 0.0j, 0.003 - 0.002j])
def test_each_compartment_keeps_its_liquid(centre: complex) -> None:
    found = bodies(CUT, centre, 1.0)
    assert len(found) == 4
    for one in found:
        # Chords of half a degree miss a^2/6 = 1.3e-5 of the disc, of which the layer is a fifth.
        assert area(one) == pytest.approx(0.25 * VOLUME / HEIGHT, rel=1.3e-5 / 0.19)


def test_liquid_that_can_pass_has_one_surface_about_the_axis() -> None:
    centre = 0.003 - 0.002j
    (one,) = bodies(LOW, centre, 1.0)
    assert area(one) == pytest.approx(VOLUME / HEIGHT, rel=1e-4)
    wall = max(one.liquid.loops, key=lambda loop: float(np.abs(loop).max()))
    np.testing.assert_allclose(np.abs(wall - centre), RADIUS, rtol=1e-12)
    (surface,) = one.liquid.arcs
    np.testing.assert_allclose(np.abs(surface), one.level, rtol=1e-12)


def test_the_surface_of_a_section_about_the_axis() -> None:
    base = disc(RADIUS, 96, order=2)
    angle = np.arctan2(base.points[:, 1], base.points[:, 0])
    stretch = 1.0 + 0.02 * np.cos(6.0 * angle) * (np.hypot(*base.points.T) / RADIUS) ** 4
    section = chamber_section("lobes", Section(base.points * stretch[:, None], base.triangles))
    volume = 0.2 * section.area * HEIGHT
    record = FilledChamber(section.farthest, 0.0, HEIGHT, volume, "water", REST, section=section)
    (one,) = bodies(record, 0.001j, 1.0)
    # The wall between its nodes is drawn straight.
    assert area(one) == pytest.approx(section.area - math.pi * REST**2, rel=2e-3)
    assert len(walls(record)) == len(walls(record)[0]) == 1
    # The thinnest place decides how much may be drawn: 0.98 R less the surface.
    assert record.least_depth < section.farthest - record.mean_surface_radius
    factors = exaggeration((record,), (1e-4,))
    assert factors.deflection * 1e-4 <= 0.9 * factors.depth * record.least_depth * (1.0 + 1e-12)


@pytest.mark.parametrize("inner", [0.3 * RADIUS, 0.7 * RADIUS])
def test_the_liquid_lies_on_the_outer_of_two_walls(inner: float) -> None:
    section = chamber_section("ring", annulus(RADIUS, inner, 96))
    record = FilledChamber(RADIUS, 0.0, HEIGHT, VOLUME, "water", REST, section=section)
    (one,) = bodies(record, 0.0j, 1.0)
    wall = np.abs(max(one.liquid.loops, key=lambda loop: float(np.abs(loop).max())))
    # Straight sides between 96 nodes on the circle; their middles lie R (1 - cos(pi/96)) inside it.
    assert wall.max() == pytest.approx(RADIUS, rel=1e-12)
    assert wall.min() >= RADIUS * math.cos(math.pi / 96) * (1.0 - 1e-12)


def test_plates_grow_with_the_layer() -> None:
    for inner, outer in plates(Baffles(3, 0.095, 0.001), RADIUS, 2.0):
        assert abs(outer) == pytest.approx(RADIUS - 2.0 * 0.001)
        assert abs(inner) == pytest.approx(RADIUS - 2.0 * 0.005)
    # Inside the chamber: an inner wall cuts them off.
    assert abs(plates(Baffles(3, 0.0), RADIUS, 2.0, 0.04)[0][0]) == pytest.approx(0.04)
