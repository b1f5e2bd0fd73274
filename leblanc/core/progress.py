"""What a command is doing while it takes its time, on stderr: a bar on a terminal, else a line now and then.

A study says how far it has come by `update`; who listens, if anybody does, is the business of who asked.
"""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from itertools import chain, repeat

from leblanc.core.interrupts import at_forced_end
from solvers.compiling import LISTENERS

_PAUSES = (2.0, 3.0, 5.0, 10.0, 20.0, 30.0)  # s, between lines where there is no terminal
_SHOW_CURSOR = b"\x1b[?25h\n"

Update = Callable[..., None]
_LISTENER: ContextVar[Update | None] = ContextVar("listener", default=None)


def update(done: float | None = None, total: float | None = None, what: str | None = None) -> None:
    """Say how far the work has come, in any unit, and what is done now; all may be left out."""
    listener = _LISTENER.get()
    if listener is not None:
        listener(done, total, what)


@contextmanager
def told(listener: Update) -> Iterator[None]:
    """Let a function of `done`, `total` and `what` hear the updates within the block."""
    token = _LISTENER.set(listener)
    try:
        yield
    finally:
        _LISTENER.reset(token)


def heard(progress: Callable[[float, float], object]) -> Update:
    """Listener that calls a function of what is done and of the total, where both are known."""

    def listener(done: float | None = None, total: float | None = None, what: str | None = None) -> None:
        if done is not None and total is not None:
            progress(done, total)

    return listener


class _Lines:
    """Lines about work that takes its time, where there is no terminal: the first soon, then ever fewer."""

    def __init__(self, what: str) -> None:
        self.what, self.share, self.begun = what, 0.0, time.monotonic()
        self.over = threading.Event()
        threading.Thread(target=self._tell, daemon=True, name="progress").start()

    def show(self, done: float | None = None, total: float | None = None, what: str | None = None) -> None:
        if done is not None and total:
            self.share = done / total
        elif what is not None:  # something else, of which it is not known how far it has come
            self.share = 0.0
        self.what = self.what if what is None else what

    def _tell(self) -> None:
        for pause in chain(_PAUSES, repeat(_PAUSES[-1])):
            if self.over.wait(pause):
                return
            spent = time.monotonic() - self.begun
            far = f", {100.0 * self.share:.0f} %" if self.share > 0.0 else ""
            left = f", about {spent * (1.0 / self.share - 1.0):.0f} s left" if self.share > 0.05 else ""
            with suppress(OSError, ValueError):  # nobody reads any more
                os.write(2, f"{self.what}, {spent:.0f} s{far}{left}\n".encode())


@contextmanager
def _compiling(what: str, show: Update) -> Iterator[Update]:
    """A listener that also says so while something is compiled, and then what is done as before."""
    now = [what]

    def shown(done: float | None = None, total: float | None = None, what: str | None = None) -> None:
        now[0] = now[0] if what is None else what
        show(done, total, what)

    def heard(begins: bool) -> None:
        show(what="compiling, once for this computer" if begins else now[0])

    LISTENERS.append(heard)
    try:
        yield shown
    finally:
        LISTENERS.remove(heard)


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
        lines = _Lines(what)
        try:
            with _compiling(what, lines.show) as show, told(show):
                yield show
        finally:
            lines.over.set()
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

            def show(done: float | None = None, total: float | None = None, what: str | None = None) -> None:
                # Something new is shown at once, however short it is.
                bar.update(task, completed=done, total=total, description=what, refresh=what is not None)

            with _compiling(what, show) as show_all, told(show_all):
                yield show_all
    finally:
        at_forced_end.remove(show_cursor)
