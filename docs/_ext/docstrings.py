"""Docstrings of this house as reStructuredText.

They are plain text with code in single backquotes, sections `Parameters`, `Returns`, `Raises` and `Examples`,
and citations such as `[theory: waves, eq. 5]` and `[DR18, eq. 8]`, which become links. The types of
parameters are the annotations as they are written in the source.
"""

from __future__ import annotations

import ast
import re
from pathlib import Path
from typing import Any

from api_pages import public_names
from sphinx.application import Sphinx

_SECTION = re.compile(r"^(\w+)\n-{4,}$", re.MULTILINE)
_ENTRY = re.compile(r"^(?P<names>[\w*]+(?:, [\w*]+)*) : (?P<text>.*)$")
_CODE = re.compile(r"(`[^`]+`)")
_CITED = re.compile(r"\[((?:theory: \w+|[A-Z][A-Za-z]+\d\d)[^\]]*)\]")
_PLACE = re.compile(r"^(theory: (?P<page>\w+)|(?P<key>[A-Z][A-Za-z]+\d\d))(?P<rest>.*)$", re.DOTALL)
_SPECIAL = re.compile(r"([\\*|_])")
_BIB = re.compile(r"@\w+\{(\w+),")


def keys(bibliography: Path) -> set[str]:
    """Keys of a BibTeX file."""
    return set(_BIB.findall(bibliography.read_text(encoding="utf-8")))


def plain(text: str, names: dict[str, str], known: set[str]) -> str:
    """Running text: code in backquotes, citations and objects linked, everything else as it is.

    Parameters
    ----------
    text : of a docstring
    names : full names of the objects that a short name means
    known : keys of the bibliography
    """
    parts = []
    for part in _CODE.split(text):
        if part.startswith("`") and part.endswith("`") and len(part) > 1:
            parts.append(_code(part[1:-1], names))
            continue
        begin = 0
        for found in _CITED.finditer(part):
            parts.append(_escaped(part[begin : found.start()]))
            parts.append(cited(found[1], known))
            begin = found.end()
        parts.append(_escaped(part[begin:]))
    return "".join(parts)


def _escaped(text: str) -> str:
    return _SPECIAL.sub(r"\\\1", text)


def _code(text: str, names: dict[str, str]) -> str:
    """A name that is known as a link, else a literal."""
    if text in names:
        return f"\\ :py:obj:`{text} <{names[text]}>`\\ "
    return f"\\ ``{text}``\\ "


def cited(text: str, known: set[str]) -> str:
    """Links of the places in one bracket, `theory: waves, eq. 5; DR18, eq. 8`, as reStructuredText."""
    places = [_place(place.strip(), known) for place in text.split(";")]
    return "[" + "; ".join(places) + "]"


def _place(text: str, known: set[str]) -> str:
    found = _PLACE.match(" ".join(text.split()))
    if found is None:
        return _escaped(text)
    rest = found["rest"]
    if found["page"]:
        page = found["page"]
        numbers = re.sub(r"\d+", lambda n: f":ref:`{n[0]} <{page}-eq-{n[0]}>`", rest)
        return f"theory: :ref:`{page} <theory-{page}>`" + (numbers if "eq." in rest else rest)
    key = found["key"]
    return (f":cite:label:`{key}`" if key in known else key) + _escaped(rest)


def written_types(thing: Any) -> dict[str, str]:
    """Types of parameters or fields as written; of `Annotated` the type alone."""
    thing = getattr(thing, "py_func", thing)
    ranks = reversed(thing.__mro__) if isinstance(thing, type) else (thing,)
    found: dict[str, str] = {}
    for owner in ranks:
        given = vars(owner).get("__annotations__", {}) if isinstance(owner, type) else owner.__annotations__
        found |= {name: _written(value) for name, value in given.items()}
    return found


def _written(value: object) -> str:
    text = value if isinstance(value, str) else getattr(value, "__name__", str(value))
    if not text.startswith("Annotated["):
        return text
    tree = ast.parse(text, mode="eval").body
    assert isinstance(tree, ast.Subscript)
    assert isinstance(tree.slice, ast.Tuple)
    return ast.unparse(tree.slice.elts[0])


