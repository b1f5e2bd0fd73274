"""One call of the command line of this checkout, in this process, whatever its packages are called."""

from __future__ import annotations

import contextlib
import importlib
import io
import os
import sys
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Called:
    """What a command gave back.

    Parameters
    ----------
    code : exit code; the name of the exception if one came through, which no command may do
    stdout, stderr : what it printed
    """

    code: int | str
    stdout: str
    stderr: str


def call(arguments: Sequence[str]) -> Called:
    """Run one command as `leblanc ARGUMENTS` would, in the present folder."""
    module, _, function = _pyproject()["project"]["scripts"]["leblanc"].partition(":")
    main = getattr(importlib.import_module(module), function)
    stdout, stderr = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(stdout), contextlib.redirect_stderr(stderr):
        try:
            code = main(list(arguments))
        except SystemExit as stop:
            code = stop.code if isinstance(stop.code, int) else 1
        except Exception as error:
            code = f"{type(error).__name__}: {error}"
    return Called(code, stdout.getvalue(), stderr.getvalue())


def use_checkout(folder: Path) -> None:
    """Make this checkout the one that is imported, here and in processes started from here.

    Commands of other packages are found by the entry points of the installed distribution, which may be of
    another checkout: a description of this one is written and takes its place.

    Parameters
    ----------
    folder : for the description
    """
    project = _pyproject()["project"]
    described = folder / f"{project['name']}-{project['version']}.dist-info"
    described.mkdir(parents=True)
    (described / "METADATA").write_text(
        f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: {project['version']}\n", encoding="utf-8"
    )
    groups = project.get("entry-points", {})
    lines = [
        line
        for group, entries in groups.items()
        for line in (f"[{group}]", *(f"{name} = {target}" for name, target in entries.items()))
    ]
    (described / "entry_points.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
    places = [str(folder), str(ROOT)]
    sys.path[:0] = places
    before = os.environ.get("PYTHONPATH")
    os.environ["PYTHONPATH"] = os.pathsep.join([*places, *([before] if before else [])])


def packages() -> list[str]:
    """Names of the packages of this checkout."""
    names: list[str] = _pyproject()["tool"]["hatch"]["build"]["targets"]["wheel"]["packages"]
    return names


def _pyproject() -> dict[str, Any]:
    return tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
