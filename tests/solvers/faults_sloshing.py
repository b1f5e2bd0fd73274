"""Seeded faults of sloshing: matrices, modes, force, damping."""

from __future__ import annotations

from tests.faults import Fault
from tests.solvers.sloshing import test_damping as damping
from tests.solvers.sloshing import test_sloshing as oracle

FAULTS: tuple[Fault, ...] = (
    Fault(
        "solvers.sloshing.assembly",
        "u.grad[0] * v.grad[0] +",
        "u.grad[0] * v.grad[0] -",
        oracle.check_matrices,
    ),
    Fault(
        "solvers.sloshing.assembly",
        "grads[:, 0] * unit[:, :, 1] -",
        "grads[:, 0] * unit[:, :, 1] +",
        oracle.check_matrices,
    ),
    Fault(
        "solvers.sloshing.assembly",
        "end - start + bend * (1.0 - 2.0 * t)",
        "end - start + bend * (1.0 - t)",
        oracle.check_matrices,
    ),
    Fault(
        "solvers.sloshing.system", "broadcast_to(-first", "broadcast_to(first", oracle.check_waves_of_the_ring
    ),
    Fault(
        "solvers.sloshing.system",
        "[1.0, 7.0, -8.0], [-8.0, -8.0, 16.0]]) / 3.0",
        "[1.0, 7.0, -8.0], [-8.0, -8.0, 16.0]]) / 6.0",
        oracle.check_matrices,
    ),
    Fault(
        "solvers.sloshing.system",
        "(gyration.T @ section.points)",
        "(gyration @ section.points)",
        oracle.check_pressure_and_newton,
    ),
    Fault(
        "solvers.sloshing.system",
        "whole[:, part] -= coupling.T",
        "whole[:, part] += coupling.T",
        oracle.check_waves_of_the_ring,
    ),
    Fault(
        "solvers.sloshing.system", "qr(schur @ constants)", "qr(constants)", oracle.check_limits_of_baffles
    ),
    Fault(
        "solvers.sloshing.system",
        "(4.0 / 3.0) * _cross",
        "(2.0 / 3.0) * _cross",
        oracle.check_areas_of_a_bumpy_wall,
    ),
    Fault(
        "solvers.sloshing.system",
        "_area(section.points, section.surface) - across",
        "across",
        oracle.check_force_on_the_ring,
    ),
    Fault(
        "solvers.sloshing.modes",
        "= -1j * (turned - turned.T)",
        "= -0.5j * (turned - turned.T)",
        oracle.check_waves_of_the_ring,
    ),
    Fault(
        "solvers.sloshing.modes",
        "np.where(travel < 0.0, -1.0, 1.0)",
        "np.where(travel < 0.0, 1.0, -1.0)",
        oracle.check_waves_of_the_ring,
    ),
    Fault("solvers.sloshing.modes", "psi=-1j * frequency", "psi=1j * frequency", oracle.check_shapes),
    Fault(
        "solvers.sloshing.modes",
        "/ section.surface_radius\n    fitted",
        "* section.surface_radius\n    fitted",
        oracle.check_shapes,
    ),
    Fault("solvers.sloshing.modes", "np.exp(-1j * n * angle", "np.exp(1j * n * angle", oracle.check_shapes),
    Fault(
        "solvers.sloshing.modes", "product = -values.conj()", "product = values.conj()", oracle.check_shapes
    ),
    Fault(
        "solvers.sloshing.forced",
        "force = second + 2.0 * 1j",
        "force = second - 2.0 * 1j",
        oracle.check_force_on_the_ring,
    ),
    Fault(
        "solvers.sloshing.forced",
        "found[2] - np.tensordot",
        "found[2] + np.tensordot",
        oracle.check_force_on_the_ring,
    ),
    Fault(
        "solvers.sloshing.forced",
        "np.concatenate([p, p.conj()])",
        "np.concatenate([p, p])",
        oracle.check_force_on_the_ring,
    ),
    Fault(
        "solvers.sloshing.forced",
        "slip**2 * system.inertia + 2j",
        "slip**2 * system.inertia - 2j",
        oracle.check_pressure_and_newton,
    ),
    Fault(
        "solvers.sloshing.forced",
        "walls.along @ force - slip**2",
        "walls.along @ force + slip**2",
        oracle.check_pressure_and_newton,
    ),
    Fault(
        "solvers.sloshing.forced",
        "= -(spin**2) * section",
        "= spin**2 * section",
        oracle.check_pressure_and_newton,
    ),
    Fault(
        "solvers.sloshing.forced",
        "0.5 * (circle @ FORWARD.conj())",
        "0.5 * (circle @ BACKWARD.conj())",
        oracle.check_force_on_the_ring,
    ),
    Fault(
        "fluid.friction",
        "np.sqrt(2.0 * np.asarray(viscosity",
        "np.sqrt(0.5 * np.asarray(viscosity",
        damping.test_layers,
    ),
    Fault(
        "fluid.friction",
        "(viscosity, twice - sigma), ",
        "(viscosity, twice + sigma), ",
        damping.check_plate_layer,
    ),
    Fault("fluid.friction", "2.0 * np.asarray(spin", "1.0 * np.asarray(spin", damping.check_plate_layer),
    Fault(
        "fluid.friction",
        "first * (k + c) + second * (k - c)",
        "first * (k - c) + second * (k + c)",
        damping.check_ring_by_hand,
    ),
    Fault("fluid.friction", "lost / (k + potential)", "lost / (2.0 * k)", damping.check_ring_by_hand),
    Fault(
        "fluid.friction",
        "1.0 / (1.0 + np.asarray(thickness",
        "1.0 / (0.0 + np.asarray(thickness",
        damping.check_edges,
    ),
    Fault(
        "solvers.sloshing.damping",
        "modes.spin / modes.frequency",
        "modes.frequency / modes.spin",
        damping.check_ring_by_hand,
    ),
    Fault(
        "solvers.sloshing.damping",
        "before[wall[:, 1]] = ",
        "before[wall[:, 0]] = ",
        damping.check_edges,
    ),
    Fault("solvers.sloshing.damping", "rate(once, g, g)", "rate(once, 2.0 * g, g)", damping.check_thin_layer),
    Fault("solvers.sloshing.damping", "< _BACK * size", "> -_BACK * size", damping.check_edges),
)
