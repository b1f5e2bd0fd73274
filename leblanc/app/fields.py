"""The form of a machine: each value of its file as a field, made from the models that check the file."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from typing import Any

from pydantic.fields import FieldInfo

from fluid.friction.laws import FrictionLaw
from fluid.liquid import KNOWN_LIQUIDS
from leblanc.core.units import MINUS, TEMPERATURE, Dimension, Unit, unit_for, unit_typed
from leblanc.scene.chambers import LiquidRule
from leblanc.scene.rows import Value
from leblanc.scene.scene import FrictionRule, Scene
from leblanc.scene.schema.load import field_path
from leblanc.scene.schema.part import Part, allowed_at, parts_of, rule_of
from leblanc.scene.schema.paths import entry_rule
from leblanc.scene.schema.rules import Flag, OneOf, Quantity, Several, Text, Whole

# Heading of each group of the form, and the tables of the file in it.
GROUPS = {
    "Rotor": ("rotor", "cabinet", "points"),
    "Chambers": ("chambers",),
    "Speeds": ("speeds", "gravity"),
    "Run-up": ("runup", "programme"),
    "Model": ("model",),
}
REACH = 4.0  # a slider goes from a value over this to the value times this
WITHOUT_NUMBER = (FrictionLaw.NONE, FrictionLaw.STOKES, FrictionLaw.WALL)  # friction by its name alone
_LONGEST = 12  # entries of a list that have a field each
_AXES = ("x", "y", "z")


@dataclass(frozen=True)
class Slider:
    """Where a slider begins and ends, in the unit of its field."""

    low: float
    high: float
    at: float
    log: bool


@dataclass(frozen=True)
class FormField:
    """One value of the file."""

    path: str
    label: str
    help: str  #: what it is
    kind: str  #: quantity, whole, choice, flag or text
    text: str  #: as it stands in the file; empty where it does not
    usual: str  #: in words where the file does not give it
    unit: str  #: of a bare number; empty for none
    allowed: str
    assumed: bool
    choices: tuple[str, ...] = ()  #: names that may stand there; of a text among others
    slider: Slider | None = None


@dataclass(frozen=True)
class FieldSet:
    """Fields of one table of the file."""

    title: str
    fields: tuple[FormField, ...]


def form_of(scene: Scene, table: Mapping[str, Any], anchors: Mapping[str, float]) -> list[dict[str, Any]]:
    """Groups of the form as JSON takes them.

    `table` is the content of the file as it was typed; `anchors` are the values, SI, about which sliders lie
    where that is not the value itself.
    """
    found = []
    for title, roots in GROUPS.items():
        sets = [
            part
            for root in roots
            if root in type(scene).model_fields
            for part in _sets(scene, table, anchors, root)
            if part.fields
        ]
        if sets:
            found.append({"title": title, "sets": [asdict(each) for each in sets]})
    return found


def _sets(
    scene: Scene, table: Mapping[str, Any], anchors: Mapping[str, float], root: str
) -> Iterator[FieldSet]:
    value, field = getattr(scene, root), type(scene).model_fields[root]
    if isinstance(value, Part):
        yield from _part(value, (root,), root, scene, table, anchors)
    elif isinstance(value, tuple):
        for k, each in enumerate(value):
            title = f"{root.removesuffix('s')} {k + 1}"
            yield from _part(each, (root, k), title, scene, table, anchors)
    elif value is not None:
        yield FieldSet("", tuple(_fields(field, root, value, (root,), scene, table, anchors)))


def _part(
    part: Part,
    place: tuple[str | int, ...],
    title: str,
    scene: Scene,
    table: Mapping[str, Any],
    anchors: Mapping[str, float],
) -> Iterator[FieldSet]:
    """The table's own values first, then those of tables in it."""
    own: list[FormField] = []
    below: list[FieldSet] = []
    for name, field in type(part).model_fields.items():
        value = getattr(part, name)
        keys = (*place, name)
        if name == "kind" or (name == "values" and value == ()):
            continue
        if isinstance(value, Part):
            below += _part(value, keys, f"{title}, {_words(name)}", scene, table, anchors)
        elif isinstance(value, tuple) and value and all(isinstance(each, Part) for each in value):
            for k, each in enumerate(value):
                called = f"{title}, {_words(name).removesuffix('s')} {k + 1}"
                below += _part(each, (*keys, k), called, scene, table, anchors)
        elif rule_of(field) is not None and not (value in (None, ()) and parts_of(field)):
            own += _fields(field, name, value, keys, scene, table, anchors)
    yield FieldSet(_capital(title), tuple(own))
    yield from below


def _fields(
    field: FieldInfo,
    name: str,
    value: Any,
    keys: tuple[str | int, ...],
    scene: Scene,
    table: Mapping[str, Any],
    anchors: Mapping[str, float],
) -> Iterator[FormField]:
    """The field of a value, or of each entry of a short list."""
    rule, typed = rule_of(field), given_at(table, keys)
    inner = rule.each if isinstance(rule, Several) else entry_rule(field.annotation)
    if isinstance(typed, list) and isinstance(inner, Quantity | Whole) and len(typed) <= _LONGEST:
        marks = _AXES if len(typed) == len(_AXES) else tuple(str(k + 1) for k in range(len(typed)))
        for k, mark in enumerate(marks):
            label = f"{_words(name)} {mark}"
            yield _field(
                inner,
                field,
                label,
                value[k],
                typed[k],
                (*keys, k),
                scene.assumed,
                anchors,
                allowed=inner.allowed,
            )
        return
    yield _field(rule, field, _words(name), value, typed, keys, scene.assumed, anchors, allowed_at(field))


