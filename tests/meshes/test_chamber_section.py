"""Chambers with a section of their own: level of the liquid, whole surface, balance."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.liquid import known_liquid
from meshes.chamber import Chamber
from meshes.chamber_section import (
    chamber_section,
    layer_depth,
    level,
    liquid_of,
    rest_offset,
    surface_is_whole,
)
from meshes.errors import InputError
from meshes.section import Section, annulus, disc

RADIUS, HEIGHT = 0.15, 0.05
DISC = chamber_section("disc.msh", disc(RADIUS, 96, order=2))


def bent(lobes: int, size: float, shift: float = 0.0) -> Section:
    """Disc whose wall waves round it, moved sideways."""
    base = disc(RADIUS, 96, order=2)
    x, y = base.points.T
    angle, away = np.arctan2(y, x), np.hypot(x, y) / RADIUS
    stretch = 1.0 + size * np.cos(lobes * angle) * away**4
    return Section(base.points * stretch[:, None] + np.array([shift, 0.0]), base.triangles)


def test_a_disc_is_a_circular_chamber() -> None:
    volume = math.pi * (RADIUS**2 - 0.135**2) * HEIGHT
    drawn = Fill(Chamber(DISC.farthest, HEIGHT, section=DISC), known_liquid("water"), volume)
    plain = Fill(Chamber(RADIUS, HEIGHT), known_liquid("water"), volume)
    # Quadratic edges lose (pi/96)^4/60 of the radius: 2e-8; the thin layer enlarges it tenfold.
    assert drawn.surface_radius == pytest.approx(plain.surface_radius, rel=1e-6)
    assert drawn.depth == pytest.approx(plain.depth, rel=1e-5)
    assert drawn.added_mass == pytest.approx(plain.added_mass, rel=1e-6)
    assert drawn.uneven
    assert drawn.compartments == 1


def test_whole_and_broken_surfaces() -> None:
    for lobes, size, share, whole in ((6, 0.03, 0.2, True), (2, 0.15, 0.05, False)):
        section = chamber_section("lobes", bent(lobes, size))
        assert surface_is_whole(section, share * section.area) is whole
    section = chamber_section("lobes", bent(2, 0.15))
    radius, part = level(section, 0.05 * section.area)
    # In two pockets: less of the circle lies inside; the wall at a quarter turn is nearer than the surface.
    assert 0.1 < part < 0.9
    assert radius > RADIUS * 0.85


def test_liquid_that_lies_to_one_side() -> None:
    # Triangles by their corners lose (2 pi/96)^2/6 of the area, all round alike.
    assert rest_offset(DISC, 0.2 * DISC.area) < 1e-4 * RADIUS
    shifted = chamber_section("shifted", bent(6, 0.0, 0.004))
    area = 0.3 * shifted.area
    # The moment of the whole section belongs to the liquid alone.
    assert rest_offset(shifted, area) == pytest.approx(0.004 * shifted.area / area, rel=1e-2)


def test_the_thinnest_place_and_the_mesh() -> None:
    section = chamber_section("lobes", bent(6, 0.03))
    area = 0.25 * section.area
    radius, _ = level(section, area)
    assert layer_depth(section, area) == pytest.approx(0.97 * RADIUS - radius, rel=1e-3)
    assert liquid_of(section, radius).order == 2


def test_sections_are_equal_by_content() -> None:
    assert chamber_section("other name", disc(RADIUS, 96, order=2)) == DISC
    assert chamber_section("disc.msh", disc(RADIUS, 97, order=2)) != DISC


def test_a_section_stands_alone() -> None:
    with pytest.raises(InputError, match="without baffles and inner_radius"):
        Chamber(DISC.farthest, HEIGHT, inner_radius=0.01, section=DISC)
    with pytest.raises(InputError, match="that of the section"):
        Chamber(0.2, HEIGHT, section=DISC)
    ring = chamber_section("ring", annulus(RADIUS, 0.05, 64, order=2))
    # The inner wall has 21 edges: (pi/21)^4/60 = 8e-6.
    exact = math.pi * (RADIUS**2 - 0.05**2) * HEIGHT
    assert Chamber(ring.farthest, HEIGHT, section=ring).capacity == pytest.approx(exact, rel=1e-5)
