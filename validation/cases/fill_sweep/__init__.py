"""Fill sweep of a real top loader: its logs, one assumed machine for all seven fills, and the verdict."""

from __future__ import annotations

from validation.case import Case


def cases() -> list[Case]:
    """Passage, cruise, coast-down, best volumes, and what the columns of the source hold."""
    from validation.cases.fill_sweep import judged

    return judged.cases()
