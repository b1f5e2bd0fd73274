"""The waves as py-pde equations, and their steppers as py-pde solvers; its trackers and storages serve both.

`AnnularLongWavePDE` is the nonlinear layer, `KdvBurgersPDE` the waves of one family, whose field is the
liquid area above its mean; both live on a `circle`. Importing an equation registers its solver,
"finite_volume" or "exponential", and takes py-pde's seconds: the names below are fetched when they are used.

    equation = AnnularLongWavePDE(fill, whirl, friction=friction, dispersion=True)
    state = equation.solve(equation.start(circle(256)), 3.0, solver="finite_volume")
    equation.force(state, 3.0), equation.offset(state)

    equation = KdvBurgersPDE(family, damping=0.1, forcing=q, whirl_speed=s)
    equation.solve(ScalarField(circle(256)), 3.0, solver="exponential")
"""

from __future__ import annotations

import importlib
import logging
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from solvers.pypde.coupled import CoupledSolver, RotorLayersPDE, TurnTracker, run
    from solvers.pypde.grid import circle
    from solvers.pypde.long_wave import AnnularLongWavePDE, FiniteVolumeSolver
    from solvers.pypde.one_family import ExponentialSolver, KdvBurgersPDE, SplitPDE
    from solvers.pypde.periodic import PeriodicNewtonSolver, PeriodicOrbit
    from solvers.pypde.steady_newton import SteadyNewtonSolver

__all__ = [
    "AnnularLongWavePDE",
    "CoupledSolver",
    "ExponentialSolver",
    "FiniteVolumeSolver",
    "KdvBurgersPDE",
    "PeriodicNewtonSolver",
    "PeriodicOrbit",
    "RotorLayersPDE",
    "SplitPDE",
    "SteadyNewtonSolver",
    "TurnTracker",
    "circle",
    "run",
]
# It would warn users of the time that compiling takes within a tracker.
logging.getLogger("pde.solvers.controller").setLevel(logging.ERROR)

_HOMES = {
    "AnnularLongWavePDE": "long_wave",
    "FiniteVolumeSolver": "long_wave",
    "PeriodicNewtonSolver": "periodic",
    "PeriodicOrbit": "periodic",
    "SteadyNewtonSolver": "steady_newton",
    "circle": "grid",
} | dict.fromkeys(("CoupledSolver", "RotorLayersPDE", "TurnTracker", "run"), "coupled")


def __getattr__(name: str) -> Any:
    """Fetch a name when it is used."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    home = importlib.import_module(f"{__name__}.{_HOMES.get(name, 'one_family')}")
    return getattr(home, name)
