"""Forces and clearances of a machine over speed or over time."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from leblanc.core.netcdf import Variable, finite
from leblanc.core.netcdf import variable as var
from meshes.arrays import Array, Flags, Index
from solvers.rotor.loads.turn import Extremes


@dataclass(frozen=True)
class Worst:
    """The worst of one quantity and where it is."""

    value: float  #: SI
    speed: float  #: spin speed, rad/s
    time: float  #: s; nan over speed

    def to_json(self) -> dict[str, float | None]:
        """Plain values; no time over speed."""
        found = {"value": self.value, "speed": self.speed}
        if not math.isnan(self.time):
            found["time"] = self.time
        return {name: number if math.isfinite(number) else None for name, number in found.items()}


@dataclass(frozen=True)
class MachineLoads:
    """What a machine is judged by at k speeds, or in k intervals of time; f feet, h holders, p points."""

    speed: Array  #: spin speed, rad/s, shape (k,)
    time: Array  #: s, and rad by which the drum has turned, shape (k,); empty over speed
    angle: Array
    worst: Extremes  #: of each turn or interval
    rest: Array  #: force under each foot at rest, N, shape (f,)
    friction: float  #: coefficient of the feet; nan without a cabinet
    holders: tuple[str, ...]  #: their names
    bearings: tuple[str, ...]
    points: tuple[str, ...]
    gaps: Array  #: of the points, m, nan where none is given, shape (p,)
    torque: Array  #: of the drive on the shaft, N m and W, shape (k,)
    power: Array
    orbit: Array  #: semi-axes of each point's ellipse, m, shape (2, k, p); over time (2, 0, p)
    asked: Index  #: which of the k are speeds of the scene, shape (n,)
    impulse: Array  #: of each hand-over of liquid on each bearing, N s, shape (j, b)
    jumps: Array  #: time of each, s, shape (j,)
    counts: Flags | None = None  #: which of the k count for the worst, shape (k,); all if None

    @property
    def stands(self) -> bool:
        """There is a cabinet."""
        return self.rest.size > 0

    @property
    def in_time(self) -> bool:
        """Over time, not over speed."""
        return self.time.size > 0

    def over_turn(self, values: Array, least: bool = False) -> Array:
        """Largest, or least, value over the turn that ends at each time, (k,); over speed values stay."""
        if not self.in_time:
            return values
        begins = np.searchsorted(self.angle, self.angle - 2.0 * math.pi)
        worst = np.fmin if least else np.fmax
        # Pairs of begin and end as `reduceat` takes them; every second result is that of a turn.
        pairs = np.stack([begins, np.arange(1, begins.size + 1)], axis=1).reshape(-1)
        return np.asarray(worst.reduceat(np.append(values, np.nan), pairs)[::2])

    def least(self, values: Array) -> Worst:
        """The least of some values, shape (k,)."""
        values = self._counting(values)
        return self._at(values, None if np.isnan(values).all() else int(np.nanargmin(values)))

    def largest(self, values: Array) -> Worst:
        """The largest of some values, shape (k,)."""
        values = self._counting(values)
        return self._at(values, None if np.isnan(values).all() else int(np.nanargmax(values)))

    def _counting(self, values: Array) -> Array:
        """The same, nan where they do not count."""
        return values if self.counts is None else np.where(self.counts, values, np.nan)

    def _at(self, values: Array, k: int | None) -> Worst:
        if k is None:
            return Worst(math.nan, math.nan, math.nan)
        time = float(self.time[k]) if self.in_time else math.nan
        return Worst(float(values[k]), float(self.speed[k]), time)

    @property
    def clearances(self) -> dict[str, Worst]:
        """The least clearance of each point that has a gap, by its name."""
        return {
            name: self.least(self.worst.clearance[:, k])
            for k, name in enumerate(self.points)
            if not math.isnan(self.gaps[k])
        }

    @property
    def feet(self) -> tuple[Worst, ...]:
        """The largest force under each foot."""
        return tuple(self.largest(force) for force in self.worst.floor_force.T)

    @property
    def walking(self) -> Worst:
        """The least margin against walking."""
        return self.least(self.worst.walking)

    def _named(self, names: tuple[str, ...], values: Array) -> dict[str, list[Any]]:
        """Lists over speed or time by name, m or N, of values of shape (k, names)."""
        return {name: finite(values[self.asked, k]) for k, name in enumerate(names)}

    def to_json(self) -> dict[str, Any]:
        """Plain values over the scene's speeds or over time, SI; the worst between the speeds as well."""
        w, rows = self.worst, self.asked
        known = [k for k, gap in enumerate(self.gaps) if not math.isnan(gap)]
        names = tuple(self.points[k] for k in known)
        over = self._named(names, w.clearance[:, known])
        found: dict[str, Any] = {
            "displacement": self._named(self.points, w.moved),
            "mount_force": self._named(self.holders, w.holder),
            "bearing_force": self._named(self.bearings, w.bearing),
            "motor_torque": finite(self.torque[rows]),
            "motor_power": finite(self.power[rows]),
        }
        if self.in_time:
            found["clearance"] = {name: worst.to_json()["value"] for name, worst in self.clearances.items()}
            found["bearing_impulse"] = {
                name: finite(self.impulse[:, k]) for k, name in enumerate(self.bearings)
            }
            found["bearing_impulse_time"] = finite(self.jumps)
            found["clearance_over_time"] = over
        else:
            found["clearance"] = over
            large, small = self.orbit
            found["orbit"] = {
                name: {"major": finite(large[rows, k]), "minor": finite(small[rows, k])}
                for k, name in enumerate(self.points)
            }
        if self.stands:
            found |= self._floor_json()
        return found | {"worst": self._worst_json()}

    def _floor_json(self) -> dict[str, Any]:
        """Feet and margins."""
        w, rows = self.worst, self.asked
        walking = finite(w.walking[rows])
        return {
            "floor_force": finite(w.floor_force[rows]),
            "floor_force_least": finite(w.floor_force_least[rows]),
            "floor_force_rest": finite(self.rest),
            "lift_off_margin": finite(w.lift_off[rows]),
            "slip_margin": finite(w.slip[rows]),
            **(
                {"walking_margin": self.walking.to_json()["value"], "walking_margin_over_time": walking}
                if self.in_time
                else {"walking_margin": walking}
            ),
        }

    def _worst_json(self) -> dict[str, Any]:
        """The worst of each and where it is."""
        w = self.worst
        found: dict[str, Any] = {
            "clearance": {name: worst.to_json() for name, worst in self.clearances.items()},
            "displacement": self._largest(self.points, w.moved),
            "mount_force": self._largest(self.holders, w.holder),
            "bearing_force": self._largest(self.bearings, w.bearing),
            "motor_torque": self.largest(self.torque).to_json(),
            "motor_power": self.largest(self.power).to_json(),
        }
        if self.stands:
            found["floor_force"] = [worst.to_json() for worst in self.feet]
            found["walking_margin"] = self.walking.to_json()
        return found

    def _largest(self, names: tuple[str, ...], values: Array) -> dict[str, Any]:
        return {name: self.largest(values[:, k]).to_json() for k, name in enumerate(names)}

    def variables(self) -> dict[str, Variable]:
        """Arrays over `speed` or `time`; dimensions `foot`, `mount`, `bearing` and `point` come with them."""
        w, rows = self.worst, self.asked
        over = "time" if self.in_time else "speed"
        span = "since the time before" if self.in_time else "over a turn"
        found = {
            "motor_torque": var((over,), self.torque[rows], "N m", "torque of the drive", "mean"),
            "motor_power": var((over,), self.power[rows], "W", "power of the drive", "mean"),
            **_table(over, "mount", self.holders, w.holder[rows], "N", "force", f"largest {span}"),
            **_table(over, "bearing", self.bearings, w.bearing[rows], "N", "force", f"largest {span}"),
            **_table(over, "point", self.points, w.moved[rows], "m", "displacement", f"largest {span}"),
        }
        if self.points:
            text = f"least {span}, below 0 where it touches"
            found["point_clearance"] = var((over, "point"), w.clearance[rows], "m", "clearance", text)
            if not self.in_time:
                for name, values in zip(("major", "minor"), self.orbit, strict=True):
                    text = f"{name} semi-axis of the orbit"
                    found[f"point_{name}"] = var((over, "point"), values[rows], "m", text)
        if self.in_time and self.bearings:
            text = "of a hand-over of liquid"
            found["handover_time"] = var(("handover",), self.jumps, "s", "time", text)
            found["bearing_impulse"] = var(
                ("handover", "bearing"), self.impulse, "N s", "impulse on the bearing", text
            )
        if not self.stands:
            return found
        for name, long in (("floor_force", "largest"), ("floor_force_least", "least")):
            values, text = getattr(w, name)[rows], "vertical force of the floor"
            found[name] = var((over, "foot"), values, "N", text, f"{long} {span}")
        found["floor_force_rest"] = var(("foot",), self.rest, "N", "vertical force of the floor", "at rest")
        for name, values in (("lift_off", w.lift_off), ("slip", w.slip), ("walking", w.walking)):
            text = f"least {span}; 1 at rest, 0 where the machine walks"
            found[f"{name}_margin"] = var((over,), values[rows], "1", f"margin, {name}", text)
        return found


def _table(
    over: str, of: str, names: tuple[str, ...], values: Array, unit: str, what: str, text: str
) -> dict[str, Variable]:
    """Values of named parts; nothing where there are none."""
    if not names:
        return {}
    labels = np.array(names, dtype=object)
    return {
        f"{of}_name": var((of,), labels, "1", f"name of the {of}"),
        f"{of}_{what}": var((over, of), values, unit, f"{what} of the {of}", text),
    }
