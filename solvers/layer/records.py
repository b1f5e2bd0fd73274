"""Named records that Python and compiled code share: what drives a layer, its loads, how its way ended.

Numbers that change one by one stand in arrays of numpy's structured types, of length 1 where there is one of
a kind; what stays is a tuple with names. Lengths over R, times in the unit of the spin.
"""

from __future__ import annotations

from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np

from fluid.friction.wall import NO_TABLE
from meshes.arrays import Array

# A `numpy.recarray`; its stubs forget the fields of what is picked from it.
Record = Any


def floats(*names: str) -> np.dtype[Any]:
    """Structured type of floats with these names."""
    return np.dtype([(name, np.float64) for name in names], align=True)


def records(kind: np.dtype[Any], count: int = 1) -> Record:
    """So many records of zeros."""
    return np.zeros(count, kind).view(np.recarray)


class Drive(NamedTuple):
    """A prescribed whirl as the steps take it [theory: long_wave, eq. 8]."""

    amplitude: float  #: of the axis
    slip: float  #: whirl speed seen from the drum
    ramp: float  #: time over which the amplitude grows
    whirl: float  #: whirl speed in space
    weight: float  #: gravity across the axis
    spin: float  #: Omega


class Wall(NamedTuple):
    """What the wall does to a layer."""

    #: law and coefficient: of the friction, as by `fluid.friction.laws.Friction.at`; rates in the unit of the
    #: spin
    law: int
    coefficient: float
    lid: float  #: 2 R/h_c, floor and lid under Stokes' friction and the law of the wall
    dispersion: bool  #: whether its waves disperse
    #: plates, thin, top and table: of the law of the wall, see `fluid.friction.wall.WallDrag`
    plates: float = 0.0
    thin: float = 0.0
    top: float = 0.0
    table: Array = NO_TABLE


# Integrals over time: force by the pressure on the wall over rho h_c R^3, offset, turning, least and largest
# depth, body force; x is along the deflection, y 90 deg ahead of it [theory: long_wave, eq. 7].
LOADS = floats(
    *("force_x", "force_y", "offset_x", "offset_y", "turning", "depth_min", "depth_max", "push_x", "push_y")
)

# How far a layer has come, and its fastest wave; 0 where that is not known yet.
PACE = floats("time", "fastest")


class Outcome(IntEnum):
    """How a stretch of time steps ended, of a layer or of a rotor with layers; shared with compiled code."""

    DONE = 0
    TOO_LONG = 1
    AT_AXIS = 2
    RAN_OUT = 3
    NOT_COUPLED = 4
    STOPPED = 5
    INTERRUPTED = 6
    RAN_AWAY = 7
    BROKE = 8
    DRIED = 9
    WANTS_NODES = 10
    FAMILY_LOST = 11

    @property
    def message(self) -> str:
        """Why it went no further; empty where it came to its end."""
        return _MESSAGES[self]


_MESSAGES = {
    Outcome.DONE: "",
    Outcome.TOO_LONG: "a layer outran the shortest step",
    Outcome.AT_AXIS: "the liquid piled up towards the axis, where it is no layer",
    Outcome.RAN_OUT: "the time steps ran out: thin films move too fast for longer ones",
    Outcome.NOT_COUPLED: "rotor and layers did not agree in the shortest steps",
    Outcome.STOPPED: "the motor stands",
    Outcome.INTERRUPTED: "interrupted",
    Outcome.RAN_AWAY: "a film beside a dry wall ran away, and the time steps shrank to nothing",
    Outcome.BROKE: "a wave broke: the fully nonlinear wave owes no force",
    Outcome.WANTS_NODES: "a wave wants more than 512 nodes, and its crest does not break",
    Outcome.DRIED: "a wave left a part of its wall dry, which the fully nonlinear wave cannot",
    Outcome.FAMILY_LOST: "waves of KdV-Burgers ran away, or the liquid came to stand still",
}
