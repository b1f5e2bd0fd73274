"""The questions as tools of a server over stdio: asked by the protocol's own client, and in the process."""

from __future__ import annotations

import asyncio
import json
import pickle
import sys
from pathlib import Path
from typing import Any

import pytest

import leblanc as lb
from leblanc.cli import main
from leblanc.cli.mcp import _ASKED, _short, _told
from leblanc.core.quantities import plain
from leblanc.core.question import parameters
from leblanc.scene.examples import example_path
from meshes.errors import InputError
from tests.mutants import kills

ROOT = Path(__file__).parents[3]
RIG = example_path("horizontal_rig").read_text(encoding="utf-8")
FEW = ["speeds.count=3"]
RUN = "leblanc.studies.run:run"
LAYER = {"radius": "150 mm", "height": "50 mm", "volume": "671 ml", "speed": 40.0}
CALLS: dict[str, dict[str, Any]] = {
    "explain": {"machine": RIG},
    "run": {"machine": RIG, "sets": [*FEW, "rotor.mass='5 kg'"]},
    "runup": {
        "machine": RIG,
        "sets": ["runup.duration='1 s'", "runup.back=false"],
        "cells": 16,
        "check": False,
        "samples": 200,
    },
    "map": {"machine": RIG, "volumes": 3, "speeds": ["1000 rpm", 150]},
    "optimise": {"machine": RIG, "front": False, "max_evaluations": 5},
    "compare": {"machine": RIG, "sets": FEW, "models": ["statics", "linear"]},
    "layer": LAYER | {"whirl_speed": 32, "whirl_amplitude": "0.15 mm"},
    "modes": LAYER | {"count": 2},
    "volume": {"radius": "150 mm", "height": "50 mm", "speed": 40.0, "eccentricity": "1 mm"},
    "bearing": {"speed": "1000 rpm", "balls": 9, "ball_diameter": "8 mm", "pitch_diameter": "40 mm"},
    "machines": {},
}


def asked(*calls: tuple[str, dict[str, Any]]) -> tuple[dict[str, Any], list[tuple[bool, str]]]:
    """Schemas of the tools of a server, and of each call whether it failed and what came back."""
    mcp = pytest.importorskip("mcp")

    async def talk() -> tuple[dict[str, Any], list[tuple[bool, str]]]:
        server = mcp.StdioServerParameters(
            command=sys.executable, args=["-m", "leblanc", "mcp"], env={"PYTHONPATH": str(ROOT)}
        )
        async with mcp.Client(server) as client:
            tools = {tool.name: tool.input_schema for tool in (await client.list_tools()).tools}
            found = [await client.call_tool(name, given) for name, given in calls]
        return tools, [(one.is_error, one.content[0].text) for one in found]

    return asyncio.run(talk())


def test_each_tool_answers_as_the_call_in_python() -> None:
    tools, answers = asked(*CALLS.items())
    assert set(tools) == set(CALLS) == {*_ASKED, "machines"}
    found = {name: json.loads(text) for name, (_, text) in zip(CALLS, answers, strict=True)}
    assert not any(failed for failed, _ in answers)
    assert found["machines"]["examples"]["horizontal_rig"].startswith("A steel disc")
    assert "Chamber" in found["machines"]["tables"]
    for name in _ASKED:
        assert set(found[name]) == {"headline", "error", "cautions", "faults", "units", "answer"}
        assert found[name]["units"] and found[name]["answer"]
    run = lb.run(lb.example("horizontal_rig").replace({"speeds.count": 3, "rotor.mass": "5 kg"}))
    assert found["run"]["answer"] == json.loads(json.dumps(plain(run.to_json())))
    assert found["run"]["units"]["amplitude"] == "m" and "5 kg" not in found["run"]["headline"]
    assert found["run"]["headline"] and found["run"]["cautions"]
    # What each option is, and nothing that is a file or has no place here.
    assert tools["run"]["required"] == ["machine"] and tools["map"]["properties"]["volumes"]["description"]
    assert not {"folder", "emulator", "mesh", "workers"} & {
        key for one in tools.values() for key in one["properties"]
    }


