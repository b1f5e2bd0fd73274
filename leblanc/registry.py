"""Which module answers a question about a kind of machine, and what installed packages announce.

The one place that names wings.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib.metadata import EntryPoint, distributions

# Groups of entry points.
COMMANDS, LIQUIDS, MACHINES = "leblanc.commands", "leblanc.liquids", "leblanc.machines"
CORE = ("jeffcott", "two_plane", "tub")  # kinds that the core's own studies answer

# "module:function" of a scene, by kind of machine and by question.
WINGS: dict[str, dict[str, str]] = {
    "balls": {
        "run": "leblanc.studies.balls.study:run_balls",
        "explain": "leblanc.studies.explain.balls.study:explain_balls",
    },
    "exciter": {
        "run": "leblanc.wings.exciter.study:run_exciter",
        "explain": "leblanc.wings.exciter.study:explain_exciter",
    },
    "magnetic": {
        "run": "leblanc.wings.magnetic.study:run_magnetic",
        "explain": "leblanc.wings.magnetic.study:explain_magnetic",
        "view": "leblanc.wings.magnetic.geometry:magnetic_view",
    },
    "spindle": {
        "run": "leblanc.wings.spindle.study:run_spindle",
        "view": "leblanc.wings.spindle.geometry:spindle_view",
    },
}


def answerer(question: str, kind: str) -> str | None:
    """What answers a question about a kind of machine; None where the core does."""
    if kind in CORE or kind in WINGS:
        return WINGS.get(kind, {}).get(question)
    entry = announced(MACHINES).get(kind)
    return None if entry is None else entry.load().ANSWERS.get(question)


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
