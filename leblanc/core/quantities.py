"""Quantities of an answer, read from its declarations; its JSON and its named arrays made from them."""

from __future__ import annotations

import cmath
import math
import re
import sys
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from itertools import pairwise
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any, get_args, get_origin

import numpy as np

from leblanc.core.netcdf import NamedArrays, Variable, finite, flags, variable
from leblanc.core.notes import Note
from leblanc.core.question import Names
from leblanc.core.units import is_unit
from meshes.errors import InputError
from meshes.quantity import Q


@dataclass(frozen=True)
class _Declared:
    """A quantity as it is declared: by which attribute, what, of which classes."""

    attribute: str
    q: Q
    types: tuple[type, ...]


_FOUND: dict[type, dict[str, _Declared]] = {}


def quantities(kind: type) -> Mapping[str, Q]:
    """Declared quantities of an answer by public name: those of its bases first, fields before properties."""
    return {key: each.q for key, each in _declared(kind).items()}


def _declared(kind: type) -> dict[str, _Declared]:
    """Declarations by public name; read once a class."""
    if kind in _FOUND:
        return _FOUND[kind]
    found: dict[str, _Declared] = {}
    for base in reversed(kind.__mro__):
        written: dict[str, Any] = dict(vars(base).get("__annotations__", {}))
        for name, value in vars(base).items():
            if isinstance(value, property) and value.fget is not None:
                said_of = getattr(value.fget, "__annotations__", {})  # none of what `carried` makes
                written[name] = said_of.get("return", "")
        names = Names(vars(sys.modules[base.__module__]))
        for name, hint in written.items():
            said: Any = eval(hint, {}, names) if isinstance(hint, str) and "Q(" in hint else hint
            if get_origin(said) is Annotated:
                what, *beside = get_args(said)
                types = tuple(_types(what))
                for each in beside:
                    if not isinstance(each, Q):
                        continue
                    key = each.key or name
                    if key in found and found[key].attribute != name:
                        other = f"{kind.__name__}.{found[key].attribute}"
                        raise InputError(f"{kind.__name__}.{name}", key, f"a name of its own; {other} has it")
                    found[key] = _Declared(name, each, types)
    _FOUND[kind] = found
    try:
        for key, declared in found.items():
            _require_sound(kind, key, declared.q)
    except InputError:
        del _FOUND[kind]
        raise
    return found


_PATH = re.compile(r"\{0\.(\w+)")  # attribute that a text stands for


def _require_sound(kind: type, key: str, q: Q) -> None:
    """Raise `InputError` where a declaration has no unit that is one, no names, attributes that are none."""
    at = f"{kind.__name__}.{key}"
    if not isinstance(q.unit, str) or not ("{0." in q.unit or is_unit(q.unit)):
        raise InputError(f"{at}.unit", q.unit, 'a unit as CF writes it, such as "m s-1"; "1" of a number')
    if not isinstance(q.over, tuple) or not all(isinstance(dim, str) for dim in q.over):
        raise InputError(f"{at}.over", q.over, 'a tuple of names of dimensions, such as ("speed",)')
    paths = [*filter(None, (q.when,)), *_PATH.findall(f"{q.unit} {q.name} {q.text}")]
    fields = {name for base in kind.__mro__ for name in vars(base).get("__annotations__", {})}
    for name in paths:
        if not (name in fields or hasattr(kind, name) or _has(kind, name)):
            raise InputError(at, name, f"an attribute of {kind.__name__}")


def _types(hint: Any) -> Iterator[type]:
    """Classes in a type: its own, those of which it is made."""
    if isinstance(hint, type) and not get_args(hint):
        yield hint
    for part in get_args(hint):
        yield from _types(part)


def types_of(kind: type, key: str) -> tuple[type, ...]:
    """Classes of which the values of a quantity are, or are made."""
    return _declared(kind)[key].types


def _of(record: Any) -> Iterator[tuple[str, Q, Any]]:
    """Public name, declaration and value of each quantity that a record has."""
    for key, each in _declared(type(record)).items():
        there = getattr(record, each.q.when) if each.q.when else record
        if there is not None and not (isinstance(there, tuple) and not there):
            yield key, each.q, getattr(record, each.attribute)


