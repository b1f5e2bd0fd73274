"""Seeded faults of the dry rotors and their vibration."""

from __future__ import annotations

from tests.faults import Fault
from tests.solvers import test_bearing as bearing
from tests.solvers import test_tub as tub
from tests.solvers import test_two_plane as two_plane
from tests.solvers import test_vibration as vibration

TWO_PLANE, TUB = "solvers.rotor.two_plane", "solvers.rotor.tub"
VIBRATION, CAMPBELL = "solvers.rotor.vibration", "solvers.rotor.campbell"

FAULTS: tuple[Fault, ...] = (
    Fault(
        TWO_PLANE, "[0.0, 1.0, -position, 0.0]", "[0.0, 1.0, position, 0.0]", two_plane.check_support_matrices
    ),
    Fault(
        TWO_PLANE, "support.damping * axis.T", "support.stiffness * axis.T", two_plane.check_support_matrices
    ),
    Fault(
        TWO_PLANE,
        "= self.polar_inertia, -self.polar_inertia",
        "= -self.polar_inertia, self.polar_inertia",
        two_plane.check_free_top,
    ),
    Fault(
        TWO_PLANE,
        "= self.polar_inertia, -self.polar_inertia",
        "= 2.0 * self.polar_inertia, -2.0 * self.polar_inertia",
        two_plane.check_gyroscopic_splitting,
    ),
    Fault(TWO_PLANE, "np.array([1.0, -1j])", "np.array([1.0, 1j])", two_plane.check_long_shaft),
    Fault(
        TWO_PLANE,
        "cmath.exp(1j * unbalanced.angle)",
        "cmath.exp(-1j * unbalanced.angle)",
        two_plane.check_long_shaft,
    ),
    Fault(
        TWO_PLANE,
        "[self.mass, self.mass, inertia, inertia]",
        "[self.mass, self.mass, inertia, 2.0 * inertia]",
        two_plane.check_far_above_resonance,
    ),
    Fault(TUB, "[1.0, 0.0, 0.0, 0.0, z, -y]", "[1.0, 0.0, 0.0, 0.0, -z, -y]", tub.check_displacement),
    Fault(TUB, "[0.0, 1.0, 0.0, -z, 0.0, x]", "[0.0, 1.0, 0.0, 0.0, -z, x]", tub.check_matrices),
    Fault(TUB, "[0.0, 0.0, 1.0, y, -x, 0.0]", "[0.0, 0.0, 1.0, y, x, 0.0]", tub.check_matrices),
    Fault(TUB, "/ math.hypot(*self.direction)", "", tub.check_matrices),
    Fault(
        TUB, "moving.T @ tensor @ moving", "moving.T @ np.diag(np.diag(tensor)) @ moving", tub.check_matrices
    ),
    Fault(
        TUB,
        "gyroscopic[5, 3] = -along, along",
        "gyroscopic[5, 3] = -2.0 * along, 2.0 * along",
        tub.check_matrices,
    ),
    Fault(TUB, "gyroscopic[5, 3] = -along, along", "gyroscopic[5, 3] = along, -along", tub.check_matrices),
    Fault(TUB, "0.0, across, along, across]", "0.0, along, across, along]", tub.check_matrices),
    Fault(
        TUB, "inertia += self.drum_mass * drum.T", "inertia -= self.drum_mass * drum.T", tub.check_matrices
    ),
    Fault(TUB, "[[2, 0]]", "[[0, 2]]", tub.check_unbalance),
    Fault(TUB, "(centre + heavy * lean).T", "(centre - heavy * lean).T", tub.check_unbalance),
    Fault(
        TUB,
        "+ heavy * lean).T @ np.array([1.0, -1j])",
        "+ heavy * lean).T @ np.array([1.0, 1j])",
        tub.check_unbalance,
    ),
    Fault(
        VIBRATION,
        "omega[:, None, None] * system.gyroscopic",
        "-omega[:, None, None] * system.gyroscopic",
        vibration.check_modes_solve_the_equations,
    ),
    Fault(
        VIBRATION,
        "state *= np.tile(scale, 2)[:, None] / np.tile(scale, 2)",
        "state *= np.tile(scale, 2) / np.tile(scale, 2)[:, None]",
        vibration.check_modes_solve_the_equations,
    ),
    Fault(
        VIBRATION,
        "-_per_mass(system, system.stiffness)",
        "-2.0 * _per_mass(system, system.stiffness)",
        vibration.check_rayleigh,
    ),
    Fault(
        VIBRATION,
        "- np.square(omega) * system.mass",
        "+ np.square(omega) * system.mass",
        vibration.check_jeffcott,
    ),
    Fault(
        VIBRATION,
        "system.damping + omega * system.gyroscopic",
        "system.damping - omega * system.gyroscopic",
        vibration.check_unbalance_in_time,
    ),
    Fault(
        VIBRATION,
        "np.square(omega)[:, None] * system.unbalance",
        "omega[:, None] * system.unbalance",
        vibration.check_jeffcott,
    ),
    Fault(
        VIBRATION, "0.5 * np.conj(first - 1j * second)", "0.5 * (first - 1j * second)", vibration.check_orbit
    ),
    Fault(VIBRATION, "0.5 * (first + 1j * second)", "0.5 * (first - 1j * second)", vibration.check_jeffcott),
    Fault(
        VIBRATION,
        "np.abs(self.forward) + np.abs(self.backward)",
        "np.abs(self.forward)",
        vibration.check_orbit,
    ),
    Fault(
        VIBRATION,
        "np.square(np.abs(first + 1j * second))",
        "np.square(np.abs(first - 1j * second))",
        vibration.check_whirl_direction,
    ),
    Fault(
        VIBRATION,
        "system.mass - 1j * system.gyroscopic",
        "system.mass + 1j * system.gyroscopic",
        vibration.check_critical_speeds,
    ),
    Fault(CAMPBELL, "- likeness)[1]", "+ likeness)[1]", vibration.check_campbell),
    Fault(
        CAMPBELL,
        "return mode(speed, which)[0] - speed",
        "return mode(speed, which)[0] - 0.9 * speed",
        vibration.check_campbell,
    ),
    Fault(
        "solvers.rotor.bearing",
        "1.0 - ball * np.cos(angle) / pitch",
        "1.0 + ball * np.cos(angle) / pitch",
        bearing.check_rolling,
    ),
    Fault(
        "solvers.rotor.bearing",
        "1.0 - ball * np.cos(angle) / pitch",
        "1.0 - ball * np.sin(angle) / pitch",
        bearing.check_rolling,
    ),
    Fault(
        "solvers.rotor.bearing",
        "1.0 - found / expected",
        "1.0 - expected / np.maximum(found, 1.0)",
        bearing.check_slip,
    ),
)
