"""Faults of section meshes and cut triangles."""

from __future__ import annotations

from tests.faults import Fault
from tests.meshes.refine.test_waterline import check_half_plane, check_hole, check_range, check_whole_section
from tests.meshes.test_quality import (
    check_equilateral,
    check_jacobian_at_the_nodes,
    check_parabola_angle,
    check_parabola_area,
)
from tests.meshes.test_section import check_polygon_area, check_quadratic_wall

FAULTS: tuple[Fault, ...] = (
    Fault("meshes.quality", "cross(c1, c2) / 3.0", "cross(c1, c2) / 2.0", check_parabola_area),
    Fault("meshes.quality", "bend = 2.0 * (start + end)", "bend = (start + end)", check_parabola_area),
    Fault("meshes.quality", "np.roll(c1 + 2.0 * c2, 1", "np.roll(c1 + c2, 1", check_parabola_angle),
    Fault(
        "meshes.quality", "0.25 * np.sqrt(3.0) * longest", "0.5 * np.sqrt(3.0) * longest", check_equilateral
    ),
    Fault("meshes.quality", "(xp * yq - xq * yp)", "(xp * yq + xq * yp)", check_jacobian_at_the_nodes),
    Fault("meshes.section", "points = [radii[j] * np", "points = [radii[j] ** 2 * np", check_polygon_area),
    Fault(
        "meshes.section",
        "middles[curved] = 0.5 * (ra + rb) * along",
        "middles[curved] = np.sqrt(ra * rb * np.sum(along**2, axis=1)[:, None] / 4.0) * along",
        check_quadratic_wall,
    ),
    Fault(
        "meshes.refine.waterline",
        "3.0 * np.sum(c1 * c2, axis=0)",
        "2.0 * np.sum(c1 * c2, axis=0)",
        check_hole,
    ),
    Fault(
        "meshes.refine.waterline",
        "curve[1] + 2.0 * t * curve[2]",
        "curve[1] + t * curve[2]",
        check_whole_section,
    ),
    Fault("meshes.refine.waterline", "(x * dy - y * dx)", "(y * dx - x * dy)", check_whole_section),
    Fault("meshes.refine.waterline", "* _RAY[1] * fraction\n", "* _RAY[1]\n", check_whole_section),
    Fault(
        "meshes.refine.waterline",
        "_square(curve, middle) < level",
        "_square(curve, middle) < 0.9 * level",
        check_half_plane,
    ),
    Fault(
        "meshes.refine.waterline",
        "np.sqrt(np.minimum(origin, square)",
        "(np.minimum(origin, square)",
        check_half_plane,
    ),
    Fault(
        "meshes.refine.waterline", "(xa * yb - ya * xb, xa * xb", "(xa * yb + ya * xb, xa * xb", check_range
    ),
)
