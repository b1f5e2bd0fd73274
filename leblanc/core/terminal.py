"""Blocks as text."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from leblanc.core.blocks import Block, Table, Words

if TYPE_CHECKING:
    from leblanc.core.answer import Answer


def show(blocks: Iterable[Block]) -> None:
    """Print blocks on stdout; pictures are no text."""
    from leblanc.cli.terminal.output import print_table

    for block in blocks:
        if isinstance(block, Words):
            print(block.text)
        elif isinstance(block, Table) and block.rows:
            if block.title:
                print(f"\n{block.title}")
            print_table(block.rows, block.head, block.right, indent=2 if block.title else 0)


def rows(answer: Answer) -> list[tuple[str, str]]:
    """First and last text of each row, for a notebook."""
    return [(row[0], row[1]) for block in answer.blocks() if isinstance(block, Table) for row in block.rows]
