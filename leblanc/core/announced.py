"""What installed packages announce by entry points, as commands and liquid models."""

from __future__ import annotations

from collections.abc import Callable
from importlib.metadata import EntryPoint, distributions

COMMANDS, LIQUIDS = "leblanc.commands", "leblanc.liquids"  # groups


def announced(group: str, failed: Callable[[str], object] = lambda _: None) -> dict[str, EntryPoint]:
    """Entry points of a group by name; one that cannot be read announces none, `failed` says why."""
    found: dict[str, EntryPoint] = {}
    for package in distributions():
        try:
            entries = [entry for entry in package.entry_points if entry.group == group]
        except Exception as error:
            failed(str(error) or type(error).__name__)
            continue
        for entry in entries:
            found.setdefault(entry.name, entry)  # of two versions on the path the first is the one imported
    return found
