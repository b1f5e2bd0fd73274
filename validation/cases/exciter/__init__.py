"""The dual-frequency exciter against its source [YF17].

`speeds` holds its numbers and critical speed, `traces` the figures over time and parameters, `beyond` what
lies beyond the critical speed.
"""

from __future__ import annotations

from validation.cases.case import Case


def cases() -> list[Case]:
    """Stuck, characteristic and critical speeds, the worked table, traces, trends, and what lies beyond."""
    from validation.cases.exciter import beyond, speeds, traces

    return [*speeds.cases(), *traces.cases(), *beyond.cases()]
