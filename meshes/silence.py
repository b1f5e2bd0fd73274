"""Keep what compiled libraries print off the terminal."""

from __future__ import annotations

import contextlib
import ctypes
import os
import sys
from collections.abc import Iterator


@contextlib.contextmanager
def silenced() -> Iterator[None]:
    """Send what the whole process prints on its standard output into the void.

    Libraries such as OpenCASCADE write there without asking, below Python's own streams. For the time being
    other threads are silent as well.
    """
    try:
        kept = os.dup(1)
    except OSError:  # there is no standard output
        yield
        return
    _flush()
    void = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(void, 1)
        yield
    finally:
        _flush()
        os.dup2(kept, 1)
        os.close(void)
        os.close(kept)


def _flush() -> None:
    """Empty the buffers of Python and of the C library, so that each text goes where it belongs."""
    with contextlib.suppress(AttributeError, ValueError):  # a stream that is missing or closed
        sys.stdout.flush()
    with contextlib.suppress(OSError, TypeError, AttributeError):  # where the C library has no common name
        ctypes.CDLL(None).fflush(None)
