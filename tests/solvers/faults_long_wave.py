"""Seeded faults of the long-wave equations and their finite volumes.

The compiled solver keeps its code while a fault is seeded: its own lines are the business of
`uncompiled_faults.py`. Here are the equations, which it compiles as they stand.
"""

from __future__ import annotations

from tests.faults import Fault
from tests.fluid import test_long_wave as oracle

MODULE = "fluid.long_wave"

FAULTS: tuple[Fault, ...] = (
    Fault(MODULE, "-0.5 * np.log1p", "-np.log1p", oracle.check_speeds),
    Fault(MODULE, "turning + carried, np.sqrt", "turning - carried, np.sqrt", oracle.check_speeds),
    Fault(MODULE, "log * whole * whole", "log * spin * spin", oracle.check_speeds),
    Fault(
        MODULE, "- surface * pull\n\n\ndef surface", "+ surface * pull\n\n\ndef surface", oracle.check_circles
    ),
    Fault(MODULE, "(square - 2.0 * head)", "(square - head)", oracle.check_circles),
    Fault(MODULE, "return velocity * log\n", "return velocity * log * 1.01\n", oracle.check_forms),
    Fault(
        MODULE, "(log + area / (surface * surface))", "(log - area / (surface * surface))", oracle.check_forms
    ),
    Fault(MODULE, "/ 3.0 - surface * area", "/ 3.0 + surface * area", oracle.check_forms),
    Fault(
        MODULE, "2.0 * spin * log * velocity - surface", "spin * log * velocity - surface", oracle.check_forms
    ),
    Fault("fluid.friction", "(1.0 + lid * depth)", "(1.0 + lid)", oracle.check_friction_rates),
    Fault("fluid.friction", "np.abs(velocity) / area", "velocity / area", oracle.check_friction_rates),
    Fault(
        "fluid.friction",
        "0.5 * np.asarray(viscosity",
        "2.0 * np.asarray(viscosity",
        oracle.check_friction_rates,
    ),
)
