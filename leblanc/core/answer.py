"""An answer to a question: declared quantities, blocks to be shown, one main figure."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar

from leblanc.core import quantities
from leblanc.core.blocks import Block
from leblanc.results.base import Result

if TYPE_CHECKING:
    from leblanc.results.netcdf import NamedArrays


class Answer(Result):
    """Base of a frozen dataclass whose fields and properties are declared by `Q`."""

    attributes: Mapping[str, Any] = {}  #: of its data file, besides the quantities
    failed = ""  #: why there is no answer, or none to rely on; empty where there is one
    summary: ClassVar[str] = "leblanc.core.terminal:rows"

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
