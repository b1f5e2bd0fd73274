"""Quantities of an answer, read from its declarations; its JSON and its named arrays made from them."""

from __future__ import annotations

import builtins
import math
import sys
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any, get_args, get_origin

import numpy as np

from leblanc.core.netcdf import NamedArrays, Variable, flags, variable
from leblanc.core.notes import Note
from meshes.quantity import Q


class _Names(dict[str, Any]):
    """Names of a module; one that only a type checker imports stands for any type."""

    def __missing__(self, name: str) -> Any:
        return getattr(builtins, name, Any)


_Declared = dict[str, tuple[Q, tuple[type, ...]]]
_FOUND: dict[type, _Declared] = {}


def quantities(kind: type) -> Mapping[str, Q]:
    """Declared quantities of an answer by name: those of its bases first, fields before properties."""
    return {name: q for name, (q, _) in _declared(kind).items()}


def part_with(kind: type, name: str) -> str | None:
    """The part of an answer whose record declares a quantity; None where none does."""
    for part, (q, types) in _declared(kind).items():
        if q.part and any(name in quantities(one) or part_with(one, name) for one in types):
            return part
    return None


def _declared(kind: type) -> _Declared:
    """The same with the classes that stand in its type; read once a class."""
    if kind in _FOUND:
        return _FOUND[kind]
    found: _Declared = {}
    for base in reversed(kind.__mro__):
        written: dict[str, Any] = dict(vars(base).get("__annotations__", {}))
        for name, value in vars(base).items():
            if isinstance(value, property) and value.fget is not None:
                said_of = getattr(value.fget, "__annotations__", {})  # none of what `carried` makes
                written[name] = said_of.get("return", "")
        names = _Names(vars(sys.modules[base.__module__]))
        for name, hint in written.items():
            said: Any = eval(hint, {}, names) if isinstance(hint, str) and "Q(" in hint else hint
            if get_origin(said) is Annotated:
                what, *beside = get_args(said)
                types = tuple(one for one in (what, *get_args(what)) if isinstance(one, type))
                found |= [(name, (each, types)) for each in beside if isinstance(each, Q)]
    _FOUND[kind] = found
    return found


def plain(value: Any) -> Any:
    """A value as JSON knows it: complex numbers as [re, im], None for what is not finite, notes as texts."""
    if value is None or isinstance(value, str | bool | int):
        return value
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, complex):
        return [plain(value.real), plain(value.imag)]
    if isinstance(value, Mapping):
        return {str(key): plain(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [plain(each) for each in value]
    if isinstance(value, Note):
        return value.text
    if is_dataclass(value) and not isinstance(value, type):
        return to_json(value)
    if hasattr(value, "tolist"):  # arrays and their scalars
        return plain(value.tolist())
    if isinstance(value, Path):
        return str(value)
    raise TypeError(f"{type(value).__name__} has no form in JSON")


def to_json(record: Any) -> dict[str, Any]:
    """Declared quantities of a record by name, all fields of one that declares none."""
    declared = quantities(type(record))
    if not declared:
        return {field.name: plain(getattr(record, field.name)) for field in fields(record)}
    found: dict[str, Any] = {}
    for name, q in declared.items():
        value = getattr(record, name)
        if q.json and not (q.part and value is None):
            found |= to_json(value) if q.part else {name: plain(value)}
    return found


def named_arrays(record: Any, attrs: Mapping[str, Any] = MappingProxyType({})) -> NamedArrays:
    """Declared quantities that have a unit or states, over their dimensions; complex ones in two parts."""
    arrays: dict[str, Variable] = {}
    coordinates: dict[str, Variable] = {}
    for name, q, value in _with_parts(record):
        if not q.data or not (q.unit or q.flags) or (value is None and q.over):
            continue
        place = coordinates if q.coordinate or q.over == (name,) else arrays
        place |= _variables(q.variable or name, q, math.nan if value is None else value)
    return NamedArrays(arrays, coordinates, attrs)


def _with_parts(record: Any) -> Iterator[tuple[str, Q, Any]]:
    """Quantities of a record, of its parts, and of the records in rows."""
    for name, q in quantities(type(record)).items():
        value = getattr(record, name)
        if not q.data or (value is None and (q.part or q.rows)):
            continue
        if q.part:
            yield from _with_parts(value)
        elif q.rows:
            for inner, each in quantities(type(value[0])).items() if value else ():
                column = np.array([getattr(row, inner) for row in value])
                yield f"{q.rows}_{inner}", replace(each, over=(q.rows, *each.over), variable=""), column
        else:
            yield name, q, value


def _variables(name: str, q: Q, value: Any) -> dict[str, Variable]:
    if q.over and isinstance(value, tuple):  # with None for what is not there
        value = np.array([math.nan if one is None else one for one in value])
    if q.flags:
        return {name: flags(q.over, np.asarray(value), q.flags, q.name, q.text)}
    if q.axes is None:
        return {name: variable(q.over, value, q.unit, q.name, q.text)}
    values = np.asarray(value)
    return {
        f"{name}_{part}": variable(q.over, getattr(values, part), q.unit, f"{q.name}, {where}", q.text)
        for part, where in zip(("real", "imag"), q.axes, strict=True)
    }
