"""Balls as `leblanc view` draws them: spheres in their races where `run` and run-ups find them."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

import leblanc as lb
from leblanc.cli import main
from leblanc.plotting.bodies import BallView, DrawnRace
from leblanc.studies.balls.answer import BallsAnswer
from leblanc.studies.shapes.balls import ball_radius, ball_view, drawn_races, ringed, side_by_side
from leblanc.studies.shapes.machine import runup_view
from leblanc.view.balls import ball_still
from leblanc.view.film import ball_film, runup_film
from leblanc.view.parts import Picture
from tests.mutants import kills

EXAMPLES = Path(__file__).parents[3] / "examples"


def scene(name: str) -> lb.Scene:
    return lb.load_scene(EXAMPLES / f"{name}.toml")


def centres(picture: Picture, number: int) -> tuple[np.ndarray, float, np.ndarray]:
    """Middles of the balls of a race across the axis, complex, their radius, places along it, mm."""
    piece = picture.piece(f"balls {number}")
    first, along = (1, 0) if picture.lying else (0, 2)
    return piece.points[:, first] + 1j * piece.points[:, first + 1], piece.ball, piece.points[:, along]


def middle(view: BallView, race: int, index: int = -1) -> complex:
    """Of a race as drawn, mm."""
    return complex(1e3 * view.scale.deflection * view.deflection[index, view.races[race].ring])


def stand_where_run_says(speed: float) -> None:
    machine = scene("balls")
    view = ball_view(machine, speed, factor=7.0)
    across, size, along = centres(ball_still(view, -1), 1)
    race = machine.balls[0]
    assert race.diameter is not None and size == pytest.approx(500.0 * race.diameter)
    away = across - middle(view, 0)
    np.testing.assert_allclose(np.abs(away), 1e3 * race.radius, rtol=1e-12)
    found = lb.run(machine.replace({"speeds.start": speed, "speeds.stop": speed, "speeds.count": 1}))
    assert isinstance(found, BallsAnswer) and along.tolist() == [0.0, 0.0]
    total = np.exp(1j * np.angle(away)).sum()
    expected = np.exp(1j * found.ball_angle[0]).sum()
    # Apart or side by side, the middle of both has the direction that `run` tells.
    assert np.angle(total / expected) == pytest.approx(0.0, abs=1e-9)
    if not view.apart[-1]:
        np.testing.assert_allclose(np.sort(np.angle(away)), np.sort(found.ball_angle[0]), rtol=1e-9)
    touching = abs(away[0] - away[1]) == pytest.approx(2.0 * size, rel=1e-9)
    assert touching == (speed < 100.0) == view.apart[-1]


@kills("leblanc.view.balls:with_balls", "race.radius * np.exp", "(race.radius - race.ball) * np.exp")
@kills("leblanc.view.balls:with_balls", "stage.scale.deflection * instant", "2.0 * instant")
@pytest.mark.parametrize("speed", [60.0, 80.0])
def test_balls_together_stand_side_by_side_where_run_says(speed: float) -> None:
    stand_where_run_says(speed)


@kills("leblanc.view.balls:with_balls", "np.exp(1j * angle", "np.exp(2j * angle")
def test_balls_that_balance_stand_where_run_says() -> None:
    stand_where_run_says(300.0)


@pytest.mark.parametrize("name", ["balls_and_liquid", "long_rotor"])
def test_several_races_keep_their_balls_and_places(name: str) -> None:
    machine = scene(name)
    view = ball_view(machine)
    picture = ball_still(view, -1)
    moment = 0.0
    for k, race in enumerate(machine.balls):
        across, _, along = centres(picture, k + 1)
        assert across.size == race.count
        np.testing.assert_allclose(np.abs(across - middle(view, k)), 1e3 * race.radius, rtol=1e-9)
        np.testing.assert_allclose(along, 1e3 * race.plane, atol=1e-9)
        moment += race.capacity / race.count * np.exp(1j * np.angle(across)).sum()
    if name == "balls_and_liquid":
        # In one plane they take the unbalance away; but where some that would overlap are drawn side by side.
        apart = 2.0 * 6.0 / 94.0 if view.apart[-1] else 1e-9
        assert abs(moment + machine.rotor.unbalance) < apart * machine.rotor.unbalance
        assert {piece.name for piece in picture.pieces} >= {"surface 1", "liquid 1", "wall 2", "wall 3"}


@kills("leblanc.studies.shapes.balls:drawn_races", "len(scene.liquids) + k", "len(scene.liquids)")
def test_rings_are_as_wide_as_the_balls_and_hold_no_liquid() -> None:
    machine = scene("balls_and_liquid")
    rings = ringed(machine)
    assert [race.ring for race in drawn_races(machine)] == [1, 2]
    assert [fill.volume for fill in rings.fills[1:]] == [0.0, 0.0]
    for race, fill in zip(machine.balls, rings.fills[1:], strict=True):
        chamber = fill.chamber
        assert 0.5 * (chamber.radius + chamber.inner_radius) == pytest.approx(race.radius)
        assert chamber.radius - chamber.inner_radius == pytest.approx(race.diameter)
    # A ball of 15 g in steel.
    unsaid = scene("long_rotor").balls[0]
    assert ball_radius(unsaid) == pytest.approx((3.0 * 0.015 / (4.0 * math.pi * 7850.0)) ** (1.0 / 3.0))
    assert drawn_races(scene("long_rotor"))[0].assumed


@kills("leblanc.studies.shapes.balls:side_by_side", "(n * low + m * high) / (n + m)", "low")
def test_balls_move_apart_until_none_covers_another() -> None:
    """About their middle; balls that are free stay, across the beginning of the angle as well."""
    half = 0.1
    race = DrawnRace(0, 0.2, 0.2 * math.sin(half), False, (0, 5))
    given = np.array([3.1, -3.1, 3.12, 1.0, 3.0])
    found = side_by_side([race], given)
    turn = np.exp(1j * found)
    assert found[3] == given[3]
    away = np.abs(turn[:, None] - turn)[np.triu_indices(5, 1)]
    assert away.min() >= 2.0 * math.sin(half) * (1.0 - 1e-9)
    # Four of them in one group: their mean angle, counted round pi, stays.
    group = [0, 1, 2, 4]
    before, after = (np.mod(values[group], 2.0 * math.pi).mean() for values in (given, found))
    assert after == pytest.approx(before)
    assert np.array_equal(side_by_side([race], np.linspace(0.0, 4.0, 5)), np.linspace(0.0, 4.0, 5))


def test_a_film_of_the_run_up_has_the_balls_of_its_history() -> None:
    machine = scene("balls").replace({"runup.duration": "12 s", "runup.stop": "200 rad/s"})
    view = runup_view(machine, 5)
    film = runup_film(view)
    assert film.count == 5
    run = view.result
    for k in (0, 4):
        picture = film.picture(k)
        across = centres(picture, 1)[0] * np.exp(-1j * view.turn[k])
        moved = 1e3 * view.scale.deflection * view.frames.deflection[k, 0]
        np.testing.assert_allclose(np.abs(across - moved), 65.0, rtol=1e-9)
        at = int(np.abs(run.time - view.frames.time[k]).argmin())
        expected = side_by_side(view.races, run.ball_angle[at])
        # Samples of the history lie a hundredth of a second apart; the balls pass the drum slowly there.
        np.testing.assert_allclose(np.exp(1j * np.angle(across - moved)), np.exp(1j * expected), atol=0.2)
        assert "liquid" not in picture.state


def test_a_film_over_the_speeds_where_there_is_no_run_up() -> None:
    film = ball_film(ball_view(scene("long_rotor").replace({"speeds.count": 4}), every=True), 3)
    assert film.count == 3
    assert film.picture(0).inset is not None and "balls together" in film.picture(0).state
    assert "balance" in film.picture(2).state


def test_the_command_draws_balls(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, shown = str(EXAMPLES / "balls.toml"), tmp_path / "balls.png"
    assert main(["view", path, "--speed", "600 rpm", "--screenshot", str(shown), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["state"] == "together" and found["stable"] and shown.stat().st_size > 10_000
    assert len(found["ball_angle"]) == 2 and found["deflection_factor"] > 1.0
    assert main(["view", path, "--speed", "-1"]) == 2
    assert "--speed" in capsys.readouterr().err
