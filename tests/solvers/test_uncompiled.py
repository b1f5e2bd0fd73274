"""Seeded faults in what numba compiles, in a process in which it compiles nothing."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize(
    "name",
    [
        *(
            "layer/uncompiled_layer",
            "layer/uncompiled_drag",
            "layer/uncompiled_baffles",
            "layer/uncompiled_inside",
            "runup/uncompiled_balls",
            "runup/uncompiled_long_wave",
            "runup/uncompiled_linear",
            "runup/uncompiled_pool",
            "statics/uncompiled_statics",
        ),
    ],
)
def test_compiled_lines_are_held_by_oracles(name: str) -> None:
    chosen = [f"tests/solvers/{name}.py", "-q", "-n", "0", "-p", "no:cacheprovider"]
    done = subprocess.run(
        [sys.executable, "-m", "pytest", *chosen],
        cwd=ROOT,
        env=os.environ | {"NUMBA_DISABLE_JIT": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout[-4000:]
