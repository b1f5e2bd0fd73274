"""Who hears what is compiled: once for a computer, for which a first command takes longer than later ones."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

#: Functions that are called with True as something begins to be compiled and with False as it is done.
LISTENERS: list[Callable[[bool], object]] = []


#: Processor times of what this process has compiled, s.
SPENT: list[float] = []


def tell(begins: bool) -> None:
    """Let everybody hear that something begins to be compiled, or is done."""
    for listener in tuple(LISTENERS):
        listener(begins)


def with_room(function: Callable[..., Any], *given: Any) -> Any:
    """Call a function with room for all the frames that it will stack.

    CPython keeps frames in pieces of 16 kB. Where a loop calls across the end of one, each call asks the
    system for the next and gives it back, which took a sixth of the time to compile.
    """
    return function(*given)


# A frame of half a megabyte has a piece of a megabyte, and the rest of it is for those that it calls.
with_room.__code__ = with_room.__code__.replace(co_stacksize=70_000)
