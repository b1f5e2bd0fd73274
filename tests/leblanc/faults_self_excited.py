"""Seeded faults of what self-excited whirl makes of a study."""

from __future__ import annotations

from tests.faults import Fault
from tests.leblanc import test_self_excited as oracle

FAULTS: tuple[Fault, ...] = (
    Fault("leblanc.studies.run", "found.growth > 0.0)", "found.growth >= 0.0)", oracle.check_stable),
    Fault("leblanc.studies.run", "stable & ~(found", "stable | ~(found", oracle.check_stable),
    Fault("leblanc.studies.run", "np.argmax(found.growth)", "np.argmin(found.growth)", oracle.check_words),
    Fault("leblanc.studies.run", "{high * RPM:.5g} rpm", "{high:.5g} rpm", oracle.check_words),
    Fault(
        "leblanc.studies.run",
        "unstable_bands(rotor, [scene.chambers], speed, friction, growth[None])",
        "unstable_bands(rotor, [scene.chambers], speed, (0, 0.0), growth[None])",
        oracle.check_rig,
    ),
)
