"""A file that is no scene is refused in one line; many faults in one scene come all at once."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from leblanc.cli import main
from leblanc.scene.scene import load_scene
from leblanc.scene.schema import load
from leblanc.scene.schema.load import MAX_BYTES, SceneError
from tests.leblanc.scene.test_faulty_scenes import CHAMBER, GOOD, shell

FILES = {
    "not TOML": (b"name = Rig", "valid TOML", "(at line 1, column 8)"),
    "a comma for a point": (
        b"name = 'x'\ngravity = 9,81  # m/s^2",
        "line 2",
        ": gravity = 9,81; the decimal sign",
    ),
    "a bare unit": (b"gravity = 981 cm/s^2", "line 1", "stands in quotes, as"),
    "a bare word": (b"name = Rig", ": name = Rig; a text stands in quotes"),
    "a study": (b"scene = 'rig.toml'\n[vary]", "a scene; this is a study", "leblanc sweep"),
    "an open bracket": (b'name = "x"\n[rotor\nmass = 1', "valid TOML", "line 2"),
    "a key twice": (b"name = 'a'\nname = 'b'", "valid TOML", "line 2"),
    "a table twice": (b"[rotor]\n[rotor]", "valid TOML", "line 2"),
    "half a file": (GOOD[:120].encode(), "valid TOML", "line"),
    "JSON": (b'{"name": "x"}', "valid TOML", "line 1"),
    "Latin letters of old": ('name = "Gerät"'.encode("latin-1"), "UTF-8", "byte 12, at line 1"),
    "UTF-16": (GOOD.encode("utf-16"), "UTF-8", "byte 1"),
    "bytes of no text": (bytes(range(256)), "must be"),
    "zeros": (bytes(100), "valid TOML", "line 1"),
    "too many digits": (b"name = " + b"1" * 5000, "valid TOML", "digits"),
    "deep brackets": (b"name = " + b"[" * 100_000, "less deeply nested"),
    "a key of a million parts": (b"a" + b".a" * 1_000_000 + b" = 1", "at most 30 parts; one at line 1"),
    "a table of a million parts": (b"\n[a" + b".'a'" * 1_000_000 + b"]", "at most 30 parts; one at line 2"),
    "too long": (b"#" * (MAX_BYTES + 1), "at most 10 MB"),
}


@pytest.mark.parametrize("name", FILES)
def test_a_file_that_is_no_scene(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    content, *said = FILES[name]
    path = tmp_path / "scene.toml"
    path.write_bytes(content)
    (line,) = shell(path, capsys).splitlines()
    assert line.startswith(f"{path}: must be ")
    assert all(words in line for words in said), line


def test_an_empty_file_lacks_everything(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "scene.toml"
    path.touch()
    lines = shell(path, capsys).splitlines()
    assert [line.split(": ")[1] for line in lines] == ["name", "rotor", "speeds"]


def test_a_file_that_is_not_there(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for path in (tmp_path / "none.toml", tmp_path / ("x" * 300), tmp_path / "none" / "scene.toml"):
        assert shell(path, capsys).startswith(f"{path}: must be a file that can be read: ")
    assert "No such file" in shell(tmp_path / "none.toml", capsys)


def test_a_folder_is_no_scene(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert "Is a directory" in shell(tmp_path, capsys)


def test_a_file_that_may_not_be_read(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(GOOD, encoding="utf-8")
    path.chmod(0)
    if os.access(path, os.R_OK):  # a superuser may read anything

        def refuse(*_: object) -> None:
            raise PermissionError(13, "Permission denied", str(path))

        monkeypatch.setattr(load, "open_regular", refuse)
    assert shell(path, capsys) == f"{path}: must be a file that can be read: Permission denied\n"


def test_a_path_that_cannot_be() -> None:
    with pytest.raises(SceneError, match="null"):
        load_scene("scene\0.toml")


def test_all_faults_come_at_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    wrong = {
        '"4 kg"': '"-4 kg"',
        "damping_ratio": "stiffness = 4e4\ndamping_ratio",
        'inner_radius = "10 mm"': 'inner_radius = "70 mm"',
        "count = 20": "count = 0\nstep = 1",
        '"2000 rpm"': '"50 rpm"',
        '"auto"': '"best"',
        '["rotor.mass"]': '["rotor.mas", "name"]',
    }
    text = GOOD
    for right, other in wrong.items():
        text = text.replace(right, other)
    # a second chamber, filled above its brim, shows that one wrong chamber does not hide another
    text += CHAMBER.replace("10 ml", "2 l")
    path = tmp_path / "scene.toml"
    path.write_text(text, encoding="utf-8")
    fields = [line.split(": ")[1].split(" = ")[0] for line in shell(path, capsys).splitlines()]
    assert sorted(fields) == [
        "assumed.0",
        "chambers.0.inner_radius",
        "chambers.1.volume",
        "model.liquid",
        "rotor.mass",
        "rotor.stiffness",
        "speeds.count",
        "speeds.step",
        "speeds.stop",
    ]


def test_each_fault_has_its_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """That of the key, or of the table that lacks it."""
    wrong = {'"4 kg"': '"-4 kg"', 'axis = "horizontal"': "", '"10 ml"': '"2 l"', '["rotor.mass"]': '["x"]'}
    text = GOOD
    for right, other in wrong.items():
        text = text.replace(right, other)
    path = tmp_path / "scene.toml"
    path.write_text(text, encoding="utf-8")
    lines = text.splitlines()
    expected = {
        "assumed.0": 'assumed = ["x"]',
        "rotor.mass": 'mass = "-4 kg"',
        "rotor.axis": "[rotor]",
        "chambers.0.volume": 'volume = "2 l"',
    }
    found = [line.removeprefix(f"{path}:").split(": ") for line in shell(path, capsys).splitlines()]
    assert {rest[0].split(" = ")[0]: lines[int(number) - 1] for number, *rest in found} == expected
    with pytest.raises(SceneError) as caught:  # in Python as on the command line
        load_scene(path)
    assert [lines[fault.line - 1] for fault in caught.value.faults if fault.line] == [*expected.values()]


def test_what_a_study_refuses_is_told_where_it_stands(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A scene without a fault, of which a command cannot answer one value."""
    path = tmp_path / "scene.toml"
    good = GOOD.replace("[[chambers]]", "[[chambers]]\nbaffles = { count = 4 }")
    path.write_text(good.replace('"auto"', '"kdv"'), encoding="utf-8")
    (line,) = shell(path, capsys).splitlines()
    number = good.splitlines().index('liquid = "auto"') + 1
    assert line.startswith(f'{path}:{number}: model.liquid = "kdv": must be ')


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"--radius": "-65 mm"}, "leblanc: --radius = '-65 mm': must be a finite number above 0"),
        ({"--inner-radius": "300 mm"}, "leblanc: --inner-radius = '300 mm': must be below radius (65 mm)"),
        (
            {"--volume": "3 l"},
            "leblanc: --volume = '3 l': must be at most the chamber's capacity (0.265465 l)",
        ),
        (
            {"--volume": "3e6 mm^3"},
            "leblanc: --volume = '3e6 mm^3': must be at most the chamber's capacity (265465 mm^3)",
        ),
    ],
)
def test_an_option_is_refused_as_it_was_typed(
    changed: dict[str, str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    given = {"--radius": "65 mm", "--height": "20 mm", "--eccentricity": "1 mm", "--speed": "1000 rpm"}
    assert main(["volume", *(word for pair in (given | changed).items() for word in pair)]) == 2
    assert capsys.readouterr().err == f"{said}\n"


def test_names_and_values_stay_on_their_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "two\nlines.toml"
    text = GOOD.replace('"4 kg"', '"4\\nkg\\u001b[31m"').replace("count", '"co\\nunt"')
    path.write_text(text, encoding="utf-8")
    printed = shell(path, capsys)
    assert len(printed.splitlines()) == 3  # the mass, the count that is missing, the key that is not known
    assert all(line.isprintable() for line in printed.splitlines())


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs pipes with names")
@pytest.mark.parametrize("what", ["pipe", "device", "loop"])
def test_what_never_ends_is_not_read(what: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "scene.toml"
    if what == "pipe":
        os.mkfifo(path)
    else:
        path.symlink_to("/dev/zero" if what == "device" else path.name)
    for command in ("run", "sweep"):
        assert main([command, str(path)]) == 2
        (said,) = capsys.readouterr().err.splitlines()
        assert said.startswith(f"{path}: must be a file that can be read: ")


def test_dots_within_values_are_no_keys(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(f'source = "{"a. " * 100}{"." * 100}"\n{GOOD}', encoding="utf-8")
    assert load_scene(path).source.startswith("a. a. ")


def test_only_some_of_a_million_faults_are_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "scene.toml"
    path.write_text("".join(f"k{k} = 1\n" for k in range(20_000)) + GOOD, encoding="utf-8")
    said = shell(path, capsys).splitlines()
    assert len(said) == 101
    assert said[-1] == f"{path}: must be free of 19900 more faults"
