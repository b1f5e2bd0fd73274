"""Session settings: floating-point faults raise, hypothesis is pinned."""

import hashlib
import os
import tempfile
from pathlib import Path

# Small matrices get many times slower when the BLAS spreads them over threads.
for _variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_variable, "1")
os.environ.setdefault("MPLBACKEND", "Agg")

# numba keys its cache by the file of the compiled function alone, not by what that calls: a cache of its own
# for each state of the sources keeps stale machine code out of the tests.
_root = Path(__file__).parent.parent
_sources = sorted(p for name in ("fluid", "solvers") for p in (_root / name).rglob("*.py"))
_digest = hashlib.sha256(b"".join(p.read_bytes() for p in _sources)).hexdigest()[:16]
os.environ.setdefault("NUMBA_CACHE_DIR", str(Path(tempfile.gettempdir()) / f"leblanc-numba-{_digest}"))

import numpy as np  # noqa: E402
from hypothesis import HealthCheck, settings  # noqa: E402

np.seterr(divide="raise", over="raise", invalid="raise")

settings.register_profile(
    "pinned", derandomize=True, deadline=None, database=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("pinned")
