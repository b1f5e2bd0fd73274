"""The search for balls: the least mass by statics, the margin by roots, what is refused, files and words."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import leblanc as lb
from leblanc.cli import main
from leblanc.scene.scene import JeffcottRotor, Scene, dry_rotor
from leblanc.scene.schema.load import SceneError
from leblanc.scene.tasks import BallRanges, Optimisation
from leblanc.studies.optimise.balls import study as search
from leblanc.studies.optimise.balls.answer import BallDesignAnswer
from leblanc.studies.optimise.balls.problem import Verdict, ball_problem, crowding, with_balls
from leblanc.studies.optimise.balls.study import optimise_balls
from meshes.errors import InputError
from solvers.rotor.balls.stability import balanced_stability
from tests.mutants import kills

ROOT = Path(__file__).resolve().parents[4]
EXAMPLE = lb.example("balls")
UNBALANCE, RADIUS, SPEED = 6e-4, 0.065, 100.0 * math.pi
ROOM = "leblanc.studies.optimise.balls"


def planar(**race: Any) -> Scene:
    """The example, its balls given by their mass."""
    own = {"kind": "balls", "radius": RADIUS, "count": 2, "mass": 0.005, "drag": 0.1} | race
    return EXAMPLE.replace({"chambers.0": own, "speeds.count": 7})


def _stiffness(balls: float, speed: Any = SPEED) -> Any:
    """Dynamic stiffness of the example with balls of some mass, N/m."""
    rotor = EXAMPLE.rotor
    assert isinstance(rotor, JeffcottRotor)
    own = rotor.machine()
    return own.stiffness - (own.mass + balls) * speed**2 + 1j * own.damping * speed


def two_planes() -> Scene:
    """A long rotor above its resonances with a race near each end, unbalanced in two other planes."""
    table = lb.example("two_plane_rig").table()
    table.pop("runup", None)
    rotor = {"kind": "two_plane", "axis": "vertical", "mass": 10.0, "transverse_inertia": 0.5}
    rotor |= {"polar_inertia": 0.1}
    rotor["supports"] = [
        {"position": -0.15, "stiffness": 8e3, "damping": 40.0},
        {"position": 0.2, "stiffness": 8e3, "damping": 40.0},
    ]
    rotor["unbalances"] = [
        {"size": 3e-4, "position": -0.1, "angle": 0.0},
        {"size": 5e-4, "position": 0.1, "angle": 1.0},
    ]
    race = {"kind": "balls", "radius": 0.08, "count": 2, "mass": 0.006, "drag": 0.3}
    table |= {"rotor": rotor, "assumed": [], "speeds": {"start": 20.0, "stop": 120.0, "count": 4}}
    table["chambers"] = [race | {"plane": plane} for plane in (-0.12, 0.12)]
    return Scene(**table)


@pytest.fixture(autouse=True)
def _short(monkeypatch: pytest.MonkeyPatch) -> None:
    """Few generations: what follows the search finds the ends exactly."""
    monkeypatch.setattr(search, "_GENERATIONS", 1)
    monkeypatch.setattr(search, "_STEPS", 6)
    monkeypatch.setattr(search, "_FOUND", 1e-4)


@kills(f"{ROOM}.problem:total_mass", "race.count * race.each", "race.each")
@kills(f"{ROOM}.study:_lightest", 'variable.name in ("mass", "diameter")', 'variable.name in ("diameter",)')
@pytest.mark.parametrize("count", [2, 3])
def test_least_mass_is_the_unbalance_over_the_radius(count: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a planar rotor: the mass of all balls times the radius holds all but what the limit allows.

    Balls that hold less stand where the deflection is: for the unbalance U, that of the balls B and what is
    left r the triangle |U|^2 = r^2 + B^2 - 2 r B cos a, with a the angle of the dynamic stiffness D, and
    |w| = Omega^2 r/|D| [theory: balls, eq. 22].
    """
    limit = 2e-6
    monkeypatch.setattr(search, "_ROUNDS", 1)  # enough for a single race
    monkeypatch.setattr(search, "_FOUND", 1e-7)
    task = Optimisation(
        objective="least_mass",
        vibration_limit=limit,
        balls={"count": [count, count], "mass": ["1 g", "20 g"]},
    )
    best = optimise_balls(planar(), task)
    held = _stiffness(best.mass)
    rest = limit * abs(held) / SPEED**2
    turn = np.angle(held)
    holds = rest * np.cos(turn) + np.sqrt(UNBALANCE**2 - (rest * np.sin(turn)) ** 2)
    assert best.feasible
    # The gap between masses is halved until it is 1e-7 of the mass; limits hold to 1e-9.
    assert best.mass == pytest.approx(holds / RADIUS, rel=3e-7)
    assert best.value == best.mass
    assert best.vibration == pytest.approx(limit, rel=1e-4)
    assert best.count == (count,)


