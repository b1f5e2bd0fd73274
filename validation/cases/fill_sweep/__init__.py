"""The fill sweep of a real top loader: its logs, one assumed machine for all seven fills, and the verdict.

`machine` is the machine, `fitted` finds its values from two of the fills and keeps what was found, `contact`
adds a clearance to it, `judged` holds the other five against them.
"""

from __future__ import annotations

from validation.cases.case import Case


def cases() -> list[Case]:
    """Passage, cruise, coast-down, best volumes, and what the columns of the source hold."""
    from validation.cases.fill_sweep import judged

    return judged.cases()
