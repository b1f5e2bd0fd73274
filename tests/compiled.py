"""A home for machine code that numba compiles, new for each state of the sources. Loads no library."""

from __future__ import annotations

import hashlib
import os
import stat
import tempfile
from pathlib import Path


def use_own_cache() -> None:
    """Choose the folder, unless the environment has chosen one.

    numba keys its cache by the file of the compiled function alone, not by what that calls: a cache of its
    own for each state of the sources keeps stale machine code out of the tests.
    """
    root = Path(__file__).parent.parent
    sources = sorted(p for name in ("fluid", "solvers") for p in (root / name).rglob("*.py"))
    digest = hashlib.sha256(b"".join(p.read_bytes() for p in sources)).hexdigest()[:16]
    os.environ.setdefault("NUMBA_CACHE_DIR", str(private_folder(f"numba-{digest}")))


def private_folder(name: str) -> Path:
    """A folder that no other user can have put anything into, for numba unpickles what it finds there.

    Below the user's own caches it is found again the next time; where there are none that are private it is
    a new one.
    """
    caches = os.environ.get("XDG_CACHE_HOME") or Path("~/.cache").expanduser()
    folder = Path(caches) / "leblanc-tests" / name
    try:
        folder.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        folder.mkdir(exist_ok=True, mode=0o700)
        ours = all(_is_private(place.lstat()) for place in (folder.parent, folder))
    except OSError:
        ours = False
    return folder if ours else Path(tempfile.mkdtemp(prefix="leblanc-numba-"))


def _is_private(found: os.stat_result) -> bool:
    """A folder of this user's, into which nobody else may write."""
    own = not hasattr(os, "getuid") or found.st_uid == os.getuid()
    return own and stat.S_ISDIR(found.st_mode) and not found.st_mode & (stat.S_IWGRP | stat.S_IWOTH)
