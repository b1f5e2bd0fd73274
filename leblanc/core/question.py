"""A question is the signature of its call; quantities are read from texts with units, faults name keywords.

A parameter says in its type what it is: `speed: Annotated[Quantity, ANGULAR_SPEED, "Speed of the shaft."]`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from importlib import import_module
from inspect import signature
from typing import Annotated, Any, TypeVar, get_args, get_origin

from leblanc.core.units import Dimension, parse_option

Quantity = str | float  # a number in SI units, or a text with its unit
A = TypeVar("A")


@dataclass(frozen=True)
class Asked:
    """One parameter of a question."""

    name: str
    kind: Any  #: its type
    default: Any  #: `Parameter.empty` where it must be given
    text: str  #: what it is, a sentence
    dimension: Dimension | None  #: what it measures; None for what is no quantity


def parameters(question: Callable[..., Any]) -> Iterator[Asked]:
    """What a question asks for, in the order of its signature."""
    for each in signature(question).parameters.values():
        kind = each.annotation
        if isinstance(kind, str):
            kind = eval(kind, question.__globals__)
        said = get_args(kind) if get_origin(kind) is Annotated else (kind,)
        text = next((one for one in said[1:] if isinstance(one, str)), "")
        dimension = next((one for one in said[1:] if isinstance(one, Dimension)), None)
        yield Asked(each.name, said[0], each.default, text, dimension)


def ask(question: Callable[..., A], study: str, given: Mapping[str, Any]) -> A:
    """The answer of a study to the values of a question, its quantities in SI units.

    Parameters
    ----------
    question : whose signature says what each value is
    study : what answers, as "module:function"
    given : by name, as `locals()` of the question

    Raises
    ------
    InputError : a quantity that cannot be read, what the study refuses
    """
    values = dict(given)
    for one in parameters(question):
        if one.dimension is not None and values[one.name] is not None:
            values[one.name] = parse_option(values[one.name], one.dimension, one.name)
    module, _, name = study.partition(":")
    answer: A = getattr(import_module(module), name)(**values)
    return answer
