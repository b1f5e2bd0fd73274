"""Seeded faults of the suspended tub of the source."""

from __future__ import annotations

from tests.faults import Fault
from tests.validation import test_tub as oracle

MODULE = "validation.cases.suspended_tub"

FAULTS: tuple[Fault, ...] = (
    Fault(MODULE, "side * math.sin(turn)", "side * math.cos(angle) * math.sin(turn)", oracle.check_direction),
    Fault(MODULE, "math.sin(angle) * flat", "math.sin(angle)", oracle.check_direction),
    Fault(MODULE, ", side * math.sin(turn)", ", math.sin(turn)", oracle.check_static_balance),
    Fault(MODULE, "DAMPER - known.friction", "DAMPER + known.friction", oracle.check_vertical_resonance),
    Fault(MODULE, "SPRING - known.lateral", "SPRING + known.lateral", oracle.check_vertical_resonance),
)
