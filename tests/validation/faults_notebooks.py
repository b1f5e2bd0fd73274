"""Seeded faults of the comparisons made for the notebooks."""

from __future__ import annotations

from tests.faults import Fault
from tests.validation import test_notebooks_cases as oracle

OPTIMUM, TUB, WAVE = "validation.cases.fill_optimum", "validation.cases.tub", "validation.figures.layer"

FAULTS: tuple[Fault, ...] = (
    Fault(OPTIMUM, "rotor.mass + fill.full_mass", "rotor.mass + fill.mass", oracle.check_closed_forms),
    Fault(OPTIMUM, "rotor.damping * speed", "rotor.damping", oracle.check_closed_forms),
    Fault(OPTIMUM, "rotor.unbalance * speed**2", "rotor.unbalance * speed", oracle.check_closed_forms),
    Fault(OPTIMUM, "form.full_volume", "form.optimal_volume", oracle.check_closed_forms),
    Fault(TUB, "1800e-6 /", "1800e-3 /", oracle.check_measured_amplitude),
    Fault(WAVE, "1e3 * (depth - np.array(run[key]))", "depth - np.array(run[key])", oracle.check_summary),
    Fault(WAVE, "np.argmax(np.abs(one))", "np.argmin(np.abs(one))", oracle.check_summary),
)
