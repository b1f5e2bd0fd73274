"""A data file gives its answer back: values, words, pages, figures; a stranger's file runs nothing."""

from __future__ import annotations

import json
import lzma
import random
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import pytest
import xarray as xr

import leblanc as lb
from leblanc.cli import main
from leblanc.core.disk import FORMAT, _made, _said
from leblanc.core.netcdf import NamedArrays, read_aside, variable, write_netcdf
from leblanc.core.quantities import alike
from leblanc.core.terminal import show
from meshes.errors import InputError
from tests.leblanc.core.answers import ASKED, answer
from tests.mutants import kills

FEW = {"speeds.count": 3}
COMMENT = "# typed by hand\n"


def few(name: str, **changes: Any) -> lb.Scene:
    return lb.example(name).replace(FEW | {key.replace("__", "."): value for key, value in changes.items()})


def fitted() -> Any:
    """A machine without liquid from twelve of its own amplitudes."""
    machine = few("horizontal_rig", speeds__count=12, chambers=[])
    found = lb.run(machine)
    table = "speed [rad/s], amplitude [m]\n" + "".join(
        f"{one:.6g}, {other:.3g}\n" for one, other in zip(found.speed, found.amplitude, strict=True)
    )
    Path("measured.csv").write_text(table, encoding="utf-8")
    return lb.fit(machine, "measured.csv", unknown=["rotor.damping_ratio"])


def swept() -> Any:
    Path("scene.toml").write_text(COMMENT + few("horizontal_rig").to_toml(), encoding="utf-8")
    study = (
        COMMENT
        + 'scene = "scene.toml"\nmethod = "grid"\n[vary]\n"rotor.mass" = { linspace = [4.0, 5.0, 2] }\n'
    )
    Path("study.toml").write_text(study, encoding="utf-8")
    return lb.sweep("study.toml", out="swept", workers=0)


SPRINGS = {"objective": "layout", "layout": {"reach": [0.0, 0.05, 0.05], "turn": 0.0}}
MORE: dict[str, Callable[[], Any]] = {
    "run": lambda: lb.run(few("horizontal_rig")),
    "run of two planes": lambda: lb.run(few("two_plane_rig")),
    "run of a tub": lambda: lb.run(few("tub")),
    "balls": lambda: lb.run(few("balls")),
    "balls and liquid": lambda: lb.run(few("balls_and_liquid")),
    "runup": lambda: lb.runup(few("runup", runup__duration="1 s", runup__cells=16), samples=50),
    "map": lambda: lb.map_whirl(few("horizontal_rig"), volumes=3, speeds=5),
    "map of balls": lambda: lb.map_balls(few("balls"), values=2, speeds=3),
    "optimum": lambda: lb.optimise(few("horizontal_rig"), deflection="0.5 mm", front=False),
    "layout": lambda: lb.optimise(few("tub", optimise=SPRINGS)),
    "fit": fitted,
    "sweep": swept,
}


@pytest.fixture(autouse=True)
def own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.mark.usefixtures("_exciter_once")
@pytest.mark.parametrize("kind", [*ASKED, *MORE])
def test_a_file_gives_the_answer_back(kind: str, capsys: pytest.CaptureFixture[str]) -> None:
    found = answer(kind) if kind in ASKED else MORE[kind]()
    capsys.readouterr()
    found.save("answer.nc")
    again = lb.open("answer.nc")
    assert type(again) is type(found)
    assert again == found
    assert again.typed == found.typed
    assert alike(again.to_json(), found.to_json())
    assert again.blocks() == found.blocks()
    words = []
    for one in (found, again):
        show(one.blocks())
        words.append(capsys.readouterr().out)
    assert words[0] == words[1] != ""
    assert again.plot().axes
    with xr.open_dataset("answer.nc", engine="h5netcdf", decode_timedelta=False) as data:
        machine = {
            str(name) for name in data.variables if str(name).startswith("machine_")
        }  # of the file alone
        assert {*data.variables} - machine == {*found.to_dataset().variables}
        assert data.attrs.get("machine_file", "") == found.typed.machine_file


@kills("leblanc.core.disk:save", '"typed": typed', '"typed": {}')
@kills("leblanc.core.answer:as_typed", "scene.text", "scene.to_toml()")
def test_the_machine_file_is_kept_as_typed() -> None:
    """With its comments; of a scene that was changed in Python as a file would say it."""
    scene = few("centrifuge", speeds__count=2)
    text = COMMENT + scene.to_toml()
    Path("typed.toml").write_text(text, encoding="utf-8")
    changed = lb.load_scene("typed.toml").replace({"rotor.mass": "9 kg"})
    for asked, kept in (("typed.toml", text), (scene, scene.to_toml()), (changed, changed.to_toml())):
        lb.run(asked).save("answer.nc")  # type: ignore[arg-type]
        found = lb.open("answer.nc")
        assert found.typed.machine_file == kept
        assert lb.Scene.from_toml(kept).digest == found.digest


