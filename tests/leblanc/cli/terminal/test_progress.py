"""Whoever waits at a terminal sees what is done; a pipe sees the answer alone."""

from __future__ import annotations

import json
import os
import sys
import threading
from contextlib import suppress
from pathlib import Path

import pytest

from leblanc.cli import main

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
        ["response by statics"],
    ),
}


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize("name", SHOWN)
def test_progress(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    arguments, wanted = SHOWN[name]
    terminal, end = pty.openpty()
    seen: list[bytes] = []

    def read() -> None:
        with suppress(OSError):  # the other end is closed
            while piece := os.read(terminal, 1 << 16):
                seen.append(piece)

    reader = threading.Thread(target=read)
    reader.start()
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("TERM", "xterm")
    with os.fdopen(end, "w") as stream, monkeypatch.context() as patch:
        patch.setattr(sys, "stderr", stream)
        code = main([*arguments, "--json"])
    reader.join()
    os.close(terminal)
    shown = b"".join(seen).decode()
    assert code == 0, shown
    assert isinstance(json.loads(capsys.readouterr().out), dict)
    for words in wanted:
        assert words in shown


@pytest.mark.usefixtures("undrawn")
def test_nothing_is_shown_elsewhere(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Without a terminal stderr has the closing line alone."""
    assert main([*SHOWN["map"][0], "--json", "--out", str(tmp_path)]) == 0
    assert capsys.readouterr().err == "Vertical rig: 21 volumes by 21 speeds done\n"
