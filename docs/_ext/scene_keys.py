"""The page of every key of a scene and of a study, from the models that check them."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from pydantic.fields import FieldInfo

from fluid.friction.laws import Friction
from leblanc.scene.scene import Scene
from leblanc.scene.schema.part import Part, parts_of, rule_of
from leblanc.scene.schema.paths import entry_rule, tables_of
from leblanc.scene.schema.rules import Entries, Flag, OneOf, Quantity, Several, Span, Text, Whole
from leblanc.studies.sweep.plan import FORMS, Study

NAME = "scene.md"
ROTORS = parts_of(Scene.model_fields["rotor"])

_HEAD = """# Keys of a scene and of a study

Every key that a scene file or a study file may have. This page is made from the code that checks the files
(`docs/_ext/scene_keys.py`); [your machine](howto/machine.md) shows scenes, [sweeps](howto/sweep.md) studies.

A quantity is a plain number in the SI unit that stands here, or a text with a unit, `"65 mm"`; see
[units](howto/machine.md). A key without a default must be given. Where a meaning ends with "or" and another
key, exactly one of the two must be given. `leblanc new` writes a scene to start from, and
`leblanc new --list` lists the examples.
"""
_COLUMNS = ("Key", "Unit", "Allowed", "Default", "Meaning")


def page() -> str:
    """The page in Markdown."""
    tables = tables_of(Scene, next(iter(ROTORS)))
    parts = [_HEAD, _section("## The file", "", tables[()])]
    for kind, rotor in ROTORS.items():
        parts.append(
            _section(f"## Rotor: {kind}", f'`[rotor]` with `kind = "{kind}"`. {_said(rotor)}', rotor)
        )
        parts += [
            _section(f"### {_heading(place)} of {kind}", _said(part), part)
            for place, part in tables_of(Scene, kind).items()
            if place[:1] == ("rotor",) and len(place) > 1
        ]
    shown = set()
    for place, part in tables.items():
        if place and place[0] != "rotor" and part not in shown:  # a liquid has the same keys everywhere
            shown.add(part)
            parts.append(_section(f"## {_heading(place)}", _said(part), part))
    parts.append(_section("## Study", _said(Study), Study))
    rows = [(f"`{form}`", meaning) for form, meaning in FORMS.values()]
    text = (
        "One of these for each field in `[vary]`, as in\n`"
        + '"rotor.mass" = { uniform = ["3 kg", "12 kg"] }`.'
    )
    parts.append(f"### Distributions\n\n{text}\n\n" + _table(("Distribution", "Values"), rows))
    return "\n".join(parts)


def write(folder: Path) -> Path:
    """Write the page of keys into a folder; its path."""
    path = folder / NAME
    path.write_text(page(), encoding="utf-8")
    return path


def _said(part: type[Part]) -> str:
    """What a table is."""
    return (part.__doc__ or "").partition("\n")[0]


def _heading(place: tuple[str, ...]) -> str:
    """A table as a file heads it, or as the value of a key."""
    name = ".".join(key for key in place if not key.startswith("*"))
    if place[-1].startswith("*") and place[0] != "optimise":
        kind = place[-1].removeprefix("*")
        return f"[[{name}]] of kind {kind}" if kind else f"[[{name}]]"
    return f"[{name}]" if len(place) == 1 else f"{place[-1] if place[-1] != '*' else place[-2]} = {{ ... }}"


def _section(title: str, text: str, part: type[Part]) -> str:
    rows = [_row(name, field) for name, field in part.model_fields.items()]
    return f"{title}\n\n" + (f"{text}\n\n" if text else "") + _table(_COLUMNS, rows)


def _table(head: tuple[str, ...], rows: list[Any]) -> str:
    lines = [head, tuple("---" for _ in head), *(map(_literal, row) for row in rows)]
    return "".join("| " + " | ".join(cells) + " |\n" for cells in lines)


def _literal(cell: str) -> str:
    """A cell whose asterisks, outside code, are products and no emphasis."""
    parts = re.split(r"(`[^`]*`)", cell)
    parts[::2] = (part.replace("*", "\\*") for part in parts[::2])
    return "".join(parts)


def _row(name: str, field: FieldInfo) -> tuple[str, str, str, str, str]:
    return (
        f"`{name}`",
        _unit(field),
        _allowed(field),
        _default(field),
        field.description or "",
    )


def _unit(field: FieldInfo) -> str:
    """SI unit of a value, or of each entry of a list."""
    rule = rule_of(field)
    for candidate in (rule, getattr(rule, "each", None), entry_rule(field.annotation)):
        quantity = getattr(candidate, "each", candidate)
        if isinstance(quantity, Quantity):
            return quantity.dimension.unit
    return ""


def _allowed(field: FieldInfo) -> str:
    """What may stand there, without the name of the quantity and its unit, which have columns."""
    rule = rule_of(field)
    if rule is None:
        if field.annotation is not None and not parts_of(field):
            return f"`{field.default}`"  # the kind
        return "a table of one of these kinds" if field.discriminator else "a table"
    if isinstance(rule, Entries):
        entry = entry_rule(field.annotation)
        each = f", each {_bounds(entry)}" if entry is not None else ""
        text = f"{rule.allowed}{each}".replace("[[", "`[[").replace("]]", "]]`")
        return text.replace("{", "`{").replace("}", "}`")
    return _bounds(rule)


def _bounds(rule: Any) -> str:
    """A rule in a few words."""
    if isinstance(rule, Quantity):
        zero = "0, or " if rule.or_zero and rule.low > 0.0 else ""
        return f"{zero}{rule.low:g} to {rule.high:g}"
    if isinstance(rule, Whole):
        return f"{rule.low} to {rule.high}, whole"
    if isinstance(rule, OneOf):
        return ", ".join(f"`{word}`" for word in rule.names)
    if isinstance(rule, Flag):
        return "`true`, `false`"
    if isinstance(rule, Span):
        return f"two, the lower first, each {_bounds(rule.each)}"
    if isinstance(rule, Several):
        return f"{_bounds(rule.each)}; or {rule.count} of them"
    if isinstance(rule, Text):
        return f"a text of at most {rule.longest} characters"
    # A table in a table is one piece of code.
    return re.sub(r"\{(?:[^{}]|\{[^{}]*\})*\}", r"`\g<0>`", str(rule.allowed)).removeprefix("one of: ")


def _default(field: FieldInfo) -> str:
    if field.is_required() or (rule_of(field) is None and isinstance(field.default, str)):
        return ""  # the kind of a rotor is its only value
    value = field.default
    if value is None:
        return "none"
    if isinstance(value, bool):
        return "`true`" if value else "`false`"
    if isinstance(value, Part):
        return "its defaults"
    if isinstance(value, Friction):
        return f"`{value.law}`"
    if isinstance(value, tuple):
        return ", ".join(f"{number:g}" for number in value) or "none"
    if isinstance(value, str):
        return f"`{value}`" if value else "empty"
    return f"{value:g}"


if __name__ == "__main__":
    write(Path(__file__).resolve().parents[1])
