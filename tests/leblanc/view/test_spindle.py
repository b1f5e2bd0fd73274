"""Spindle units as `leblanc view` draws them: volumes of the sections, shapes, what stands where."""

from __future__ import annotations

import json
import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import leblanc as lb
from leblanc.cli import main
from leblanc.view.parts import Picture
from leblanc.view.spindle import SIDES, revolved, spindle_film, spindle_picture
from leblanc.wings.spindle.geometry import DrawnSection, SpindleView, levels_of, spindle_view
from meshes.arrays import Array, Indices
from meshes.errors import InputError
from tests.mutants import kills

SPINDLE = Path(__file__).parents[3] / "examples" / "spindle.toml"


@cache
def drawn(number: int) -> SpindleView:
    """The example in a natural motion."""
    return spindle_view(lb.load_scene(SPINDLE), number)


def volume(points: Array, faces: list[Indices]) -> float:
    """Of a closed body, by the divergence theorem over triangles; negative where faces look inward."""
    quads = np.concatenate(faces)
    triangles = points[np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])]
    return float(np.linalg.det(triangles).sum() / 6.0)


@kills("leblanc.view.spindle:revolved", "for size in (radius, bore)", "for size in (radius, 0.0)")
def test_sections_have_their_volume() -> None:
    """A bent axis shears the body, which keeps its volume; a polygon of so many sides stands for a circle."""
    place = np.linspace(0.1, 0.4, 13)
    polygon = math.sin(2.0 * math.pi / SIDES) * SIDES / (2.0 * math.pi)
    for bend in (0.0, 0.05):
        found = volume(*revolved(place, bend * place**2, 0.03, 0.02))
        exact = math.pi * (0.03**2 - 0.02**2) * 0.3 * polygon
        assert abs(found) == pytest.approx(exact, rel=1e-9)


def test_a_solid_section_and_one_cut_open() -> None:
    place, height = np.array([0.0, 0.2]), np.zeros(2)
    polygon = math.sin(2.0 * math.pi / SIDES) * SIDES / (2.0 * math.pi)
    solid = abs(volume(*revolved(place, height, 0.03, 0.0)))
    assert solid == pytest.approx(math.pi * 0.03**2 * 0.2 * polygon, rel=1e-9)
    # What is left of the circle: 230 of 360 degrees, in as many pieces.
    opened = abs(volume(*revolved(place, height, 0.03, 0.02, opened=True)))
    left = math.radians(230.0)
    exact = 0.5 * SIDES * math.sin(left / SIDES) * (0.03**2 - 0.02**2) * 0.2
    assert opened == pytest.approx(exact, rel=1e-9)


def beam(picture: Picture, name: str) -> Array:
    return np.concatenate([piece.points for piece in picture.pieces if piece.name == f"beam {name}"])


@kills("leblanc.view.spindle:_beam", "0.5 * section.diameter", "section.diameter")
@kills("leblanc.wings.spindle.geometry:_sections", "initial=place", "initial=0.0")
def test_beams_stand_where_the_scene_says() -> None:
    """Stations that a joint joins stand at one place; widths are the diameters, along the whole beam."""
    view = spindle_view(lb.load_scene(SPINDLE))
    picture = spindle_picture(view, 0.5 * math.pi)  # passing through rest
    spindle, housing = beam(picture, "spindle"), beam(picture, "housing")
    assert np.ptp(spindle[:, 0]) == pytest.approx(259.0) and np.ptp(housing[:, 0]) == pytest.approx(250.0)
    # The leading bearing: 30 mm from the spindle's nose, 38 mm from the quill's face.
    assert spindle[:, 0].min() + 30.0 == pytest.approx(housing[:, 0].min() + 38.0)
    assert np.abs(spindle[:, 1]).max() == pytest.approx(14.0)
    assert np.hypot(housing[:, 1], housing[:, 2]).max() == pytest.approx(32.5)
    assert np.hypot(housing[:, 1], housing[:, 2]).min() == pytest.approx(18.0)
    names = [piece.name for piece in picture.pieces]
    assert {f"joint {k}" for k in range(1, 9)} <= set(names) and "ground of joint 8" in names


@kills("leblanc.view.spindle:_centre", "swing * moved", "-swing * moved")
def test_the_motion_is_the_natural_one_as_large_as_the_factor() -> None:
    """The tool holder's free end moves as the mode of `run` says, beside the station that moves most."""
    found = lb.run(lb.load_scene(SPINDLE).replace({"speeds.count": 2}))
    for number in (1, 2):
        view = drawn(number)
        mode = found.modes[number - 1]
        assert view.frequency == pytest.approx(mode.frequency, rel=1e-9) and view.count == len(found.modes)
        moved, rest = (spindle_picture(view, phase) for phase in (0.0, 0.5 * math.pi))
        rise = (moved.piece("wanted").points - rest.piece("wanted").points)[0]
        np.testing.assert_allclose(
            rise, [0.0, 0.0, 1e3 * view.factor * mode.stations["tool_holder.0"]], atol=1e-9
        )
        assert max(np.abs(part.deflection).max() for part in view.beams) == pytest.approx(1.0)


def test_masses_are_discs_of_steel() -> None:
    view = drawn(1)
    for mass, (size, inertia) in zip(view.masses, ((0.15, 4e-5), (0.3, 2e-4)), strict=True):
        own = 7850.0 * math.pi * mass.radius**2 * mass.thickness
        assert own == pytest.approx(size) and 0.25 * own * mass.radius**2 == pytest.approx(inertia)


@kills("leblanc.wings.spindle.geometry:_have_room", "a.diameter <= b.bore or", "a.diameter <= b.diameter or")
def test_beams_without_room_for_one_another_stand_side_by_side() -> None:
    view = spindle_view(lb.load_scene(SPINDLE))
    assert {part.name: part.level for part in view.beams} == {
        **{"tool_holder": 0, "spindle": 0, "housing": 0},
        "frame": 1,
    }
    tube, rod = DrawnSection(0.0, 1.0, 0.1, 0.05), DrawnSection(0.0, 1.0, 0.05, 0.0)
    wide, behind = DrawnSection(0.0, 1.0, 0.06, 0.0), DrawnSection(1.0, 2.0, 0.1, 0.0)
    assert levels_of([(tube,), (rod,), (wide,), (wide,), (behind,)]) == [0, 0, 1, 2, 0]


def test_the_command_draws_a_spindle(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    shown = tmp_path / "spindle.png"
    assert main(["view", str(SPINDLE), "--speed", "335 Hz", "--screenshot", str(shown), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["mode"] == 2 and shown.stat().st_size > 10_000
    assert found["frequency"] == pytest.approx(2.0 * math.pi * 335.0, rel=1e-3)
    assert main(["view", str(SPINDLE), "--mode", "9"]) == 2
    assert "--mode = 9: must be a whole number from 1 to 5" in capsys.readouterr().err
    film = spindle_film(drawn(1), 4)
    up, down = film.picture(0).piece("wanted").points, film.picture(2).piece("wanted").points
    rest = film.picture(1).piece("wanted").points
    np.testing.assert_allclose(0.5 * (up + down), rest, atol=1e-9)
    for wrong in ({"factor": 0.0}, {"speed": -1.0}, {"number": 0}):
        with pytest.raises(InputError):
            spindle_view(lb.load_scene(SPINDLE), **wrong)
