"""Solvers by their names in py-pde, its own ones among them: which an equation takes, and with what steps."""

from __future__ import annotations

import math
import warnings
from typing import Any

import numpy as np
from pde.grids.base import GridBase
from pde.solvers.base import SolverBase, registered_solvers
from pde.solvers.scipy import ScipySolver

from meshes.errors import InputError

SAMPLES = 64  # of the loads in a whirl period, where a solver does not add them up
_STEP = 0.05  # times the fastest frequency, of a solver that is not known here
_RELATIVE, _ABSOLUTE = 1e-6, 1e-7  # tolerances of scipy's steps, the second over the size of a field
_FIXED_POINT = 1e-11  # root mean square of what is left of an implicit step, over the smallest field
_ITERATIONS = 1000


def names(equation: Any) -> tuple[str, ...]:
    """Names of the solvers that are registered in py-pde and can solve an equation.

    Those for several processes or for noise are left out, and those whose steps it cannot stand.
    """
    return tuple(
        name
        for name, kind in sorted(registered_solvers().items())
        if name == getattr(kind, "name", None) and not kind.mpi_run and _serves(kind, equation)
    )


def _serves(kind: type[SolverBase], equation: Any) -> bool:
    if equation.steps.get(kind.name, _STEP) == 0.0:  # type: ignore[attr-defined]
        return False
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # a name that is going out of use
            kind(equation)
    except (InputError, RuntimeError):
        return False
    return True


def require_solver(equation: Any, name: str) -> None:
    """Raise `InputError` unless a solver of that name can solve an equation."""
    found = names(equation)
    if name not in found:
        raise InputError("solver", name, "one of " + ", ".join(found))


def is_ours(name: str) -> bool:
    """Whether a solver of this name chooses its steps by itself, as those of this package do."""
    return registered_solvers()[name].__module__.partition(".")[0] != "pde"


def stepping(equation: Any, grid: GridBase, name: str, interval: float) -> dict[str, Any]:
    """What `solve` is given with the name of a solver, for steps that it is stable and right with.

    A whole number of steps fills the interval between stops; nothing for solvers that choose their steps.
    """
    if name == "exponential":
        return {"dt": interval}  # an error relative to a wave that begins with none would be of no use
    if is_ours(name):
        return {}
    kind = registered_solvers()[name]
    if issubclass(kind, ScipySolver):
        cells = int(np.prod(grid.shape))
        return {"method": "RK45", "rtol": _RELATIVE, "atol": _ABSOLUTE * np.repeat(equation.sizes, cells)}
    longest = equation.steps.get(name, _STEP) / equation.fastest(grid)
    found: dict[str, Any] = {"dt": interval / math.ceil(interval / longest)}
    if name in ("implicit", "crank-nicolson"):
        found |= {"maxiter": _ITERATIONS, "maxerror": _FIXED_POINT * min(equation.sizes)}
    return found
