"""Seeded faults of a scene's run-up, its film and its files."""

from __future__ import annotations

from tests.faults import Fault
from tests.leblanc import test_runup as oracle

FAULTS: tuple[Fault, ...] = (
    Fault(
        "leblanc.studies.runup",
        "self.history.deflection[:, 0] * np.exp(-1j * self.history.angle)",
        "self.history.deflection[:, 0] * np.exp(1j * self.history.angle)",
        oracle.check_dry_run,
    ),
    Fault(
        "leblanc.studies.runup",
        "math.pi * np.maximum(1.0, np.ceil(",
        "math.pi * np.maximum(0.5, 0.5 * np.ceil(",
        oracle.check_turn_mean,
    ),
    Fault("leblanc.studies.runup", "/ (2.0 * half))", "/ half)", oracle.check_turn_mean),
    Fault("leblanc.studies.runup", "0.5 * (values[1:] + values[:-1])", "values[1:]", oracle.check_lines),
    Fault(
        "leblanc.studies.runup",
        "history.speed + history.mean_rotation[:, k]",
        "history.speed - history.mean_rotation[:, k]",
        oracle.check_gravity_across,
    ),
    Fault(
        "leblanc.studies.runup",
        "capture_speed(fill.surface_radius, scene.gravity)",
        "capture_speed(fill.chamber.radius, scene.gravity)",
        oracle.check_gravity_across,
    ),
    Fault(
        "leblanc.studies.runup",
        "covering_speed(fill, axial_gravity(scene))",
        "covering_speed(fill, 2.0 * axial_gravity(scene))",
        oracle.check_gravity_along,
    ),
    Fault("leblanc.studies.runup", "max(held, covering", "min(held, covering", oracle.check_gravity_along),
    Fault(
        "leblanc.studies.runup",
        ">= wall.radius - wall.inner_radius",
        ">= wall.radius + wall.inner_radius",
        oracle.check_inner_wall,
    ),
    Fault(
        "leblanc.studies.runup", "plan.rate, plan.duration", "plan.duration, plan.rate", oracle.check_drive
    ),
    Fault(
        "leblanc.studies.runup",
        "Motor(plan.start, motor",
        "Motor(plan.stop, motor",
        oracle.check_drive,
    ),
    Fault(
        "leblanc.studies.prepare",
        'scene.gravity if scene.rotor.axis == "horizontal"',
        'scene.gravity if scene.rotor.axis == "vertical"',
        oracle.check_pool,
    ),
    Fault(
        "leblanc.studies.runup",
        "synchronous_response(jeffcott(scene), scene.chambers, passed",
        "synchronous_response(jeffcott(scene), (), passed",
        oracle.check_steady,
    ),
    Fault(
        "leblanc.studies.runup",
        "unstable_bands(system, [scene.chambers], passed, friction)",
        "unstable_bands(system, [scene.chambers], passed, (1, 1.0))",
        oracle.check_bands,
    ),
    Fault(
        "leblanc.results.runup",
        '"liquid_angle": np.angle(position)',
        '"liquid_angle": -np.angle(position)',
        oracle.check_json,
    ),
    Fault("leblanc.studies.runup_film", "turn = np.exp(-1j", "turn = np.exp(1j", oracle.check_film),
    Fault("leblanc.studies.runup_film", "np.angle(-turn)", "np.angle(turn)", oracle.check_pool),
    Fault(
        "leblanc.studies.runup_film",
        "1.0 - np.sqrt(np.maximum(1.0 - 2.0 * machine.area",
        "1.0 - np.sqrt(np.maximum(1.0 - machine.area",
        oracle.check_film,
    ),
    Fault(
        "leblanc.studies.runup_film",
        "corners[1, k + 1] - corners[1, k]",
        "corners[1, k] - corners[1, k + 1]",
        oracle.check_film,
    ),
    Fault(
        "leblanc.figures.runup_film",
        "half - math.sin(half) * math.cos(half)",
        "half + math.sin(half) * math.cos(half)",
        oracle.check_pool,
    ),
    Fault(
        "leblanc.figures.runup",
        "y, good = rpm[point], size[point, column], calm[point, column]",
        "y, good = rpm[point], size[point, column], ~calm[point, column]",
        oracle.check_steady_lines,
    ),
    Fault(
        "leblanc.studies.runup",
        'return "long_wave" if asked == "auto"',
        'return "linear" if asked == "auto"',
        oracle.check_liquid_model,
    ),
)
