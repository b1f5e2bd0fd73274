"""Dual-frequency exciter against its source [YF17]."""

from __future__ import annotations

from validation.case import Case


def cases() -> list[Case]:
    """Stuck, characteristic and critical speeds, the worked table, traces, trends, and what lies beyond."""
    from validation.cases.exciter import beyond, speeds, traces

    return [*speeds.cases(), *traces.cases(), *beyond.cases()]
