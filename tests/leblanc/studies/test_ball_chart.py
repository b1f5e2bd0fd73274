"""Charts of balls of a scene: `run` beside them, the limit of what balls hold, a machine that is known."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import leblanc as lb
from leblanc.cli import main
from leblanc.studies.balls.answer import BallsAnswer
from leblanc.studies.map.balls.answer import BallChart, checks, curves, facts, sentence
from leblanc.studies.map.balls.figure import chart_figure, regions
from meshes.errors import InputError
from solvers.rotor.balls.steady import BallKind
from tests.mutants import kills

EXAMPLES = Path(__file__).parents[3] / "examples"
STUDY, FIGURE = (f"leblanc.studies.map.balls.{part}" for part in ("study", "figure"))
CHARTS = "solvers.rotor.balls.charts"
# Of each support, N s/m, and the least speed above which the long rotor stays balanced, rad/s: motions in
# time confirm both sides (`validation.cases.two_plane.damping`).
EDGES = {0.5: 79.23, 5.0: 59.37, 40.0: 49.66, 8000.0: 48.86}
SUPPORTS = [f"rotor.supports.{k}.damping" for k in (0, 1)]


def scene(name: str, **changes: Any) -> lb.Scene:
    return lb.load_scene(EXAMPLES / f"{name}.toml").replace(
        {key.replace("__", "."): value for key, value in changes.items()}
    )


@pytest.fixture
def no_curves(monkeypatch: pytest.MonkeyPatch) -> None:
    """Follow no curve, most of a small chart's work, where the growth or the band is evaluated alone."""
    monkeypatch.setattr(f"{CHARTS}._neighbours", lambda *_: ())


@cache
def coarse_and_fine() -> tuple[BallChart, BallChart]:
    """Charts of one machine, the fine one without its curves."""
    coarse = lb.map_balls(scene("balls"), values=5, speeds=6)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(f"{CHARTS}._neighbours", lambda *_: ())
        return coarse, lb.map_balls(scene("balls"), values=17, speeds=21)


def beside_liquid(**changes: Any) -> lb.Scene:
    """Two balls beside liquid, which balance in one way: a chart and `run` judge the same state."""
    machine = scene("balls_and_liquid", rotor__unbalance=3e-3, **changes)
    return machine.altered(chambers=(*machine.liquids, machine.balls[0]))


def growth_by_run(machine: lb.Scene, kind: BallKind) -> np.ndarray:
    """Growth about the states of a kind at each speed, by the solver of `run`, which shares no code."""
    found = lb.run(machine)
    assert isinstance(found, BallsAnswer)
    rows = np.where(found.states.kind == kind, found.states.growth, np.nan)
    return np.asarray(np.nanmin(rows, axis=1))


def as_in_run(machine: lb.Scene) -> None:
    chart = lb.map_balls(machine, values=2, speeds=3)
    np.testing.assert_allclose(chart.speed, machine.speed_array(), rtol=1e-14)
    expected = growth_by_run(machine, BallKind.BALANCED)
    # Eigenvalues of matrices whose entries differ by rounding, over the spin.
    np.testing.assert_allclose(chart.scene_growth, expected, rtol=1e-6, atol=1e-9 * chart.speed[-1])


@pytest.mark.usefixtures("no_curves")
@pytest.mark.parametrize("name", ["balls", "long_rotor"])
def test_growth_with_the_scene_as_it_stands_is_that_of_run(name: str) -> None:
    as_in_run(scene(name, speeds__count=3))


@pytest.mark.usefixtures("no_curves")
@kills("solvers.synchronous.balls:in_step", "system.mass + _in_step", "system.mass + 0.0 * _in_step")
def test_growth_beside_liquid_is_that_of_run() -> None:
    """The liquid as a mass in step."""
    as_in_run(beside_liquid(speeds__count=3))


@pytest.mark.usefixtures("no_curves")
def test_an_even_share_is_one_of_the_family() -> None:
    """Two races of one plane share the unbalance by what they hold: growth in the range of all members."""
    machine = scene("balls_and_liquid", speeds__count=3)
    chart, found = lb.map_balls(machine, values=2, speeds=3), lb.run(machine)
    assert isinstance(found, BallsAnswer) and found.growth_range is not None
    balanced = (found.states.kind[:, 0] == BallKind.BALANCED) & (found.chosen == 0)
    assert balanced.sum() >= 2
    least, largest = found.growth_range[balanced].T
    assert (least <= chart.scene_growth[balanced]).all() and (chart.scene_growth[balanced] <= largest).all()


@pytest.mark.usefixtures("no_curves")
@kills(f"{CHARTS}:stable_bands", "bracketed_root(largest, x[known], x[known + 1])[0]", "x[known]")
@pytest.mark.parametrize("machine", [scene("balls"), beside_liquid()], ids=["balls", "balls_and_liquid"])
def test_the_edge_is_where_the_growth_of_run_changes_its_sign(machine: lb.Scene) -> None:
    edge = lb.map_balls(machine, values=2, speeds=12).stable_from
    beside = {"speeds.start": edge * (1.0 - 1e-6), "speeds.stop": edge * (1.0 + 1e-6), "speeds.count": 2}
    below, above = growth_by_run(machine.replace(beside), BallKind.BALANCED)
    assert below > 0.0 > above


