"""The drawn liquid: its volume, its surface, its centre of mass, against closed forms and other solvers.

Half-planes a turn/n apart replace arcs by chords: a sector of angle d between two circles has the area
(R^2 - a^2) d/2, drawn (R^2 - a^2) sin(d)/2. The relative error d^2/6 is the same for every pair of circles
about the centre of the half-planes; for walls about another centre it is of the same order.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from leblanc.plotting.bodies import LiquidShape, strips
from leblanc.studies.shapes.layer import RAYS, body_at_rest, body_of_layer, body_of_pool
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.statics.hydrostatics import equilibrium, optimal_volume

CHORD = (2.0 * math.pi / RAYS) ** 2 / 6.0
DRUM = Chamber(0.2, 0.05)
RING = Chamber(0.2, 0.05, 0.15)

# Chamber, volume, deflection, speed, gravity along the axis: wet, dry in part, slow and flat, floor covered,
# nearly full, thin, inner wall wetted, lying machine.
CASES = [
    (DRUM, 5e-4, 0.005 + 0j, 90.0, 9.81),
    (DRUM, 1e-4, -0.005j, 90.0, 9.81),
    (DRUM, 2e-3, -0.005j, 5.0, 9.81),
    (DRUM, 6.2e-3, 0.01j, 20.0, 9.81),
    (RING, 1.2e-3, -0.05 - 0.02j, 90.0, 0.0),
    (RING, 2e-3, -0.05 - 0.02j, 15.0, 9.81),
    (RING, 2.5e-4, 0.1j, 200.0, 0.0),
    (RING, 2.0e-3, 0.1 + 0j, 2.0, 9.81),
]


def centroid(shape: LiquidShape) -> complex:
    """Centre of mass across the axis of the drawn body, by tetrahedra from a point inside."""
    points = shape.outline()
    corners = points.reshape(-1, 3)[strips(*points.shape[:2])]
    volume, moment = 0.0, np.zeros(3)
    for second, third in ((1, 2), (2, 3)):
        a, b, c = corners[:, 0], corners[:, second], corners[:, third]
        part = np.sum(a * np.cross(b, c), axis=1) / 6.0
        volume += part.sum()
        moment += (part[:, None] * (a + b + c) / 4.0).sum(axis=0)
    found = moment / volume
    return complex(found[0], found[1])


def test_volume() -> None:
    # Twice the chord error: walls about the drum's centre, seen from the axis at rest, and thin crescents,
    # whose ends fall between two half-planes.
    for chamber, volume, deflection, speed, gravity in CASES:
        shape = body_at_rest(chamber, volume, deflection, speed, gravity)
        thin = 10.0 if np.mean(shape.wet) < 0.5 else 2.0
        assert abs(shape.volume() / volume - 1.0) < thin * CHORD, (chamber, volume, speed)


def test_paraboloid() -> None:
    # Every point of the free surface lies on z = beta r^2 + C with C of the equilibrium, or where the surface
    # is cut: at floor, lid or a wall.
    for chamber, volume, deflection, speed, gravity in CASES:
        if gravity == 0.0:
            continue
        shape = body_at_rest(chamber, volume, deflection, speed, gravity)
        found = equilibrium(chamber, volume, abs(deflection), speed, gravity)
        beta, constant = speed**2 / (2.0 * gravity), float(found.surface_constant)
        x, y, z = np.moveaxis(shape.surface, -1, 0)
        free = (shape.radius > shape.inner[:, None] * (1.0 + 1e-9)) & (
            shape.radius < shape.outer[:, None] * (1.0 - 1e-9)
        )
        assert free.any()
        # beta R^2 units in the last place of the squares, a few of them.
        rounding = 1e-13 * max(beta * chamber.radius**2, chamber.height)
        assert np.all(np.abs(z - beta * (x**2 + y**2) - constant)[free] < rounding)
        assert z.min() >= 0.0
        assert z.max() <= chamber.height * (1.0 + 1e-12)


def test_centre_of_mass() -> None:
    # The first moment of the equilibrium by another way (arcs of the wall, Gauss-Legendre), along the
    # deflection. The chords move it by the same share of the lever.
    for chamber, volume, deflection, speed, gravity in CASES:
        shape = body_at_rest(chamber, volume, deflection, speed, gravity)
        moment, _ = equilibrium(chamber, volume, abs(deflection), speed, gravity).unbalance()
        expected = float(moment) / volume * deflection / abs(deflection)
        assert abs(centroid(shape) - expected) < 4.0 * CHORD * chamber.radius


def test_dry_arc() -> None:
    # Without gravity the dry arc ends where the circle of the surface meets the wall.
    chamber, volume, deflection, speed, gravity = CASES[6]
    shape = body_at_rest(chamber, volume, deflection, speed, gravity)
    dry = ~shape.wet
    towards = np.exp(1j * shape.angle) * np.conj(deflection / abs(deflection))
    assert dry.any()
    # Opposite the deflection, alike to both sides.
    assert towards[dry].real.max() < towards[~dry].real.min()
    # A half-plane stands at each end, where the distances of wall and surface agree.
    free = shape.radius[shape.wet].min()
    assert np.sort(np.abs(shape.outer / free - 1.0))[:2].max() < 1e-12
    assert float(optimal_volume(chamber, abs(deflection), speed, gravity)) > volume


def test_layer_and_pool() -> None:
    theta = 2.0 * np.pi * np.arange(240) / 240
    depth = 0.01 + 0.004 * np.cos(2.0 * theta)
    shape = body_of_layer(DRUM, 0.01j, theta, depth)
    exact = DRUM.height * np.pi * np.mean(2.0 * DRUM.radius * depth - depth**2)
    # Chords, and the trapezoid of a cosine over 240 points, which the chord error bounds many times over.
    assert abs(shape.volume() / exact - 1.0) < 4.0 * CHORD
    crest = shape.angle[np.argmin(shape.radius[:, 0])]
    assert abs(math.cos(2.0 * crest) - 1.0) < 1e-12
    for volume in (1e-4, 1e-3, 5e-3):
        pool = body_of_pool(DRUM, volume, 0.01j, -1.0)
        assert abs(pool.volume() / volume - 1.0) < 4.0 * CHORD
        # It lies on the side that gravity points to, symmetric about it, under a flat surface.
        middle = centroid(pool) - 0.01j
        assert abs(middle / abs(middle) - np.exp(-1j)) < 1e-3
        level = ((pool.surface[..., 0] + 1j * pool.surface[..., 1] - 0.01j) * np.exp(1j)).real
        assert np.ptp(level[pool.wet]) < 1e-12


def test_no_film_on_a_dry_wall() -> None:
    theta = 2.0 * np.pi * np.arange(64) / 64
    shape = body_of_layer(DRUM, 0j, theta, np.where(theta < math.pi, 0.01, 0.0))
    assert np.array_equal(shape.wet, (shape.angle >= 0.0) & (shape.angle < math.pi - 1e-9))
    assert np.all(shape.height[~shape.wet] == 0.0)


@given(
    fill=st.floats(0.01, 0.99),
    share=st.floats(0.0, 0.9),
    inner=st.sampled_from([0.0, 0.3, 0.7]),
    speed=st.floats(0.1, 500.0),
    gravity=st.sampled_from([0.0, 9.81]),
    angle=st.floats(-3.14, 3.14),
)
def test_any_chamber_holds_its_volume(
    fill: float, share: float, inner: float, speed: float, gravity: float, angle: float
) -> None:
    chamber = Chamber(0.1, 0.03, inner * 0.1)
    room = chamber.inner_radius or chamber.radius
    volume, deflection = fill * chamber.capacity, share * room * complex(math.cos(angle), math.sin(angle))
    shape = body_at_rest(chamber, volume, deflection, speed, gravity)
    # Rays that graze a wall turn fast along it: seen from 0.9 R the wall passes ten times as fast on the near
    # side, and thin crescents have few half-planes.
    assert abs(shape.volume() - volume) < 100.0 * CHORD * volume
    assert np.all(np.diff(shape.angle) > 0.0)
    assert np.all(shape.radius <= shape.outer[:, None] * (1.0 + 1e-12))
    assert np.all(np.diff(shape.height, axis=1) >= 0.0)


def test_the_axis_at_rest_lies_inside() -> None:
    with pytest.raises(InputError, match="deflection"):
        body_at_rest(RING, 1e-3, 0.15 + 0j, 50.0, 0.0)