def reached(record: Any, key: str) -> Any:
    """A quantity by its public name, of a record or of one of its parts; None where it has no such part.

    Raises
    ------
    AttributeError : no quantity of that name is declared
    """
    for each in _declared(type(record)).values():
        if each.q.part and any(_has(kind, key) for kind in each.types):
            part = getattr(record, each.attribute)
            if part is None:
                return None
            own = _declared(type(part)).get(key)
            return reached(part, key) if own is None else getattr(part, own.attribute)
    raise AttributeError(f"{type(record).__name__!r} object has no attribute {key!r}")


def _has(kind: type, key: str) -> bool:
    declared = _declared(kind)
    return key in declared or any(
        each.q.part and any(_has(one, key) for one in each.types) for each in declared.values()
    )


def names(kind: type) -> set[str]:
    """Public names of all quantities of an answer, those of its parts among them."""
    parts = (one for each in _declared(kind).values() if each.q.part for one in each.types)
    return set(_declared(kind)).union(*(names(one) for one in parts))


def plain(value: Any) -> Any:
    """A value as JSON knows it: complex numbers as [re, im], None for what is not finite, notes as texts."""
    if value is None or isinstance(value, str | bool | int):
        return value
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, complex):
        return [value.real, value.imag] if cmath.isfinite(value) else [None, None]
    if isinstance(value, Mapping):
        return {str(key): plain(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [plain(each) for each in value]
    if isinstance(value, Note):
        return value.text
    if is_dataclass(value) and not isinstance(value, type):
        return plain(value.to_json()) if hasattr(value, "to_json") else to_json(value)
    if isinstance(value, np.ndarray | np.generic) and value.dtype.kind in "fc":
        wide = np.asarray(value, complex if value.dtype.kind == "c" else float)
        return finite(wide) if wide.ndim else plain(wide.item())
    if hasattr(value, "tolist"):  # arrays and their scalars
        return plain(value.tolist())
    if isinstance(value, Path):
        return str(value)
    raise TypeError(f"{type(value).__name__} has no form in JSON")


def to_json(record: Any, only: Collection[str] = ()) -> dict[str, Any]:
    """Declared quantities of a record by public name, all fields of one that declares none.

    A part may bring its own `to_json`.
    """
    if not _declared(type(record)):
        return {field.name: plain(getattr(record, field.name)) for field in fields(record)}
    found: dict[str, Any] = {}
    for key, q, value in _of(record):
        if not q.json or (only and key not in only):
            continue
        if q.part:
            if value is not None:
                found |= value.to_json() if hasattr(value, "to_json") else to_json(value)
        elif q.prefix:
            found[key] = None if value is None else to_json(value, q.only)
        elif q.sparse:
            there = ~np.isnan(getattr(record, q.sparse))
            each, ends = plain(value[there]), np.cumsum(there.sum(axis=1)).tolist()
            found[key] = [each[start:end] for start, end in pairwise([0, *ends])]
        else:
            try:
                found[key] = plain(value)
            except TypeError as error:
                at = f"{type(record).__name__}.{key}"
                raise InputError(
                    at, type(value).__name__, "numbers, texts, records, or lists of them"
                ) from error
    return found


def named_arrays(record: Any, attrs: Mapping[str, Any] = MappingProxyType({})) -> NamedArrays:
    """Declared quantities that have a unit or states, over their dimensions; complex ones in two parts."""
    arrays: dict[str, Variable] = {}
    coordinates: dict[str, Variable] = {}
    for name, q, value in _with_parts(record):
        if isinstance(value, Variable):
            arrays[name] = value
        elif (q.unit or q.flags) and not (value is None and q.over):
            place = coordinates if q.coordinate or q.over == (name,) else arrays
            place |= _variables(name, q, math.nan if value is None else value)
    return NamedArrays(arrays, coordinates, attrs)


def _with_parts(record: Any, only: Collection[str] = ()) -> Iterator[tuple[str, Q, Any]]:
    """Variables of a record, of its parts, of records in rows; a part may bring its own `variables`."""
    for key, q, value in _of(record):
        if not q.data or (only and key not in only) or (value is None and (q.part or q.rows)):
            continue
        if q.part and hasattr(value, "variables"):
            yield from ((name, q, variable) for name, variable in value.variables().items())
        elif q.part:
            yield from _with_parts(value)
        elif q.prefix:
            own = [(name, inner, math.nan) for name, inner in _scalars(type(record), key)]
            own = own if value is None else list(_with_parts(value, q.only))
            dims = {name for name, _, _ in own}
            for name, inner, each in own:
                over = tuple(f"{q.prefix}_{dim}" if dim in dims else dim for dim in inner.over)
                text = ", ".join(part for part in (q.text, inner.text) if part)
                found = name if inner.variable else f"{q.prefix}_{name}"
                yield found, replace(inner, over=over, text=text), each
        elif q.rows and value:
            yield from _columns(
                next(kind for kind in types_of(type(record), key) if _declared(kind)), value, q.rows
            )
        elif not q.rows:
            said = {part: getattr(q, part).format(record) for part in ("unit", "name", "text")}
            yield q.variable or key, replace(q, **said), value


def _scalars(kind: type, key: str) -> Iterator[tuple[str, Q]]:
    """What the data file has of a record that is not there: its numbers without dimensions, as nan."""
    for record in types_of(kind, key):
        for name, each in _declared(record).items():
            if each.q.data and each.q.unit and not each.q.over and not each.q.axes:
                yield each.q.variable or name, each.q


def row_variables(kind: type, rows: Sequence[Any], dim: str) -> dict[str, Variable]:
    """Quantities of records of a kind along a dimension; none of them gives variables of length 0."""
    made = (_variables(name, q, column) for name, q, column in _columns(kind, rows, dim))
    return {name: variable for each in made for name, variable in each.items()}


def _columns(kind: type, rows: Sequence[Any], dim: str) -> Iterator[tuple[str, Q, Any]]:
    """Quantities of records along a dimension, those of their parts among them; nan in place of no record."""
    for name, each in _declared(kind).items():
        column = [None if row is None else getattr(row, each.attribute) for row in rows]
        if each.q.part or each.q.prefix:
            yield from _columns(each.types[0], column, dim)
        elif each.q.data and not (each.q.over and all(value is None for value in column)):
            shape = next((np.shape(value) for value in column if value is not None), ())
            nothing = np.full(shape, False if each.q.flags else math.nan)
            values = [nothing if value is None else value for value in column]
            found = each.q.variable or f"{dim}_{name}"
            yield found, replace(each.q, over=(dim, *each.q.over)), np.array(values)


def _variables(name: str, q: Q, value: Any) -> dict[str, Variable]:
    if q.over and isinstance(value, tuple):  # with None for what is not there
        value = np.array([math.nan if one is None else one for one in value])
    if q.flags:
        states = np.asarray(value)
        if states.dtype.kind == "U":
            meanings = q.flags.split()
            states = np.array([meanings.index(each) for each in states.tolist()], int) + 2 - len(meanings)
        return {name: flags(q.over, states, q.flags, q.name, q.text)}
    values = np.asarray(value)
    kinds, what = ("biufc", "numbers") if q.axes else ("biufU", "real numbers or texts")
    texts = values.dtype.kind == "O" and all(isinstance(one, str) for one in values.ravel().tolist())
    if values.ndim != len(q.over) or not (values.dtype.kind in kinds or texts):
        over = f"({', '.join(q.over)})" if q.over else "nothing"
        raise InputError(name, f"{values.dtype} of shape {values.shape}", f"{what} over {over}, as declared")
    if q.axes is None:
        return {name: variable(q.over, value, q.unit, q.name, q.text)}
    values = np.where(np.isnan(values), complex(math.nan, math.nan), values)
    return {
        f"{name}_{end}": variable(
            q.over,
            getattr(values, end),
            q.unit,
            f"{q.name}, {part} part",
            "; ".join(filter(None, (where, q.text))),
        )
        for end, part, where in zip(("real", "imag"), ("real", "imaginary"), q.axes, strict=True)
    }


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
        # Of an answer what is worked out later is not asked for: it is sealed then.
        known = vars(value) if hasattr(value, "__dict__") else {}
        yield from (
            known[one.name] if one.name in known else getattr(value, one.name) for one in fields(value)
        )
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
