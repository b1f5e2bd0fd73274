"""Seeded faults of the layer with friction."""

from __future__ import annotations

from tests.faults import Fault
from tests.fluid import test_whirl as oracle

MODULE = "fluid.whirl"

FAULTS: tuple[Fault, ...] = (
    Fault(MODULE, "- 2.0 * t * omega - 1j", "+ 2.0 * t * omega - 1j", oracle.check_offset),
    Fault(MODULE, "- 1j * np.asarray(rate)) - t", "+ 1j * np.asarray(rate)) - t", oracle.check_offset),
    Fault(
        MODULE, "np.asarray(rate)) - t * np.square", "np.asarray(rate)) + t * np.square", oracle.check_offset
    ),
    Fault(MODULE, "share = 0.5 * (1.0 - np", "share = 0.5 * (1.0 + np", oracle.check_offset),
    Fault(MODULE, "-share * np.square(omega)", "share * np.square(omega)", oracle.check_offset),
    Fault(MODULE, "filled = 2.0 * t / (1.0 + t)", "filled = t / (1.0 + t)", oracle.check_frictionless),
    Fault(MODULE, "filled * (1.0 + offset_with", "filled * (1.0 - offset_with", oracle.check_frictionless),
    Fault(MODULE, "t * omega + 0.5j", "t * omega + 1.0j", oracle.check_free_waves),
    Fault(
        MODULE,
        "np.square(centre) + t * np.square(omega)",
        "np.square(centre) - t * np.square(omega)",
        oracle.check_free_waves,
    ),
    Fault(MODULE, "np.sqrt(1j * np.asarray(slip", "np.sqrt(-1j * np.asarray(slip", oracle.check_wall_layer),
    Fault(MODULE, "0.5 * film, 2.0 * radius", "1.0 * film, 2.0 * radius", oracle.check_laws),
    Fault(
        MODULE, "2.0 * radius / fill.chamber.height", "1.0 * radius / fill.chamber.height", oracle.check_laws
    ),
    Fault(MODULE, "math.sqrt(fill.liquid.viscosity)", "fill.liquid.viscosity", oracle.check_laws),
    Fault(MODULE, "film / (2.0 - film)", "film / (2.0 + film)", oracle.check_laws),
    Fault(
        MODULE, "total + own * (1.0 + offset", "total + own * (1.0 - offset", oracle.check_neutral_stiffness
    ),
    Fault(MODULE, "np.square(r) * total", "r * total", oracle.check_neutral_stiffness),
    Fault(MODULE, "min(outer, inner)", "max(outer, inner)", oracle.check_covering_speed),
    Fault(
        MODULE,
        "gravity * chamber.height / min",
        "2.0 * gravity * chamber.height / min",
        oracle.check_covering_speed,
    ),
)
