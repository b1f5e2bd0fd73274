"""A question is the signature of its call; quantities are read from texts with units, faults name keywords.

A parameter says in its type what it is: `speed: Annotated[Quantity, ANGULAR_SPEED, "Speed of the shaft."]`.
No options of its command are `folder`, or `out` as Python calls it, where a study keeps what another run
takes up, and `progress`.
"""

from __future__ import annotations

import builtins
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from importlib import import_module
from inspect import Parameter, Signature, signature
from typing import Annotated, Any, TypeVar, get_args, get_origin

from leblanc.core.progress import heard, told
from leblanc.core.units import Dimension, parse_option

Quantity = str | float  # a number in SI units, or a text with its unit
Texts = str | Sequence[str]  # one text or several; the option is typed anew for each
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
STUDY = Reader("leblanc.studies.sweep.plan:study_of")  # a sweep, or the path of its study file
FILE = Reader("leblanc.core.files:path_of")  # the path of a file
FRICTION = Reader("leblanc.scene.scene:friction_of")  # a law, its text, or its table
LIQUID = Reader("leblanc.scene.scene:liquid_of")  # a liquid, or a known name


@dataclass(frozen=True)
class Option:
    """How a parameter is typed where that is not --its-name."""

    names: tuple[str, ...] = ()  #: as typer takes them, as "--from"; what is usually true is --no-NAME
    argument: bool = False  #: by its place, without a name
    same: bool = False  #: the answer does not depend on it
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
    for each in signature(question).parameters.values():
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
    return answer


def read(question: Callable[..., Any], given: Mapping[str, Any]) -> dict[str, Any]:
    """Values by the names of a question's parameters, each read as its type says."""
    values = dict(given)
    for one in parameters(question):
        value = given.get(one.name)
        if one.name not in given or (value is None and one.default is None):
            continue
        if isinstance(one.read, Reader):
            values[one.name] = called(one.read.address)(value, one.name)
        elif one.read is not None and value is not None:
            values[one.name] = parse_option(value, one.read, one.name)
    return values
