"""Speeds of an exciter by expansion."""

from __future__ import annotations

import math

from meshes.errors import InputError
from solvers.rotor.exciter.machine import CharacteristicSpeeds, Dimensionless, lag_number


def approximate_speeds(machine: Dimensionless, together: float = 1.0) -> CharacteristicSpeeds:
    """The same for light damping and small chi, by expansion [theory: balls, eq. 15] [YF17, eq. 13].

    Parameters
    ----------
    machine, together : see `lag_number`; some platform damping
    """
    chi, h = lag_number(machine, together), machine.damping
    if h <= 0.0 or chi <= 0.0:
        raise InputError("damping", h, "above 0, with A above 0")
    root = math.cbrt(0.5 * chi)
    resonance = 0.25 * chi / h**2
    return CharacteristicSpeeds(
        second_pair=1.0 + 1.5 * root + 2.0 * root**2 + 53.0 / 24.0 * root**3,
        through_resonance=1.0 + resonance,
        merger=1.0 + resonance + 9.0 / 16.0 * chi + 1.5 * (1.0 + 27.0 / 32.0 * chi) * h**2,
    )
