"""The page's state without a browser: form, changes of the file, live answers, comparison, work."""

from __future__ import annotations

import random
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import leblanc as lb
from leblanc.app import jobs as jobs_module
from leblanc.app import live as live_module
from leblanc.app.fields import GROUPS
from leblanc.app.jobs import Jobs, elsewhere
from leblanc.app.live import Live, curve_of, words_of
from leblanc.app.machine import Machine
from leblanc.app.state import State
from leblanc.scene.examples import example_names, example_path

PATIENCE = 120.0  # s until something must have happened
NAMES = [name for name in example_names() if "/" not in name]
ROOT = Path(__file__).parents[3]


def opened(name: str) -> Machine:
    path = example_path(name)
    return Machine(path.read_text(encoding="utf-8"), str(path))


def fields(machine: Machine) -> list[dict[str, Any]]:
    return [one for group in machine.form() for part in group["sets"] for one in part["fields"]]


def until(what: Callable[[], Any]) -> Any:
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        if value := what():
            return value
        time.sleep(0.01)
    raise AssertionError("never")


@pytest.mark.parametrize("name", NAMES)
def test_each_field_says_what_the_file_says(name: str) -> None:
    """A field typed again as it stands changes nothing, and sliders stand at the value."""
    machine = opened(name)
    assert [group["title"] for group in machine.form()] == [
        title for title in GROUPS if any(group["title"] == title for group in machine.form())
    ]
    found, scene = fields(machine), machine.scene
    assert len({one["path"] for one in found}) == len(found)
    for one in found:
        assert one["label"] and one["allowed"], one
        if one["text"] and one["kind"] != "text":
            assert machine.edit(one["path"], one["text"]), (one, machine.faults)
            assert machine.scene == scene, one["path"]
        slider = one["slider"]
        if slider and one["text"]:
            assert slider["low"] <= slider["at"] <= slider["high"], one
            typed = f"{slider['at']:.6g} {one['unit']}" if one["kind"] == "quantity" else f"{slider['at']:g}"
            assert machine.drag(one["path"], typed), (one, machine.faults)
            assert machine.edit(one["path"], one["text"]), one


@pytest.mark.parametrize("name", NAMES)
def test_assumed_values_are_marked(name: str) -> None:
    machine = opened(name)
    assumed = machine.scene.assumed
    for one in fields(machine):
        inside = any(
            f"{one['path']}.".startswith(f"{path}.") or f"{path}.".startswith(f"{one['path']}.")
            for path in assumed
        )
        assert one["assumed"] == inside, one["path"]


def test_a_change_touches_its_line_alone() -> None:
    machine = opened("horizontal_rig")
    before = machine.text.splitlines()
    assert machine.edit("chambers.0.radius", "66")  # a bare number has the unit of the field
    after = machine.text.splitlines()
    changed = [(one, other) for one, other in zip(before, after, strict=True) if one != other]
    assert changed == [
        (
            'radius = "65 mm"                   # 130 mm diameter',
            'radius = "66 mm"                   # 130 mm diameter',
        )
    ]
    assert lb.Scene.from_toml(machine.text) == machine.scene
    assert machine.scene.chambers[0].radius == 0.066


def test_what_is_refused_changes_nothing() -> None:
    machine = opened("horizontal_rig")
    text, scene = machine.text, machine.scene
    for path, typed in (
        ("chambers.0.volume", "12 cm"),
        ("chambers.0.volume", "900 ml"),
        ("chambers.0.radius", ""),
        ("rotor.kind", "wheel"),
        ("rotor.nothing", "1"),
        ("chambers.7.volume", "1 ml"),
        ("speeds.count", "many"),
        ("model.liquid", "soup"),
        ("", "1"),
    ):
        for change in (machine.drag, machine.edit):
            assert not change(path, typed), (path, typed)
            assert machine.text == text and machine.scene == scene
            assert "must be" in machine.faults[path]
            assert not machine.can_undo
    with pytest.raises(lb.SceneError) as refused:
        scene.replace({"chambers.0.volume": "900 ml"})
    machine.edit("chambers.0.volume", "900 ml")
    assert refused.value.faults[0].allowed in machine.faults["chambers.0.volume"]


def test_a_drag_is_no_step() -> None:
    machine = opened("runup")
    for volume in ("300 ml", "400 ml", "500 ml"):
        assert machine.drag("chambers.0.volume", volume)
    assert machine.scene.chambers[0].volume == pytest.approx(5e-4)
    assert not machine.can_undo
    assert machine.edit("chambers.0.volume", "500 ml")
    machine.undo()
    assert machine.scene == lb.example("runup")
    assert not machine.can_undo


def test_an_emptied_field_has_its_usual_value() -> None:
    machine = opened("horizontal_rig")
    assert machine.edit("model.friction", "none")
    assert machine.edit("model.friction", "")
    assert machine.scene.model.friction == lb.example("horizontal_rig").model.friction
    assert machine.edit("chambers.0.inner_radius", "")  # assumed: its mark goes with it
    assert "chambers.0.inner_radius" not in machine.scene.assumed
    machine.undo()
    assert "chambers.0.inner_radius" in machine.scene.assumed