@pytest.mark.usefixtures("no_curves")
@kills(f"{CHARTS}:existence_bounds", "(middle, high) if exists(middle) == there[k]", "(middle, high) if True")
def test_the_balanced_state_ends_where_the_balls_hold_the_unbalance() -> None:
    """N m R = U_0."""
    machine = scene("balls")
    held = lb.map_balls(machine, "rotor.unbalance", start=1e-5, stop=2e-3, values=5, speeds=3)
    race = machine.balls[0]
    np.testing.assert_allclose(held.bounds, [race.count * race.each * race.radius], rtol=1e-8)
    assert held.missing.any(axis=1).tolist() == (held.value > held.bounds[0]).tolist()
    table = machine.table()
    table["chambers"] = [
        {"kind": "balls", "radius": 0.065, "count": 2, "mass": "7 g", "drag": "0.1 N*s/m", "plane": 0.0}
    ]
    table["assumed"] = []
    heavy = lb.map_balls(lb.Scene(**table), "chambers.0.mass", start="1 g", stop="20 g", values=6, speeds=3)
    np.testing.assert_allclose(heavy.bounds, [6e-4 / (2 * 0.065)], rtol=1e-8)


@pytest.mark.usefixtures("undrawn")
def test_the_long_rotor_comes_out_of_the_command(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    over = [word for path in SUPPORTS for word in ("--over", path)]
    words = [*over, "--from", "0.3", "--to", "1.2e4", "--values", "6", "--speeds", "7", "--json"]
    path = str(EXAMPLES / "long_rotor.toml")
    assert main(["map", path, *words, "--out", str(tmp_path)]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["value"][0] == 0.3 and found["value"][-1] == 1.2e4 and found["unit"] == "N*s/m"
    outer = max(found["edges"], key=lambda edge: max(edge["speed"]))
    assert outer["kind"] == "hopf" and outer["ends"] == ["left", "left"]
    order = np.argsort(outer["value"])
    speed, value = (np.array(outer[name])[order] for name in ("speed", "value"))
    for damping, edge in EDGES.items():
        # Straight pieces of a fiftieth of the chart on a curve: a second-order error.
        assert np.interp(np.log(damping), np.log(value), speed) == pytest.approx(edge, rel=2e-3)
    monkeypatch.setattr(f"{CHARTS}._neighbours", lambda *_: ())  # its bands alone
    machine = scene("long_rotor").replace(dict.fromkeys(SUPPORTS, 5.0))
    assert lb.map_balls(machine, values=2, speeds=3).stable_from == pytest.approx(EDGES[5.0], abs=0.006)
    assert {path.name for path in tmp_path.iterdir()} == {*("map.nc", "map.html", "map.svg", "contents.json")}


@pytest.mark.usefixtures("no_curves", "undrawn")
def test_the_command_says_what_the_function_returns(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = str(tmp_path / "slow.toml")
    text = (EXAMPLES / "balls.toml").read_text(encoding="utf-8")
    Path(path).write_text(text.replace("3000 rpm", "400 rpm"), encoding="utf-8")
    words = ["--values", "4", "--speeds", "5", "--state", "heavy", "--linear"]
    assert main(["map", path, *words, "--out", str(tmp_path), "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    found = lb.map_balls(path, values=4, speeds=5, state="heavy", log=False)
    assert printed["growing"] == found.growing.tolist() and printed["value"] == found.value.tolist()
    assert printed["state"] == "heavy" and not found.log
    assert main(["map", path, *words, "--out", str(tmp_path)]) == 0
    assert "with all balls on the heavy side" in capsys.readouterr().out
    assert "leblanc map" in (tmp_path / "map.html").read_text(encoding="utf-8")


@pytest.mark.usefixtures("no_curves")
@kills(f"{CHARTS}:gathered", "(np.pi if light else 0.0)", "(0.0 if light else np.pi)")
def test_gathered_states_are_those_of_run() -> None:
    """On the heavy side below the critical speed; opposite, above it, where balls are too light."""
    weak = scene("balls", rotor__unbalance=2e-3)
    for machine, state, speed in ((scene("balls"), "heavy", 40.0), (weak, "light", 250.0)):
        near = machine.replace({"speeds.start": speed, "speeds.stop": 1.01 * speed, "speeds.count": 2})
        chart = lb.map_balls(near, values=2, speeds=2, state=state)
        expected = growth_by_run(near, BallKind.TOGETHER)
        assert (expected < 0.0).all()
        np.testing.assert_allclose(chart.scene_growth, expected, rtol=1e-6)


@pytest.mark.usefixtures("no_curves")
@kills("leblanc.studies.map.varied:Varied.at", "value * share", "value")
@kills("leblanc.studies.map.varied:_own", "float(found)", "2.0 * float(found)")
def test_several_numbers_keep_their_ratio() -> None:
    machine = scene("balls_and_liquid")
    own = machine.balls[0].drag, machine.balls[1].drag
    chart = lb.map_balls(machine, start=own[0], stop=3.0 * own[0], values=2, speeds=2)
    assert chart.paths == ("chambers.1.drag", "chambers.2.drag") and chart.scene_value == own[0]
    np.testing.assert_allclose(chart.growth[0], chart.scene_growth, rtol=1e-9)
    tripled = machine.replace({path: 3.0 * drag for path, drag in zip(chart.paths, own, strict=True)})
    beside = lb.map_balls(tripled, values=2, speeds=2)
    np.testing.assert_allclose(chart.growth[1], beside.scene_growth, rtol=1e-9)


@kills(f"{FIGURE}:_lines", "(edge.speed - first)", "(edge.speed - last)")
@kills(f"{FIGURE}:regions", "label(~wall)", "label(~wall | wall)")
def test_regions_reach_up_to_the_curves() -> None:
    """Between the points of a coarse grid they say what a fine one finds."""
    coarse, fine = coarse_and_fine()  # the mutants are in what is drawn of them
    speed, value, growing = regions(coarse)
    rows = [int(np.abs(np.log(value / v)).argmin()) for v in fine.value]
    columns = [int(np.abs(speed - s).argmin()) for s in fine.speed]
    same = growing[np.ix_(rows, columns)] == fine.growing
    # But where a point lies on a curve to within a cell of the picture.
    assert same.mean() > 0.99


def test_texts_and_arrays_of_a_chart() -> None:
    chart = lb.map_balls(scene("balls"), "rotor.unbalance", start=1e-5, stop="1.2 kg*mm", values=4, speeds=5)
    assert "stable from" in sentence(chart) and "rotor.unbalance being 600 g mm" in sentence(chart)
    told = dict(facts(chart))
    assert told["It begins or ends at"] == told["Unbalance that the balls of each race hold"]
    assert [row[0] for row in curves(chart).rows] == ["a pair of roots crosses (Hopf)"]
    assert [check.grade > 0 for check in checks(chart)] == [True, False, False]
    data = chart.to_dataset()
    assert data.growth.dims == ("value", "speed") and data.value.attrs["units"] == "kg*m"
    assert data.edge_speed.size == sum(edge.speed.size for edge in chart.edges)
    assert chart_figure(chart).alt
    low = lb.map_balls(scene("balls", speeds__stop="800 rpm"), values=2, speeds=3)
    assert "stable at none of these speeds" in sentence(low) and checks(low)[2].grade
    none = lb.map_balls(scene("balls", rotor__unbalance=2e-3), values=2, speeds=3)
    assert "not possible" in sentence(none) and np.isnan(none.stable_from)


@pytest.mark.parametrize(
    ("given", "field"),
    [
        ({"over": "rotor.foo"}, "over"),
        ({"over": "chambers.0.count"}, "over"),
        ({"over": "chambers.0.mass"}, "over"),
        ({"over": "speeds.start"}, "over"),
        ({"over": ["chambers.0.drag", "rotor.mass"]}, "over"),
        ({"over": ["rotor.mass", "rotor.mass"]}, "over"),
        ({"over": "chambers.0.plane"}, "start"),
        ({"over": "chambers.0.diameter", "stop": 1.0}, "over"),
        ({"start": "3 m"}, "start"),
        ({"start": 2.0, "stop": 1.0}, "stop"),
        ({"stop": -1.0}, "stop"),
        ({"start": 0.0, "log": True}, "start"),
        ({"values": 1}, "values"),
        ({"speeds": 1_000_000}, "speeds"),
        ({"state": "together"}, "state"),
    ],
)
def test_what_is_refused(given: dict[str, Any], field: str) -> None:
    with pytest.raises(InputError) as refused:
        lb.map_balls(scene("balls"), **given)
    assert refused.value.field == field


@pytest.mark.usefixtures("no_curves")
def test_each_kind_of_map_refuses_the_options_of_the_other(capsys: pytest.CaptureFixture[str]) -> None:
    for name, option in (("balls", "--volumes"), ("horizontal_rig", "--values")):
        assert main(["map", str(EXAMPLES / f"{name}.toml"), option, "3"]) == 2
        said = capsys.readouterr().err.strip()
        assert said.startswith(f"leblanc: {option} = 3: must be left out") and "\n" not in said
    with pytest.raises(InputError, match="map_balls"):
        lb.map_whirl(scene("balls"))
    with pytest.raises(InputError, match="kind balls"):
        lb.map_balls(scene("horizontal_rig"))
    assert isinstance(lb.map_balls(scene("balls"), values=2, speeds=2), BallChart)
