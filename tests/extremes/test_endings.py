"""Commands that are killed, interrupted or run out of room leave nothing half written."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.extremes.endings import COMMANDS, SIGNALS, by_signal, on_a_full_disk, small_disk

TRIALS = 2  # `python -m tests.extremes.endings --trials N` makes as many as wanted


@pytest.mark.slow
@pytest.mark.parametrize("name", SIGNALS)
@pytest.mark.parametrize("command", COMMANDS)
def test_ended_by_a_signal(command: str, name: str) -> None:
    counts, found = by_signal(command, name, TRIALS, seed=5)
    assert not found
    assert counts.total() == TRIALS


@pytest.mark.slow
@pytest.mark.parametrize("command", [name for name in COMMANDS if "workers" not in name])
def test_on_a_full_disk(command: str) -> None:
    counts, found = on_a_full_disk(command, TRIALS, seed=5)
    assert not found
    assert counts.total() == TRIALS


@pytest.mark.slow
@pytest.mark.parametrize("command", COMMANDS)
def test_on_a_small_disk(command: str, tmp_path: Path) -> None:
    try:
        with small_disk(tmp_path, 4096):
            pass
    except OSError as error:
        pytest.skip(f"no disk can be mounted: {error}")
    counts, found = on_a_full_disk(command, TRIALS, seed=5, mounted=True)
    assert not found
    assert counts.total() == TRIALS
