"""`leblanc new`: a scene to start from, the commented starter or an example."""

from __future__ import annotations

import errno
import json
import os
import re
from importlib import resources
from pathlib import Path
from typing import Annotated

import typer

from leblanc.core.files import writing
from leblanc.core.terminal import print_table, say
from leblanc.scene.schema.load import meant
from meshes.errors import InputError

# Examples from which machines of one's own begin.
_KINDS = {
    "jeffcott": "runup",
    "tub": "front_loader",
    "two_plane": "two_plane_rig",
    "top_loader": "top_loader",
    "balls": "balls",
    "exciter": "vibratory_table",
    "magnetic": "blood_pump",
    "spindle": "spindle",
}


def new(
    file: Annotated[
        Path | None, typer.Argument(help="Where to write it; scene.toml, or NAME.toml for an example.")
    ] = None,
    example: Annotated[
        str | None, typer.Option("--example", metavar="NAME", help="Write this example instead.")
    ] = None,
    kind: Annotated[
        str | None,
        typer.Option(metavar="KIND", help=f"Start a machine of this kind: {', '.join(_KINDS)}."),
    ] = None,
    list_: Annotated[bool, typer.Option("--list", help="List the examples and write nothing.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Overwrite a file that is there.")] = False,
) -> None:
    """Write a commented starter scene, a machine of a kind, or one of the examples."""
    if list_:
        _list()
        return
    if kind is not None and example is not None:
        raise InputError("--kind", kind, "left out with --example")
    if kind is not None:
        content, file = _of_kind(kind, file)
        next_step = "leblanc run"
    elif example is None:
        content = resources.files("leblanc.scene").joinpath("starter.toml").read_bytes()
        file, next_step = file or Path("scene.toml"), "leblanc run"
    else:
        content, name, next_step = _example(example)
        file = file or Path(name)
    if not force and os.path.lexists(file):
        raise FileExistsError(errno.EEXIST, "exists already; --force overwrites a file", str(file))
    if not file.parent.is_dir():
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), str(file))
    with writing(file) as part:
        part.write_bytes(content)
    say(f"wrote {file}; try: {next_step} {file}")


def _of_kind(kind: str, file: Path | None) -> tuple[bytes, Path]:
    """Content of the example of a kind of machine under the name of one's own file, and that file."""
    from leblanc.scene.examples import example_path

    if kind not in _KINDS:
        raise InputError("--kind", kind, f"one of: {', '.join(_KINDS)}{meant(kind, _KINDS)}")
    file = file or Path(f"my_{kind}.toml")
    text = example_path(_KINDS[kind]).read_text(encoding="utf-8")
    name = json.dumps(file.stem.replace("_", " ").capitalize(), ensure_ascii=False)
    head = f"# Every value is that of the example {_KINDS[kind]}: put your own in their places.\n#\n"
    text, found = re.subn(r'(?m)^name = ".*"', lambda _: f"name = {name}", text, count=1)
    assert found == 1
    return (head + text).encode(), file


def _example(name: str) -> tuple[bytes, str, str]:
    """Content of an example, its file's name, and what to do with it."""
    from leblanc.scene.examples import example_path
    from leblanc.scene.schema.load import read_toml

    path = example_path(name)
    content = path.read_bytes()
    scene = read_toml(path).get("scene")
    if not isinstance(scene, str):
        return content, path.name, "leblanc run"
    # A study: its scene is looked for beside it.
    beside = Path(scene).name
    content = content.replace(f'"{scene}"'.encode(), f'"{beside}"'.encode())
    return content, path.name, f"leblanc new --example {Path(scene).stem}; leblanc sweep"


def _list() -> None:
    """Names of the examples, and what each is."""
    from leblanc.scene.examples import example_names, example_title

    print_table([(name, example_title(name)) for name in example_names()])
