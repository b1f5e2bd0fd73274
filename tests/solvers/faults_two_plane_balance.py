"""Seeded faults of the conditions of two-plane balancing."""

from __future__ import annotations

from tests.faults import Fault
from tests.solvers.rotor import test_two_plane_balance as oracle

_BALANCE = "solvers.rotor.two_plane_balance"

FAULTS: tuple[Fault, ...] = (
    Fault(_BALANCE, "sum(k * z for k, z", "sum(-k * z for k, z", oracle.check_support),
    Fault(_BALANCE, "sum(k * z * z for k, z", "sum(k * z for k, z", oracle.check_support),
    Fault(_BALANCE, "v11, v22, v33 = (b - c)", "v11, v22, v33 = (b + c)", oracle.check_conditions),
    Fault(_BALANCE, "(a - c) * square - k33", "(a - c) * square + k33", oracle.check_conditions),
    Fault(_BALANCE, "rotor.mass * square - k11", "square - k11", oracle.check_conditions),
    Fault(_BALANCE, "v11 * v33 - k14 * k14", "v11 * v33 + k14 * k14", oracle.check_conditions),
    Fault(_BALANCE, "v22 * v33 - k14 * k14", "v11 * v33 - k14 * k14", oracle.check_conditions),
    Fault(_BALANCE, "tilt_x, tilt_y = (b - c)", "tilt_x, tilt_y = (a - c)", oracle.check_hessian),
    Fault(_BALANCE, "[0.0, tilt_y, -k14, 0.0]", "[0.0, tilt_y, k14, 0.0]", oracle.check_hessian),
    Fault(_BALANCE, "[k14, 0.0, 0.0, shift]", "[-k14, 0.0, 0.0, shift]", oracle.check_hessian),
    Fault(
        _BALANCE,
        "shift = rotor.mass * speed**2 - k11",
        "shift = rotor.mass * speed**2 + k11",
        oracle.check_hessian,
    ),
    Fault(
        _BALANCE,
        "excess * k11 + rotor.mass * k33",
        "excess * k11 + 2.0 * rotor.mass * k33",
        oracle.check_resonances,
    ),
    Fault(
        _BALANCE,
        "k11 * k33 - k14 * k14\n    # Never",
        "k11 * k33 + k14 * k14\n    # Never",
        oracle.check_resonances,
    ),
    Fault(_BALANCE, "math.sqrt(stiffness / inertia)", "stiffness / inertia", oracle.check_uncoupled),
    Fault(_BALANCE, "mass=rotor.mass + added_mass", "mass=rotor.mass", oracle.check_resonances),
)
