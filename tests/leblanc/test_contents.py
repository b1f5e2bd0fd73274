"""No scene overwrites what another gave, and no file of an earlier run stays unmarked beside new ones."""

from __future__ import annotations

import hashlib
import json
import shutil
from pathlib import Path

import pytest

from leblanc.cli import main
from leblanc.core import files
from leblanc.core.contents import NAME, recording, results_dir
from meshes.errors import InputError

Capture = pytest.CaptureFixture[str]
EXAMPLES = Path(__file__).parents[2] / "examples"


def write(path: Path, text: str) -> None:
    """A file as commands write it."""
    with files.writing(path) as part:
        part.write_text(text, encoding="utf-8")


def made(folder: Path) -> dict[str, dict[str, object]]:
    """What the record of a folder says, by command."""
    return dict(json.loads((folder / NAME).read_text(encoding="ascii"))["made"])


def does(command: str, scene: str, state: str, names: dict[str, str], out: Path | None = None) -> list[str]:
    """One command that writes some files; what it says of others."""
    with recording(command) as record:
        folder = results_dir("Rig", out, Path(scene), state)
        for name, text in names.items():
            write(folder / name, text)
        return record.close()


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of a scene of which there are two files."""
    monkeypatch.chdir(tmp_path)
    for name in ("a.toml", "b.toml"):
        Path(name).write_text("", encoding="utf-8")
    return Path("out/Rig")


# -- two scenes of one name ----------------------------------------------------------------------------------


@pytest.mark.usefixtures("undrawn")
def test_commands_keep_what_another_scene_gave(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.chdir(tmp_path)
    text = (EXAMPLES / "spindle.toml").read_text(encoding="utf-8")
    text = text.replace('"Spindle unit on its test rig"', '"Spindle"').replace("count = 1991", "count = 21")
    for name in ("a.toml", "b.toml"):
        Path(name).write_text(text, encoding="utf-8")
    report = tmp_path / "out" / "Spindle" / "summary.html"
    assert main(["run", "a.toml"]) == 0
    checksum = hashlib.sha256(report.read_bytes()).hexdigest()
    assert made(report.parent)["run"]["files"]["summary.html"] == checksum  # type: ignore[index]
    before = report.stat().st_mtime_ns
    capsys.readouterr()

    for command in (["run", "b.toml"], ["view", "b.toml"]):
        assert main(command) == 2
        told = capsys.readouterr().err.strip().splitlines()
        assert len(told) == 1 and "must be another folder, or --force" in told[0]
        assert "leblanc: --out = 'out/Spindle'" in told[0] and "what ../../a.toml gave" in told[0]
    assert report.stat().st_mtime_ns == before
    assert main(["run", "b.toml", "--out", "elsewhere"]) == 0
    assert main(["run", "b.toml", "--force"]) == 0
    assert made(report.parent)["run"]["scene"] == "../../b.toml"
    assert main(["run", "b.toml"]) == 0  # the same again
    shutil.move("b.toml", "c.toml")
    assert main(["run", "c.toml"]) == 0  # the same file by another name: nothing else could be overwritten
    assert [path.name for path in Path("out").iterdir()] == ["Spindle"]


def test_names_that_differ_only_where_file_systems_do_not(folder: Path) -> None:
    with recording("run"):
        results_dir("a/b", None, Path("a.toml"), "1")
    with recording("run"), pytest.raises(InputError, match=r"what \.\./\.\./a\.toml gave"):
        results_dir("a:b", None, Path("b.toml"), "1")


def test_a_link_to_a_scene_is_that_scene(folder: Path) -> None:
    does("run", "a.toml", "1", {})
    Path("link.toml").symlink_to("a.toml")
    assert does("run", "link.toml", "1", {}) == []


def test_a_chosen_folder_is_taken(folder: Path) -> None:
    does("run", "a.toml", "1", {"run.txt": "a"})
    assert does("run", "b.toml", "2", {"run.txt": "b"}, out=folder) == []
    assert (folder / "run.txt").read_text(encoding="utf-8") == "b"


# -- files of an earlier run ---------------------------------------------------------------------------------


def test_what_is_not_written_again_is_removed(folder: Path) -> None:
    does("run", "a.toml", "1", {"run.txt": "1", "chamber_2.png": "1", "mine.png": "1"})
    (folder / "mine.png").write_text("changed by hand", encoding="utf-8")
    (folder / "notes.txt").write_text("of the user", encoding="utf-8")
    said = does("run", "a.toml", "2", {"run.txt": "2"})
    assert said == [f"{folder}: removed chamber_2.png, of an earlier run"]
    assert {path.name for path in folder.iterdir()} == {"run.txt", "mine.png", "notes.txt", NAME}


def test_parts_of_a_command_stand_beside_each_other(folder: Path) -> None:
    def writes(part: str, names: tuple[str, ...]) -> None:
        with recording("export") as record:
            inside = results_dir("Rig", None, Path("a.toml"), "1", part=part)
            for name in names:
                write(inside / name, name)
            record.close()

    writes("csv", ("a.csv", "b.csv"))
    writes("xlsx", ("a.xlsx",))
    writes("csv", ("a.csv",))
    assert {path.name for path in folder.iterdir()} == {"a.csv", "a.xlsx", NAME}


def test_files_of_another_command_are_marked(folder: Path) -> None:
    does("runup", "a.toml", "1", {"runup.nc": "1"})
    assert does("run", "a.toml", "1", {"run.txt": "1"}) == []
    said = does("run", "a.toml", "2", {"run.txt": "2"})
    assert said == [f"{folder}: made by runup before the machine file changed: runup.nc"]
    assert {command: entry["current"] for command, entry in made(folder).items()} == {
        "run": True,
        "runup": False,
    }
    assert does("runup", "a.toml", "2", {"runup.nc": "2"}) == []


def test_a_run_that_was_stopped_leaves_a_mark(folder: Path) -> None:
    does("run", "a.toml", "1", {"run.txt": "1", "late.txt": "1"})
    with pytest.raises(KeyboardInterrupt), recording("run"):
        write(results_dir("Rig", None, Path("a.toml"), "1") / "run.txt", "2")
        raise KeyboardInterrupt
    assert (folder / "late.txt").exists()
    assert made(folder)["run"]["finished"] is False
    assert made(folder)["run"]["files"]["run.txt"] == hashlib.sha256(b"2").hexdigest()  # type: ignore[index]
    said = does("runup", "a.toml", "1", {"runup.nc": "1"})
    assert said == [f"{folder}: perhaps of two runs, since run was stopped: run.txt, late.txt"]


def test_a_command_that_fails_at_once_leaves_no_mark(folder: Path) -> None:
    for before in ({}, {"run.txt": "1"}):
        if before:
            does("run", "a.toml", "1", before)
        there = sorted(folder.iterdir()) if folder.exists() else None
        with pytest.raises(OSError, match="full"), recording("run"):
            results_dir("Rig", None, Path("a.toml"), "2")
            raise OSError("full")
        assert (sorted(folder.iterdir()) if folder.exists() else None) == there
        assert folder.parent.exists() == (there is not None)
    assert made(folder)["run"]["finished"] is True


# -- records of strangers ------------------------------------------------------------------------------------

SUM = hashlib.sha256(b"dear").hexdigest()


@pytest.mark.parametrize("name", ["../dear.txt", "sub/dear.txt", "link.txt", "{}", "\ud800", "\0", "x" * 999])
def test_a_record_of_a_stranger_removes_nothing_elsewhere(name: str, folder: Path) -> None:
    (folder / "sub").mkdir(parents=True)
    kept = [Path("out/dear.txt"), folder / "sub" / "dear.txt"]
    for path in kept:
        path.write_bytes(b"dear")
    (folder / "link.txt").symlink_to("../dear.txt")
    listed = {name.format(kept[0].resolve()): SUM}
    entry = {"scene": name, "digest": "0", "finished": True, "files": listed}
    (folder / NAME).write_text(json.dumps({"scene": name, "made": {"run": entry}}), encoding="ascii")
    does("run", "a.toml", "1", {"run.txt": "1"}, out=folder)
    assert all(path.read_bytes() == b"dear" for path in kept)
    assert (folder / "link.txt").is_symlink()


@pytest.mark.parametrize(
    "content", [b"", b"[]", b"{", b"\xff", b'{"made": []}', b'{"made": {"run": 1}}', b"[" * 100_000]
)
def test_a_record_that_is_none_is_written_anew(content: bytes, folder: Path) -> None:
    folder.mkdir(parents=True)
    (folder / NAME).write_bytes(content)
    assert does("run", "a.toml", "1", {"run.txt": "1"}) == []
    assert list(made(folder)) == ["run"]
