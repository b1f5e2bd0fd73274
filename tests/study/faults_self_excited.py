"""Seeded faults of what self-excited whirl makes of a study."""

from __future__ import annotations

from tests.faults import Fault
from tests.study import test_self_excited as oracle

FAULTS: tuple[Fault, ...] = (
    Fault("study.self_excited", "found.growth > 0.0)", "found.growth >= 0.0)", oracle.check_stable),
    Fault("study.self_excited", "stable & ~(found", "stable | ~(found", oracle.check_stable),
    Fault("study.self_excited", "np.argmax(found.growth)", "np.argmin(found.growth)", oracle.check_words),
    Fault("study.self_excited", "{high * RPM:.5g} rpm", "{high:.5g} rpm", oracle.check_words),
    Fault(
        "study.self_excited",
        "unstable_bands(system, [scene.chambers], speed, friction, growth[None])",
        "unstable_bands(system, [scene.chambers], speed, (0, 0.0), growth[None])",
        oracle.check_rig,
    ),
)
