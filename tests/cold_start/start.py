"""What a command costs from a cold start, and what takes the time.

    python -m tests.cold_start.start                          # the usual commands on shipped scenes
    python -m tests.cold_start.start run examples/tub.toml    # any command
    python -m tests.cold_start.start --json tests/cold_start/cold_start.json  # as kept

All times are processor time, user and system, of a process of its own with its threads: medians of runs in
turn with those of what they are compared with, so that other work on the machine acts on both alike. The
libraries' part is a process that imports all modules of libraries that the command ended with, in the same
order, and nothing of ours. Compiled kernels come from numba's cache: an untimed run comes first. POSIX only.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from tests.cold_start.child import FRONT, OURS
from validation.study import launch, write

KEPT = Path(__file__).with_name("cold_start.json")
ROOT = Path(__file__).resolve().parents[2]
RIG, RUNUP = "examples/horizontal_rig.toml", "examples/runup.toml"
COMMANDS = (
    *(("--help",), ("explain", RIG), ("run", RIG), ("map", RIG), ("optimise", RIG)),
    ("runup", RUNUP),
)
_PICTURES, _FILES = {"matplotlib", "PIL", "contourpy", "numpy"}, {"h5py", "h5netcdf"}  # beside the physics
_ENTRY = f"import sys; from {FRONT}.cli import main; sys.exit(main())"
_IMPORT_ALL = """
import importlib, sys
for name in sys.stdin.read().split():
    try:
        importlib.import_module(name)
    except ImportError:  # an alias that a library sets up by itself
        pass
"""


@dataclass(frozen=True)
class ColdStart:
    """What one command costs from a cold start; processor time, s."""

    arguments: tuple[str, ...]  #: behind `leblanc`
    total: float  #: of the command
    libraries: float  #: of importing the modules of libraries that it ends with, Python's own start included
    modules: dict[str, int]  #: how many modules of each library that is
    #: call of the command function, "import", "physics" or "work", library: share of the command's time
    notes: dict[tuple[str, str, str], float]

    @property
    def ratio(self) -> float:
        """Time of the command over that of its libraries."""
        return self.total / self.libraries

    @property
    def physics(self) -> float:
        """Time of the command that goes into its answer."""
        return sum(seconds for _, seconds in self.shares(2, where=[(1, "physics")]))

    def parts(self) -> dict[str, float]:
        """What the time goes into, s: the answer, imports, pictures and the data file among what is left."""
        found = dict.fromkeys(("libraries", "own modules", "physics", "pictures", "data file", "rest"), 0.0)
        for (_, kind, name), share in self.notes.items():
            if kind == "import":
                part = "own modules" if name in OURS else "libraries"
            elif kind == "physics":
                part = "physics"
            else:
                part = "pictures" if name in _PICTURES else "data file" if name in _FILES else "rest"
            found[part] += share * self.total
        return found

    def shares(self, *fields: int, where: Sequence[tuple[int, str]] = ()) -> list[tuple[str, float]]:
        """Times by the kept fields (0 call, 1 import, physics or work, 2 library), s, the longest first.

        Only notes whose fields have the values of `where` count.
        """
        found: dict[str, float] = {}
        for key, share in self.notes.items():
            if all(key[field] == value for field, value in where):
                name = " ".join(key[field] for field in fields)
                found[name] = found.get(name, 0.0) + share * self.total
        return sorted(found.items(), key=lambda row: -row[1])


def processor_time(command: Sequence[str], given: str = "") -> float:
    """Processor time of one process and of what it waits for, s; `given` is its standard input."""
    with tempfile.TemporaryFile() as source, tempfile.TemporaryFile() as said:
        source.write(given.encode())
        source.seek(0)
        process = subprocess.Popen(
            command, cwd=ROOT, stdin=source, stdout=subprocess.DEVNULL, stderr=said, env=_settings()
        )
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            said.seek(0)
            message = said.read().decode(errors="replace")
            raise RuntimeError(f"{' '.join(command)} ended with code {process.returncode}\n{message}")
    return usage.ru_utime + usage.ru_stime


def medians(programs: Mapping[str, tuple[Sequence[str], str]], repeats: int) -> dict[str, float]:
    """Median processor time of programs by name, s; they run in turn."""
    found: dict[str, list[float]] = {name: [] for name in programs}
    for _ in range(repeats):
        for name, (command, given) in programs.items():
            found[name].append(processor_time(command, given))
    return {name: statistics.median(times) for name, times in found.items()}


def _settings() -> dict[str, str]:
    """One thread for everybody, our packages from this tree, compiled sources kept as Python usually does."""
    threads = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")
    path = os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH"))))
    kept = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
    return kept | threads | {"PYTHONPATH": path, "MPLBACKEND": "Agg"}


def third_party(modules: Iterable[str]) -> list[str]:
    """Modules of libraries, in the order given: neither Python's own nor ours."""
    own = sys.stdlib_module_names | OURS | {"__main__", "__mp_main__"}
    return [name for name in modules if name.partition(".")[0] not in own]


