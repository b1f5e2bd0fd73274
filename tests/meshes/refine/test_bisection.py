"""Meshes of liquid with half as long sides: exact parts of the same parabolas."""

from __future__ import annotations

import math

import numpy as np
import pytest

from meshes.baffles import Baffles
from meshes.errors import InputError
from meshes.quality import cell_areas
from meshes.refine.bisection import halved, straightened
from meshes.refine.waterline import liquid_outside
from meshes.rings.quadrilaterals import ring
from meshes.rings.sectors import compartment
from meshes.section import Section, annulus, disc
from tests.mutants import kills


def area(points: np.ndarray, cells: np.ndarray) -> float:
    return float(np.abs(cell_areas(points, cells)).sum())


def bend(points: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """How far nodes between vertices are from the middles of the sides, at most, m."""
    middle = 0.5 * (points[cells[:, :3]] + points[np.roll(cells[:, :3], -1, axis=1)])
    return np.asarray(np.abs(points[cells[:, 3:]] - middle).max(axis=(1, 2)))


@kills("meshes.refine.bisection:halved", "points[on_circle] *=", "points[on_circle] *= 1.0 + 0.0 *")
def test_halved() -> None:
    base = annulus(0.2, 0.05, 48, order=2)
    angle = np.arctan2(base.points[:, 1], base.points[:, 0])
    bent = Section(base.points * (1.0 + 0.05 * np.cos(3.0 * angle))[:, None], base.triangles)
    slit = compartment(Baffles(1), 0, 0.2, 0.05, 48)
    for section in (bent, slit):
        liquid = liquid_outside(section, 0.14, order=2, surface_size=0.02)
        finer = halved(liquid)
        assert len(finer.cells) == 4 * len(liquid.cells)
        for name in ("surface", "wall"):
            assert len(getattr(finer, name)) == 2 * len(getattr(liquid, name))
        assert np.array_equal(
            np.sort(np.bincount(finer.wall_piece)), 2 * np.sort(np.bincount(liquid.wall_piece))
        )
        # Parts of the same parabolas inside and on walls: the vertices are the old nodes, the walls the same.
        assert np.allclose(finer.points[: len(liquid.points)], liquid.points, rtol=0.0, atol=1e-15)
        # The surface is nearer to its circle: arcs of a half angle b lose b^4/30 of the sector.
        between = finer.points[finer.surface].reshape(-1, 2)
        assert np.abs(np.hypot(*between.T) / 0.14 - 1.0).max() < 1e-14
        b = 0.5 * 0.02 / 0.14
        assert (
            abs(area(finer.points, finer.cells) - area(liquid.points, liquid.cells))
            < math.pi * 0.14**2 * b**4
        )
        # Parts are like the whole: a quarter of its area, but for the bend of curved ones.
        ratio = np.abs(cell_areas(finer.points, finer.cells)).reshape(4, -1).sum(axis=0)
        whole = np.abs(cell_areas(liquid.points, liquid.cells))
        assert np.abs(ratio / whole - 1.0).max() < 0.02
        inner = np.abs(cell_areas(finer.points, finer.cells)).reshape(4, -1) / whole
        assert np.abs(inner - 0.25).max() < 0.1


@kills("meshes.refine.bisection:_quartered", "_INNER, points[cells]", "0.9999 * _INNER, points[cells]")
def test_straight_parts_of_straight_triangles() -> None:
    liquid = liquid_outside(disc(0.2, 24, order=1), 0.14, order=2)
    finer = halved(liquid)
    bends = [bend(one.points, one.cells) for one in (liquid, finer)]
    straight = np.tile(bends[0] < 1e-12, 4)
    assert straight.sum() > 100 and bends[1][straight].max() < 1e-12


@kills("meshes.refine.bisection:_at_quarters", "0.375 * low + 0.75", "0.5 * low + 0.625")
@kills("meshes.refine.bisection:_at_quarters", "0.375 * high + 0.75", "0.5 * high + 0.625")
def test_walls_keep_their_shape() -> None:
    """Every new node of a wall lies on the parabola of the side it came from."""
    liquid = liquid_outside(disc(0.2, 24, order=2), 0.14, order=2)
    finer = halved(liquid)
    start, end, middle = liquid.points[liquid.wall].transpose(1, 0, 2)
    made = finer.points[finer.wall[:, 2]]
    for t in (0.25, 0.75):
        on = (1 - t) * (1 - 2 * t) * start + 4 * t * (1 - t) * middle + t * (2 * t - 1) * end
        away = np.hypot(*(on[:, None] - made[None]).transpose(2, 0, 1)).min(axis=1)
        assert away.max() < 1e-15


def test_straightened() -> None:
    liquid = liquid_outside(disc(0.2, 24, order=2), 0.14, order=2)
    plain = straightened(liquid)
    assert plain.order == 1 and len(plain.cells) == len(liquid.cells)
    assert len(plain.points) == len(np.unique(liquid.cells[:, :3]))


def test_other_cells_are_refused() -> None:
    with pytest.raises(InputError, match="quadratic triangles"):
        halved(ring(0.2, 0.14, 16, 2))
