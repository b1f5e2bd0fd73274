"""Read built pages as their readers do: `python docs/proofread.py out/docs`; exit code 1 if a page is wrong.

Markup that shows as it was typed, and pictures without words, are found without a browser. Whether a page
fits a telephone is asked of a Chromium, where there is one.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Sequence
from html.parser import HTMLParser
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from tests.oracles.browser import Browser, browser, found  # noqa: E402 - of this repository

PHONE = 390, 844  # pixels
# Markdown, TeX and the roles of Sphinx, as they look when nothing has read them.
_MARKUP = re.compile(r"\*\*|`|\$|\\|\][([]|\{\w[\w:]*\}(?=`|$)")
_NO_WORDS = re.compile(r"^$|\.(png|svg|webp)$|^No description")
_AS_TYPED = {"code", "pre", "script", "style", "svg", "title"}
_EMPTY = {"br", "col", "hr", "img", "input", "link", "meta", "source", "wbr"}
# The frames of a page: one that is wider inside than outside moves the whole page, or cuts it off. Boxes in
# them, of code, tables and formulas, may scroll by themselves.
_FRAMES = """(async () => {
  if (window.MathJax && MathJax.startup) await MathJax.startup.promise;
  const frames = "html, body, main, article, .page, .main, .content, .article-container";
  return Math.max(innerWidth, ...[...document.querySelectorAll(frames)].map(
    (frame) => Math.ceil(frame.getBoundingClientRect().left) + frame.scrollWidth));
})()"""


class _Text(HTMLParser):
    """Text of a page outside code, formulas and signatures."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[tuple[str, bool]] = []
        self.leaks: list[str] = []
        self.last = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Go into an element."""
        names = (dict(attrs).get("class") or "").split()
        typed = tag in _AS_TYPED or bool({"math", "sig"} & set(names))
        if tag == "img" and _NO_WORDS.search(dict(attrs).get("alt") or ""):
            self.leaks.append("a picture without words for who cannot see it")
        if tag == "em" and self.last.isalnum() and not self._typed():
            self.leaks.append("emphasis within a word")
        if tag not in _EMPTY:
            self.open.append((tag, typed))

    def handle_endtag(self, tag: str) -> None:
        """Leave an element."""
        while self.open and self.open.pop()[0] != tag:
            pass

    def handle_data(self, data: str) -> None:
        """Look at text."""
        if not self._typed():
            places = _MARKUP.finditer(data)
            around = (data[max(0, leak.start() - 30) : leak.end() + 30].strip() for leak in places)
            self.leaks += [f"markup shows: {text!r}" for text in around]
        self.last = data[-1:]

    def _typed(self) -> bool:
        return any(typed for _, typed in self.open)


def leaks(page: str) -> list[str]:
    """Markup that shows in a page of HTML, and pictures without words, a line for each place."""
    reader = _Text()
    reader.feed(page)
    return reader.leaks


def width(tab: Browser, page: Path) -> int:
    """How wide a page is on a telephone, pixels; that of the telephone if it fits."""
    tab.open(page.resolve().as_uri(), *PHONE)
    return int(tab.value(_FRAMES))


def faults(folder: Path) -> list[str]:
    """What is wrong with the pages of a folder, a line each.

    Parameters
    ----------
    folder : of the site, a report or notebooks
    """
    pages = sorted(folder.rglob("*.html"))
    wrong = [
        f"{page.relative_to(folder)}: {leak}"
        for page in pages
        for leak in leaks(page.read_text(encoding="utf-8"))
    ]
    chromium = found()
    if chromium is None:
        print("no Chromium: the widths of the pages are not looked at")
        return wrong
    with browser(chromium) as tab:
        wide = {page: width(tab, page) for page in pages}
    return wrong + [
        f"{page.relative_to(folder)}: {wide[page]} pixels wide on a telephone of {PHONE[0]}"
        for page in pages
        if wide[page] > PHONE[0]
    ]


def main(arguments: Sequence[str] | None = None) -> int:
    """Proofread folders; exit code."""
    wrong = [
        line for name in (sys.argv[1:] if arguments is None else arguments) for line in faults(Path(name))
    ]
    for line in wrong:
        print(line, file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main())
