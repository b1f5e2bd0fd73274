"""Seeded faults of the polar mesh."""

from __future__ import annotations

from tests.faults import Fault
from tests.meshes.rings import test_sectors as oracle

FAULTS: tuple[Fault, ...] = (
    Fault(
        "meshes.rings.quadrilaterals",
        "turns = baffles.first_angle",
        "turns = -baffles.first_angle",
        oracle.check_geometry,
    ),
    Fault(
        "meshes.rings.quadrilaterals",
        "radii[0], radii[-1] = surface_radius, radius",
        "radii[-1] = 1.01 * radius",
        oracle.check_geometry,
    ),
    Fault(
        "meshes.rings.quadrilaterals",
        "np.power(t, rise) if fall",
        "np.power(t, fall) if fall",
        oracle.check_grading,
    ),
    Fault("meshes.rings.quadrilaterals", "(4.0 * near / gap)", "(near / depth)", oracle.check_grading),
    Fault(
        "meshes.rings.quadrilaterals",
        "start + length * _between(count * times",
        "start + length * _between(count",
        oracle.check_grading,
    ),
)
