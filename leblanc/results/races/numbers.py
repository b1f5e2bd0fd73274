"""A scene with balls in numbers: what they hold, how quickly they follow, from where on they balance."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any, ClassVar

import numpy as np

from leblanc.core.answer import Result, attributes
from leblanc.core.netcdf import NamedArrays, finite, flags
from leblanc.core.netcdf import variable as var
from leblanc.results.base import number_or_none
from leblanc.results.explanation import Explanation
from meshes.arrays import Array, Flags
from solvers.rotor.balls.two_plane_balance import Balancing


@dataclass(frozen=True)
class RaceNumbers:
    """One race with its balls in numbers."""

    count: int  #: of the balls
    mass: float  #: of one ball, kg
    plane: float  #: along the axis, m
    capacity: float  #: largest unbalance that the balls hold, kg m
    #: unbalance that they must hold where the rotor is balanced, kg m; nan where no shares of the races
    #: balance it
    share: float
    #: share of the way round that the balls take side by side, 0 where their diameter is not known
    crowding: float
    #: in which the speed of a free ball against its drum falls to 1/e, s, infinite without drag
    fade_time: float
    drag: float  #: dimensionless, over a ball's mass, rolling share and the critical speed
    sticking: float  #: deflection below which balls that resist to rolling stay where they are, m


@dataclass(frozen=True)
class BallExplanation(Result):
    """A scene with balls in numbers; s speeds.

    Examples
    --------
    >>> import leblanc as lb
    >>> told = lb.explain(lb.example("balls"))
    >>> told.can_balance, round(told.balanced_from / told.machine.critical_speed_dry, 2)
    (True, 1.12)
    """

    figure: ClassVar[str] = "leblanc.figures.races.numbers:numbers_figure"
    summary: ClassVar[str] = "leblanc.text.races.numbers:facts"

    machine: Explanation  #: the same scene without its balls
    races: tuple[RaceNumbers, ...]  #: in their order
    unbalance: float  #: of the rotor, all of its sizes together, kg m
    ball_mass: float  #: of all balls, kg
    can_balance: bool  #: the balls can take all unbalance away
    reason: str  #: why not, or that they can, in words
    #: speed from which on the balanced state is stable, rad/s, nan if at none of the scene's
    balanced_from: float
    speed: Array  #: at which it was looked at, rad/s, shape (s,)
    growth: Array  #: of small motions about the balanced state, 1/s, nan where there is none, shape (s,)
    #: conditions of balancing in two planes; None where the rotor or its races have none
    balancing: Balancing | None
    #: condition of balancing in the plane of the only race, shape (s,); None elsewhere
    single_plane: Flags | None
    lacking: tuple[str, ...]  #: what is not told, a sentence each

    @property
    def name(self) -> str:
        """Of the scene."""
        return self.machine.name

    @property
    def source(self) -> str:
        """Where its values come from."""
        return self.machine.source

    @property
    def assumed(self) -> tuple[str, ...]:
        """Paths of the values that no source gives."""
        return self.machine.assumed

    @property
    def digest(self) -> str:
        """Fingerprint of the scene."""
        return self.machine.digest

    def to_json(self) -> dict[str, Any]:
        """What `explain` prints for scripts: the scene without its balls, and the balls; SI."""
        own = self.machine.to_json()
        own["not_told"] = [*own["not_told"], *self.lacking]
        return own | {
            "races": [
                {key: number_or_none(value) for key, value in asdict(race).items()} for race in self.races
            ],
            "unbalance": self.unbalance,
            "ball_mass": self.ball_mass,
            "can_balance": self.can_balance,
            "can_balance_why": self.reason,
            "balanced_from": number_or_none(self.balanced_from),
            "balanced_growth": {"speed": finite(self.speed), "growth": finite(self.growth)},
            "balancing": None if self.balancing is None else _balancing_json(self.balancing),
            "single_plane": None if self.single_plane is None else self.single_plane.tolist(),
        }

    def named_arrays(self) -> NamedArrays:
        """Arrays over the dimensions `race` and `at` (speeds), beside those of the scene without balls."""
        own, rate = self.machine.named_arrays(), "rad s-1"
        units = {"count": "1", "mass": "kg", "plane": "m", "capacity": "kg m", "share": "kg m"}
        units |= {"crowding": "1", "fade_time": "s", "drag": "1", "sticking": "m"}
        found = {
            f"race_{name}": var(
                ("race",),
                np.array([getattr(race, name) for race in self.races]),
                unit,
                name.replace("_", " "),
            )
            for name, unit in units.items()
        }
        found |= {
            "can_balance": flags((), np.array(self.can_balance), "no yes", "the balls hold the unbalance"),
            "balanced_from": var((), self.balanced_from, rate, "speed from which on the rotor is balanced"),
            "ball_speed": var(("ball_at",), self.speed, rate, "spin speed"),
            "balanced_growth": var(("ball_at",), self.growth, "s-1", "growth about the balanced state"),
        }
        return NamedArrays({**own.variables, **found}, own.coords, attributes(self, "explain", {}, ()))


def _balancing_json(found: Balancing) -> dict[str, Any]:
    """Conditions in two planes, and the roots of rotor and balls beside them."""
    return {
        "speed": finite(found.speed),
        "possible": found.possible.tolist(),
        "above": None if math.isinf(found.above) else found.above,
        "resonances": list(found.resonances),
        "long": found.long,
        "growth": None if found.growth is None else finite(found.growth),
        "conditions": [
            {"name": each.name, "above": None if math.isinf(each.above) else each.above}
            for each in found.conditions
        ],
    }
