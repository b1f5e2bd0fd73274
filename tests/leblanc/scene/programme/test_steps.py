"""The language of a programme's steps: what is written is read again, and what is no step is said so."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from leblanc.scene.programme.steps import MAX_STEPS, Step, parse_step
from leblanc.scene.scene import Scene, scene_from_table
from leblanc.scene.schema.load import SceneError
from leblanc.studies.drives import drive_of
from meshes.errors import InputError
from solvers.runup.programme import Programme, Stage
from tests.mutants import kills

RPM = math.pi / 30.0

SPEEDS = st.one_of(st.just(0.0), st.floats(1e-6, 1e6))
RATES, TIMES = st.floats(1e-9, 1e9), st.floats(1e-9, 1e9)
STEPS = st.one_of(
    st.builds(lambda v, t: Step("to", v, time=t), SPEEDS, TIMES),
    st.builds(lambda v, r: Step("to", v, r), SPEEDS, RATES),
    st.builds(lambda t: Step("hold", time=t), TIMES),
    st.builds(lambda v: Step("coast", v), SPEEDS),
    st.builds(lambda t: Step("coast", time=t), TIMES),
)
WORDS = st.lists(
    st.sampled_from(
        ["to", "hold", "coast", "in", "at", "0", "90", "rpm", "rpm/s", "s", "10 s", "-1", "1e999", "(", "µ"]
    ),
    max_size=8,
).map(" ".join)


@settings(max_examples=300)
@given(STEPS)
def test_what_is_written_is_read_again(step: Step) -> None:
    assert parse_step(step.written()) == step
    assert (
        parse_step(f"  {step.written().upper().split(' ')[0]}  {step.written().partition(' ')[2]} ") == step
    )
    assert step.words().isprintable()


@settings(max_examples=300)
@given(st.one_of(st.text(max_size=40), WORDS, st.integers(), st.none(), st.lists(st.text(max_size=4))))
def test_any_text_is_a_step_or_a_fault(text: object) -> None:
    try:
        found = parse_step(text, "programme.steps.2")
    except InputError as fault:
        assert fault.field == "programme.steps.2" and 'a step: "to 90 rpm in 4 s"' in fault.allowed
        return
    assert parse_step(found.written()) == found


@kills("leblanc.scene.programme.steps:parse_step", 'found["what"], TIME', 'found["what"], RATE')
@kills("leblanc.scene.programme.steps:parse_step", 'Step("hold", time', 'Step("coast", time')
def test_steps_as_people_write_them() -> None:
    assert parse_step("to 90 rpm in 4 s") == Step("to", 90.0 * RPM, time=4.0)
    assert parse_step("To 1200 rpm at 60 rpm/s") == Step("to", 1200.0 * RPM, 60.0 * RPM)
    assert parse_step("to 20 Hz in 1 min") == Step("to", 40.0 * math.pi, time=60.0)
    assert parse_step("hold 10 s") == Step("hold", time=10.0)
    assert parse_step("coast to 0") == Step("coast", 0.0)
    assert parse_step("coast to 100 rpm") == Step("coast", 100.0 * RPM)
    assert parse_step("coast 20 s") == Step("coast", time=20.0)


@pytest.mark.parametrize(
    "text, told",
    [
        ("hodl 10 s", "did you mean hold?"),
        ("cost to 0", "did you mean coast?"),
        ("to 90 rpm", '"to" needs "in" and a time or "at" and a rate'),
        ("to 90 rpm in 4 rpm", "its time must be a time"),
        ("to 90 rpn in 4 s", "there is no unit rpn"),
        ("to 90 in 4 s", "this text has no unit"),
        ("to 90 rpm at 60 rpm", "its rate must be an angular acceleration"),
        ("to -90 rpm at 60 rpm/s", "its speed must be an angular speed"),
        ("hold", "its time must be a time"),
        ("coast to", "its speed must be an angular speed"),
        ("hold 0 s", "its time must be a time"),
        ("", "a step"),
    ],
)
def test_what_is_wrong_is_said(text: str, told: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_step(text)
    assert told in caught.value.allowed


def scene(programme: dict[str, object], **changes: object) -> Scene:
    table = {
        "name": "x",
        "rotor": {
            "kind": "jeffcott", "mass": 30, "stiffness": 18750, "damping": 90, "unbalance": 0.1,
            "axis": "vertical",
        },
        "chambers": [{"radius": 0.25, "height": 0.04, "volume": 5e-4, "liquid": "water"}],
        "speeds": {"start": 1, "stop": 2, "count": 2},
        "programme": programme,
    }  # fmt: skip
    return scene_from_table(table | changes)


GOOD = ["to 30 rad/s in 2 s", "hold 1 s", "to 20 rad/s at 10 rad/s^2", "coast to 5 rad/s", "coast 2 s"]


@kills("leblanc.studies.drives:_stage", "limit if free and step.time is None else", "limit if free else")
@kills(
    "leblanc.studies.drives:drive_of", "plan.drag_torque,\n            plan.drag_rate", "plan.drag_rate,\n0.0"
)
def test_a_programme_of_a_scene_is_that_of_the_solvers() -> None:
    told = {"steps": GOOD, "inertia": "0.5 kg*m^2", "drag_torque": "2 N*m", "drag_rate": "0.1 1/s"}
    found = scene(told | {"start": "0 rpm", "coast_limit": "90 s"})
    assert found.programme is not None and found.speed_plan is found.programme
    coast = Stage(5.0, duration=90.0, free=True), Stage(duration=2.0, free=True)
    stages = Stage(30.0, duration=2.0), Stage(duration=1.0), Stage(20.0, 10.0), *coast
    assert drive_of(found.programme) == Programme(0.0, stages, 0.5, 2.0, 0.1, limit=90.0)
    again = scene_from_table(found.table())
    assert again == found and again.digest == found.digest
    assert found.replace({"programme.steps.1": "hold 2 s"}).digest != found.digest


def test_other_words_for_the_same() -> None:
    """Units and blanks are no part of a scene: the fingerprint is that of the values."""
    one = {"start": "30 rpm", "steps": ["to 90 rpm in 4 s", "hold 1 min", "to 12 rad/s at 90 rpm/s"]}
    other = {"start": "0.5 Hz", "steps": ["To  1.5 Hz in 4000 ms", "hold 60 s", "to 12 1/s at 1.5 Hz/s"]}
    assert scene(one).digest == scene(other).digest
    assert scene(one).digest != scene(one | {"steps": one["steps"][:2]}).digest


@pytest.mark.parametrize(
    "programme, field, told",
    [
        ({"steps": [*GOOD[:2], "hodl 1 s"], "inertia": 1}, "programme.steps.2", "did you mean hold?"),
        ({"steps": ["to 30 rad/s in 2 s", "to 30 rad/s in 1 s"]}, "programme.steps.1", "another speed"),
        ({"steps": ["to 9 rad/s in 2 s", "coast to 9 rad/s"], "inertia": 1}, "programme.steps.1", "below"),
        ({"steps": ["hold 2 s"]}, "programme.steps", "a step to a speed above 0"),
        ({"steps": []}, "programme.steps", f"a list of 1 to {MAX_STEPS} steps"),
        ({"steps": GOOD}, "programme.inertia", "given where a step coasts"),
        ({"steps": GOOD, "inertia": 0}, "programme.inertia", "a moment of inertia"),
        ({"steps": GOOD[:2], "start": "-1 rpm"}, "programme.start", "an angular speed"),
        ({"steps": GOOD[:2], "stepps": 1}, "programme.stepps", "did you mean steps?"),
    ],
)
def test_faults_name_their_place(programme: dict[str, object], field: str, told: str) -> None:
    with pytest.raises(SceneError) as caught:
        scene({"start": 0} | programme)
    (fault,) = caught.value.faults
    assert fault.field == field and told in fault.allowed


def test_one_table_drives() -> None:
    runup = {"start": 1, "stop": 2, "rate": 1, "duration": 2}
    with pytest.raises(SceneError) as caught:
        scene({"start": 0, "steps": GOOD[:2]}, runup=runup)
    (fault,) = caught.value.faults
    assert fault.field == "runup" and "left out where [programme] is given" in fault.allowed
