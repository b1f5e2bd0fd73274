"""What the answers hold: every quantity with its unit, meaning, dimensions, error and equation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from leblanc.core.question import Option, ask

if TYPE_CHECKING:
    from leblanc.studies.outputs.answer import OutputsAnswer


def outputs(
    question: Annotated[
        str, Option(argument=True), "Command whose quantities are listed, such as run [default: all]."
    ] = "",
) -> OutputsAnswer:
    """Quantities that a command computes: name, unit, meaning, dimensions, error, equation.

    Raises
    ------
    InputError : no such command

    Examples
    --------
    >>> import leblanc as lb
    >>> [one.unit for one in lb.outputs("bearing").quantities if one.name == "bpfo"]
    ['rad s-1']
    """
    return ask(outputs, "leblanc.studies.outputs.study:answer", locals())
