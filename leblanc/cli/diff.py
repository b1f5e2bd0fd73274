"""`leblanc diff`: what differs between two machines."""

from __future__ import annotations

import math
from itertools import zip_longest
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from leblanc.cli.terminal.output import load
from leblanc.core.terminal import print_json, print_table

if TYPE_CHECKING:
    from leblanc.core.units import Dimension

_SAME = 1e-10  # relative, as the digest of a machine has it


def diff(
    first: Annotated[Path, typer.Argument(help="Scene file (TOML).")],
    other: Annotated[Path, typer.Argument(help="Scene file (TOML) beside it.")],
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of words.")] = False,
) -> None:
    """What differs between two machines, key by key."""
    from leblanc.scene.schema.paths import values_of

    machines = [load(path) for path in (first, other)]
    found = [{path: (value, unit) for path, value, unit in values_of(machine)} for machine in machines]
    paths = [
        path
        for path in {**found[0], **found[1]}
        if not _alike(*(values.get(path, (None, None))[0] for values in found))
    ]
    first_digest, other_digest = (
        machine.altered(name="", source="", assumed=()).digest for machine in machines
    )
    same = first_digest == other_digest
    if json:
        rows = [
            {"path": path, "first": values[0], "other": values[1], "unit": unit.unit if unit else None}
            for path in paths
            for values, unit in [_both(found, path)]
        ]
        print_json({"first": str(first), "other": str(other), "same": same, "differences": rows})
        return
    if paths:
        texts = [
            (path, *(_text(value, unit) for value in values))
            for path in paths
            for values, unit in [_both(found, path)]
        ]
        print_table(texts, ("Key", str(first), str(other)))
    if same:
        print("The same machine, in other words." if paths else "The same machine.")


def _both(found: list[dict[str, Any]], path: str) -> tuple[list[Any], Dimension | None]:
    """Both values at a path, None where there is none, and what they measure."""
    pairs = [values.get(path, (None, None)) for values in found]
    return [value for value, _ in pairs], next((unit for _, unit in pairs if unit is not None), None)


def _alike(first: Any, other: Any) -> bool:
    """Whether two values are the same to ten digits."""
    if isinstance(first, list) and isinstance(other, list):
        return all(_alike(a, b) for a, b in zip_longest(first, other))
    if isinstance(first, float) and isinstance(other, int | float):
        return math.isclose(first, other, rel_tol=_SAME)
    return bool(first == other)


def _text(value: Any, unit: Dimension | None) -> str:
    """A value for readers, with its unit."""
    from leblanc.core.units import NUMBER, with_unit

    if value is None:
        return "not given"
    if isinstance(value, list):
        return ", ".join(_text(each, unit) for each in value)
    if isinstance(value, float) and math.isfinite(value):
        return with_unit(value, unit or NUMBER)
    return str(value).lower() if isinstance(value, bool) else str(value)
