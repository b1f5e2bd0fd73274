"""Seeded faults of the optimiser: its search, its objectives, its constraints, its closed forms."""

from __future__ import annotations

from tests.faults import Fault
from tests.leblanc import test_optimise as oracle
from tests.solvers import test_fill_search as searching

FAULTS: tuple[Fault, ...] = (
    Fault(
        "leblanc.studies.optimise.closed_form", "ring + 0.5 * fall", "ring + fall", oracle.check_full_volume
    ),
    Fault(
        "leblanc.studies.optimise.closed_form",
        "deflection * (chamber.radius + near)",
        "deflection * chamber.radius",
        oracle.check_full_volume,
    ),
    Fault(
        "leblanc.studies.optimise.closed_form",
        "2.0 * gravity * chamber.height / speed**2",
        "gravity * chamber.height / speed**2",
        oracle.check_full_volume,
    ),
    Fault(
        "leblanc.studies.optimise.closed_form",
        "of_touching / of_most",
        "of_most / of_touching",
        oracle.check_full_volume,
    ),
    Fault(
        "leblanc.studies.optimise.closed_form",
        "np.divide(-state.nearest_depth",
        "np.divide(1.0 - state.nearest_depth",
        oracle.check_optimal_volume,
    ),
    Fault(
        "leblanc.studies.optimise.closed_form",
        "Judgement(-state.unbalance()[0] / most",
        "Judgement(state.unbalance()[0] / most",
        oracle.check_largest_unbalance,
    ),
    Fault(
        "leblanc.studies.optimise.objectives",
        "weights / weights.sum()",
        "weights / weights.size",
        oracle.check_mean,
    ),
    Fault(
        "leblanc.studies.optimise.objectives",
        "np.repeat(volumes, count, axis=0)",
        "np.tile(volumes, (count, 1))",
        oracle.check_mean_of_several,
    ),
    Fault(
        "leblanc.studies.optimise.conditions",
        "liquid=liquid_at(chamber.liquid, one.temperature)",
        "liquid=chamber.liquid",
        oracle.check_robust,
    ),
    Fault(
        "leblanc.studies.optimise.conditions",
        "self.quantile, axis=0",
        "1.0 - self.quantile, axis=0",
        oracle.check_robust,
    ),
    Fault(
        "leblanc.studies.optimise.conditions",
        "low + (high - low) * share[:, 0]",
        "low + (high + low) * share[:, 0]",
        oracle.check_robust,
    ),
    Fault(
        "leblanc.studies.optimise.constraints",
        "growth_map(system, rows, speed, friction)[0].max(axis=1)",
        "growth_map(system, rows, speed, friction)[0].min(axis=1)",
        oracle.check_growth,
    ),
    Fault(
        "leblanc.studies.optimise.constraints",
        "(value - self.limit) / self.scale",
        "(self.limit - value) / self.scale",
        oracle.check_excess,
    ),
    Fault(
        "leblanc.studies.optimise.constraints",
        '"1/s", -margin, scale',
        '"1/s", margin, scale',
        oracle.check_excess,
    ),
    Fault(
        "leblanc.studies.optimise.front",
        "~np.all(values[later] >= values[k], axis=1)",
        "~np.any(values[later] >= values[k], axis=1)",
        oracle.check_front,
    ),
    Fault(
        "solvers.search",
        "(judged.objective, cost, judged.excess)",
        "(judged.objective, judged.excess, cost)",
        searching.check_order,
    ),
    Fault(
        "solvers.search",
        "np.maximum(judged.excess, 0.0)",
        "np.maximum(-judged.excess, 0.0)",
        searching.check_infeasible,
    ),
    Fault(
        "solvers.search",
        "holds = (said.objective <= limit)",
        "holds = (said.objective >= limit)",
        searching.check_plateau,
    ),
    Fault(
        "solvers.search",
        "moved / cost[i], -moved / cost[j]",
        "moved / cost[i], moved / cost[j]",
        searching.check_valley,
    ),
    Fault("solvers.search", "low + t[:, None] * one", "low + t[:, None] + 0.0 * one", searching.check_edge),
)
