"""Seeded faults of the liquid's equilibrium."""

from __future__ import annotations

from tests.faults import Fault
from tests.solvers.statics import test_hydrostatics as oracle


def _whole() -> None:
    for fill, e, speed in ((0.02, 0.012, 40.0), (0.3, 0.25, 7.0), (0.01, 0.1, 1e4), (0.7, 0.05, 6.0)):
        oracle.check_state(0.2, 0.05, fill, e, speed)


def _optimal() -> None:
    oracle.test_optimal_volume_values(0.2, 0.05, 90.0, (54.43957239, 178.3088703, 603.5171603))


ARC = "solvers.statics.wall"
STATICS = "solvers.statics.hydrostatics"
INTEGRALS = "solvers.statics.integrals"

FAULTS: tuple[Fault, ...] = (
    Fault(ARC, "np.arctan2(sin, e + cos)", "np.arctan2(sin, e - cos)", _whole),
    Fault(ARC, "_FAR[1] * 2.0 * e * sin", "_FAR[1] * e * sin", _whole),
    Fault(ARC, "8.0 * e * k * sine", "4.0 * e * k * sine", _whole),
    Fault(ARC, "(e - 1.0) + 2.0 * squared", "(e - 1.0) + squared", _whole),
    Fault(ARC, "np.square(1.0 - eps), 0.0)", "1.0 - eps, 0.0)", _whole),
    Fault(ARC, "0.5 * (panel.s * panel.phi + panel", "0.5 * (panel.s * panel.phi - panel", _whole),
    Fault(ARC, "yy[rows] += (0.5 * liquid", "yy[rows] += (liquid", _whole),
    Fault(ARC, "(0.5 * liquid * depth * panel.phi)", "(liquid * depth * panel.phi)", _whole),
    Fault(ARC, ".sum(-1) / 3.0", ".sum(-1) / 2.0", _whole),
    Fault(ARC, "xz[rows] += (0.5 * liquid", "xz[rows] += (liquid", _whole),
    Fault(ARC, "series = 4.0 / 6.0 * small**3", "series = 4.0 / 5.0 * small**3", _whole),
    Fault(STATICS, "2.0 * np.maximum(plan_xx - mean * plan_x, 0.0)", "2.0 * plan_xx", oracle.check_slope),
    Fault(STATICS, "self.volume + 2.0 * np.max", "2.0 * np.max", oracle.check_slope),
    Fault(INTEGRALS, "(1.0 + ratio + 2.0 * eps)", "(1.0 + ratio + eps)", oracle.check_slope),
    Fault(STATICS, "np.square(1.0 + self.eccentricity / radius)", "1.0", oracle.check_bowl),
    Fault(STATICS, "4.0 * steep * e / chamber.radius)", "2.0 * steep * e / chamber.radius)", _optimal),
    Fault(INTEGRALS, "_all_moments, (2, 3, 2, 4, 4, 2, 3)", "_all_moments, (2, 2, 2, 4, 4, 2, 3)", _whole),
    Fault("fluid.paraboloid", "fall = 2.0 * g * h", "fall = g * h", _whole),
    Fault("fluid.paraboloid", "0.5 * height - beta", "0.5 * height + beta", oracle.check_clear_constant),
)
