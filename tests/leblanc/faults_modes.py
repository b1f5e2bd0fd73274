"""Seeded faults of the answer about modes."""

from __future__ import annotations

import tempfile
from pathlib import Path

from tests.faults import Fault
from tests.leblanc.studies import test_modes as oracle


def check_file() -> None:
    """The section from a file, in a folder of its own."""
    with tempfile.TemporaryDirectory() as folder:
        oracle.check_file(Path(folder))


FAULTS: tuple[Fault, ...] = (
    Fault(
        "leblanc.studies.modes",
        "np.abs(other / size - 1.0) / (4.0**order - 1.0)",
        "np.abs(other / size - 1.0)",
        oracle.check_ring,
    ),
    Fault(
        "leblanc.studies.modes",
        "np.where(modes.frequency > 0.0, *both)",
        "np.where(modes.frequency < 0.0, *both)",
        oracle.check_ring,
    ),
    Fault("leblanc.studies.modes", "damping.rate / size", "damping.rate * size", oracle.check_ring),
    Fault(
        "leblanc.studies.modes",
        "surface_radius_of(section, volume / chamber.height)",
        "surface_radius_of(section, volume)",
        check_file,
    ),
    Fault("leblanc.studies.modes", "[liquid, halved(liquid)]", "[liquid, liquid]", check_file),
    Fault("leblanc.studies.modes", "k += same", "k += 1", oracle.check_closed_sectors),
)