@pytest.mark.parametrize("name", ["horizontal_rig", "tub", "balls", "blood_pump"])
def test_undo_and_redo_go_the_same_way(name: str) -> None:
    machine, draw = opened(name), random.Random(name)
    texts = [machine.text]
    for _ in range(60):
        one = draw.choice([one for one in fields(machine) if one["slider"]])
        slider = one["slider"]
        value = draw.uniform(slider["low"], slider["high"])
        machine.edit(
            one["path"], str(round(value)) if one["kind"] == "whole" else f"{value:.4g} {one['unit']}"
        )
        if machine.text != texts[-1]:
            texts.append(machine.text)
        assert lb.Scene.from_toml(machine.text, machine.file) == machine.scene
    assert len(texts) > 20
    for text in reversed(texts[:-1]):
        machine.undo()
        assert machine.text == text
    assert not machine.can_undo
    for text in texts[1:]:
        machine.redo()
        assert machine.text == text
    assert not machine.can_redo


def test_the_newest_request_wins(monkeypatch: pytest.MonkeyPatch) -> None:
    begun, go, asked = threading.Event(), threading.Event(), []
    scenes = [lb.example("washing_machine").replace({"gravity": 9.0 + 0.1 * k}) for k in range(6)]
    run = lb.run

    def slow(scene: lb.Scene) -> Any:
        asked.append(scene.gravity)
        begun.set()
        assert go.wait(PATIENCE)
        return run(scene)

    monkeypatch.setattr(live_module.lb, "run", slow)
    heard: list[dict[str, Any]] = []
    live = Live(heard.append)
    live.ask(scenes[0], "first")
    assert begun.wait(PATIENCE)
    for k, scene in enumerate(scenes[1:], 1):
        live.ask(scene, str(k))
    go.set()
    until(lambda: any("words" in news for news in heard))
    live.close()
    assert asked == [9.0, 9.5]
    assert [news["mark"] for news in heard if "curve" in news] == ["first", "5"]
    assert [news["mark"] for news in heard if "words" in news] == ["5"]  # once nothing waits


def test_what_cannot_be_answered_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(scene: lb.Scene) -> Any:
        raise lb.InputError("rotor.mass", 1.0, "another")

    monkeypatch.setattr(live_module.lb, "run", refused)
    heard: list[dict[str, Any]] = []
    live = Live(heard.append)
    live.ask(lb.example("washing_machine"))
    until(lambda: heard)
    live.close()
    assert "must be another" in heard[0]["fault"]


@pytest.mark.parametrize("name", ["horizontal_rig", "two_plane_rig", "programme"])
def test_the_numbers_drawn_are_those_of_the_answer(name: str) -> None:
    answer = lb.run(lb.example(name))
    found = curve_of(answer)
    assert found is not None
    count = len(found["speed"])
    for drawn, exact in (
        (found["speed"], answer.curve.speed),
        (found["amplitude"], answer.curve.amplitude),
        (found["dry"], answer.curve.amplitude_dry),
        *((line, answer.chamber_curve[:, j].real) for j, line in enumerate(found["real"])),
        *((line, answer.chamber_curve[:, j].imag) for j, line in enumerate(found["imag"])),
    ):
        assert len(drawn) == count
        values = np.array([np.nan if one is None else one for one in drawn])
        known = np.isfinite(exact)
        assert np.array_equal(np.isfinite(values), known)
        np.testing.assert_allclose(values[known], exact[known], rtol=1e-5)  # six digits
    assert found["peak"]["amplitude"] == pytest.approx(answer.peak["amplitude"], rel=1e-5)
    assert len(found["unstable"]) == np.count_nonzero(~answer.stable)
    assert [one["area"] for one in found["chambers"]] == [
        pytest.approx(chamber.volume / chamber.height) for chamber in lb.example(name).chambers
    ]


@pytest.mark.parametrize("name", ["horizontal_rig", "balls_design"])
def test_words_have_headline_and_tables(name: str) -> None:
    found = words_of(lb.run(lb.example(name)))
    assert found["headline"].endswith(".")
    assert found["tables"] and all(len(row) > 1 for table in found["tables"] for row in table["rows"])


class Page:
    """What a page would have been told last."""

    def __init__(self) -> None:
        self.shown: dict[str, Any] = {}

    def push(self, name: str, value: Any) -> None:
        self.shown[name] = value


@contextmanager
def page(name: str) -> Iterator[tuple[State, dict[str, Any]]]:
    path, seen = example_path(name), Page()
    state = State(path.read_text(encoding="utf-8"), str(path), seen.push)
    try:
        state.begin()
        yield state, seen.shown
    finally:
        state.close()


