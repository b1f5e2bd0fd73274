"""Tables of words become cards on a telephone: a cell carries the name of its column for the style sheet.

A table of numbers scrolls in its box instead, so that they stay below one another.
"""

from __future__ import annotations

from html import escape
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx

_SENTENCE = 40  # characters of a cell that is read, not compared with those above and below
_NAME = "column-name"


def name_cells(_app: Sphinx, doctree: nodes.document, _docname: str) -> None:
    """Mark tables of three and more columns that hold words."""
    for table in doctree.findall(nodes.table):
        head, body = table.next_node(nodes.thead), table.next_node(nodes.tbody)
        if head is None or body is None:
            continue
        names = [entry.astext() for entry in head[-1]]
        cells = [entry for row in body for entry in row]
        if len(names) < 3 or not any(len(cell.astext()) > _SENTENCE for cell in cells):
            continue
        table["classes"].append("cards")
        for row in body:
            for name, cell in zip(names, row, strict=False):
                cell[_NAME] = name
                if not cell.astext().strip():
                    cell["classes"].append("empty")


def visit_entry(translator: Any, node: nodes.entry) -> None:
    """Open a cell as ever, with the name of its column."""
    place = len(translator.body)
    type(translator).visit_entry(translator, node)
    if _NAME in node:
        opened = translator.body[place]
        translator.body[place] = opened.replace("<td", f'<td data-name="{escape(node[_NAME])}"', 1)


def setup(app: Sphinx) -> dict[str, Any]:
    """Register with Sphinx."""
    app.connect("doctree-resolved", name_cells)
    app.add_node(nodes.entry, override=True, html=(visit_entry, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
