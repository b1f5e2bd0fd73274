"""Blocks of an answer as one HTML page that needs nothing else."""

from __future__ import annotations

import base64
import os
import platform
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import count, groupby
from pathlib import Path
from typing import Any

from leblanc.core.answer import versions
from leblanc.core.blocks import (
    Block,
    Cell,
    Checks,
    Columns,
    Grade,
    Headline,
    Notes,
    Picture,
    Section,
    Table,
    Words,
    flat,
)
from leblanc.core.files import writing
from leblanc.core.notes import one_line

# What the numbers, the files and the figures come from.
PACKAGES = (
    "leblanc", "numpy", "scipy", "numba", "py-pde", "scikit-fem", "h5py", "matplotlib",
)  # fmt: skip
AUTHORS = "The leblanc developers"
TITLE = "leblanc: passive liquid balancers and rotors partly filled with liquid"
TYPES = {".svg": "image/svg+xml", ".png": "image/png"}


@dataclass(frozen=True)
class About:
    """What a report is about and how to make it again."""

    name: str  #: of the scene
    source: str
    digest: str
    rows: Sequence[Any]  #: what the scene says, each with a label and its values
    tables: Sequence[Any] = ()  #: of what there may be several of, each with a head and rows of values
    unused: Sequence[Any] = ()  #: rows on which the numbers do not depend
    elsewhere: tuple[str, ...] = ()  #: assumed values that are not among the rows
    command: str = ""  #: that writes the report; empty if it was no command
    data: str = ""  #: file of the numbers beside the report; empty if there is none

    @property
    def values(self) -> list[Any]:
        """All values."""
        single = [value for row in (*self.rows, *self.unused) for value in row.values]
        return single + [value for table in self.tables for row in table.rows for value in row]

    @property
    def assumed(self) -> bool:
        """Some value is marked."""
        return any(value.assumed for value in self.values)


def all_versions() -> dict[str, str]:
    """Versions of Python and of what the numbers, files and figures come from."""
    return {"Python": platform.python_version()} | versions(PACKAGES)


def citation() -> str:
    """How to cite the program, as its citation file says."""
    return f"{AUTHORS}. {TITLE}. Version {versions()['leblanc']}."


def made_on() -> str:
    """Day on which a report is made, as 2026-11-22, in UTC; what SOURCE_DATE_EPOCH says where it is set.

    Only a report carries it: files of numbers and figures are the same whenever they are made.
    """
    given = os.environ.get("SOURCE_DATE_EPOCH", "")
    moment = time.gmtime(int(given)) if given.isdecimal() and len(given) < 12 else time.gmtime()
    return time.strftime("%Y-%m-%d", moment)


def write_page(
    title: str, blocks: Sequence[Block], about: About, figures: Mapping[str, Any], path: Path
) -> None:
    """Write the page of an answer; the figures are those of its pictures on disk, by their names."""
    shown = list(flat(blocks, "page"))
    headline = next((block for block in shown if isinstance(block, Headline)), Headline(""))
    checks = [check for block in shown if isinstance(block, Checks) for check in block.rows]
    parts = {
        "title": title,
        "machine": headline.about,
        "answer": headline.text,
        "doubt": doubt(checks, headline.error) if checks else "",
        "sections": _sections(blocks, figures),
    }
    render("page", about, parts, path)


def render(
    body: str, about: About, parts: Mapping[str, Any], path: Path, package: str = "leblanc.core"
) -> None:
    """Write a body inside the common frame; a package keeps its template in a folder `templates`."""
    from jinja2 import ChoiceLoader, Environment, PackageLoader, StrictUndefined

    environment = Environment(
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        loader=ChoiceLoader([PackageLoader(name) for name in dict.fromkeys((package, "leblanc.core"))]),
    )
    environment.filters["line"] = one_line
    made = {"about": about, "date": made_on(), "versions": all_versions(), "citation": citation()}
    text = environment.get_template(f"{body}.html.j2").render(made, **parts)
    with writing(path) as temporary:
        temporary.write_text(text.lstrip(), encoding="utf-8")


_CLAUSES = 2  # of the sentence of doubt
# What weighs most in it first; what none of these begins follows.
_WEIGHTS = (
    "Not converged",
    "Not converged in time",
    "Stopped before its end",
    "Amplitude infinite",
    "Constraints exceeded",
    "Answer unstable",
    "A small whirl grows",
    "Growth not known",
    "Stability not known",
    "Liquid model out of range",
    "Model out of range",
    "Error above",
    "Limit cycle",
    "Self-excited whirl",
)


