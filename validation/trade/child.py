"""`python -m validation.trade.child`: one case in a process of its own, for the memory it takes.

Reads a pickled scene and case on stdin, writes a pickled `Run` on stdout.
"""

from __future__ import annotations

import pickle
import sys
import time
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from validation.trade.evaluate import Run

_STATUS, _RESET = Path("/proc/self/status"), Path("/proc/self/clear_refs")


def resident() -> tuple[int, int]:
    """Memory that this process holds now and at most so far, bytes.

    Linux reports both and lets the second be set back. Elsewhere both are the most so far, which is all that
    the resource module knows; there a process also inherits the figure of the one that started it.
    """
    with suppress(OSError, KeyError, ValueError):
        lines = dict(line.split(":", 1) for line in _STATUS.read_text(encoding="ascii").splitlines())
        return tuple(1024 * int(lines[name].split()[0]) for name in ("VmRSS", "VmHWM"))  # type: ignore[return-value]
    import resource

    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)
    return most, most


def run(scene: Any, case: Any) -> Run:
    """Answer of a case with what it takes beyond a process that has everything loaded and compiled."""
    begin = time.process_time()
    from validation.trade.answers import answer, taste

    taste(scene, case)
    first = time.process_time() - begin
    with suppress(OSError):
        _RESET.write_text("5", encoding="ascii")  # sets the most so far to what is held now
    before = resident()[0]
    begin = time.process_time()
    found = answer(scene, case)
    taken = time.process_time() - begin
    memory = max(0, resident()[1] - before)
    from validation.trade.evaluate import Run

    return Run(found, (taken,), first, memory)


if __name__ == "__main__":
    pickle.dump(run(*pickle.load(sys.stdin.buffer)), sys.stdout.buffer)
