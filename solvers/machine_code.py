"""Compiled functions of numba, imported here alone, their machine code kept where nobody else can write.

numba keys its cache by the file of a function, not by what that calls, and raises where neither the package
nor HOME can be written. Here each state of the sources has a folder of its own below the user's caches;
without one each process compiles for itself.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import stat
import threading
import time
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numba
import platformdirs

# Options of what only compiled code calls: it needs no wrappers.
BARE: dict[str, Any] = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
_UNUSED = 30.0 * 86400.0  # s, after which the folder of other sources is removed
_choosing = threading.Lock()
_config: Any = numba.config


def machine_code(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Decorator that compiles a function by `numba.njit` with some options.

    What becomes part of its callers (`inline`) has no machine code of its own.
    """
    compile_it: Any = numba.njit(**options)

    def compiled(function: Callable[..., Any]) -> Any:
        made = compile_it(function)
        folder = None if "inline" in options or _config.DISABLE_JIT else cache_folder()
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
def cache_folder() -> Path | None:
    """Where machine code is kept: NUMBA_CACHE_DIR, or below the user's caches; None where neither can be."""
    if _config.CACHE_DIR:
        folder = Path(_config.CACHE_DIR)
        return folder if _writable(folder) else None
    root = Path(__file__).parent.parent
    sources = sorted(path for name in ("fluid", "solvers") for path in (root / name).rglob("*.py"))
    digest = hashlib.sha256(b"".join(path.read_bytes() for path in sources)).hexdigest()[:16]
    return private_folder(f"machine-code-{digest}")


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
            _remove_unused(caches)
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


def _remove_unused(caches: Path) -> None:
    """Remove machine code of sources that are no longer in use."""
    for folder in caches.glob("machine-code-*"):
        if folder.lstat().st_mtime < time.time() - _UNUSED and not folder.is_symlink():
            shutil.rmtree(folder, ignore_errors=True)
