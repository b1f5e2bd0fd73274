"""Claims of the sources that print no equation: several chambers, a swing of 35 mm, rules for a layout."""

from __future__ import annotations

from validation.case import Case


def cases() -> list[Case]:
    """Every claim with its verdict."""
    from validation.cases.claims import chambers, layout, swing

    return [*chambers.cases(), *swing.cases(), *layout.cases()]
