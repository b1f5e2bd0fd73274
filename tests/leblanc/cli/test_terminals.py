"""Every command on every terminal: letters that it lacks, streams that are closed, readers that left.

One process for each kind of terminal loads what the commands need and forks for each of them, so that each
finds its streams as a shell would hand them over.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from leblanc import cli

ROOT = Path(cli.__file__).parents[2]
pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")

NAME = "Öl\N{EN DASH}Zentrifuge Ω ☃"
SCENE = "öl.toml"
SIZES = ["--radius", "65mm", "--height", "20mm", "--speed", "100"]
COMMANDS = {
    "help": ["--help"],
    "version": ["--version"],
    "new": ["new", "ä.toml"],
    "explain": ["explain", SCENE],
    "run": ["run", SCENE],
    "run in JSON": ["run", SCENE, "--json", "--out", "Ä"],
    "run of a table": ["run", "vibratory_table.toml"],
    "compare": ["compare", SCENE, "--models", "statics,linear"],
    "volume": ["volume", *SIZES, "--eccentricity", "0.1mm"],
    "layer": ["layer", *SIZES, "--volume", "10ml", "--whirl-speed", "100", "--whirl-amplitude", "0.1mm"],
    "modes": ["modes", *SIZES, "--volume", "10ml"],
    "map": ["map", SCENE, "--volumes", "3", "--speeds", "5"],
    "runup": ["runup", "hochlauf.toml", "--cells", "16", "--samples", "20", "--no-check"],
    "optimise": ["optimise", SCENE, "--no-front"],
    "sweep": ["sweep", "größe.toml", "--workers", "0"],
    "view": ["view", SCENE],
    "validate": ["validate", "vector_model"],
    "no command": ["nöthing"],
    "no file": ["run", "nö\nfile\x1b[31m.toml"],
}
#: What each terminal sees at every landing; all commands on all terminals are a slow test.
QUICK = ("help", "new", "run", "no command", "no file")
MORE = {"ascii": ("explain", "volume"), "all closed": ("sweep",)}

CHILD = """if True:
    import os, sys, traceback
    from leblanc.cli import main
    import leblanc.studies.run.figure, leblanc.studies.run.study, leblanc.core.page, leblanc.core.netcdf
    import numpy.random, rich.table

    commands, told = eval(sys.argv[1]), os.open("codes", os.O_WRONLY | os.O_CREAT)
    if sys.argv[2:]:
        from dataclasses import replace
        from leblanc.core import disk
        from leblanc.plotting.page import Figure

        draw, nothing = disk.drawing, lambda _: Figure(figsize=(1.0, 1.0))
        disk.drawing = lambda answer, picture, folder, png: draw(
            answer, replace(picture, draw="__main__:nothing"), folder, png
        )
    os.dup2(told, 100)  # above the streams, of which some are closed here
    os.close(told)
    for name, arguments in commands.items():
        child = os.fork()
        if child == 0:
            sys.argv = ["leblanc", *map(os.fsdecode, arguments)]
            try:
                sys.exit(main())
            except Exception:
                os.write(100, traceback.format_exc().encode("ascii", "backslashreplace"))
                os._exit(99)
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        os.write(100, f"{name}: {code}\\n".encode())
"""

TERMINALS = {
    "ascii": ({"PYTHONIOENCODING": "ascii"}, ">said 2>complained"),
    "posix": ({"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}, ">said 2>complained"),
    "stdout closed": ({}, "2>complained >&-"),
    "stderr closed": ({}, ">said 2>&-"),
    "all closed": ({}, "<&- >&- 2>&-"),
    "stdout left": ({}, "2>complained | exec true"),
    "stderr left": ({}, "2>&1 >said | exec true"),
}


def write_inputs(folder: Path) -> None:
    """Scenes and a study with letters in their names that ASCII lacks."""
    for scene, name in (("horizontal_rig", SCENE), ("runup", "hochlauf.toml"), ("vibratory_table", "")):
        text = (ROOT / "examples" / f"{scene}.toml").read_text(encoding="utf-8")
        lines = [
            f'name = "{NAME}{" 2" * (scene == "runup")}"' if line.startswith("name =") and name else line
            for line in text.splitlines()
        ]
        lines = ["count = 5" if line.startswith("count =") else line for line in lines]
        (folder / (name or f"{scene}.toml")).write_text("\n".join(lines), encoding="utf-8")
    (folder / "größe.toml").write_text(
        f'scene = "{SCENE}"\nmethod = "random"\nsamples = 4\nseed = 1\n'
        '[vary]\n"rotor.mass" = { uniform = [3.0, 5.0] }\n',
        encoding="utf-8",
    )


def codes_of(folder: Path, terminal: str, names: tuple[str, ...], *undrawn: str) -> dict[str, int]:
    """Exit codes of some commands on a terminal; `undrawn`, a word, for pictures of nothing."""
    write_inputs(folder)
    settings, streams = TERMINALS[terminal]
    commands = {name: [word.encode() for word in COMMANDS[name]] for name in names}
    subprocess.run(
        ["bash", "-c", f'"$@" {streams}', "bash", sys.executable, "-c", CHILD, repr(commands), *undrawn],
        cwd=folder,
        env={key: value for key, value in os.environ.items() if not key.startswith("LC_")}
        | {"PYTHONPATH": str(ROOT)}
        | settings,
        check=False,
    )
    said = (folder / "codes").read_text(encoding="ascii")
    assert "Traceback" not in said, said
    complained = folder / "complained"
    assert not complained.exists() or b"Traceback" not in complained.read_bytes()
    return {line.rpartition(": ")[0]: int(line.rpartition(": ")[2]) for line in said.splitlines()}


def expected(name: str, terminal: str) -> int:
    """Exit code that was promised: who reads the answer may leave, what is written is written."""
    if name in ("no command", "no file"):
        return 2
    return 1 if terminal == "stdout left" and name != "new" else 0


@pytest.mark.parametrize("terminal", ["ascii", "stderr closed", "all closed", "stdout left"])
def test_no_terminal_ends_a_command(terminal: str, tmp_path: Path) -> None:
    names = (*QUICK, *MORE.get(terminal, ()))
    codes = codes_of(tmp_path, terminal, names, "undrawn")
    assert codes == {name: expected(name, terminal) for name in names}
    assert (tmp_path / "out" / NAME / "summary.html").exists()
    assert (tmp_path / "ä.toml").exists()
    if terminal == "stderr closed":  # messages do not go where the answer goes
        assert " done" not in (tmp_path / "said").read_text(encoding="utf-8")


@pytest.mark.slow
@pytest.mark.parametrize("terminal", TERMINALS)
def test_no_terminal_ends_any_command(terminal: str, tmp_path: Path) -> None:
    names = tuple(COMMANDS)
    assert codes_of(tmp_path, terminal, names) == {name: expected(name, terminal) for name in names}
