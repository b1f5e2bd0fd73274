"""Whoever waits at a terminal sees what is done; a pipe sees the answer alone."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest

pty = pytest.importorskip("pty")

ROOT = Path(__file__).parents[4]
CHAMBER = ["--radius", "0.1", "--height", "0.05", "--volume", "1e-4", "--speed", "50"]
# What stands on the terminal while the command works.
SHOWN = {
    "run": (["run", str(ROOT / "examples" / "vertical_rig.toml")], ["self-excited whirl", "response to"]),
    "modes": (["modes", *CHAMBER], ["waves by finite elements", "damping"]),
    "map": (
        ["map", str(ROOT / "examples" / "vertical_rig.toml"), "--volumes", "21", "--speeds", "21"],
        ["preparing", "volumes", "edges of the bands"],
    ),
    "validate": (["validate", "errata"], ["errata"]),
    "layer": (
        ["layer", *CHAMBER, "--whirl-speed", "30", "--whirl-amplitude", "1e-3", "--model", "fem"],
        ["waves under the whirl"],
    ),
    "compare": (
        ["compare", str(ROOT / "examples" / "vertical_rig.toml"), "--models", "statics,linear"],
        ["response by several models"],
    ),
}


@pytest.mark.parametrize("name", SHOWN)
def test_progress(name: str, tmp_path: Path) -> None:
    arguments, wanted = SHOWN[name]
    terminal, end = pty.openpty()
    process = subprocess.Popen(
        [sys.executable, "-m", "leblanc", *arguments, "--json"],
        stdout=subprocess.PIPE,
        stderr=end,
        cwd=tmp_path,
        env=os.environ | {"TERM": "xterm", "PYTHONPATH": str(ROOT)},
    )
    os.close(end)
    seen: list[bytes] = []

    def read() -> None:
        try:
            while piece := os.read(terminal, 1 << 16):
                seen.append(piece)
        except OSError:  # the other end is closed
            pass

    reader = threading.Thread(target=read)
    reader.start()
    out, _ = process.communicate(timeout=300)
    reader.join()
    os.close(terminal)
    shown = b"".join(seen).decode()
    assert process.returncode == 0, shown
    assert isinstance(json.loads(out), dict)
    for words in wanted:
        assert words in shown


def test_nothing_is_shown_elsewhere(tmp_path: Path) -> None:
    """Without a terminal stderr has the closing line alone."""
    arguments = [*SHOWN["map"][0], "--json"]
    done = subprocess.run(
        [sys.executable, "-m", "leblanc", *arguments],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.stderr == "Vertical rig: 21 volumes by 21 speeds done\n"
