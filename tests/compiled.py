"""A home for machine code that numba compiles, new for each state of the sources. Loads no library."""

from __future__ import annotations

import hashlib
import os
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
    os.environ.setdefault("NUMBA_CACHE_DIR", str(Path(tempfile.gettempdir()) / f"leblanc-numba-{digest}"))
