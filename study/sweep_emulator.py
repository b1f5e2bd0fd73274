"""Emulators of what a sweep found."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from meshes.border import InputError
from study.emulator import Emulator, emulate
from study.sweep_outputs import DONE, SINGLE
from study.sweep_store import Store, read_store

EMULATED = tuple(one.name for one in SINGLE)


def emulate_store(store: Store | Path, output: str, seed: int = 0) -> Emulator:
    """Emulator of an output that is one number a sample, over the varied fields [theory: emulator].

    Parameters
    ----------
    store : of a sweep, or its folder; samples that are not done are left out
    output : one of `EMULATED`
    seed : of the choice of samples and of the folds

    Raises
    ------
    InputError : no such store or output, a field of words, too few samples

    Examples
    --------
    >>> emulate_store(Path("nowhere"), "peak_amplitude")
    Traceback (most recent call last):
    ...
    meshes.border.InputError: store = 'nowhere': must be the store of a sweep
    """
    if output not in EMULATED:
        raise InputError("output", output, "one of " + ", ".join(EMULATED))
    found = read_store(store) if isinstance(store, Path) else store
    fields = varied_fields(found)
    columns = [found.read(name) for name in fields]
    for name, column in zip(fields, columns, strict=True):
        if column.dtype.kind != "f":
            raise InputError(name, "words", "a number; an emulator has no measure for words")
    values = np.where(found.read("status") == DONE, found.read(output), np.nan)
    return emulate(fields, np.stack(columns, axis=1), values, seed)


def emulated_outputs(store: Store, seed: int = 0) -> dict[str, Emulator | str]:
    """An emulator of every output that is one number a sample, or in words why there is none.

    Parameters
    ----------
    store, seed : as for `emulate_store`
    """
    found: dict[str, Emulator | str] = {}
    for output in EMULATED:
        try:
            found[output] = emulate_store(store, output, seed)
        except InputError as error:
            found[output] = f"{error.field} must be {error.allowed}"
    return found


def varied_fields(store: Store) -> tuple[str, ...]:
    """Paths of the varied fields, in the order of the study."""
    lines = str(store.attributes()["vary"]).splitlines()
    return tuple(line.partition(": ")[0] for line in lines)
