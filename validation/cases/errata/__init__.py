"""Errata of the sources: what is printed beside what is derived, each computed [theory: errata].

`tub` has the equations of the suspended tub, `formulas` those of liquids and balancers, `machines` what the
sources say of rotors, bearings and pumps, `statements` what they say against their own equations.
"""

from __future__ import annotations

from validation.cases.case import Case


def cases() -> list[Case]:
    """Every erratum found, each with its printed and its derived value."""
    from validation.cases.errata import formulas, machines, statements, tub

    return [*tub.cases(), *formulas.cases(), *machines.cases(), *statements.cases()]
