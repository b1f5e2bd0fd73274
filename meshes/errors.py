"""Checks at the border: bad input is named with its field, its value and what is allowed."""

from __future__ import annotations

import math
from enum import Enum

MOST_NODES = 1_000_000  # of a mesh


class InputError(ValueError):
    """A value that a model cannot take.

    Parameters
    ----------
    field : name of the argument, as the user knows it
    value : what was given
    allowed : the permitted range, in words

    Examples
    --------
    >>> require_positive("radius", -0.1)
    Traceback (most recent call last):
        ...
    meshes.errors.InputError: radius = -0.1: must be a finite number above 0
    """

    def __init__(self, field: str, value: object, allowed: str) -> None:
        given = value.value if isinstance(value, Enum) else value
        super().__init__(f"{field} = {given!r}: must be {allowed}")
        self.field = field
        self.value = value
        self.allowed = allowed

    def __reduce__(self) -> tuple[type[InputError], tuple[str, object, str]]:
        """Comes whole out of another process."""
        return type(self), (self.field, self.value, self.allowed)


def require_positive(field: str, value: float) -> None:
    """Raise `InputError` unless `value` is finite and above zero."""
    if not (math.isfinite(value) and value > 0.0):
        raise InputError(field, value, "a finite number above 0")


def require_few_nodes(field: str, value: object, nodes: float) -> None:
    """Raise `InputError` for a mesh of more than `MOST_NODES` nodes, which asks before it is made."""
    if not nodes <= MOST_NODES:
        asked = f"{nodes:.1e}" if math.isfinite(nodes) else "endless"
        raise InputError(field, value, f"such that the mesh has at most a million nodes, not about {asked}")


def require_not_negative(field: str, value: float) -> None:
    """Raise `InputError` unless `value` is finite and zero or above."""
    if not (math.isfinite(value) and value >= 0.0):
        raise InputError(field, value, "a finite number, 0 or above")
