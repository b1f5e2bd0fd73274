"""One response from several, each with its own liquid model at its own speeds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fluid.fill import Fill
from meshes.arrays import Index
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import RotorSystem
from solvers.synchronous.coupled import CoupledResponse, coupled_response
from solvers.synchronous.planar import Response, synchronous_response

Names = NDArray[np.str_]


def mixed_response(
    rotor: Jeffcott, fills: Sequence[Fill], speed: ArrayLike, gravity: float, models: Names
) -> Response:
    """`synchronous_response` with one liquid model for each speed.

    Parameters
    ----------
    rotor, fills, speed, gravity : as there
    models : names, shape (n,)
    """
    spin = np.asarray(speed, dtype=float)
    found: Response = _together(
        models, lambda name, at: synchronous_response(rotor, fills, spin[at], gravity, name)
    )
    return found


def mixed_coupled(
    system: RotorSystem, fills: Sequence[Fill], speed: ArrayLike, gravity: float, models: Names
) -> CoupledResponse:
    """`coupled_response` with one liquid model for each speed.

    Parameters
    ----------
    system, fills, speed, gravity : as there
    models : names, shape (n,)
    """
    spin = np.asarray(speed, dtype=float)
    found: CoupledResponse = _together(
        models, lambda name, at: coupled_response(system, fills, spin[at], gravity, name)
    )
    return found


def _together(models: Names, solve: Callable[[str, Index], Any]) -> Any:
    """Answers of all models, each at its speeds, in the order of the speeds."""
    names = list(dict.fromkeys(models.tolist()))
    parts = [(at, solve(name, at)) for name in names for at in [np.flatnonzero(models == name)]]
    return parts[0][1] if len(parts) == 1 else _merged(parts)


def _merged(parts: list[tuple[Index, Any]]) -> Any:
    """A dataclass of arrays over speed; what is no array is alike in all parts."""
    first = parts[0][1]
    order = np.argsort(np.concatenate([at for at, _ in parts]))
    found: dict[str, Any] = {}
    for field in fields(first):
        values = [getattr(part, field.name) for _, part in parts]
        if isinstance(values[0], Response):
            found[field.name] = _merged([(at, one) for (at, _), one in zip(parts, values, strict=True)])
        elif isinstance(values[0], np.ndarray):
            wide = _padded(values) if field.name.startswith("branch_") else values
            found[field.name] = np.concatenate(wide)[order]
        else:
            found[field.name] = values[0]
    return type(first)(**found)


def _padded(tables: list[NDArray[Any]]) -> list[NDArray[Any]]:
    """The same number of branches in each, nan or False where there is none."""
    most = max(table.shape[1] for table in tables)
    wide = []
    for table in tables:
        missing: Any = False if table.dtype == bool else complex(np.nan, np.nan)
        out = np.full((table.shape[0], most), missing, dtype=table.dtype)
        out[:, : table.shape[1]] = table
        wide.append(out)
    return wide
