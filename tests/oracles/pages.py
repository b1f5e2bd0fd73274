"""Pages of reports taken apart: texts by tag, tables, addresses, with the rules that every page keeps."""

from __future__ import annotations

import base64
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

from leblanc.core.answer import Answer
from leblanc.core.blocks import Block, Cell, Checks, Columns, Picture, Section, Table, flat
from leblanc.core.page import About, write_page
from leblanc.plotting.page import FigureFiles
from leblanc.scene.rows import Row, Value
from leblanc.studies.run.answer import RunAnswer

VOID = {"meta", "img", "br"}
ONLY_IN = {"tr": {"thead", "tbody"}, "td": {"tr"}, "th": {"tr"}, "dt": {"div"}, "dd": {"div"}, "li": {"ul"}}
WARNING = "Warning:"


class Page(HTMLParser):
    """One page; tags must close in order and stand where they may."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.texts: list[tuple[str, str]] = []
        self.rows: list[list[str]] = []
        self.tables: list[list[list[str]]] = []
        self.terms: list[tuple[str, str]] = []
        self.addresses: list[str] = []
        self.alts: list[str] = []
        self.attributes: list[tuple[str, str, str]] = []
        self.levels: list[int] = []
        self.tags: set[str] = set()
        self.captions = 0
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.add(tag)
        self.attributes += [(tag, key, str(value)) for key, value in attrs]
        self.addresses += [str(value) for key, value in attrs if key in ("src", "href", "action", "data")]
        self.alts += [str(value) for key, value in attrs if key == "alt"]
        assert len({key for key, _ in attrs}) == len(attrs)
        assert not any(key.startswith("on") for key, _ in attrs)
        if tag in ONLY_IN:
            assert self.open[-1] in ONLY_IN[tag], (tag, self.open[-3:])
        if tag == "table":
            self.tables.append([])
        elif tag == "tr":
            self.rows.append([])
            self.tables[-1].append(self.rows[-1])
        elif tag in ("th", "td"):
            self.rows[-1].append("")
            assert tag == "td" or dict(attrs)["scope"] in ("row", "col")
        elif tag == "figcaption":
            self.captions += 1
        elif tag == "dt":
            self.terms.append(("", ""))
        elif tag in ("h1", "h2", "h3"):
            self.levels.append(int(tag[1]))
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.texts.append((self.open[-1] if self.open else "", data.strip()))
        inside = [tag for tag in self.open if tag in ("th", "td", "dt", "dd")]
        if inside and inside[0] in ("th", "td"):
            self.rows[-1][-1] += data
        elif inside:
            label, value = self.terms[-1]
            self.terms[-1] = (label + data, value) if inside[0] == "dt" else (label, value + data)

    def of(self, tag: str) -> list[str]:
        return [text for found, text in self.texts if found == tag and text]

    @property
    def all_text(self) -> str:
        return " ".join(text for tag, text in self.texts if tag != "style")

    @property
    def words(self) -> str:
        """All text with single spaces."""
        return " ".join(self.all_text.split())

    def table(self, *head: str) -> list[list[str]]:
        """Rows of the only table whose headings begin so, without those."""
        (found,) = [one for one in self.tables if one[0][: len(head)] == list(head)]
        return found[1:]

    def row(self, label: str) -> list[str]:
        """Values of the only row with that heading."""
        (found,) = [row[1:] for row in self.rows if row and row[0] == label]
        return found

    def warnings(self) -> set[str]:
        """Headings of the rows in which some value is marked."""
        return {row[0] for row in self.rows if any(cell.startswith(WARNING) for cell in row[1:])}


def read_page(path: Path) -> Page:
    """A page that keeps the rules of all."""
    text = path.read_text(encoding="utf-8")
    page = Page(text)
    check_rules(page, text)
    return page


def check_rules(page: Page, text: str) -> None:
    """Nothing from elsewhere, no scripts; headings in order; every picture whole and with words."""
    assert text.startswith("<!DOCTYPE html>")
    assert not page.tags & {"script", "iframe", "object", "embed", "link", "base", "form", "a"}
    told = [value for _, _, value in page.attributes if not value.startswith("data:image/")]
    assert all("//" not in value and "url(" not in value for value in told)
    assert "@import" not in text and "url(" not in text
    assert ("html", "lang", "en") in page.attributes
    policy = [
        value for tag, key, value in page.attributes if tag == "meta" and value.startswith("default-src")
    ]
    assert policy == ["default-src 'none'; img-src data:; style-src 'unsafe-inline'"]
    assert page.levels[0] == 1 and page.levels.count(1) == 1
    assert all(b - a <= 1 for a, b in zip(page.levels, page.levels[1:], strict=False))
    assert len(page.alts) == len(page.addresses) == page.captions
    assert all(len(alt) > 20 for alt in page.alts)
    for address in page.addresses:
        kind, _, content = address.partition(",")
        assert kind in ("data:image/svg+xml;base64", "data:image/png;base64")
        start = base64.b64decode(content, validate=True)[:8]
        assert start.startswith(b"<?xml" if "svg" in kind else b"\x89PNG")
    for table in page.tables:
        assert len({len(row) for row in table}) == 1  # as many cells in every row
    assert "nan" not in page.all_text.split() and "inf" not in page.all_text.split()
    assert "None" not in page.all_text.split()


def about_record(record: RunAnswer) -> About:
    """What a report of a made-up record is about: the record's own list of inputs."""
    values = [(label, Value(text, (path,)).marked(record.assumed)) for label, text, path in record.inputs]
    rows = tuple(Row(label, (value,)) for label, value in values)
    paths = [path for _, _, path in record.inputs]
    elsewhere = tuple(
        one for one in record.assumed if not any(path == one or path.startswith(f"{one}.") for path in paths)
    )
    return About(record.name, record.source, record.digest, rows, elsewhere=elsewhere)


def printed(value: float) -> str:
    """A number as reports print it, by Python's own four digits."""
    if value == 0.0:
        return "0"
    exponent = math.floor(math.log10(abs(value)))
    text = f"{value:.3e}" if not -4 <= exponent < 6 else f"{value:.{max(0, 3 - exponent)}f}"
    if "e" not in text and "." in text:
        text = text.rstrip("0").rstrip(".")
    return text.replace("-", "\N{MINUS SIGN}")


def rows_of(answer: Answer) -> dict[str, str]:
    """First cell of every row and check that an answer shows, and the second."""
    found: dict[str, str] = {}
    for block in (*flat(answer.blocks(), "page"), *flat(answer.blocks(), "text")):
        if isinstance(block, Checks):
            found |= {one.label: one.where for one in block.rows}
        elif isinstance(block, Table):
            texts = [[cell.text if isinstance(cell, Cell) else cell for cell in row] for row in block.rows]
            found |= {row[0]: row[1] for row in texts if len(row) > 1}
    return found


def write_page_of(answer: Answer, what: About, figures: Sequence[FigureFiles], path: Path) -> None:
    """Page of an answer with those of its pictures that there are."""
    files = {one.name: one for one in figures}
    write_page(answer.title, tuple(_drawn(answer.blocks(), set(files))), what, files, path)


def _drawn(blocks: Iterable[Block], names: set[str]) -> Iterator[Block]:
    for block in blocks:
        if isinstance(block, Columns):
            left, right = (tuple(_drawn(side, names)) for side in (block.left, block.right))
            yield replace(block, left=left, right=right)
        elif isinstance(block, Section):
            yield replace(block, blocks=tuple(_drawn(block.blocks, names)))
        elif not isinstance(block, Picture) or block.name in names:
            yield block
