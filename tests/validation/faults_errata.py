"""Seeded faults of the derivations behind the errata."""

from tests.faults import Fault
from tests.validation import test_errata as oracle

FAULTS: tuple[Fault, ...] = (
    Fault(
        "validation.cases.errata_tub",
        "spin[0, 2] + omega",
        "spin[0, 2] + 2 * omega",
        oracle.test_gyroscopic_coupling_is_the_torque_that_turns_the_spin,
    ),
    Fault(
        "validation.cases.errata_tub",
        "sp.Matrix(q[:3]) + turn * place - place",
        "sp.Matrix(q[:3]) - turn * place + place",
        oracle.test_tub_matrices_against_rigid_body_kinematics,
    ),
    Fault(
        "validation.cases.errata",
        "(r[:, None] * np.sin(angle)) ** 2",
        "0.0 * r[:, None]",
        oracle.assert_polar_moment,
    ),
)
