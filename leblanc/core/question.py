"""A question is the signature of its call; quantities are read from texts with units, faults name keywords.

A parameter says in its type what it is: `speed: Annotated[Quantity, ANGULAR_SPEED, "Speed of the shaft."]`.
No options of its command are `folder`, or `out` as Python calls it, where a study keeps what another run
takes up, and `progress`.
"""

from __future__ import annotations

import builtins
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import nullcontext, suppress
from dataclasses import dataclass
from importlib import import_module
from inspect import Parameter, Signature, cleandoc, signature
from numbers import Integral, Real
from os import PathLike
from types import NoneType, UnionType
from typing import Annotated, Any, TypeVar, Union, get_args, get_origin

from leblanc.core.progress import heard, told
from leblanc.core.units import Dimension, parse_option
from meshes.errors import InputError

Quantity = str | float  # a number in SI units, or a text with its unit
Texts = str | Sequence[str]  # one text or several; the option is typed anew for each
Points = int | Sequence[Quantity]  # how many, evenly spaced, or each of them; a command takes how many
A = TypeVar("A")


class Names(dict[str, Any]):
    """Names of a module; one that only a type checker imports stands for any type."""

    def __missing__(self, name: str) -> Any:
        return getattr(builtins, name, Any)


@dataclass(frozen=True)
class Reader:
    """What reads a value that is no quantity."""

    address: str  #: "module:function" of the value and the name of its keyword
    many: bool = False  #: its option may be repeated; a command gives a list of texts


SCENE = Reader("leblanc.scene.scene:scene_of")  # a scene, or the path of its file
STUDY = Reader("leblanc.studies.sweep.plan:study_of")  # a sweep or a machine, or the path of its file
VARY = Reader("leblanc.studies.sweep.plan:vary_of", many=True)  # values by paths, or texts PATH=VALUES
FILE = Reader("leblanc.core.files:path_of")  # the path of a file
FRICTION = Reader("leblanc.scene.scene:friction_of")  # a law, its text, or its table
LIQUID = Reader("leblanc.scene.scene:liquid_of")  # a liquid, or a known name


@dataclass(frozen=True)
class Option:
    """How a parameter is typed where that is not --its-name."""

    names: tuple[str, ...] = ()  #: as typer takes them, as "--from"; what is usually true is --no-NAME
    argument: bool = False  #: by its place, without a name
    alone: bool = False  #: no option of a command: Python alone has it
    same: bool = False  #: the answer does not depend on it
    apart: bool = False  #: files of one value stand beside those of another
    film: int = 0  #: no option: so many where the command is asked for a film by --animate


@dataclass(frozen=True)
class Asked:
    """One parameter of a question."""

    name: str
    kind: Any  #: its type
    default: Any  #: `Parameter.empty` where it must be given
    text: str  #: what it is, a sentence
    read: Dimension | Reader | None  #: what it measures, or what reads it; None for what is taken as it is
    option: Option


def parameters(question: Callable[..., Any]) -> Iterator[Asked]:
    """What a question asks for, in the order of its signature."""
    written: Signature = getattr(question, "__asked__", None) or signature(question)
    for each in written.parameters.values():
        kind = each.annotation
        if isinstance(kind, str):
            kind = eval(kind, {}, Names(question.__globals__))
        said = get_args(kind) if get_origin(kind) is Annotated else (kind,)
        yield Asked(
            *(each.name, said[0], each.default),
            text=next((one for one in said[1:] if isinstance(one, str)), ""),
            read=next((one for one in said[1:] if isinstance(one, Dimension | Reader)), None),
            option=next((one for one in said[1:] if isinstance(one, Option)), Option()),
        )


def together(*questions: Callable[..., Any]) -> Signature:
    """Parameters of several questions behind one command; options are None where they are not given."""
    found: dict[str, Parameter] = {}
    for question in questions:
        for name, each in signature(question).parameters.items():
            found.setdefault(name, each)
    return Signature(
        [
            each
            if each.default is Parameter.empty
            else each.replace(default=None, kind=Parameter.KEYWORD_ONLY)
            for each in found.values()
        ]
    )


