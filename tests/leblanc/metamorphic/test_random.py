"""Random machines over six decades of every field: a few in each run of the tests, a thousand by `make`."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import pytest

from tests.leblanc.metamorphic.random_scenes import COMMANDS, Violation, changes, expected, search, violations
from tests.oracles.alike import differences
from tests.oracles.machines import Table
from tests.oracles.random_machines import KINDS, machine

# The machines of a slow run, and in how many processes.
COUNT, JOBS = int(os.environ.get("METAMORPHIC_COUNT", "1000")), int(os.environ.get("METAMORPHIC_JOBS", "1"))


def test_every_field_takes_six_decades() -> None:
    """Of a thousand draws: the middle 99 % of a field that is even in its logarithm spans 5.94 of six."""
    drawn = [machine(seed, "jeffcott") for seed in range(1000)]
    for key in ("mass", "stiffness", "damping", "unbalance"):
        values = np.log10([table["rotor"][key] for table in drawn])
        assert np.ptp(np.quantile(values, [0.005, 0.995])) > 5.8, key
    for key in ("radius", "height", "volume"):
        values = np.log10([chamber[key] for table in drawn for chamber in table["chambers"]])
        assert np.ptp(np.quantile(values, [0.005, 0.995])) > 5.8, key
    assert {machine(seed)["rotor"]["kind"] for seed in range(30)} == set(KINDS)
    assert machine(7) == machine(7)


@pytest.mark.parametrize("seed", [1, 4, 55, pytest.param(70, marks=pytest.mark.slow), 92])
def test_a_few_random_machines(seed: int) -> None:
    """55 and 70 have thin films on stiff supports, where the terms of the balance cancel to ten digits.

    92 whirls a ten-millionth as fast as it spins, and in no direction.
    """
    assert violations(seed, "run") == []


def test_a_wrong_answer_is_a_violation(monkeypatch: pytest.MonkeyPatch) -> None:
    """What forgets the scale of one key, turns the wrong way or fails now and then is found."""
    honest = COMMANDS["run"]
    calls = []

    def forgetful(table: Table) -> dict[str, Any]:
        calls.append(table)
        answer = honest(table)
        return answer | ({"liquid_mass": 1.01 * answer["liquid_mass"]} if len(calls) == 3 else {})

    monkeypatch.setitem(COMMANDS, "run", forgetful)
    # The third call is the second change: the similar machine.
    assert [(one.change, one.key) for one in violations(4, "run")] == [("scaled", "liquid_mass")]

    def failing(table: Table) -> dict[str, Any]:
        raise ZeroDivisionError

    monkeypatch.setitem(COMMANDS, "run", failing)
    (fault,) = violations(4, "run")
    assert (fault.key, fault.change) == ("error", "none") and "ZeroDivisionError" in fault.text


def test_turned_answers_are_told_from_unturned() -> None:
    table = next(machine(seed) for seed in range(9, 99) if machine(seed)["rotor"]["kind"] == "two_plane")
    answer = COMMANDS["run"](table)
    off = differences(answer, expected(answer, "turned"))
    assert off["deflection"] > 0.1 and off["phase"] > 0.1 and off["amplitude"] == 0.0
    assert {name for name, _, _ in changes(table, 0)} >= {"units", "scaled", "permuted", "turned", "mirrored"}


@pytest.mark.slow
def test_a_thousand_random_machines() -> None:
    found: list[Violation] = [one for some in search(0, COUNT, ["run"], JOBS) for one in some]
    assert not found, "\n".join(map(str, found))
