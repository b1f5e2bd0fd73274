"""The net itself: it holds what it should, it sees what is changed, and it runs."""

from __future__ import annotations

import copy
import math
import subprocess
import sys
from collections.abc import Callable
from itertools import chain
from pathlib import Path
from typing import Any

import pytest

from tests.net.__main__ import KEPT
from tests.net.answers import Answer, plain, read, write
from tests.net.call import ROOT
from tests.net.cases import Case, all_cases
from tests.net.compare import arrays, compare
from tests.net.scenes import changed, shake, shake_options
from tests.net.tolerances import DEFAULT, TABLE, tolerance_of

NAMES = [case.name for case in all_cases()]
RUN = "run-horizontal_rig"
NETCDF = "out/response.nc"


def kept(name: str) -> Answer:
    return read(KEPT / f"{name}.json.xz")


def test_every_command_has_a_kept_answer_and_every_answer_a_command() -> None:
    assert sorted(path.name for path in KEPT.iterdir()) == sorted(f"{name}.json.xz" for name in NAMES)
    typed = {case.name: list(case.argv) for case in all_cases()}
    assert {name: kept(name)["argv"] for name in NAMES} == typed


def test_no_command_ended_with_an_exception() -> None:
    codes = {name: kept(name)["code"] for name in NAMES}
    assert set(codes.values()) == {0, 2, 3}
    assert {name for name, code in codes.items() if code == 2 and not name.startswith("wrong-")} == {
        "optimise-lobes",  # the search knows round walls only, and says so
    }
    assert all(code == 2 for name, code in codes.items() if name.startswith("wrong-"))


def test_what_is_kept_is_small() -> None:
    assert sum(path.stat().st_size for path in KEPT.iterdir()) < 3e6


def _scaled(factor: float) -> Callable[[Answer], None]:
    def change(answer: Answer) -> None:
        amplitude = answer["stdout"]["amplitude"]
        k = amplitude.index(max(amplitude))
        amplitude[k] *= factor

    return change


def _stdout(key: str, value: Any) -> Callable[[Answer], None]:
    return lambda answer: answer["stdout"].update({key: value})


def _first(key: str, value: Any) -> Callable[[Answer], None]:
    return lambda answer: answer["stdout"][key].__setitem__(0, value)


def _variable(key: str, value: Any) -> Callable[[Answer], None]:
    return lambda answer: answer["data"][NETCDF]["variables"]["amplitude"].update({key: value})


CHANGES: dict[str, tuple[Callable[[Answer], None], str]] = {
    "value": (_scaled(1.0 + 2e-12), "stdout.amplitude["),
    "sign": (_scaled(-1.0), "stdout.amplitude["),
    "not a number": (_scaled(math.nan), "stdout.amplitude["),
    "None for a number": (_first("amplitude", None), "stdout.amplitude[0]"),
    "a number for None": (_first("error_estimate", 0.0), "stdout.error_estimate[0]"),
    "truth": (_first("dry_patch", True), "stdout.dry_patch[0]"),
    "1 for true": (_first("stable", 1), "stdout.stable[0]"),
    "model": (_first("model", "kdv"), "stdout.model[0]"),
    "missing key": (lambda answer: answer["stdout"].pop("phase"), "stdout.phase"),
    "renamed key": (
        lambda answer: answer["stdout"].update({"lag": answer["stdout"].pop("phase")}),
        "stdout.lag",
    ),
    "new key": (_stdout("novel", 1.0), "stdout.novel"),
    "shorter": (lambda answer: answer["stdout"]["speed"].pop(), "stdout.speed"),
    "shape": (
        lambda answer: answer["stdout"].update(deflection=[list(chain(*answer["stdout"]["deflection"]))]),
        "stdout.deflection#",
    ),
    "prose of another type": (_stdout("notes", "<str>"), "stdout.notes"),
    "new file": (lambda answer: answer["files"].update({"out/more.csv": "written"}), "files.out/more.csv"),
    "missing file": (lambda answer: answer["files"].pop("out/summary.html"), "files.out/summary.html"),
    "an empty list": (_stdout("phase", []), "stdout.phase"),
    "exit code": (lambda answer: answer.update(code=3), "code"),
    "an exception": (lambda answer: answer.update(code="ValueError: no"), "code"),
    "units": (_variable("units", "mm"), f"data.{NETCDF}.variables.amplitude.units"),
    "dims": (_variable("dims", ["time"]), f"data.{NETCDF}.variables.amplitude.dims"),
    "dtype": (_variable("dtype", "float32"), f"data.{NETCDF}.variables.amplitude.dtype"),
    "variable": (
        lambda answer: answer["data"][NETCDF]["variables"].pop("amplitude"),
        f"data.{NETCDF}.variables.amplitude.values",
    ),
}


@pytest.mark.parametrize("name", CHANGES)
def test_every_kind_of_change_is_told(name: str) -> None:
    change, path = CHANGES[name]
    before = kept(RUN)
    after = copy.deepcopy(before)
    change(after)
    told = compare(RUN, before, after)
    assert told
    assert any(one.path.startswith(path) for one in told), [str(one) for one in told]


def test_rounding_is_not_told() -> None:
    before = kept(RUN)
    after = copy.deepcopy(before)
    assert compare(RUN, before, after) == []
    _scaled(1.0 + 5e-13)(after)  # half the tolerance
    assert after != before
    assert compare(RUN, before, after) == []


