"""Pages of the API reference: the public names of `leblanc` by their use, then each package by module.

An object is described once. What `import leblanc` offers stands on the page of public names; on the page of
its package its line leads there.
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
# The page of public names: its sections, their introductions, and the names of `leblanc` in them.
PUBLIC = "public"
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
    classes = [m for m in members if m.name == _RESULT or names.intersection(m.bases)]
    return sorted(classes, key=lambda member: (member.name != _RESULT, member.name))


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
    """Full name of each public object whose short name only one module has."""
    found: dict[str, list[str]] = {}
    for module in modules(source_root()):
        for member in module.members:
            found.setdefault(member.name, []).append(member.full)
    return {short: full[0] for short, full in found.items() if len(full) == 1}


def write(folder: Path) -> list[Path]:
    """Write the pages.

    Parameters
    ----------
    folder : where they go, below the packages' own

    Returns
    -------
    The pages: public names first, then in the order of the layers
    """
    folder.mkdir(parents=True, exist_ok=True)
    by_package: dict[str, list[Module]] = {}
    found = modules(source_root())
    answers = results(found)
    for module in found:
        by_package.setdefault(module.package, []).append(module)
    pages = [folder / f"{PUBLIC}.rst"]
    pages[0].write_text(_public_page(found, answers), encoding="utf-8")
    for package, members in by_package.items():
        page = folder / f"{package}.rst"
        page.write_text(_page(package, members, answers), encoding="utf-8")
        pages.append(page)
    return pages


def _public_page(found: Iterable[Module], answers: list[Member]) -> str:
    """The public names of `leblanc` and its results, each with its docstring."""
    members = {member.full: member for module in found for member in module.members}
    title = "Public names"
    lines = [
        title,
        "=" * len(title),
        "",
        "After ``import leblanc as lb``, each is ``lb.NAME``.",
        "",
        *_promise(found),
    ]
    for section, introduction, names in SECTIONS:
        lines += _section(section, introduction, [members[f"leblanc.{name}"] for name in names])
    text = "What calls return. All inherit from :py:obj:`Answer <leblanc.core.answer.Answer>`."
    return "\n".join(lines + _section("Results", text, answers))


def _promise(found: Iterable[Module]) -> list[str]:
    """What scripts may rely on, besides the names of the page."""
    there = {module.name: module for module in found}
    below = [(f":py:mod:`{name}`", there[name].summary) for name in KEPT]
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
    """A heading, a table of members, then their docstrings."""
    lines = [title, "-" * len(title), "", introduction, "", *_table(_rows(members))]
    for member in members:
        lines += _described(member)
    return lines


def _page(package: str, members: list[Module], answers: list[Member]) -> str:
    elsewhere = {member.full for member in answers}
    lines = [package, "=" * len(package), ""]
    lines += _table([(f":py:mod:`{module.name}`", module.summary) for module in members])
    for module in members:
        lines += ["", module.name, "-" * len(module.name), "", f".. automodule:: {module.name}", ""]
        lines += _table(_rows(module.members))
        for member in module.members:
            if member.full == f"{module.name}.{member.name}" and member.full not in elsewhere:
                lines += _described(member)
    return "\n".join(lines)


def _described(member: Member) -> list[str]:
    """The directive for the docstring of a member."""
    lines = [f".. {member.directive}:: {member.full}"]
    # matplotlib gives each of its classes a method `set` with a docstring that is its own, pydantic each of
    # its models a `model_config` with words in another markup.
    members = ["   :members:", "   :exclude-members: set, model_config", ""]
    return lines + (members if member.directive == "autoclass" else [""])


def _rows(members: Iterable[Member]) -> list[tuple[str, str]]:
    """Names that lead to their docstrings, and what they are."""
    return [(f":py:obj:`{member.name} <{member.full}>`", member.summary) for member in members]


def _table(rows: list[tuple[str, str]]) -> list[str]:
    """Names and what they are."""
    if not rows:
        return []
    lines = [".. list-table::", "   :widths: 30 70", ""]
    for name, text in rows:
        lines += [f"   * - {name}", f"     - {text}"]
    return [*lines, ""]
