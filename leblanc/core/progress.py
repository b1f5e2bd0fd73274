"""What a command is doing while it takes its time: on stderr, on a terminal only."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from leblanc.core.interrupts import at_forced_end

_SHOW_CURSOR = b"\x1b[?25h\n"

Update = Callable[..., None]


@contextmanager
def working(what: str) -> Iterator[Update]:
    """Show what is done, for how long by now, and how far it has come where that is known.

    Parameters
    ----------
    what : is done first

    Yields
    ------
    Function of `done` and `total`, in any unit, and of `what` is done now; all may be left out
    """
    if not sys.stderr.isatty():
        yield lambda *_, **__: None
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        Progress,
        SpinnerColumn,
        TaskProgressColumn,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    columns = (
        *(SpinnerColumn(), TextColumn("{task.description}"), BarColumn(), TaskProgressColumn()),
        *(TimeElapsedColumn(), TextColumn("left"), TimeRemainingColumn()),
    )

    def show_cursor() -> None:
        os.write(2, _SHOW_CURSOR)

    at_forced_end.append(show_cursor)
    try:
        with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
            task = bar.add_task(what, total=None)

            def update(
                done: float | None = None, total: float | None = None, what: str | None = None
            ) -> None:
                # Something new is shown at once, however short it is.
                bar.update(task, completed=done, total=total, description=what, refresh=what is not None)

            yield update
    finally:
        at_forced_end.remove(show_cursor)
