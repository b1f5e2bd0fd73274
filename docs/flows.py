"""Which modules of ours a command passes through, traced in a process of its own; see house.py."""

from __future__ import annotations

import contextlib
import importlib
import io
import json
import os
import re
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import FrameType
from typing import Any

# The command line, by its name of tomorrow and of today.
_FRONTS = ("leblanc", "study")
_RIG, _RUNUP = "examples/horizontal_rig.toml", "examples/runup.toml"
COMMANDS = (("run", _RIG), ("runup", _RUNUP), ("optimise", _RIG))
_SHORT = 'duration = "2 s"'


@dataclass(frozen=True)
class Flow:
    """Modules of ours that one command passes through; folders' `__init__` count as modules.

    Parameters
    ----------
    command : as typed
    entered : a function or method of theirs ran for the command: what a reader follows
    with_definitions : the same, and those whose functions ran only while they were imported, such as the
        ones that the dataclass decorator makes
    imported : all that were loaded
    """

    command: str
    entered: list[str]
    with_definitions: list[str]
    imported: list[str]


def trace_all(root: Path) -> list[Flow]:
    """Trace the commands, the run-up cut short.

    Parameters
    ----------
    root : folder of the packages
    """
    found = []
    with tempfile.TemporaryDirectory() as scratch:
        short = Path(scratch) / "runup.toml"
        text = (root / _RUNUP).read_text(encoding="utf-8")
        short.write_text(re.sub(r'duration = ".*?"', _SHORT, text), encoding="utf-8")
        for command, scene in COMMANDS:
            place = str(short) if scene == _RUNUP else scene
            flow = trace([command, place, "--out", str(Path(scratch) / "out")], root)
            found.append(Flow(f"leblanc {command} {scene}", *flow))
    return found


def trace(arguments: list[str], root: Path) -> tuple[list[str], list[str], list[str]]:
    """Modules that a command passes through, in the order of `Flow`.

    Parameters
    ----------
    arguments : behind `leblanc`
    root : folder of the packages

    Raises
    ------
    RuntimeError : the command fails
    """
    path = os.pathsep.join(filter(None, (str(root), os.environ.get("PYTHONPATH"))))
    settings = os.environ | {"PYTHONPATH": path, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run(
        [sys.executable, __file__, str(root), *arguments],
        cwd=root,
        env=settings,
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode != 0:
        raise RuntimeError(f"leblanc {' '.join(arguments)} failed:\n{done.stderr}")
    found = json.loads(done.stdout)
    return found["entered"], found["with_definitions"], found["imported"]


def watched(arguments: list[str], root: Path) -> dict[str, Any]:
    """Run a command in this process and note whose functions are entered.

    Parameters
    ----------
    arguments, root : as for `trace`
    """
    front = next(name for name in _FRONTS if (root / name / "cli").is_dir())
    ours = frozenset(path.parent.name for path in root.glob("*/__init__.py"))
    entered, at_import, seen = set[str](), set[str](), set[Any]()

    def note(frame: FrameType, event: str, _: object) -> None:
        code = frame.f_code
        name = str(frame.f_globals.get("__name__", ""))
        if event != "call" or code in seen or name.partition(".")[0] not in ours or not _is_function(frame):
            return
        if _importing(frame, ours):
            at_import.add(name)
        else:
            seen.add(code)
            entered.add(name)

    main = importlib.import_module(f"{front}.cli").main
    threading.setprofile(note)
    sys.setprofile(note)
    try:
        with contextlib.redirect_stdout(io.StringIO()):
            code = main(arguments)
    finally:
        sys.setprofile(None)
        threading.setprofile(None)  # type: ignore[arg-type]
    return {
        "code": code,
        "entered": sorted(entered),
        "with_definitions": sorted(entered | at_import),
        "imported": sorted(name for name in sys.modules if name.partition(".")[0] in ours),
    }


def _is_function(frame: FrameType) -> bool:
    """Whether this is a function, not the body of a module or of a class."""
    optimised = 0x1  # inspect.CO_OPTIMIZED
    return bool(frame.f_code.co_flags & optimised)


def _importing(frame: FrameType | None, ours: Iterable[str]) -> bool:
    """Whether the body of a module of ours is being executed around this."""
    while frame is not None:
        top = str(frame.f_globals.get("__name__", "")).partition(".")[0]
        if frame.f_code.co_name == "<module>" and top in ours:
            return True
        frame = frame.f_back
    return False


def shown(flows: Iterable[Flow]) -> str:
    """How many modules, in Markdown.

    Parameters
    ----------
    flows : of `trace_all`
    """
    counted = [(flow.command, flow.entered, flow.with_definitions, flow.imported) for flow in flows]
    rows = [(command, *(str(len(modules)) for modules in found)) for command, *found in counted]
    return markdown(("command", "modules entered", "with definitions", "imported"), rows)


def markdown(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table in Markdown."""
    return "\n".join("| " + " | ".join(row) + " |" for row in (heads, ["---"] * len(heads), *rows))


if __name__ == "__main__":
    answer = watched(sys.argv[2:], Path(sys.argv[1]))
    json.dump(answer, sys.stdout)
    raise SystemExit(answer["code"])
