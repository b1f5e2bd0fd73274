"""Seeded faults of the emulator."""

from __future__ import annotations

from tests.faults import Fault
from tests.leblanc.studies.sweep import test_emulator as oracle

EMULATOR, ERROR = "leblanc.studies.sweep.emulator", oracle.check_error_is_that_of_unseen_samples

FAULTS: tuple[Fault, ...] = (
    Fault(EMULATOR, "(np.exp(mean), np.exp(mean) * deviation)", "(mean, deviation)", ERROR),
    Fault(EMULATOR, "self.centre + self.scale * mean", "self.centre + mean", ERROR),
    Fault(
        EMULATOR,
        "missed[fold == k] = mean - standard",
        "missed[fold == k] = 0.1 * mean - 0.1 * standard",
        ERROR,
    ),
    Fault(EMULATOR, "points[fold != k], standard[fold != k]", "points, standard", ERROR),
    Fault(EMULATOR, "size = scale if positive else 1.0", "size = 1.0", ERROR),
    Fault(EMULATOR, "np.log(np.maximum(values[:, wide], 1e-300))", "values[:, wide]", ERROR),
    Fault(EMULATOR, "np.log(output[taken]) if positive else", "output[taken] if positive else", ERROR),
)
