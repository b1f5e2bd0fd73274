"""Seeded faults in what numba compiles, in a process in which it compiles nothing."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("folder", ["layer", "runup", "statics", "whirl"])
def test_compiled_lines_are_held_by_oracles(folder: str) -> None:
    files = [str(file) for file in sorted((ROOT / "tests/solvers" / folder).glob("uncompiled_*.py"))]
    assert files
    chosen = [*files, "-q", "-n", "0", "-p", "no:cacheprovider"]
    done = subprocess.run(
        [sys.executable, "-m", "pytest", *chosen],
        cwd=ROOT,
        env=os.environ | {"NUMBA_DISABLE_JIT": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout[-4000:]
