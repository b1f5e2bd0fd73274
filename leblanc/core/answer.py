"""An answer to a question: declared quantities, blocks to be shown, one main figure."""

from __future__ import annotations

import html
import io
from abc import ABC, abstractmethod
from base64 import b64encode
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from importlib import import_module, metadata
from operator import attrgetter
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

from leblanc.core import quantities
from leblanc.core.blocks import Block, Table
from leblanc.core.notes import Note, one_line

if TYPE_CHECKING:
    from leblanc.core.netcdf import Dataset, NamedArrays


class NotConverged(RuntimeError):  # noqa: N818 - it names a state, not a mistake
    """A solver did not converge everywhere; what did is kept. One line for each that did not."""

    def __init__(self, failed: Sequence[str]) -> None:
        super().__init__("\n".join(failed))
        self.failed = tuple(failed)


def versions(packages: Iterable[str] = ("leblanc", "numpy", "scipy")) -> dict[str, str]:
    """Versions of packages, by default of this one and of the libraries that all numbers come from."""
    return {package: _version(package) for package in packages}


@cache
def _version(package: str) -> str:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:  # run from a source tree that was never installed
        return "not installed"


class OfScene(Protocol):
    """An answer that says which scene it belongs to."""

    @property
    def name(self) -> str:
        """Name of the scene."""

    @property
    def source(self) -> str:
        """Where its values come from."""

    @property
    def assumed(self) -> tuple[str, ...]:
        """Paths of the values that no source gives."""

    @property
    def digest(self) -> str:
        """Fingerprint of the scene."""


def attributes(
    result: OfScene, command: str, own: Mapping[str, str], notes: Iterable[Note | str]
) -> dict[str, str]:
    """Attributes of the data file that a command writes: scene, what this kind alone has, notes, versions."""
    said = [one_line(note if isinstance(note, str) else note.text) for note in notes]
    return {
        "title": one_line(result.name),
        "source": one_line(result.source) or "not stated",
        "digest": result.digest,
        "assumed": "; ".join(map(one_line, result.assumed)) or "nothing",
        **own,
        "notes": "\n".join(said) or "none",
        "history": f"written by leblanc {command}",
        **{f"version_{package}": version for package, version in versions().items()},
    }


def presented_by(address: str) -> Callable[[Any], Any]:
    """The function at "module:function" that presents an answer, loaded when it is first used.

    Answers import no figures. They name them, and this is the only place that follows such a name:
    `answer.plot()` works without an import that runs upward.
    """
    module, _, name = address.partition(":")
    found: Callable[[Any], Any] = getattr(import_module(module), name)
    return found


def carried(path: str) -> Any:
    """A name of an answer's JSON for what stands deeper in it, as "history.time".

    Where a part of the path is None the answer does not have the name.
    """
    return property(attrgetter(path))


class Result(ABC):
    """An answer to a question about a machine.

    A subclass is a frozen dataclass that names `figure`, the function that draws its main figure, and
    `summary`, the function that gives its main numbers as labels and values; both as "module:function".
    """

    figure: ClassVar[str]
    summary: ClassVar[str]

    @abstractmethod
    def to_json(self) -> dict[str, Any]:
        """What the command prints with --json: SI, radians, complex numbers as [re, im]."""

    @abstractmethod
    def named_arrays(self) -> NamedArrays:
        """Its numbers as arrays with named dimensions, units in their attributes."""

    def to_dataset(self) -> Dataset:
        """The same as an xarray dataset."""
        return self.named_arrays().to_dataset()

    def plot(self) -> Any:
        """The main figure, a `matplotlib.figure.Figure`."""
        return presented_by(self.figure)(self)

    def _repr_html_(self) -> str:
        """The main numbers and the main figure, for a notebook."""
        rows = "".join(
            f'<tr><th scope="row" style="text-align: left">{html.escape(label)}</th>'
            f"<td>{html.escape(value)}</td></tr>"
            for label, value in self._rows()
        )
        drawing, figure = io.BytesIO(), self.plot()
        figure.savefig(drawing, format="svg")
        address = b64encode(drawing.getvalue()).decode("ascii")
        alt = html.escape(getattr(figure, "alt", ""))
        return f'<table>{rows}</table><img alt="{alt}" src="data:image/svg+xml;base64,{address}">'

    def _rows(self) -> Sequence[tuple[str, str]]:
        rows: Sequence[tuple[str, str]] = presented_by(self.summary)(self)
        return rows


class Answer(Result):
    """Base of a frozen dataclass whose fields and properties are declared by `Q`."""

    attributes: Mapping[str, Any] = {}  #: of its data file, besides the quantities
    failed: str = ""  #: why there is no answer, or none to rely on; empty where there is one

    def __getattr__(self, name: str) -> Any:
        """A quantity of one of its parts; None where it has no such part."""
        part = quantities.part_with(type(self), name)
        if part is None:
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")
        record = getattr(self, part)
        return None if record is None else getattr(record, name)

    @abstractmethod
    def blocks(self) -> Sequence[Block]:
        """What is shown of it, in the order of reading."""

    def to_json(self) -> dict[str, Any]:
        """Its quantities by name: SI, radians, complex numbers as [re, im], None for what is not there."""
        return quantities.to_json(self)

    def named_arrays(self) -> NamedArrays:
        """Its quantities as arrays with named dimensions, units in their attributes."""
        return quantities.named_arrays(self, self.attributes)

    def _rows(self) -> Sequence[tuple[str, str]]:
        """First and last text of each row of its tables."""
        tables = (block for block in self.blocks() if isinstance(block, Table))
        return [(row[0], row[1]) for table in tables for row in table.rows]
