"""The grid that the waves live on, and what their py-pde equations share."""

from __future__ import annotations

import math
import warnings
from typing import Any

from pde.backends.base import BackendBase
from pde.grids.cartesian import CartesianGrid
from pde.pdes.base import PDEBase

from meshes.errors import InputError


def circle(points: int) -> CartesianGrid:
    """Periodic grid of the waves: at least 8 even cells all round the drum, theta at their centres.

    An even number with small factors is fastest.
    """
    if points < 8:
        raise InputError("points", points, "8 or more")
    return CartesianGrid([(0.0, 2.0 * math.pi)], points, periodic=True)


class CirclePDE(PDEBase):  # type: ignore[no-untyped-call]
    """A py-pde equation of waves round the drum: on numpy's backend, and an interrupt ends its runs."""

    def solve(
        self,
        state: Any,
        t_range: Any,
        dt: float | None = None,
        tracker: Any = "auto",
        **options: Any,
    ) -> Any:
        """Solve as py-pde does, but let a Ctrl-C through, of which py-pde makes an early end."""
        with warnings.catch_warnings():
            warnings.filterwarnings(
                "ignore", "`ExplicitSolver` is deprecated"
            )  # a name of py-pde's for Euler's
            final = super().solve(state, t_range, dt, tracker, **options)
        ended = self.diagnostics["controller"]
        if not ended["successful"] and ended["stop_reason"] == _BROKEN_OFF:
            raise KeyboardInterrupt
        return final

    def determine_backend(
        self, state: Any, backend: str | BackendBase[Any] = "auto", *, use_mpi: bool = False
    ) -> BackendBase[Any]:
        """The backend for a solver: numpy unless another is asked for, so that nothing is compiled."""
        return super().determine_backend(state, "numpy" if backend == "auto" else backend, use_mpi=use_mpi)


_BROKEN_OFF = "User interrupted simulation"  # what py-pde's controller says
