"""Faults of sections with baffles, cut sections, bodies of liquid, their files and findings."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from functools import cache, wraps
from pathlib import Path

from meshes.errors import InputError
from tests.faults import Fault
from tests.meshes.test_body import check_faces, check_paraboloid, check_tetrahedron, check_upright, check_wave
from tests.meshes.test_exchange import check_groups, check_turned_cells
from tests.meshes.test_findings import check_points_across, check_points_per_wave, check_wave_error
from tests.meshes.test_liquid_section import check_pieces, check_sides
from tests.meshes.test_quality import check_quadrilaterals
from tests.meshes.test_ring import (
    check_angles,
    check_baffle_length,
    check_grading,
    check_ring_area,
    check_sector_area,
    check_slits,
)
from tests.meshes.test_waterline_cut import (
    check_area_outside,
    check_bisection,
    check_both_sides,
    check_inverse,
    check_sizes,
)


def check_files() -> None:
    with tempfile.TemporaryDirectory() as folder:
        check_groups(Path(folder))


def check_turned() -> None:
    with tempfile.TemporaryDirectory() as folder:
        check_turned_cells(Path(folder))


@cache
def refused(oracle: Callable[[], None]) -> Callable[[], None]:
    """The oracle of a fault that the meshes themselves refuse: folded cells, circles that bound nothing."""

    @wraps(oracle)
    def check() -> None:
        try:
            oracle()
        except InputError as fault:
            raise AssertionError(str(fault)) from fault

    return check


FAULTS: tuple[Fault, ...] = (
    Fault(
        "meshes.quality",
        "slopes, number = np.stack([4.0 * t - 3.0",
        "slopes, number = np.stack([4.0 * t - 2.0",
        check_quadrilaterals,
    ),
    Fault("meshes.quality", "along_q = values[i]", "along_q = values[j]", check_quadrilaterals),
    Fault(
        "meshes.liquid_section",
        "start[:, 0] * end[:, 1] < start[:, 1] * end[:, 0]",
        "start[:, 0] * end[:, 1] > start[:, 1] * end[:, 0]",
        refused(check_sides),
    ),
    Fault(
        "meshes.liquid_section",
        "here[np.argmax(radius[here])]",
        "here[np.argmin(radius[here])]",
        check_pieces,
    ),
    Fault("meshes.baffles", "2.0 * math.pi / self.count", "math.pi / self.count", refused(check_angles)),
    Fault("meshes.baffles", "radius - self.wall_gap", "radius + self.wall_gap", refused(check_baffle_length)),
    Fault("meshes.rings.slits", "turned = [1, 0, 2]", "turned = [0, 1, 2]", check_slits),
    Fault(
        "meshes.rings.triangles",
        "shorter = slope / (growth - 1.0)",
        "shorter = (growth - 1.0) / slope",
        check_grading,
    ),
    Fault(
        "meshes.rings.triangles",
        "0.5 * (length + (end - start) / slope)",
        "0.5 * (length + (start - end) / slope)",
        check_grading,
    ),
    Fault(
        "meshes.rings.triangles",
        "0.5 * (values[1:] + values[:-1])",
        "0.6 * values[1:] + 0.4 * values[:-1]",
        refused(check_ring_area),
    ),
    Fault(
        "meshes.rings.triangles",
        "np.sin(angle)], axis=-1)",
        "np.cos(angle)], axis=-1)",
        refused(check_ring_area),
    ),
    Fault(
        "meshes.rings.sectors",
        "middle = 0.5 * (r[tail] + r[head])",
        "middle = 0.49 * (r[tail] + r[head])",
        refused(check_sector_area),
    ),
    Fault(
        "meshes.refine.bisection",
        "0.375 * low + 0.75 * middle - 0.125 * high",
        "0.375 * low + 0.625 * middle",
        refused(check_bisection),
    ),
    Fault(
        "meshes.refine.bisection",
        "0.5 * (points[bc] + points[ca]) - 0.125",
        "0.5 * (points[bc] + points[ca]) - 0.25",
        refused(check_bisection),
    ),
    Fault("meshes.refine.bisection", "marked[base[more]] = True", "break", refused(check_bisection)),
    Fault(
        "meshes.refine.circle_cut",
        "signs * np.sign(signs.sum(axis=1))[:, None] < 0.0",
        "signs * np.sign(signs.sum(axis=1))[:, None] > 0.0",
        refused(check_both_sides),
    ),
    Fault(
        "meshes.refine.circle_cut",
        "bent[middle] = circle.project(0.5",
        "bent[middle] = (0.5",
        refused(check_both_sides),
    ),
    Fault(
        "meshes.refine.circle_cut",
        "tip_out = signs[np.arange(n), apex] > 0.0",
        "tip_out = signs[np.arange(n), apex] < 0.0",
        refused(check_both_sides),
    ),
    Fault(
        "meshes.refine.circle_cut",
        "points[..., 1] - self.y) - self.radius",
        "points[..., 1] + self.y) - self.radius",
        refused(check_both_sides),
    ),
    Fault("meshes.refine.waterline_cut", "square = radius * radius", "square = radius", check_area_outside),
    Fault(
        "meshes.refine.waterline_cut",
        "farthest - depth) - liquid_area",
        "farthest - depth) - 1.01 * liquid_area",
        check_inverse,
    ),
    Fault(
        "meshes.refine.waterline_cut", "0.5 * (growth - 1.0)", "0.5 * (growth + 1.0)", refused(check_sizes)
    ),
    Fault(
        "meshes.bodies.body",
        "start = np.where(empty[column[:, c]], high, low)",
        "start = low",
        check_paraboloid,
    ),
    Fault("meshes.bodies.body", "(top & open_top[:, None])", "(top & ~open_top[:, None])", check_faces),
    Fault("meshes.bodies.body", "np.sum(x * flux)) / 3.0", "np.sum(x * flux)) / 2.0", check_tetrahedron),
    Fault(
        "meshes.bodies.body", "first = 0.5 * np.sum(x * x * flux", "first = np.sum(x * x * flux", check_wave
    ),
    Fault("meshes.bodies.body", "volume * middle", "middle", check_tetrahedron),
    Fault("meshes.bodies.body", "np.diag(4.0 * share - 1.0)", "np.diag(4.0 * share)", check_tetrahedron),
    Fault(
        "meshes.bodies.paraboloid",
        "(-constant / beta, height / beta)",
        "(constant / beta, height / beta)",
        refused(check_paraboloid),
    ),
    Fault("meshes.bodies.paraboloid", "floor + 0.5 * ramp", "floor + ramp", check_upright),
    Fault(
        "meshes.bodies.paraboloid",
        "(square - floor) / ramp, 0.0",
        "(floor - square) / ramp, 0.0",
        refused(check_paraboloid),
    ),
    Fault(
        "meshes.bodies.wave", "radius - (1.0 - share) * thickness", "radius - share * thickness", check_wave
    ),
    Fault("meshes.bodies.wave", "np.stack([r * np.cos(theta)", "np.stack([r * np.sin(theta)", check_wave),
    Fault("meshes.files.exchange", "origin[cells] = section.triangles", "pass", check_files),
    Fault(
        "meshes.files.exchange",
        "turned = np.take(cells, _REVERSED[cells.shape[1]], axis=1)",
        "turned = cells[:, ::-1]",
        refused(check_turned),
    ),
    Fault("meshes.findings", "step**2 / 12.0", "step**2 / 24.0", check_wave_error),
    Fault("meshes.findings", "step**4 / 720.0", "step**4 / 360.0", check_wave_error),
    Fault(
        "meshes.findings",
        "liquid.order * 2.0 * math.pi / (mode",
        "2.0 * math.pi / (mode",
        check_points_per_wave,
    ),
    Fault(
        "meshes.findings",
        "liquid.surface_radius / mode)",
        "liquid.surface_radius * mode)",
        check_points_across,
    ),
)
