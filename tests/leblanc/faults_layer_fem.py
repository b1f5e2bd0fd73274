"""Seeded faults of a layer's answer by finite elements."""

from __future__ import annotations

from tests.faults import Fault
from tests.leblanc.studies import test_layer_fem as oracle

_MODULE = "leblanc.studies.layer"

FAULTS: tuple[Fault, ...] = (
    Fault(
        _MODULE,
        "whirl.speed**2 * whirl.amplitude",
        "whirl.spin**2 * whirl.amplitude",
        oracle.check_linear_theory,
    ),
    Fault(_MODULE, "moment = -(system", "moment = (system", oracle.check_newton),
    Fault(_MODULE, "/ system.liquid_area\n", "/ system.enclosed_area\n", oracle.check_newton),
    Fault(_MODULE, "(pull * system.enclosed_area)", "(pull * system.liquid_area)", oracle.check_compartments),
    Fault(
        _MODULE,
        "chamber.radius - inner - drawn",
        "chamber.radius - inner + drawn",
        oracle.check_linear_theory,
    ),
    Fault(_MODULE, "0.5 * (total @ FORWARD)", "0.0 * (total @ FORWARD)", oracle.check_newton),
)
