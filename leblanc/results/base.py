"""What every result can do (become JSON, a dataset, a figure, a block of a notebook), notes, chambers."""

from __future__ import annotations

import html
import io
import math
from abc import ABC, abstractmethod
from base64 import b64encode
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from enum import StrEnum
from functools import cache
from importlib import import_module, metadata
from operator import attrgetter
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

from meshes.baffles import Baffles
from meshes.chamber_section import ChamberSection, layer_depth

if TYPE_CHECKING:
    from leblanc.results.netcdf import Dataset, NamedArrays


class NoteCode(StrEnum):
    """What a note says; each result has an enumeration of its own."""


@dataclass(frozen=True)
class Note:
    """One thing that a reader of a result must know.

    A program uses `code` and `data`, a reader reads `text`. A sentence is written in one place: the
    function that makes the note.
    """

    code: NoteCode  #: kind of the sentence
    data: Mapping[str, object] = field(hash=False)  #: the numbers of the sentence, SI
    text: str  #: the sentence

    def __post_init__(self) -> None:
        object.__setattr__(self, "data", MappingProxyType(dict(self.data)))

    def __str__(self) -> str:
        return self.text

    def __reduce__(self) -> tuple[object, ...]:
        return Note, (self.code, dict(self.data), self.text)


def texts(notes: Iterable[Note]) -> tuple[str, ...]:
    """The sentences of notes, in their order."""
    return tuple(note.text for note in notes)


EXACT = 1e-9  # a relative error that is nothing but rounding
WHOLE = 0.995  # a relative error that is said to be the whole or more


def percent(value: float) -> str:
    """A share in per cent, two digits; a text where it is the whole or nothing."""
    if value >= WHOLE:
        return "about 100 % or more"
    return "rounding" if value < EXACT else f"{100.0 * value:.2g} %"


def one_line(text: str) -> str:
    """Text without line breaks and control characters, which files and figures cannot carry."""
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


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
    """The function of a room above that presents a result, loaded when it is first used.

    Results import neither figures nor texts. A result names them as "module:function", and this is the only
    place that follows such a name: `result.plot()` works without an import that runs upward.

    Parameters
    ----------
    address : as in "leblanc.figures.response:amplitude_figure"
    """
    module, _, name = address.partition(":")
    found: Callable[[Any], Any] = getattr(import_module(module), name)
    return found


@dataclass(frozen=True)
class ConstraintValue:
    """A constraint at what was found best."""

    limit: float  #: in the unit; the value must not be above the limit
    value: float
    satisfied: bool  #: it is not
    unit: str  #: of both, and what they are
    meaning: str


def carried(path: str) -> Any:
    """A name of a result's JSON for what stands deeper in the result.

    Parameters
    ----------
    path : from the result, as "history.time"; where a part of it is None the result does not have the name
    """
    return property(attrgetter(path))


def plain(value: Any) -> Any:
    """The same in what JSON has: a complex number as [re, im], null for what is not finite."""
    if value is None or isinstance(value, str | bool | int):
        return value
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, complex):
        return [plain(value.real), plain(value.imag)]
    if isinstance(value, Mapping):
        return {str(key): plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [plain(entry) for entry in value]
    if isinstance(value, Path):
        return str(value)
    if is_dataclass(value) and not isinstance(value, type):
        return {one.name: plain(getattr(value, one.name)) for one in fields(value)}
    if hasattr(value, "tolist"):  # arrays and their scalars
        return plain(value.tolist())
    raise TypeError(f"{type(value).__name__} has no form in JSON")


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
            for label, value in presented_by(self.summary)(self)
        )
        drawing, figure = io.BytesIO(), self.plot()
        figure.savefig(drawing, format="svg")
        address = b64encode(drawing.getvalue()).decode("ascii")
        alt = html.escape(getattr(figure, "alt", ""))
        return f'<table>{rows}</table><img alt="{alt}" src="data:image/svg+xml;base64,{address}">'


@dataclass(frozen=True)
class FilledChamber:
    """One chamber with its liquid."""

    radius: float  #: m; the last one of the undisturbed layer
    inner_radius: float
    height: float
    volume: float  #: of the liquid, m^3
    liquid_name: str  #: as the scene names it
    mean_surface_radius: float
    plane: float = 0.0  #: position along the axis where that matters, m
    baffles: Baffles | None = None  #: None without any
    section: ChamberSection | None = None  #: None for circular walls

    @property
    def least_depth(self) -> float:
        """Depth of the undisturbed layer where it is thinnest, m."""
        area = self.volume / self.height
        if self.section is not None and 0.0 < area < self.section.area:
            return layer_depth(self.section, area)
        return self.radius - self.mean_surface_radius