@kills(f"{ROOM}.study:_quickest", "min([begin, float(found.x)], key=growth)", "begin")
@kills(f"{ROOM}.problem:_limits", "-margin if margin > 0.0", "-0.5 * margin if margin > 0.0")
def test_the_leading_root_is_the_margin(monkeypatch: pytest.MonkeyPatch) -> None:
    """Lightest balls with a margin: the roots of rotor and balls, by another code, fade with just that."""
    margin = 4.0
    monkeypatch.setattr(search, "_ROUNDS", 1)  # enough for a single race
    monkeypatch.setattr(search, "_DRAG_FOUND", 1e-3)
    task = Optimisation(
        objective="least_mass",
        stability_margin=margin,
        balls={"mass": ["1 g", "20 g"], "drag": [0.002, 2.0]},
    )
    scene = planar()
    best = optimise_balls(scene, task)
    assert best.feasible
    (race,) = best.races
    found = scene.balls[0].altered(mass=race.mass, drag=race.drag)
    system = dry_rotor(scene).system()
    stability = balanced_stability(system, [found.race()], SPEED)
    # The logarithm of the mass is looked for to 1e-4, with which the growth changes about as the mass does.
    assert stability.growth == pytest.approx(-margin, rel=1e-3)
    # The drag is the best one: another by a tenth fades more slowly, the balls being so heavy.
    for factor in (0.9, 1.1):
        other = found.altered(drag=factor * race.drag)
        assert balanced_stability(system, [other.race()], SPEED).growth > stability.growth


def test_each_plane_has_its_share() -> None:
    """In two planes the balls of each race hold what statics says: sum and moment of the unbalances."""
    task = Optimisation(objective="least_mass", vibration_limit=1e-9, balls={"mass": ["1 g", "20 g"]})
    best = optimise_balls(two_planes(), task)
    sizes, places = np.array([3e-4, 5e-4 * np.exp(1j)]), np.array([-0.1, 0.1])
    sums = np.array([sizes.sum(), (sizes * places).sum()])
    shares = np.abs(np.linalg.solve([[1.0, 1.0], [-0.12, 0.12]], sums))
    assert best.feasible
    # An amplitude below 1e-9 m leaves 1e-8 kg m; masses on the way to it are lowered in turn.
    np.testing.assert_allclose(best.capacity, shares, rtol=2e-3)


def _judged(scene: Scene, task: Optimisation, **own: float) -> Verdict:
    """Verdict on the scene's balls with other values."""
    (race,) = scene.balls
    changed = scene.altered(chambers=(race.altered(**own),))
    return replace(ball_problem(changed, task), variables=()).judged(np.empty(0))


@kills(f"{ROOM}.problem:BallProblem.taken", "self.task.quantile", "0.0")
@pytest.mark.parametrize(("low", "wide"), [(1.0, 2.5), (3.0, 1.3)])
def test_the_largest_unbalance_of_a_range_decides(low: float, wide: float) -> None:
    """Balls that hold just more than the largest of a range balance all; a little less leaves the rest."""
    most = low * wide * 1e-4
    task = Optimisation(objective="robust", unbalance=(low * 1e-4, most), balls={"mass": ["1 g", "20 g"]})
    scene = planar()
    enough = _judged(scene, task, mass=1.02 * most / (2.0 * RADIUS))
    short = _judged(scene, task, mass=0.9 * most / (2.0 * RADIUS))
    holds, turn = 0.9 * most, np.angle(held := _stiffness(0.9 * most / RADIUS))
    rest = holds * np.cos(turn) + np.sqrt((holds * np.cos(turn)) ** 2 + most**2 - holds**2)
    assert enough.value == 0.0
    assert short.value == pytest.approx(rest * SPEED**2 / abs(held), rel=1e-7)


@kills(f"{ROOM}.problem:crowding", "math.asin(share) / math.pi", "math.asin(share) / (2.0 * math.pi)")
def test_balls_that_do_not_fit_are_not_judged() -> None:
    """Six circles of a radius fit round one of their own size: a diameter as large as the path's radius."""
    race = EXAMPLE.balls[0].altered(diameter=RADIUS, count=6)
    assert crowding(race) == pytest.approx(1.0, rel=1e-12)
    task = Optimisation(balls={"diameter": ["5 mm", "100 mm"], "count": [2, 6]})
    problem = ball_problem(EXAMPLE, task)
    assert problem.judged(np.array([6.0, math.log(0.07)])).excess > 0.0
    assert problem.judged(np.array([6.0, math.log(0.01)])).excess <= 0.0


