"""The quantities of the answers, as tables."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from leblanc.core.answer import Answer
from leblanc.core.blocks import Block, Section, Table
from meshes.quantity import Q

HEAD = ("Name", "Unit", "Meaning", "Over", "Error", "Equation")


@dataclass(frozen=True)
class Output:
    """A quantity of an answer."""

    question: str  #: command that computes it
    answer: str  #: class of the answer
    name: str  #: in JSON and in Python, "a.b" for b of the record a, "a[].b" for that of each record
    unit: str  #: as CF writes it; empty for texts, truth values and records
    meaning: str
    over: tuple[str, ...]  #: names of its dimensions
    error: str  #: quantity that is its error
    by: str  #: its equation
    json: bool  #: it stands in the JSON
    variable: str  #: its name in the data file; empty where it is not there

    @property
    def row(self) -> tuple[str, ...]:
        """As `HEAD` heads it."""
        name = self.name if self.json else f"{self.variable or self.name} (data file)"
        return name, self.unit, self.meaning, ", ".join(self.over), self.error, self.by


@dataclass(frozen=True)
class OutputsAnswer(Answer):
    """Every quantity of the answers of one command, or of all.

    Examples
    --------
    >>> import leblanc as lb
    >>> {one.question for one in lb.outputs("runup").quantities}
    {'runup'}
    """

    command = "outputs"
    title = "Outputs"

    quantities: Annotated[tuple[Output, ...], Q(text="every quantity, by answer")]
    titles: dict[str, str]  #: of the classes, in their order

    def __repr__(self) -> str:
        """How many, and of which commands."""
        of = ", ".join(dict.fromkeys(one.question for one in self.quantities))
        return f"<OutputsAnswer: {len(self.quantities)} quantities of {of}>"

    def blocks(self) -> tuple[Block, ...]:
        sections = []
        for kind, title in self.titles.items():
            rows = [one.row for one in self.quantities if one.answer == kind]
            command = next(one.question for one in self.quantities if one.answer == kind)
            sections.append(Section(kind, (Table(rows, HEAD, title=f"{command}: {title}", sentences=True),)))
        return tuple(sections)

    def plot(self, ax: Any = None) -> Any:
        """There is no figure."""
        raise AttributeError("outputs have no figure")

    def _repr_html_(self) -> str:
        return self._tables()
