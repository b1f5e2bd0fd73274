"""The table of symbols is what the pages show, and its names are those of the code."""

from __future__ import annotations

import ast
from pathlib import Path

from fluid.notation import GROUPS, page

ROOT = Path(__file__).parents[2]


def test_the_page_has_the_tables() -> None:
    assert page() in (ROOT / "docs" / "symbols.md").read_text(encoding="utf-8")


def test_names_are_used() -> None:
    used = set()
    for package in ("meshes", "fluid", "solvers"):
        for path in (ROOT / package).rglob("*.py"):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.arg):
                    used.add(node.arg)
                elif isinstance(node, ast.FunctionDef):
                    used.add(node.name)
                elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
                    used.add(node.target.id)
    named = {name for group in GROUPS.values() for s in group for name in s.name.split(", ")}
    assert not named - used


def test_no_name_has_two_meanings() -> None:
    names = [name for group in GROUPS.values() for s in group for name in s.name.split(", ")]
    assert len(names) == len(set(names))
