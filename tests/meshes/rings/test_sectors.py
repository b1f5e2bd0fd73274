"""Quadrilaterals of the ring: areas, circles, slits of all kinds, grading."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from meshes.baffles import Baffles
from meshes.liquid_section import SIDES
from meshes.rings.quadrilaterals import ring
from tests.mutants import kills

R, A = 0.2, 0.17


def area(points: np.ndarray, sides: np.ndarray) -> float:
    """Area inside sides with what they bound on the left, exact for quadratic ones."""
    start, end = points[sides[:, 0]], points[sides[:, 1]]
    middle = points[sides[:, 2]] if sides.shape[1] == 3 else 0.5 * (start + end)
    total = 0.0
    for t, weight in zip(*np.polynomial.legendre.leggauss(4), strict=True):
        x = 0.5 * t * (t - 1) * start + (1 - t * t) * middle + 0.5 * t * (t + 1) * end
        dx = (t - 0.5) * start - 2 * t * middle + (t + 0.5) * end
        total += weight * float(np.sum(x[:, 0] * dx[:, 1] - x[:, 1] * dx[:, 0]))
    return 0.5 * total


@kills("meshes.rings.quadrilaterals:_rays", "turns = baffles.first_angle", "turns = -baffles.first_angle")
@kills(
    "meshes.rings.quadrilaterals:_layout",
    "radii[0], radii[-1] = surface_radius, radius",
    "radii[-1] = 1.01 * radius",
)
def test_geometry() -> None:
    """The boundary is that of the liquid: whole area, surface on r = a, wall on r = R and on the baffles."""
    for baffles in (None, Baffles(3, 0.18), Baffles(2, 0.0, 0.01), Baffles(4, 0.18, 0.01, 0.3), Baffles(5)):
        for order, bound in ((1, 4e-3), (2, 1e-6)):
            mesh = ring(R, A, 96, 4, order=order, baffles=baffles)
            sides = np.concatenate([mesh.surface, mesh.wall])
            exact = math.pi * (R**2 - A**2)
            # 8 (2 pi/96)^2/12 of the wall's share for straight sides, (2 pi/96)^4/100 for quadratic ones.
            assert abs(area(mesh.points, sides) / exact - 1.0) < bound
            radius = np.hypot(*mesh.points.T)
            assert np.allclose(radius[mesh.surface], A, rtol=1e-14)
            on_wall = radius[mesh.wall] > R * (1.0 - 1e-12)
            angle = np.arctan2(*mesh.points[mesh.wall].T[::-1]).T
            if baffles is None:
                assert np.all(on_wall)
                continue
            spoke = np.array([np.abs(np.sin(angle - one)) for one in baffles.angles]).min(axis=0)
            assert np.all(on_wall | (spoke < 1e-12))
            inner, outer = baffles.wetted_span(R, A) or (0.0, 0.0)
            slit = ~on_wall.all(axis=1)
            assert np.isclose(radius[mesh.wall[slit]].min(), inner) and np.isclose(
                radius[mesh.wall[slit]].max(), outer
            )
            # Both sides of each baffle.
            ends = mesh.points[mesh.wall[slit][:, :2]]
            length = np.hypot(*(ends[:, 1] - ends[:, 0]).T).sum()
            assert np.isclose(length, 2 * baffles.count * (outer - inner))


@kills("meshes.rings.quadrilaterals:_between", "np.power(t, rise) if fall", "np.power(t, fall) if fall")
@kills("meshes.rings.quadrilaterals:_rays", "(4.0 * near / gap)", "(near / depth)")
@kills(
    "meshes.rings.quadrilaterals:_circles",
    "start + length * _between(count * times",
    "start + length * _between(count",
)
def test_grading() -> None:
    """Cells at edges of baffles shrink as powers, and `times` splits every cell evenly in its number."""
    mesh = ring(R, A, 48, 4, baffles=Baffles(2, 0.18))
    edge = np.abs(mesh.points - [0.18, 0.0]).sum(axis=1).argmin()
    beside = np.any(mesh.cells == edge, axis=1)
    size = np.ptp(mesh.points[mesh.cells[beside]], axis=1).max(axis=0)
    # The first of 8 steps of a fifth power over twice the depth; the first of 4 or more over a part of it.
    assert size[1] <= 1.01 * 0.18 * 2.0 * math.log(R / A) / 8**5 and size[0] < 0.02 / 4**5 * 1.01
    finer = ring(R, A, 48, 4, baffles=Baffles(2, 0.18), times=3)
    assert len(finer.cells) == 9 * len(mesh.cells)
    # A narrow gap is resolved: four cells and more in what is left to the wall.
    narrow = ring(R, A, 48, 4, baffles=Baffles(2, 0.0, 1e-8))
    angle = np.abs(np.arctan2(*narrow.points.T[::-1]))
    assert angle[angle > 1e-12].min() < 0.25 * 1e-8 / R


def test_steps_towards_walls() -> None:
    mesh = ring(R, A, 16, 8, towards_surface=2.0, towards_wall=2.0)
    radii = np.unique(np.round(np.hypot(*mesh.points.T), 12))[::2]
    steps = np.diff(np.log(radii))
    assert steps[0] < 0.3 * steps[3] and steps[-1] < 0.3 * steps[4]


@settings(max_examples=25)
@given(
    st.floats(0.02, 0.999), st.integers(8, 40), st.integers(1, 5), st.integers(0, 6), st.floats(0.0, 1.0),
    st.floats(0.0, 0.9), st.sampled_from([1, 2]),
)  # fmt: skip
def test_any_ring(
    share: float, around: int, across: int, count: int, tip: float, gap: float, order: int
) -> None:
    depth = 1.0 - share
    baffles = None
    if count and gap < 0.95 * (1.0 - tip):
        baffles = Baffles(
            count, share + tip * depth if tip > 0.01 else 0.0, gap * depth if gap > 0.01 else 0.0
        )
    if baffles is not None and baffles.wetted_span(1.0, share) is None:
        baffles = None
    mesh = ring(1.0, share, around, across, order=order, baffles=baffles)
    # Euler: every inner side has two cells.
    sides = mesh.cells.shape[0] * len(SIDES[mesh.cells.shape[1]])
    assert (sides - len(mesh.surface) - len(mesh.wall)) % 2 == 0
    assert mesh.order == order
