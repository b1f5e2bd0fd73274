"""Balls in races as results keep them: what they are, and the unbalance that they make."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from meshes.arrays import Array, Complex


@dataclass(frozen=True)
class RaceOfBalls:
    """A race with its balls, all alike.

    Parameters
    ----------
    count : of its balls
    moment : mass of one ball, less that of the liquid it displaces, times the radius of its path, kg m
    plane : position along the axis, m
    radius : of the path of the balls' centres, m
    diameter : of the balls, m; None where the scene does not say it
    """

    count: int
    moment: float
    plane: float
    radius: float
    diameter: float | None = None


def ball_moment(races: Sequence[RaceOfBalls], angle: Array) -> Complex:
    """Unbalance of all balls together, kg m, shape (...,).

    Parameters
    ----------
    races : N balls in all
    angle : of each in the drum, race by race, rad, shape (..., N)
    """
    each = np.repeat([race.moment for race in races], [race.count for race in races])
    return np.asarray(np.exp(1j * angle) @ each)


def in_race(races: Sequence[RaceOfBalls]) -> Array:
    """Number of the race of each ball, from 0, shape (N,)."""
    return np.repeat(np.arange(len(races)), [race.count for race in races])
