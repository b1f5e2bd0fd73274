"""What every result can do: become JSON, a dataset, a figure, a block of a notebook."""

from __future__ import annotations

import html
import io
from abc import ABC, abstractmethod
from base64 import b64encode
from collections.abc import Callable, Iterable, Mapping
from importlib import import_module, metadata
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

from leblanc.results.note import Note

if TYPE_CHECKING:
    from leblanc.results.netcdf import Dataset


def one_line(text: str) -> str:
    """Text without line breaks and control characters, which files and figures cannot carry."""
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def versions(packages: Iterable[str] = ("leblanc", "numpy", "scipy")) -> dict[str, str]:
    """Versions of packages, by default of this one and of the libraries that all numbers come from."""
    found = {}
    for package in packages:
        try:
            found[package] = metadata.version(package)
        except metadata.PackageNotFoundError:  # run from a source tree that was never installed
            found[package] = "not installed"
    return found


class OfScene(Protocol):
    """A result that says which scene it belongs to."""

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
    """Attributes of the dataset of a result: scene, what is its own, notes, versions.

    Parameters
    ----------
    result : names its scene
    command : that writes the dataset
    own : attributes that only this kind of result has
    notes : of the result
    """
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
    """The function of a room above that presents a result, loaded when it is first asked for.

    Results import neither figures nor texts. A result names them as "module:function", and this is the only
    place that follows such a name: `result.plot()` works without an import that runs upward.

    Parameters
    ----------
    address : as in "leblanc.figures.response:amplitude_figure"
    """
    module, _, name = address.partition(":")
    found: Callable[[Any], Any] = getattr(import_module(module), name)
    return found


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
    def to_dataset(self) -> Dataset:
        """An xarray dataset with units in its attributes."""

    def plot(self) -> Any:
        """The main figure, a `matplotlib.figure.Figure`."""
        return presented_by(self.figure)(self)

    def _repr_html_(self) -> str:
        """The main numbers and the main figure, for a notebook."""
        rows = "".join(
            f'<tr><th scope="row" style="text-align: left">{html.escape(label)}</th>'
            f"<td>{html.escape(value)}</td></tr>"
            for label, value in presented_by(self.summary)(self)
        )
        drawing, figure = io.BytesIO(), self.plot()
        figure.savefig(drawing, format="svg")
        address = b64encode(drawing.getvalue()).decode("ascii")
        alt = html.escape(getattr(figure, "alt", ""))
        return f'<table>{rows}</table><img alt="{alt}" src="data:image/svg+xml;base64,{address}">'
