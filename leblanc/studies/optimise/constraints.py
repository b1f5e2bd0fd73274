"""What volumes must keep to, and the judge that puts objective and constraints together [theory: optimum]."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from fluid.fill import Fill
from leblanc.scene.machine import dry_rotor
from leblanc.scene.scene import Scene
from leblanc.studies.optimise.answers import FilledMachine, with_volumes
from leblanc.studies.optimise.conditions import Robust
from leblanc.studies.optimise.objectives import PeakOver, Vibration
from leblanc.studies.prepare import solver_friction
from meshes.arrays import Array
from solvers.search import Judgement
from solvers.whirl.growth import growth_map

_BEYOND = 1.3  # of a limit, up to which a vibration above it must be known exactly


@dataclass(frozen=True)
class Verdict:
    """A constraint at one point.

    Parameters
    ----------
    limit, value : in the unit; the value must not be above the limit
    satisfied : it is not
    unit, text : of both, and what they are
    """

    limit: float
    value: float
    satisfied: bool
    unit: str
    text: str


class Constraint:
    """A value that must not be above its limit.

    Parameters
    ----------
    name, text, unit : for reports
    limit : in the unit
    scale : what an excess is measured by, above 0
    value : of volumes, shape (m, c), and of the limit beyond which a lower estimate will do; shape (m,)
    """

    def __init__(
        self,
        name: str,
        text: str,
        unit: str,
        limit: float,
        scale: float,
        value: Callable[[Array, float], Array],
    ) -> None:
        self.name, self.text, self.unit = name, text, unit
        self.limit, self.scale, self._value = limit, scale, value

    def value(self, volumes: Array) -> Array:
        """Value with volumes, shape (m, c); infinite where it was not found, shape (m,)."""
        found = self._value(volumes, self.limit)
        return np.where(np.isnan(found), math.inf, found)

    def excess(self, value: Array) -> Array:
        """By how much a value is above its limit, over the scale; 0 or below if it is not."""
        return np.asarray((value - self.limit) / self.scale)

    def verdict(self, value: float) -> Verdict:
        """The constraint at one point."""
        return Verdict(self.limit, value, value <= self.limit, self.unit, self.text)


def dry_wall(machine: FilledMachine, speed: float) -> Constraint:
    """No wall dry over its whole height at a speed, rad/s."""

    def value(volumes: Array, _: float) -> Array:
        return machine.at(volumes, np.full(volumes.shape[0], speed)).dry_patch

    text = "wall dry somewhere at the working speed (1) or nowhere (0)"
    return Constraint("dry_patch", text, "1", 0.0, 1.0, value)


def limited(name: str, text: str, vibration: Vibration, limit: float) -> Constraint:
    """A vibration up to a limit, m."""

    def value(volumes: Array, most: float) -> Array:
        return vibration.exact(volumes, _BEYOND * most)

    return Constraint(name, text, "m", limit, limit, value)


def clearance(over: PeakOver, limit: float) -> Constraint:
    """Amplitude at all operating speeds up to the room that there is, m."""
    return limited("clearance", "largest amplitude at the operating speeds", over, limit)


def growth(scene: Scene, volumes: Array, speed: Array) -> Array:
    """Growth of the small whirl that grows most at any of some speeds [theory: optimum, eq. 5].

    Parameters
    ----------
    scene : the machine
    volumes : m^3, shape (m, c)
    speed : rad/s, shape (n,)

    Returns
    -------
    1/s, below 0 where every whirl dies out, nan where the whirls were not found, shape (m,)
    """
    rows: list[Sequence[Fill]] = [with_volumes(scene, row).chambers for row in volumes]
    system, friction = dry_rotor(scene).system(), solver_friction(scene.model.friction)
    return np.asarray(growth_map(system, rows, speed, friction)[0].max(axis=1))


def stability(scene: Scene, speed: Array, margin: float) -> Constraint:
    """Every small whirl dies out at the operating speeds, rad/s, at least at the rate of a margin, 1/s."""

    def value(volumes: Array, _: float) -> Array:
        return growth(scene, volumes, speed)

    # A growth of a thousandth of the spin speed is a good measure where no margin is asked for.
    scale = max(margin, 1e-3 * float(speed.max()))
    text = "largest growth of a small whirl at the operating speeds"
    return Constraint("stability", text, "1/s", -margin, scale, value)


def room_when_warm(robust: Robust) -> Constraint:
    """The liquid fits its chamber at every temperature."""

    def value(volumes: Array, _: float) -> Array:
        return robust.fullest(volumes)

    text = "share of a chamber that its liquid takes when warmest"
    return Constraint("room_when_warm", text, "1", 1.0, 1.0, value)


@dataclass
class FillJudge:
    """Judges volumes by a vibration, or by their mass, and by constraints.

    Parameters
    ----------
    vibration : to be small
    density : of each chamber's liquid, kg/m^3, shape (c,)
    constraints : to keep to
    by_mass : the liquid's mass is to be small; the vibration is then one of the constraints
    best : least objective of any allowed volumes so far, above which an estimate will do
    """

    vibration: Vibration
    density: Array
    constraints: tuple[Constraint, ...]
    by_mass: bool = False
    best: float = field(default=math.inf)

    def __call__(self, volumes: Array) -> Judgement:
        """Judgement of m sets of volumes, m^3, shape (m, c).

        Its details are the values of the constraints, the mass, the vibration, and whether that is sure (1)
        or an estimate from below (0).
        """
        found = {one.name: one.value(volumes) for one in self.constraints}
        over = np.full(volumes.shape[0], -1.0)
        for one in self.constraints:
            over = np.maximum(over, one.excess(found[one.name]))
        mass = volumes @ self.density
        if self.by_mass:
            objective, vibration = mass, found["vibration"]
            sure = vibration <= _BEYOND * next(
                one.limit for one in self.constraints if one.name == "vibration"
            )
        else:
            vibration, sure = self.vibration.least(volumes, self.best)
            objective = vibration
        self.best = min(self.best, float(objective[sure & (over <= 0.0)].min(initial=math.inf)))
        extra = {"mass": mass, "vibration": vibration, "sure": sure.astype(float)}
        return Judgement(objective, over, found | extra)
