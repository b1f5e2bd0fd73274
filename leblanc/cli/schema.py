"""`leblanc schema`: the JSON schema of a machine file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from leblanc.core.files import writing
from leblanc.core.terminal import say


def schema(
    out: Annotated[Path | None, typer.Option(help="File to write it to, in place of the screen.")] = None,
) -> None:
    """Write the JSON schema of a machine file, by which editors complete its keys."""
    import json

    from leblanc.scene.scene import Scene
    from leblanc.scene.schema.editor import machine_schema

    text = json.dumps(machine_schema(Scene), indent=1)
    if out is None:
        print(text)
        return
    with writing(out) as part:
        part.write_text(text + "\n", encoding="utf-8")
    say(f"wrote {out}; a machine file that begins with #:schema {out} has editors complete its keys")
