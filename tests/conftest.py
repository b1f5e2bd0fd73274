"""Session settings: floating-point faults raise, hypothesis is pinned; oracles meet their mutants."""

import gc
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

# Even where the environment says not to keep bytecode: without it each worker collects for 20 s instead of 8,
# and each process that a test starts compiles what it imports anew.
sys.dont_write_bytecode = False
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

# Small matrices get many times slower when the BLAS spreads them over threads.
for _variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_variable, "1")
os.environ.setdefault("MPLBACKEND", "Agg")

import numpy as np  # noqa: E402
import pytest  # noqa: E402
from hypothesis import HealthCheck, Phase, settings  # noqa: E402
from pytest_rerunfailures import StatusDB  # noqa: E402

from tests.mutants import CAUGHT, Mutant, seeded  # noqa: E402
from tests.oracles.browser import tab as tab  # noqa: E402

np.seterr(divide="raise", over="raise", invalid="raise")

settings.register_profile(
    "pinned", derandomize=True, deadline=None, database=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("pinned")


@pytest.hookimpl(trylast=True)
def pytest_configure(config: pytest.Config) -> None:
    """The marks of tests/mutants.py; workers count tries of a test by themselves.

    The plugin that tries hanging tests once more has every worker ask the first process before each test,
    through a socket: up to 45 ms, longer than most tests take. The answer matters only where a worker died,
    and there the first process asks itself.
    """
    if hasattr(config, "failures_db") and config.option.reruns:
        if hasattr(config, "workerinput"):
            config.failures_db.sock.close()
            config.failures_db = StatusDB()
        else:
            config.failures_db.get_test_reruns = lambda test: config.option.reruns
    config.addinivalue_line("markers", "kills(mutant): the test fails with this mutant in place")
    config.addinivalue_line("markers", "mutant: a run of an oracle with a mutant, which must fail")


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Of an oracle with several cases the first one meets the mutants."""
    met = set()
    kept = []
    for item in items:
        mutant = _mutant(item)
        key = item.nodeid.partition("[")[0], mutant
        if mutant is None or key not in met:
            kept.append(item)
        met.add(key)
    items[:] = kept


def _mutant(item: Any) -> Mutant | None:
    return item.callspec.params.get("mutant") if hasattr(item, "callspec") else None


def pytest_collection_finish() -> None:
    """What was imported and collected stays: the garbage collector need not look through it again."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(10_000)


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
    mutant = _mutant(pyfuncitem)
    if mutant is None:
        return (yield)
    with seeded(mutant), _noticed_once(pyfuncitem.function), pytest.raises(CAUGHT):
        yield
    return True


@contextmanager
def _noticed_once(test: Any) -> Iterator[None]:
    """Hypothesis seeks no smaller example of a failure that is wanted."""
    drawn = getattr(test, "_hypothesis_internal_use_settings", None)
    if drawn is None:
        yield
        return
    phases = (Phase.explicit, Phase.generate)
    test._hypothesis_internal_use_settings = settings(drawn, phases=phases, report_multiple_bugs=False)
    try:
        yield
    finally:
        test._hypothesis_internal_use_settings = drawn
