"""Fields of a scene by their paths: the rule of each, and a scene's content with other values there."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from itertools import pairwise
from typing import Annotated, Any, get_args, get_origin

from pydantic.fields import FieldInfo

from leblanc.core.units import Dimension
from leblanc.scene.schema.load import field_path, meant
from leblanc.scene.schema.part import Part, parts_of, rule_of
from leblanc.scene.schema.rules import Entries, Refused, Several

Keys = tuple[str | int, ...]

# What an answer to each command depends on; all samples of a sweep have as many speeds.
_MACHINE = ("gravity", "rotor", "chambers", "cabinet", "points", "model")
ROOTS = {"run": (*_MACHINE, "speeds"), "runup": (*_MACHINE, "runup", "programme")}
_FIXED = (("rotor", "kind"), ("speeds", "count"))


@cache
def tables_of(root: type[Part], kind: str) -> dict[tuple[str, ...], type[Part]]:
    """Each table of a file by its place; "*" stands for the number of an entry.

    Of entries of several kinds "*" is the usual one, and "*balls" that of the kind `balls`; `kind` is the
    rotor's.
    """
    found: dict[tuple[str, ...], type[Part]] = {(): root}
    for name, field in root.model_fields.items():
        parts = parts_of(field)
        inside: dict[tuple[str, ...], type[Part]]
        if get_origin(field.annotation) is tuple and parts:
            inside = {(name, "*" if part.USUAL_KIND else f"*{key}"): part for key, part in parts.items()}
        else:
            part = parts.get(kind) or parts.get("")
            inside = {} if part is None else {(name,): part}
        for place, part in inside.items():
            found |= {(*place, *below): table for below, table in tables_of(part, kind).items()}
    return found


def place_of(table: Mapping[str, Any], keys: Keys, tables: Mapping[tuple[str, ...], Any]) -> tuple[str, ...]:
    """Keys of a path in a scene file's content as `tables_of` has them."""
    place: tuple[str, ...] = ()
    found: Any = table
    for key in keys:
        stands = isinstance(found, list) and isinstance(key, int) and key < len(found)
        found = found[key] if stands else found.get(key) if isinstance(found, Mapping) else None
        other = f"*{found.get('kind', '')}" if isinstance(key, int) and isinstance(found, Mapping) else ""
        named = other if (*place, other) in tables else "*"
        place = (*place, named if isinstance(key, int) else key)
    return place


def keys_of(path: str) -> Keys:
    """Keys along a path such as "chambers.0.volume", numbers of entries as such."""
    return tuple(int(key) if key.isdecimal() and len(key) < 7 else key for key in path.split("."))


# What holds several of a kind, and what one of them is called.
_ONE = {"chambers": "chamber", "supports": "support", "unbalances": "unbalance", "springs": "spring"}
_ONE |= {"dampers": "damper", "points": "point", "bearings": "bearing"}
_WORDS = {"drag": "race damping", "ball_mass": "mass of a ball"}


def path_words(*paths: str, chambers: int = 1) -> str:
    """The number at paths for an axis or a caption: "rotor.supports.0.damping" is "damping of support 1".

    `chambers` is how many the machine has, races among them.
    """
    keys, more = keys_of(paths[0]), f" and {len(paths) - 1} more" if len(paths) > 1 else ""
    name = _WORDS.get(str(keys[-1]), str(keys[-1]).replace("_", " "))
    places = [
        f"{_ONE.get(str(above), str(above))} {key + 1}"
        for above, key in pairwise(keys)
        if isinstance(key, int)
    ]
    # A machine with one chamber or race has no other to tell it from.
    places = [place for place in places if place != "chamber 1" or chambers > 1]
    return (f"{name} of {places[-1]}" if places and not isinstance(keys[-1], int) else name) + more


def rule_at(root: type[Part], table: Mapping[str, Any], path: str, command: str = "run") -> Any:
    """Rule of one value at a path such as "chambers.0.volume", in a table free of faults.

    `Refused`, with what there is, where there is no single value that a study of a command may vary.
    """
    keys = keys_of(path)
    pattern = tuple("*" if isinstance(key, int) else key for key in keys)
    roots = ROOTS[command]
    if keys[0] not in roots or pattern in _FIXED:
        fixed = ", ".join(".".join(keys) for keys in _FIXED if keys[0] in roots)
        raise Refused(f"the path of a field under {', '.join(roots)}, other than {fixed}")
    field, depth = require_field(root, table, path)
    rule = _rule_of(field, keys[depth + 1 :], field_path(keys[: depth + 1]))
    if keys[depth + 1 :]:
        _must_stand(table, keys, tables_of(root, table["rotor"]["kind"]))
    return rule


