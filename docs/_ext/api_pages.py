"""Pages of the API reference: one for each package, a section for each public module."""

from __future__ import annotations

import ast
import importlib.util
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

PACKAGES = ("meshes", "fluid", "solvers", "leblanc", "validation")
# Programs, and notebooks in text form, which are pages of their own.
_LEFT_OUT = {"__main__", "notebooks"}
_DIRECTIVE: dict[type, str] = {ast.FunctionDef: "autofunction", ast.ClassDef: "autoclass"}
_CITED = re.compile(r"\s*\[[^\]]*(?:theory|\d\d)[^\]]*\]")


@dataclass(frozen=True)
class Member:
    """A public function or class.

    Parameters
    ----------
    name : in its module
    directive : what autodoc calls it
    summary : first line of its docstring, without citations
    """

    name: str
    directive: str
    summary: str


@dataclass(frozen=True)
class Module:
    """A public module as its source shows it.

    Parameters
    ----------
    name : dotted
    package : dotted name of the package whose page has it
    summary : first line of its docstring
    members : public functions and classes defined in it, in their order
    """

    name: str
    package: str
    summary: str
    members: tuple[Member, ...]


def source_root() -> Path:
    """The folder that holds the packages which are documented: those that are imported."""
    found = importlib.util.find_spec(PACKAGES[0])
    if found is None or found.origin is None:
        raise RuntimeError("the package is not installed; see `make docs`")
    return Path(found.origin).parents[1]


def modules(root: Path) -> Iterator[Module]:
    """Public modules below a folder, package by package."""
    for package in PACKAGES:
        for path in sorted((root / package).rglob("*.py")):
            parts = path.relative_to(root).with_suffix("").parts
            if _LEFT_OUT & set(parts) or any(p.startswith("_") and p != "__init__" for p in parts):
                continue
            tree = ast.parse(path.read_text(encoding="utf-8"))
            members = tuple(
                Member(node.name, _DIRECTIVE[type(node)], summary(node))
                for node in tree.body
                if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_")
            )
            own = parts[-1] == "__init__"
            if own and not members:
                continue
            name = ".".join(parts[:-1] if own else parts)
            yield Module(name, ".".join(parts[:-1]), summary(tree), members)


def summary(node: ast.Module | ast.FunctionDef | ast.ClassDef) -> str:
    """First line of a docstring, without citations, as reStructuredText."""
    line = (ast.get_docstring(node) or "").partition("\n")[0]
    parts = re.split(r"(`[^`]+`)", _CITED.sub("", line))
    plain = [
        re.sub(r"([\\*|_])", r"\\\1", one) if k % 2 == 0 else f"\\ `{one}`\\ " for k, one in enumerate(parts)
    ]
    return "".join(plain)


def public_names() -> dict[str, str]:
    """Full name of each public object whose short name only one module has."""
    found: dict[str, list[str]] = {}
    for module in modules(source_root()):
        for member in module.members:
            found.setdefault(member.name, []).append(f"{module.name}.{member.name}")
    return {short: full[0] for short, full in found.items() if len(full) == 1}


def write(folder: Path) -> list[Path]:
    """Write the pages.

    Parameters
    ----------
    folder : where they go, below the packages' own

    Returns
    -------
    The pages, in the order of the layers
    """
    folder.mkdir(parents=True, exist_ok=True)
    by_package: dict[str, list[Module]] = {}
    for module in modules(source_root()):
        by_package.setdefault(module.package, []).append(module)
    pages = []
    for package, members in by_package.items():
        page = folder / f"{package}.rst"
        page.write_text(_page(package, members), encoding="utf-8")
        pages.append(page)
    return pages


def _page(package: str, members: list[Module]) -> str:
    lines = [package, "=" * len(package), ""]
    lines += _table([(f":py:mod:`{one.name}`", one.summary) for one in members])
    for module in members:
        lines += ["", module.name, "-" * len(module.name), "", f".. automodule:: {module.name}", ""]
        lines += _table([(f":py:obj:`{one.name}`", one.summary) for one in module.members])
        for one in module.members:
            lines += [f".. {one.directive}:: {module.name}.{one.name}"]
            # matplotlib gives each of its classes a method `set` with a docstring that is its own.
            members = ["   :members:", "   :exclude-members: set", ""]
            lines += members if one.directive == "autoclass" else [""]
    return "\n".join(lines)


def _table(rows: list[tuple[str, str]]) -> list[str]:
    """Names and what they are."""
    if not rows:
        return []
    lines = [".. list-table::", "   :widths: 30 70", ""]
    for name, text in rows:
        lines += [f"   * - {name}", f"     - {text}"]
    return [*lines, ""]