def _weight(label: str) -> int:
    """Rank of a check in the sentence of doubt, the lowest first."""
    ranks = (rank for rank, start in enumerate(_WEIGHTS) if label.startswith(start))
    return next(ranks, len(_WEIGHTS))


def doubt(checks: Iterable[Any], error: str = "") -> str:
    """What must not be relied on in an answer, in one sentence of two clauses; the rest is in the table.

    Of an answer whose headline no check touches its error is said.
    """
    rows = list(checks)
    failed = sorted((one for one in rows if one.grade > Grade.NOTE), key=lambda one: _weight(one.label))
    aside = f"; estimated error {error}" if error else ""
    if not failed and any(one.grade for one in rows):
        return f"No limit of the models touches these figures{aside}."
    if not failed:
        return f"No limit of the models is passed{aside}."
    told = "; ".join(f"{one.label[:1].lower()}{one.label[1:]}: {one.where}" for one in failed[:_CLAUSES])
    rest = len(failed) - _CLAUSES
    return f"Caution: {told}{f' ({rest} more under the limits)' if rest > 0 else ''}{aside}."


def _sections(blocks: Sequence[Block], figures: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Sections as the template takes them; what stands before the first one are the results."""
    numbers = count(1)
    loose = tuple(block for block in blocks if not isinstance(block, Section))
    first = tuple(block for block in loose if not isinstance(block, Notes))
    notes = [block for block in loose if isinstance(block, Notes)]
    own = [block for block in blocks if isinstance(block, Section)]
    # Results of an answer's own follow in the same section.
    more = next((section for section in own if section.title == "Results"), Section("Results", ()))
    results = replace(more, blocks=(*first, *more.blocks))
    own = [section for section in own if section is not more]
    found = []
    for section in (results, *own, *(Section(note.title, (note,), shown=note.shown) for note in notes)):
        if section.shown != "text":
            inner = list(_rendered(section.blocks, figures, numbers))
            if inner:
                look = {"title": section.title, "width": section.width, "screen": section.screen}
                found.append(look | {"blocks": inner})
    return found


def _rendered(
    blocks: Iterable[Block], figures: Mapping[str, Any], numbers: Iterator[int]
) -> Iterator[dict[str, Any]]:
    """Blocks of a page as the template takes them, neighbouring pictures together; nothing for empty ones."""
    shown = [block for block in blocks if block.shown != "text" and not isinstance(block, Headline | Section)]
    shown = [block for block in shown if not (isinstance(block, Picture) and block.alone)]
    # Two in a row below pictures that stand beside tables.
    layout = "two" if any(isinstance(block, Columns) and block.wide for block in shown) else "one"
    for drawn, group in groupby(shown, lambda block: isinstance(block, Picture)):
        if drawn:
            names = [one.name for one in group if isinstance(one, Picture)]
            pictures = [{"number": next(numbers), **picture(figures[name])} for name in names]
            yield {"kind": "pictures", "pictures": pictures, "layout": layout}
        else:
            for block in group:
                yield from _one(block, figures, numbers)


def _one(block: Block, figures: Mapping[str, Any], numbers: Iterator[int]) -> Iterator[dict[str, Any]]:
    if isinstance(block, Columns):
        left, right = (list(_rendered(side, figures, numbers)) for side in (block.left, block.right))
        yield {"kind": "columns", "wide": block.wide, "left": left, "right": right}
    elif isinstance(block, Notes):
        if texts := [line for line in map(one_line, block.texts) if line]:
            yield {"kind": "notes", "texts": texts}
    elif isinstance(block, Checks):
        rows = [(one.label, Cell(one.where, warning=one.grade > Grade.NOTE)) for one in block.rows]
        yield {"kind": "table", "table": Table(rows, (block.title, block.head))}
    elif isinstance(block, Table):
        if block.rows:
            yield {"kind": "table", "table": block}
    elif isinstance(block, Words):
        parts = {"text": block.text, "name": block.name, "code": block.code, "small": block.small}
        yield {"kind": "words", **parts}


def picture(files: Any, alt: str = "") -> dict[str, Any]:
    """A figure on disk as a page shows it, its caption as text."""
    chosen = files.shown
    content = base64.b64encode(chosen.read_bytes()).decode("ascii")
    return {
        "title": files.title,
        "caption": one_line(files.caption.shown.removeprefix(f"{files.title}.")),
        "alt": alt or files.alt or files.title,
        "address": f"data:{TYPES[chosen.suffix]};base64,{content}",
    }
