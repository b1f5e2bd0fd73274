"""What is written is whole or not there, in folders that every file system takes."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from leblanc.cli import exit_code
from leblanc.core import files

Capture = pytest.CaptureFixture[str]


def test_files_go_to_a_folder_named_after_the_scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert files.out_dir("Horizontal rig", None) == Path("out") / "Horizontal rig"
    assert files.out_dir("Horizontal rig", tmp_path / "a" / "b") == tmp_path / "a" / "b"
    for folder in (tmp_path / "out" / "Horizontal rig", tmp_path / "a" / "b"):
        assert folder.is_dir()
        assert list(folder.iterdir()) == []


def test_a_folder_that_cannot_be_is_named(tmp_path: Path, capsys: Capture) -> None:
    file = tmp_path / "file"
    file.touch()
    for folder in (file, file / "below"):
        assert exit_code(lambda folder=folder: files.out_dir("x", folder)) == 2
        assert capsys.readouterr().err.startswith(f"{folder}: ")


def test_where_nothing_may_be_written_another_folder_is_offered(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise PermissionError(13, "Permission denied", "out")

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(Path, "mkdir", refuse)
    assert exit_code(lambda: files.out_dir("x", None)) == 2
    assert capsys.readouterr().err == "out: Permission denied; --out DIR chooses another folder\n"


def test_a_folder_that_may_not_be_written_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(**_: object) -> None:
        raise PermissionError(13, "Permission denied", str(tmp_path / "tmpx8s7d6"))

    monkeypatch.setattr(files.tempfile, "TemporaryFile", refuse)
    with pytest.raises(PermissionError) as caught:
        files.out_dir("x", tmp_path)
    assert caught.value.filename == str(tmp_path)


@pytest.mark.parametrize(
    ("name", "folder"),
    [
        ("Horizontal rig", "Horizontal rig"),
        ("Прилад № 1", "Прилад № 1"),
        ("../../etc/passwd", "_.._etc_passwd"),
        ("a/b\\c:d", "a_b_c_d"),
        ("..", "_"),
        ("", "_"),
        (" x. ", "x"),
        ("con", "_con"),
        ("nul.txt", "_nul.txt"),
    ],
)
def test_names_that_file_systems_refuse(name: str, folder: str) -> None:
    assert files.safe_name(name) == folder


@settings(max_examples=200)
@given(st.text(st.characters(exclude_categories=["Cs"]), max_size=300))
def test_any_name_is_one_folder_below(name: str) -> None:
    folder = files.safe_name(name)
    assert Path(folder).name == folder
    assert folder not in ("", ".", "..")
    assert len(folder.encode()) <= 255


def test_a_file_is_whole_or_not_there(tmp_path: Path) -> None:
    file = tmp_path / "data.json"

    def half() -> None:
        with files.writing(file) as part:
            assert part.suffix == ".json"  # some writers choose the format by it
            part.write_text("half", encoding="utf-8")
            raise KeyboardInterrupt

    assert exit_code(half) == 130
    assert list(tmp_path.iterdir()) == []
    with files.writing(file) as part:
        part.write_text("whole", encoding="utf-8")
    assert exit_code(half) == 130
    assert [(one.name, one.read_text(encoding="utf-8")) for one in tmp_path.iterdir()] == [
        ("data.json", "whole")
    ]


def test_a_disk_that_fills_up_leaves_nothing_and_names_the_file(tmp_path: Path, capsys: Capture) -> None:
    file = tmp_path / "data.nc"

    def fill() -> None:
        with files.writing(file) as part:
            part.touch()
            raise OSError(28, "No space left on device")

    assert exit_code(fill) == 2
    assert capsys.readouterr().err == f"{file}: No space left on device\n"
    assert list(tmp_path.iterdir()) == []
