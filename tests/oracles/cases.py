"""The cases of `leblanc validate`, as the net keeps them: nothing is computed again."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from tests.net.answers import read

_KEPT = Path(__file__).parents[1] / "net" / "kept"


def kept_cases() -> list[dict[str, Any]]:
    """Records of all groups, each as the last of its runs that was kept has it."""
    found: list[dict[str, Any]] = []
    for path in sorted(_KEPT.glob("validate-*.json.xz")):
        answer = read(path)["stdout"]
        assert isinstance(answer, dict), path
        found += answer["cases"]
    return found
