"""A target that cannot be written is found before the work, by every command that writes."""

from __future__ import annotations

import os
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path

import pytest

from leblanc.cli import main

EXAMPLES = Path(__file__).parents[3] / "examples"
RIG, RUNUP = str(EXAMPLES / "vertical_rig.toml"), str(EXAMPLES / "weak_motor.toml")
TABLE, STUDY = str(EXAMPLES / "vibratory_table.toml"), str(EXAMPLES / "studies" / "fill_grid.toml")
CHAMBER = ["--radius", "0.1", "--height", "0.05", "--volume", "1e-4", "--speed", "50"]
LAYER = ["layer", *CHAMBER, "--whirl-speed", "40", "--whirl-amplitude", "1e-3"]
Capture = pytest.CaptureFixture[str]

# What each command does first once it has read what it is given.
WORK = (
    "leblanc.studies.run.study.run_scene",
    "leblanc.wings.exciter.study.run_exciter",
    "leblanc.studies.compare.study._answer",
    "leblanc.studies.layer.study.answer_layer",
    "leblanc.studies.layer.study.layer_history",
    "leblanc.studies.layer.study.layer_film",
    "leblanc.studies.modes.study.answer_modes",
    "leblanc.studies.map.study.map_scene",
    "leblanc.studies.runup.study.runup_scene",
    "leblanc.studies.optimise.study.optimise_scene",
    "leblanc.studies.sweep.study.answer_sweep",
    "leblanc.studies.shapes.machine.machine_view",
    "leblanc.studies.shapes.machine.table_view",
    "leblanc.studies.shapes.machine.mode_view",
    "validation.trade.trade.trade_scene",
    "validation.run_notebooks.execute",
)
FOLDERS: dict[str, Sequence[str]] = {
    "run": ["run", RIG, "--out"],
    "run of a table": ["run", TABLE, "--out"],
    "compare": ["compare", RIG, "--models", "statics,linear", "--out"],
    "layer": [*LAYER, "--out"],
    "modes": ["modes", *CHAMBER, "--out"],
    "map": ["map", RIG, "--out"],
    "runup": ["runup", RUNUP, "--out"],
    "optimise": ["optimise", RIG, "--out"],
    "sweep": ["sweep", STUDY, "--workers", "0", "--out"],
    "view": ["view", RIG, "--out"],
    "trade": ["trade", RIG, "--out"],
    "notebooks": ["notebooks", "1_paraboloid", "--out"],
    "frames of a view": ["view", RIG, "--animate"],
}
FILES: dict[str, tuple[Sequence[str], str]] = {
    "film of a layer": ([*LAYER, "--animate"], ".gif"),
    "film of a run-up": (["runup", RUNUP, "--animate"], ".gif"),
    "picture": (["view", RIG, "--screenshot"], ".png"),
    "picture of a table": (["view", TABLE, "--screenshot"], ".png"),
    "picture of a mode": (["view", RIG, "--mode", "1", "--screenshot"], ".png"),
    "film of a view": (["view", RIG, "--animate"], ".gif"),
}
# What commands call their files, in a folder that is there.
NAMES = {
    "run": ("response.nc", "summary.html"),
    "run of a table": ("summary.html",),
    "compare": ("compare.nc",),
    "map": ("map.nc", "map.html"),
    "runup": ("runup.nc", "runup.html"),
    "optimise": ("optimum.nc", "optimise.html"),
    "view": ("view.png",),
    "trade": ("trade.json",),
}


@pytest.fixture(autouse=True)
def idle(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """No command gets to its work."""

    def work(*_: object, **__: object) -> None:
        pytest.fail("the work was begun")

    # All are loaded first: one loaded later would keep what stands here in place of the work of another.
    for name in WORK:
        import_module(name.rpartition(".")[0])
    for name in WORK:
        monkeypatch.setattr(name, work)
    monkeypatch.chdir(tmp_path)


def refused(arguments: Sequence[str], target: Path, capsys: Capture) -> None:
    assert main([*arguments, str(target)]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"{target}")


@pytest.mark.parametrize("name", FOLDERS)
def test_folder(name: str, tmp_path: Path, capsys: Capture) -> None:
    if name == "notebooks":  # which says first that it lacks its extra
        pytest.importorskip("jupytext")
    (tmp_path / "file").touch()
    for target in (tmp_path / "file" / "below", tmp_path / ("long" * 70)):
        refused(FOLDERS[name], target, capsys)
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


@pytest.mark.parametrize("name", NAMES)
def test_file_in_a_folder(name: str, tmp_path: Path, capsys: Capture) -> None:
    for file in NAMES[name]:
        (tmp_path / "a" / file).mkdir(parents=True)
        assert main([*FOLDERS[name], str(tmp_path / "a")]) == 2
        assert capsys.readouterr().err == f"{tmp_path / 'a' / file}: Is a directory\n"
        (tmp_path / "a" / file).rmdir()


@pytest.mark.parametrize("name", FILES)
def test_file(name: str, tmp_path: Path, capsys: Capture) -> None:
    arguments, ending = FILES[name]
    (tmp_path / "file").touch()
    (tmp_path / f"folder{ending}").mkdir()
    for target in ("file/film", "long" * 70, "folder"):
        refused(arguments, tmp_path / f"{target}{ending}", capsys)


@pytest.mark.parametrize("name", FILES)
def test_protected_file(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    """Its owner has taken the permission to write away; root may write all the same."""
    arguments, ending = FILES[name]
    target, allowed = tmp_path / f"kept{ending}", os.access
    target.write_text("kept")
    monkeypatch.setattr(
        os,
        "access",
        lambda path, mode: allowed(path, mode) and not (Path(path) == target and mode == os.W_OK),
    )
    refused(arguments, target, capsys)
    assert target.read_text() == "kept"
