"""What was written for other tools."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from leblanc.core.answer import Answer
from leblanc.core.blocks import Block, Table, Words
from leblanc.core.notes import Note
from meshes.quantity import Q


@dataclass(frozen=True)
class ExportAnswer(Answer):
    """Files of a machine for other tools.

    Examples
    --------
    >>> import leblanc as lb
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     lb.export(lb.example("horizontal_rig"), to="csv", out=folder).files[0]
    'response.csv'
    """

    command = "export"
    title = "Export"

    name: Annotated[str, Q(text="of the scene")]
    source: str
    assumed: Annotated[tuple[str, ...], Q(text="values that no source gives")]
    digest: Annotated[str, Q(text="of the scene")]
    to: Annotated[str, Q(text="format")]
    folder: Annotated[str, Q(text="where the files are")]
    files: Annotated[tuple[str, ...], Q(text="their names")]
    contents: Annotated[tuple[str, ...], Q(text="what each of them holds")]
    notes: Annotated[tuple[Note, ...], Q(text="what a user of the files should know")] = ()

    @property
    def closing(self) -> str:
        return f"{self.name}: {len(self.files)} file{'' if len(self.files) == 1 else 's'} in {self.folder}"

    def blocks(self) -> tuple[Block, ...]:
        said = [Words(note.text, shown="text") for note in self.notes]
        return Table(list(zip(self.files, self.contents, strict=True)), ("File", "Content")), *said

    def plot(self, ax: Any = None) -> Any:
        """There is no figure."""
        raise AttributeError("an export has no figure")

    def _repr_html_(self) -> str:
        return self._tables()
