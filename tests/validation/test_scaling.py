"""The queues of a sweep: limits of what workers and first process can do."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.mutants import kills
from validation.benchmarks.scaling import passed

HERE = "validation.benchmarks.scaling:passed"


@kills(HERE, "clock += taken * aside", "clock += aside")
@given(
    st.lists(st.floats(0.01, 3.0), min_size=1, max_size=60),
    st.floats(0.0, 1.0),
    st.integers(1, 70),
)
def test_no_sweep_is_faster_than_its_workers_or_its_first_process(
    durations: list[float], aside: float, workers: int
) -> None:
    """Nor slower than one that hands out the next block only when all before it are written."""
    found = passed(durations, aside, workers)
    least = max(sum(durations) / workers, len(durations) * aside, max(durations) + aside)
    assert least * (1.0 - 1e-12) <= found <= sum(durations) + len(durations) * aside + 1e-9


@pytest.mark.parametrize("workers", [1, 3, 16])
def test_workers_are_never_idle_while_the_first_process_is_quick(workers: int) -> None:
    """Equal blocks, nothing to do aside: as many rounds as it takes."""
    assert passed([2.0] * 48, 0.0, workers) == pytest.approx(2.0 * math.ceil(48 / workers), rel=1e-12)


@kills(HERE, "max(clock, heapq.heappop(free))", "heapq.heappop(free)")
@kills(HERE, "ahead * workers", "2 * workers")
def test_workers_wait_where_nothing_is_handed_out_ahead() -> None:
    """One block for each worker: it works while the first process writes nothing, and the other way round."""
    assert passed([1.0] * 5, 0.5, 1, ahead=1) == pytest.approx(5 * 1.5, rel=1e-12)
    assert passed([1.0] * 4, 0.25, 2, ahead=1) == pytest.approx(2 * 1.5, rel=1e-12)


def test_the_first_process_bounds_any_number_of_workers() -> None:
    """Blocks in which there is nothing to do."""
    for workers in (1, 10, 100):
        assert passed([1e-9] * 50, 0.2, workers) == pytest.approx(50 * 0.2, rel=1e-6)
    many = [passed([1.0] * 400, 0.05, workers) for workers in (1, 2, 4, 8, 16, 32, 64)]
    assert many == sorted(many, reverse=True)
    assert many[-1] == pytest.approx(400 * 0.05, rel=0.06)  # and the first block's own second
