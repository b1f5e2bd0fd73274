"""Configuration of the documentation site: `make docs`, or `python docs/build.py`.

Everything a page needs lies in the site: mathematics, style and search work without a network.
"""

from __future__ import annotations

import sys
from importlib import metadata
from pathlib import Path

_HERE = Path(__file__).parent
sys.path[:0] = [str(_HERE / "_ext"), str(_HERE.parent)]

project = "leblanc"
author = "The leblanc developers"
copyright = "the leblanc developers, BSD-3-Clause"
version = release = metadata.version("leblanc")

extensions = [
    "myst_parser",            # Markdown
    "sphinx.ext.autodoc",
    "sphinx.ext.mathjax",
    "sphinxcontrib.bibtex",
    "sphinx_copybutton",
    "equations",              # numbers of equations as the sources have them, and links to them
    "docstrings",             # docstrings of this house to reStructuredText
    "pages",                  # tables that the pages take from the code
    "tables",                 # tables of words as cards on a telephone
    "thumbnails",             # the gallery as a grid of cards
]  # fmt: skip

exclude_patterns = ["_ext", "images", "examples"]
nitpicky = True
# Markdown: pages also render on GitHub, so only what both understand is used outside the contents.
myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_heading_anchors = 4
myst_links_external_new_tab = False
# What stands on a page can be typed: "65 mm" in straight quotes, --json with two hyphens.
smartquotes = False

autodoc_member_order = "bysource"
autodoc_mock_imports = ["jax", "pythonfmu"]  # the site does without the extras gpu and export
autodoc_typehints = "none"  # types stand with the parameters
autodoc_class_signature = "mixed"
add_module_names = False
toc_object_entries = False

bibtex_bibfiles = ["../references.bib"]
bibtex_default_style = "keyed"

html_theme = "furo"
html_title = f"leblanc {release}"
html_static_path = ["_static"]
html_css_files = ["house.css"]
html_copy_source = False
html_show_sphinx = False
html_last_updated_fmt = None
copybutton_prompt_text = "$ "
copybutton_only_copy_prompt_lines = True
