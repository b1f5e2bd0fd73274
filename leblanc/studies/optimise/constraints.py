"""What volumes must keep to: constraints, each with a limit and a scale [theory: optimum, eq. 5, 11, 12]."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from itertools import repeat

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import Friction, FrictionLaw
from leblanc.core.units import LENGTH, VOLUME, over_rpm, with_unit
from leblanc.scene.scene import Scene, Speeds, dry_rotor
from leblanc.scene.tasks import LOADS, Optimisation
from leblanc.studies.loads.study import loaded_machine
from leblanc.studies.optimise.answer import ConstraintValue
from leblanc.studies.optimise.filled import FilledMachine, Once, with_volumes
from leblanc.studies.optimise.objectives import LIMITED, Load, LoadsOver, Passages
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.cycles.balance import not_circular
from solvers.cycles.cycles import largest_whirl
from solvers.layer.places import FEWEST_CELLS
from solvers.whirl.growth import growth_map

_ON_FEET = ("floor_force", "walking_margin", "slip_margin")
UNITS = {"floor_force": "N", "motor_torque": "N m"}  # of loads; of the others 1


@dataclass(frozen=True)
class Limit:
    """A value that must not be above a limit."""

    name: str
    meaning: str  #: of the value
    unit: str  #: of value and limit
    limit: float
    scale: float  #: above 0, measures the excess

    def excess(self, value: Array | float) -> Array:
        """By how much a value is above its limit, over the scale; 0 or below if it is not."""
        return np.asarray((value - self.limit) / self.scale)

    def at(self, value: float, rounding: float = 0.0) -> ConstraintValue:
        """The constraint where it has a value, which is kept up to a rounding of the scale."""
        kept = bool(value <= self.limit + rounding * self.scale)
        return ConstraintValue(self.limit, value, kept, self.unit, self.meaning)


@dataclass(frozen=True)
class Constraint(Limit):
    """A value of volumes that must not be above a limit."""

    found: Callable[[Array], Array]  #: values with m sets of volumes, shape (m, c); nan where not found
    load: Load | None = None  #: whose value it is

    def value(self, volumes: Array) -> Array:
        """Value with volumes, m^3, shape (m, c); infinite where it was not found, shape (m,)."""
        found = self.found(volumes)
        return np.where(np.isnan(found), math.inf, found)

    def on(self, runs: Passages) -> Constraint:
        """The same with other run-ups; itself where it is no load."""
        if self.load is None:
            return self
        load = self.load.on(runs)
        return replace(self, load=load, found=load.exact)


def at_speed(machine: FilledMachine, speed: float, what: str) -> Callable[[Array], Array]:
    """What a machine with volumes answers at a speed, rad/s: "dry_patch" or "reach"."""
    return lambda volumes: np.asarray(getattr(machine.at(volumes, np.full(volumes.shape[0], speed)), what))


def dry_wall(machine: FilledMachine, speed: float) -> Constraint:
    """No wall dry over its whole height at a speed, rad/s."""
    text = "wall dry somewhere at the working speed (1) or nowhere (0)"
    return Constraint("dry_patch", text, "1", 0.0, 1.0, at_speed(machine, speed, "dry_patch"))


def whirl_friction(scene: Scene) -> Friction:
    """Friction with which small whirls are evaluated: the scene's, or the laminar one where it has none.

    Without any friction every layer makes some small whirl grow, however slowly: nothing could be told.
    """
    friction = scene.model.friction
    return Friction(FrictionLaw.STOKES) if friction.law is FrictionLaw.NONE else friction


def growth(scene: Scene, volumes: Array, speed: Array, pool: ProcessPoolExecutor | None = None) -> Array:
    """Growth of the fastest-growing small whirl at any of some speeds [theory: optimum, eq. 5].

    1/s, below 0 where every whirl decays, nan where the whirls were not found, shape (m,). A pool takes one
    set of volumes at a time.
    """
    if pool is not None and volumes.shape[0] > 1:
        parts = pool.map(growth, repeat(scene), volumes[:, None], repeat(speed))
        return np.concatenate(list(parts))
    rows = [with_volumes(scene, row).fills for row in volumes]
    rotor, friction = dry_rotor(scene), whirl_friction(scene)
    return np.asarray(growth_map(rotor, rows, speed, friction)[0].max(axis=1))


def stability(
    scene: Scene, speed: Array, margin: float, where: str, pool: ProcessPoolExecutor | None = None
) -> Constraint:
    """Every small whirl decays at some speeds, rad/s, at least at the rate of a margin, 1/s."""
    # A growth of a thousandth of the spin speed is a good measure where no margin is asked for.
    scale = max(margin, 1e-3 * float(speed.max()))
    text = f"largest growth of a small whirl {where}"
    return Constraint(
        "stability", text, "1/s", 0.0 - margin, scale, lambda volumes: growth(scene, volumes, speed, pool)
    )


def whirl_size(scene: Scene, speed: Array, limit: float) -> Constraint:
    """Whirls that excite themselves grow to a limit at most, m [theory: whirl, eq. 24]."""
    rotor, friction = dry_rotor(scene), whirl_friction(scene)
    why_not = not_circular(rotor, scene.fills, friction)
    if why_not:
        raise InputError("optimise.whirl_limit", limit, f"left out: {why_not}")
    each = Once(lambda row: largest_whirl(rotor, with_volumes(scene, row).fills, speed, friction))
    text = "largest self-excited whirl at the operating speeds"
    return Constraint("whirl_limit", text, "m", limit, limit, lambda volumes: np.array(each(volumes)))


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
    text = "share of the way to a chamber's inner edge that its liquid reaches at the working speed"
    return Constraint("spill", text, "1", 1.0, 1.0, at_speed(machine, speed, "reach"))


def limits_loads(task: Optimisation) -> bool:
    """Whether the task limits a load: each takes a response over speeds, or a run-up."""
    return any(getattr(task, name) is not None for name in LIMITED)


def loads_in_time(task: Optimisation) -> bool:
    """Whether loads are looked at over the run-up."""
    return task.loads_over != "operating" and (limits_loads(task) or task.objective in LOADS)


def loads_of(
    task: Optimisation, machine: FilledMachine, speeds: Speeds, runs: Passages | None, least: float = 0.0
) -> LoadsOver:
    """The loads that a task looks at."""
    return LoadsOver(machine, None if task.loads_over == "runup" else speeds, least, runs)


def load_constraints(
    task: Optimisation, machine: FilledMachine, speeds: Speeds, runs: Passages | None = None
) -> Iterator[Constraint]:
    """What the task limits of forces, walking, clearances and the motor."""
    over, where = loads_of(task, machine, speeds, runs, task.point_clearance or 0.0), load_place(task)
    held = "share of its hold on the floor that the machine uses {}, 1 less the {} margin"
    left = with_unit(task.point_clearance or 0.0, LENGTH)
    texts = {
        "floor_force": f"largest force under a foot {where}",
        "walking_margin": held.format(where, "walking"),
        "slip_margin": held.format(where, "slip"),
        "point_clearance": f"largest share that a point takes {where} of its gap less {left}",
        "motor_torque": f"largest torque of the motor {where}",
    }
    for name, text in texts.items():
        given = getattr(task, name)
        if given is None:
            continue
        limit = 1.0 - given if name.endswith("margin") else 1.0 if name == "point_clearance" else given
        scale = given if name in UNITS else 1.0
        load = Load(over, name)
        yield Constraint(name, text, UNITS.get(name, "1"), limit, scale, load.exact, load)


def load_place(task: Optimisation, speeds: Speeds | None = None) -> str:
    """Where the loads of a task are looked at, in words."""
    steady = "at the operating speeds" if speeds is None else over_rpm(speeds.start, speeds.stop)
    in_time = "over the run-up in time"
    return {"operating": steady, "runup": in_time, "both": f"{steady} and {in_time}"}[task.loads_over]


def require_loads(scene: Scene, task: Optimisation) -> None:
    """Refuse what needs a cabinet, points or a run-up that the scene does not have, or goes another way."""
    limits = [name for name in LIMITED if getattr(task, name) is not None]
    if task.deflection is not None and limits:
        name = f"optimise.{limits[0]}"
        raise InputError(name, getattr(task, limits[0]), "left out where optimise.deflection is given")
    for name in [*limits, *([task.objective] if task.objective in LOADS else [])]:
        asked = name in limits
        field = f"optimise.{name if asked else 'objective'}"
        value, way = (getattr(task, name), "left out") if asked else (name, "another one")
        if name in _ON_FEET and scene.cabinet is None:
            raise InputError(field, value, f"{way}: the scene has no [cabinet]")
        if name == "motor_torque" and loaded_machine(scene) is None:
            text = f"{way}: the scene has no [cabinet], [[points]] or [[rotor.bearings]]"
            raise InputError(field, value, text)
        gaps = [point.gap for point in scene.points if point.gap is not None]
        if name == "point_clearance" and not min(gaps, default=0.0) > (task.point_clearance or 0.0):
            text = "below the gap of every point in [[points]], at least one of which has a gap"
            raise InputError(field, value, text if asked else f"{way}: no point in [[points]] has a gap")
    if loads_in_time(task) and scene.speed_plan is None:
        text = "operating: the scene has no table [runup] or [programme]"
        raise InputError("optimise.loads_over", task.loads_over, text)


def freeing_volumes(scene: Scene) -> Array:
    """Volume of each chamber from which on its liquid passes the baffles, m^3, shape (c,).

    Below it the liquid is in compartments; 0 where it never is, as behind a gap at the wall.
    """
    return np.array([_freeing(fill) for fill in scene.fills])


def _freeing(fill: Fill) -> float:
    chamber, baffles = fill.chamber, fill.chamber.baffles
    if baffles is None or baffles.wetted_span(chamber.radius, baffles.tip_radius) is None:
        return 0.0
    if baffles.wetted_span(chamber.radius, 0.0)[1] < chamber.radius:  # type: ignore[index]
        return 0.0
    inner = max(baffles.tip_radius, chamber.inner_radius)
    return math.pi * chamber.height * (chamber.radius - inner) * (chamber.radius + inner)


def most_cells(scene: Scene) -> int:
    """Cells round each wall that long waves need where the liquid is in the most compartments; 0 without."""
    cut = zip(scene.fills, freeing_volumes(scene).tolist(), strict=True)
    counts = (fill.chamber.baffles.count for fill, freed in cut if freed > 0.0 and fill.chamber.baffles)
    return max((FEWEST_CELLS * count for count in counts), default=0)


def require_known_walls(scene: Scene, task: Optimisation, low: Array, high: Array) -> None:
    """Refuse baffles that no model answers for at some of the volumes searched."""
    for k, (fill, freed) in enumerate(zip(scene.fills, freeing_volumes(scene).tolist(), strict=True)):
        baffles = fill.chamber.baffles
        if baffles is None:
            continue
        if task.whirl_limit is not None:
            raise InputError(
                "optimise.whirl_limit", task.whirl_limit, "left out: limit cycles know no baffles"
            )
        if low[k] >= freed or high[k] <= 0.0:
            continue
        where = f"or least volumes in optimise.volumes.{k} of {with_unit(freed, VOLUME)}, which passes them"
        if baffles.count == 2:
            text = f"3 or more where they cut the liquid, as two compartments have no model; {where}"
            raise InputError(f"chambers.{k}.baffles.count", baffles.count, text)
        plan, cells = scene.speed_plan, FEWEST_CELLS * baffles.count
        if plan is not None and task.objective == "peak" and not task.steady and plan.cells < cells:
            text = f"{cells} or more, {FEWEST_CELLS} in each of {baffles.count} compartments; {where}"
            table = "runup" if scene.programme is None else "programme"
            raise InputError(f"{table}.cells", plan.cells, text)
        if scene.model.liquid not in ("auto", "linear", "fem", "long_wave"):
            text = f"auto, linear or fem where baffles cut the liquid into compartments; {where}"
            raise InputError("model.liquid", scene.model.liquid, text)
