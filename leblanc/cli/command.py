"""The one way through: a command is made from a question, asks it, writes and shows the answer."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from inspect import Parameter, signature
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, get_origin

import typer

from leblanc.cli.terminal.output import FORCE, SET, load, load_study, processes
from leblanc.core.answer import Answer
from leblanc.core.contents import results_dir
from leblanc.core.files import out_dir, path_text
from leblanc.core.interrupts import raise_stopped
from leblanc.core.progress import working
from leblanc.core.question import (
    SCENE,
    STUDY,
    Asked,
    Points,
    Quantity,
    Reader,
    Texts,
    called,
    parameters,
    read,
    readable,
)
from leblanc.core.terminal import print_json, say, show
from meshes.errors import InputError

if TYPE_CHECKING:
    from leblanc.scene.scene import Scene

_OUT = "Folder for the files [default: out/<{} name>]."
_ONLY_OUT = "Folder for the figure; without it none is written."
_PNG = "Write figures as PNG as well."
_JSON = "Print one JSON object instead of words."
_FOLDER = ("folder", "out")  # of a study
_LOADED: Mapping[Any, Callable[..., Any]] = {SCENE: load, STUDY: load_study}


def command(question: Callable[..., Any]) -> Callable[..., None]:
    """The command of a question: its parameters as arguments and options, its answer in words or as JSON.

    The module of the question may name the `FILES` that its answer writes, the last being the data, and have
    a function `present` of the answer and of further options, which gives back what is shown.
    """
    if not question.__module__.startswith("leblanc."):
        readable(question)  # as `leblanc` does for its own, when Python asks for them
    everything = {one.name: one for one in parameters(question)}
    films = {name: one.option.film for name, one in everything.items() if one.option.film}
    apart = {*_FOLDER, "progress", *films, *(name for name, one in everything.items() if one.option.alone)}
    own = {name: one for name, one in everything.items() if name not in apart}
    present: Callable[..., Any] | None = getattr(sys.modules[question.__module__], "present", None)
    more = {one.name: one for one in list(parameters(present))[1:]} if present else {}
    asked = own | more
    files: tuple[str, ...] = getattr(sys.modules[question.__module__], "FILES", ())
    subject = next((one for one in own.values() if one.read in _LOADED), None)
    options = [_typed(one) for one in asked.values()]
    whole = subject is not None and subject.default is Parameter.empty  # it has a folder of its own
    if files and whole:
        options.append(_parameter("force", bool, typer.Option("--force", help=FORCE), False))
    if files:
        help_of_out = _OUT.format(subject.name) if subject is not None and whole else _ONLY_OUT
        options.append(_parameter("out", Path | None, typer.Option(help=help_of_out), None))
        options.append(_parameter("png", bool, typer.Option("--png", help=_PNG), False))
    if subject is not None:
        options.append(_parameter("set", list[str] | None, typer.Option("--set", help=SET), None))
    options.append(_parameter("json", bool, typer.Option("--json", help=_JSON), False))

    def run(
        json: bool, out: Path | None = None, png: bool = False, force: bool = False, **given: Any
    ) -> None:
        given |= {name: not given[name] for name, one in asked.items() if _usual(one)}
        machine, folder, where = None, None, f"leblanc {question.__name__}"
        changes = given.pop("set", None) or ()
        if changes and (subject is None or given[subject.name] is None):
            raise InputError("--set", changes[0], "left out without a scene")
        if subject is not None and given[subject.name] is not None:
            source = Path(given[subject.name])
            loaded = _LOADED[subject.read]
            machine, where = loaded(source, changes) if changes else loaded(source), str(source)
            if files and whole:
                state = getattr(machine, "scene", machine).digest
                part = " ".join(given[name] for name, one in own.items() if one.option.apart)
                folder = results_dir(machine.name, out, source, state, *files, force=force, part=part)
        if out is not None and not whole:
            folder = out_dir(question.__name__, out)
        values = {name: _value(own[name], given[name]) for name in own}
        values |= {name: folder for name in _FOLDER if name in everything}
        values |= {} if subject is None else {subject.name: machine}
        values |= films if given.get("animate") is not None else {}
        with working("preparing"):
            try:
                shown = read(present, {name: given[name] for name in more}) if present else {}
                answer: Answer = question(**values)
                typed = answer.typed
                answer = present(answer, **shown) if present else answer
            except InputError as error:
                raise _of_option(error, asked) from error
        line = _command_line(question.__name__, list(own.values()), given, changes)
        object.__setattr__(answer, "typed", replace(typed, command=line))
        finish(answer, where, json, folder, machine, png)

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
    png: bool = False,
) -> None:
    """Write the files of an answer into a folder, show it, and end as it asks for; faults name `where`."""
    drawn = [] if folder is None else called("leblanc.core.disk:write")(answer, folder, machine, png)
    answer.after()
    if json:
        print_json(answer.to_json())
    else:
        show(answer.blocks())
        if folder is not None and (answer.page or answer.data):
            print(_closing(answer, folder, drawn))
    if not (answer.page or answer.data):
        for one in drawn:
            say(f"wrote {one.svg}")
    if answer.interrupted:
        raise_stopped()
    fault = answer.fault(where)
    if fault is not None:
        raise fault
    if answer.closing:
        say(answer.closing)


def _parameter(name: str, kind: Any, option: Any, default: Any) -> Parameter:
    return Parameter(name, Parameter.KEYWORD_ONLY, default=default, annotation=Annotated[kind, option])


def _typed(one: Asked) -> Parameter:
    """A parameter as typer takes it: a scene is the path of its file, quantities are texts."""
    if one.read is SCENE:
        needed = one.default is Parameter.empty
        words = "Scene file (TOML)." if needed else one.text
        return _parameter(one.name, Path if needed else Path | None, typer.Argument(help=words), one.default)
    kind: Any = one.kind
    if kind == Texts:
        return _parameter(one.name, list[str] | None, typer.Option(*one.option.names, help=one.text), None)
    several = one.read.many if isinstance(one.read, Reader) else get_origin(kind) is Sequence
    if kind == Points:
        kind = int
    elif several:
        kind = list[str] if one.default is Parameter.empty else list[str] | None
    elif one.read is not None or kind == Quantity | None:  # of the latter the study knows the unit
        kind = str if one.default is Parameter.empty else str | None
    if kind is Any:  # typed by its name
        kind = str | None
    if one.option.argument:
        return _parameter(one.name, kind, typer.Argument(help=one.text), one.default)
    if _usual(one):
        return _parameter(one.name, bool, typer.Option(_option(one), help=one.text), False)
    if one.name == "workers":
        return _parameter(one.name, int | None, typer.Option(help=one.text), None)
    return _parameter(one.name, kind, typer.Option(*one.option.names, help=one.text), one.default)


def _usual(one: Asked) -> bool:
    """It is true unless --no-NAME is typed."""
    return one.default is True and not one.option.names


def _option(one: Asked, value: Any = None) -> str:
    """The option as it is typed; of a pair, as "--log/--linear", the second one for False."""
    if not one.option.names:
        return f"--{'no-' if _usual(one) else ''}{one.name.replace('_', '-')}"
    first, _, second = one.option.names[-1].partition("/")
    return second if second and value is False else first


def _value(one: Asked, value: Any) -> Any:
    return processes(value) if one.name == "workers" and one.default is not None else value


def _of_option(error: InputError, asked: Mapping[str, Asked]) -> InputError:
    """A fault that names the option in place of the keyword."""
    one = asked.get(error.field)
    if error.field != "out" and (one is None or one.option.argument):
        return error
    return InputError("--out" if one is None else _option(one), error.value, error.allowed)


def _command_line(name: str, asked: Sequence[Asked], given: Mapping[str, Any], changes: Sequence[str]) -> str:
    """The command that makes the same answer again, wherever its files go."""
    parts = ["leblanc", name]
    for one in asked:
        value = given[one.name]
        option = _option(one, value)
        if one.read is SCENE or one.option.argument:
            parts += [] if value is None else [str(value)]
        elif one.option.same or value == one.default:
            continue
        elif isinstance(value, bool):
            parts.append(option)
        else:
            for each in value if isinstance(value, list | tuple) else (value,):
                parts += [option, str(each)]
    parts += [part for change in changes for part in ("--set", change)]
    return " ".join(map(shlex.quote, map(path_text, parts)))


def _closing(answer: Answer, folder: Path, drawn: Sequence[Any]) -> str:
    """Where to look now."""
    seen = f"See {drawn[0].svg}" if drawn else ""
    first = f"Read {folder / answer.page}" if answer.page else seen
    data = f"the data are in {folder / answer.data}" if answer.data else ""
    return "; ".join(part for part in (first, data) if part)