def cold_start(arguments: Sequence[str], repeats: int = 5) -> ColdStart:
    """Measure one command, the arguments behind `leblanc`; its files go to a folder that is removed."""
    with tempfile.TemporaryDirectory() as scratch:
        writes = arguments[0] in {"run", "map", "runup", "optimise"} and "--out" not in arguments
        whole = [*arguments, *(("--out", scratch) if writes else ())]
        file = Path(scratch) / "watched.json"
        watched = [sys.executable, "-m", "tests.cold_start.child", str(file), *whole]
        processor_time(watched)  # fills the caches of Python and numba
        notes: Counter[tuple[str, str, str]] = Counter()
        for _ in range(repeats):
            processor_time(watched)
            found = json.loads(file.read_text(encoding="utf-8"))
            notes.update({(call, kind, name): count for call, kind, name, count in found["notes"]})
        modules = third_party(found["modules"])
        programs = {
            "total": ([sys.executable, "-c", _ENTRY, *whole], ""),
            "libraries": ([sys.executable, "-c", _IMPORT_ALL], "\n".join(modules)),
        }
        times = medians(programs, repeats)
    counts = Counter(name.partition(".")[0] for name in modules)
    shares = {key: count / notes.total() for key, count in notes.items()}
    return ColdStart(tuple(arguments), **times, modules=dict(counts.most_common()), notes=shares)


def text(found: ColdStart) -> str:
    """Measurement as text."""
    lines = [
        f"leblanc {' '.join(found.arguments)}",
        f"  {found.total:.2f} s in all; importing its libraries alone {found.libraries:.2f} s; "
        f"ratio {found.ratio:.2f}, without the physics {(found.total - found.physics) / found.libraries:.2f}",
        "  modules: " + ", ".join(f"{name} {count}" for name, count in found.modules.items()),
    ]
    for kind in ("import", "physics", "work"):
        rows = found.shares(2, where=[(1, kind)])
        lines.append(f"  {kind} {sum(seconds for _, seconds in rows):.2f} s: {_listed(rows)}")
    for call, seconds in found.shares(0):
        if seconds >= 0.01 * found.total:
            lines.append(f"    {seconds:6.2f} s {call}: {_listed(found.shares(1, 2, where=[(0, call)]))}")
    return "\n".join(lines)


def _listed(rows: Iterable[tuple[str, float]]) -> str:
    return ", ".join(f"{name} {seconds:.2f}" for name, seconds in rows if seconds >= 0.01)


def front_doors(repeats: int) -> dict[str, float]:
    """Processor time of small programs: Python alone, and imports, s."""
    programs = {"python": "pass", "import numpy": "import numpy", f"import {FRONT}": f"import {FRONT}"}
    programs[f"import {FRONT}.cli"] = f"import {FRONT}.cli"
    return medians({name: ([sys.executable, "-c", code], "") for name, code in programs.items()}, repeats)


def main(*command: str, repeats: int = 5, json: Path | None = None) -> Iterator[str]:
    """Measure and print the usual commands or one, and write the numbers to a file as well."""
    doors = front_doors(2 * repeats)
    yield "\n".join(f"{seconds:.3f} s {name}" for name, seconds in doors.items())
    found = []
    for each in [command] if command else COMMANDS:
        found.append(cold_start(each, repeats))
        yield f"\n{text(found[-1])}"
    if json is not None:
        write(json, {"imports": doors, "commands": [_plain(start) for start in found]})


def _plain(found: ColdStart) -> dict[str, Any]:
    """A measurement as it is kept, shares by kind and library."""
    notes: dict[tuple[str, str], float] = {}
    for (_, kind, name), share in found.notes.items():
        notes[kind, name] = notes.get((kind, name), 0.0) + share
    rows = sorted(notes.items(), key=lambda row: -row[1])
    return asdict(found) | {"notes": [[*key, round(share, 4)] for key, share in rows if share >= 5e-4]}


def kept() -> list[ColdStart]:
    """The measurements that are kept with the package, without calls, in the order of the commands."""
    rows = json.loads(KEPT.read_text(encoding="utf-8"))["commands"]
    for row in rows:
        row["arguments"] = tuple(row["arguments"])
        row["notes"] = {("", kind, name): share for kind, name, share in row["notes"]}
    return [ColdStart(**row) for row in rows]


if __name__ == "__main__":
    launch(main)
