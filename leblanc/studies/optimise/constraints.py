"""What volumes must keep to: constraints, each with a limit and a scale [theory: optimum, eq. 5, 11, 12]."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import Friction, FrictionLaw
from leblanc.core.units import LENGTH, with_unit
from leblanc.results.base import ConstraintValue
from leblanc.scene.scene import Scene, dry_rotor
from leblanc.studies.optimise.answers import FilledMachine, with_volumes
from leblanc.studies.optimise.balance import QualityAtSpeed
from leblanc.studies.optimise.objectives import PeakOver, Vibration
from leblanc.studies.optimise.robust import Robust
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.cycles.balance import not_circular
from solvers.cycles.cycles import largest_whirl
from solvers.whirl.growth import growth_map


class Constraint:
    """Value of volumes (m, c) that must not exceed a limit; `scale`, above 0, measures the excess."""

    def __init__(
        self,
        name: str,
        meaning: str,
        unit: str,
        limit: float,
        scale: float,
        value: Callable[[Array], Array],
    ) -> None:
        self.name, self.meaning, self.unit = name, meaning, unit
        self.limit, self.scale, self._value = limit, scale, value

    def value(self, volumes: Array) -> Array:
        """Value with volumes, m^3, shape (m, c); infinite where it was not found, shape (m,)."""
        found = self._value(volumes)
        return np.where(np.isnan(found), math.inf, found)

    def excess(self, value: Array) -> Array:
        """By how much a value is above its limit, over the scale; 0 or below if it is not."""
        return np.asarray((value - self.limit) / self.scale)

    def at(self, value: float) -> ConstraintValue:
        """The constraint where it has a value."""
        return ConstraintValue(self.limit, value, value <= self.limit, self.unit, self.meaning)


def dry_wall(machine: FilledMachine, speed: float) -> Constraint:
    """No wall dry over its whole height at a speed, rad/s."""

    def value(volumes: Array) -> Array:
        return machine.at(volumes, np.full(volumes.shape[0], speed)).dry_patch

    text = "wall dry somewhere at the working speed (1) or nowhere (0)"
    return Constraint("dry_patch", text, "1", 0.0, 1.0, value)


def limited(name: str, meaning: str, vibration: Vibration, limit: float) -> Constraint:
    """A vibration up to a limit, m."""

    return Constraint(name, meaning, "m", limit, limit, vibration.exact)


def clearance(over: PeakOver, limit: float) -> Constraint:
    """Amplitude at all operating speeds up to the room that there is, m."""
    return limited("clearance", "largest amplitude at the operating speeds", over, limit)


def whirl_friction(scene: Scene) -> Friction:
    """Friction with which small whirls are judged: the scene's, or the laminar one where it has none.

    Without any friction every layer makes some small whirl grow, however slowly: nothing could be told.
    """
    friction = scene.model.friction
    return Friction(FrictionLaw.STOKES) if friction.law is FrictionLaw.NONE else friction


def balanced(quality: QualityAtSpeed, grade: float) -> Constraint:
    """Unbalance of rotor and liquid together up to a grade of ISO 21940-11, m/s."""
    text = "unbalance of rotor and liquid over the rotor's mass, times the working speed"
    return Constraint("balance_quality", text, "m/s", grade, grade, quality.of)


def growth(scene: Scene, volumes: Array, speed: Array) -> Array:
    """Growth of the small whirl that grows most at any of some speeds [theory: optimum, eq. 5].

    1/s, below 0 where every whirl decays, nan where the whirls were not found, shape (m,).
    """
    rows: list[Sequence[Fill]] = [with_volumes(scene, row).fills for row in volumes]
    rotor, friction = dry_rotor(scene), whirl_friction(scene)
    return np.asarray(growth_map(rotor, rows, speed, friction)[0].max(axis=1))


def stability(scene: Scene, speed: Array, margin: float, where: str) -> Constraint:
    """Every small whirl dies out at some speeds, rad/s, at least at the rate of a margin, 1/s."""

    def value(volumes: Array) -> Array:
        return growth(scene, volumes, speed)

    # A growth of a thousandth of the spin speed is a good measure where no margin is asked for.
    scale = max(margin, 1e-3 * float(speed.max()))
    text = f"largest growth of a small whirl {where}"
    return Constraint("stability", text, "1/s", 0.0 - margin, scale, value)


def whirl_size(scene: Scene, speed: Array, limit: float) -> Constraint:
    """Whirls that excite themselves grow to a limit at most, m [theory: whirl, eq. 24]."""
    rotor, friction = dry_rotor(scene), whirl_friction(scene)
    why_not = not_circular(rotor, scene.fills, friction)
    if why_not:
        raise InputError("optimise.whirl_limit", limit, f"left out: {why_not}")
    known: dict[bytes, float] = {}

    def value(volumes: Array) -> Array:
        for row in volumes:
            key = row.tobytes()
            if key not in known:
                known[key] = largest_whirl(rotor, with_volumes(scene, row).fills, speed, friction)
        return np.array([known[row.tobytes()] for row in volumes])

    return Constraint(
        "whirl_limit", "largest self-excited whirl at the operating speeds", "m", limit, limit, value
    )


def wetting(scene: Scene, least: float) -> Constraint:
    """Each chamber holds no liquid or a film of a least mean depth, m [theory: optimum, eq. 11]."""
    radius, height = np.array([(fill.chamber.radius, fill.chamber.height) for fill in scene.fills]).T

    def value(volumes: Array) -> Array:
        area = volumes / (np.pi * height)
        depth = area / (radius + np.sqrt(np.maximum(np.square(radius) - area, 0.0)))
        thin = np.divide(least, depth, out=np.zeros_like(depth), where=depth > 0.0)
        return np.asarray(thin.max(axis=1))

    text = f"least depth of a film, {with_unit(least, LENGTH)}, over that of the thinnest film"
    return Constraint("wetting", text, "1", 1.0, 1.0, value)


def spill(machine: FilledMachine, speed: float) -> Constraint:
    """The liquid stays clear of every inner edge at a speed, rad/s [theory: optimum, eq. 12]."""

    def value(volumes: Array) -> Array:
        return machine.at(volumes, np.full(volumes.shape[0], speed)).reach

    text = "share of the way to a chamber's inner edge that its liquid reaches at the working speed"
    return Constraint("spill", text, "1", 1.0, 1.0, value)


def room_when_warm(robust: Robust) -> Constraint:
    """The liquid fits its chamber at every temperature."""

    def value(volumes: Array) -> Array:
        return robust.around.fullest(volumes)

    text = "share of a chamber that its liquid takes when warmest"
    return Constraint("room_when_warm", text, "1", 1.0, 1.0, value)
