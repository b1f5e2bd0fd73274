"""Free surface, walls and their pieces of meshes whose boundary is known; what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest

from meshes.baffles import Baffles
from meshes.errors import InputError
from meshes.liquid_section import LiquidSection, free_sides, liquid_section
from meshes.rings.triangles import ring
from meshes.section import disc
from tests.mutants import kills

INNER, OUTER, AROUND = 0.6, 1.0, 12


def ring_of(nodes: int, around: int = AROUND, start: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """One row of cells of 3, 6, 4 or 9 nodes between two circles."""
    angle = start + math.pi * np.arange(2 * around) / around
    radius = np.linspace(INNER, OUTER, 3)[:, None]
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1).reshape(-1, 2)
    j = 2 * np.arange(around)

    def at(row: int, on: int) -> np.ndarray:
        return row * 2 * around + (j + on) % (2 * around)

    corners = [at(0, 0), at(2, 0), at(2, 2), at(0, 2)]
    if nodes in (4, 9):
        cells = np.stack([*corners, at(1, 0), at(2, 1), at(1, 2), at(0, 1), at(1, 1)], axis=1)[:, :nodes]
        return points, cells
    a, b, c, d = corners
    first = np.stack([a, b, c, at(1, 0), at(2, 1), at(1, 1)], axis=1)
    second = np.stack([a, c, d, at(1, 1), at(1, 2), at(0, 1)], axis=1)
    return points, np.concatenate([first, second])[:, :nodes]


def turn_of(mesh: LiquidSection, sides: np.ndarray) -> float:
    """Angle about the axis that some sides run through, rad."""
    (xa, ya), (xb, yb) = mesh.points[sides[:, 0]].T, mesh.points[sides[:, 1]].T
    return float(np.sum(np.arctan2(xa * yb - ya * xb, xa * xb + ya * yb)))


@kills(
    "meshes.liquid_section:_surface_and_wall",
    "start[:, 0] * end[:, 1] < start[:, 1] * end[:, 0]",
    "start[:, 0] * end[:, 1] > start[:, 1] * end[:, 0]",
)
def test_sides() -> None:
    """The wall runs around counter-clockwise, the surface clockwise, each with the liquid on its left."""
    for nodes in (3, 6, 4, 9):
        mesh = liquid_section(*ring_of(nodes), INNER)
        assert len(mesh.surface) == len(mesh.wall) == AROUND
        assert turn_of(mesh, mesh.wall) == pytest.approx(2 * math.pi, rel=1e-14)
        assert turn_of(mesh, mesh.surface) == pytest.approx(-2 * math.pi, rel=1e-14)
        assert np.hypot(*mesh.points[mesh.surface.ravel()].T) == pytest.approx(INNER, rel=1e-15)
        assert mesh.order == (2 if nodes in (6, 9) else 1)
        assert list(mesh.fixed_piece) == [True]


@kills("meshes.liquid_section:_outermost", "here[np.argmax(radius[here])]", "here[np.argmin(radius[here])]")
def test_pieces() -> None:
    """A baffle that touches nothing is a piece of its own, an attached one is part of the outer wall.

    By hand: three full baffles make three bodies with a wall each; three that leave a gap at the wall, or
    stand free, are three pieces beside the wall.
    """
    cases = [
        (Baffles(3, 0.0), [True] * 3),
        (Baffles(3, 0.8), [True]),
        (Baffles(3, 0.0, 0.1), [True, False, False, False]),
        (Baffles(3, 0.8, 0.1), [True, False, False, False]),
    ]
    for baffles, expected in cases:
        mesh = ring(OUTER, INNER, 12, baffles=baffles, growth=3.0)
        assert sorted(mesh.fixed_piece) == sorted(expected)
        radius = np.hypot(*mesh.points.T)
        for piece, fixed in enumerate(mesh.fixed_piece):
            reach = radius[mesh.wall[mesh.wall_piece == piece]].max()
            assert (reach > OUTER * (1 - 1e-12)) == fixed


def test_two_bodies_have_a_fixed_wall_each() -> None:
    """Half a ring twice, the second turned by half a turn: two bodies of liquid."""
    points, cells = ring_of(4)
    centre = np.degrees(np.arctan2(*points[cells].mean(axis=1)[:, ::-1].T)) % 360
    halves = cells[(centre < 89) | ((centre > 181) & (centre < 269))]
    mesh = liquid_section(points, halves, INNER)
    assert list(mesh.fixed_piece) == [True, True]
    assert len(mesh.wall) == 2 * 3 + 4


def test_a_tube_between_two_surfaces_has_a_free_inner_wall() -> None:
    """A channel that leaves the circle and comes back to it: its two walls do not touch."""
    along = np.linspace(0.0, 1.0, 13)
    sides = []
    for half, rise in ((10.0, 0.3), (40.0, 0.8)):
        angle = np.radians(90.0 + half * (2.0 * along - 1.0))
        sides.append(((1.0 + rise * np.sin(math.pi * along)) * np.array([-np.cos(angle), np.sin(angle)])).T)
    for side in sides:
        side[[0, -1]] /= np.hypot(*side[[0, -1]].T)[:, None]  # the mouths lie on the circle r = 1
    points = np.concatenate([side[::-1] for side in sides])
    cells = np.array([[k, 13 + k, 14 + k, k + 1] for k in range(12)])
    mesh = liquid_section(points, cells, 1.0)
    assert len(mesh.surface) == 2
    assert sorted(mesh.fixed_piece) == [False, True]
    fixed = int(np.argmax(mesh.fixed_piece))
    assert np.all(mesh.wall[mesh.wall_piece == fixed] >= 13)


def test_arrays_are_attracting_and_locked() -> None:
    points, cells = ring_of(6)
    mesh = liquid_section(points, cells, INNER)
    points[0] = 9.0
    assert mesh.points[0, 0] == INNER
    for array in (mesh.points, mesh.cells, mesh.surface, mesh.wall, mesh.wall_piece, mesh.fixed_piece):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = array[0]


def _bad(nodes: int, change: str) -> tuple[np.ndarray, np.ndarray, float]:
    points, cells = ring_of(nodes)
    radius = INNER
    if change == "clockwise":
        cells = cells.copy()
        cells[3, :4] = cells[3, [0, 3, 2, 1]]
    elif change == "folded":
        points[cells[0, -1]] = points[cells[0, 0]] * 0.99
    elif change == "flat":
        points[cells[0, 2]] = points[cells[0, 1]]
    elif change == "twice":
        cells = np.concatenate([cells, cells[:1]])
    elif change == "shared":
        cells = cells.copy()
        cells[0, 4] = cells[1, 5]
    elif change == "apart":
        far = points[cells[0]] + 5.0
        cells = np.concatenate([cells, [np.arange(nodes) + len(points)]])
        points = np.concatenate([points, far])
    elif change == "inside":
        radius = 0.5 * (INNER + OUTER)
        points = points.copy()
        points[np.hypot(*points.T) > 0.9] *= radius / OUTER
    elif change == "away":
        radius = 0.5
    return points, cells, radius


@pytest.mark.parametrize(
    ("nodes", "change", "field"),
    [
        (4, "clockwise", "cells"),
        (9, "folded", "cells"),
        (4, "flat", "cells"),
        (4, "twice", "cells"),
        (9, "shared", "cells"),
        (4, "apart", "cells"),
        (9, "apart", "cells"),
        (4, "away", "surface_radius"),
    ],
)
def test_bad_meshes_are_refused(nodes: int, change: str, field: str) -> None:
    with pytest.raises(InputError) as fault:
        liquid_section(*_bad(nodes, change))
    assert fault.value.field == field


@pytest.mark.parametrize(
    ("points", "cells", "field"),
    [
        (np.zeros((3, 3)), [[0, 1, 2]], "points"),
        (np.full((3, 2), np.nan), [[0, 1, 2]], "points"),
        (np.eye(5, 2), [[0, 1, 2, 3, 4]], "cells"),
        (np.eye(3, 2), [[0.0, 1.0, 2.0]], "cells"),
        (np.eye(3, 2), [[0, 1, -2]], "cells"),
        (np.eye(3, 2), [[0, 1, 3]], "cells"),
        (np.eye(3, 2), np.zeros((0, 3), dtype=int), "cells"),
    ],
)
def test_bad_arrays_are_refused(points: np.ndarray, cells: object, field: str) -> None:
    with pytest.raises(InputError) as fault:
        liquid_section(points, np.asarray(cells), 1.0)
    assert fault.value.field == field


def test_the_offending_number_is_named() -> None:
    with pytest.raises(InputError, match="-2"):
        liquid_section(np.eye(3, 2), np.array([[0, 1, -2]]), 1.0)


def test_a_full_disc_has_no_surface() -> None:
    """Its wall is a circle with all its nodes, but the liquid lies inside of it."""
    section = disc(1.0, 16, order=2)
    with pytest.raises(InputError, match="the circle that bounds the mesh"):
        liquid_section(section.points, section.triangles, 1.0)


def test_liquid_inside_the_circle_is_refused() -> None:
    """A ring whose inner circle is given as the surface, with a wedge that reaches further in."""
    points, cells = ring_of(3)
    wedge = np.array([[INNER - 0.2, 0.0], [INNER, 0.0], [INNER - 0.2, 0.2]])
    more = np.concatenate([cells, [[len(points), 0, len(points) + 2]]])
    with pytest.raises(InputError, match="least radius"):
        liquid_section(np.concatenate([points, wedge]), more, INNER)


def test_free_sides_of_one_cell_are_its_sides() -> None:
    assert free_sides(np.array([[0, 1, 2]])).tolist() == [[0, 1], [1, 2], [2, 0]]
    assert free_sides(np.arange(9)[None]).tolist() == [[0, 1, 4], [1, 2, 5], [2, 3, 6], [3, 0, 7]]
