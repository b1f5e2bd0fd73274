"""`run` of a tub whose bearings have a rating: load, slip, wear, life, with and without liquid."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np
import pytest

import leblanc as lb
from leblanc.core.blocks import Table, flat
from leblanc.scene.scene import Scene
from leblanc.scene.schema.load import SceneError
from leblanc.studies.run.answer import RunAnswer
from leblanc.studies.run.notes import RunCode
from leblanc.studies.run.study import run_scene
from tests.mutants import kills

RATING = 9560.0
_STUDY = "leblanc.studies.loads.study:with_bearing_life"


def tub(**changed: Any) -> Scene:
    """The tub of the examples at few speeds, its bearings rated."""
    every = {"speeds.count": 7} | {f"rotor.bearings.{k}.dynamic_rating": RATING for k in (0, 1)}
    return lb.example("tub").replace(
        every | {key.replace("__", "."): value for key, value in changed.items()}
    )


@cache
def light() -> RunAnswer:
    """The tub with hardly any weight: its bearings carry what the unbalance makes."""
    answer = run_scene(tub(gravity=0.01, rotor__unbalance="5 g*m"))
    assert isinstance(answer, RunAnswer)
    return answer


@kills(_STUDY, "rating_life(rating, load, speed) / _HOUR", "rating_life(rating, load, speed)")
@kills(_STUDY, "loads.worst.bearing_mean[loads.asked]", "loads.worst.bearing[loads.asked]")
@kills(_STUDY, "_HOUR * sliding_speed", "sliding_speed")
def test_keys_hang_together() -> None:
    """[bearing][speed]; life (C/P)^3 million turns; the load is the forces' mean, below their largest."""
    answer = run_scene(tub(gravity=0.01, rotor__unbalance="5 g*m"))
    told = answer.to_json()
    life = told["bearing_life"]
    keys = {"load", "least_load", "slip", "wear_volume", "life_hours"}
    assert keys <= set(life) and np.shape([life[key] for key in sorted(keys)]) == (5, 2, 7)
    load, speed = np.array(life["load"]), np.array(told["speed"])
    hours = 1e6 * (RATING / load) ** 3 / (speed * 30.0 / math.pi * 60.0)
    np.testing.assert_allclose(life["life_hours"], hours, rtol=1e-12)
    np.testing.assert_allclose(life["least_load"], np.full((2, 7), 0.01 * RATING), rtol=1e-12)
    largest = np.array([told["bearing_force"][f"bearing {k}"] for k in (1, 2)])
    assert np.all(load < largest) and np.all(load > 0.5 * largest)
    slip = np.maximum(1.0 - load / (0.01 * RATING), 0.0)
    np.testing.assert_allclose(life["slip"], slip, rtol=1e-12)
    # Archard's law: hardened steel, an hour of the track's speed, 0.5 (28.5 - 6.75) mm times the spin's slip.
    worn = 1e-17 * load * 3600.0 * slip * speed * 0.5 * (0.0285 - 0.00675)
    np.testing.assert_allclose(life["wear_volume"], worn, rtol=1e-12)
    assert np.any(slip > 0.0)


def test_good_balance_makes_slip() -> None:
    """Where the liquid takes load from a bearing its cage slips more: the finding of the source."""
    life = light().bearing_life
    assert life is not None
    lower = (life.load < life.load_dry * (1.0 - 1e-6)) & (life.slip > 0.0)
    assert lower.any()
    assert np.all(life.slip[lower] > life.slip_dry[lower])
    # A smaller unbalance makes more of it, a smaller bearing less.
    half = run_scene(tub(gravity=0.01, rotor__unbalance="2.5 g*m")).bearing_life
    assert np.all(half.slip >= life.slip) and np.any(half.slip > life.slip + 0.05)
    ratings = {f"rotor.bearings.{k}.dynamic_rating": 0.3 * RATING for k in (0, 1)}
    lighter = run_scene(tub(gravity=0.01, rotor__unbalance="5 g*m").replace(ratings)).bearing_life
    assert np.all(lighter.slip <= life.slip) and np.any(lighter.slip < life.slip - 0.05)
    notes = [note for note in light().notes if note.code == RunCode.SKIDS]
    assert notes and "the better the balance" in notes[0].text


def test_weight_at_low_speed() -> None:
    """So slow that nothing but the weight of drum and liquid acts, both bearings carry it together."""
    answer = run_scene(tub(speeds__start="0.5 rpm", speeds__stop="600 rpm"))
    life, scene = answer.bearing_life, lb.example("tub")
    weight = 9.81 * (scene.rotor.drum_mass + sum(fill.mass for fill in scene.fills))
    # They stand on one side of the drum: the nearer one carries more than all of it, the other pulls back.
    assert abs(life.load[0, 0] - life.load[1, 0]) == pytest.approx(weight, rel=2e-3)
    assert not any(note.code == RunCode.SKIDS for note in answer.notes)


def test_nothing_is_invented() -> None:
    """No rating, no key; one rating, one bearing; no balls, no wear; no wear asked without a rating."""
    balls = {"ball_diameter": 0.00675, "pitch_diameter": 0.0285}
    bare = [balls | {"position": place} for place in (-0.06, -0.15)]
    plain = run_scene(lb.example("tub").replace({"speeds.count": 3, "rotor.bearings": bare}))
    assert "bearing_life" not in plain.to_json()
    assert not any(
        "Ball bearings" in block.title for block in flat(plain.blocks(), "text") if isinstance(block, Table)
    )
    rated = [bare[0], bare[1] | {"dynamic_rating": RATING}]
    one = lb.example("tub").replace({"speeds.count": 3, "rotor.bearings": rated})
    life = run_scene(one).to_json()["bearing_life"]
    for key in ("least_load", "slip", "life_hours", "wear_volume"):
        assert life[key][0] == [None] * 3 and None not in life[key][1]
    bearings = [{"position": place, "dynamic_rating": RATING} for place in (-0.06, -0.15)]
    life = run_scene(lb.example("tub").replace({"speeds.count": 3, "rotor.bearings": bearings})).to_json()
    assert life["bearing_life"]["wear_volume"] == [[None] * 3] * 2
    assert None not in life["bearing_life"]["life_hours"][0]
    with pytest.raises(SceneError, match="left out without dynamic_rating"):
        lb.example("tub").replace({"rotor.bearings": [bare[0] | {"wear_coefficient": 1e-17}, bare[1]]})
    with pytest.raises(SceneError, match="dynamic_rating"):
        tub(rotor__bearings__0__dynamic_rating=-1.0)


def test_table_and_file(tmp_path: Any) -> None:
    """A row a bearing; the data file gives the answer back."""
    answer = light()
    (table,) = [
        block
        for block in flat(answer.blocks(), "text")
        if isinstance(block, Table) and "Ball bearings" in block.title
    ]
    assert [row[0] for row in table.rows] == ["bearing 1", "bearing 2"]
    answer.save(tmp_path / "response.nc")
    assert lb.open(tmp_path / "response.nc") == answer
    assert answer.to_dataset()["bearing_life_load"].dims == ("bearing", "speed")
