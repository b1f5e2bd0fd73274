"""Seeded faults of what studies make of a rotor that tilts."""

from __future__ import annotations

from tests.faults import Fault
from tests.leblanc import test_motion_run as oracle

FAULTS: tuple[Fault, ...] = (
    Fault(
        "leblanc.results.response",
        "np.abs(self.motion.backward)\n",
        "-np.abs(self.motion.backward)\n",
        oracle.check_amplitude_of_an_ellipse,
    ),
    Fault(
        "leblanc.results.response",
        "np.abs(self.motion.backward_dry)\n",
        "0.5 * np.abs(self.motion.backward_dry)\n",
        oracle.check_amplitude_of_an_ellipse,
    ),
    Fault(
        "leblanc.studies.explain",
        "fill.added_mass / bare.mass",
        "fill.mass / bare.mass",
        oracle.check_explained_mass,
    ),
    Fault(
        "leblanc.studies.run", "int(np.argmax(size))", "int(np.argmin(size))", oracle.check_one_rotor_two_ways
    ),
)
