"""The cases of `leblanc validate`, as the net keeps them: nothing is computed again."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest

from tests.net.answers import read
from validation.case import Case

_KEPT = Path(__file__).parents[1] / "net" / "kept"


def kept_cases() -> list[dict[str, Any]]:
    """Records of all groups, each as the last of its runs that was kept has it."""
    found: list[dict[str, Any]] = []
    for path in sorted(_KEPT.glob("validate-*.json.xz")):
        answer = read(path)["stdout"]
        assert isinstance(answer, dict), path
        found += answer["cases"]
    return found


def kept_group(group: str) -> dict[str, dict[str, Any]]:
    """Records of one group by what follows its name; `python -m tests.net check` computes them anew."""
    named = [(*case["name"].split("/", 1), case) for case in kept_cases()]
    found = {name: case for of, name, case in named if of == group}
    assert found
    return found


def verdicts(found: dict[str, dict[str, Any]], *wanted: str) -> set[str]:
    """Names of the cases that have one of these verdicts."""
    return {name for name, case in found.items() if case["verdict"] in wanted}


def come_out_again(cases: Iterable[Case]) -> None:
    """Cases that are computed now have the kept verdicts and, as closely as the net asks, numbers."""
    kept, found = {case["name"]: case for case in kept_cases()}, list(cases)
    assert found
    for case in found:
        before = kept[case.name]
        assert case.verdict == before["verdict"], case.name
        if isinstance(case.computed, float):
            assert case.computed == pytest.approx(before["computed"], rel=1e-6, abs=1e-9), case.name
