"""Seeded faults of the rotor's response with liquid."""

from __future__ import annotations

from tests.faults import Fault
from tests.solvers import test_response as oracle

FAULTS: tuple[Fault, ...] = (
    Fault(
        "fluid.fill",
        "self.chamber.radius**2 * self.chamber.height",
        "self.chamber.radius * self.chamber.height",
        oracle.check_added_mass,
    ),
    Fault(
        "solvers.rotor.jeffcott",
        "- self.mass * np.square(speed) + 1j",
        "+ self.mass * np.square(speed) + 1j",
        oracle.check_added_mass,
    ),
    Fault(
        "solvers.rotor.jeffcott",
        "+ 1j * self.damping * speed",
        "- 1j * self.damping * speed",
        oracle.check_added_mass,
    ),
    Fault(
        "solvers.response",
        "force = rotor.unbalance * np.square(spin)",
        "force = rotor.unbalance * spin",
        oracle.check_added_mass,
    ),
    Fault(
        "solvers.response",
        "pull = np.square(speed) * state.unbalance",
        "pull = speed * state.unbalance",
        oracle.check_balance,
    ),
    Fault(
        "solvers.response",
        "elastic = rotor.stiffness - (rotor.mass + sum",
        "elastic = rotor.stiffness - (rotor.mass - sum",
        oracle.check_balance,
    ),
    Fault(
        "solvers.response",
        "np.square(spin) * (rotor.mass + state.slope)",
        "np.square(spin) * (rotor.mass + secant)",
        oracle.check_middle_branch,
    ),
    Fault(
        "solvers.response",
        "return unbalance / mass",
        "return unbalance / mass - deflection",
        oracle.check_added_mass,
    ),
    Fault(
        "solvers.liquid_models",
        "1.0 + 4.0 * steep[which] * deflection",
        "1.0 + 2.0 * steep[which] * deflection",
        oracle.check_balance,
    ),
    Fault(
        "solvers.response",
        "rotor.stiffness - (rotor.mass + slope) * np.square(speed)",
        "rotor.stiffness - (rotor.mass - slope) * np.square(speed)",
        oracle.check_critical_speed,
    ),
)
