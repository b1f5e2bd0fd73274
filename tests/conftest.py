"""Session settings: floating-point faults raise, hypothesis is pinned; oracles meet their mutants."""

import os
from collections.abc import Iterator

# Small matrices get many times slower when the BLAS spreads them over threads.
for _variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_variable, "1")
os.environ.setdefault("MPLBACKEND", "Agg")

import numpy as np  # noqa: E402
import pytest  # noqa: E402
from hypothesis import HealthCheck, settings  # noqa: E402

from tests.mutants import CAUGHT, seeded  # noqa: E402

np.seterr(divide="raise", over="raise", invalid="raise")

settings.register_profile(
    "pinned", derandomize=True, deadline=None, database=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("pinned")


def pytest_configure(config: pytest.Config) -> None:
    """The marks of tests/mutants.py."""
    config.addinivalue_line("markers", "kills(mutant): the test fails with this mutant in place")
    config.addinivalue_line("markers", "mutant: a run of an oracle with a mutant, which must fail")


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """An oracle runs as it stands and once for each of its mutants."""
    mutants = [mark.args[0] for mark in metafunc.definition.iter_markers("kills")]
    if mutants:
        metafunc.fixturenames.append("mutant")
        runs = [pytest.param(m, id=str(m), marks=pytest.mark.mutant) for m in mutants]
        metafunc.parametrize("mutant", [pytest.param(None, id=pytest.HIDDEN_PARAM), *runs])


@pytest.hookimpl(wrapper=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> Iterator[None]:
    """With its mutant in place the oracle must fail."""
    params = pyfuncitem.callspec.params if hasattr(pyfuncitem, "callspec") else {}
    mutant = params.get("mutant")
    if mutant is None:
        return (yield)
    with seeded(mutant), pytest.raises(CAUGHT):
        yield
    return True