def called(address: str) -> Callable[..., Any]:
    """The function at "module:function", loaded when it is first used."""
    module, _, name = address.partition(":")
    found: Callable[..., Any] = getattr(import_module(module), name)
    return found


def ask(question: Callable[..., A], study: str, given: Mapping[str, Any]) -> A:
    """The answer of a study, "module:function", to the values of a question, as `locals()` of it has them.

    `progress` is no value of the study: it is called with what is done and the total, as `update` says them.

    Raises
    ------
    InputError : a quantity that cannot be read, what the study refuses
    """
    values = read(question, given)
    progress = values.pop("progress", None)
    with nullcontext() if progress is None else told(heard(progress)):
        answer: A = called(study)(**values)
    called("leblanc.core.quantities:seal")(answer)
    called("leblanc.core.answer:as_typed")(answer, **values)
    return answer


def read(question: Callable[..., Any], given: Mapping[str, Any]) -> dict[str, Any]:
    """Values by the names of a question's parameters, each read as its type says."""
    values = dict(given)
    for one in parameters(question):
        value = given.get(one.name)
        if one.name not in given or (value is None and one.default is None):
            continue
        value = values[one.name]
        if isinstance(one.read, Reader):
            if value is None and one.default is Parameter.empty:
                raise InputError(one.name, None, "given")
            values[one.name] = called(one.read.address)(value, one.name)
        elif one.read is None:
            values[one.name] = _typed(value, one.kind, one.name)
        elif one.kind == Points:
            values[one.name] = _points(value, one.read, one.name)
        elif value is not None:
            values[one.name] = parse_option(value, one.read, one.name)
        elif one.default is not None and NoneType not in _kinds(one.kind):
            raise InputError(one.name, None, one.read.allowed)
    return values


def _points(value: Any, dimension: Dimension, name: str) -> int | tuple[float, ...]:
    """How many, or each of them in SI units."""
    points = _typed(value, Points, name)
    if isinstance(points, int):
        return points
    each = points.tolist() if hasattr(points, "tolist") else points
    return tuple(parse_option(one, dimension, f"{name}.{k}") for k, one in enumerate(each))


_LARGE = 1e15  # whole numbers up to here are printed

# What a value may be by its type: who tells, what it becomes, and how a message says it.
_PLAIN: dict[Any, tuple[Callable[[Any], bool], Callable[[Any], Any], str]] = {
    bool: (lambda value: type(value).__name__ in ("bool", "bool_"), bool, "True or False"),
    int: (lambda value: isinstance(value, Integral) and not isinstance(value, bool), int, "a whole number"),
    float: (lambda value: isinstance(value, Real) and not isinstance(value, bool), float, "a number"),
    str: (lambda value: isinstance(value, str), str, "a text"),
    PathLike: (lambda value: isinstance(value, PathLike), lambda value: value, "the path of a file"),
    Sequence: (
        lambda value: isinstance(value, list | tuple) or (hasattr(value, "tolist") and value.ndim > 0),
        lambda value: value,
        "a list",
    ),
    Mapping: (lambda value: isinstance(value, Mapping), lambda value: value, "a table"),
    Callable: (callable, lambda value: value, "a function"),
}


def _kinds(kind: Any) -> tuple[Any, ...]:
    """The types of which a value may be one; of a generic one what it is made from."""
    parts = get_args(kind) if get_origin(kind) in (Union, UnionType) else (kind,)
    names = {"Sequence": Sequence, "Mapping": Mapping, "Callable": Callable, "PathLike": PathLike}
    origins = ((get_origin(part) or part) for part in parts)
    found = (names.get(getattr(part, "__name__", ""), part) for part in origins)
    return tuple(Sequence if part in (list, tuple) else part for part in found)


