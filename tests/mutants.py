"""Mutants: one wrong sign, factor or moment put into one function, which an oracle must catch.

`@kills(function, right, wrong)` above a test says that the test fails while `wrong` stands for `right` in
that function. The test runs once as it stands and once with each of its mutants (`tests/conftest.py`), which
it must notice. `pytest -m mutant` runs the mutants alone, `-m "not mutant"` the tests alone.
"""

from __future__ import annotations
import __future__

import ast
import importlib
import inspect
import types
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path

import pytest

from meshes.errors import InputError

# What tells that an oracle, or the package itself, noticed.
CAUGHT = (AssertionError, ArithmeticError, InputError)


@dataclass(frozen=True)
class Mutant:
    """A wrong piece of source in one function.

    Parameters
    ----------
    function : "module:qualified name" of a function, or of a method, property or cached function
    right : a piece of its source that stands there exactly once
    wrong : what replaces it
    """

    function: str
    right: str
    wrong: str

    def __str__(self) -> str:
        module, _, name = self.function.partition(":")
        texts = (" ".join(text.split()) for text in (self.right, self.wrong))
        right, wrong = (text if len(text) <= 60 else f"{text[:57]}..." for text in texts)
        return f"{module.rpartition('.')[2]}.{name}: {right} -> {wrong}"


def kills(function: str, right: str, wrong: str) -> pytest.MarkDecorator:
    """Mark a test as the oracle that catches this mutant; the parameters are those of `Mutant`."""
    return pytest.mark.kills(Mutant(function, right, wrong))


@contextmanager
def seeded(mutant: Mutant) -> Iterator[None]:
    """Run the body with the mutant in place, wherever its function was imported to."""
    module, _, name = mutant.function.partition(":")
    found = _found(importlib.import_module(module), name)
    function = _function(found)
    right = function.__code__
    wrong = _wrong_code(mutant, name, Path(inspect.getfile(function)), right)
    forget = getattr(found, "cache_clear", lambda: None)
    forget()
    function.__code__ = wrong
    try:
        yield
    finally:
        function.__code__ = right
        forget()


def _found(module: types.ModuleType, name: str) -> object:
    """What stands under a qualified name, as the class holds it: properties are not called."""
    found: object = module
    for part in name.split("."):
        found = inspect.getattr_static(found, part)
    return found


def _function(found: object) -> types.FunctionType:
    """The plain function behind a property, a class method, a cache."""
    if isinstance(found, property):
        found = found.fget
    elif isinstance(found, cached_property):
        found = found.func
    elif isinstance(found, staticmethod | classmethod):
        found = found.__func__
    found = inspect.unwrap(found)  # type: ignore[arg-type]
    assert isinstance(found, types.FunctionType), f"{found} is compiled or no function"
    return found


@cache
def _parsed(path: Path) -> tuple[list[str], dict[tuple[str, int], tuple[ast.FunctionDef, int, int]]]:
    """Lines, and functions by name and first line: each with the lines of the whole statement around it."""
    source = path.read_text(encoding="utf-8")
    functions = {}
    for statement in ast.parse(source).body:
        around = _first_line(statement) - 1, statement.end_lineno
        for node in ast.walk(statement):
            if isinstance(node, ast.FunctionDef):
                functions[node.name, _first_line(node)] = node, *around
    return source.splitlines(keepends=True), functions


def _first_line(node: ast.stmt) -> int:
    return min([node.lineno, *(d.lineno for d in getattr(node, "decorator_list", []))])


def _wrong_code(mutant: Mutant, name: str, path: Path, right: types.CodeType) -> types.CodeType:
    """Compile the function, or the class it stands in, with the mutant in place."""
    lines, functions = _parsed(path)
    last_name, first_line = name.rpartition(".")[2], right.co_firstlineno
    node, begin, end = functions[last_name, first_line]
    first, last = node.lineno - 1, node.end_lineno
    source = "".join(lines[first:last])
    assert source.count(mutant.right) == 1, f"{mutant}: stands there {source.count(mutant.right)} times"
    # Empty lines before it, so that numbers of lines stay.
    text = "".join(
        ["\n" * begin, *lines[begin:first], source.replace(mutant.right, mutant.wrong), *lines[last:end]]
    )
    future = right.co_flags & __future__.annotations.compiler_flag
    whole = compile(text, str(path), "exec", future, dont_inherit=True)
    return next(c for c in _codes(whole) if c.co_name == last_name and c.co_firstlineno == first_line)


def _codes(code: types.CodeType) -> Iterator[types.CodeType]:
    """The code objects within one, at every depth."""
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            yield constant
            yield from _codes(constant)
