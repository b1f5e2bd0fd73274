"""The section of pictures as a grid of cards, with thumbnails that are made while the site is built.

In it stand a picture and a paragraph in turn: what it shows, a link to the page that explains it, and the
command that draws it. So it reads where nothing makes cards of them.
"""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from pathlib import Path
from typing import Any

import numpy as np
from docutils import nodes
from PIL import Image
from sphinx.application import Sphinx

PAGE = "howto/view"
_WIDE, _HIGH = 480, 360  # pixels at most: twice what a card is wide, for screens of many dots
_FOLDER = "thumbnails"


def cards(app: Sphinx, doctree: nodes.document, docname: str) -> None:
    """Put a grid of cards in the place of the pictures of each section."""
    if docname != PAGE or app.builder.format != "html":
        return
    gallery = next(one for one in doctree.findall(nodes.section) if "gallery" in one["ids"])
    for section in list(gallery.findall(nodes.section)):
        pairs = list(_pairs(section))
        if pairs:
            grid = nodes.container("", *(_card(app, *pair) for pair in pairs), classes=["gallery"])
            section.replace(pairs[0][0].parent, grid)
            for image, words in pairs:
                for node in (image.parent, words):
                    if node.parent is section and node in section:
                        section.remove(node)


def _pairs(section: nodes.section) -> Iterator[tuple[nodes.image, nodes.paragraph]]:
    """Pictures of a section, each with the paragraph below it."""
    for node, below in zip(section.children, section.children[1:], strict=False):
        if isinstance(node, nodes.paragraph) and len(node) == 1 and isinstance(node[0], nodes.image):
            yield node[0], below


def _card(app: Sphinx, image: nodes.image, words: nodes.paragraph) -> nodes.container:
    """One picture: the thumbnail leads to the whole, the words to the page, below them the command."""
    uri = image["uri"]
    # Sphinx copies the pictures that it meets on its pages; from this one the image itself is gone.
    name = app.builder.images[uri] = app.env.images[uri][1]
    folder = Path(app.outdir, app.builder.imagedir)
    wide, high = thumbnail(Path(app.srcdir, uri), folder / _FOLDER / f"{Path(name).stem}.webp")
    images = "../" * PAGE.count("/") + app.builder.imagedir
    place = f"{images}/{_FOLDER}/{Path(name).stem}.webp"
    shown = (
        f'<a href="{images}/{name}"><img src="{place}" alt="{escape(image["alt"])}" '
        f'width="{wide}" height="{high}" loading="lazy" decoding="async"></a>'
    )
    text = words.astext().partition(" (")[0]
    link, command = words.next_node(nodes.reference), words.next_node(nodes.literal)
    return nodes.container(
        "",
        nodes.raw("", shown, format="html"),
        nodes.paragraph("", "", nodes.reference("", text, internal=True, refuri=link["refuri"])),
        nodes.paragraph("", "", command.deepcopy(), classes=["command"]),
        classes=["card"],
    )


def thumbnail(picture: Path, small: Path) -> tuple[int, int]:
    """Write a small picture; of one that is higher than a card the panels that fit, else the whole.

    Parameters
    ----------
    picture : the whole, PNG
    small : the file to write

    Returns
    -------
    Width and height, pixels
    """
    small.parent.mkdir(parents=True, exist_ok=True)
    with Image.open(picture) as whole:
        copy = whole.convert("RGB")
    limit = copy.width * _HIGH // _WIDE
    if copy.height > limit:
        # Between panels stand rows of one colour.
        least = np.asarray(copy).min(axis=(1, 2))
        gaps = np.flatnonzero(least[limit // 2 : limit] == 255)
        copy = copy.crop((0, 0, copy.width, limit // 2 + int(gaps[-1]) if gaps.size else copy.height))
    copy.thumbnail((_WIDE, _HIGH), Image.Resampling.LANCZOS)
    copy.save(small, "WEBP", quality=80, method=6)
    return copy.size


def setup(app: Sphinx) -> dict[str, Any]:
    """Register with Sphinx."""
    app.connect("doctree-resolved", cards)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
