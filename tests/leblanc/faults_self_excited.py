"""Seeded faults of what self-excited whirl makes of a study."""

from __future__ import annotations

from tests.faults import Fault
from tests.leblanc import test_self_excited as oracle

FAULTS: tuple[Fault, ...] = (
    Fault("leblanc.results.motion", "self.growth > 0.0)", "self.growth >= 0.0)", oracle.check_stable),
    Fault("leblanc.results.motion", "stable & ~(self", "stable | ~(self", oracle.check_stable),
    Fault("leblanc.results.run_notes", "np.argmax(whirl", "np.argmin(whirl", oracle.check_words),
    Fault(
        "leblanc.studies.run",
        "filled, speed, machine.friction, known)",
        "filled, speed, (0, 0.0), known)",
        oracle.check_rig,
    ),
)
