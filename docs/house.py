"""Measure the house: modules, folders and imports of the packages, and what a command passes through.

    python docs/house.py                                  # the table
    python docs/house.py --flows                          # and the modules that three commands pass through
    python docs/house.py --picture docs/images/rooms.png  # and the parts on their floors

The sources are read, not imported. An import is a statement in a source, for a type checker alone as well;
modules that a name in a string brings in are not seen.
"""

from __future__ import annotations

import argparse
import ast
import json
import sys
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import median

_HERE = Path(__file__).resolve().parent
ROOT = _HERE.parent
sys.path.insert(0, str(_HERE))

import flows  # noqa: E402 - beside this file
import rooms  # noqa: E402

# From the ground up. `study` is what `leblanc` was called; a package that is not there is left out.
PACKAGES = ("meshes", "fluid", "solvers", "study", "leblanc", "validation")


@dataclass(frozen=True)
class Module:
    """One source file.

    Parameters
    ----------
    name : full, without `__init__`
    room : folder that it lies in, from the root, with slashes
    lines : of the file
    imports : modules of ours that it imports, wherever in the file
    inside : import statements inside functions: of our modules, and of others
    """

    name: str
    room: str
    lines: int
    imports: frozenset[str]
    inside: tuple[int, int]

    @property
    def package(self) -> str:
        """Its top-level package."""
        return self.name.partition(".")[0]


def read(root: Path, packages: Iterable[str] = PACKAGES) -> list[Module]:
    """Read the sources of the packages that exist.

    Parameters
    ----------
    root : folder that holds them
    packages : names of their folders
    """
    files = {_name(path, root): path for name in packages for path in sorted((root / name).rglob("*.py"))}
    return [_module(name, path, root, files) for name, path in files.items()]


def _name(path: Path, root: Path) -> str:
    parts = path.relative_to(root).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def _module(name: str, path: Path, root: Path, known: Collection[str]) -> Module:
    text = path.read_text(encoding="utf-8")
    package = name if path.name == "__init__.py" else name.rpartition(".")[0]
    imports: set[str] = set()
    inside = [0, 0]
    for statement, in_function in _imports(ast.parse(text)):
        ours = {_known(target, known) for target in _targets(statement, package)} - {""}
        imports |= ours
        inside[0 if ours else 1] += in_function
    room = path.parent.relative_to(root).as_posix()
    return Module(name, room, len(text.splitlines()), frozenset(imports - {name}), (inside[0], inside[1]))


