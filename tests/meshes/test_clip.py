"""A section without the disc of a circle: areas against integrals over the mesh, outlines against areas."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from meshes.baffles import Baffles
from meshes.clip import ARC, PIECES, area_within, outside_circle, radius_for, wall_loops
from meshes.refine.waterline import area_outside
from meshes.rings.sectors import compartment
from meshes.section import Section, annulus, disc, section_area
from tests.mutants import kills

RADIUS = 0.1


def lobed(section: Section, lobes: int, height: float) -> Section:
    angle = np.arctan2(section.points[:, 1], section.points[:, 0])
    stretch = 1.0 + height * np.cos(lobes * angle) * (np.hypot(*section.points.T) / RADIUS) ** 4
    return Section(section.points * stretch[:, None], section.triangles)


SECTIONS = {
    "disc": disc(RADIUS, 48, order=2),
    "ring": annulus(RADIUS, 0.04, 48, order=1),
    "lobes round a core": lobed(annulus(RADIUS, 0.03, 48, order=2), 5, 0.15),
    "slit": compartment(Baffles(1), 0, RADIUS, 0.05, 36),
    "third": compartment(Baffles(3), 1, RADIUS, 0.02, 24),
}
# A parabola over a side of angle a in PIECES pieces: each misses 2/3 of its length times its sagitta.
CHORD = (2.0 * math.pi / 36 / PIECES) ** 2


@kills("meshes.clip:_outer_parts", "> _TINY * radius", ">= 0.0")
@kills("meshes.clip:_joined", "not _holds(walls", "False and not _holds(walls")
@settings(max_examples=60, deadline=None)
@given(
    st.sampled_from(sorted(SECTIONS)),
    st.floats(0.0, 1.3),
    st.complex_numbers(max_magnitude=1.5, allow_nan=False, allow_infinity=False),
)
@example("slit", 0.8, 0j)
@example("ring", 0.7, 0j)
@example("ring", 0.2, 0j)
@example("ring", 1.2, 0j)
@example("disc", 0.5, 1.66e-6 + 0.5j)  # touches the wall from within, where a corner only just reaches out
@example("disc", 0.2043540934012485, 0.9054813497193132 - 0.7940858313827505j)  # and from without
def test_area_and_outline(name: str, radius: float, moved: complex) -> None:
    section, circle, away = SECTIONS[name], radius * RADIUS, moved * RADIUS
    loops = tuple(loop + away for loop in wall_loops(section))
    whole = section_area(section)
    exact = area_outside(section, circle, (-away.real, -away.imag))
    left = outside_circle(loops, circle)
    assert whole - area_within(loops, circle) == pytest.approx(exact, abs=whole * CHORD)
    # Chords of the arcs cut off a twelfth of their angle squared of the disc.
    assert left.area == pytest.approx(exact, abs=whole * CHORD + circle**2 * ARC**2)
    for loop in left.loops:
        assert np.abs(loop).min() >= circle * (1.0 - 1e-9)
    for arc in left.arcs:
        np.testing.assert_allclose(np.abs(arc), circle, rtol=1e-9)


@pytest.mark.parametrize("name", sorted(SECTIONS))
@pytest.mark.parametrize("share", [0.05, 0.4, 0.9])
def test_the_circle_that_leaves_an_area(name: str, share: float) -> None:
    loops = tuple(loop + 0.01 - 0.02j for loop in wall_loops(SECTIONS[name]))
    whole = outside_circle(loops, 0.0).area
    radius = radius_for(loops, share * whole)
    assert outside_circle(loops, radius).area == pytest.approx(share * whole, abs=radius**2 * ARC**2)


def test_walls_have_the_section_on_their_left() -> None:
    outer, inner = sorted(wall_loops(SECTIONS["ring"]), key=lambda loop: -float(np.abs(loop).max()))
    assert float(np.sum((outer.conj() * np.roll(outer, -1)).imag)) > 0.0
    assert float(np.sum((inner.conj() * np.roll(inner, -1)).imag)) < 0.0
    assert len(wall_loops(SECTIONS["slit"])) == 1
