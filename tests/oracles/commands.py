"""What the commands answer, as the JSON that scripts rely on, without their figures and reports."""

from __future__ import annotations

import contextlib
import io
import json
from typing import Any

import numpy as np

from leblanc.cli import main
from leblanc.scene.scene import scene_from_table
from leblanc.studies.map.study import answer
from leblanc.studies.optimise.study import optimise_scene
from leblanc.studies.run.study import run_scene
from leblanc.studies.runup.study import runup_scene

Answer = dict[str, Any]


def run(table: dict[str, Any]) -> Answer:
    return run_scene(scene_from_table(table)).to_json()


def whirl_map(table: dict[str, Any], volumes: int = 4, speeds: int = 5) -> Answer:
    return answer(scene_from_table(table), None, speeds, volumes=volumes).to_json()


def optimum(table: dict[str, Any]) -> Answer:
    return optimise_scene(scene_from_table(table), front=False).to_json()


def runup(table: dict[str, Any]) -> Answer:
    return runup_scene(scene_from_table(table), check=False).to_json()


def by_options(command: str, options: dict[str, Any]) -> Answer:
    """A command that takes all it needs as options: layer, modes, volume."""
    words = [command, "--json"]
    for name, value in options.items():
        words.append(f"--{name}")
        if value is not True:
            words.append(value if isinstance(value, str) else repr(value))
    out, said = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(said):
        code = main(words)
    assert code == 0, said.getvalue()
    return json.loads(out.getvalue())  # type: ignore[no-any-return]


def numbers(values: Any) -> np.ndarray:
    """Nested lists as an array, in one row where they differ in length; null is not a number."""
    if isinstance(values, list | tuple):
        parts = [numbers(one) for one in values]
        even = len({part.shape for part in parts}) <= 1
        return np.array(parts) if even else np.concatenate([part.ravel() for part in parts])
    return np.array(np.nan if values is None else values)
