"""Compiled functions of numba, imported here alone, their machine code kept where nobody else can write.

numba keys its cache by the file of a function, not by what that calls, and raises where neither the package
nor HOME can be written. Here each state of a module and of all that it imports has a folder of its own below
the user's caches; without one each process compiles for itself.

What one compiled function calls by its name becomes a part of it and is optimised with it; what only compiled
code calls (BARE) is therefore left as it is, and has no machine code of its own. Large parts, and those that
only some scenes have, are handed over as arguments instead: `Handed`.
"""

from __future__ import annotations

import gc
import hashlib
import inspect
import os
import re
import shutil
import stat
import threading
import time
import warnings
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numba
import platformdirs
from numba.core import codegen, event
from numba.core.errors import NumbaExperimentalFeatureWarning
from numba.core.registry import cpu_target

from solvers import compiling

# Options of what only compiled code calls, of what is handed over, and of what Python calls as well as that;
# without any of them Python calls a function. Each wrapper is compiled too.
BARE: dict[str, Any] = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
HANDED: dict[str, Any] = {"no_cpython_wrapper": True, "no_cfunc_wrapper": False}
BOTH: dict[str, Any] = {"no_cfunc_wrapper": False}
_HERE = Path(__file__)
# What a module imports of the layers up to this one, indented or not, in brackets or not.
_OURS = r"((?:meshes|fluid|solvers)\b[\w.]*)"
_IMPORT = re.compile(rf"^ *(?:from {_OURS} import (\([^)]*\)|.+)|import {_OURS})", re.MULTILINE)
_UNUSED = 30.0 * 86400.0  # s, after which the folder of other sources is removed
_choosing = threading.RLock()
_config: Any = numba.config


