"""Fixtures for all tests of this room."""

from __future__ import annotations

from functools import cache
from typing import Any

import pytest

from tests.oracles.blocks import undrawn as undrawn


@cache
def _critical_speed(*given: Any) -> Any:
    from solvers.rotor.exciter.motion import critical_speed

    return critical_speed(*given)


@pytest.fixture
def _exciter_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """The critical speed of an exciter is sought in time once for all tests of what is said of it."""
    monkeypatch.setattr("leblanc.wings.exciter.study.critical_speed", _critical_speed)