def test_wrong_input_and_the_end_of_the_time_come_back_as_words() -> None:
    wrong = (
        ({"machine": RIG + "\nsquares = 3"}, "squares"),
        ({"machine": "a"}, "valid TOML"),
        ({"machine": RIG, "sets": ["rotor.mass=-1"]}, "rotor.mass"),
        ({"machine": RIG, "sets": ["rotor.mass"]}, "PATH=VALUE"),
        ({"machine": RIG, "sets": ["chambers.0.section='/etc/hostname'"]}, "no file is read"),
        ({"machine": RIG, "timout": 3.0}, "timout"),
        ({"machine": RIG, "timeout": 0.0}, "greater than 0"),
        ({}, "machine"),
    )
    long = {"machine": RIG, "sets": ["runup.duration='500 s'"], "timeout": 1.0}
    _, answers = asked(
        *(("run", given) for given, _ in wrong),
        ("machines", {"name": "nothing"}),
        ("runup", long),
        ("machines", {"name": "horizontal_rig"}),
    )
    *refused, unknown, late, after = answers
    for (failed, text), (_, said) in zip(refused, wrong, strict=True):
        assert failed and said in text and "Traceback" not in text
    assert unknown[0] and "horizontal_rig" in unknown[1]
    assert late[0] and "timeout = 1 s is over" in late[1]
    assert not after[0] and json.loads(after[1]) == {"horizontal_rig": RIG}


@kills("leblanc.cli.mcp:_told", "'\"section\":' in", "'\"sections\":' in")
@kills("leblanc.cli.mcp:_told", "[table, changes, steps]", "[table, steps]")
@kills("leblanc.cli.mcp:_told", "[table, changes, steps]", "[table, changes]")
@kills("leblanc.cli.mcp:_told", "[table, changes, steps]", "[changes, steps]")
def test_no_file_of_the_caller_is_read() -> None:
    """However the key is written; a source that speaks of a section is none."""
    assert "section" in RIG
    cut = RIG.replace('radius = "65 mm"', '"sect\\u0069on" = "nowhere.msh"')
    for machine, sets in (
        (cut, []),
        (RIG, ["chambers.0.section='nowhere.msh'"]),
        (RIG, ['chambers=[{ "sect\\u0069on" = "nowhere.msh", height = 1, volume = 0 }]']),
    ):
        with pytest.raises((InputError, lb.SceneError)) as refused:
            _told("run", RUN, {"machine": machine, "sets": sets})
        assert isinstance(refused.value, InputError) and refused.value.field == "section"


@kills("leblanc.cli.mcp:_short", "// _LONG + 1", "// _LONG + 2")
@kills("leblanc.cli.mcp:_short", "// _LONG + 1", "// (2 * _LONG) + 1")
def test_long_lists_are_thinned_evenly() -> None:
    assert _short({"few": list(range(24)), "one": 3.0}) == {"few": list(range(24)), "one": 3.0}
    many = _short([[k] * 60 for k in range(201)])
    assert [row[0] for row in many] == list(range(0, 201, 9)) and {len(row) for row in many} == {20}


def test_no_option_is_a_file() -> None:
    """Readers of files are left out by name: a question that gets another one must be thought of."""
    from leblanc.cli.mcp import _LEFT, called
    from leblanc.core.question import FILE, STUDY

    for name in _ASKED:
        asks = parameters(called(f"leblanc.studies.{name}:{name}"))
        assert {one.name for one in asks if one.read in (FILE, STUDY)} <= set(_LEFT)


@pytest.mark.parametrize("wrong", [{"rotor.mas": 1.0}, {"rotor.mass": -1.0}])
def test_refusals_come_whole_out_of_another_process(wrong: dict[str, float]) -> None:
    with pytest.raises(lb.SceneError) as scene:
        lb.example("horizontal_rig").replace(wrong)
    again = pickle.loads(pickle.dumps(scene.value))
    assert str(again) == str(scene.value) and again.faults == scene.value.faults
    error = pickle.loads(pickle.dumps(InputError("radius", -1.0, "above 0")))
    assert (error.field, error.value, error.allowed) == ("radius", -1.0, "above 0")
    assert str(error) == str(InputError("radius", -1.0, "above 0"))


def test_without_the_extra_its_name_is_said(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("leblanc.cli.mcp.find_spec", lambda name: None)
    assert main(["mcp"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "pip install leblanc[mcp]" in line
