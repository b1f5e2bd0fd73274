"""Faults in the problems that other codes are given, and in the errors against their answers."""

from __future__ import annotations

from tests.faults import Fault
from tests.validation.test_benchmarks import (
    check_distance,
    check_equation_of_py_pde,
    check_errors_fall,
    check_force,
    check_layer_problem,
)

_PROBLEMS, _LAYERS = "validation.benchmarks.problems", "validation.benchmarks.layers"
_OURS, _PYPDE = "validation.benchmarks.ours", "validation.benchmarks.peer_pypde"

FAULTS: tuple[Fault, ...] = (
    Fault(_PROBLEMS, "np.exp(-1j * first *", "np.exp(1j * first *", check_distance),
    Fault(_OURS, "done, problem.c.linear_speed", "done, -problem.c.linear_speed", check_errors_fall),
    Fault(_LAYERS, "grown * cmath.exp(1j *", "grown * cmath.exp(-1j *", check_force),
    Fault(_LAYERS, "/ (2.0 * math.pi)\n        size", "/ math.pi\n        size", check_force),
    Fault(_LAYERS, "np.power(1.0 - 2.0 * area, 1.5)", "np.power(1.0 - 2.0 * area, 0.5)", check_layer_problem),
    Fault(_LAYERS, "+ turns * sums[-1]", "", check_layer_problem),
    Fault(_PYPDE, '"c": problem.drift', '"c": -problem.drift - 1.0', check_equation_of_py_pde),
)
