"""Commands ended by signals at random moments, and on a full disk: what they leave behind.

`python -m tests.extremes.endings --trials 10` prints a table; POSIX only.
"""

from __future__ import annotations

import json
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from leblanc.core.netcdf import read_values
from validation.study import launch

_EXAMPLES = Path(__file__).parents[2] / "examples"
_RIG = _EXAMPLES / "vertical_rig.toml"
_STUDY = """
scene = "scene.toml"
method = "sobol"
samples = 512
seed = 11

[vary]
"rotor.mass" = { uniform = ["3 kg", "12 kg"] }
"""
# Of each command, with everything that it writes in the folder `out`.
COMMANDS: dict[str, tuple[str, ...]] = {
    "run": ("run", str(_RIG), "--out", "out"),
    "runup": (
        *("runup", str(_EXAMPLES / "runup.toml"), "--cells", "32", "--samples", "200", "--out", "out"),
    ),
    "optimise": ("optimise", str(_RIG), "--out", "out"),
    "map": ("map", str(_RIG), "--volumes", "41", "--speeds", "101", "--out", "out"),
    "sweep": ("sweep", "study.toml", "--workers", "0", "--netcdf", "--out", "out"),
    "sweep, 2 workers": ("sweep", "study.toml", "--workers", "2", "--out", "out"),
    "view": ("view", str(_RIG), "--screenshot", "out/view.png"),
}
SIGNALS = {"kill -9": signal.SIGKILL, "SIGINT": signal.SIGINT, "SIGTERM": signal.SIGTERM}
_PROMISED = {signal.SIGKILL: -signal.SIGKILL, signal.SIGINT: 130, signal.SIGTERM: 143}
_DEADLINE = 600.0  # s
_BEGINNING = 0.5  # s, in which Python starts: nothing of this package hears a signal yet


@dataclass(frozen=True)
class Ending:
    """How a command ended."""

    code: int  #: of its process
    said: str  #: on stderr
    waited: float  #: from the signal to the end, s


def start(command: str, folder: Path, most: int | None = None) -> subprocess.Popen[str]:
    """Command in a session of its own; `most`: bytes of a file at most, as on a full disk."""
    (folder / "out").mkdir(exist_ok=True)
    scene = re.sub("(?m)^count = .*$", "count = 3", _RIG.read_text(encoding="utf-8"))
    (folder / "scene.toml").write_text(scene, encoding="utf-8")
    (folder / "study.toml").write_text(_STUDY, encoding="utf-8")

    def limit() -> None:
        # A shell has what runs in the background ignore interrupts, and children inherit that.
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        if most is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))

    return subprocess.Popen(
        [sys.executable, "-m", "leblanc", *COMMANDS[command]],
        cwd=folder,
        env=os.environ | {"PYTHONPATH": str(_EXAMPLES.parent), "MPLBACKEND": "Agg"},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        preexec_fn=limit,
    )


def ended(command: str, folder: Path, after: float, number: int) -> Ending:
    """A command that gets a signal after some time, with all the processes that it has started."""
    process = start(command, folder)
    begin = time.monotonic()
    try:
        process.wait(after)
    except subprocess.TimeoutExpired:
        begin = time.monotonic()
        os.killpg(process.pid, number)
    _, said = process.communicate(timeout=_DEADLINE)
    return Ending(process.returncode, said, time.monotonic() - begin)


def broken(folder: Path) -> list[str]:
    """Files under their final names that are not whole, and with what is wrong with them."""
    return [f"{path.name}: {wrong}" for path in _files(folder) if not _part(path) and (wrong := _wrong(path))]


def parts(folder: Path) -> list[str]:
    """Files that are not under their final names."""
    return [path.name for path in _files(folder) if _part(path)]


def _files(folder: Path) -> Iterator[Path]:
    """All files that are no part of a store, which is judged by itself."""
    return (path for path in sorted(folder.rglob("*")) if path.is_file() and "sweep.zarr" not in str(path))


def _part(path: Path) -> bool:
    return ".part" in path.name


def _wrong(path: Path) -> str:
    """Why a file cannot be read to its end, or nothing."""
    try:
        _read(path)
    except Exception as error:  # whatever a library makes of half a file
        return f"{type(error).__name__}: {error}"
    return ""


def _read(path: Path) -> Any:
    """Read a file to its end."""
    if path.suffix in (".png", ".gif"):
        from PIL import Image, ImageSequence

        with Image.open(path) as image:
            return [frame.load() for frame in ImageSequence.Iterator(image)]
    if path.suffix == ".nc":
        return read_values(path)
    if path.suffix == ".svg":
        return ElementTree.parse(path)
    if path.suffix == ".html" and not path.read_text(encoding="utf-8").rstrip().endswith("</html>"):
        raise ValueError("no end")
    return path.read_bytes()


def store_of(folder: Path) -> dict[str, bytes]:
    """Every file of a sweep's store."""
    store = folder / "out" / "sweep.zarr"
    return {str(path.relative_to(store)): path.read_bytes() for path in store.rglob("*") if path.is_file()}


