"""Drum, housing, springs and dampers: at the places of the scene, and in films on the ground."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from leblanc.studies.shapes.machine import mode_view, strobe
from leblanc.view.camera import INSET, letters
from leblanc.view.film import WIDE, mode_film, point_at, runup_film, with_inset
from leblanc.view.machine import SIDES
from leblanc.view.parts import Inset, Picture
from leblanc.view.picture import fill, pixels, plotter
from tests.leblanc.view.test_picture import MACHINES, across, middle_of_circle, short_film
from tests.leblanc.view.views import scene, short_runup, show, working

MORE = ("washing_machine", "two_plane_rig")


def ends_of(picture: Picture, name: str) -> tuple[np.ndarray, np.ndarray]:
    """First and last point of the line in the middle of a coil, mm."""
    points = picture.piece(name).points.reshape(-1, SIDES, 3).mean(axis=1)
    return points[0], points[-1]


def test_springs_of_a_tub_stand_where_the_scene_says() -> None:
    machine = scene("tub")
    view = working("tub")
    motion, factor = view.motion, view.scale.deflection
    springs = [spring for spring in machine.rotor.springs if spring.direction is not None]
    assert len(springs) == 2
    for k, spring in enumerate(springs, start=1):
        start, end = ends_of(view.picture, f"spring {k}")
        x, y, z = spring.position
        # The drum spins about y, gravity points against z: in the picture y, -x, z.
        rest = 1e3 * np.array([y, -x, z])
        moved = 1e3 * factor * complex(motion.deflection[-1, 0] + motion.lean[-1] * (y - motion.places[0]))
        assert start - rest == pytest.approx([0.0, moved.real, moved.imag], abs=1e-9)
        way = np.array([spring.direction[1], -spring.direction[0], spring.direction[2]])
        away = (end - rest) / np.linalg.norm(end - rest)
        assert away == pytest.approx(way / np.linalg.norm(way), abs=1e-9)
    assert sum(piece.name.startswith("bush") for piece in view.picture.pieces) >= 4
    assert {"damper 1", "damper 2", "drum", "housing"} <= {piece.name for piece in view.picture.pieces}


def test_a_spring_at_a_place_of_its_own_acts_along_the_axes() -> None:
    machine = scene("tub")
    alone = {"position": ("300 mm", "0 mm", "0 mm"), "stiffness": ("2 N/mm", "0 N/mm", "3 N/mm")}
    held = {"rotor.springs": [alone, *machine.table()["rotor"]["springs"]], "rotor.dampers": []}
    picture = show(machine.replace(held), 60.0).picture
    ways = []
    for k in (1, 2):
        start, end = ends_of(picture, f"spring {k}")
        ways.append(np.abs(end - start).argmax())
    # x lies across, -y of the picture; z is up. None along y.
    assert ways == [1, 2]
    # The next is one of the others, at a place of its own; nothing is drawn of what it has not.
    assert not np.allclose(ends_of(picture, "spring 3")[0], ends_of(picture, "spring 1")[0])
    assert not any(piece.name == "damper 1" for piece in picture.pieces)


def test_supports_of_two_planes() -> None:
    view = working("two_plane_rig")
    axis = view.picture.piece("axis of the drum").points
    for k, support in enumerate(scene("two_plane_rig").rotor.supports, start=1):
        middle = view.picture.piece(f"bearing {k}").points.reshape(2, -1, 3).mean(axis=1).mean(axis=0)
        assert middle[0] == pytest.approx(1e3 * support.position)
        share = (middle[0] - axis[0, 0]) / (axis[1, 0] - axis[0, 0])
        assert middle == pytest.approx(axis[0] + share * (axis[1] - axis[0]), abs=1e-9)
    assert "schematic" in view.picture.caption


@pytest.mark.parametrize("name", MACHINES)
def test_the_drum_carries_its_chambers(name: str) -> None:
    view = working(name)
    picture = view.picture
    along = 0 if picture.lying else 2
    names = ("drum", "back of the drum")
    drum = np.concatenate([piece.points for piece in picture.pieces if piece.name in names])
    assert len(drum) > 0
    rims = np.concatenate([piece.points for piece in picture.pieces if piece.name.startswith("rim")])
    # Walls stand so much outside the liquid that the two do not coincide: 0.3 % of the radius.
    room = 0.004 * 1e3 * max(fill.chamber.radius for fill in view.motion.fills)
    assert drum[:, along].min() <= rims[:, along].min() + room
    if any(piece.name == "drum" for piece in picture.pieces):
        assert drum[:, along].max() >= rims[:, along].max() - room
    assert "sche" in picture.caption or "sketched" in picture.caption


def blue(picture: Picture, machine: Picture) -> float:
    """Share of pixels with the liquid's colours, by another's camera."""
    plot = plotter(machine)
    try:
        fill(plot, picture)
        seen = pixels(plot).astype(int)
    finally:
        plot.close()
    return float(np.mean(seen[..., 2] > seen[..., 0] + 25))


@pytest.mark.parametrize(
    "name", ["tub", "centrifuge", *(pytest.param(n, marks=pytest.mark.slow) for n in MORE)]
)
def test_parts_leave_the_liquid_in_sight(name: str) -> None:
    view = working(name)
    liquid = tuple(piece for piece in view.picture.pieces if piece.look in ("liquid", "surface"))
    bare = blue(replace(view.picture, pieces=liquid), view.picture)
    # A seventh: a strut before a ring, and the far inside of a ring behind a shaft.
    assert blue(view.picture, view.picture) > (1.0 - 1.0 / 7.0) * bare > 0.0


def test_one_unit_in_a_picture() -> None:
    # 3.8 mm with the spin and 94 um against it stand in one caption.
    picture = working("tub").picture
    words = f"{picture.state} {picture.caption}"
    assert "turn against it" in words
    assert set(re.findall(r"\d (um|mm|m)\b", words)) == {"mm"}


# -- films ---------------------------------------------------------------------------------------------------


def test_spin_is_slowed_down_evenly() -> None:
    time, speed = np.linspace(0.0, 10.0, 41), np.linspace(5.0, 105.0, 41)
    turn, slower = strobe(time, speed)
    # The mean speed of a step is exact while the speed rises evenly.
    assert slower * turn == pytest.approx(5.0 * time + 5.0 * time**2, abs=1e-9)
    assert math.degrees(np.diff(turn).max()) <= 18.0
    # Two digits, rounded up: by no more than a tenth.
    assert math.degrees(np.diff(turn).max()) > 16.0
    assert strobe(time, 0.01 * speed)[1] == 1.0


def test_a_film_of_a_run_up_shows_motion() -> None:
    view = short_runup("washing_machine")
    film = runup_film(view)
    shown = [film.picture(k) for k in range(film.count)]
    assert f"{view.slower:g} times slower" in shown[0].caption
    assert f"{view.scale.deflection:g} times" in shown[0].caption
    factor = 1e3 * view.scale.deflection
    # The largest whirl is a good part of the machine.
    assert factor * np.abs(view.frames.deflection).max() > 0.1 * 180.0
    spots, grounds, points = [], [], []
    for k, picture in enumerate(shown):
        centre = middle_of_circle(across(picture, "rim 1"))
        true = factor * complex(view.frames.deflection[k, 0]) * np.exp(1j * view.turn[k])
        assert abs(centre - true) < 1e-9
        spots.append(complex(across(picture, "unbalance")[0]) - centre)
        grounds.append(ends_of(picture, "spring 1")[1])
        assert np.array_equal(picture.piece("gravity").points, shown[0].piece("gravity").points)
        assert picture.inset is not None
        points.append(point_at(picture.inset, picture.inset.curves[0][1], (300, 100), 10)[0])
    steps = np.angle(np.array(spots[1:]) / np.array(spots[:-1]))
    # The mark turns with the spin, faster and faster, never so far that it seems to stand or to turn back.
    assert np.all(steps > 0.0) and steps.max() < math.radians(18.01)
    assert steps == pytest.approx(np.diff(view.turn))
    assert np.ptp(np.array(grounds), axis=0).max() < 1e-9
    assert np.all(np.diff(points) > 0.0)


def test_a_pool_lies_at_the_bottom_of_every_frame() -> None:
    view = short_runup("washing_machine")
    film = runup_film(view)
    pools = [k for k in range(film.count) if np.isnan(view.frames.depth[k, 0]).any()]
    assert len(pools) > 1
    for k in pools:
        picture = film.picture(k)
        centre = middle_of_circle(across(picture, "rim 1"))
        surface = across(picture, "surface 1")[np.unique(picture.piece("surface 1").cells)] - centre
        # Flat, below the middle; where it meets the wall to the nearest of 540 rays, 2 mm apart there.
        assert surface.imag.max() < 0.0
        assert np.ptp(surface.imag) < 2.0


def test_a_film_over_speeds_turns_its_drum() -> None:
    film = short_film()
    angle = [np.angle(across(film.picture(k), "arm")[1]) for k in range(film.count)]
    assert np.all(np.diff(np.unwrap(angle)) > 0.0)
    assert "spin and whirl turn by 18" in film.picture(0).caption


def test_a_period_of_a_mode_has_no_jump() -> None:
    mode = mode_view(scene("centrifuge"), 3)
    film = mode_film(mode, 24)
    at = [film.picture(k).piece("surface 1").points for k in range(film.count)]
    steps = [float(np.linalg.norm(one - other, axis=1).max()) for one, other in pairwise([*at, at[0]])]
    # The last step leads back to the first frame. A wave that travels moves alike in all of them, to the
    # angle between two of its 240 points, 3/15 of a step: a share of (pi/24/5)^2 of the largest.
    assert min(steps) > 0.0
    assert max(steps) == pytest.approx(min(steps), rel=1e-2)


def test_the_point_of_a_film_stands_on_its_curve() -> None:
    across_, values = np.linspace(0.0, 2.0, 21), np.linspace(0.0, 1.0, 21) ** 2
    white = np.full((600, 800, 3), 255, dtype=np.uint8)
    places = []
    for at in (0.5, 1.5):
        inset = Inset(across_, (("amplitude", values),), at, "time")
        shown = with_inset(white, inset)
        # The curve is 2 pixels wide, the point 8: where the colour stands higher than the curve is.
        orange = (shown[..., 0] > 190) & (shown[..., 2] < 60)
        column = np.argmax(np.where(orange[40:].sum(axis=0) > 6, orange[40:].sum(axis=0), 0))
        size, letter = (round(WIDE * 800), round(INSET * 600)), letters((800, 600))
        x, y = point_at(inset, values, size, letter)
        assert abs(column - (800 - size[0]) - x) < 3.0
        assert orange[round(y), 800 - size[0] + round(x)]
        places.append(y)
    # Farther on the curve is higher, and rows of pixels count downwards.
    assert places[1] < places[0]
    assert np.array_equal(with_inset(white, inset)[200:], white[200:])


def test_a_cabinet_stands_on_its_feet() -> None:
    """Feet, edges and points where the scene has them; what is on the drum goes round with it."""
    machine = scene("tub")
    view, factor = working("tub"), working("tub").scale.deflection
    names = {piece.name for piece in view.picture.pieces}
    feet = [1e3 * np.array([y, -x, z]) for x, y, z in machine.cabinet.feet]
    drawn = view.picture.piece("edge of the cabinet, floor").points
    assert len(drawn) == len(feet) + 1 and {f"foot {k + 1}" for k in range(len(feet))} <= names
    for foot in feet:
        assert np.linalg.norm(drawn - foot, axis=1).min() < 1e-9
    # Round the cabinet, no diagonal: of four feet of a rectangle the line is as long as its sides.
    sizes = np.ptp(np.array(feet), axis=0)[:2]
    way = np.linalg.norm(np.diff(drawn, axis=0), axis=1)
    assert sorted(way) == pytest.approx(sorted([*sizes, *sizes]))
    motion = view.motion
    for point in machine.points:
        x, y, z = point.position
        shift = complex(motion.deflection[-1, 0] + motion.lean[-1] * (y - motion.places[0])) * factor
        (place,) = view.picture.piece(f"point {point.name}").points
        assert place == pytest.approx(1e3 * np.array([y, -x + shift.real, z + shift.imag]), abs=1e-9)
    assert "The cabinet stands on its feet" in view.picture.caption


def test_points_of_other_rotors() -> None:
    """z lies along the axis; of a lying one x is up, of a standing one x lies across."""
    points = [{"name": "rim", "on": "drum", "position": [0.02, 0.03, 0.01]}]
    for axis, expected in (("horizontal", [10.0, -30.0, 20.0]), ("vertical", [20.0, 30.0, 10.0])):
        still = scene("horizontal_rig").replace({"points": points, "rotor.axis": axis})
        view = show(still, 30.0, 1e-6)
        (place,) = view.picture.piece("point rim").points
        assert place == pytest.approx(expected, abs=1e-3)
