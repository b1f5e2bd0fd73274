"""The command line around the commands: exit codes, one line per fault, no traceback."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import typer

import leblanc as lb
from leblanc import cli
from leblanc.cli import exit_code, main
from leblanc.core.answer import NotConverged
from leblanc.scene.scene import load_scene
from leblanc.scene.schema.load import SceneError, SceneFault
from meshes.errors import InputError
from tests.mutants import kills

Capture = pytest.CaptureFixture[str]
ROOT = Path(cli.__file__).parents[2]


def leblanc(*arguments: str, **options: Any) -> subprocess.CompletedProcess[str]:
    """The command in a process of its own."""
    code = f"import sys; sys.path.insert(0, {str(ROOT)!r}); from leblanc.cli import main; sys.exit(main())"
    command = [sys.executable, "-c", code, *arguments]
    return subprocess.run(command, text=True, stderr=subprocess.PIPE, check=False, **options)


# -- values in place of those of the file --------------------------------------------------------------------


@kills("leblanc.cli.command:_command_line", 'for part in ("--set", change)', "for part in ()")
def test_other_values_of_a_machine(tmp_path: Path, capsys: Capture) -> None:
    """As the file with these values answers; the command that makes it again says them."""
    changes = ("rotor.unbalance=0.12 kg mm", "chambers.0.volume='0.8 l'", "speeds.count=20")
    typed = [part for change in changes for part in ("--set", change)]
    assert main(["run", str(ROOT / "examples/runup.toml"), *typed, "--json", "--out", str(tmp_path)]) == 0
    printed = json.loads(capsys.readouterr().out)
    values = {"rotor.unbalance": 1.2e-4, "chambers.0.volume": 8e-4, "speeds.count": 20}
    answer = lb.run(lb.example("runup").replace(values))
    np.testing.assert_allclose(printed["amplitude"], answer.response.amplitude, rtol=1e-12)
    assert "--set &#39;rotor.unbalance=0.12 kg mm&#39;" in (tmp_path / "summary.html").read_text("utf-8")
    assert lb.open(tmp_path / "response.nc").speed.size == 20


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ("rotor.unbalanc=3", "--set: rotor.unbalanc = 3: must be the path of a field; .*mean unbalance"),
        ("speeds.count=1.5", "--set: speeds.count = 1.5: must be a whole number"),
        ("chambers.0.volume=1,5 l", '--set: chambers.0.volume = "1,5 l": .*point, as in "1.5 l"'),
        ("chambers.7.volume=1 l", "--set: chambers.7.volume = "),
        ("rotor", "--set = 'rotor': must be PATH=VALUE"),
        ("=3", "--set = '=3': must be PATH=VALUE"),
    ],
)
def test_other_values_that_are_refused(change: str, said: str, capsys: Capture) -> None:
    assert main(["explain", str(ROOT / "examples/runup.toml"), "--set", change]) == 2
    lines = capsys.readouterr().err.strip().split("\n")
    assert len(lines) == 1 and re.search(said, lines[0])


# -- the command line itself ---------------------------------------------------------------------------------


@pytest.mark.parametrize("arguments", [[], ["--help"]])
def test_help_lists_the_commands(arguments: list[str], capsys: Capture) -> None:
    assert main(arguments) == 0
    printed = capsys.readouterr().out
    assert "Usage: leblanc" in printed
    assert "new " in printed
    assert "completion" not in printed


def test_help_loads_nothing_heavy() -> None:
    code = """if True:
        import sys
        from leblanc.cli import main
        main(["--help"])
        heavy = {"numpy", "scipy", "pydantic", "pint", "rich", "skfem", "pde", "xarray", "matplotlib"}
        sys.exit(", ".join(heavy & set(sys.modules)) or 0)
    """
    check = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert check.returncode == 0, check.stderr


# Libraries that other commands need, and those that come with them.
ELSEWHERE = {
    *("xarray", "pandas", "dask", "distributed", "pint", "zarr", "SALib", "sklearn", "joblib"),
    *("skfem", "meshio", "pde", "sympy", "pyvista", "vtk", "vtkmodules", "trame", "gmsh", "ezdxf"),
    *("matplotlib.pyplot", "scipy.optimize", "scipy.stats", "scipy.integrate", "scipy.interpolate"),
}
RIG = "examples/horizontal_rig.toml"


@pytest.mark.parametrize(
    "commands",
    [
        # Bands are looked for where waves meet critical speeds, which scipy.linalg finds.
        [(["map", RIG, "--volumes", "5", "--speeds", "11"], ["numba", "scipy.sparse"])],
        [(["explain", RIG], ["matplotlib", "h5py", "jinja2", "numba"])],
        [
            (["run", RIG], ["scipy.sparse", "numba"]),
            (["optimise", "examples/centrifuge.toml", "--no-front"], []),
            (["runup", "examples/runup.toml", "--cells", "16", "--samples", "50", "--no-check"], []),
        ],
    ],
    ids=lambda commands: commands[0][0][0],
)
def test_a_command_loads_what_it_needs(commands: list[tuple[list[str], list[str]]], tmp_path: Path) -> None:
    """To load libraries is most of a short command; not one of these has anything to say to it."""
    asked = [
        ([*given, *([] if given[0] == "explain" else ["--out", str(tmp_path)])], ELSEWHERE | set(unused))
        for given, unused in commands
    ]
    code = f"""if True:
        import sys
        from leblanc.cli import main
        for arguments, unused in {asked!r}:
            assert main(arguments) == 0
            if loaded := ", ".join(unused & set(sys.modules)):
                sys.exit(f"{{arguments[0]}}: {{loaded}}")
    """
    check = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert check.returncode == 0, check.stderr


def test_version(capsys: Capture) -> None:
    assert main(["--version"]) == 0
    assert capsys.readouterr().out.strip()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["nosuch"], "nosuch"),
        (["--nosuch"], "--nosuch"),
        (["new", "--nosuch"], "--nosuch"),
        (["new", "a.toml", "b.toml"], "b.toml"),
    ],
)
def test_a_wrong_command_line_is_one_clear_line(arguments: list[str], said: str, capsys: Capture) -> None:
    assert main(arguments) == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    (line,) = printed.err.splitlines()
    assert line.startswith("leblanc: ")
    assert said in line
    assert line.endswith((". See: leblanc --help", "? See: leblanc --help", ". See: leblanc new --help"))


# -- what a command may raise --------------------------------------------------------------------------------

SCENE_FAULTS = SceneError(
    [SceneFault("s.toml", "rotor.mass", "-1", "above 0"), SceneFault("s.toml", "name", None, "given")]
)


@pytest.mark.parametrize(
    ("error", "code", "lines"),
    [
        (
            InputError("radius", -1.0, "a finite number above 0"),
            2,
            ["leblanc: radius = -1.0: must be a finite"],
        ),
        (SCENE_FAULTS, 2, ["s.toml: rotor.mass = -1: must be above 0", "s.toml: name: must be given"]),
        (NotConverged(["90 rad/s: no branch", "95 rad/s: no branch"]), 3, ["90 rad/s: no", "95 rad/s: no"]),
        (PermissionError(13, "Permission denied", "out/x"), 2, ["out/x: Permission denied"]),
        (OSError(28, "No space left on device"), 2, ["leblanc: No space left on device"]),
        (typer.BadParameter("must be one of a,\n\tb"), 2, ["leblanc: Invalid value: must be one of a, b"]),
        (KeyboardInterrupt(), 130, ["leblanc: interrupted"]),
        (BrokenPipeError(32, "Broken pipe"), 1, []),
    ],
    ids=lambda it: type(it).__name__ if isinstance(it, BaseException) else "",
)
def test_each_failure_has_its_exit_code(
    error: BaseException, code: int, lines: list[str], capsys: Capture
) -> None:
    def fail() -> None:
        raise error

    assert exit_code(fail) == code
    printed = capsys.readouterr()
    assert printed.out == ""
    said = printed.err.splitlines()
    assert len(said) == len(lines)
    assert all(line.startswith(start) for line, start in zip(said, lines, strict=True))


def test_a_command_keeps_its_exit_code_within_typer(monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    commands = typer.Typer()

    @commands.callback()
    def _all() -> None: ...

    @commands.command()
    def fail(how: str) -> None:
        raise {
            "input": InputError("radius", -1.0, "above 0"),
            "stuck": NotConverged(["90 rad/s"]),
            "stop": KeyboardInterrupt(),
            "exit": typer.Exit(3),
        }[how]

    monkeypatch.setattr(cli, "application", lambda _: commands)
    codes = {how: main(["fail", how]) for how in ("input", "stuck", "stop", "exit")}
    assert codes == {"input": 2, "stuck": 3, "stop": 130, "exit": 3}
    assert "Traceback" not in capsys.readouterr().err


def test_a_mistake_of_the_program_is_not_hidden() -> None:
    with pytest.raises(ZeroDivisionError):
        exit_code(lambda: 1 / 0)


class Package:
    """An installed package with these entry points; None if its description is damaged."""

    def __init__(self, entries: list[EntryPoint] | None) -> None:
        self.entries = entries

    @property
    def entry_points(self) -> list[EntryPoint]:
        if self.entries is None:
            raise TypeError("Pair.__new__() missing 1 required positional argument: 'value'")
        return self.entries


def announce(monkeypatch: pytest.MonkeyPatch, *packages: list[EntryPoint] | None) -> None:
    """Let these be the installed packages."""
    monkeypatch.setattr("leblanc.registry.distributions", lambda: [Package(entries) for entries in packages])


def test_broken_packages_do_not_end_the_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    (tmp_path / "plugs.py").write_text(
        "def odd(it: 'nosuch') -> None: ...\n"
        "def good() -> None: print('well')\n"
        "def __getattr__(name):\n"
        "    raise {'ends': SystemExit(7), 'fails': ZeroDivisionError('line\\nbreak')}[name]\n",
        encoding="utf-8",
    )
    monkeypatch.syspath_prepend(tmp_path)
    names = ("good", "odd", "ends", "fails")
    plugs = [EntryPoint(name, f"plugs:{name}", "leblanc.commands") for name in names]
    taken = EntryPoint("run", "plugs:fails", "leblanc.commands")
    announce(monkeypatch, None, [*plugs, taken], [EntryPoint("good", "plugs:fails", "leblanc.commands")])

    assert main(["--help"]) == 0
    printed = capsys.readouterr()
    assert printed.out.count("Not available.") == 3
    unread, shadowed, second = printed.err.splitlines()
    assert "entry points of a package cannot be read" in unread
    assert shadowed == "leblanc: plugs:fails is not used: leblanc.commands has run of leblanc itself"
    assert second == "leblanc: plugs:fails is not used: leblanc.commands has good of plugs:good"

    assert main(["good"]) == 0
    assert capsys.readouterr().out == "well\n"
    for name in names[1:]:
        assert main([name]) == 2
        *_, last = capsys.readouterr().err.splitlines()
        assert f"plugs:{name} cannot be loaded" in last
    assert main(["run", "nosuch.toml"]) == 2
    assert "nosuch.toml" in capsys.readouterr().err


def test_a_command_of_another_package(monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    entries = [
        EntryPoint("measure", "leblanc.cli.new:new", "leblanc.commands"),
        EntryPoint("broken", "no_such_package.command:broken", "leblanc.commands"),
    ]
    announce(monkeypatch, entries)
    assert main(["--help"]) == 0
    assert "measure" in capsys.readouterr().out
    assert main(["broken", "anything", "--at-all"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "no_such_package" in line


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is always full")
def test_a_full_disk_is_one_line() -> None:
    with Path("/dev/full").open("w") as full:
        done = leblanc("--version", stdout=full)
    assert done.returncode == 2
    assert done.stderr == "leblanc: No space left on device\n"


def test_a_reader_that_left_is_no_error() -> None:
    reading, writing = os.pipe()
    os.close(reading)
    with os.fdopen(writing, "w") as pipe:
        done = leblanc("--help", stdout=pipe)
    assert (done.returncode, done.stderr) == (1, "")


# -- new -----------------------------------------------------------------------------------------------------


def test_new_writes_a_scene_that_loads(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new"]) == 0
    assert main(["new", "other.toml"]) == 0
    assert capsys.readouterr().out == ""
    assert load_scene("scene.toml") == load_scene("other.toml")
    assert sorted(file.name for file in tmp_path.iterdir()) == ["other.toml", "scene.toml"]
    assert "#" in (tmp_path / "scene.toml").read_text(encoding="utf-8")


def test_new_overwrites_only_by_force(tmp_path: Path, capsys: Capture) -> None:
    file = tmp_path / "scene.toml"
    file.write_text("mine", encoding="utf-8")
    assert main(["new", str(file)]) == 2
    assert file.read_text(encoding="utf-8") == "mine"
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"{file}: ")
    assert "--force" in line
    assert main(["new", str(file), "--force"]) == 0
    assert load_scene(file)


def test_new_names_what_it_cannot_write(tmp_path: Path, capsys: Capture) -> None:
    file = tmp_path / "none" / "scene.toml"
    assert main(["new", str(file)]) == 2
    assert capsys.readouterr().err == f"{file}: No such file or directory\n"
    assert main(["new", str(tmp_path), "--force"]) == 2
    assert capsys.readouterr().err.startswith(f"{tmp_path}: ")
    assert list(tmp_path.iterdir()) == []
