"""`leblanc app`: a page with a machine as sliders beside its answer."""

from __future__ import annotations

from importlib import resources
from pathlib import Path
from typing import Annotated

import typer

from leblanc.core.terminal import say
from meshes.errors import InputError


def app(
    scene: Annotated[
        Path | None, typer.Argument(help="Scene file (TOML) [default: the starter of leblanc new].")
    ] = None,
    host: Annotated[str, typer.Option(help="Address that the page is served at.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Port of the page; 0 takes a free one.")] = 8080,
) -> None:
    """Serve a page with the machine as sliders beside its live answer, until Ctrl-C."""
    from leblanc.app import require_app
    from leblanc.scene.schema.load import read_text
    from leblanc.view.access import HERE

    if not 0 <= port <= 65535:
        raise InputError("--port", port, "from 0 to 65535")
    require_app()
    from leblanc.app.page import serve  # which loads what the extra brings

    if scene is None:
        text = resources.files("leblanc.scene").joinpath("starter.toml").read_text(encoding="utf-8")
    else:
        text = read_text(scene)
    if host.lower() not in HERE:
        say(f"{host} is not this machine alone: who reads the address below on its way can open the page")
    file = "scene.toml" if scene is None else str(scene)
    serve(text, file, host, port, lambda address: print(f"Open {address}", flush=True))
