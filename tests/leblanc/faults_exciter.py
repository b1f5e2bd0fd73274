"""Seeded faults of an exciter's answer."""

from __future__ import annotations

from tests.faults import Fault
from tests.leblanc.studies import test_exciter as oracle

_STUDY = "leblanc.studies.exciter"

FAULTS: tuple[Fault, ...] = (
    Fault(
        _STUDY,
        "np.abs(np.array(motions)).T * machine.length",
        "np.abs(np.array(motions)).T",
        oracle.check_units,
    ),
    Fault(
        _STUDY, "platform_motion(numbers, n, q) for", "platform_motion(numbers, q, n) for", oracle.check_units
    ),
    Fault(_STUDY, "stuck=stuck * unit", "stuck=stuck", oracle.check_units),
    Fault(_STUDY, "rolling=rolling", "rolling=rolling + 1.0", oracle.check_record),
)
