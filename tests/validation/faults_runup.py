"""Seeded faults of the studies of run-ups."""

from __future__ import annotations

from tests.faults import Fault
from tests.validation import test_runup as oracle

FAULTS: tuple[Fault, ...] = (
    Fault(
        "validation.cases.runup",
        "optimal_volume(CHAMBER, deflection, RAMP.stop, _GRAVITY)",
        "optimal_volume(CHAMBER, deflection, RAMP.start, _GRAVITY)",
        oracle.check_best_volume,
    ),
    Fault(
        "validation.cases.runup",
        "fills, [RAMP.stop], _GRAVITY",
        "fills[:0], [RAMP.stop], _GRAVITY",
        oracle.check_steady_end,
    ),
    Fault(
        "validation.figures.runup_lag",
        "np.exp(-1j * exact_angle) / turn_mean(h.liquid_position",
        "np.exp(1j * exact_angle) / turn_mean(h.liquid_position",
        oracle.check_lag,
    ),
    Fault(
        "validation.figures.runup_lag",
        "h.deflection[:, 0] * np.exp(-1j * h.angle)",
        "h.deflection[:, 0] * np.exp(1j * h.angle)",
        oracle.check_lag,
    ),
    Fault(
        "validation.figures.runup_lag",
        "answer.deflection, -answer.liquid_angle",
        "answer.deflection_dry, -answer.liquid_angle",
        oracle.check_steady_response,
    ),
    Fault(
        "validation.figures.runup_lag",
        "/ math.log(one.rate / other.rate)",
        "/ math.log(other.rate / one.rate)",
        oracle.check_orders,
    ),
)
