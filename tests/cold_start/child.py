"""`python -m tests.cold_start.child FILE COMMAND ...`: one command of `leblanc`, watched.

A timer interrupts the command every few milliseconds of its processor time and notes which library is at
work, whether that is an import or done for the physics, and which call of the command function it belongs to.
What was noted and the modules that the command ended with go to FILE as JSON.
"""

from __future__ import annotations

import importlib
import io
import json
import signal
import sys
import sysconfig
from collections import Counter
from contextlib import redirect_stdout
from pathlib import Path
from types import FrameType

_ROOT = Path(__file__).resolve().parents[2]
FRONT = "leblanc"  # the package of the command line
OURS = frozenset({"meshes", "fluid", "solvers", FRONT, "validation"})
# What these have done is physics, whoever does it; numba's getting ready of a kernel is not.
PHYSICS = frozenset({"meshes", "fluid", "solvers"})
_GETTING_READY = "_compile_for_args"
# Processor time between two notes, s; kernels round it up to their own tick.
_EVERY = 1e-3
_PLACES = tuple(
    sorted({sysconfig.get_paths()[name] for name in ("purelib", "platlib")}, key=len, reverse=True)
)

START, STANDARD = "command line", "standard library"


def library(file: str) -> str | None:
    """Top-level package of a source file; None for the standard library and what has no file."""
    for place in (*_PLACES, str(_ROOT)):
        if file.startswith(place + "/"):
            name = file[len(place) + 1 :].partition("/")[0].partition(".")[0]
            return name if place != str(_ROOT) or name in OURS else None
    return None


def place(frame: FrameType | None, command: str) -> tuple[str, str, str]:
    """Call under way, "import", "physics" or "work", and library of the innermost frame.

    The command's name is that of its module and of its function.
    """
    at_work, imported, importing, call, inner = None, None, False, START, None
    physics, getting_ready = False, False
    while frame is not None:
        code = frame.f_code
        if code.co_filename == "<frozen importlib._bootstrap>":
            if code.co_name == "_find_and_load" and imported is None:
                top = str(frame.f_locals.get("name", "")).partition(".")[0]
                imported = None if top in sys.stdlib_module_names else top
            importing = True
        else:
            owner = library(code.co_filename)
            at_work = at_work or owner
            getting_ready |= code.co_name == _GETTING_READY
            physics |= owner in PHYSICS
        if code.co_name == command and Path(code.co_filename).parent.name == "cli":
            call = _name(inner, command)
        inner, frame = frame, frame.f_back
    if importing:
        return call, "import", imported or STANDARD
    return call, "physics" if physics and not getting_ready else "work", at_work or STANDARD


def _name(inner: FrameType | None, command: str) -> str:
    """The call that the command function has under way."""
    if inner is None or library(inner.f_code.co_filename) is None:
        return START if inner is None else "imports"
    name = inner.f_code.co_name
    return name if name != command else START


def watch(arguments: list[str]) -> dict[str, object]:
    """Run a command: `code` of its exit; `notes` (call, kind, library, count); `modules` at the end."""
    notes: Counter[tuple[str, str, str]] = Counter()
    command = arguments[0]

    def note(_number: int, frame: FrameType | None) -> None:
        notes[place(frame, command)] += 1

    signal.signal(signal.SIGPROF, note)
    signal.setitimer(signal.ITIMER_PROF, _EVERY, _EVERY)
    try:
        with redirect_stdout(io.StringIO()):
            code = importlib.import_module(f"{FRONT}.cli").main(arguments)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
    modules = [name for name in sys.modules if name not in _LOADED]
    return {"code": code, "notes": [[*key, count] for key, count in notes.items()], "modules": modules}


_LOADED = frozenset(sys.modules)

if __name__ == "__main__":
    Path(sys.argv[1]).write_text(json.dumps(watch(sys.argv[2:])), encoding="utf-8")
