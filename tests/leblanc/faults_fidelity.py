"""Seeded faults of the estimated errors and of the choice of the liquid model."""

from __future__ import annotations

from tests.faults import Fault
from tests.leblanc import test_fidelity as choice
from tests.solvers import test_model_error as error

_DEFECT, _ERROR = "solvers.statics.law_defect", "solvers.synchronous.errors"

FAULTS: tuple[Fault, ...] = (
    Fault(_DEFECT, "1.0 - filled - 0.5 * ring", "1.0 - filled + 0.5 * ring", error.check_upright_surface),
    Fault(_DEFECT, "np.sqrt(2.0 * air * ring)", "np.sqrt(air * ring)", error.check_upright_surface),
    Fault(_DEFECT, "np.sqrt(2.0 * filled * ring)", "np.sqrt(filled * ring)", error.check_upright_surface),
    Fault(_DEFECT, "air * ring / (1.0 - inner)", "air * ring", error.check_upright_surface),
    Fault(
        _DEFECT, "filled - 0.5 * ring, 1.0 - np", "filled + 0.5 * ring, 1.0 - np", error.check_upright_surface
    ),
    Fault(_DEFECT, "air - 0.5 * ring, cut", "air + 0.5 * ring, cut", error.check_law_bound),
    Fault(
        _DEFECT, "np.pi * (1.0 - surfaces.filled)", "np.pi * (0.5 - surfaces.filled)", error.check_law_bound
    ),
    Fault(_DEFECT, "np.abs(missing) * (1.0 + eps)", "missing * (1.0 - eps)", error.check_law_bound),
    Fault(_DEFECT, "np.pi * np.square(wall) * eps[rows] - pushed", "-pushed", error.check_law_bound),
    Fault(_DEFECT, "b * (s * area[rows] - low", "b * (s * area[rows] + low", error.check_law_bound),
    Fault(_DEFECT, "b * (s * x[rows] - low", "b * (s * x[rows] + low", error.check_law_bound),
    Fault(_DEFECT, "floor + np.divide(missing", "floor - np.divide(missing", error.check_law_bound),
    Fault(_ERROR, "1.0 - low), 0.0)", "low - 1.0), 0.0)", error.check_coverage),
    Fault(_ERROR, "full * least - lost", "full * least + lost", error.check_coverage),
    Fault(
        _ERROR,
        "elastic - pairs.added_mass * squared",
        "elastic + pairs.added_mass * squared",
        error.check_enclosure,
    ),
    Fault(_ERROR, "force + squared * pairs.reach", "force - squared * pairs.reach", error.check_enclosure),
    Fault(
        _ERROR,
        "stiffness * pull + np.sqrt(under)",
        "np.sqrt(under) - stiffness * pull",
        error.check_enclosure,
    ),
    Fault(
        _ERROR,
        "single & above, np.minimum(most, beside)",
        "single, np.minimum(most, linear)",
        error.check_enclosure,
    ),
    Fault(_ERROR, "np.minimum(linear, softened)), 0.0)", "linear), linear)", error.check_enclosure),
    Fault(_ERROR, "np.maximum(np.abs(beyond), frozen)", "np.abs(beyond)", error.check_enclosure),
    Fault(
        "solvers.synchronous.coupled_errors",
        "linear + _carried(spread,",
        "linear - _carried(spread,",
        error.check_tilting,
    ),
    Fault(
        "solvers.synchronous.coupled_errors",
        "np.square(speed)[:, None] * np.stack(bounds",
        "np.stack(bounds",
        error.check_tilting,
    ),
    Fault(
        "solvers.synchronous.coupled_errors",
        "left = size - change",
        "left = size + 1e3 * change",
        error.check_tilting,
    ),
    Fault(
        "solvers.synchronous.errors",
        "(radius / depth) ** _THIN",
        "(depth / radius) ** _THIN",
        error.check_gravity,
    ),
    Fault(
        "solvers.synchronous.errors", "_THIN * np.square(weakness)", "_THIN * weakness", error.check_gravity
    ),
    Fault(
        "solvers.synchronous.errors",
        "pull = np.square(pairs.speed) * weighted",
        "pull = weighted",
        error.check_gravity,
    ),
    Fault("solvers.synchronous.errors", "largest + moved", "largest - moved", error.check_gravity),
    Fault(
        "solvers.runup.error", "crest / fill.depth - 1.0", "crest / fill.depth", error.check_run_up_estimate
    ),
    Fault("solvers.runup.error", "_WAVE * wave**2", "_WAVE * wave", error.check_run_up_estimate),
    Fault("solvers.runup.error", "_LAG * lag**2", "_LAG * lag", error.check_run_up_estimate),
    Fault(
        "solvers.synchronous.mixed", "np.concatenate(wide)[order]", "np.concatenate(wide)", choice.check_mixed
    ),
    Fault(
        "leblanc.studies.choose",
        "linear.wet & (linear.worst <= tolerance)",
        "linear.worst <= 9.0",
        choice.check_within_tolerance,
    ),
    Fault(
        "leblanc.studies.choose",
        "linear.worst, ROUNDING) + gravity",
        "linear.worst, ROUNDING)",
        choice.check_missed,
    ),
    Fault(
        "leblanc.studies.prepare",
        'scene.rotor.axis == "horizontal"',
        'scene.rotor.axis == "vertical"',
        choice.check_missed,
    ),
)
