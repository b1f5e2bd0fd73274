"""`leblanc new`: a commented scene to start from."""

from __future__ import annotations

import errno
import os
from importlib import resources
from pathlib import Path
from typing import Annotated

import typer

from leblanc.cli.output import say, writing


def new(
    file: Annotated[Path, typer.Argument(help="Where to write it.")] = Path("scene.toml"),
    force: Annotated[bool, typer.Option("--force", help="Overwrite a file that is there.")] = False,
) -> None:
    """Write a commented starter scene."""
    if not force and os.path.lexists(file):
        raise FileExistsError(errno.EEXIST, "exists already; --force overwrites a file", str(file))
    starter = resources.files("leblanc.scene").joinpath("starter.toml").read_bytes()
    with writing(file) as part:
        part.write_bytes(starter)
    say(f"wrote {file}; try: leblanc run {file}")