def converted(lines: list[str], types: dict[str, str], names: dict[str, str], known: set[str]) -> list[str]:
    """A docstring of this house as reStructuredText.

    Parameters
    ----------
    lines : of the docstring, without common indent
    types : of the parameters
    names, known : see `plain`
    """
    pieces = _SECTION.split("\n".join(lines))
    out = _paragraphs(pieces[0], names, known)
    for title, body in zip(pieces[1::2], pieces[2::2], strict=True):
        out += ["", f".. rubric:: {title}", ""]
        body = body.strip("\n")
        if title == "Examples":
            out += body.splitlines()
        elif title == "Returns" and _ENTRY.match(body.partition("\n")[0]) is None:
            out += _paragraphs(body, names, known)
        else:
            out += _entries(body, types if title == "Parameters" else {}, names, known)
    return [*out, ""]


def _paragraphs(text: str, names: dict[str, str], known: set[str]) -> list[str]:
    return plain(text, names, known).splitlines()


def _entries(body: str, types: dict[str, str], names: dict[str, str], known: set[str]) -> list[str]:
    """`name : text` lines, with their indented continuations, as a definition list."""
    out: list[str] = []
    for line in body.splitlines():
        found = _ENTRY.match(line)
        if found:
            terms = [term.strip() for term in found["names"].split(",")]
            kinds = dict.fromkeys(types[term] for term in terms if term in types)
            term = ", ".join(f"**{_escaped(term)}**" for term in terms)
            kind = " or ".join(_type(text, names) for text in kinds)
            out += [
                "",
                term + (f" \N{EN DASH} {kind}" if kind else ""),
                "   " + plain(found["text"], names, known),
            ]
        elif line.startswith(" ") and out:
            out.append("   " + plain(line.strip(), names, known))
        else:
            out += ["", plain(line, names, known)] if line.strip() else [""]
    return out


def _type(text: str, names: dict[str, str]) -> str:
    """An annotation with links to the types of this package."""
    out = []
    for part in re.split(r"([A-Za-z_][\w.]*)", text):
        if part in names:
            out.append(f":py:obj:`{part} <{names[part]}>`")
        elif part.strip():
            # A literal neither begins nor ends with a space.
            left, right = (" " if part.startswith(" ") else ""), (" " if part.endswith(" ") else "")
            out.append(f"{left}``{part.strip()}``{right}")
        else:
            out.append(part)
    return "\\ ".join(part for part in out if part)


def setup(app: Sphinx) -> dict[str, Any]:
    """Register with Sphinx."""
    names = public_names()
    known = keys(Path(app.confdir).parent / "references.bib")

    def process(_app: Sphinx, what: str, _name: str, thing: Any, _options: Any, lines: list[str]) -> None:
        types = written_types(thing) if what in {"function", "method", "class", "exception"} else {}
        lines[:] = converted(lines, types, names, known)

    def citations(app: Sphinx, docname: str, source: list[str]) -> None:
        """Keys of papers in the pages become links."""
        if app.env.doc2path(docname).suffix == ".md":
            source[0] = linked(source[0], known)

    app.connect("autodoc-process-docstring", process)
    app.connect("source-read", citations)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def linked(text: str, known: set[str]) -> str:
    """Markdown with `[DR18, eq. 8]` and the like linked to the bibliography, code left alone."""
    parts = re.split(r"(^```.*?^```|`[^`\n]*`|\$\$.*?\$\$)", text, flags=re.DOTALL | re.MULTILINE)
    for i in range(0, len(parts), 2):
        parts[i] = re.sub(
            r"\[([A-Z][A-Za-z]+\d\d)((?:[,;][^\]]*)?)\](?!\()",
            lambda found: f"[{{cite:label}}`{found[1]}`{found[2]}]" if found[1] in known else found[0],
            parts[i],
        )
    return "".join(parts)
