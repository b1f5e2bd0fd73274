"""Seeded faults of halved meshes."""

from __future__ import annotations

from tests.faults import Fault
from tests.meshes.refine import test_bisection as oracle

_MODULE = "meshes.refine.bisection"

FAULTS: tuple[Fault, ...] = (
    Fault(_MODULE, "0.375 * low + 0.75", "0.5 * low + 0.625", oracle.check_walls_keep_their_shape),
    Fault(_MODULE, "0.375 * high + 0.75", "0.5 * high + 0.625", oracle.check_walls_keep_their_shape),
    Fault(_MODULE, "points[on_circle] *=", "points[on_circle] *= 1.0 + 0.0 *", oracle.check_halved),
    Fault(
        _MODULE,
        "_INNER, points[cells]",
        "0.9999 * _INNER, points[cells]",
        oracle.check_straight_parts_of_straight_triangles,
    ),
)
