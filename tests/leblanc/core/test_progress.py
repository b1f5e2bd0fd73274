"""What a command says while it takes its time, where there is no terminal, and of what is compiled."""

from __future__ import annotations

import os
import threading

import pytest

from leblanc.core import progress
from solvers.compiling import tell
from tests.mutants import kills


class Clock:
    """Waits that are over at once, some of them; the work then is."""

    def __init__(self, count: int) -> None:
        self.left, self.pauses = count, list[float]()

    def wait(self, pause: float) -> bool:
        self.pauses.append(pause)
        self.left -= 1
        return self.left < 0


@kills("leblanc.core.progress:_Lines._tell", "1.0 / self.share - 1.0", "1.0 / self.share")
@kills("leblanc.core.progress:_Lines.show", "self.share = 0.0", "pass")
def test_lines_about_work(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is done, how long by now, how far and how much is left; something new begins without a share."""
    written: list[bytes] = []
    now = iter([0.0, 2.0, 10.0, 30.0])
    monkeypatch.setattr(progress.time, "monotonic", lambda: next(now))
    monkeypatch.setattr(os, "write", lambda stream, text: written.append(text) if stream == 2 else None)
    monkeypatch.setattr(threading.Thread, "start", lambda _: None)
    lines = progress._Lines("searching")
    said = []
    for share in (None, 0.25, 0.0):
        if share:
            lines.show(share, 1.0, "40 sets")
        elif share == 0.0:
            lines.show(what="trade-off")
        lines.over = Clock(1)  # type: ignore[assignment]
        lines._tell()
        said.append(written.pop().decode())
    assert said == ["searching, 2 s\n", "40 sets, 10 s, 25 %, about 30 s left\n", "trade-off, 30 s\n"]


@kills("leblanc.core.progress:_compiling", "if begins else now[0]", "if begins else what")
@kills("leblanc.core.progress:_compiling", "LISTENERS.remove(heard)", "pass")
def test_what_is_compiled_is_said_and_then_what_was_done_before() -> None:
    said: list[str | None] = []

    def show(done: float | None = None, total: float | None = None, what: str | None = None) -> None:
        said.append(what)

    with progress._compiling("reading", show) as update:
        update(what="running up")
        tell(True)
        tell(False)
    tell(True)
    assert said == ["running up", "compiling, once for this computer", "running up"]
