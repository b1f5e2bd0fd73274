"""The page of the public API: what `import leblanc` offers, by its use.

Keys of a machine file and quantities of an answer are described on pages of their own, modules below the
public names by their docstrings.
"""

from __future__ import annotations

import ast
import importlib.util
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from leblanc import registry

PACKAGES = ("meshes", "fluid", "solvers", "leblanc", "validation")
# Programs, and notebooks in text form, which are pages of their own.
_LEFT_OUT = {"__main__", "notebooks"}
_DIRECTIVE: dict[type, str] = {ast.FunctionDef: "autofunction", ast.ClassDef: "autoclass"}
NAME = "api"
# Sections of the page, their introductions, and the names of `leblanc` in them.
SECTIONS: tuple[tuple[str, str, tuple[str, ...]], ...] = (
    (
        "Machines",
        "A scene is a machine with its liquid; what it may say stands on the :doc:`page of keys </scene>`.",
        (
            *("load_scene", "example", "Scene"),
            *(
                "JeffcottRotor",
                "TwoPlaneRotor",
                "TubRotor",
                "Exciter",
                "MagneticRotor",
                "Spindle",
                "Chamber",
                "Fill",
                "Liquid",
                "Friction",
                "LiquidModel",
                "LiquidAnswer",
            ),
        ),
    ),
    (
        "Calls",
        "Each does what the command of its name does, and returns a result.",
        (
            *("run", "run_up", "map_whirl", "map_balls", "optimise", "sweep", "compare", "fit", "explain"),
            *("layer", "modes", "volume", "bearing", "validate", "export", "open", "outputs"),
        ),
    ),
    ("Errors", "What is wrong with the input, in full.", ("InputError", "SceneError")),
)
# Modules besides, whose names stay.
KEPT = (
    *("fluid.fill", "fluid.liquid", "meshes.chamber", "solvers.rotor.jeffcott"),
    *("solvers.synchronous.response", "solvers.liquid_model"),
)
_RESULT = "Answer"  # class that all results inherit from
_BASE = f"leblanc.core.answer.{_RESULT}"
_WITH_METHODS = {"Scene"}
_CITED = re.compile(r"\s*\[[^\]]*(?:theory|\d\d)[^\]]*\]")


@dataclass(frozen=True)
class Member:
    """A public function or class.

    Parameters
    ----------
    name : in its module
    directive : what autodoc calls it
    summary : first line of its docstring, without citations
    full : dotted name under which it is described; below `leblanc` itself if it is one of its public names
    bases : names of the classes that it inherits from, as written, through private ones of its module
    """

    name: str
    directive: str
    summary: str
    full: str
    bases: tuple[str, ...] = ()


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


@cache
def modules(root: Path) -> tuple[Module, ...]:
    """Public modules below a folder, package by package."""
    return tuple(_modules(root))


def _modules(root: Path) -> Iterator[Module]:
    public = public_homes()
    for package in PACKAGES:
        for path in sorted((root / package).rglob("*.py")):
            parts = path.relative_to(root).with_suffix("").parts
            if _LEFT_OUT & set(parts) or any(p.startswith("_") and p != "__init__" for p in parts):
                continue
            own = parts[-1] == "__init__"
            name = ".".join(parts[:-1] if own else parts)
            tree = ast.parse(path.read_text(encoding="utf-8"))
            bases = {
                node.name: [*map(ast.unparse, node.bases)]
                for node in tree.body
                if isinstance(node, ast.ClassDef)
            }
            members = tuple(
                Member(
                    node.name,
                    _DIRECTIVE[type(node)],
                    summary(node),
                    public.get((name, node.name), f"{name}.{node.name}"),
                    tuple(_inherited(node.name, bases)),
                )
                for node in tree.body
                if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_")
            )
            if own and not members:
                continue
            yield Module(name, ".".join(parts[:-1]), summary(tree), members)


def _inherited(name: str, bases: dict[str, list[str]]) -> Iterator[str]:
    """Names that a class inherits from, each private one of its module with its own."""
    for base in bases.get(name, ()):
        yield base
        if base.startswith("_"):
            yield from _inherited(base, bases)


def public_homes() -> dict[tuple[str, str], str]:
    """Public name, as in "leblanc.run", of each module and name in it that `leblanc` hands on."""
    import leblanc

    homes = {}
    for name in leblanc.__all__:
        found = getattr(leblanc, name)
        homes[found.__module__, found.__qualname__] = f"leblanc.{name}"
    return homes


