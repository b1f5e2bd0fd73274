"""What commands print is JSON; what they write is whole or not there."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from leblanc.cli import exit_code, output

Capture = pytest.CaptureFixture[str]


@dataclass(frozen=True)
class Found:
    speed: Any
    label: str


def printed(value: object, capsys: Capture) -> Any:
    output.print_json(value)
    text = capsys.readouterr().out
    assert text.endswith("\n")
    assert text.count("\n") == 1
    return json.loads(text, parse_constant=lambda word: pytest.fail(f"{word} is not JSON"))


def test_json_of_everything_a_study_holds(capsys: Capture) -> None:
    value = {
        "array": np.array([[1.0, math.nan], [math.inf, -math.inf]]),
        "complex": np.array([1 + 2j, complex(math.nan, 1)]),
        "one": np.complex128(1 - 1j),
        "whole": np.int64(3),
        "flag": np.array([True, False]),
        "truth": np.bool_(True),
        "word": np.array(["statics", "linear"]),
        "none": None,
        "path": Path("a") / "b",
        "found": (Found(np.float64(2.5), "Ω"), Found([], "")),
        "number": -math.inf,
    }
    assert printed(value, capsys) == {
        "array": [[1.0, None], [None, None]],
        "complex": [[1.0, 2.0], [None, 1.0]],
        "one": [1.0, -1.0],
        "whole": 3,
        "flag": [True, False],
        "truth": True,
        "word": ["statics", "linear"],
        "none": None,
        "path": str(Path("a") / "b"),
        "found": [{"speed": 2.5, "label": "Ω"}, {"speed": [], "label": ""}],
        "number": None,
    }


def test_json_keeps_every_digit(capsys: Capture) -> None:
    numbers = [0.1, 1e-300, 1.7976931348623157e308, math.pi, -0.0]
    assert printed({"x": np.array(numbers)}, capsys)["x"] == numbers


def test_json_refuses_what_it_does_not_know(capsys: Capture) -> None:
    with pytest.raises(TypeError, match="object"):
        output.print_json({"x": object()})
    assert capsys.readouterr().out == ""


def test_files_go_to_a_folder_named_after_the_scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert output.out_dir("Horizontal rig", None) == Path("out") / "Horizontal rig"
    assert output.out_dir("Horizontal rig", tmp_path / "a" / "b") == tmp_path / "a" / "b"
    for folder in (tmp_path / "out" / "Horizontal rig", tmp_path / "a" / "b"):
        assert folder.is_dir()
        assert list(folder.iterdir()) == []


def test_a_folder_that_cannot_be_is_named(tmp_path: Path, capsys: Capture) -> None:
    file = tmp_path / "file"
    file.touch()
    for folder in (file, file / "below"):
        assert exit_code(lambda folder=folder: output.out_dir("x", folder)) == 2
        assert capsys.readouterr().err.startswith(f"{folder}: ")


def test_where_nothing_may_be_written_another_folder_is_offered(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise PermissionError(13, "Permission denied", "out")

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(Path, "mkdir", refuse)
    assert exit_code(lambda: output.out_dir("x", None)) == 2
    assert capsys.readouterr().err == "out: Permission denied; --out DIR chooses another folder\n"


def test_a_folder_that_may_not_be_written_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(**_: object) -> None:
        raise PermissionError(13, "Permission denied", str(tmp_path / "tmpx8s7d6"))

    monkeypatch.setattr(output.tempfile, "TemporaryFile", refuse)
    with pytest.raises(PermissionError) as caught:
        output.out_dir("x", tmp_path)
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
    assert output.safe_name(name) == folder


@settings(max_examples=200)
@given(st.text(st.characters(exclude_categories=["Cs"]), max_size=300))
def test_any_name_is_one_folder_below(name: str) -> None:
    folder = output.safe_name(name)
    assert Path(folder).name == folder
    assert folder not in ("", ".", "..")
    assert len(folder.encode()) <= 255


def test_a_file_is_whole_or_not_there(tmp_path: Path) -> None:
    file = tmp_path / "data.json"

    def half() -> None:
        with output.writing(file) as part:
            assert part.suffix == ".json"  # some writers choose the format by it
            part.write_text("half", encoding="utf-8")
            raise KeyboardInterrupt

    assert exit_code(half) == 130
    assert list(tmp_path.iterdir()) == []
    with output.writing(file) as part:
        part.write_text("whole", encoding="utf-8")
    assert exit_code(half) == 130
    assert [(one.name, one.read_text(encoding="utf-8")) for one in tmp_path.iterdir()] == [
        ("data.json", "whole")
    ]


def test_a_disk_that_fills_up_leaves_nothing_and_names_the_file(tmp_path: Path, capsys: Capture) -> None:
    file = tmp_path / "data.nc"

    def fill() -> None:
        with output.writing(file) as part:
            part.touch()
            raise OSError(28, "No space left on device")

    assert exit_code(fill) == 2
    assert capsys.readouterr().err == f"{file}: No space left on device\n"
    assert list(tmp_path.iterdir()) == []
