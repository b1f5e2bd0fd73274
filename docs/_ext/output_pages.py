"""The page of every output, from the declarations of the answers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from itertools import groupby
from pathlib import Path

import leblanc as lb
from leblanc.studies.outputs.answer import HEAD

NAME = "outputs.md"

_HEAD = """# Outputs of the commands

Every quantity that a command computes, with the names of its JSON, of its data file and of its answer in
Python. This page is made from the declarations of the answers (`docs/_ext/output_pages.py`);
`leblanc outputs [QUESTION]` prints the same, with `--json` for programs; in Python it is `lb.outputs("run")`.

Units are SI, as data files write them; a quantity without one is a text, a truth value or a record. `a.b` is
the quantity b of the record a, `a[].b` that of each record in the list a. "Over" names the dimensions,
"error" the quantity that is the error of this one, "equation" where it stands on the pages of theory.
"(data file)" stands behind a name that the data file alone has.

What does not exist, is not known, or is not finite is null in JSON and nan in data files and in Python. The
JSON does not say which of the three it is: where an answer tells them apart, a quantity beside it does, such
as `stable` or `converged`. A complex number is [real, imaginary] in JSON and two variables in a data file.

Data files of rotors with or without chambers say besides of what machine they are: `machine_mass` (kg, that
moves with the axis, no liquid), `machine_critical_speed` (rad s-1, no liquid, undamped), and by chamber
`machine_liquid_mass` (kg) and `machine_capacity` (m3).
"""


def page() -> str:
    """The page in Markdown: what several answers have once, then each answer's own."""
    found = lb.outputs()
    count = Counter(one.row for one in found.quantities)
    shared = list(dict.fromkeys(one.row for one in found.quantities if count[one.row] > 1))
    said = "Quantities of more than one answer; each answer below names those that it has."
    parts, command = [_HEAD, f"## In several answers\n\n{said}\n", _table(shared)], ""
    for kind, each in groupby(found.quantities, lambda one: one.answer):
        rows = list(each)
        if rows[0].question != command:
            command = rows[0].question
            parts.append(f"## {command}\n")
        parts.append(f"### {kind}\n\n{found.titles[kind]}\n")
        own = [one.row for one in rows if count[one.row] == 1]
        names = [one.row[0].partition(" ")[0] for one in rows if count[one.row] > 1]
        # Of a record that is shared as a whole its name is enough.
        names = [name for name in names if name.rpartition(".")[0].removesuffix("[]") not in names]
        if own:
            parts.append(_table(own))
        if names:
            listed = ", ".join(f"`{name}`" for name in names)
            parts.append(f"And, as [above](#in-several-answers): {listed}.\n")
    return "\n".join(parts)


def _table(rows: Sequence[tuple[str, ...]]) -> str:
    lines = [HEAD, tuple("---" for _ in HEAD), *map(_cells, rows)]
    return "".join("| " + " | ".join(cells) + " |\n" for cells in lines)


def write(folder: Path) -> Path:
    """Write the page of outputs into a folder; its path."""
    path = folder / NAME
    path.write_text(page(), encoding="utf-8")
    return path


def _cells(row: tuple[str, ...]) -> tuple[str, ...]:
    name, unit, meaning, over, error, by = row
    name, _, aside = name.partition(" ")
    shown = [f"`{text}`" if text else "" for text in (name, over, error)]
    meaning = meaning.replace("|", "\\|").replace("*", "\\*").replace("<", "\\<")
    return f"{shown[0]} {aside}".rstrip(), unit, meaning, shown[1], shown[2], by


if __name__ == "__main__":
    write(Path(__file__).resolve().parents[1])
