"""The one way through: a command is made from a question, asks it, writes and shows the answer."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Callable, Mapping, Sequence
from inspect import Parameter, signature
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from leblanc.cli.terminal.output import load, processes
from leblanc.core.answer import Answer, NotConverged
from leblanc.core.contents import results_dir
from leblanc.core.files import out_dir, path_text
from leblanc.core.progress import working
from leblanc.core.question import SCENE, Asked, Quantity, Texts, called, parameters, read
from leblanc.core.terminal import print_json, say, show
from meshes.errors import InputError

if TYPE_CHECKING:
    from leblanc.scene.scene import Scene

_OUT = "Folder for the files [default: out/<scene name>]."
_ONLY_OUT = "Folder for the figure; without it none is written."
_JSON = "Print one JSON object instead of words."


def command(question: Callable[..., Any]) -> Callable[..., None]:
    """The command of a question: its parameters as arguments and options, its answer in words or as JSON.

    The module of the question may name the `FILES` that its answer writes, the last being the data, and have
    a function `present` of the answer and of further options, which gives back what is shown.
    """
    everything = {one.name: one for one in parameters(question)}
    own = {name: one for name, one in everything.items() if name not in ("folder", "progress")}
    present: Callable[..., Any] | None = getattr(sys.modules[question.__module__], "present", None)
    more = {one.name: one for one in list(parameters(present))[1:]} if present else {}
    asked = own | more
    files: tuple[str, ...] = getattr(sys.modules[question.__module__], "FILES", ())
    options = [_typed(one) for one in asked.values()]
    if files:
        help_of_out = _OUT if "scene" in asked else _ONLY_OUT
        options.append(_parameter("out", Path | None, typer.Option(help=help_of_out), None))
    options.append(_parameter("json", bool, typer.Option("--json", help=_JSON), False))

    def run(json: bool, out: Path | None = None, **given: Any) -> None:
        source = given.get("scene")
        machine, folder, where = None, None, f"leblanc {question.__name__}"
        if source is not None:
            machine, where = load(source), str(source)
            if files:
                folder = results_dir(machine.name, out, source, machine.digest, *files)
        elif out is not None:
            folder = out_dir(question.__name__, out)
        values = {name: _value(own[name], given[name]) for name in own}
        values |= {"folder": folder} if "folder" in everything else {}
        with working("preparing"):
            try:
                shown = read(present, {name: given[name] for name in more}) if present else {}
                answer: Answer = question(**values | ({} if machine is None else {"scene": machine}))
                answer = present(answer, **shown) if present else answer
            except InputError as error:
                raise _of_option(error, asked) from error
        line = _command_line(question.__name__, list(own.values()), given)
        finish(answer, where, json, folder, machine, line)

    run.__doc__ = (question.__doc__ or "").partition("\n")[0]
    made = signature(question).replace(parameters=options, return_annotation=None)
    run.__signature__ = made  # type: ignore[attr-defined]  # what typer reads
    return run


def finish(
    answer: Answer,
    where: str,
    json: bool,
    folder: Path | None = None,
    machine: Scene | None = None,
    line: str = "",
) -> None:
    """Write the files of an answer into a folder, show it, and end as it asks for.

    Faults name `where` they are; `line` is the command that makes the answer again.
    """
    drawn = [] if folder is None else write(answer, folder, machine, line)
    if json:
        print_json(answer.to_json())
    else:
        show(answer.blocks())
        if folder is not None and (answer.page or answer.data):
            print(_closing(answer, folder))
    if not (answer.page or answer.data):
        for one in drawn:
            say(f"wrote {one.png}")
    if answer.interrupted:
        raise KeyboardInterrupt
    if answer.failed:
        raise NotConverged([f"{where}: {fault}" for fault in answer.failed])
    if answer.done:
        say(answer.done)


def _parameter(name: str, kind: Any, option: Any, default: Any) -> Parameter:
    return Parameter(name, Parameter.KEYWORD_ONLY, default=default, annotation=Annotated[kind, option])


def _typed(one: Asked) -> Parameter:
    """A parameter as typer takes it: a scene is the path of its file, quantities are texts."""
    if one.read is SCENE:
        return _parameter(one.name, Path, typer.Argument(help="Scene file (TOML)."), Parameter.empty)
    kind = one.kind
    if kind == Texts:
        return _parameter(one.name, list[str] | None, typer.Option(*one.option.names, help=one.text), None)
    if one.read is not None or kind == Quantity | None:  # of the latter the study knows the unit
        kind = str if one.default is Parameter.empty else str | None
    if one.name == "workers":
        return _parameter(one.name, int | None, typer.Option(help=one.text), None)
    return _parameter(one.name, kind, typer.Option(*one.option.names, help=one.text), one.default)


def _value(one: Asked, value: Any) -> Any:
    return processes(value) if one.name == "workers" else value


def _option(one: Asked, value: Any = None) -> str:
    """Its option as typed; of a pair, as "--log/--linear", the second one for False."""
    names = one.option.names[-1] if one.option.names else f"--{one.name.replace('_', '-')}"
    first, _, second = names.partition("/")
    return second if value is False or not first else first


def _of_option(error: InputError, asked: Mapping[str, Asked]) -> InputError:
    """A fault that names the option in place of the keyword."""
    one = asked.get(error.field)
    return error if one is None else InputError(_option(one), error.value, error.allowed)


def _command_line(name: str, asked: Sequence[Asked], given: Mapping[str, Any]) -> str:
    """The command that makes the same answer again, wherever its files go."""
    parts = ["leblanc", name]
    for one in asked:
        value = given[one.name]
        option = _option(one, value)
        if one.read is SCENE:
            parts.append(path_text(value))
        elif one.option.same or value == one.default:
            continue
        elif isinstance(value, bool):
            parts.append(option)
        else:
            for each in value if isinstance(value, list | tuple) else (value,):
                parts += [option, str(each)]
    return " ".join(map(shlex.quote, parts))


def write(answer: Answer, folder: Path, machine: Scene | None = None, line: str = "") -> list[Any]:
    """All files of an answer: data, pictures, report; those of the pictures."""
    from leblanc.core.blocks import Picture, flat
    from leblanc.core.netcdf import write_netcdf
    from leblanc.core.page import write_page

    if answer.data:
        write_netcdf(answer.named_arrays(), folder / answer.data)
    pictures = (block for block in flat(answer.blocks(), "page") if isinstance(block, Picture))
    figures = {one.name: _drawn(answer, one, folder) for one in pictures}
    if answer.page:
        assert machine is not None
        from leblanc.scene.inputs import about

        what = about(machine, line, answer.data, answer.task, answer.unused)
        write_page(answer.title, answer.blocks(), what, figures, folder / answer.page)
    return list(figures.values())


def _drawn(answer: Answer, picture: Any, folder: Path) -> Any:
    from leblanc.figures.drawing.page import save

    return save(called(picture.draw)(answer), folder, picture.name, picture.title)


def _closing(answer: Answer, folder: Path) -> str:
    """Where to look now."""
    first = f"Read {folder / answer.page}" if answer.page else ""
    data = f"the data are in {folder / answer.data}" if answer.data else ""
    return "; ".join(part for part in (first, data) if part)
