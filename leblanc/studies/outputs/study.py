"""Quantities read from the declarations of all answers."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from importlib import import_module
from importlib.metadata import EntryPoint
from inspect import isabstract
from pathlib import Path
from typing import Any

import leblanc
from leblanc.core.answer import Answer
from leblanc.core.quantities import quantities, types_of
from leblanc.core.units import with_peak
from leblanc.registry import COMMANDS, announced, sound
from leblanc.studies.outputs.answer import Output, OutputsAnswer
from meshes.errors import InputError


def answer(question: str) -> OutputsAnswer:
    """What a question answers with, all of them where it is empty."""
    kinds = answers()
    names = list(dict.fromkeys(kind.command for kind in kinds))
    if question and question not in names:
        others = announced(COMMANDS)
        kinds = _announced_answers(others[question]) if question in others else []
        if not kinds:
            raise InputError("question", question, f"one of: {', '.join((*names, *others))}")
    chosen = [kind for kind in kinds if question in ("", kind.command)]
    found: dict[tuple[str, str], Output] = {}
    for one in (each for kind in chosen for each in _outputs(kind, kind)):
        key = one.answer, one.name
        if key not in found or not found[key].variable:  # of the same in two records that which is stored
            found[key] = one
    titles = {kind.__name__: (kind.__doc__ or "").partition("\n")[0] for kind in chosen}
    return OutputsAnswer(tuple(found.values()), titles)


def answers() -> list[type[Answer]]:
    """The classes of all answers of leblanc, those of one command together."""
    root = Path(leblanc.__file__).parent
    for path in sorted(root.rglob("answer.py")):
        import_module(".".join(("leblanc", *path.relative_to(root).with_suffix("").parts)))
    kinds = {
        kind
        for kind in _below(Answer)
        if kind.__module__.startswith("leblanc.") and not (kind.__name__.startswith("_") or isabstract(kind))
    }
    return sorted(kinds - {OutputsAnswer}, key=lambda kind: (kind.command, kind.__name__))


def _announced_answers(entry: EntryPoint) -> list[type[Answer]]:
    """The classes of the answers of a command of another package, in the order of their names."""
    with sound(entry.name, f"loading {entry.value}", "question"):
        entry.load()
    found = (
        kind for kind in _below(Answer) if getattr(kind, "command", "") == entry.name and not isabstract(kind)
    )
    return sorted(found, key=lambda kind: kind.__name__)


def _below(kind: Any) -> Iterator[type[Answer]]:
    for one in kind.__subclasses__():
        yield one
        yield from _below(one)


def _outputs(
    top: type[Answer],
    kind: type,
    path: str = "",
    prefix: str = "",
    only: Collection[str] = (),
    rows: tuple[str, ...] = (),
) -> Iterator[Output]:
    """Quantities of a class and of the records in it, which stand in the answer `top` at a path."""
    for name, q in quantities(kind).items():
        if only and name not in only:
            continue
        inner = [one for one in types_of(kind, name) if quantities(one)]
        if q.part:
            for one in inner:
                yield from _outputs(top, one, path, prefix, (), rows)
            continue
        stored = q.data and (q.unit or q.flags)
        said = "; ".join(filter(None, (q.name, with_peak(q.unit, q.name, q.text))))
        if said or not inner:
            yield Output(
                *(top.command, top.__name__, f"{path}{name}", q.unit, said, (*rows, *q.over), q.error, q.by),
                json=q.json,
                variable=(q.variable or f"{prefix}{name}") if stored else "",
            )
        for one in inner:
            dim = (q.rows,) if q.rows else ()
            begin = f"{q.prefix or q.rows}_" if q.prefix or q.rows else ""
            yield from _outputs(top, one, f"{path}{name}{'[]' if dim else ''}.", begin, q.only, dim or rows)
