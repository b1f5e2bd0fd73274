"""What users read has the field's terms: no word of our own where the field has one."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import fluid
import leblanc
import meshes
import solvers

# Ours, and what the field says. Single words that a key or a name may be are not here.
WORDS = {
    r"whirls? (that )?grows? (by itself|most)": "self-excited whirl; fastest-growing whirl",
    r"held in time|held states?|[Hh]old anew": "integrated in time, time-domain state; recompute",
    r"(not|has not|have not|until it) settled": "not converged",
    r"\b(dies|fades?) (out|away|with)": "decays",
    r"\bto and fro\b": "straight-line",
    r"\b(no|No|a) ring (of liquid )?stands\b": "annular layer",
    r"\bcapture speed\b|falls back(?! into a pool)": "centrifuging speed; collapse of the annulus",
    r"\bcarried (along|round)\b": "spin-up, annulus reached from rest",
    r"\bhand-over\b": "pool-annulus transition",
    r"\bfull chamber's mass\b": "reference mass",
    r"\b[Ff]orce ratio\b": "force coefficient",
    r"\b(one|One) family of\b": "unidirectional",
    r"\b[Ff]ree waves?\b": "natural sloshing wave",
    r"\b[Ee]xact waves?\b": "fully nonlinear wave",
    r"\bas printed\b": "as published",
    r"\b[Cc]losed form\b": "analytical",
    r"\b(hold left|motor hangs|hardest blow)\b": "sliding margin, Sommerfeld effect, impulse",
    r"[Bb]ear in mind|Doubtful": "note, caution",
    r"\b(is|are|not) (told|judged)\b|\bis told\b": "reported, evaluated",
}
PRIVATE = re.compile("|".join(WORDS))


def spoken(tree: ast.Module) -> Iterator[str]:
    """Every text of a module but its docstrings; of an f-string what is written out, as one."""
    silent = {
        id(node.body[0].value)
        for node in ast.walk(tree)
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef)
        and node.body
        and isinstance(node.body[0], ast.Expr)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            yield "".join(part.value if isinstance(part, ast.Constant) else "{}" for part in node.values)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in silent:
            yield node.value


def private(source: str) -> set[str]:
    """Our own words in the texts of a source."""
    return {found[0] for text in spoken(ast.parse(source)) for found in PRIVATE.finditer(text)}


def test_texts_have_the_terms_of_the_field() -> None:
    """Console, reports, help and labels, and what solvers say of themselves in them."""
    for package in (meshes, fluid, solvers, leblanc):
        for path in sorted(Path(str(package.__file__)).parent.rglob("*.py")):
            assert not private(path.read_text(encoding="utf-8")), path


def test_our_own_words_are_seen() -> None:
    """In a plain text, across the pieces of an f-string; not in a docstring or a key."""
    assert private('say("the whirl that grows most")') == {"whirl that grows most"}
    assert private('f"{count} motions held " f"in time"') == {"held in time"}
    assert not private('"""Held in time."""\nkey = "capture_speed"')
