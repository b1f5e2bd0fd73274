"""Published cases beside what the package computes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from leblanc.core.question import called


def validate(group: str | None = None) -> Sequence[Any]:
    """Published cases beside what the package computes: printed, computed, difference and verdict of each.

    Parameters
    ----------
    group : of cases, as `leblanc validate --help` lists them; all if None

    Raises
    ------
    InputError : no such group

    Examples
    --------
    >>> import leblanc as lb
    >>> {case.verdict for case in lb.validate("turning")} <= {"agrees", "erratum", "trend", "differs"}
    True
    """
    found: Sequence[Any] = called("validation.command:all_cases")(group)
    return found
