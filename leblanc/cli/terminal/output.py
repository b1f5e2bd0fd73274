"""What commands have in common: the scene they read, how many processes they start."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from leblanc.core.files import path_text
from leblanc.core.terminal import say
from meshes.errors import InputError

if TYPE_CHECKING:
    from leblanc.scene.scene import Scene
    from leblanc.studies.sweep.plan import Sweep


FORCE = "Write into the folder of another scene of the same name."
SET = "Another value of a key of the machine, as rotor.unbalance='120 g mm'; may be repeated."


def load(path: Path, changes: Sequence[str] = ()) -> Scene:
    """Scene from a file, SceneError with all that is wrong; doubts go to stderr, one line each.

    `changes` are values as they are typed behind --set, "PATH=VALUE".
    """
    from leblanc.liquid.validity import DoubtCode, doubts, moves_freely
    from leblanc.scene.scene import scene_from_table
    from leblanc.scene.schema.load import SceneError, escaped, given_at, read_text, scene_table, with_lines

    text = read_text(path)
    table = scene_table(text, path)
    with with_lines(path):
        scene = scene_from_table(table, str(path), text)
    others = dict(map(change, changes))
    if others:
        try:
            scene = scene.replace(others)
        except SceneError as error:
            raise SceneError([replace(fault, file="--set") for fault in error.faults]) from error
        table = scene.table()
    for note in doubts(scene, table):
        if note.code is DoubtCode.FREE and moves_freely(scene):
            continue  # what refuses such a machine says so, and `explain` lists its free motions
        field = str(note.data["field"])
        line = None if field in others else given_at(path, field)[2]
        say(f"{escaped(str(path))}{f':{line}' if line else ''}: warning: {note.text}")
    return scene


def change(text: str) -> tuple[str, Any]:
    """Path and value of "PATH=VALUE"; the value as TOML where it is one, else a text."""
    path, sign, value = path_text(text).partition("=")
    if not sign or not path.strip():
        raise InputError("--set", text, "PATH=VALUE, such as rotor.unbalance='120 g mm'")
    path = re.sub(r"\[(\d+)\]", r".\1", path.strip())  # as in other languages
    try:
        return path, tomllib.loads(f"value = {value}")["value"]
    except ValueError:
        return path, value.strip()


def load_study(path: Path, changes: Sequence[str] = ()) -> Sweep:
    """Sweep from a study file, as `load` reads a scene; of a machine file, with changes, before it varies."""
    from leblanc.liquid.validity import doubts
    from leblanc.scene.schema.load import read_toml
    from leblanc.studies.sweep.plan import is_machine, load_sweep, study_of
    from leblanc.studies.sweep.sampling import sampling_note

    if is_machine(read_toml(path)):
        return study_of(load(path, changes))
    if changes:
        raise InputError(
            "--set", changes[0], "left out with a study file: the value stands in its machine file"
        )
    plan = load_sweep(path)
    for doubt in doubts(plan.scene, plan.table):
        say(f"{plan.scene_path}: warning: {doubt.text}")
    if note := sampling_note(plan):
        say(f"{plan.name}: {note}")
    return plan


def processes(wanted: int | None) -> int:
    """As many as are wanted, or one on each core; InputError for fewer than one."""
    from leblanc.studies.held.holding import cores

    if wanted is not None and wanted < 1:
        raise InputError("--workers", wanted, "1 or more")
    return cores() if wanted is None else wanted
