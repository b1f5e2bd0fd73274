"""Machines with balls asked twice: every input off by 1e-10 of itself must not change what is answered."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import pytest

from leblanc.scene.scene import Scene
from leblanc.studies.balls.study import run_balls
from tests.oracles.machines import Table
from tests.oracles.random_balls import machine_with_balls, nudged_balls

# The machines of a slow run.
COUNT, FIRST = int(os.environ.get("METAMORPHIC_COUNT", "200")), int(os.environ.get("METAMORPHIC_FIRST", "0"))
SIZE = 1e-10
# What an answer may move by: a thousand times the change, of its scale (spin, bare amplitude, a turn).
ALLOWED = 1e3 * SIZE
# A machine next to a fold, or to roots that meet, is sensitive to its inputs: there as much as a change a
# thousand times as large does. A jump by chance is as large for both, and larger than the next.
COARSE, MOST = 1e3 * SIZE, 1e-3


def told(table: Table) -> dict[str, Any]:
    """Discrete and continuous answers of `run`, the latter over their scales."""
    result = run_balls(Scene(**table))
    states, speed = result.states, result.speed[:, None]
    bare = np.nanmax(result.amplitude_without)
    assert result.growth_range is not None
    return {
        "discrete": [
            states.kind.tolist(),
            states.stable.tolist(),
            states.dimension.tolist(),
            result.state.tolist(),
            result.stable.tolist(),
            result.elsewhere.tolist(),
            result.can_balance,
        ],
        "growth": states.growth / speed,
        "growth_range": result.growth_range / speed,
        "amplitude": result.sizes / bare,
        "places": np.exp(1j * states.places),
    }


def changed_by(table: Table, seed: int) -> list[str]:
    """What differs more than it may."""
    whole, small = told(table), told(nudged_balls(table, seed, SIZE))
    if whole["discrete"] != small["discrete"]:
        return [
            f"{a} became {b}" for a, b in zip(whole["discrete"], small["discrete"], strict=True) if a != b
        ]
    coarse: dict[str, Any] | None = None
    found = []
    for key in ("growth", "growth_range", "amplitude", "places"):
        off = float(np.nanmax(np.abs(whole[key] - small[key]), initial=0.0))
        if off <= ALLOWED:
            continue
        coarse = coarse or told(nudged_balls(table, seed, COARSE))
        alike = coarse["discrete"] == whole["discrete"]
        scale = float(np.nanmax(np.abs(whole[key] - coarse[key]), initial=0.0)) if alike else 0.0
        if off > min(0.5 * scale, MOST):
            found.append(f"{key} by {off:.1e}; by {scale:.1e} for {COARSE:g}")
    return found


@pytest.mark.parametrize("seed", [0, 1, 4, 7, 9, 92])
def test_a_few_machines_with_balls(seed: int) -> None:
    assert changed_by(machine_with_balls(seed), seed) == []


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(FIRST, FIRST + COUNT))
def test_many_machines_with_balls(seed: int) -> None:
    assert changed_by(machine_with_balls(seed), seed) == []
