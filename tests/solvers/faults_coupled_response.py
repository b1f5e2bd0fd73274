"""Seeded faults of the harmonic balance of rotor and liquid."""

from __future__ import annotations

from tests.faults import Fault
from tests.solvers import test_coupled_response as oracle

TERMS, BACKWARD, BRANCHES = (
    "solvers.synchronous.balance",
    "solvers.synchronous.backward",
    "solvers.synchronous.coupled",
)
RESPONSE, CRITICAL = "solvers.synchronous.response", "solvers.synchronous.critical"

FAULTS: tuple[Fault, ...] = (
    Fault(
        TERMS, "0.5 * answer @ np.conj(self.plane).T", "0.5 * answer @ self.plane.T", oracle.check_added_mass
    ),
    Fault(TERMS, "0.5 * np.einsum(", "1.0 * np.einsum(", oracle.check_added_mass),
    Fault(
        TERMS, "squared[:, None, None] * back", "-squared[:, None, None] * back", oracle.check_linear_layer
    ),
    Fault(
        TERMS,
        "backward_mass(fill) * np.outer(np.conj(p), p)",
        "backward_mass(fill) * np.outer(p, np.conj(p))",
        oracle.check_linear_layer,
    ),
    Fault(
        BACKWARD, "force_ratio(curvature, -1.0)", "force_ratio(curvature, 1.0)", oracle.check_backward_mass
    ),
    Fault(
        BACKWARD, "        return fill.mass\n", "        return fill.full_mass\n", oracle.check_full_chambers
    ),
    Fault(TERMS, "np.array([1.0, -1j])", "np.array([1.0, 1j])", oracle.check_added_mass),
    Fault(TERMS, "force=squared[:, None] * system", "force=speed[:, None] * system", oracle.check_added_mass),
    Fault(
        BRANCHES,
        "elastic = support.real - squared * mass",
        "elastic = support.real",
        oracle.check_planar_rotor,
    ),
    Fault(BRANCHES, "moment - mass * deflection", "moment", oracle.check_planar_rotor),
    Fault(
        BRANCHES,
        "np.angle(support * size - pulled)",
        "np.angle(support * size + pulled)",
        oracle.check_planar_rotor,
    ),
    Fault(
        BRANCHES,
        "- squared[:, None] * ((secant * w) @ p)",
        "- squared[:, None] * ((law.slope * w) @ p)",
        oracle.check_balance,
    ),
    Fault(
        BRANCHES,
        "- squared[:, None] * ((secant * w) @ p)",
        "- squared[:, None] * ((secant * w) @ np.conj(p))",
        oracle.check_balance,
    ),
    Fault(RESPONSE, "np.abs(moment) / mass", "np.abs(moment) * mass", oracle.check_added_mass),
    Fault(
        CRITICAL,
        "0.5 * full * np.outer(p, np.conj(p))",
        "full * np.outer(p, np.conj(p))",
        oracle.check_critical_speeds,
    ),
    Fault(
        CRITICAL,
        "0.5 * backward_mass(fill) * np.outer",
        "backward_mass(fill) * np.outer",
        oracle.check_critical_speeds,
    ),
)
