"""Signatures as a reader wants them: types, not what checks them; what each parameter is, in the help."""

from __future__ import annotations

from collections.abc import Callable
from inspect import Parameter, Signature, cleandoc, signature
from types import NoneType, UnionType
from typing import Annotated, Any, Union, get_args, get_origin

from leblanc.core.question import FILE, FRICTION, LIQUID, SCENE, parameters

_READ = {
    SCENE: "Scene | dict | str | PathLike",
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
        said = "float | str" if one.read is not None else shown(one.kind)
        said = _READ.get(one.read, said) if one.read in _READ else said
        if one.default is None and "None" not in said:
            said += " | None"
        made.append(own.parameters[one.name].replace(annotation=_Text(said)))
        if one.text:
            lines.append(f"{one.name} : {one.text[:1].lower()}{one.text[1:].rstrip('.')}")
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