def test_comparison() -> None:
    with page("horizontal_rig") as (state, shown):
        until(lambda: "curve" in shown)
        first = shown["curve"]["curve"]["amplitude"]
        state.freeze()
        state.edit("rotor.unbalance", "0.7 kg*mm")
        until(lambda: shown["curve"]["curve"]["amplitude"] != first)
        assert [one["amplitude"] for one in shown["compared"]["frozen"]] == [first]
        assert shown["form"]["undo"]
        state.undo()
        until(lambda: shown["curve"]["curve"]["amplitude"] == first)
        state.measured("mine.csv", (ROOT / "docs/examples/measured.csv").read_text())
        assert len(shown["compared"]["measured"]["speed"]) > 10
        assert shown["compared"]["measured"]["speed"][0] == pytest.approx(572.96 * np.pi / 30.0, rel=1e-5)
        for bad in (
            "",
            "nothing",
            "time [s], amplitude [mm]\n1, 2\n2, 3",
            "speed [rpm], phase [deg]\n1, 2\n2, 3",
        ):
            state.measured("bad.csv", bad)
            assert "must be" in shown["said"]["text"], bad
            assert "bad.csv" in shown["said"]["text"] or "measured" in shown["said"]["text"]
            assert shown["compared"]["measured"]["name"] == "measured, mine.csv"
        state.clear()
        assert shown["compared"] == {"frozen": [], "measured": None}


def test_another_file_takes_its_place() -> None:
    with page("horizontal_rig") as (state, shown):
        state.open("bad.toml", "name = 1")
        assert "must be" in shown["said"]["text"]
        assert shown["form"]["name"] == "Horizontal rig"
        radius = lb.example("runup").chambers[0].radius
        state.open("runup.toml", example_path("runup").read_text(encoding="utf-8"))
        assert (shown["form"]["name"], shown["form"]["file"]) == ("Run-up", "runup.toml")
        until(lambda: "curve" in shown and shown["curve"]["curve"]["chambers"][0]["radius"] == radius)


def test_work_is_done_and_its_best_is_taken() -> None:
    with page("washing_machine") as (state, shown):
        state.take_best()
        assert "No best volumes" in shown["said"]["text"]
        state.start("best")
        state.start("report")
        assert {job["state"] for job in shown["jobs"]} == {"runs"}
        until(lambda: all(job["state"] != "runs" for job in shown["jobs"]))
        assert {job["kind"]: job["state"] for job in shown["jobs"]} == {"best": "done", "report": "done"}, (
            shown["jobs"]
        )
        content = state.content("report")
        assert content is not None and content["name"] == "summary.html"
        assert state.content("best") is None
        (best,) = next(job for job in shown["jobs"] if job["kind"] == "best")["result"]["volume"]
        state.take_best()
        assert state.machine.scene.chambers[0].volume == pytest.approx(best, rel=1e-5)
        state.undo()
        assert state.machine.scene == lb.example("washing_machine")
        state.dismiss("report")
        assert [job["kind"] for job in shown["jobs"]] == ["best"]


def test_work_can_be_cancelled() -> None:
    told = threading.Event()
    jobs = Jobs(told.set)
    path = example_path("horizontal_rig")
    jobs.start("runup", path.read_text(encoding="utf-8"), str(path))
    job = jobs._jobs["runup"]
    folder = Path(job.folder.name)
    assert folder.is_dir()
    jobs.cancel("runup")
    assert job.process.poll() is not None
    assert [one["state"] for one in jobs.shown()] == ["cancelled"]
    jobs.cancel("runup")
    jobs.close()
    assert not folder.exists()
    assert jobs.shown() == []


def test_work_that_fails_says_why() -> None:
    jobs = Jobs(lambda: None)
    jobs.start("best", "name = 1", "scene.toml")
    until(lambda: jobs.shown()[0]["state"] != "runs")
    assert jobs.shown()[0]["state"] == "failed"
    assert "must be" in jobs.shown()[0]["words"]
    assert jobs.content("best") is None
    jobs.close()


def test_a_machine_without_a_run_up_is_told_so() -> None:
    with page("front_loader") as (state, shown):
        if state.machine.scene.speed_plan is not None:
            state.machine = opened("spindle")
        state.start("runup")
        assert "no run-up" in shown["said"]["text"]
        state.start("nothing")
        assert shown["jobs"] == []


def test_sections_are_found_from_another_folder(tmp_path: Path) -> None:
    text = 'name = "x"  # kept\n[[chambers]]\nsection = "walls.msh"\n'
    moved = elsewhere(text, str(tmp_path / "machine.toml"))
    assert f'"{tmp_path / "walls.msh"}"' in moved
    assert "# kept" in moved
    assert jobs_module.elsewhere('name = "x"\n', "scene.toml") == 'name = "x"\n'


def test_without_its_extra_the_command_names_it() -> None:
    """In a process in which none of its libraries can be found, one line and no traceback."""
    code = """if True:
        import sys
        class Nothing:
            def find_spec(self, name, *_):
                if name.partition(".")[0] in ("trame", "trame_vuetify", "tomlkit"):
                    raise ModuleNotFoundError(name)
        import importlib.util
        found = importlib.util.find_spec
        importlib.util.find_spec = lambda name, *_: None if name in ("trame", "tomlkit") else found(name)
        sys.meta_path.insert(0, Nothing())
        from leblanc.cli import main
        sys.exit(main(["app", "--port", "0"]))
    """
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 2 and done.stderr.count("\n") == 1, done.stderr
    assert "pip install leblanc[app]" in done.stderr
