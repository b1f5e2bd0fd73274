"""What commands have in common: the scene they read, how many processes they start."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from leblanc.core.terminal import say

if TYPE_CHECKING:
    from leblanc.scene.scene import Scene
    from leblanc.studies.sweep.plan import Sweep


def load(path: Path) -> Scene:
    """Scene from a file, SceneError with all that is wrong; doubts go to stderr, one line each."""
    from leblanc.liquid.validity import DoubtCode, doubts, moves_freely
    from leblanc.scene.scene import scene_from_table
    from leblanc.scene.schema.load import escaped, given_at, read_text, scene_table, with_lines

    text = read_text(path)
    table = scene_table(text, path)
    with with_lines(path):
        scene = scene_from_table(table, str(path), text)
    for note in doubts(scene, table):
        if note.code is DoubtCode.FREE and moves_freely(scene):
            continue  # what refuses such a machine says so, and `explain` lists its free motions
        _, _, line = given_at(path, str(note.data["field"]))
        say(f"{escaped(str(path))}{f':{line}' if line else ''}: warning: {note.text}")
    return scene


def load_study(path: Path) -> Sweep:
    """Sweep from a study file, as `load` reads a scene."""
    from leblanc.liquid.validity import doubts
    from leblanc.studies.sweep.plan import load_sweep
    from leblanc.studies.sweep.sampling import sampling_note

    plan = load_sweep(path)
    for doubt in doubts(plan.scene, plan.table):
        say(f"{plan.scene_path}: warning: {doubt.text}")
    if note := sampling_note(plan):
        say(f"{plan.name}: {note}")
    return plan


def processes(wanted: int | None) -> int:
    """As many as are wanted, or one on each core; InputError for fewer than one."""
    from leblanc.studies.held.holding import cores
    from meshes.errors import InputError

    if wanted is not None and wanted < 1:
        raise InputError("--workers", wanted, "1 or more")
    return cores() if wanted is None else wanted
