"""`leblanc mcp`: the questions as tools of a Model Context Protocol server over stdio.

Made from their signatures, as commands are. A call works in a process that is ended in time, without files.
"""

from __future__ import annotations

import json
import re
from importlib.util import find_spec
from inspect import Parameter, Signature
from typing import Annotated, Any

from leblanc.core.question import SCENE, called, parameters
from meshes.errors import InputError

_ASKED = ("explain", "run", "runup", "map", "optimise", "compare", "layer", "modes", "volume", "bearing")
_LEFT = ("folder", "progress", "timeout", "frames", "emulator", "mesh", "mesh_unit")  # files, and our own
_LONG = 25  # values of a list that are told


def mcp() -> None:
    """Serve the questions as tools by the Model Context Protocol, over stdio, until the input ends."""
    if find_spec("mcp") is None:
        raise InputError("mcp", "no mcp", "asked for once the extra is installed: pip install leblanc[mcp]")
    from mcp.server import MCPServer

    places = {name: f"leblanc.studies.{name}:{name}" for name in _ASKED}
    tools = [_tool(*one) for one in (places | {"machines": "leblanc.cli.mcp:machines"}).items()]
    MCPServer("leblanc", tools=tools, log_level="ERROR").run()


def machines(name: Annotated[str, "Example whose text is wanted, or table whose keys are."] = "") -> Any:
    """Examples of machine files and the tables in them; of a name the text, or the keys as JSON schema."""
    from leblanc.scene.examples import example_names, example_path, example_title

    schema = called("leblanc.scene.schema.editor:machine_schema")(called("leblanc.scene.scene:Scene"))
    tables = schema["$defs"]
    if name:
        return tables.get(name) or {name: example_path(name).read_text(encoding="utf-8")}
    return {"examples": {each: example_title(each) for each in example_names()}, "tables": sorted(tables)}


def _tool(name: str, place: str) -> Any:
    from mcp.server.mcpserver.exceptions import ToolError
    from mcp.server.mcpserver.tools import Tool
    from pydantic import Field

    def asked(timeout: float, **given: Any) -> Any:
        with called("leblanc.studies.processes:processes")(1) as pool:  # which ends it, whatever it does
            try:
                return pool.submit(_told, name, place, given).result(timeout)
            except (TimeoutError, ValueError) as error:  # which wrong input is
                raise ToolError(str(error) or f"timeout = {timeout:g} s is over without an answer") from None

    options: list[Any] = [("timeout", Annotated[float, Field(gt=0, le=3600)], 60.0, "Seconds it may take.")]
    for one in parameters(called(place)):
        if one.read is SCENE:
            kind: Any = str if one.default is Parameter.empty else str | None
            options.append(("machine", kind, one.default, "Text of a machine file (TOML)."))
            options.append(("sets", list[str], (), "Values in place of its own, as rotor.mass='4 kg'."))
        elif one.name not in _LEFT and not one.option.same:
            kind = str | dict[str, Any] | list[str] | None if "Any" in str(one.kind) else one.kind
            options.append((one.name, kind, one.default, one.text))
    typed = [(key, Annotated[kind, Field(description=text)], default) for key, kind, default, text in options]
    signed = [Parameter(key, Parameter.KEYWORD_ONLY, default=one, annotation=to) for key, to, one in typed]
    asked.__signature__ = Signature(signed, return_annotation=dict[str, Any])  # type: ignore[attr-defined]
    about = (called(place).__doc__ or "").partition("\n\n")[0]
    made = Tool.from_function(asked, name, description=f"{about} In SI units; lists thinned to {_LONG}.")
    made.fn_metadata.arg_model.model_config["extra"] = "forbid"
    made.fn_metadata.arg_model.model_rebuild(force=True)
    return made


def _told(name: str, place: str, given: dict[str, Any]) -> Any:
    """What a tool answers, in its process."""
    text, sets = given.pop("machine", None), given.pop("sets", ())
    if text is not None:
        table = called("leblanc.scene.schema.load:toml_of")(text, "machine")
        changes = dict(map(called("leblanc.cli.terminal.output:change"), sets))
        steps = dict.fromkeys(re.findall(r"\w+", " ".join(changes)))
        if '"section":' in json.dumps([table, changes, steps], default=str):
            raise InputError("section", "a file", "left out: no file is read")
        scene = called("leblanc.scene.scene:scene_from_table")(table, "machine", text)
        given["scene"] = scene.replace(changes)
    found = called(place)(**given)
    if name == "machines":
        return found
    words, kind = called("leblanc.app.live:words_of")(found), type(found).__name__
    listed = [one for one in called("leblanc.studies.outputs:outputs")(name).quantities if one.answer == kind]
    head = {key: words[key] for key in ("headline", "error", "cautions")} | {"faults": list(found.faults)}
    units = {one.name: one.unit for one in listed if one.unit and one.json}
    return head | {"units": units, "answer": _short(found.to_json())}


def _short(value: Any) -> Any:
    """Lists of `_LONG` values at most, evenly taken from all."""
    if isinstance(value, dict):
        return {key: _short(each) for key, each in value.items()}
    return [_short(each) for each in value[:: len(value) // _LONG + 1]] if isinstance(value, list) else value
