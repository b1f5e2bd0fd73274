"""`leblanc new`: a scene to start from, the commented starter or an example."""

from __future__ import annotations

import errno
import os
from importlib import resources
from pathlib import Path
from typing import Annotated

import typer

from leblanc.core.files import writing
from leblanc.core.terminal import say


def new(
    file: Annotated[
        Path | None, typer.Argument(help="Where to write it; scene.toml, or NAME.toml for an example.")
    ] = None,
    example: Annotated[
        str | None, typer.Option("--example", metavar="NAME", help="Write this example instead.")
    ] = None,
    list_: Annotated[bool, typer.Option("--list", help="List the examples and write nothing.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Overwrite a file that is there.")] = False,
) -> None:
    """Write a commented starter scene, or one of the examples."""
    if list_:
        _list()
        return
    if example is None:
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

    names = example_names()
    width = max(map(len, names))
    for name in names:
        print(f"{name:{width}}  {example_title(name)}")
