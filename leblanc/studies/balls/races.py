"""Balls in races as results keep them: what they are, and the unbalance that they make."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from meshes.arrays import Array, Complex, Flags
from meshes.quantity import Q

_OVER = ("speed",)


@dataclass(frozen=True)
class RaceOfBalls:
    """A race with its balls, all alike."""

    count: int  #: of its balls
    #: mass of one ball, less that of the liquid it displaces, times the radius of its path, kg m
    moment: float
    plane: float  #: position along the axis, m
    radius: float  #: of the path of the balls' centres, m
    diameter: float | None = None  #: of the balls, m; None where the scene does not say it


@dataclass(frozen=True)
class GravityOnBalls:
    """What gravity across the axis does to N balls at rest in a drum, at s speeds [theory: races, eq. 11]."""

    share: Annotated[
        Array,
        Q(
            "1",
            "gravity over centrifugal acceleration",
            "of the balls that have least of it",
            _OVER,
            variable="gravity_share",
        ),
    ]
    ball_swing: Annotated[
        Array,
        Q(
            "rad",
            "swing of the ball",
            "of gravity across the axis, about the place at rest, once a turn",
            ("speed", "ball"),
            variable="ball_swing",
        ),
    ]
    amplitude: Annotated[
        Array,
        Q("m", "shake by the balls' swing", "zero to peak, twice a turn", _OVER, variable="swing_amplitude"),
    ]
    power: Annotated[
        Array, Q("W", "power that the swing of the balls takes", over=_OVER, variable="swing_power")
    ]


@dataclass(frozen=True)
class StuckBalls:
    """What balls that resist to rolling leave, let go from places all round; s speeds, N balls."""

    hold: Annotated[
        Array,
        Q(
            "m",
            "deflection along its race up to which the ball stays",
            "resistance to rolling less gravity across the axis, 0 where gravity moves the ball each turn",
            ("speed", "ball"),
        ),
    ]  # [theory: races, eq. 9]
    low: Annotated[Array, Q("m", "amplitude that balls leave, 5 % of their starts below it", "", _OVER)]
    median: Annotated[Array, Q("m", "amplitude that balls leave, median of their starts", "", _OVER)]
    high: Annotated[Array, Q("m", "amplitude that balls leave, 95 % of their starts below it", "", _OVER)]

    @property
    def sticks(self) -> Flags:
        """Some ball can stay where it is, shape (s,)."""
        return np.asarray((self.hold > 0.0).any(axis=1))


def ball_moment(races: Sequence[RaceOfBalls], angle: Array) -> Complex:
    """Unbalance of all balls together, kg m, shape (...,)."""
    each = np.repeat([race.moment for race in races], [race.count for race in races])
    return np.asarray(np.exp(1j * angle) @ each)


def in_race(races: Sequence[RaceOfBalls]) -> Array:
    """Number of the race of each ball, from 0, shape (N,)."""
    return np.repeat(np.arange(len(races)), [race.count for race in races])
