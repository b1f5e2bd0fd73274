"""Seeded faults of many scenes at once."""

from __future__ import annotations

from tests.faults import Fault
from tests.leblanc import test_batch as oracle

BATCH, CHECK = "leblanc.studies.batch", oracle.check_each_is_what_run_gives

FAULTS: tuple[Fault, ...] = (
    Fault(
        BATCH,
        "gravity = np.array([machine.axial_gravity for machine in prepared])",
        "gravity = np.zeros(len(scenes))",
        CHECK,
    ),
    Fault(BATCH, "~(growth > 0.0)", "(growth == growth)", CHECK),
    Fault(
        BATCH, '"amplitude_dry": np.abs(one.deflection_dry)', '"amplitude_dry": np.abs(one.deflection)', CHECK
    ),
    Fault(
        BATCH,
        '"phase": phase(one.deflection),\n        }',
        '"phase": -phase(one.deflection),\n        }',
        CHECK,
    ),
    Fault(BATCH, "for part in parts])[order]", "for part in parts])", CHECK),
)
