"""What reports have in common: the command that makes them again, models and why, notes."""

from __future__ import annotations

import shlex
from collections.abc import Collection, Iterable, Sequence
from pathlib import Path

from leblanc.core.files import path_text
from leblanc.core.notes import Note, NoteCode, one_line
from leblanc.report.parts import Table, table
from leblanc.results.choice import ModelSpan
from leblanc.studies.run.words import described, error_words, speeds_words


def command_line(name: str, scene: Path, *options: tuple[str, object, object]) -> str:
    """The command that makes the same report again, wherever its files go.

    Options are name, value and default; those at their default are left out, a flag stands alone.
    """
    parts = ["leblanc", name, path_text(scene)]
    for option, value, default in options:
        if value != default:
            parts += [option] if value is True else [option, str(value)]
    return " ".join(map(shlex.quote, parts))


def why(spans: Sequence[ModelSpan]) -> Table:
    """Which liquid model answers at which speeds, how well, and why."""
    rows = [
        (
            speeds_words(span),
            span.model + ("" if span.in_range else " (out of range)"),
            error_words(span),
            f"{span.reason[:1].upper()}{span.reason[1:]}.",
        )
        for span in spans
    ]
    return table("", ("Speeds (rpm)", "Model", "Estimated error", "Why"), rows, sentences=True)


def models(names: Sequence[str], held: bool = False) -> list[tuple[str, str]]:
    """Each liquid model that was used, and what it does and takes for granted."""
    return described(names, held)


def notes(given: Iterable[Note | str], elsewhere: Collection[NoteCode] = ()) -> list[str]:
    """Sentences of a result's notes without those that the page says in another place."""
    said = [str(note) for note in given if isinstance(note, str) or note.code not in elsewhere]
    return [line for line in map(one_line, said) if line]
