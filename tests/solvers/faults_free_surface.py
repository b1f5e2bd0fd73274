"""Faults of the finite-element free surface."""

from __future__ import annotations

from tests.faults import Fault
from tests.solvers.statics.test_free_surface import check_crescent, check_optimal_volumes, check_state
from tests.solvers.statics.test_free_surface_limits import check_clear_surface, check_flat_surface
from tests.solvers.statics.test_free_surface_sections import check_turned

MODULE = "solvers.statics.free_surface"

FAULTS: tuple[Fault, ...] = (
    Fault(MODULE, "lid = floor + plan.ramp", "lid = floor + 2.0 * plan.ramp", check_optimal_volumes),
    Fault(
        MODULE, "(x * x + y * y - floor) / plan.ramp", "(x * x - floor) / plan.ramp", check_optimal_volumes
    ),
    Fault(MODULE, "where=~cut)", "where=cut)", check_optimal_volumes),
    Fault(MODULE, "cut |= (plan.least", "cut &= (plan.least", check_optimal_volumes),
    Fault(MODULE, 'w["x"][0] - plan.axis[0]', 'w["x"][0] + plan.axis[0]', check_clear_surface),
    Fault(MODULE, "-height * (floor / plan.ramp)", "height * (floor / plan.ramp)", check_clear_surface),
    Fault(MODULE, "height * (below / plan.ramp)", "height * (floor / plan.ramp)", check_clear_surface),
    Fault(MODULE, "plan.ramp * (wetted_height / height)", "plan.ramp * wetted_height", check_flat_surface),
    Fault(MODULE, "0.5 * depth * depth", "depth * depth", check_flat_surface),
    Fault(MODULE, "depth * depth * depth / 3.0", "depth * depth * depth / 2.0", check_flat_surface),
    Fault(MODULE, "x * middle, y * middle", "y * middle, x * middle", check_state),
    Fault(MODULE, "x * x * depth, y * y * depth", "y * y * depth, x * x * depth", check_state),
    Fault(MODULE, "third, x * y * depth", "third, x * x * depth", check_turned),
    Fault(MODULE, "math.sqrt(max(floor, 0.0))", "math.sqrt(max(below, 0.0))", check_clear_surface),
    Fault(MODULE, "plan.farthest - dry_radius**2", "plan.farthest - dry_radius", check_crescent),
    Fault(MODULE, "rise = 4.0 * beta * radius", "rise = 2.0 * beta * radius", check_optimal_volumes),
    Fault(
        MODULE,
        "(20.0 * 1e-7 * layer / radius) ** 0.25",
        "(20.0 * 1e-7 * layer / radius) ** 0.2",
        check_optimal_volumes,
    ),
)
