"""The kept comparisons of accuracy and cost: whole, of the scenes as they stand, and made again."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from leblanc.scene.scene import load_scene
from solvers.wave_error import family_error, long_wave_error
from validation.trade import __main__ as trade_main
from validation.trade import fingerprint, kept, names
from validation.trade.__main__ import overview
from validation.trade.answers import FAMILY, WAVES, answer, lone_layer
from validation.trade.cases import layer_questions, refined_to, response_question, runup_question
from validation.trade.cases import questions as all_questions
from validation.trade.evaluate import Row, dominates, errors
from validation.trade.results import record_of, trade_json
from validation.trade.trade import error_table

EXAMPLES = Path(__file__).parents[2] / "examples"


def rows_of(result: dict[str, Any], question: str) -> list[Row]:
    return [row for each in record_of(result).comparisons if each.question == question for row in each.rows]


def questions() -> list[tuple[str, str]]:
    return [(name, one["question"]) for name in names() for one in kept(name)["questions"]]


def test_every_shipped_scene_is_kept_as_it_stands() -> None:
    """`python -m validation.trade` makes them again where this fails."""
    # The front loader takes too long, the top loader as well; the programme is that of the washing machine,
    # a spindle and a blood pump have no liquid, and of balls only the steps of a run-up are traded.
    others = {"front_loader", "programme", "spindle", "top_loader", "balls", "balls_and_liquid", "blood_pump"}
    others |= {"balls_design", "long_rotor", "measured_balls"}
    assert names() == sorted({path.stem for path in EXAMPLES.glob("*.toml")} - others)
    for name in names():
        scene = load_scene(EXAMPLES / f"{name}.toml")
        assert kept(name)["fingerprint"] == fingerprint(EXAMPLES / f"{name}.toml"), name
        wanted = ["response"] if scene.runup is None else ["response", "runup"]
        assert [one["question"] for one in kept(name)["questions"]] == wanted


@pytest.mark.parametrize(("name", "question"), questions())
def test_default_is_never_dominated(name: str, question: str) -> None:
    """No other row is at least as accurate and cheaper by more than the times spread."""
    result = kept(name)
    own = next(one["reference_error"] for one in result["questions"] if one["question"] == question)
    rows = rows_of(result, question)
    default = next(row for row in rows if row.default)
    assert [row.label for row in rows if dominates(row, default, own)] == []


@pytest.mark.parametrize(("name", "question"), questions())
def test_front_and_default_are_sound(name: str, question: str) -> None:
    """On the front is what nothing dominates; the default response keeps the tolerance."""
    result = kept(name)
    own = next(one["reference_error"] for one in result["questions"] if one["question"] == question)
    rows = rows_of(result, question)
    for row in rows:
        beaten = math.isnan(row.error) or any(dominates(other, row, own) for other in rows)
        assert row.on_front == (not beaten)
        assert row.memory >= 0 and row.time > 0.0 and row.spread >= 0.0
    default = next(row for row in rows if row.default)
    assert sum(row.default for row in rows) == 1
    # A run-up takes the cells that the scene gives, and an exciter's formulas make no promise. Gravity across
    # the axis may take more than the tolerance: no more than the default tells.
    promised = max(result["tolerance"], 0.0 if math.isnan(default.estimate) else default.estimate) + own
    assert default.error <= promised or question == "runup" or default.model != "auto"


@pytest.mark.parametrize("name", names())
def test_what_is_kept_is_read_whole(name: str) -> None:
    """The record that a file is read as makes the same file."""
    before = kept(name)
    again = trade_json(record_of(before))
    assert all(again[key] == before[key] for key in again if key not in ("versions", "remark"))


def test_one_question_is_measured_anew(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """`--question` leaves the others as they were, and asks for all of them where the scene is another."""
    before = record_of(kept("centrifuge"))
    response, runup = before.comparisons
    found = replace(before, comparisons=(replace(runup, order=9.0),))
    monkeypatch.setattr(trade_main, "_HERE", tmp_path)
    asked: dict[str, Any] = {"examples": EXAMPLES, "only": ("centrifuge",), "question": "runup"}
    with monkeypatch.context() as patch:
        # Versions of another day are none to be refused here.
        patch.setattr("validation.trade.results.versions", lambda: dict(kept("centrifuge")["versions"]))
        patch.setattr(
            "validation.trade.__main__.platform.python_version",
            lambda: kept("centrifuge")["versions"]["python"],
        )
        patch.setattr(
            "validation.trade.__main__.metadata.version", lambda name: kept("centrifuge")["versions"][name]
        )
        patch.setattr("validation.trade.trade.trade_scene", lambda scene, only: found)
        assert trade_main.main(**asked) == trade_main.overview()
        written = record_of(json.loads((tmp_path / "centrifuge.json").read_text(encoding="utf-8")))
        assert written.comparisons == (response, *found.comparisons)
        found = replace(found, digest="another")
        with pytest.raises(RuntimeError, match="has changed"):
            trade_main.main(**asked)


def test_made_again() -> None:
    """Two responses and a run-up: the errors of the cheap cases are the kept ones.

    A bound of 1e-6 of each error and 1e-11 of the answer leaves room for another order of sums.
    """
    for name, asked in (("centrifuge", (response_question, runup_question)), ("runup", (response_question,))):
        scene = load_scene(EXAMPLES / f"{name}.toml")
        for question in (ask(scene) for ask in asked):
            stored = {row.label: row for row in rows_of(kept(name), question.name)}
            before = next(one for one in kept(name)["questions"] if one["question"] == question.name)
            question = refined_to(question, before["reference"])
            assert set(stored) == {case.label for case in question.cases}
            cheap = [case for case in question.cases if case.model != "fem" and (case.resolution or 0) <= 16]
            for label, (error, peak) in error_table(question, cheap).items():
                assert error == pytest.approx(stored[label].error, rel=1e-6, abs=1e-11)
                assert peak == pytest.approx(stored[label].peak_error, rel=1e-6, abs=1e-11)


def test_table() -> None:
    """One line for each scene and question."""
    assert len(overview().rows) == len(questions())


def test_the_solvers_of_py_pde_are_listed_where_a_scene_asks_for_its_waves() -> None:
    scene = load_scene(EXAMPLES / "centrifuge.toml").altered(runup=None)
    names = {
        liquid: [
            question.name for question in all_questions(scene.replace({"model.liquid": liquid}), quick=True)
        ]
        for liquid in ("auto", "kdv")
    }
    assert names["kdv"] == [*names["auto"], WAVES, FAMILY]
    assert [one.name for one in all_questions(scene, quick=True, layer=True)] == names["kdv"]
    empty = scene.replace({"model.liquid": "kdv", "chambers.0.volume": 0.0})
    assert [one.name for one in all_questions(empty, quick=True)] == names["auto"]
    no = all_questions(scene.replace({"model.liquid": "kdv"}), quick=True, layer=False)
    assert [one.name for one in no] == names["auto"]


def test_a_layer_alone_by_each_solver_of_py_pde() -> None:
    """The same equations by other steps: on as many cells their errors are those of the cells."""
    waves, family = layer_questions(load_scene(EXAMPLES / "runup.toml"), quick=True)
    solvers = {case.variant for case in waves.cases}
    assert {
        "finite_volume",
        "runge-kutta",
        "scipy",
        "adams-bashforth",
        "implicit",
        "crank-nicolson",
    } <= solvers
    assert {"steady_newton", "exponential", "runge-kutta"} <= {case.variant for case in family.cases}
    picked = [
        case for case in waves.cases if case.resolution == 16 and case.variant in ("runge-kutta", "scipy")
    ]
    best, *found = (answer(waves.scene, case) for case in (waves.reference, *picked))
    first, second = (errors(WAVES, one, best)[0] for one in found)
    # What they tell of themselves is of the model, beside exact waves, and of the cells.
    fill, whirl, _ = lone_layer(waves.scene)
    layer, size = fill.depth / fill.chamber.radius, whirl.amplitude / fill.depth
    for one in found:
        assert one.estimate == pytest.approx(
            float(long_wave_error(layer, whirl.detuning, size, False, 16)), rel=1e-12
        )
        assert one.estimate > float(long_wave_error(layer, whirl.detuning, size, False)) > 0.0
    # Both err by the cells, 6 %, and by their steps, 1e-4 of it.
    assert 1e-2 < first < 0.1 and abs(first - second) < 1e-3 * first
    (picked_one,) = (case for case in family.cases if case.variant == "runge-kutta")
    one, best = (answer(family.scene, case) for case in (picked_one, family.reference))
    assert errors(FAMILY, one, best)[0] < 1e-5
    assert one.estimate == family_error(layer, whirl.speed / whirl.spin, size, whitham=False) > 0.0
    assert not any(case.variant in ("milstein", "explicit_mpi") for case in (*waves.cases, *family.cases))
