"""Balancing in two planes [FF20]."""

from __future__ import annotations

from validation.case import Case


def cases() -> list[Case]:
    """The source's conditions, statements and demonstrations."""
    from validation.cases.two_plane import conditions

    return conditions.cases()
