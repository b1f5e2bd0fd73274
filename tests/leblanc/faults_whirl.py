"""Seeded faults of the stability map."""

from __future__ import annotations

from tests.faults import Fault
from tests.leblanc import test_map as oracle

FAULTS: tuple[Fault, ...] = (
    Fault(
        "leblanc.studies.whirl_map",
        "share = parts / parts.sum()",
        "share = parts / parts.max()",
        oracle.check_fills,
    ),
    Fault("leblanc.studies.whirl_map", "np.min(capacity[wet]", "np.max(capacity[wet]", oracle.check_fills),
    Fault("leblanc.studies.whirl_map", "speed > max(needed", "speed > 2.0 * max(needed", oracle.check_range),
    Fault(
        "leblanc.studies.whirl_map",
        "zip(rows, whirl_speed - speed",
        "zip(rows, whirl_speed",
        oracle.check_thin_layers,
    ),
    Fault(
        "leblanc.studies.whirl_map",
        "2.0 * fill.liquid.viscosity",
        "fill.liquid.viscosity",
        oracle.check_thin_layers,
    ),
    Fault(
        "leblanc.figures.stability_map",
        "np.where(inside, distance, -distance)",
        "np.where(inside, -distance, distance)",
        oracle.check_record,
    ),
    Fault(
        "leblanc.figures.stability_map",
        "np.abs(result.speed - end))",
        "np.square(result.speed - end) + 1.0)",
        oracle.check_outline,
    ),
)
