"""Every seeded fault is caught by its oracle, and every oracle passes without it."""

from __future__ import annotations

import importlib
from pathlib import Path

import pytest

from tests.faults import Fault, seeded

_HERE = Path(__file__).parent


def _all_faults() -> list[Fault]:
    names = sorted(p.relative_to(_HERE.parent).with_suffix("") for p in _HERE.glob("*/faults_*.py"))
    return [f for name in names for f in importlib.import_module(".".join(name.parts)).FAULTS]


FAULTS = _all_faults()


@pytest.mark.parametrize("fault", FAULTS, ids=str)
def test_fault_is_caught(fault: Fault) -> None:
    with seeded(fault), pytest.raises((AssertionError, ArithmeticError)):
        fault.oracle()


@pytest.mark.parametrize(
    "oracle", dict.fromkeys(f.oracle for f in FAULTS), ids=lambda o: f"{o.__module__}.{o.__name__}"
)
def test_oracle_passes_without_fault(oracle) -> None:  # type: ignore[no-untyped-def]
    oracle()