def faults(command: str, folder: Path, ending: Ending, number: int, whole: dict[str, bytes]) -> list[str]:
    """What is not as promised after a signal; `whole` is the store of a sweep that nothing happened to."""
    found = broken(folder)
    # Ended by the signal itself as Python takes itself down, which shells call 128 and its number as well.
    if ending.code not in (_PROMISED[signal.Signals(number)], -number, 0):
        found.append(f"exit code {ending.code}")
    if "Traceback" in ending.said or len(ending.said.splitlines()) > 3:
        found.append(f"said {ending.said[-300:]!r}")
    if number != signal.SIGKILL and parts(folder):
        found.append(f"left {parts(folder)}")
    if number != signal.SIGKILL and ending.waited > 2.0 and ending.code != 0:
        found.append(f"took {ending.waited:.1f} s")
    if command.startswith("sweep"):
        again = start(command, folder)
        _, said = again.communicate(timeout=_DEADLINE)
        if again.returncode != 0:
            found.append(f"did not go on: {said[-300:]!r}")
        elif store_of(folder) != whole:
            found.append("the store came out another one")
    return found


def by_signal(command: str, name: str, trials: int, seed: int) -> tuple[Counter[str], list[str]]:
    """Ends of a command by a signal at random moments, and what was not as promised.

    The moments lie evenly over the time that the command takes.
    """
    rng, counts, found = np.random.default_rng(seed), Counter[str](), list[str]()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch) / "whole"
        folder.mkdir()
        begin = time.monotonic()
        _, said = start(command, folder).communicate(timeout=_DEADLINE)
        lasted, whole = time.monotonic() - begin, store_of(folder)
        if broken(folder):
            found.append(f"undisturbed: {broken(folder)}, {said}")
        for trial in range(trials):
            folder = Path(scratch) / str(trial)
            folder.mkdir()
            after = float(rng.uniform(_BEGINNING, lasted))
            ending = ended(command, folder, after, SIGNALS[name])
            wrong = faults(command, folder, ending, SIGNALS[name], whole)
            counts["done before" if ending.code == 0 else "ended"] += 1
            counts["at fault"] += bool(wrong)
            found += [f"{command}, {name}, {after:.2f} of {lasted:.2f} s: {fault}" for fault in wrong]
            shutil.rmtree(folder)
    return counts, found


@contextmanager
def small_disk(folder: Path, size: int) -> Iterator[None]:
    """Folder that is a disk in memory of so many bytes; takes the rights to mount one."""
    done = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(folder)], capture_output=True, text=True
    )
    if done.returncode:
        raise OSError(done.stderr.strip())
    try:
        yield
    finally:
        subprocess.run(["umount", str(folder)], check=True)


def on_a_full_disk(
    command: str, trials: int, seed: int, mounted: bool = False
) -> tuple[Counter[str], list[str]]:
    """Ends of a command where the disk is full, and what was not as promised.

    Mounted: on a small disk in memory; else no file may be longer than that. The seed says how long.
    """
    rng, counts, found = np.random.default_rng(seed), Counter[str](), list[str]()
    for _ in range(trials):
        most = int(10.0 ** rng.uniform(2.0, 5.5))
        with tempfile.TemporaryDirectory() as scratch, ExitStack() as stack:
            folder = Path(scratch)
            if mounted:
                (folder / "out").mkdir()
                stack.enter_context(small_disk(folder / "out", most))
            process = start(command, folder, None if mounted else most)
            _, said = process.communicate(timeout=_DEADLINE)
            wrong = broken(folder)
            if process.returncode not in (0, 2):
                wrong.append(f"exit code {process.returncode}")
            if "Traceback" in said or (process.returncode == 2 and len(said.splitlines()) > 2):
                wrong.append(f"said {said[-300:]!r}")
            if parts(folder):
                wrong.append(f"left {parts(folder)}")
        counts["done" if process.returncode == 0 else "ended"] += 1
        counts["at fault"] += bool(wrong)
        where = "a disk of" if mounted else "files up to"
        found += [f"{command}, {where} {most} bytes: {fault}" for fault in wrong]
    return counts, found


def main(
    trials: int = 5, seed: int = 1, commands: tuple[str, ...] = tuple(COMMANDS), mount: bool = False
) -> Iterator[str]:
    """Table of so many trials of each command and each way to end; exit code 1 if one was not as promised.

    Mount: full disks are mounted in memory, as root.
    """
    every: list[str] = []
    for command in commands:
        for name in SIGNALS:
            counts, found = by_signal(command, name, trials, seed)
            yield f"{command:18}{name:12}{json.dumps(counts)}"
            every += found
        counts, found = on_a_full_disk(command, trials, seed, mount)
        yield f"{command:18}{'full disk':12}{json.dumps(counts)}"
        every += found
    yield from every
    if every:
        raise SystemExit(1)


if __name__ == "__main__":
    launch(main)