def _field(
    rule: Any,
    field: FieldInfo,
    label: str,
    value: Any,
    typed: Any,
    keys: tuple[str | int, ...],
    assumed: tuple[str, ...],
    anchors: Mapping[str, float],
    allowed: str,
) -> FormField:
    path = field_path(keys)
    kind, unit, slider = "text", "", None
    choices: tuple[str, ...] = ()
    usual = "" if value is None or typed is not None else _said(value, getattr(rule, "dimension", None))
    number = value if isinstance(value, int | float) and not isinstance(value, bool) else None
    if isinstance(rule, Quantity):
        kind = "quantity"
        shown = unit_shown(typed, value, rule.dimension)
        unit = shown.name
        if number is not None and rule.dimension is not TEMPERATURE:
            slider = _slider(rule, number, anchors.get(path, number), shown.count)
    elif isinstance(rule, Whole):
        kind = "whole"
        if number is not None:
            slider = _slider(rule, number, anchors.get(path, number), 1.0)
    elif isinstance(rule, OneOf):
        kind, choices = "choice", rule.names
    elif isinstance(rule, Flag):
        kind = "flag"
    elif isinstance(rule, LiquidRule):
        choices = tuple(KNOWN_LIQUIDS)
    elif isinstance(rule, FrictionRule):
        choices = tuple(law.value for law in WITHOUT_NUMBER)
    return FormField(
        path=path,
        label=label,
        help=field.description or "",
        kind=kind,
        text=text_of(typed),
        usual=usual or ("false" if kind == "flag" and typed is None and value is None else ""),
        unit=unit,
        allowed=allowed,
        assumed=Value("", (path,)).marked(assumed).assumed,
        choices=choices,
        slider=slider,
    )


def unit_shown(typed: Any, value: Any, dimension: Dimension) -> Unit:
    """Unit in which a field is shown: the one in the file, else one that a person would write."""
    if typed is not None and not isinstance(typed, dict | list):
        return unit_typed(typed, dimension)
    if dimension is TEMPERATURE:
        return Unit(dimension.unit, 1.0)
    found = unit_for(dimension, *([value] if isinstance(value, int | float) else []))
    return Unit(found.name.replace(" ", "*"), found.count)


def _slider(rule: Quantity | Whole, value: float, anchor: float, count: float) -> Slider | None:
    """About the anchor, within what is allowed; none for a value that has no size to go by."""
    if value == anchor == 0.0:
        return None
    if anchor == 0.0 or not abs(anchor) / REACH <= abs(value) <= abs(anchor) * REACH:
        anchor = value if value != 0.0 else anchor
    size = abs(anchor)
    log = rule.low >= 0.0 and value > 0.0 and anchor > 0.0
    low, high = (size / REACH, size * REACH) if log else (min(0.0, value), size * REACH)
    if rule.low < 0.0:
        low, high = -REACH * size, REACH * size
    low, high = max(low, rule.low), min(high, rule.high)
    if isinstance(rule, Whole):
        low, high, log = max(float(rule.low), low // 1), high // 1, False
    if not low < high:
        return None
    return Slider(_digits(low * count), _digits(high * count), _digits(value * count), log)


def _digits(value: float) -> float:
    return float(f"{value:.6g}")


def given_at(table: Mapping[str, Any], keys: tuple[str | int, ...]) -> Any:
    """What a file's content says at some keys; None where it says nothing."""
    found: Any = table
    for key in keys:
        if isinstance(found, Mapping):
            found = found.get(str(key))
        elif isinstance(found, list | tuple) and isinstance(key, int) and key < len(found):
            found = found[key]
        else:
            return None
    return found


def text_of(typed: Any) -> str:
    """A value of a file as a field shows it: a text without quotes, anything else as TOML."""
    if typed is None:
        return ""
    if isinstance(typed, str):
        return typed
    import tomlkit

    if isinstance(typed, dict):
        inline = tomlkit.inline_table()
        inline.update(typed)
        return str(inline.as_string())
    return str(tomlkit.item(typed).as_string())


def value_of(text: str, rule: Any, unit: str) -> Any:
    """What a typed text means in a file: of a quantity a bare number has the unit of its field."""
    said = text.strip()
    if isinstance(rule, Text | OneOf):
        return said
    if isinstance(rule, Quantity) and unit and not said.startswith(("[", "{")):
        try:
            float(said.replace(MINUS, "-"))
        except ValueError:
            return said
        return f"{said.replace(MINUS, '-')} {unit}"
    try:
        return tomllib.loads(f"value = {said}")["value"]
    except ValueError:
        return said


def _said(value: Any, dimension: Dimension | None) -> str:
    """A value that the file does not give, in words."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float):
        return str(value) if dimension is None else unit_for(dimension, value).text(value)
    if isinstance(value, str):
        return value
    law = getattr(value, "law", None)
    return "" if law is None else str(getattr(law, "value", law))


def _words(name: str) -> str:
    return name.replace("_", " ")


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:].replace("_", " ")
