"""Commands about files of machines: what differs, what a report of a fault holds, where one's own begins."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path

import pytest

from leblanc.cli import GROUPS, main
from leblanc.cli.new import _KINDS
from leblanc.scene.examples import example, example_names, example_path, example_title
from leblanc.scene.scene import Scene, load_scene, scene_from_table
from leblanc.scene.schema.paths import values_of
from tests.mutants import kills

Capture = pytest.CaptureFixture[str]
RUNUP = example_path("runup")


def digest(scene: Scene) -> str:
    """Of the machine, whoever named it."""
    return scene.altered(name="", source="", assumed=()).digest


def write(folder: Path, name: str, text: str) -> str:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return str(path)


@kills("leblanc.cli.diff:_alike", "rel_tol=_SAME", "rel_tol=0.1")
def test_what_differs(tmp_path: Path, capsys: Capture) -> None:
    text = RUNUP.read_text(encoding="utf-8")
    one = write(tmp_path, "one.toml", text)
    other = example("runup").replace({"chambers.0.volume": "0.52 l", "runup.back": True})
    two = write(tmp_path, "two.toml", other.to_toml())
    assert main(["diff", one, two, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["same"] is False
    assert {row["path"]: (row["first"], row["other"], row["unit"]) for row in found["differences"]} == {
        "chambers.0.volume": (pytest.approx(5e-4), pytest.approx(5.2e-4), "m^3"),
        "runup.back": (False, True, None),
    }
    assert main(["diff", one, two]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "chambers.0.volume 500 ml 520 ml runup.back false true" in printed


def test_the_same_machine_in_other_words(tmp_path: Path, capsys: Capture) -> None:
    one = write(tmp_path, "one.toml", example("runup").to_toml())
    assert main(["diff", str(RUNUP), one]) == 0
    assert capsys.readouterr().out == "The same machine.\n"
    table = example("runup").table()
    mass, speed = table["rotor"]["mass"], table["rotor"].pop("critical_speed")
    table["assumed"] = [path for path in table["assumed"] if path != "rotor.critical_speed"]
    table["rotor"]["stiffness"] = mass * speed**2
    two = write(tmp_path, "two.toml", scene_from_table(table).to_toml())
    assert main(["diff", one, two, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["same"] is True
    assert {row["path"] for row in found["differences"]} == {
        "rotor.critical_speed",
        "rotor.stiffness",
        "assumed",
    }


def test_values_of_every_example_have_paths_that_lead_back() -> None:
    for name in example_names():
        if name.startswith("studies/"):
            continue
        scene = example(name)
        table = scene.table()
        for path, value, unit in values_of(scene):
            found: object = table
            for key in path.split("."):
                inside = found[int(key)] if isinstance(found, list) else found
                found = inside if isinstance(found, list) else inside.get(key)  # type: ignore[union-attr]
                if found is None:
                    break  # a default
            if found is not None and not isinstance(found, dict):
                assert value == found or repr(value).replace("(", "[").replace(")", "]") == repr(found), (
                    f"{name}: {path}"
                )
            assert unit is None or not isinstance(value, str)


def test_a_report_of_a_fault_has_no_names(tmp_path: Path, capsys: Capture) -> None:
    text = RUNUP.read_text(encoding="utf-8").replace('name = "Run-up"', 'name = "Secret of ACME"')
    assert main(["report-bug", write(tmp_path, "secret.toml", text)]) == 0
    printed = capsys.readouterr().out
    assert "Secret" not in printed and "secret" not in printed and str(tmp_path) not in printed
    for library in ("leblanc", "numpy", "py-pde", "scikit-fem", "Python"):
        assert f"* {library} " in printed
    machine = scene_from_table(tomllib.loads(printed.partition("```toml")[2].partition("```")[0]))
    assert digest(machine) == digest(load_scene(RUNUP)) and machine.name == "Machine" and not machine.source


def test_without_a_machine_there_are_versions(capsys: Capture) -> None:
    assert main(["report-bug"]) == 0
    assert "toml" not in capsys.readouterr().out


@pytest.mark.parametrize("kind", _KINDS)
def test_a_machine_of_ones_own_of_each_kind(
    kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new", "--kind", kind]) == 0
    scene = load_scene(f"my_{kind}.toml")
    assert scene.name == f"My {kind.replace('_', ' ')}"
    assert digest(scene) == digest(example(_KINDS[kind]))
    assert main(["new", "--kind", kind]) == 2  # it is there
    assert main(["new", "--kind", kind, "--example", "tub"]) == 2
    assert "left out with --example" in capsys.readouterr().err


def test_no_such_kind(capsys: Capture) -> None:
    assert main(["new", "--kind", "tubs"]) == 2
    assert "did you mean tub?" in capsys.readouterr().err


def test_each_example_has_a_sentence(capsys: Capture) -> None:
    titles = {name: example_title(name) for name in example_names()}
    assert all(title.endswith(".") and " " in title and "[" not in title for title in titles.values())
    assert len(set(titles.values())) == len(titles)
    assert main(["new", "--list"]) == 0
    assert all(name in capsys.readouterr().out or name for name in titles)


def test_the_help_names_each_command_once_in_its_group(capsys: Capture) -> None:
    assert main(["--help"]) == 0
    printed = capsys.readouterr().out
    heads = [line.removesuffix(":") for line in printed.splitlines() if line.endswith(":") and line[0] != " "]
    assert heads[-len(GROUPS) :] == list(GROUPS)
    first = [line.split()[0] for line in printed.splitlines() if line.startswith("  ") and line[2] != " "]
    names = [name for names in GROUPS.values() for name in names]
    assert [word for word in first if word in names] == names
    assert "..." not in printed.partition("Begin:")[2]