def test_a_speed_without_a_stable_state_is_no_design() -> None:
    """Near the critical speed the balls run: no amplitude is known."""
    near = _judged(
        EXAMPLE.replace({"optimise": {"working_speed": "1000 rpm"}}), Optimisation(working_speed=104.7)
    )
    assert math.isinf(near.vibration)
    assert near.excess > 0.0


@kills("leblanc.studies.balls.states:worst_states", "np.where(stable, sizes[rows, chosen], most)", "most")
def test_the_peak_counts_balls_on_the_heavy_side() -> None:
    """Where nothing is stable: (U + N m R) Omega^2 over the dynamic stiffness; elsewhere the stable state."""
    from leblanc.studies.balls.states import worst_states

    scene, speed = planar(mass=0.007), np.array([40.0, 105.0, 300.0])
    found = worst_states(scene, speed)
    assert found.stable.tolist() == [True, False, True]
    whole, held = UNBALANCE + 2 * 0.007 * RADIUS, _stiffness(0.014, speed)
    gathered = whole * speed**2 / np.abs(held)
    # Below the critical speed the stable state is nearly that, with the balls a little aside.
    assert found.amplitude[1] == pytest.approx(gathered[1], rel=1e-9)
    assert found.amplitude[2] == 0.0
    assert found.amplitude[0] < gathered[0] * (1.0 + 1e-9)


