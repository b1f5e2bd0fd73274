"""Errata of the sources: what is printed beside what is derived, each computed [theory: errata]."""

from __future__ import annotations

from validation.case import Case


def cases() -> list[Case]:
    """Every erratum found, each with its printed and its derived value."""
    from validation.cases.errata import formulas, machines, statements, tub

    return [*tub.cases(), *formulas.cases(), *machines.cases(), *statements.cases()]