def _imports(node: ast.AST, in_function: bool = False) -> Iterator[tuple[ast.Import | ast.ImportFrom, bool]]:
    """Import statements, and whether each stands inside a function."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.Import | ast.ImportFrom):
            yield child, in_function
        within = isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda)
        yield from _imports(child, in_function or within)


def _targets(statement: ast.Import | ast.ImportFrom, package: str) -> list[str]:
    """Dotted names that a statement asks for; `from a import b` asks for a.b, which may be a name in a."""
    if isinstance(statement, ast.Import):
        return [alias.name for alias in statement.names]
    base = statement.module or ""
    if statement.level:
        above = package.split(".")[: len(package.split(".")) - statement.level + 1]
        base = ".".join([*above, *filter(None, [base])])
    return [f"{base}.{alias.name}" for alias in statement.names]


def _known(target: str, known: Collection[str]) -> str:
    """The module of ours that a dotted name leads to; empty if it leads elsewhere."""
    while target and target not in known:
        target = target.rpartition(".")[0]
    return target


@dataclass(frozen=True)
class Row:
    """Numbers of one package, or of all.

    Parameters
    ----------
    package : its name
    modules, lines : how many
    folder : the folder with the most modules of its own, and how many
    middle : lines of the module in the middle when they are ordered by length
    largest : the longest module and its lines
    single : modules that exactly one other module imports
    inside, inside_elsewhere : import statements inside functions, of our modules and of others; and those
        that are not in a folder `cli`
    circles : folders that import one another in a circle
    """

    package: str
    modules: int
    lines: int
    folder: tuple[str, int]
    middle: float
    largest: tuple[str, int]
    single: int
    inside: tuple[int, int]
    inside_elsewhere: tuple[int, int]
    circles: list[list[str]]


def table(modules: Sequence[Module]) -> list[Row]:
    """Numbers of each package, and of all in the last row.

    Parameters
    ----------
    modules : from `read`
    """
    importers = Counter(target for module in modules for target in module.imports)
    packages: dict[str, list[Module]] = {}
    for module in modules:
        packages.setdefault(module.package, []).append(module)
    return [_row(name, some, importers) for name, some in (packages | {"all": list(modules)}).items()]


def _row(package: str, modules: Sequence[Module], importers: Mapping[str, int]) -> Row:
    longest = max(modules, key=lambda module: module.lines)
    elsewhere = [module for module in modules if "cli" not in module.room.split("/")]
    return Row(
        package,
        len(modules),
        sum(module.lines for module in modules),
        Counter(module.room for module in modules).most_common(1)[0],
        median(module.lines for module in modules),
        (longest.name, longest.lines),
        sum(importers[module.name] == 1 for module in modules),
        _sum(module.inside for module in modules),
        _sum(module.inside for module in elsewhere),
        rooms.circles(between(modules)),
    )


def _sum(pairs: Iterable[tuple[int, int]]) -> tuple[int, int]:
    ours, others = zip(*pairs, strict=True)
    return sum(ours), sum(others)


def between(modules: Sequence[Module]) -> dict[tuple[str, str], int]:
    """Imports between folders: importing and imported folder, and how many.

    A module beside the folders of its package that imports one of them stands above them and counts alone.
    Names that a folder's `__init__` hands on from within, and what a `__main__` starts, are no imports of it.
    """
    home = {module.name: module.room for module in modules}
    imports = {module.name: _own(module) & home.keys() for module in modules}
    loose = {module.name for module in modules if module.room == module.package != module.name}
    while above := {
        name for name in loose if any("/" in home[to] and _beside(name, to) for to in imports[name])
    }:
        home |= {name: f"{name.replace('.', '/')}.py" for name in above}
        loose -= above
    found: Counter[tuple[str, str]] = Counter()
    for name, targets in imports.items():
        found.update((home[name], home[target]) for target in targets if home[target] != home[name])
    return dict(found)


def _beside(name: str, other: str) -> bool:
    """Whether two modules are of one package."""
    return name.partition(".")[0] == other.partition(".")[0]


def _own(module: Module) -> set[str]:
    """Imports of a module that make its room depend on another."""
    starts = module.name.endswith(".__main__")
    return set() if starts else {name for name in module.imports if not name.startswith(f"{module.name}.")}


def shown(rows: Iterable[Row]) -> str:
    """The table in Markdown.

    Parameters
    ----------
    rows : of `table`
    """
    heads = (
        *("package", "modules", "lines", "largest folder", "median", "largest module", "one importer"),
        *("imports in functions (ours + others)", "outside cli", "folders in circles"),
    )
    cells = [
        (
            *(row.package, str(row.modules), str(row.lines), f"{row.folder[0]} {row.folder[1]}"),
            *(f"{row.middle:g}", f"{row.largest[0]} {row.largest[1]}", str(row.single)),
            *(" + ".join(map(str, pair)) for pair in (row.inside, row.inside_elsewhere)),
            "; ".join(", ".join(circle) for circle in row.circles) or "none",
        )
        for row in rows
    ]
    return flows.markdown(heads, cells)


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, print, draw.

    Parameters
    ----------
    arguments : of the command line; None: the process's own

    Returns
    -------
    Exit code
    """
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--root", type=Path, default=ROOT, help="folder of the packages [this tree]")
    parser.add_argument("--flows", action="store_true", help="trace three commands, half a minute")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the numbers")
    parser.add_argument("--picture", type=Path, metavar="FILE", help="draw the parts, as PNG and as SVG")
    parser.add_argument("--out", type=Path, default=Path(), help="folder that these names start from [here]")
    chosen = parser.parse_args(arguments)
    modules = read(chosen.root)
    rows = table(modules)
    print(shown(rows))
    traced = flows.trace_all(chosen.root) if chosen.flows else []
    if traced:
        print(f"\n{flows.shown(traced)}")
    if chosen.json is not None:
        kept = {"packages": [asdict(row) for row in rows], "flows": [asdict(flow) for flow in traced]}
        (chosen.out / chosen.json).write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")
    if chosen.picture is not None:
        rooms.draw_rooms([module.name for module in modules], chosen.out / chosen.picture)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