@kills("leblanc.scene.inputs:machine_variables", "fill.mass, fill.chamber", "fill.volume, fill.chamber")
@kills("leblanc.scene.inputs:machine_variables", "> 1e-9 * speed", ">= 0.0 * speed")
def test_a_file_says_of_what_machine_it_is(tmp_path: Path) -> None:
    """By hand: a mass on springs that are alike, a ring; the same from a file read and written again."""
    scene = few("horizontal_rig", speeds__count=2)
    rotor, path = scene.rotor.machine(), tmp_path / "a.nc"  # type: ignore[union-attr]
    lb.run(scene).save(path)
    lb.open(path).save(tmp_path / "b.nc")
    for each in (path, tmp_path / "b.nc"):
        with xr.open_dataset(each, engine="h5netcdf") as data:
            assert data.machine_mass == rotor.mass and data.machine_mass.units == "kg"
            speed = data.machine_critical_speed.values
            np.testing.assert_allclose(speed, [np.sqrt(rotor.stiffness / rotor.mass)], rtol=1e-12)
            for k, chamber in enumerate(scene.chambers):
                room = np.pi * chamber.radius**2 * chamber.height
                assert data.machine_capacity[k] == pytest.approx(room, rel=1e-12)
                liquid = chamber.volume * chamber.liquid.density
                assert data.machine_liquid_mass[k] == pytest.approx(liquid, rel=1e-12)


@pytest.mark.parametrize(
    ("command", "name", "changes"),
    [
        ("run", "centrifuge", {}),
        ("run", "balls", {}),
        ("runup", "runup", {"runup.duration": "1 s", "runup.cells": 16}),
    ],
)
def test_a_report_is_written_anew(command: str, name: str, changes: dict[str, Any], tmp_path: Path) -> None:
    """As the command wrote it, of the machine file as typed, though that is gone."""
    text = COMMENT + lb.example(name).replace(FEW | changes).to_toml()
    Path("typed.toml").write_text(text, encoding="utf-8")
    main([command, "typed.toml", "--out", "first"])
    Path("typed.toml").unlink()
    (data,) = Path("first").glob("*.nc")
    found = lb.open(data)
    assert found.typed.machine_file == text
    assert found.typed.command.split()[:3] == ["leblanc", command, "typed.toml"]
    found.write("second")
    written = {
        path.name: path.read_bytes() for path in Path("first").iterdir() if path.name != "contents.json"
    }
    assert len(written) > 2
    assert written == {path.name: path.read_bytes() for path in Path("second").iterdir()}


def test_values_are_kept_as_they_are() -> None:
    arrays = (
        np.arange(3),
        np.array([1j]),
        np.float64(2.0),
        np.array([["a"]]),
        np.array([(1,), None], object),
    )
    frozen = MappingProxyType({"a": frozenset({1})})
    whole = (
        1,
        2.5,
        float("nan"),
        None,
        True,
        "\n",
        1 + 2j,
        [1],
        {"a": (1,), 2: {}},
        Path("x"),
        arrays,
        frozen,
    )
    assert alike(_made(json.loads(json.dumps(_said(whole)))), whole)
    with pytest.raises(InputError, match="function"):
        _said(few)


def file_of(said: object, aside: bytes = b"") -> Path:
    """A file in which this stands aside."""
    arrays = NamedArrays({"x": variable(("k",), np.arange(3.0), "m", "x")}, {}, {})
    write_netcdf(arrays, Path("odd.nc"), aside or lzma.compress(json.dumps(said).encode()))
    return Path("odd.nc")


def whole(found: object, **changes: object) -> dict[str, object]:
    return {"format": FORMAT, "leblanc": "0.0", "typed": {}, "answer": found} | changes


@dataclass
class Loose:
    """Of no package that a file may name, and not frozen."""

    x: int = 0


@kills("leblanc.core.disk:_class", "if package not in _PACKAGES:", "if False:")
def test_a_strangers_class_is_not_loaded(monkeypatch: pytest.MonkeyPatch) -> None:
    loaded: list[str] = []
    monkeypatch.setattr("leblanc.core.disk.import_module", lambda name: loaded.append(name) or json)
    for address in ("subprocess:Popen", "tests.leblanc.core.test_disk:Loose", "leblanc_plugin.x:Y"):
        with pytest.raises(InputError, match="a data file that a command of leblanc wrote, undamaged"):
            lb.open(file_of(whole(["record", address, {}])))
    assert not loaded


