"""What commands print: blocks and JSON on stdout, messages on stderr."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterable, Sequence
from contextlib import suppress
from io import TextIOWrapper
from typing import Literal, TextIO

from leblanc.core.blocks import Block, Checks, Grade, Headline, Notes, Table, Words, flat

_WIDTH = 100  # characters of a line where there is no terminal


def show(blocks: Iterable[Block]) -> None:
    """Print blocks on stdout; pictures are no text."""
    for block in flat(blocks, "text"):
        if isinstance(block, Words | Headline):
            print(f"{block.name}: {block.text}" if isinstance(block, Words) and block.name else block.text)
        elif isinstance(block, Notes):
            for text in block.texts:
                print(f"note: {text}")
        elif isinstance(block, Checks):
            # What is passed at no speed stands in the report.
            passed = [one for one in block.rows if one.grade or one.where != "none"]
            touched = any(one.grade > Grade.NOTE for one in passed)
            print(f"\n{block.title}{' (! touches the figures above)' if touched else ''}")
            marks = ["!" if one.grade > Grade.NOTE else " " for one in passed]
            shown = [(f"{mark} {one.label}", one.where) for mark, one in zip(marks, passed, strict=True)]
            print_table(shown or [("  none", "")])
        elif isinstance(block, Table) and block.rows:
            if block.title:
                print(f"\n{block.title}")
            rows = [[cell if isinstance(cell, str) else cell.text for cell in row] for row in block.rows]
            print_table(rows, block.head, block.right, block.indent or 2 * bool(block.title))


def ready_streams() -> None:
    """Let every text be printed, whatever the terminal.

    A stream that is closed becomes the void: the next file that is opened would take its number, and what a
    library prints would end up in that file. What an encoding lacks is printed as an escape.
    """
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.set_inheritable(os.open(os.devnull, os.O_RDWR), True)  # the lowest number that is free
    for name, number in (("stdout", 1), ("stderr", 2)):
        if getattr(sys, name) is None:
            setattr(sys, name, open(number, "w", encoding="utf-8", closefd=False))  # noqa: SIM115
        if isinstance(stream := getattr(sys, name), TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def drop(stream: TextIO) -> None:
    """Let the interpreter's last flush of a stream that nobody reads, stdout or stderr, go nowhere."""
    try:
        stream.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def say(text: str) -> None:
    """Print a line of progress or a fault on stderr, if anybody reads that."""
    with suppress(OSError):
        print(text, file=sys.stderr, flush=True)


def print_table(
    rows: Iterable[Sequence[str]], head: Sequence[str] = (), right: bool = False, indent: int = 0
) -> None:
    """Print a table on stdout; on a terminal its texts are wrapped to fit, elsewhere to 100 characters.

    Without a head it has labels and values; `right` aligns all columns but the first to the right.
    """
    from rich.console import Console
    from rich.padding import Padding
    from rich.table import Table
    from rich.text import Text

    lines = [tuple(row) for row in rows]
    table = Table(box=None, show_header=bool(head), pad_edge=False, padding=(0, 2, 0, 0), header_style="")
    side: Literal["left", "right"] = "right" if right else "left"
    short = max(len(line[0]) for line in lines) < 2 * _WIDTH // 3
    for k, name in enumerate(head or [""] * len(lines[0])):
        whole = short and k == 0
        table.add_column(Text(name), justify=side if k else "left", no_wrap=whole, overflow="fold")
    for row in lines:
        table.add_row(*map(Text, row))
    terminal = sys.stdout.isatty()
    console = Console(file=sys.stdout, width=None if terminal else _WIDTH, highlight=False, emoji=False)
    with console.capture() as printed:
        console.print(Padding(table, (0, 0, 0, indent), expand=False))
    sys.stdout.writelines(f"{line.rstrip()}\n" for line in printed.get().splitlines())


def print_json(value: object) -> None:
    """Print one JSON object on stdout, as `leblanc.core.quantities.plain` makes it."""
    from leblanc.core.quantities import plain

    sys.stdout.write(json.dumps(plain(value), allow_nan=False) + "\n")
    sys.stdout.flush()
