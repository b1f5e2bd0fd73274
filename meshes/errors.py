"""Checks at the border: bad input is named with its field, its value and what is allowed."""

from __future__ import annotations

import math


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
        super().__init__(f"{field} = {value!r}: must be {allowed}")
        self.field = field
        self.value = value
        self.allowed = allowed


def require_positive(field: str, value: float) -> None:
    """Raise `InputError` unless `value` is finite and above zero."""
    if not (math.isfinite(value) and value > 0.0):
        raise InputError(field, value, "a finite number above 0")


def require_not_negative(field: str, value: float) -> None:
    """Raise `InputError` unless `value` is finite and zero or above."""
    if not (math.isfinite(value) and value >= 0.0):
        raise InputError(field, value, "a finite number, 0 or above")
