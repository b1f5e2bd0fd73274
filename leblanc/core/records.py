"""Records of an answer, whatever they are made of: alike or not, and not to be changed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np


def seal(answer: Any) -> None:
    """Make the arrays of an answer read-only, those of its records as well."""
    for array in _arrays(answer, set()):
        array.flags.writeable = False


def _arrays(value: Any, seen: set[int]) -> Iterator[np.ndarray[Any, Any]]:
    if isinstance(value, np.ndarray):
        yield value
        return
    if id(value) in seen:
        return
    seen.add(id(value))
    for part in _parts(value):
        yield from _arrays(part, seen)


def _parts(value: Any) -> Iterator[Any]:
    if is_dataclass(value) and not isinstance(value, type):
        yield from (getattr(value, each.name) for each in fields(value))
    elif isinstance(value, Mapping):
        yield from value.values()
    elif isinstance(value, list | tuple):
        yield from value


def alike(one: Any, other: Any) -> bool:
    """Whether two values are equal, arrays element by element and nan to nan, records field by field."""
    if one is other:
        return True
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        if type(one) is not type(other) or one.dtype.kind != other.dtype.kind or one.shape != other.shape:
            return False
        if one.dtype.kind in "fc":
            return np.array_equal(one, other, equal_nan=True)
        return all(map(alike, one.ravel().tolist(), other.ravel().tolist()))
    if type(one) is not type(other):
        return False
    if is_dataclass(one) and not isinstance(one, type):
        names = [each.name for each in fields(one) if each.compare]
        return all(alike(getattr(one, name), getattr(other, name)) for name in names)
    if isinstance(one, Mapping):
        return one.keys() == other.keys() and all(alike(one[key], other[key]) for key in one)
    if isinstance(one, list | tuple):
        return len(one) == len(other) and all(map(alike, one, other))
    if isinstance(one, float | complex):
        return bool(one == other) or (one != one and other != other)
    return bool(one == other)
