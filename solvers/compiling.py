"""Who hears what is compiled: once for a computer, for which a first command takes longer than later ones."""

from __future__ import annotations

from collections.abc import Callable

#: Functions that are called with True as something begins to be compiled and with False as it is done.
LISTENERS: list[Callable[[bool], object]] = []


#: Processor times of what this process has compiled, s.
SPENT: list[float] = []


def tell(begins: bool) -> None:
    """Let everybody hear that something begins to be compiled, or is done."""
    for listener in tuple(LISTENERS):
        listener(begins)
