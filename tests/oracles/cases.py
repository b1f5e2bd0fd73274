"""The cases of `leblanc validate`, as the net keeps them: nothing is computed again."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from tests.net.answers import read

_KEPT = Path(__file__).parents[1] / "net" / "kept"


def kept_cases(group: str = "*") -> list[dict[str, Any]]:
    """Records of a group or of all, each as the last of its runs that was kept has it."""
    found: list[dict[str, Any]] = []
    for path in sorted(_KEPT.glob(f"validate-{group}.json.xz")):
        answer = read(path)["stdout"]
        assert isinstance(answer, dict), path
        found += answer["cases"]
    return found
