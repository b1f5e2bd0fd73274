"""Claims of the sources that print no equation: several chambers, and what swings the vertical rig by 35 mm.

`chambers` shares equal liquid between one to four rings, `swing` asks what 35 g do, `figure` draws the rings.
"""

from __future__ import annotations

from validation.cases.case import Case


def cases() -> list[Case]:
    """Every claim with its verdict."""
    from validation.cases.claims import chambers, swing

    return [*chambers.cases(), *swing.cases()]
