"""Balls in races as results keep them: what they are, and the unbalance that they make."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from leblanc.core.netcdf import Variable, finite, variable
from meshes.arrays import Array, Complex


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

    share: Array  #: gravity over the centrifugal acceleration of the balls that have least of it, shape (s,)
    ball_swing: Array  #: amplitude of each ball's angle about its place, once a turn, rad, shape (s, N)
    amplitude: Array  #: by which the axis is shaken with twice the spin, m, shape (s,)
    power: Array  #: that the drag of the races takes so, W, shape (s,)

    def to_json(self) -> dict[str, Any]:
        """Plain values over the speeds, SI."""
        return {name: finite(getattr(self, name)) for name in ("share", "ball_swing", "amplitude", "power")}

    def variables(self) -> dict[str, Variable]:
        """Arrays over `speed` and `ball`."""
        over = ("speed",)
        text = "of gravity across the axis, about the place at rest"
        return {
            "gravity_share": variable(over, self.share, "1", "gravity over centrifugal acceleration"),
            "swing_power": variable(over, self.power, "W", "power that the swing of the balls takes"),
            "ball_swing": variable(("speed", "ball"), self.ball_swing, "rad", "swing of the ball", text),
            "swing_amplitude": variable(
                over, self.amplitude, "m", "shake by the balls' swing", "twice a turn"
            ),
        }


def ball_moment(races: Sequence[RaceOfBalls], angle: Array) -> Complex:
    """Unbalance of all balls together, kg m, shape (...,)."""
    each = np.repeat([race.moment for race in races], [race.count for race in races])
    return np.asarray(np.exp(1j * angle) @ each)


def in_race(races: Sequence[RaceOfBalls]) -> Array:
    """Number of the race of each ball, from 0, shape (N,)."""
    return np.repeat(np.arange(len(races)), [race.count for race in races])
