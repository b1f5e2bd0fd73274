"""Seeded faults of the rotor's response with liquid."""

from __future__ import annotations

from tests.faults import Fault
from tests.solvers import test_response as oracle

FAULTS: tuple[Fault, ...] = (
    Fault(
        "solvers.rotor.jeffcott",
        "- self.mass * np.square(speed) + 1j",
        "+ self.mass * np.square(speed) + 1j",
        oracle.check_balance,
    ),
    Fault(
        "solvers.rotor.jeffcott",
        "+ 1j * self.damping * speed",
        "- 1j * self.damping * speed",
        oracle.check_balance,
    ),
    Fault(
        "solvers.synchronous.planar",
        "force, damping = pairs.unbalance * squared",
        "force, damping = pairs.unbalance * pairs.speed",
        oracle.check_added_mass,
    ),
    Fault(
        "solvers.synchronous.planar",
        "pull = np.square(pairs.speed[which]) * state.unbalance",
        "pull = pairs.speed[which] * state.unbalance",
        oracle.check_balance,
    ),
    Fault(
        "solvers.synchronous.planar",
        "elastic = pairs.stiffness - (pairs.mass + pairs",
        "elastic = pairs.stiffness - (pairs.mass - pairs",
        oracle.check_balance,
    ),
    Fault(
        "solvers.synchronous.planar",
        "np.square(spin) * (own + state.slope)",
        "np.square(spin) * (own + secant)",
        oracle.check_middle_branch,
    ),
    Fault(
        "solvers.synchronous.planar",
        "np.divide(unbalance, pairs.liquid_mass",
        "np.divide(unbalance - deflection, pairs.liquid_mass",
        oracle.check_added_mass,
    ),
    Fault(
        "solvers.synchronous.models",
        "1.0 + 4.0 * steep[which] * deflection",
        "1.0 + 2.0 * steep[which] * deflection",
        oracle.check_balance,
    ),
    Fault(
        "solvers.synchronous.critical",
        "rotor.stiffness - (rotor.mass + slope) * np.square(speed)",
        "rotor.stiffness - (rotor.mass - slope) * np.square(speed)",
        oracle.check_critical_speed,
    ),
)
