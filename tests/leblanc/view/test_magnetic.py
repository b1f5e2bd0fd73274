"""Rotors in magnetic bearings as `leblanc view` draws them: in the gap, with the path that `run` finds."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import leblanc as lb
from leblanc.cli import main
from leblanc.view.magnetic import magnetic_film, magnetic_picture
from leblanc.view.parts import Picture
from leblanc.wings.magnetic.answer import MagneticAnswer
from leblanc.wings.magnetic.geometry import magnetic_view
from meshes.errors import InputError
from tests.mutants import kills

PUMP = Path(__file__).parents[3] / "examples" / "blood_pump.toml"


def pump() -> lb.Scene:
    return lb.load_scene(PUMP).replace({"rotor.trial.duration": 0.05, "rotor.loads": []})


def across(picture: Picture, name: str) -> np.ndarray:
    """Points of a piece across the standing axis, complex, mm."""
    points = np.concatenate([piece.points for piece in picture.pieces if piece.name == name])
    return np.asarray(points[:, 0] + 1j * points[:, 1])


@kills("leblanc.view.magnetic:_axis", "(place - first)", "(place - second)")
def test_a_rotor_off_the_centre_in_one_bearing_leans() -> None:
    """Straight through 0.1 mm at -9 mm and nothing at 9 mm, which is -1/90 mm at its upper end, 11 mm."""
    view = magnetic_view(pump())
    leaning = replace(view, displacement=np.array([[1e-4, 0.0, 0.0, 0.0]] * 2), time=np.array([0.0, 1.0]))
    piece = next(piece for piece in magnetic_picture(leaning).pieces if piece.name == "axis of the rotor")
    at = np.interp(11.0, piece.points[:, 2], piece.points[:, 0])
    assert at == pytest.approx(-view.gap_factor * 0.1 / 9.0)


@kills("leblanc.view.magnetic:_bearing", "view.radius + view.gap_factor * view.gap", "view.radius + view.gap")
def test_the_rotor_stands_in_its_gap() -> None:
    view = magnetic_view(pump())
    picture = magnetic_picture(view)
    drawn = 1e3 * view.gap_factor * view.gap
    # The nearest pole is the gap away from a rotor in the centre, less where the rotor is off it.
    poles, rotor = across(picture, "pole 1"), across(picture, "rotor")
    assert np.abs(poles).min() == pytest.approx(1e3 * view.radius + drawn)
    assert np.abs(across(picture, "gap 2")) == pytest.approx(drawn)
    moved = 1e3 * view.gap_factor * 0.14e-3
    assert (rotor.real.max() + rotor.real.min()) / 2.0 == pytest.approx(moved, rel=1e-9)
    assert abs(across(picture, "path 2")[0]) == pytest.approx(moved)
    assert np.abs(across(picture, "path 1")).max() < drawn
    heights = np.concatenate([piece.points[:, 2] for piece in picture.pieces if piece.name == "rotor"])
    assert (heights.min(), heights.max()) == pytest.approx((-11.0, 11.0))
    assert [piece.name for piece in picture.pieces].count("pole 2") == 24


def test_the_path_of_a_trial_is_that_of_run() -> None:
    view, found = magnetic_view(pump()), lb.run(pump().replace({"speeds.count": 2}))
    assert isinstance(found, MagneticAnswer)
    trial = found.controllers[0].trial
    assert trial is not None and view.controller == found.controllers[0].name
    np.testing.assert_allclose(view.displacement, trial.motion.displacement, atol=1e-15)
    film = magnetic_film(view, 3)
    assert film.count == 3 and film.picture(1).inset is not None
    assert len(film.picture(1).piece("path 1").points) < len(film.picture(2).piece("path 1").points)


@kills(
    "leblanc.wings.magnetic.geometry:magnetic_view",
    "np.exp(1j * turn[:, None])",
    "np.exp(2j * turn[:, None])",
)
def test_an_orbit_by_the_unbalances_has_the_size_of_run() -> None:
    machine = pump().replace({"speeds.start": 900.0, "speeds.stop": 940.0, "speeds.count": 2})
    found = lb.run(machine)
    assert isinstance(found, MagneticAnswer)
    view = magnetic_view(machine, speed=940.0)
    distance = np.hypot(view.displacement[:, 0::2], view.displacement[:, 1::2]).max()
    assert distance == pytest.approx(found.controllers[0].amplitude[-1], rel=1e-3)
    # Drawn at most half the gap, and nearly that.
    assert 0.4 < view.path_factor * distance / (view.gap_factor * view.gap) <= 0.5
    # Once round with the spin.
    orbit = view.displacement[:, 0] + 1j * view.displacement[:, 1]
    turned = np.unwrap(np.angle(orbit))
    assert turned[-1] - turned[0] == pytest.approx(2.0 * math.pi)
    assert "different factors" in magnetic_picture(view).caption


def test_the_command_and_what_it_refuses(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    shown = tmp_path / "pump.png"
    words = ["--speed", "9000 rpm", "--factor", "1e6", "--screenshot", str(shown), "--json"]
    assert main(["view", str(PUMP), *words]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["deflection_factor"] == 1e6 and shown.stat().st_size > 10_000
    assert main(["view", str(PUMP), "--mode", "1"]) == 2
    assert "left out for a rotor in magnetic bearings" in capsys.readouterr().err
    for wrong in ({"speed": -1.0}, {"factor": 0.0}):
        with pytest.raises(InputError):
            magnetic_view(pump(), **wrong)
    lying = pump().replace({"rotor.axis": "horizontal"})
    assert magnetic_picture(magnetic_view(lying)).lying