def require_field(root: type[Part], table: Mapping[str, Any], path: str) -> tuple[FieldInfo, int]:
    """Field that a path such as "chambers.0.volume" leads to or into, and how many keys lead to its table.

    `Refused` where there is no such field, no table that it would stand in, or another one in its place.
    """
    keys = keys_of(path)
    tables = tables_of(root, table["rotor"]["kind"])
    pattern = place_of(table, keys, tables)
    depth = max(n for n in range(len(keys)) if pattern[:n] in tables)
    fields = tables[pattern[:depth]].model_fields
    if pattern[depth] not in fields:
        place, near = field_path(keys[:depth]) or "the scene", meant(pattern[depth], fields)
        raise Refused(f"the path of a field; {place} has: {', '.join(fields)}{near}")
    _must_stand(table, keys[:-1], tables)
    _must_be_alone(table, keys, tables[pattern[:depth]])
    return fields[pattern[depth]], depth


def _must_stand(table: Mapping[str, Any], keys: Keys, tables: Mapping[tuple[str, ...], Any]) -> None:
    """What leads to the value stands in the scene; a table of which every key has a default may not."""
    found: Any = table
    for n, key in enumerate(keys):
        stands = (
            isinstance(found, list) and key < len(found)
            if isinstance(key, int)
            else isinstance(found, Mapping) and key in found
        )
        place = field_path(keys[: n + 1])
        if not stands and keys[: n + 1] == ("model",):
            return
        if not stands:
            raise Refused(f"the path of a field; the scene has no {place}")
        found = found[key]
        if place_of(table, keys[: n + 1], tables) in tables and not isinstance(found, Mapping):
            raise Refused(f"the path of a field; {place} is no table in the scene")


def _rule_of(field: Any, rest: Keys, place: str) -> Any:
    """Rule of a field, or of one entry of it."""
    rule = rule_of(field)
    if rule is None or len(rest) > 1:
        raise Refused(
            f"the path of a single value; {place} is not one" if not rest else "the path of a field"
        )
    if not rest:
        if isinstance(rule, Entries):
            raise Refused(f"the path of one value, such as {place}.0")
        return rule
    if isinstance(rest[0], int) and isinstance(rule, Several):
        return rule.each
    entry = entry_rule(field.annotation)
    if isinstance(rest[0], int) and isinstance(rule, Entries) and entry is not None:
        return entry
    raise Refused(f"the path of a field; {place} has no {rest[0]}")


def entry_rule(annotation: Any) -> Any:
    """Rule of the entries of a list, from its type; None if they are tables or there is no list."""
    if get_origin(annotation) is not tuple:
        inside = [found for option in get_args(annotation) if (found := entry_rule(option)) is not None]
        return inside[0] if inside else None
    entry = get_args(annotation)[0]
    if get_origin(entry) is not Annotated:
        return None
    return next((rule.func for rule in get_args(entry)[1:] if hasattr(rule, "func")), None)


def _must_be_alone(table: Mapping[str, Any], keys: Keys, part: type[Part]) -> None:
    """The scene does not give what the value would be an alternative to."""
    for pair in part.ALTERNATIVES:
        if keys[-1] not in pair:
            continue
        (other,) = set(pair) - {keys[-1]}
        found: Any = table
        for key in keys[:-1]:
            found = found[key]
        if other in found:
            path = field_path((*keys[:-1], other))
            raise Refused(f"left out: the scene gives {path} in its place")


def with_values(table: Mapping[str, Any], changes: Iterable[tuple[Keys, Any]]) -> dict[str, Any]:
    """The content of a scene with other values at their keys; only what leads to them is copied.

    A single speed has one value: its start and stop move together.
    """
    changed, pairs = dict(table), list(changes)
    ends = [(keys, value) for keys, value in pairs if keys in (("speeds", "start"), ("speeds", "stop"))]
    if len(ends) == 1 and table["speeds"].get("count") == 1:
        pairs += [(("speeds", end), ends[0][1]) for end in ("start", "stop")]
    for keys, value in pairs:
        node: Any = changed
        for key in keys[:-1]:
            below = node[key] if isinstance(key, int) else node.get(key, {})
            node[key] = list(below) if isinstance(below, list) else dict(below)
            node = node[key]
        node[keys[-1]] = value
    return changed


def values_of(part: Part, *place: str | int) -> Iterator[tuple[str, Any, Dimension | None]]:
    """Every value of a table and of those below it: its path, in SI units, and what it measures.

    Defaults and what follows from other values as well, lists of numbers whole.
    """
    for name, field in type(part).model_fields.items():
        value, rule = getattr(part, name), rule_of(field)
        if value in (None, ()) or (name == "kind" and part.USUAL_KIND):
            continue
        tables = value if isinstance(value, tuple) else (value,)
        if all(isinstance(table, Part) for table in tables):
            for k, table in enumerate(tables):
                yield from values_of(table, *place, name, *([k] if isinstance(value, tuple) else []))
            continue
        written = getattr(rule, "written", lambda value: list(value) if isinstance(value, tuple) else value)
        said = written(value)
        if isinstance(said, Mapping):
            inside = getattr(getattr(rule, "table", None), "model_fields", {})
            for key, each in said.items():
                within = rule_of(inside[key]) if key in inside else None
                yield field_path((*place, name, key)), each, getattr(within, "dimension", None)
            continue
        rules = (rule, getattr(rule, "each", None), entry_rule(field.annotation))
        units = (getattr(one, "dimension", None) for one in rules)
        yield field_path((*place, name)), said, next((unit for unit in units if unit is not None), None)
