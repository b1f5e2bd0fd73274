"""Session settings: floating-point faults raise, hypothesis is pinned."""

import os

from tests.compiled import use_own_cache

# Small matrices get many times slower when the BLAS spreads them over threads.
for _variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_variable, "1")
os.environ.setdefault("MPLBACKEND", "Agg")

use_own_cache()

import numpy as np  # noqa: E402
from hypothesis import HealthCheck, settings  # noqa: E402

np.seterr(divide="raise", over="raise", invalid="raise")

settings.register_profile(
    "pinned", derandomize=True, deadline=None, database=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("pinned")
