"""What volumes must keep to [theory: optimum, eq. 5]."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from fluid.fill import Fill
from leblanc.results.optimum import ConstraintValue
from leblanc.scene.scene import Scene, dry_rotor
from leblanc.studies.optimise.answers import FilledMachine, with_volumes
from leblanc.studies.optimise.objectives import PeakOver, Vibration
from leblanc.studies.optimise.robust import Robust
from meshes.arrays import Array
from solvers.whirl.growth import growth_map

BEYOND = 1.3  # of a limit, up to which a vibration above it must be known exactly


class Constraint:
    """A value that must not be above its limit.

    Parameters
    ----------
    name, meaning, unit : for reports
    limit : in the unit
    scale : what an excess is measured by, above 0
    value : of volumes, shape (m, c), and of the limit beyond which a lower estimate will do; shape (m,)
    """

    def __init__(
        self,
        name: str,
        meaning: str,
        unit: str,
        limit: float,
        scale: float,
        value: Callable[[Array, float], Array],
    ) -> None:
        self.name, self.meaning, self.unit = name, meaning, unit
        self.limit, self.scale, self._value = limit, scale, value

    def value(self, volumes: Array) -> Array:
        """Value with volumes, shape (m, c); infinite where it was not found, shape (m,)."""
        found = self._value(volumes, self.limit)
        return np.where(np.isnan(found), math.inf, found)

    def excess(self, value: Array) -> Array:
        """By how much a value is above its limit, over the scale; 0 or below if it is not."""
        return np.asarray((value - self.limit) / self.scale)

    def at(self, value: float) -> ConstraintValue:
        """The constraint where it has a value."""
        return ConstraintValue(self.limit, value, value <= self.limit, self.unit, self.meaning)


def dry_wall(machine: FilledMachine, speed: float) -> Constraint:
    """No wall dry over its whole height at a speed, rad/s."""

    def value(volumes: Array, _: float) -> Array:
        return machine.at(volumes, np.full(volumes.shape[0], speed)).dry_patch

    text = "wall dry somewhere at the working speed (1) or nowhere (0)"
    return Constraint("dry_patch", text, "1", 0.0, 1.0, value)


def limited(name: str, meaning: str, vibration: Vibration, limit: float) -> Constraint:
    """A vibration up to a limit, m."""

    def value(volumes: Array, most: float) -> Array:
        return vibration.exact(volumes, BEYOND * most)

    return Constraint(name, meaning, "m", limit, limit, value)


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
    rows: list[Sequence[Fill]] = [with_volumes(scene, row).fills for row in volumes]
    rotor, friction = dry_rotor(scene), scene.model.friction
    return np.asarray(growth_map(rotor, rows, speed, friction)[0].max(axis=1))


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