def test_the_search_is_the_same_again_and_better_than_the_scene(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(search, "_MEMBERS", 3)
    monkeypatch.setattr(search, "_LEAST_MEMBERS", 9)
    task = Optimisation(balls={"count": [2, 4], "mass": ["2 g", "20 g"], "drag": [0.01, 1.0]})
    first, again = (optimise_balls(planar(), task) for _ in range(2))
    assert first.races == again.races
    np.testing.assert_array_equal(first.tried.values, again.tried.values)
    assert first.vibration <= first.vibration_before
    assert first.growth < first.growth_before
    assert first.evaluations == first.tried.mass.size
    assert len(np.unique(first.tried.values[:, 0])) > 1  # several numbers of balls
    assert len(first.to_dataset().tried) == first.evaluations


@pytest.mark.slow
def test_workers_do_not_change_the_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(search, "_FEW_GENERATIONS", 1)
    monkeypatch.setattr(search, "_FEW_STEPS", 3)
    task = Optimisation(objective="peak", steady=True, balls={"mass": ["2 g", "20 g"], "drag": [0.01, 1.0]})
    alone, shared = (optimise_balls(planar(), task, workers=count) for count in (1, 2))
    assert alone.races == shared.races
    np.testing.assert_array_equal(alone.tried.vibration, shared.tried.vibration)


def test_liquid_beside_the_balls_stays() -> None:
    """A design is evaluated with the scene's liquid: balanced, that stands evenly and does nothing."""
    scene = lb.example("balls_and_liquid")
    problem = ball_problem(scene, Optimisation(balls={"drag": [0.1, 1.0]}))
    found = problem.judged(np.log([0.3, 0.4]))
    assert found.vibration == 0.0
    assert found.growth < 0.0
    changed = with_balls(scene, problem.variables, np.log([0.3, 0.4]))
    assert [race.drag for race in changed.balls] == pytest.approx([0.3, 0.4])
    assert changed.fills == scene.fills


@given(
    st.integers(-2, 70),
    st.integers(-2, 70),
    st.floats(1e-12, 1e3),
    st.floats(1e-12, 1e3),
)
@settings(deadline=None)
def test_ranges_are_read_or_refused(least: int, most: int, low: float, high: float) -> None:
    """Whole numbers from 1 to 64 and masses from 1e-9 kg, the lower first; all else names its field."""
    right = 1 <= least <= most <= 64 and 1e-9 <= low <= high
    try:
        found = BallRanges(count=[least, most], mass=[low, f"{high!r} kg"])
    except SceneError as error:
        assert not right
        assert {fault.field for fault in error.faults} <= {"count", "mass"}
        return
    assert right
    assert found.count == (least, most)
    assert found.mass == pytest.approx((low, high))
    assert BallRanges.model_validate(found.table()) == found


@pytest.mark.parametrize(
    ("balls", "said"),
    [
        ({}, "count"),
        ({"mass": [0.001, 0.01], "diameter": [0.005, 0.01]}, "left out where mass is given"),
        ({"count": [2.5, 4]}, "a whole number from 1 to 64"),
        ({"dragg": [0.1, 1.0]}, "spelled as one of"),
        ({"radius": ["65 mm", "60 mm"]}, "the second at least the first"),
    ],
)
def test_wrong_ranges_are_told(balls: dict[str, object], said: str) -> None:
    with pytest.raises(SceneError, match=said):
        BallRanges(**balls)


@pytest.mark.parametrize(
    ("task", "field"),
    [
        ({"objective": "floor_force"}, "objective"),
        ({"deflection": 1e-3}, "optimise.deflection"),
        ({"temperature": (280.0, 300.0)}, "optimise.temperature"),
        ({"volumes": ((0.0, 1e-3),)}, "optimise.volumes"),
        ({"whirl_limit": 1e-3}, "optimise.whirl_limit"),
        ({"balls": {"mass": [0.001, 0.01]}}, "optimise.balls.mass"),
    ],
)
def test_what_says_nothing_of_balls_is_refused(task: dict[str, Any], field: str) -> None:
    with pytest.raises(InputError) as caught:
        optimise_balls(EXAMPLE, Optimisation(**task))
    assert caught.value.field == field
    assert "\n" not in str(caught.value)


def test_other_scenes_and_options_are_refused(tmp_path: Path) -> None:
    rig = lb.example("horizontal_rig")
    with pytest.raises(InputError, match="left out where no chamber is of kind balls"):
        lb.optimise(rig.replace({"optimise": {"balls": {"count": [2, 3]}}}))
    with pytest.raises(InputError, match="whose designs it does not know"):
        lb.optimise(EXAMPLE, emulator=tmp_path)
    with pytest.raises(InputError, match="workers"):
        lb.optimise(EXAMPLE, workers=0)
    with pytest.raises(InputError, match="statics beside balls"):
        lb.optimise(lb.example("balls_and_liquid").replace({"model": {"liquid": "linear"}}))


def test_the_digest_of_a_scene_without_the_block_stays() -> None:
    plain = EXAMPLE.replace({"optimise": {"objective": "least_mass"}})
    assert plain.digest == plain.altered(optimise=plain.optimise.altered(balls=None)).digest  # type: ignore[union-attr]
    assert plain.digest != plain.replace({"optimise.balls": {"count": [2, 3]}}).digest


def _file(tmp_path: Path, **optimise: object) -> Path:
    """The example for designs, with a shorter table [optimise]."""
    text = (ROOT / "examples" / "balls_design.toml").read_text(encoding="utf-8")
    text = text.partition("[optimise]")[0].replace("count = 57", "count = 5")
    lines = [f"{key} = {json.dumps(value)}" for key, value in optimise.items() if key != "balls"]
    ranges = [f"{key} = {json.dumps(value)}" for key, value in optimise.get("balls", {}).items()]  # type: ignore[attr-defined]
    file = tmp_path / "balls.toml"
    file.write_text("\n".join([text, "[optimise]", *lines, "[optimise.balls]", *ranges]), encoding="utf-8")
    return file


RANGES = {"count": [2, 3], "diameter": ["6 mm", "14 mm"]}


@pytest.mark.usefixtures("undrawn")
def test_the_command_writes_and_prints(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = _file(tmp_path, objective="least_mass", balls=RANGES)
    assert main(["optimise", str(file), "--json", "--out", str(tmp_path / "a")]) == 0
    told = json.loads(capsys.readouterr().out)
    for key in ("objective", "value", "baseline", "feasible", "constraints", "evaluations", "count", "drag"):
        assert key in told
    assert told["volume"] == []
    assert told["unit"] == "kg"
    names = {path.name for path in (tmp_path / "a").iterdir()}
    assert {"design.svg", "optimise.html", "optimum.nc"} <= names
    page = (tmp_path / "a" / "optimise.html").read_text(encoding="utf-8")
    assert "balls of" in page
    assert main(["optimise", str(file), "--out", str(tmp_path / "b")]) == 0
    said = capsys.readouterr().out
    assert "For race 1 of the scene: count = " in said
    assert 'diameter = "' in said


@pytest.mark.usefixtures("undrawn")
def test_no_balls_that_meet_all_end_with_code_3(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = _file(tmp_path, objective="least_mass", stability_margin="500 1/s", balls=RANGES)
    assert main(["optimise", str(file), "--out", str(tmp_path / "a")]) == 3
    captured = capsys.readouterr()
    assert "No balls within the ranges meet every constraint" in captured.out
    assert "no balls meet every constraint" in captured.err
    assert (tmp_path / "a" / "optimise.html").exists()


@pytest.mark.usefixtures("undrawn")
def test_an_interrupted_search_keeps_the_best(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def stopped(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(search, "_closer", stopped)
    file = _file(tmp_path, balls=RANGES)
    assert main(["optimise", str(file), "--json", "--out", str(tmp_path / "a")]) == 130
    told = json.loads(capsys.readouterr().out)
    assert told["interrupted"] is True
    assert any("INTERRUPTED" in note for note in told["notes"])


def test_a_result_shows_itself() -> None:
    result = optimise_balls(planar(), Optimisation(balls={"mass": ["2 g", "20 g"]}))
    assert isinstance(result, BallDesignAnswer)
    assert "balls" in result.plot().alt
    assert "<table>" in result._repr_html_()
