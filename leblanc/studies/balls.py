"""The balls of a scene: where a run-up finds them, and what results keep of them."""

from __future__ import annotations

import math

from leblanc.results.motion.balls import RaceOfBalls
from leblanc.scene.races import BallRace
from leblanc.scene.scene import Scene
from solvers.runup.balls import Balls

APART = 0.1  # rad between balls at the bottom of a race whose diameter the scene does not say


def races_shown(scene: Scene) -> tuple[RaceOfBalls, ...]:
    """The races of a scene as results keep them.

    Parameters
    ----------
    scene : the machine
    """
    return tuple(
        RaceOfBalls(race.count, race.capacity / race.count, race.plane, race.radius, race.diameter)
        for race in scene.balls
    )


def started_balls(scene: Scene) -> Balls:
    """The balls of a scene where a run-up begins.

    Parameters
    ----------
    scene : the machine
    """
    places: list[float] = []
    shares: list[float] = []
    for race in scene.balls:
        places += _places(race)
        shares += [1.0 if race.start == "spread" else 0.0] * race.count
    return Balls(tuple(race.race() for race in scene.balls), tuple(places), tuple(shares))


def _places(race: BallRace) -> list[float]:
    """Angle of each ball from the first direction, against which gravity acts, rad."""
    if race.start == "spread":
        return [2.0 * math.pi * k / race.count for k in range(race.count)]
    apart = APART if race.diameter is None else 2.0 * math.asin(0.5 * race.diameter / race.radius)
    return [math.pi + apart * (k - 0.5 * (race.count - 1)) for k in range(race.count)]
