"""Ctrl-C and SIGTERM: heard within a second at any moment, and no file is left half written.

Python hears a signal between two of its own instructions. Where compiled code of a library keeps it from that
for longer, a thread ends the process in its place.
"""

from __future__ import annotations

import atexit
import math
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from types import FrameType
from typing import NoReturn

INTERRUPTED, TERMINATED = 128 + signal.SIGINT, 128 + signal.SIGTERM
_SAID = {signal.SIGINT: "leblanc: interrupted", signal.SIGTERM: "leblanc: terminated"}
_PATIENCE = 0.8  # seconds that Python has to hear a signal itself
_AGAIN = 0.05  # seconds until what was dropped is raised once more


class Terminated(SystemExit):
    """Raised by SIGTERM, as KeyboardInterrupt is by SIGINT."""


class _Ears:
    """What the main thread has heard.

    Parameters
    ----------
    handler : of its signals
    last : when it was called the last time, s
    closed : it listens no longer
    """

    def __init__(self) -> None:
        self.handler: Callable[..., None] | None = None
        self.last = -math.inf
        self.closed = threading.Event()

    def open(self, number: int) -> bool:
        """Whether a signal is for this handler, or one that passes it on, and not for that of a library."""
        found = signal.getsignal(number)
        return callable(found) and getattr(found, "__wrapped__", found) is self.handler


class _Holding:
    """Whether interrupts wait for a library, and the number of the one that does."""

    depth, number = 0, 0


class _Stopping:
    """Whether somebody keeps what it has at an interrupt of either kind, and whether it was SIGTERM."""

    depth, terminated = 0, False


# What is to be done before the process is ended from another thread: files removed that are half written.
at_forced_end: list[Callable[[], object]] = []


@contextmanager
def heard() -> Iterator[None]:
    """Hear Ctrl-C as KeyboardInterrupt and SIGTERM as `Terminated`, within a second, as long as this lasts.

    After `_PATIENCE` in compiled code the process is ended with the exit code that they have. A process that
    ignores the one or the other from its start goes on doing so. Nothing outside of the main thread.
    """
    if threading.current_thread() is not threading.main_thread() or os.name != "posix":
        yield
        return
    ears, complain = _Ears(), sys.unraisablehook

    def note(number: int, frame: FrameType | None) -> None:
        if _Holding.depth:
            _Holding.number = number
            return
        ears.last = time.monotonic()
        if number == signal.SIGTERM and _Stopping.depth:
            _Stopping.terminated = True
            raise KeyboardInterrupt
        raise KeyboardInterrupt if number == signal.SIGINT else Terminated(TERMINATED)

    def raise_again(what: sys.UnraisableHookArgs) -> None:
        # Python drops what is raised while it destroys an object, or within a library's callback.
        if not issubclass(what.exc_type, KeyboardInterrupt | Terminated):
            complain(what)
            return
        number = signal.SIGTERM if issubclass(what.exc_type, Terminated) else signal.SIGINT
        # A true signal, since it ends the wait for a lock as well.
        timer = threading.Timer(_AGAIN, signal.pthread_kill, [threading.main_thread().ident, number])
        timer.daemon = True
        timer.start()

    reader, writer = os.pipe()
    os.set_blocking(writer, False)
    try:
        with given_back():
            for number in _SAID:
                if signal.getsignal(number) is not signal.SIG_IGN:
                    signal.signal(number, note)
            sys.unraisablehook = raise_again
            signal.set_wakeup_fd(writer, warn_on_full_buffer=False)
            ears.handler = note
            threading.Thread(target=_watch, args=(reader, ears), daemon=True, name="interrupts").start()
            try:
                yield
            finally:
                ears.closed.set()
    finally:
        os.close(writer)  # ends the thread
        sys.unraisablehook = complain


@contextmanager
def held() -> Iterator[None]:
    """Raise no interrupt inside of a library that breaks by one: it is raised after it.

    The process is ended as by compiled code where that takes too long.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    _Holding.depth += 1
    try:
        yield
    finally:
        _Holding.depth -= 1
        number = _Holding.number
        if number and not _Holding.depth:
            _Holding.number = 0
            signal.raise_signal(number)


@contextmanager
def stopping() -> Iterator[None]:
    """Hear SIGTERM as KeyboardInterrupt: who works inside keeps what it has at either.

    `raise_stopped` then ends the command as the signal that came.
    """
    _Stopping.depth += 1
    try:
        yield
    finally:
        _Stopping.depth -= 1


def raise_stopped() -> NoReturn:
    """The interrupt at which a command kept what it had, once that is written."""
    raise Terminated(TERMINATED) if _Stopping.terminated else KeyboardInterrupt


@contextmanager
def given_back() -> Iterator[None]:
    """Hear signals after it as before, though a library has put its own handlers in and left them there."""
    if threading.current_thread() is not threading.main_thread() or os.name != "posix":
        yield
        return
    before = {number: signal.getsignal(number) for number in _SAID}
    waker = signal.set_wakeup_fd(-1)
    signal.set_wakeup_fd(waker, warn_on_full_buffer=False)
    try:
        yield
    finally:
        for number, handler in before.items():
            if handler is not None:  # it was not put in by Python
                signal.signal(number, handler)
        signal.set_wakeup_fd(waker, warn_on_full_buffer=False)


def behind(error: BaseException) -> KeyboardInterrupt | Terminated | None:
    """The interrupt that compiled code has made another error of, if there is one."""
    found: BaseException | None = error
    seen: set[int] = set()  # errors that are raised again may stand behind each other
    while found is not None and not isinstance(found, KeyboardInterrupt | Terminated):
        seen.add(id(found))
        found = found.__cause__ or found.__context__
        found = None if id(found) in seen else found
    return found


def _watch(reader: int, ears: _Ears) -> None:
    """Wait for signals, and end the process where the main thread does not hear one."""
    with open(reader, "rb", buffering=0) as signals:
        while number := signals.read(1):
            if number[0] not in tuple(_SAID):
                continue
            came = time.monotonic()
            # Its handler may have been quicker than this thread.
            while not ears.closed.wait(_AGAIN) and ears.last < came - _PATIENCE / 2.0:
                if time.monotonic() > came + _PATIENCE and ears.open(number[0]):
                    _end(number[0])


def _end(number: int) -> NoReturn:
    """End the process as its main thread would have done."""
    try:
        for action in at_forced_end:
            action()
        os.write(2, f"{said(number)}\n".encode())
    finally:  # be it that nobody reads any more
        os._exit(128 + number)


def said(number: int) -> str:
    """What is said of a signal."""
    return _SAID[signal.Signals(number)]


def leave(code: int) -> None:
    """Let nothing that comes while Python takes itself down bring a traceback or another exit code.

    Parameters
    ----------
    code : with which the process is to end; after a signal it does so here, without waiting for threads
    """
    if threading.current_thread() is threading.main_thread():
        for number in _SAID:
            if callable(signal.getsignal(number)):
                signal.signal(number, signal.SIG_DFL)
    if code in (INTERRUPTED, TERMINATED):
        # Python itself would end by SIGINT if the interrupt came through an `exec`, though it was caught.
        # Libraries complain of what they were not let finish.
        sys.unraisablehook = lambda _: None
        if "logging" in sys.modules:
            sys.modules["logging"].disable()
        atexit._run_exitfuncs()
        for stream in (sys.stdout, sys.stderr):
            with suppress(OSError, ValueError):
                stream.flush()
        os._exit(code)
