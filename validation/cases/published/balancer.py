"""Where a balancer's liquid lies over two critical speeds, and in rigid supports [Nak11, Machines24].

That it lies along the deflection at any speed, and how much of that one family of waves has: `liquid.kdv`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from fluid.fill import Fill
from meshes.arrays import Array
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from solvers.rotor.vibration import whirl_direction
from solvers.synchronous.response import Response, response, wet_critical_speeds
from validation.case import Case, Claims
from validation.cases.published import tilt
from validation.cases.published.partitions import NATURAL, chamber_with, rotor

CLAIMS = Claims("published")

_SHARE = 0.25  # of the chamber
_UNBALANCE, _TILTING = 1e-3, 1e-4  # kg m
_STIFFER = 1e6  # supports that count as rigid
# Of the rotor that tilts: damping over stiffness, s, place of an unbalance out of the chamber's plane, m.
_DAMPING, _ASIDE = 1e-4, -0.15


def over_speed(stiffer: float) -> Response:
    """A rotor with its layer on stiffer supports, from 0.3 to 3 natural frequencies on soft ones."""
    soft = rotor(0.02)
    machine = Jeffcott(soft.mass, stiffer * soft.stiffness, soft.damping, _UNBALANCE)
    return response(machine, [chamber_with(0, _SHARE)], np.linspace(0.3, 3.0, 28) * NATURAL, gravity=0.0)


def two_criticals(place: float) -> tuple[Array, Fill, TwoPlane]:
    """Critical speeds of the forward whirls of a rotor that tilts, its unbalance at a place of the axis."""
    fill = tilt.filled(_SHARE)
    supports = tuple(Support(at, stiffness, _DAMPING * stiffness) for at, stiffness in tilt.SUPPORTS)
    machine = replace(tilt.rotor(0.2), supports=supports, unbalances=(PlaneUnbalance(place, _TILTING),))
    speeds, shapes = wet_critical_speeds(machine, [fill], gravity=0.0)
    return speeds[whirl_direction(machine.system(), shapes) > 0.0], fill, machine


def angles(place: float) -> Array:
    """Angle of the liquid from the unbalance below, between and beyond the critical speeds, deg, 0 to 180."""
    (first, second), fill, machine = two_criticals(place)
    speeds = np.array([0.5 * first, math.sqrt(first * second), 1.2 * second])
    found = response(machine, [fill], speeds, gravity=0.0)
    return np.asarray(np.degrees(np.abs(np.angle(np.exp(1j * found.liquid_angle)))))


def cases() -> Iterator[Case]:
    """Liquid over two critical speeds, and in rigid supports."""
    inside, aside = angles(tilt.filled(_SHARE).chamber.plane), angles(_ASIDE)
    same = bool(np.all(inside[:1] < 10.0) and inside[1] > 170.0 and aside[0] < 10.0 and aside[1] > 170.0)
    yield CLAIMS.case("two-criticals", agrees=same, inside=_degrees(inside), aside=_degrees(aside))
    rigid = over_speed(_STIFFER)
    liquid = chamber_with(0, _SHARE).mass * float(rigid.liquid_offset.max()) / _UNBALANCE
    yield CLAIMS.case("rigid", agrees=liquid < 1e-5, liquid=liquid)


def _degrees(values: Array) -> str:
    return ", ".join(f"{value:.0f}" for value in values) + " deg"