@pytest.mark.parametrize(
    "found",
    [
        ["record", "leblanc.core.disk:json", {}],
        ["record", "leblanc.core.answer:Answer.save", {}],
        ["record", "leblanc.core.answer:Answer", {}],
        ["record", "leblanc.__main__:main", {}],
        ["record", "leblanc.cli:main", {}],
        ["record", "leblanc.core.disk:write", {}],
        ["record", "meshes.errors:InputError", {}],
        ["enum", "meshes.errors:InputError", "x"],
        ["enum", "leblanc.studies.run.notes:RunCode", "x"],
        ["array", "|O", [1], ""],
        ["array", "<f8", [10**15], ""],
        ["call", "os:system"],
        ["tuple", 1],
        7,
    ],
)
def test_what_is_no_answer_is_refused(found: object) -> None:
    with pytest.raises(InputError, match="a data file that a command of leblanc wrote"):
        lb.open(file_of(whole(found)))


@kills("leblanc.core.disk:opened", "if number > FORMAT", "if False")
@kills("leblanc.core.disk:_made", "given.keys() - names.keys() or ", "")
def test_other_versions_are_named() -> None:
    """A newer format; records that have another name, or other fields."""
    record = "leblanc.studies.bearing.answer:"
    said = _said(answer("bearing"))
    more, fewer = ([*said[:2], dict(said[2])] for _ in range(2))
    more[2]["colour"] = "red"
    del fewer[2]["orders"]
    for found, text in (
        (
            whole(said, format=FORMAT + 1, typed={"more": 1}),
            f"format {FORMAT + 1}, of which it knows {FORMAT}",
        ),
        (whole(more), "another BearingAnswer"),
        (whole(fewer), "another BearingAnswer"),
        (whole(["record", f"{record}Missing", {}]), "Missing of leblanc.studies.bearing.answer"),
        (whole(["record", "leblanc.gone:Answer", {}]), "Answer of leblanc.gone"),
    ):
        try:
            said_of = repr(lb.open(file_of(found)))
        except InputError as error:
            said_of = str(error)
        assert said_of.endswith(f"leblanc 0.0 wrote {text}")
    assert lb.open(file_of(whole(said))) == answer("bearing")


def test_damaged_files_are_refused(tmp_path: Path) -> None:
    """What stands in the file is the answer or refused, whichever byte of it is flipped."""
    answer("modes").save("answer.nc")
    content = Path("answer.nc").read_bytes()
    begin = content.index(read_aside(Path("answer.nc"))[:50])  # type: ignore[index]
    places = [begin, begin + 20, *random.Random(3).sample(range(len(content)), 60)]
    refused = 0
    for place in places:
        Path("flipped.nc").write_bytes(content[:place] + bytes([content[place] ^ 16]) + content[place + 1 :])
        try:
            assert lb.open("flipped.nc") == answer("modes")
        except InputError as error:
            refused += 1
            assert "\n" not in str(error)
    assert refused > 5
    for cut in (b"", b"no netCDF", content[: len(content) // 2], content[:-1]):
        Path("cut.nc").write_bytes(cut)
        with pytest.raises(InputError, match="undamaged"):
            lb.open("cut.nc")
    aside = read_aside(Path("answer.nc")) or b""
    for odd in (aside[:-1], b"x", lzma.compress(b"[" * 100_000), lzma.compress(b"[1,2]")):
        with pytest.raises(InputError, match="undamaged"):
            lb.open(file_of(0, odd))


def test_other_files_are_refused(tmp_path: Path) -> None:
    answer("bearing").to_dataset().to_netcdf("numbers.nc", engine="h5netcdf")
    with pytest.raises(InputError, match="this one holds no answer"):
        lb.open("numbers.nc")
    for path in ("none.nc", "none\0.nc", "numbers.nc/none"):
        with pytest.raises(InputError, match=r"path = .* which can be read"):
            lb.open(path)
    with pytest.raises(InputError, match="path"):
        lb.open(7)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="netCDF 4 file"):
        lb.open(tmp_path)


def test_a_long_machine_file_is_kept_whole() -> None:
    long = "# " + "long " * 30_000
    found = replace(answer("bearing"))  # type: ignore[type-var]
    object.__setattr__(found, "typed", replace(found.typed, machine_file=long))
    found.save("long.nc")
    assert lb.open("long.nc").typed.machine_file == long
    with xr.open_dataset("long.nc", engine="h5netcdf") as data:
        assert data.attrs["machine_file"] == long
