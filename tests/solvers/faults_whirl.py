"""Seeded faults of self-excited whirl."""

from __future__ import annotations

from tests.faults import Fault
from tests.solvers import test_whirl as oracle

ROOTS, SYSTEM, LAMINAR = "solvers.whirl.planar", "solvers.whirl.system", "solvers.whirl.laminar"
EDGES, WHIRL = "solvers.whirl.edges", "solvers.whirl.growth"

FAULTS: tuple[Fault, ...] = (
    # One plane: the polynomial.
    Fault(
        ROOTS,
        "damping=problem.damping / mass / spin",
        "damping=0.5 * problem.damping / mass / spin",
        oracle.check_characteristic_equation,
    ),
    Fault(ROOTS, "mass=1.0 + share.sum", "mass=1.0 - share.sum", oracle.check_characteristic_equation),
    Fault(
        ROOTS,
        "2.0 * problem.layer_tanh + 1j * problem.rate",
        "2.0 * problem.layer_tanh - 1j * problem.rate",
        oracle.check_characteristic_equation,
    ),
    Fault(
        ROOTS,
        "share * 0.5 * (1.0 - problem.layer_tanh)",
        "share * 0.5 * (1.0 + problem.layer_tanh)",
        oracle.check_characteristic_equation,
    ),
    Fault(ROOTS, "problem.stokes / np.sqrt(spin)", "problem.stokes / spin", oracle.check_laminar),
    Fault(ROOTS, "wave - drag * x * x * x, bend", "wave + drag * x * x * x, bend", oracle.check_laminar),
    Fault(ROOTS, "admitted = x.real > 0.0", "admitted = x.imag > 0.0", oracle.check_laminar),
    Fault(
        ROOTS,
        "np.where(admitted, -1j * np.square(x)",
        "np.where(admitted, 1j * np.square(x)",
        oracle.check_laminar,
    ),
    # Any rotor: the matrices.
    Fault(SYSTEM, "+= layer.mass * at.T @ at", "-= layer.mass * at.T @ at", oracle.check_synchronous),
    Fault(
        SYSTEM,
        "layer.mass / (0.5 * (1.0 - layer.layer_tanh))",
        "layer.mass / (0.5 * (1.0 + layer.layer_tanh))",
        oracle.check_characteristic_equation,
    ),
    Fault(SYSTEM, "rate * unit + 2.0", "rate * unit - 2.0", oracle.check_characteristic_equation),
    Fault(SYSTEM, "rate * spin * turn - (1.0", "-rate * spin * turn - (1.0", oracle.check_synchronous),
    Fault(
        SYSTEM,
        "- (1.0 + t) * np.square(spin) * unit",
        "- (1.0 - t) * np.square(spin) * unit",
        oracle.check_synchronous,
    ),
    Fault(SYSTEM, "spin * system.gyroscopic", "-spin * system.gyroscopic", oracle.check_cone),
    Fault(SYSTEM, "system.at(plane)\n        t, rate", "system.at(0.0)\n        t, rate", oracle.check_cone),
    Fault(
        SYSTEM,
        "np.where(along + least >= against, 1.0, -1.0)",
        "np.where(along + least >= against, -1.0, 1.0)",
        oracle.check_cone,
    ),
    # Any rotor, laminar.
    Fault(LAMINAR, "+ 1.5 * friction", "+ 1.0 * friction", oracle.check_laminar_derivative),
    Fault(LAMINAR, "2.0 - 4.0 * share", "2.0 - 2.0 * share", oracle.check_laminar_derivative),
    Fault(
        LAMINAR, "np.square(root) * (1.0 - share)", "np.square(root) * (1.0 + share)", oracle.check_any_rotor
    ),
    Fault(
        LAMINAR,
        "turned = root - 1j * sense * spin",
        "turned = root + 1j * sense * spin",
        oracle.check_any_rotor,
    ),
    Fault(LAMINAR, "share = 0.5 * (1.0 - t) * np", "share = 0.5 * (1.0 + t) * np", oracle.check_any_rotor),
    Fault(LAMINAR, "- (1.0 + t) * np.square(spin)", "- (1.0 - t) * np.square(spin)", oracle.check_any_rotor),
    Fault(LAMINAR, "(np.square(p) + 1j) * speed", "(np.square(p) - 1j) * speed", oracle.check_layer_waves),
    Fault(LAMINAR, "2j * t - rate", "2j * t + rate", oracle.check_layer_waves),
    Fault(LAMINAR, "0, 3] = -t", "0, 3] = t", oracle.check_layer_waves),
    Fault(
        LAMINAR, "-layer.stokes / np.sqrt(speed)", "layer.stokes / np.sqrt(speed)", oracle.check_layer_waves
    ),
    # Which mode, and the edges.
    Fault(WHIRL, "-np.inf, -omega.imag)", "-np.inf, omega.imag)", oracle.check_published_bands),
    Fault(WHIRL, "modes.slip + problem.spin", "modes.slip - problem.spin", oracle.check_time),
    Fault(WHIRL, "mass += fill.mass", "mass -= fill.mass", oracle.check_limits),
    Fault(WHIRL, "heavy.mass + fill.mass * at.T", "heavy.mass - fill.mass * at.T", oracle.check_limits),
    Fault(EDGES, "top - share * ratio**2", "top + share * ratio**2", oracle.check_refined_edges),
    Fault(EDGES, "(2.0 * top + ratio", "(1.0 * top + ratio", oracle.check_refined_edges),
    Fault(EDGES, "stiffness / needed[needed", "needed[needed", oracle.check_refined_edges),
    Fault(EDGES, "-2.0 * layer.layer_tanh, 1.0", "2.0 * layer.layer_tanh, 1.0", oracle.check_refined_edges),
    Fault(EDGES, "(rates > 0.0) != first", "(rates > 0.0) == first", oracle.check_edges_with_friction),
    Fault(EDGES, "np.divide(at_a, at_a - at_b", "np.divide(at_b, at_a - at_b", oracle.check_edge_steps),
    Fault(
        EDGES,
        "np.concatenate([edges, 0.5 * (",
        "np.concatenate([0.1 * edges, 0.1 * (",
        oracle.check_thin_film,
    ),
)