def machine_code(settled: bool = False, **options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Decorator that compiles a function by `numba.njit` with some options.

    What becomes part of its callers (`inline`) has no machine code of its own. `settled`: of a part of others
    the compiler chooses here, once for all callers, how it rounds.
    """
    compile_it: Any = numba.njit(**({"no_cfunc_wrapper": True} | options))

    def compiled(function: Callable[..., Any]) -> Any:
        made = compile_it(function)
        made.settled = settled
        if "inline" in options or _config.DISABLE_JIT:
            return made
        folder = cache_folder(Path(inspect.getfile(function)))
        if folder is not None:
            with _choosing:
                # Read as the cache is made, and for nobody else's functions.
                given, _config.CACHE_DIR = _config.CACHE_DIR, str(folder)
                try:
                    made.enable_caching()
                except RuntimeError:  # the folder has become one that cannot be written
                    cache_folder.cache_clear()
                finally:
                    _config.CACHE_DIR = given
        return made

    return compiled


@cache
def cache_folder(source: Path = _HERE) -> Path | None:
    """Where a module's machine code is kept: NUMBA_CACHE_DIR, or below the user's caches; None: nowhere."""
    if _config.CACHE_DIR:
        folder = Path(_config.CACHE_DIR)
        return folder if _writable(folder) else None
    sources = b"".join(path.read_bytes() for path in sorted(_reached(source)))
    return private_folder(f"machine-code-{hashlib.sha256(sources).hexdigest()[:16]}")


# Types of arguments: a float, an integer, a flag, arrays of floats one after the other.
REAL, WHOLE, FLAG = numba.float64, numba.int64, numba.boolean
ROW, ROWS, BLOCKS, TURNING = REAL[::1], REAL[:, ::1], REAL[:, :, ::1], numba.complex128[::1]
NOTHING = numba.void
type_of: Any = numba.typeof


_events: Any = event


class _Heard(event.Listener):
    """Tells when numba compiles, and adds up how long it takes.

    Meanwhile nobody searches for cyclic garbage among all that it makes, which takes a fifth of the time.
    """

    begun, collects = 0.0, False

    def __init__(self) -> None:
        self.open: list[Any] = []  # the functions that are being compiled

    def on_start(self, event: Any) -> None:
        """Of a function, which may ask for others on its way."""
        if not self.open:
            self.begun, self.collects = time.process_time(), gc.isenabled()
            gc.disable()
            compiling.tell(True)
        self.open.append(event.data["dispatcher"])

    def on_end(self, event: Any) -> None:
        """Of the same."""
        self.open.pop()
        if not self.open:
            if self.collects:
                gc.enable()
            compiling.SPENT.append(time.process_time() - self.begun)
            compiling.tell(False)


_heard = _Heard()
_events.register("numba:compile", _heard)
_codegen: Any = codegen
_Library: Any = _codegen.JITCodeLibrary


class _Parts(_Library):  # type: ignore[misc]
    """What the compiler makes of a function; a part of others alone is left to these.

    Else each part would be optimised, and turned into machine code that nobody calls, before its callers do
    the same with it: a quarter of the time to compile.
    """

    part = False

    def finalize(self) -> None:
        """Link what the function calls; if it is no part, optimise all and make its machine code."""
        function = _heard.open[-1] if _heard.open else None
        if function is None or not BARE.items() <= function.targetoptions.items():
            super().finalize()
            return
        for library in dict.fromkeys(self._linking_libraries):
            self._reload_init.update(library._reload_init)
            self._final_module.link_in(library._get_module_for_linking(), preserve=True)
        if getattr(function, "settled", False):
            self._optimize_final_module()
        self._finalize_dynamic_globals()
        self._finalized = self.part = True

    def serialize_using_object_code(self) -> Any:
        """What is kept in the cache."""
        if self.part:
            return self.name, "part", self._final_module.as_bitcode()
        return super().serialize_using_object_code()

    @classmethod
    def _unserialize(cls, made: Any, state: Any) -> Any:
        name, kind, data = state
        if kind != "part":
            return super()._unserialize(made, state)
        library = made.create_library(name)
        library._final_module = _codegen.ll.parse_bitcode(data)
        library._finalized = library.part = True
        return library


# Versions of numba whose libraries `_Parts` is made of, which is no public name.
_KNOWN = ("0.68.",)


def _leave_parts(made: Any) -> None:
    """Have a numba that is known make `_Parts`; any other compiles as it does, which takes longer."""
    if not numba.__version__.startswith(_KNOWN):
        return
    set_env, engine = made.set_env, made._engine
    made._library_class = _Parts
    # The environment of what has no machine code stands nowhere.
    made.set_env = lambda name, env: engine.get_global_value_address(name) and set_env(name, env)


if not _config.DISABLE_JIT:
    _leave_parts(cpu_target.target_context.codegen())


def pair(first: Any, second: Any) -> Any:
    """Type of a pair of these."""
    types: Any = numba.types
    return types.Tuple((first, second))


class Handed:
    """A compiled function as an argument of others, which know its types alone; compiled when it is made."""

    def __init__(self, function: Any, types: Any) -> None:
        made = entry_result(function, types.signature.args)
        name = made.fndesc.llvm_cfunc_wrapper_name
        self.address: int = made.library.get_pointer_to_function(name)
        self.types = types.signature

    def __wrapper_address__(self) -> int:
        return self.address

    def signature(self) -> Any:
        """Types of result and arguments, as numba asks for them."""
        return self.types


def handed_type(result: Any, *given: Any) -> Any:
    """Type of functions that are handed over, by their result and arguments."""
    return numba.types.FunctionType(result(*given))


@cache
def handed(function: Any, types: Any) -> Any:
    """A compiled function as an argument of others; where nothing is compiled the function itself."""
    return function if _config.DISABLE_JIT else Handed(function, types)


@cache
def entry(function: Any, *given: Any) -> Any:
    """A compiled function for arguments of these types: it asks for no types as it is called."""
    if _config.DISABLE_JIT:
        return function
    entry_result(function, given)
    return function.get_overload(given)


def entry_result(function: Any, given: Any) -> Any:
    """What the compiler made of a function for arguments of these types."""
    with _choosing, warnings.catch_warnings():
        # Functions as arguments are new in numba, which says so each time.
        warnings.simplefilter("ignore", NumbaExperimentalFeatureWarning)
        compiling.with_room(function.compile, tuple(given))
    return function.overloads[tuple(given)]


def _reached(source: Path) -> set[Path]:
    """A module's file and those of all of this package that it imports, directly or by others."""
    met, left = {source}, [source]
    while left:
        new = _imported(left.pop()) - met
        met |= new
        left += new
    return met


@cache
def _imported(source: Path) -> frozenset[Path]:
    """Files of this package that a module names in its imports, modules and folders."""
    found = set()
    for package, names, module in _IMPORT.findall(source.read_text(encoding="utf-8")):
        whole = package or module
        for name in (whole, *(f"{whole}.{name}" for name in re.findall(r"\w+", names))):
            place = _HERE.parent.parent.joinpath(*name.split("."))
            found |= {path for path in (place.with_suffix(".py"), place / "__init__.py") if path.is_file()}
    return frozenset(found)


def private_folder(name: str) -> Path | None:
    """Folder below the user's own caches that no other user can have put anything into, or None.

    numba unpickles what it finds there.
    """
    caches = platformdirs.user_cache_path("leblanc", appauthor=False)
    folder = caches / name
    try:
        if not caches.is_absolute():  # a user without a home
            return None
        caches.mkdir(parents=True, exist_ok=True, mode=0o700)
        new = not folder.exists()
        folder.mkdir(exist_ok=True, mode=0o700)
        if not all(_is_private(place.lstat()) for place in (caches, folder)) or not _writable(folder):
            return None
        os.utime(folder)
        if new:
            for other in caches.glob("machine-code-*"):
                if other.lstat().st_mtime < time.time() - _UNUSED and not other.is_symlink():
                    shutil.rmtree(other, ignore_errors=True)
    except OSError:
        return None
    return folder


def _writable(folder: Path) -> bool:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return False
    return os.access(folder, os.W_OK | os.X_OK)


def _is_private(found: os.stat_result) -> bool:
    """Whether a folder is this user's, and nobody else may write into it."""
    own = not hasattr(os, "getuid") or found.st_uid == os.getuid()
    return own and stat.S_ISDIR(found.st_mode) and not (os.name == "posix" and found.st_mode & 0o022)
