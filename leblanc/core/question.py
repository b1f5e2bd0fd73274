"""A question is the signature of its call; its quantities are read from texts with units, faults name the keyword.

A parameter says in its type what it is: `speed: Annotated[Quantity, ANGULAR_SPEED, "Speed of the shaft."]`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from importlib import import_module
from inspect import Parameter, signature
from typing import Annotated, Any, TypeVar, get_args, get_origin

from leblanc.units import Dimension, parse_option
from meshes.errors import InputError

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


def command(question: Callable[..., Any]) -> Callable[..., None]:
    """The command of a question: its parameters as options, its answer printed in words or as JSON."""
    import typer

    options = [
        Parameter(
            one.name,
            Parameter.KEYWORD_ONLY,
            default=one.default,
            annotation=Annotated[_typed(one), typer.Option(help=one.text)],
        )
        for one in parameters(question)
    ]
    text = "Print one JSON object instead of words."
    options.append(
        Parameter(
            "json",
            Parameter.KEYWORD_ONLY,
            default=False,
            annotation=Annotated[bool, typer.Option("--json", help=text)],
        )
    )

    def run(json: bool, **given: Any) -> None:
        from leblanc.cli.terminal.output import print_json
        from leblanc.core.terminal import show
        from leblanc.scene.schema.load import NotConverged

        try:
            answer = question(**given)
        except InputError as error:
            raise _of_option(error, given) from error
        if json:
            print_json(answer.to_json())
        else:
            show(answer.blocks())
        if answer.failed:
            raise NotConverged([f"leblanc {question.__name__}: {answer.failed}"])

    run.__doc__ = (question.__doc__ or "").partition("\n")[0]
    run.__signature__ = signature(question).replace(parameters=options, return_annotation=None)
    return run


def _of_option(error: InputError, given: Mapping[str, Any]) -> InputError:
    """A fault that names the option in place of the keyword."""
    if error.field not in given:
        return error
    return InputError(f"--{error.field.replace('_', '-')}", error.value, error.allowed)


def _typed(one: Asked) -> Any:
    """The type of an option: quantities are texts."""
    if one.dimension is None:
        return one.kind
    return str if one.default is Parameter.empty else str | None
