"""Balancing in two planes [FF20].

`machine` is a long and a short rotor with balls, `damping` its edge of stability over the supports' damping,
`layers` liquid in place of the balls, `conditions` the comparison with the source.
"""

from __future__ import annotations

from validation.cases.case import Case


def cases() -> list[Case]:
    """The source's conditions, statements and demonstrations."""
    from validation.cases.two_plane import conditions

    return conditions.cases()
