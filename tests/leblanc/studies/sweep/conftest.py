"""Fixtures of sweeps for all tests of this room."""

from __future__ import annotations

from tests.oracles.sweeps import quick as quick