def test_faults_on_stderr_are_told() -> None:
    before = kept("wrong-negative_height")
    scene = "wrong/negative_height.toml"
    assert before["stderr"] == [f"{scene}:30: chambers.0.height", f"{scene}:37: chambers.1.height"]
    one_line = before | {"stderr": before["stderr"][:1]}
    other_field = before | {"stderr": [line.replace("height", "radius") for line in before["stderr"]]}
    assert compare("wrong-negative_height", before, one_line)
    assert compare("wrong-negative_height", before, other_field)


def test_angles_differ_by_the_shorter_way_round() -> None:
    before, after = ({"stdout": {"phase": [math.copysign(math.pi, sign), 1.0]}} for sign in (1.0, -1.0))
    assert compare("run", before, after) == []
    turned = {"stdout": {"phase": [-math.pi, -1.0]}}
    assert [one.path for one in compare("run", before, turned)] == ["stdout.phase[1]"]


def test_modes_may_change_places_but_not_values() -> None:
    rows = ([1.0, 2.0], [2.0, 1.0], [2.0, 3.0])
    before, after, other = ({"data": {"campbell_frequency": {"values": [row]}}} for row in rows)
    assert compare("run-two_plane_rig", before, after) == []
    assert compare("run-two_plane_rig", before, other)
    assert compare("run-tub", before, after)


def test_a_difference_is_told_with_its_size() -> None:
    before = {"stdout": {"rows": [{"x": 2.0, "y": 1.0}, {"x": -4.0, "y": 1.0}]}}
    after = {"stdout": {"rows": [{"x": 2.0, "y": 1.0}, {"x": -4.5, "y": 1.0}]}}
    (told,) = compare("run", before, after)
    assert (told.path, told.kept, told.found) == ("stdout.rows[1].x", "-4.0", "-4.5")
    assert told.relative == 0.125  # of the column's largest magnitude, 4
    assert str(told) == "run: stdout.rows[1].x: kept -4.0, found -4.5, relative difference 0.12"


def test_every_tolerance_is_needed() -> None:
    needed = {id(entry[2]) for entry in TABLE} | {id(DEFAULT)}
    for name in NAMES:
        needed -= {id(tolerance_of(name, path)) for path in arrays(kept(name))}
        if not needed:
            break
    assert not needed


def test_prose_is_held_by_type() -> None:
    value = {"model": "long_wave", "text": "Two words", "notes": ["a", "b"], "wall_time": 0.25, "rate": 3}
    assert plain(value, frozenset({"rate"})) == {
        "model": "long_wave",
        "text": "<str>",
        "notes": "<list>",
        "wall_time": "<number>",
        "rate": "<number>",
    }


def test_an_answer_is_kept_to_the_last_digit_and_in_the_same_bytes(tmp_path: Path) -> None:
    answer = {"stdout": {"x": [0.1, math.pi, 1e-300, None, True]}, "code": 0}
    for name in ("a", "b"):
        write(tmp_path / name, dict(reversed(answer.items())) if name == "b" else answer)
    assert read(tmp_path / "a") == answer
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


def test_scenes_are_changed_by_their_paths() -> None:
    text = 'name = "A"\n[speeds]\ncount = 5  # many\n[[chambers]]\ncount = 7\n'
    assert changed(text, {"speeds.count": "2"}) == text.replace("count = 5  # many", "count = 2")
    with pytest.raises(ValueError, match=r"rotor\.mass"):
        changed(text, {"rotor.mass": "2"})


def test_shaken_inputs_differ_by_rounding() -> None:
    assert shake('mass = "4 kg"\nheight = "4 m"\n') == 'mass = "4.000000000000004 kg"\nheight = "4 m"\n'
    assert shake_options(("layer", "--volume", "4e-4")) == ("layer", "--volume", repr(4e-4 * (1.0 + 1e-15)))


def test_the_command_tells_a_fault_and_nothing_else(tmp_path: Path) -> None:
    """Three commands run, one of which is kept with another value."""
    wanted = "layer-linear"
    names = [name for name in NAMES if wanted in name]
    for name in names:
        answer = kept(name)
        if name == wanted:
            answer["stdout"]["force_ratio"][0] *= 1.001
        write(tmp_path / f"{name}.json.xz", answer)
    command = [sys.executable, "-m", "tests.net", "check", "--only", wanted, "--kept", str(tmp_path)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 1, done.stderr
    told = [line for line in done.stdout.splitlines() if ": kept" in line]
    assert len(told) == 1
    assert told[0].startswith("layer-linear: stdout.force_ratio[0]: kept")
    assert told[0].endswith("relative difference 0.001")
    assert len(names) == 3


def test_what_a_machine_cannot_run_is_skipped(monkeypatch: pytest.MonkeyPatch) -> None:
    from tests.net import cases

    drawn = [case for case in all_cases() if case.needs]
    assert {case.needs for case in drawn} == {"screen"}
    assert all(isinstance(case, Case) and case.argv[0] == "view" for case in drawn)
    monkeypatch.setattr(cases, "_loads", lambda library: False)
    assert cases.missing("screen") == "no libEGL"
    assert cases.missing("") is None
