"""Seeded faults: one wrong sign, factor or moment for each formula, each of which an oracle must catch.

A fault names a module, a piece of its source and the wrong piece put in its place. While it is seeded, every
function of that module whose code changes runs the wrong code, wherever it was imported to. `test_faults.py`
asserts that the oracle of each fault passes without it and fails with it.
"""

from __future__ import annotations

import importlib
import inspect
import types
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path


@dataclass(frozen=True)
class Fault:
    """A wrong piece of source and the oracle that must notice it.

    Parameters
    ----------
    module : dotted name of the module
    right : a piece of its source that stands there exactly once
    wrong : what replaces it
    oracle : function without arguments that asserts the physics
    """

    module: str
    right: str
    wrong: str
    oracle: Callable[[], None]

    def __str__(self) -> str:
        return f"{self.module}: {self.right.strip()} -> {self.wrong.strip()}"


def _functions(namespace: dict[str, object], module: str) -> dict[str, types.FunctionType]:
    """Functions and methods that were defined in that module, by qualified name."""
    found: dict[str, types.FunctionType] = {}
    for value in namespace.values():
        if isinstance(value, types.FunctionType) and value.__module__ == module:
            found[value.__qualname__] = value
        elif inspect.isclass(value) and value.__module__ == module:
            for member in vars(value).values():
                function = member.fget if isinstance(member, property) else member
                function = member.func if isinstance(member, cached_property) else function
                if isinstance(function, types.FunctionType) and function.__module__ == module:
                    found[function.__qualname__] = function
    return found


@contextmanager
def seeded(fault: Fault) -> Iterator[None]:
    """Run the body with the fault in place."""
    module = importlib.import_module(fault.module)
    assert module.__file__ is not None
    source = Path(module.__file__).read_text(encoding="utf-8")
    assert source.count(fault.right) == 1, f"{fault}: stands there {source.count(fault.right)} times"
    namespace: dict[str, object] = {"__name__": fault.module, "__file__": module.__file__}
    exec(compile(source.replace(fault.right, fault.wrong), module.__file__, "exec"), namespace)
    right, wrong = _functions(vars(module), fault.module), _functions(namespace, fault.module)
    changed = {name: right[name].__code__ for name in right if name in wrong}
    assert changed, f"{fault}: changes no function"
    try:
        for name in changed:
            right[name].__code__ = wrong[name].__code__
        yield
    finally:
        for name, code in changed.items():
            right[name].__code__ = code