def _typed(value: Any, kind: Any, name: str) -> Any:
    """A value that is of one of its types; types of our own are for their study to tell."""
    kinds = _kinds(kind)
    if kind is Parameter.empty or not all(one in _PLAIN or one is NoneType for one in kinds):
        return value
    if value is None and NoneType in kinds:
        return None
    for one in kinds:
        if one is not NoneType and _PLAIN[one][0](value):
            if one is Sequence and isinstance(value, list | tuple):
                return [_typed(each, _of_list(kind), f"{name}.{k}") for k, each in enumerate(value)]
            with suppress(OverflowError):  # a whole number beyond all others
                return _PLAIN[one][1](value)
    said = dict.fromkeys(_PLAIN[one][2] for one in kinds if one is not NoneType)
    given = value if isinstance(value, str | float | None) else type(value).__name__
    given = value if isinstance(value, int) and abs(value) < _LARGE else given
    raise InputError(name, given, " or ".join(said))


def _of_list(kind: Any) -> Any:
    """Of what a list is made by its type; `Parameter.empty`, which is anything, where it does not say."""
    parts = get_args(kind) if get_origin(kind) in (Union, UnionType) else (kind,)
    lists = (get_args(part)[0] for part in parts if get_args(part) and Sequence in _kinds(part))
    return next(lists, Parameter.empty)


_READ = {
    SCENE: "Scene | dict | str | PathLike",
    STUDY: "Scene | dict | str | PathLike",
    VARY: "dict",
    FILE: "str | PathLike",
    FRICTION: "Friction | str | dict",
    LIQUID: "Liquid | str",
}


class _Text(str):
    """An annotation that is shown without quotes."""

    def __repr__(self) -> str:
        return str(self)


def shown(kind: Any) -> str:
    """A type without what checks it."""
    origin, parts = get_origin(kind), get_args(kind)
    if isinstance(kind, list):  # what a function takes
        return f"[{', '.join(map(shown, kind))}]"
    if origin is Annotated:
        return shown(parts[0])
    if origin in (Union, UnionType):
        return " | ".join(dict.fromkeys(map(shown, parts)))
    if origin is not None:
        inside = ", ".join("..." if part is Ellipsis else shown(part) for part in parts)
        return f"{getattr(origin, '__name__', str(origin))}[{inside}]"
    if kind is NoneType or kind is None:
        return "None"
    return kind.__name__ if isinstance(kind, type) else str(kind).rpartition(".")[2]


def readable(question: Callable[..., Any]) -> None:
    """Give a question a signature of plain types, and its help what each parameter is."""
    if hasattr(question, "__asked__"):
        return
    asked, own = list(parameters(question)), signature(question)
    made, lines = [], []
    for one in asked:
        said = "float | str" if one.read is not None and one.kind != Points else shown(one.kind)
        said = _READ.get(one.read, said) if one.read in _READ else said
        if one.default is None and "None" not in said:
            said += " | None"
        made.append(own.parameters[one.name].replace(annotation=_Text(said)))
        if one.text:
            text = f"{one.text[:1].lower()}{one.text[1:].rstrip('.')}"
            if one.name == "workers":  # of which a command takes as many as there are cores
                text = re.sub(r"\[default: .*\]", f"[default: {one.default}]", text)
            lines.append(f"{one.name} : {text}")
    result = own.return_annotation
    question.__asked__ = own  # type: ignore[attr-defined]  # what the command is made from
    question.__signature__ = own.replace(  # type: ignore[attr-defined]
        parameters=made, return_annotation=_Text(result) if isinstance(result, str) else result
    )
    words = cleandoc(question.__doc__ or "")
    if lines and "Parameters\n" not in words:
        head, _, rest = words.partition("\nRaises\n")
        block = "\n".join(["Parameters", "----------", *lines])
        question.__doc__ = f"{head.rstrip()}\n\n{block}\n" + (f"\nRaises\n{rest}" if rest else "")


def of_fields(fields: dict[str, Any]) -> Signature:
    """Signature of a table of a scene from its fields."""
    required = [name for name, field in fields.items() if field.is_required()]
    order = [*required, *(name for name in fields if name not in required)]
    return Signature(
        [
            Parameter(
                name,
                Parameter.KEYWORD_ONLY,
                default=Parameter.empty if fields[name].is_required() else fields[name].get_default(),
                annotation=_Text(shown(fields[name].annotation)),
            )
            for name in order
        ]
    )
