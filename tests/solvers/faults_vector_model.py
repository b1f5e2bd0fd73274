"""Seeded faults of the vector model."""

from tests.faults import Fault
from tests.solvers.rotor import test_vector_model as oracle

_MODULE = "solvers.rotor.vector_model"

FAULTS: tuple[Fault, ...] = (
    Fault(_MODULE, "k - m * np.square(omega)", "k + m * np.square(omega)", oracle.assert_lag),
    Fault(_MODULE, "k * np.sin(alpha - delta)", "k * np.sin(alpha + delta)", oracle.assert_jeffcott),
    Fault(_MODULE, "+ k * np.cos(alpha - delta)", "- k * np.cos(alpha - delta)", oracle.assert_jeffcott),
    # The source's own erratum: the factor 1/k lost.
    Fault(_MODULE, "np.arcsin(np.sin(delta) / k)", "np.arcsin(np.sin(delta))", oracle.assert_jeffcott),
    Fault(
        _MODULE,
        "delta + np.pi - inner",
        "delta - np.pi - 2.0 * inner",
        oracle.assert_second_root_between_the_critical_speeds,
    ),
    Fault(_MODULE, "k * np.sin(alpha)) / k)", "k * np.sin(alpha)))", oracle.assert_jeffcott),
)
