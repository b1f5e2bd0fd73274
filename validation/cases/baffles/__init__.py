"""Layers with baffles against computed two-phase flow: ten runs of a ring in the plane [theory: baffles]."""

from __future__ import annotations

from validation.case import Case


def cases() -> list[Case]:
    """Decays, driven losses, and the spin-up that leaves the liquid behind."""
    from validation.cases.baffles import flow

    return flow.cases()
