"""What closed forms say of a scene, against the solved answer and against sums by hand."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import leblanc as lb
from fluid.fill import Fill
from fluid.liquid import Liquid
from leblanc.core.blocks import Table
from leblanc.liquid.choose import prepare
from leblanc.scene.schema.load import SceneError
from leblanc.studies.closed_forms import study
from leblanc.studies.closed_forms.answer import ClosedForms, closed_form_table
from leblanc.studies.closed_forms.study import vector_model
from meshes.chamber import Chamber
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.vector_model import balance_residual
from solvers.synchronous.response import response
from tests.mutants import kills

ROOT = Path(__file__).parents[3]
EPS = np.finfo(float).eps
WATER = Liquid("water", 998.2, 1e-6)


def closed_forms(scene: lb.Scene) -> ClosedForms:
    return study.closed_forms(prepare(scene))


def top() -> lb.Scene:
    return lb.load_scene(ROOT / "docs/examples/spinning_top.toml")


@pytest.mark.parametrize("name", ["horizontal_rig", "vertical_rig", "runup", "centrifuge"])
def test_the_answer_of_a_planar_rotor_meets_the_vector_model(name: str) -> None:
    """Solved angle and balance of angles to rounding, at every speed."""
    result = lb.run(lb.example(name).replace({"speeds.count": 31}))
    found = result.vector_model
    assert found is not None and np.isfinite(found.balance_angle).all()
    # At worst 1 - sin(delta)/k is small: an arcsine there turns a rounding of eps into sqrt(eps).
    near = np.maximum(1.0 - np.minimum(np.sin(found.lag) / found.ratio, 1.0), EPS)
    assert np.all(np.abs(found.angle - found.balance_angle) <= 64.0 * EPS / np.sqrt(near))
    data = result.to_json()["vector_model"]
    assert data["angle"] == found.angle.tolist()


@settings(max_examples=50, deadline=None)
@given(
    mass=st.floats(0.1, 100.0),
    damping_ratio=st.floats(0.001, 2.0),
    unbalance=st.floats(1e-6, 1e-2),
    fill=st.floats(0.01, 0.95),
    speed=st.floats(0.1, 10.0),
)
def test_balance_of_angles_over_machines(
    mass: float, damping_ratio: float, unbalance: float, fill: float, speed: float
) -> None:
    chamber = Chamber(0.1, 0.05)
    rotor = Jeffcott(mass, mass * 2500.0, 2.0 * damping_ratio * mass * 50.0, unbalance * mass)
    fills = (Fill(chamber, WATER, fill * chamber.capacity),)
    answer = response(rotor, fills, np.array([speed * 50.0]), gravity=0.0)
    found = vector_model(rotor, answer, fills[0].mass)
    # The modulus of the balance is solved to some eps of its largest term.
    residual = np.abs(balance_residual(found.angle, found.lag, found.ratio)) / np.maximum(1.0, found.ratio)
    assert residual[0] <= 1e-11
    liquid = answer.liquid_offset[0] * fills[0].mass * np.exp(1j * answer.liquid_angle[0])
    total = abs(unbalance * mass + liquid)
    assert found.unbalance_left[0] == pytest.approx(total / (unbalance * mass), rel=1e-12)


@kills("leblanc.studies.closed_forms.study:vector_model", "-answer.liquid_angle", "answer.liquid_angle")
@kills("leblanc.studies.closed_forms.study:_nearest_balance", "abs(apart).argmin", "abs(apart).argmax")
def test_angle_of_a_rotor_at_its_wet_resonance() -> None:
    """By hand: with K = (M + m_f) W^2 the deflection is U0/(i C/W): the unbalance leads by a quarter turn."""
    chamber = Chamber(0.1, 0.05)
    fill = Fill(chamber, WATER, 0.5 * chamber.capacity)
    rotor = Jeffcott(10.0, (10.0 + fill.full_mass) * 900.0, 600.0, 1e-4)
    answer = response(rotor, (fill,), np.array([30.0]), gravity=0.0)
    found = vector_model(rotor, answer, fill.mass)
    assert found.angle[0] == pytest.approx(0.5 * math.pi, abs=1e-12)
    assert found.balance_angle[0] == pytest.approx(0.5 * math.pi, abs=1e-12)
    assert found.ratio[0] == pytest.approx(600.0 / (fill.full_mass * 30.0), rel=1e-12)


def test_no_unbalance_has_no_angle() -> None:
    scene = lb.example("horizontal_rig").replace({"rotor.unbalance": 0.0, "speeds.count": 5})
    found = lb.run(scene).vector_model
    assert found is not None
    assert np.isnan(found.ratio).all() and np.isnan(found.balance_angle).all()
    (row,) = closed_form_table(lb.run(scene).closed_forms).rows
    assert "no angle balances" in row[1]


def test_conditions_of_two_planes_reach_the_command() -> None:
    scene = lb.example("two_plane_rig").replace({"speeds.count": 9})
    found = lb.explain(scene).to_json()["balancing"]
    assert found["long"] and math.isclose(found["above"], max(c["above"] for c in found["conditions"]))
    # By hand, with all of the mass: v33 = M w^2 - k11 > 0.
    liquid = sum(fill.mass for fill in scene.fills)
    (shift,) = (c for c in found["conditions"] if c["name"].startswith("v33"))
    assert shift["above"] == pytest.approx(math.sqrt(80e3 / (20.0 + liquid)), rel=1e-12)
    assert found["possible"] == [speed > found["above"] for speed in found["speed"]]
    short = scene.replace({"rotor.polar_inertia": 0.9})
    data = lb.explain(short).to_json()["balancing"]
    assert data["above"] is None and not any(data["possible"])
    labels = dict(closed_form_table(closed_forms(short)).rows)
    assert "not possible at any speed" in labels["Balancing in two planes"]


def test_one_plane_says_why_not() -> None:
    scene = lb.example("two_plane_rig").replace({"chambers.1.volume": 0.0})
    answer = lb.explain(scene)
    assert "balancing" not in answer.to_json()
    assert any("fewer than two planes" in text for text in answer.not_told)


def test_cages_of_bearings() -> None:
    scene = lb.example("tub").replace({"speeds.count": 5})
    result = lb.explain(scene)
    speed = scene.speed_array()
    share = 0.5 * (1.0 - 6.75 / 28.5)
    assert list(result.cage_speed) == ["bearing 1", "bearing 2"]
    np.testing.assert_allclose(result.cage_speed["bearing 2"], share * speed, rtol=1e-14)
    tilted = scene.replace({"rotor.bearings.0.contact_angle": "60 deg"})
    first, second = closed_forms(tilted).cages
    np.testing.assert_allclose(first.speed, 0.5 * speed * (1.0 - 0.5 * 6.75 / 28.5), rtol=1e-14)
    assert np.isnan(first.printed).all()
    np.testing.assert_array_equal(second.printed, 0.5 * speed)
    assert "half the shaft's" in dict(closed_form_table(closed_forms(scene)).rows)["Cage of bearing 1"]
    bare = scene.replace({"rotor.bearings": [{"position": -0.06}, {"position": -0.15}]})
    assert any("ball_diameter" in text for text in lb.explain(bare).not_told)


def test_cages_of_supports_and_of_a_spindle() -> None:
    """Of every part of a scene that may be a rolling bearing; the fingerprint knows the balls."""
    balls = {"ball_diameter": "6.35 mm", "pitch_diameter": "31 mm", "contact_angle": "15 deg"}
    share = 0.5 * (1.0 - 6.35 / 31.0 * np.cos(np.radians(15.0)))
    scene = lb.example("two_plane_rig").replace({"speeds.count": 3})
    table = scene.table()
    table["rotor"]["supports"][1] |= balls
    rolling = lb.Scene(**table)
    assert rolling.digest != scene.digest
    for answer in (lb.explain(rolling), lb.run(rolling)):
        assert list(answer.cage_speed) == ["support 2"]
        speed = np.array(answer.cage_speed["support 2"]) / share
        np.testing.assert_allclose(speed[[0, -1]], [rolling.speeds.start, rolling.speeds.stop], rtol=1e-12)
    bare = lb.example("spindle").replace({"speeds.count": 3})
    table = bare.table()
    table["rotor"]["joints"][2] |= balls
    with pytest.raises(SceneError, match="rotation"):
        lb.Scene(**table)
    table["rotor"]["rotation"] = "33 Hz"
    spindle = lb.Scene(**table)
    assert spindle.digest != bare.digest
    found = lb.run(spindle)
    (name,) = found.cage_speed
    assert name.startswith("spindle.2 to ")
    assert found.cage_speed[name] == pytest.approx(share * 2.0 * np.pi * 33.0)
    assert found.to_json()["cage_speed"] == found.cage_speed
    assert "cage_speed" not in lb.run(bare).to_json()
    tables = [block for block in found.blocks() if isinstance(block, Table)]
    assert any(row[0].startswith("Cage of spindle.2") for table in tables for row in table.rows)


def test_what_cannot_stand_upright_is_said() -> None:
    """A planar rotor does not tilt, a tub has no ball joint, balls move in their races."""
    table = top().table()
    race = {"kind": "balls", "radius": 0.1, "count": 2, "mass": 0.01, "drag": 1.0}
    table["chambers"] = [*table["chambers"], race]
    with_balls = lb.Scene(**table).replace({"speeds.count": 2})
    words = {
        "does not tilt": closed_forms(lb.example("vertical_rig")).lacking,
        "ball joint of the source": closed_forms(lb.example("top_loader")).lacking,
        "move in their races": lb.run(with_balls).closed_forms.lacking,
    }
    for word, lacking in words.items():
        assert any("upright" in text and word in text for text in lacking)


@pytest.mark.parametrize(
    ("changes", "place"),
    [
        ({"rotor.bearings.0.ball_diameter": "30 mm"}, "ball_diameter"),
        ({"rotor.bearings.0.contact_angle": "95 deg"}, "contact_angle"),
        ({"rotor.bearings": [{"position": 0.1, "ball_diameter": 0.01}, {"position": 0.2}]}, "pitch_diameter"),
        ({"rotor.bearings": [{"position": 0.1, "contact_angle": 0.1}, {"position": 0.2}]}, "contact_angle"),
    ],
)
def test_bearings_are_checked(changes: dict[str, object], place: str) -> None:
    with pytest.raises(SceneError, match=place):
        lb.example("tub").replace(changes)


def test_upright_rotation_turns_where_it_is_said_to() -> None:
    scene = top()
    found = lb.explain(scene).upright
    assert found is not None and len(found.limits) == 1 and len(found.fill_limits) == 2
    (limit,) = found.limits
    for speed, stable in ((limit * 0.999, False), (limit * 1.001, True)):
        at = closed_forms(scene.replace({"speeds.start": speed, "speeds.stop": speed, "speeds.count": 1}))
        assert at.upright is not None and at.upright.stable.tolist() == [stable]
    volume = scene.chambers[0].volume
    for share, stable in ((0.9, False), (1.1, True)):
        at = closed_forms(scene.replace({"chambers.0.volume": volume * found.fill_limits[1] * share}))
        assert at.upright is not None and bool(at.upright.stable[-1]) is stable
    np.testing.assert_array_equal(found.margin, found.frozen - found.surface)
    assert np.all(found.surface > 0.0)
    text = dict(closed_form_table(closed_forms(scene)).rows)["Upright rotation"]
    assert text.startswith("unstable at first, turns at 444.2 rpm")


@kills("leblanc.studies.closed_forms.study:upright", "each.position - pivot", "each.position + pivot")
@kills("leblanc.studies.closed_forms.study:upright", "polar_inertia, -pivot", "polar_inertia, pivot")
def test_upright_without_liquid_is_a_top_on_springs() -> None:
    """(C - A - M l^2) W^2 + sum k (z - p)^2 = M g l, by hand."""
    changes = {"chambers.0.volume": 0.0, "rotor.supports.1.stiffness": 100.0, "speeds.start": 5.0}
    found = closed_forms(top().replace(changes)).upright
    assert found is not None
    spread, pull = 0.11 - 0.06 - 8.0 * 0.06**2, 8.0 * 9.81 * 0.06 - 100.0 * 0.12**2
    assert found.limits == pytest.approx((math.sqrt(pull / spread),), rel=1e-12)
    assert found.fill_limits == ()
    np.testing.assert_array_equal(found.dry, found.frozen)


def test_a_pivot_needs_a_vertical_axis() -> None:
    with pytest.raises(SceneError, match="pivot"):
        lb.example("two_plane_rig").replace({"rotor.pivot": -0.1})


@pytest.mark.parametrize(
    ("scene", "word"),
    [
        (lambda: lb.example("vertical_rig"), "planar rotor does not tilt"),
        (lambda: lb.example("top_loader"), "two_plane rotor"),
        (lambda: lb.example("two_plane_rig").replace({"rotor.axis": "vertical"}), "rotor.pivot, the place"),
        (lambda: top().replace({"chambers.0.baffles": {"count": 3, "tip_radius": 0.1}}), "baffles"),
    ],
)
def test_what_an_upright_scene_lacks_is_said(scene: object, word: str) -> None:
    found = closed_forms(scene())  # type: ignore[operator]
    assert found.upright is None
    assert any(word in text for text in found.lacking)
