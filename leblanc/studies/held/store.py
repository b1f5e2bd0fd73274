"""Held states on disk: a run that was broken off goes on where it stopped."""

from __future__ import annotations

import hashlib
import zipfile
from collections.abc import Iterator, Sequence
from dataclasses import fields, is_dataclass
from enum import Enum
from pathlib import Path
from typing import Any

import numpy as np

import fluid
from leblanc.core.answer import versions
from leblanc.core.files import writing
from solvers.held.branch import HeldTask, Runner
from solvers.held.state import HeldKind, HeldMachine, HeldState, HoldNumerics, Moment

FOLDER = "held"
_ROOMS = (
    "fluid",
    "solvers/rotor",
    "solvers/layer",
    "solvers/runup",
    "solvers/pypde",
    "solvers/potential",
    "solvers/held",
)


def kept(
    run: Runner, folder: Path, machine: HeldMachine, numerics: HoldNumerics, fresh: bool = False
) -> Runner:
    """A runner that looks for each state in a folder first, and leaves there what it finds."""
    folder.mkdir(parents=True, exist_ok=True)
    whole = _code()
    _feed(whole, (machine, numerics, versions()))

    def again(tasks: Sequence[HeldTask]) -> Iterator[tuple[int, HeldState]]:
        paths, missing = [], []
        for k, task in enumerate(tasks):
            own = whole.copy()
            _feed(own, task)
            paths.append(folder / f"{own.hexdigest()[:32]}.npz")
            known = None if fresh else _read(paths[-1])
            if known is None:
                missing.append(k)
            else:
                yield k, known
        for k, state in run([tasks[k] for k in missing]):
            _write(state, paths[missing[k]])
            yield missing[k], state

    return again


def _code() -> Any:
    """Digest of what holds states: another code may hold others."""
    digest, root = hashlib.sha256(), Path(fluid.__file__).parent.parent
    for room in _ROOMS:
        for path in sorted((root / room).glob("*.py")):
            digest.update(path.read_bytes())
    return digest


def _feed(digest: Any, value: Any) -> None:
    """Add a value to a digest by its content."""
    digest.update(type(value).__name__.encode())
    if isinstance(value, np.ndarray):
        digest.update(repr((value.shape, value.dtype.str)).encode())
        digest.update(np.ascontiguousarray(value).tobytes())
    elif isinstance(value, Enum):
        digest.update(repr(value.value).encode())
    elif is_dataclass(value):
        for each in fields(value):
            digest.update(each.name.encode())
            _feed(digest, getattr(value, each.name))
    elif isinstance(value, dict):
        _feed(digest, tuple(value.items()))
    elif isinstance(value, (tuple, list)):
        digest.update(str(len(value)).encode())
        for item in value:
            _feed(digest, item)
    else:
        digest.update(repr(value).encode())


def _write(state: HeldState, path: Path) -> None:
    values = {each.name: getattr(state, each.name) for each in fields(state) if each.name != "moment"}
    values["kind"] = str(state.kind)
    moment = {f"moment_{each.name}": getattr(state.moment, each.name) for each in fields(state.moment)}
    with writing(path) as part, part.open("wb") as file:
        np.savez(file, **(values | moment))


def _read(path: Path) -> HeldState | None:
    """The state in a file; None where there is none, or none that is whole."""
    try:
        with np.load(path, allow_pickle=False) as found:
            values = {name: found[name] for name in found.files}
        plain = {name: value.item() if value.ndim == 0 else value for name, value in values.items()}
        moment = Moment(**{each.name: plain.pop(f"moment_{each.name}") for each in fields(Moment)})
        plain["kind"] = HeldKind(plain["kind"])
        return HeldState(**plain, moment=moment)
    except (OSError, ValueError, KeyError, TypeError, EOFError, zipfile.BadZipFile):
        return None
