"""What commands print and write: JSON on stdout, messages on stderr, files that are whole or not there."""

from __future__ import annotations

import json
import math
import os
import re
import sys
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any, Literal

_WIDTH = 110  # characters of a line where there is no terminal
_LONGEST_NAME = 200  # bytes; file systems allow 255
_RESERVED = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?", re.IGNORECASE)  # on Windows


def say(text: str) -> None:
    """Print a line of progress or a fault on stderr."""
    print(text, file=sys.stderr, flush=True)


def print_table(
    rows: Iterable[Sequence[str]], head: Sequence[str] = (), right: bool = False, indent: int = 0
) -> None:
    """Print a table on stdout; on a terminal its texts are wrapped to fit, elsewhere to 110 characters.

    Parameters
    ----------
    rows : texts of the cells
    head : of the columns; none for labels and values
    right : all columns but the first are aligned to the right
    indent : blanks before each line
    """
    from rich.console import Console
    from rich.padding import Padding
    from rich.table import Table
    from rich.text import Text

    lines = [tuple(row) for row in rows]
    table = Table(box=None, show_header=bool(head), pad_edge=False, padding=(0, 2, 0, 0), header_style="")
    side: Literal["left", "right"] = "right" if right else "left"
    for k, name in enumerate(head or [""] * len(lines[0])):
        table.add_column(Text(name), justify=side if k else "left", no_wrap=k == 0, overflow="fold")
    for row in lines:
        table.add_row(*map(Text, row))
    terminal = sys.stdout.isatty()
    console = Console(file=sys.stdout, width=None if terminal else _WIDTH, highlight=False, emoji=False)
    with console.capture() as printed:
        console.print(Padding(table, (0, 0, 0, indent), expand=False))
    sys.stdout.writelines(f"{line.rstrip()}\n" for line in printed.get().splitlines())


def print_json(value: object) -> None:
    """Print one JSON object on stdout.

    Parameters
    ----------
    value : dataclasses, mappings, sequences, arrays and numbers; a complex number becomes [re, im], and what
        is not finite becomes null
    """
    sys.stdout.write(json.dumps(_plain(value), allow_nan=False) + "\n")
    sys.stdout.flush()


def _plain(value: Any) -> Any:
    """The same in what JSON knows."""
    if value is None or isinstance(value, str | bool | int):
        return value
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, complex):
        return [_plain(value.real), _plain(value.imag)]
    if isinstance(value, Mapping):
        return {str(key): _plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    if isinstance(value, Path):
        return str(value)
    if is_dataclass(value) and not isinstance(value, type):
        return {field.name: _plain(getattr(value, field.name)) for field in fields(value)}
    if hasattr(value, "tolist"):  # arrays and their scalars, without importing numpy for it
        return _plain(value.tolist())
    raise TypeError(f"{type(value).__name__} has no form in JSON")


def out_dir(scene_name: str, out: Path | None) -> Path:
    """Folder for the files of a command, made if need be and tried for writing.

    Parameters
    ----------
    scene_name : names the folder out/<scene name> where the user chose none
    out : the user's choice

    Raises
    ------
    OSError : it cannot be made or written; carries the path
    """
    folder = Path("out") / safe_name(scene_name) if out is None else out
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with _naming(folder), tempfile.TemporaryFile(dir=folder):
            pass  # better now than after the work
    except PermissionError as error:
        if out is None:
            error.strerror = f"{error.strerror}; --out DIR chooses another folder"
        raise
    return folder


def safe_name(name: str) -> str:
    """The name with what file systems refuse replaced by underscores."""
    kept = "".join("_" if letter in '/\\:*?"<>|' or not letter.isprintable() else letter for letter in name)
    short = kept.encode()[:_LONGEST_NAME].decode(errors="ignore").strip(". ")
    return f"_{short}" if not short or _RESERVED.fullmatch(short) else short


@contextmanager
def writing(path: Path) -> Iterator[Path]:
    """Path to write to; what was written takes its place at `path` when the block ends well.

    Until then, and if the block fails, whatever stood at `path` stands there untouched.

    Parameters
    ----------
    path : of the file; its folder must exist

    Raises
    ------
    OSError : it cannot be written; carries the path
    """
    part = path.with_name(f".{path.stem[:100]}.{os.getpid()}.part{path.suffix}")
    try:
        with _naming(path):
            yield part
            part.replace(path)
    finally:
        part.unlink(missing_ok=True)


@contextmanager
def _naming(path: Path) -> Iterator[None]:
    """Give an error of the file system the path that the user knows."""
    try:
        yield
    except OSError as error:
        error.filename, error.filename2 = str(path), None
        raise
