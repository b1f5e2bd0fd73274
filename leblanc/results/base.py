"""What every result can do: become JSON, a dataset, a figure, a block of a notebook."""

from __future__ import annotations

import html
import io
from abc import ABC, abstractmethod
from base64 import b64encode
from collections.abc import Callable
from importlib import import_module
from typing import TYPE_CHECKING, Any, ClassVar

if TYPE_CHECKING:
    from leblanc.results.netcdf import Dataset


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
