"""Seeded faults of the whirl's dimensionless numbers."""

from __future__ import annotations

from tests.faults import Fault
from tests.fluid import test_whirl_numbers as oracle

MODULE = "fluid.numbers"

FAULTS: tuple[Fault, ...] = (
    Fault(MODULE, "whirl_speed - spin", "whirl_speed + spin", oracle.check_numbers),
    Fault(MODULE, "2.0 * viscosity", "viscosity", oracle.check_numbers),
    Fault(MODULE, "abs(pair[0] - pair[1])", "abs(pair[0] + pair[1])", oracle.check_numbers),
    Fault(MODULE, "spin**2 * surface / gravity", "spin**2 * radius / gravity", oracle.check_numbers),
    Fault(
        MODULE,
        "spin * radius**2 / viscosity if viscosity else",
        "spin * depth**2 / viscosity if viscosity else",
        oracle.check_numbers,
    ),
)