def results(found: Iterable[Module] | None = None) -> list[Member]:
    """All classes of results in a list of modules (all if None), the one that they inherit from first."""
    members = [m for module in (modules(source_root()) if found is None else found) for m in module.members]
    names, known = {_RESULT}, 0
    while len(names) > known:
        known = len(names)
        names |= {member.name for member in members if names.intersection(member.bases)}
    classes = [m for m in members if m.full == _BASE or names.intersection(m.bases)]
    return sorted(classes, key=lambda member: (member.full != _BASE, member.name))


def summary(node: ast.Module | ast.FunctionDef | ast.ClassDef) -> str:
    """First line of a docstring, without citations, as reStructuredText."""
    line = (ast.get_docstring(node) or "").partition("\n")[0]
    parts = re.split(r"(`[^`]+`)", _CITED.sub("", line))
    plain = [
        re.sub(r"([\\*|_])", r"\\\1", part) if k % 2 == 0 else f"\\ `{part}`\\ "
        for k, part in enumerate(parts)
    ]
    return "".join(plain)


def public_names() -> dict[str, str]:
    """Full name of each object that the page describes, by its short name."""
    found = {name: f"leblanc.{name}" for _, _, names in SECTIONS for name in names}
    return found | {member.name: member.full for member in results()}


def write(folder: Path) -> Path:
    """Write the page into a folder, in the place of the one that says where to find it; its path."""
    path = folder / f"{NAME}.md"
    found = modules(source_root())
    path.write_text(_page(found, results(found)), encoding="utf-8")
    return path


def _page(found: Iterable[Module], answers: list[Member]) -> str:
    """The public names of `leblanc` with their docstrings, then its results."""
    members = {member.full: member for module in found for member in module.members}
    lines = [
        "# Public names",
        "",
        "After `import leblanc as lb`, each is `lb.NAME`. The short way in: [from Python](howto/python.md).",
        "",
        *_as_written(_promise(found)),
    ]
    for section, introduction, names in SECTIONS:
        lines += _section(section, introduction, [members[f"leblanc.{name}"] for name in names])
    base, *others = answers
    text = (
        "What calls return. All inherit from :py:obj:`Answer <leblanc.core.answer.Answer>`; "
        "their quantities stand on the :doc:`page of outputs </outputs>`, examples in their docstrings."
    )
    rows = [(f"``{member.name}``", member.summary) for member in others]
    return "\n".join([*lines, *_section("Results", text, [base]), *_as_written(_table(rows))])


def _promise(found: Iterable[Module]) -> list[str]:
    """What scripts may rely on, besides the names of the page."""
    there = {module.name: module for module in found}
    below = [(f"``{name}``", there[name].summary) for name in KEPT]
    groups = ", ".join(f"``{group}``" for group in (registry.COMMANDS, registry.LIQUIDS, registry.MACHINES))
    return [
        "Scripts may rely on the names of this page, their parameters and what answers carry by name; on",
        "options and exit codes of commands; on keys of machine files, studies, JSON and data files; on the",
        f"groups of entry points {groups}; and on what these modules hold:",
        "",
        *_table(below),
        "What of this moves keeps its old path for a version, with a ``DeprecationWarning`` that says the",
        "new one; the changelog says what scripts type instead. Everything else may move with any version.",
        "",
    ]


def _section(title: str, introduction: str, members: list[Member]) -> list[str]:
    """A heading, then the docstrings of its members."""
    lines = [introduction, ""]
    for member in members:
        lines += _described(member)
    return [f"## {title}", "", *_as_written(lines)]


def _as_written(lines: list[str]) -> list[str]:
    """reStructuredText in a page of Markdown."""
    return ["```{eval-rst}", *lines, "```", ""]


def _described(member: Member) -> list[str]:
    """The directive for the docstring of a member, of some classes with their methods."""
    lines = [f".. {member.directive}:: {member.full}"]
    if member.full == _BASE or member.name in _WITH_METHODS:
        # pydantic gives each of its models a `model_config` with words in another markup.
        lines += ["   :members:", "   :exclude-members: model_config"]
    return [*lines, ""]


def _table(rows: list[tuple[str, str]]) -> list[str]:
    """Names and what they are."""
    if not rows:
        return []
    lines = [".. list-table::", "   :widths: 30 70", ""]
    for name, text in rows:
        lines += [f"   * - {name}", f"     - {text}"]
    return [*lines, ""]
