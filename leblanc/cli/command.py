"""A command made from the signature of a question."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from inspect import Parameter, signature
from typing import Annotated, Any

import typer

from leblanc.core.answer import NotConverged
from leblanc.core.question import Asked, parameters
from leblanc.core.terminal import print_json, show
from meshes.errors import InputError


def command(question: Callable[..., Any]) -> Callable[..., None]:
    """The command of a question: its parameters as options, its answer printed in words or as JSON."""

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
