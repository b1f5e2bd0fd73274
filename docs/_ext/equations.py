r"""Equations keep their numbers: `$$ ... \tag{5} $$` in the section `Long wave` is `long_wave-eq-5`.

MathJax shows the tag as it stands. It is brought from the package of `_MATHJAX`, so that no page asks the
network for it.
"""

from __future__ import annotations

import importlib.util
import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.transforms import SphinxTransform

_TAG = re.compile(r"\\tag\{([0-9a-z]+)\}")
CHAPTERS = "theory/"  # whose sections number their equations for themselves
_MATHJAX = "sphinx-mathjax-offline"
# One file that draws in SVG: it needs no fonts beside it.
_SCRIPT = "tex-svg.js"


class Tagged(SphinxTransform):
    """Display equations go to MathJax as they are written, and can be linked to by their numbers."""

    default_priority = 700

    def apply(self, **_: Any) -> None:
        """Wrap each equation, name it by its tag."""
        domain = self.env.domains.standard_domain
        if not self.env.docname.startswith(CHAPTERS):
            page = Path(self.env.docname).name
            sections: dict[nodes.Node, str] = {}
        else:
            page = ""
            sections = {
                part: part[0].astext().lower().replace(" ", "_")
                for part in self.document.findall(nodes.section)
                if isinstance(part.parent.parent, nodes.document)
            }
        for part, name in sections.items():
            domain.labels[f"theory-{name}"] = self.env.docname, part["ids"][0], name
            domain.anonlabels[f"theory-{name}"] = self.env.docname, part["ids"][0]
        for node in list(self.document.findall(nodes.math_block)):
            text = node.astext()
            node.children = [nodes.Text(rf"\[{text}\]")]
            node["no-wrap"] = node["nowrap"] = True
            name = next((sections[above] for above in _above(node) if above in sections), page)
            for number in _TAG.findall(text):
                anchor = label = f"{name}-eq-{number}"
                node["ids"].append(anchor)
                domain.labels[label] = self.env.docname, anchor, f"eq. {number}"
                domain.anonlabels[label] = self.env.docname, anchor


def _above(node: nodes.Node) -> Iterator[nodes.Node]:
    """What a node stands in, from the inside."""
    while node.parent is not None:
        node = node.parent
        yield node


def _bring_mathjax(app: Sphinx) -> None:
    """Copy the script into the site."""
    if app.builder.format != "html":
        return
    package = importlib.util.find_spec(_MATHJAX)
    if package is None or not package.submodule_search_locations:
        raise RuntimeError(f"{_MATHJAX} is not installed; it comes with the extra `docs`")
    source = Path(package.submodule_search_locations[0]) / "static" / "mathjax" / _SCRIPT
    target = Path(app.outdir) / "_static" / _SCRIPT
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(source, target)


def setup(app: Sphinx) -> dict[str, Any]:
    """Register with Sphinx."""
    app.add_transform(Tagged)
    app.connect("builder-inited", _bring_mathjax)
    app.config.mathjax_path = _SCRIPT
    return {"parallel_read_safe": True, "parallel_write_safe": True}
