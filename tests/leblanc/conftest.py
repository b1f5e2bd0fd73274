"""Fixtures for all tests of this room."""

from __future__ import annotations

from tests.oracles.blocks import undrawn as undrawn
