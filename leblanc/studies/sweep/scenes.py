"""Scenes of a sweep from sampled values: only what varies is checked anew."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from pydantic import ValidationError

from leblanc.scene.chambers import Chamber
from leblanc.scene.scene import Scene, scene_from_table
from leblanc.scene.schema.load import SceneFaults, escaped
from leblanc.scene.schema.part import Part, rule_of
from leblanc.scene.schema.paths import Keys, tables_of, with_values
from leblanc.scene.schema.rules import Quantity

_WORDS_ONLY = ("source", "assumed", "runup")  # no answer of a sweep depends on them

_Tables = Mapping[tuple[str, ...], type[Part]]

Maker = Callable[[Sequence[Any]], Scene]


def scene_maker(table: Mapping[str, Any], paths: Sequence[Keys]) -> Maker:
    """What makes one scene after the other from the same table with other values.

    Each is the scene that the whole table with those values gives, at a fraction of the cost.

    Parameters
    ----------
    table : content of a scene file, free of faults
    paths : keys along the path of each value

    Returns
    -------
    Function of the values at those paths. It raises SceneFaults where the whole table would.
    """
    base = {key: value for key, value in table.items() if key not in _WORDS_ONLY}
    scene = scene_from_table(base)
    base = _in_si(base, (), tables_of(Scene, scene.rotor.kind))
    rotor_class = type(scene.rotor)
    touched = {keys[:2] if keys[0] == "chambers" else keys[:1] for keys in paths}
    chambers = sorted(int(keys[1]) for keys in touched if keys[0] == "chambers")
    in_parts = all(keys[0] in ("rotor", "chambers") for keys in paths)

    def make(values: Sequence[Any]) -> Scene:
        changed = with_values(base, zip(paths, values, strict=True))
        if not in_parts:
            return scene_from_table(changed)
        try:
            parts = list(scene.chambers)
            for k in chambers:
                parts[k] = Chamber.model_validate(changed["chambers"][k])
            rotor = scene.rotor
            if ("rotor",) in touched:
                rotor = rotor_class.model_validate(changed["rotor"])
        except ValidationError:
            return scene_from_table(changed)  # says what is wrong in words
        return scene.altered(rotor=rotor, chambers=tuple(parts))

    return make


def _in_si(table: Mapping[str, Any], place: tuple[str, ...], tables: _Tables) -> dict[str, Any]:
    """The table with quantities as plain numbers, which are not parsed again for each sample."""
    plain = dict(table)
    for key, value in table.items():
        below = (*place, key)
        if isinstance(value, list) and (*below, "*") in tables:
            plain[key] = [_in_si(one, (*below, "*"), tables) for one in value]
        elif isinstance(value, dict) and below in tables:
            plain[key] = _in_si(value, below, tables)
        elif isinstance(value, str):
            rule = rule_of(tables[place].model_fields[key])
            plain[key] = rule(value) if isinstance(rule, Quantity) else value
    return plain


def make_scenes(make: Maker, rows: Iterable[Sequence[Any]]) -> tuple[list[Scene | None], list[str]]:
    """Scenes of some samples, None for one that breaks a rule, and the reason why.

    Parameters
    ----------
    make : from `scene_maker`
    rows : values of each sample
    """
    scenes: list[Scene | None] = []
    reasons: list[str] = []
    for row in rows:
        try:
            scenes.append(make(row))
            reasons.append("")
        except SceneFaults as error:
            scenes.append(None)
            reasons.append("; ".join(_without_file(str(fault), fault.file) for fault in error.faults))
    return scenes, reasons


def _without_file(line: str, file: str) -> str:
    return line.removeprefix(f"{escaped(file)}: ")
