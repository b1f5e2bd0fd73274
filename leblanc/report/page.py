"""The page of a report: one HTML file that needs nothing else, and what all reports have in common."""

from __future__ import annotations

import os
import platform
import shlex
import time
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any

from leblanc.core.answer import versions as of_packages
from leblanc.core.files import path_text, writing
from leblanc.core.notes import Note, NoteCode, one_line
from leblanc.report.parts import Inputs, Table, scene_inputs, table
from leblanc.results.choice import ModelSpan
from leblanc.scene.scene import Scene
from leblanc.scene.tasks import Optimisation
from leblanc.studies.run.words import described, error_words, speeds_words

# What the numbers, the files and the figures come from.
PACKAGES = (
    "leblanc", "numpy", "scipy", "numba", "py-pde", "scikit-fem", "h5py", "matplotlib",
)  # fmt: skip
AUTHORS = "The leblanc developers"
TITLE = "leblanc: passive liquid balancers and rotors partly filled with liquid"


@dataclass(frozen=True)
class About:
    """What a report is about and how to make it again."""

    name: str  #: of the scene
    source: str
    digest: str
    inputs: Inputs  #: what it says
    elsewhere: tuple[str, ...] = ()  #: assumed values that are not among the inputs
    command: str = ""  #: that writes the report; empty if it was no command
    data: str = ""  #: file of the numbers beside the report; empty if there is none


def about(
    scene: Scene,
    command: str = "",
    data: str = "",
    task: Optimisation | None = None,
    unused: tuple[str, ...] = (),
) -> About:
    """What a report of a scene is about; as for `About`, `task` of an optimisation in place of the scene's.

    `unused` are tables of the scene that the report's numbers do not depend on.
    """
    inputs = scene_inputs(scene, task, unused)
    paths = [cell.path for cell in inputs.cells if cell.assumed]
    elsewhere = tuple(
        path
        for path in scene.assumed
        if not any(own == path or own.startswith(f"{path}.") or path.startswith(f"{own}.") for own in paths)
    )
    return About(scene.name, scene.source, scene.digest, inputs, elsewhere, command, data)


def command_line(name: str, scene: Path, *options: tuple[str, object, object]) -> str:
    """The command that makes the same report again, wherever its files go.

    Options are name, value and default; those at their default are left out, a flag stands alone.
    """
    parts = ["leblanc", name, path_text(scene)]
    for option, value, default in options:
        if value != default:
            parts += [option] if value is True else [option, str(value)]
    return " ".join(map(shlex.quote, parts))


def versions() -> dict[str, str]:
    """Versions of Python and of what the numbers, files and figures come from."""
    return {"Python": platform.python_version()} | of_packages(PACKAGES)


def citation() -> str:
    """How to cite the program, as its citation file says."""
    return f"{AUTHORS}. {TITLE}. Version {versions()['leblanc']}."


def why(spans: Sequence[ModelSpan]) -> Table:
    """Which liquid model answers at which speeds, how well, and why."""
    rows = [
        (
            speeds_words(span),
            span.model + ("" if span.in_range else " (out of range)"),
            error_words(span),
            f"{span.reason[:1].upper()}{span.reason[1:]}.",
        )
        for span in spans
    ]
    return table("", ("Speeds (rpm)", "Model", "Estimated error", "Why"), rows, sentences=True)


def models(names: Sequence[str], held: bool = False) -> list[tuple[str, str]]:
    """Each liquid model that was used, and what it does and takes for granted."""
    return described(names, held)


def notes(given: Iterable[Note | str], elsewhere: Collection[NoteCode] = ()) -> list[str]:
    """Sentences of a result's notes without those that the page says in another place."""
    said = [str(note) for note in given if isinstance(note, str) or note.code not in elsewhere]
    return [line for line in map(one_line, said) if line]


def made_on() -> str:
    """Day on which a report is made, as 2026-11-22, in UTC; what SOURCE_DATE_EPOCH says where it is set.

    Only a report carries it: files of numbers and figures are the same whenever they are made.
    """
    given = os.environ.get("SOURCE_DATE_EPOCH", "")
    moment = time.gmtime(int(given)) if given.isdecimal() and len(given) < 12 else time.gmtime()
    return time.strftime("%Y-%m-%d", moment)


def write_page(body: str, what: About, parts: Mapping[str, Any], path: Path) -> None:
    """Write a report from the template of its body, which takes the parts."""
    from jinja2 import Environment, FunctionLoader, StrictUndefined

    page = Environment(
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        loader=FunctionLoader(_template),
    )
    common = {
        "name": one_line(what.name),
        "source": one_line(what.source),
        "inputs": what.inputs,
        "elsewhere": ", ".join(map(one_line, what.elsewhere)),
        "command": one_line(what.command),
        "data": what.data,
        "digest": what.digest,
        "date": made_on(),
        "versions": versions(),
        "citation": citation(),
    }
    text = page.get_template(f"{body}.html.j2").render(common, **parts)
    with writing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def _template(name: str) -> str:
    return resources.files("leblanc.report").joinpath("templates", name).read_text(encoding="utf-8")
