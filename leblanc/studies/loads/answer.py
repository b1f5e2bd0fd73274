"""Forces and clearances of a machine over speed or over time."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from leblanc.core.blocks import Cell, Table
from leblanc.core.netcdf import Variable
from leblanc.core.netcdf import variable as var
from leblanc.core.quantities import quantities
from leblanc.core.units import LENGTH, NOT_FOUND, RPM, in_rpm, number, with_unit
from meshes.arrays import Array, Flags, Index
from meshes.quantity import Q
from solvers.rotor.loads.turn import Extremes

LITTLE = 0.2  # of the friction or weight at rest: a machine with less is near walking


@dataclass(frozen=True)
class Worst:
    """The worst of one quantity and where it is."""

    value: Annotated[float, Q(text="SI")]
    speed: Annotated[float, Q("rad s-1", "spin speed")]
    #: nan over speed
    time: Annotated[float, Q("s", "time", when="moment")]

    @property
    def moment(self) -> float | None:
        """Its time, None over speed."""
        return None if math.isnan(self.time) else self.time


_OF_BEARING = ("bearing", "speed")


@dataclass(frozen=True)
class BearingLife:
    """Ball bearings at the speeds of the scene; b bearings, n speeds; nan without a dynamic rating."""

    load: Annotated[Array, Q("N", "load", "cubic mean over a turn", _OF_BEARING, by="loads, eq. 21")]
    load_dry: Annotated[Array, Q("N", "load without liquid", "cubic mean over a turn", _OF_BEARING)]
    least_load: Annotated[
        Array, Q("N", "least load", "with less the balls skid: 0.01 of the rating", _OF_BEARING)
    ]
    slip: Annotated[
        Array, Q("1", "slip of the cage", "behind rolling, by its load", _OF_BEARING, by="loads, eq. 23")
    ]
    #: nan where the balls are not given
    wear_volume: Annotated[
        Array,
        Q(
            "m3",
            "wear volume",
            "of sliding balls on the inner ring, in an hour",
            _OF_BEARING,
            by="loads, eq. 25",
        ),
    ]
    life_hours: Annotated[
        Array, Q("h", "rating life", "of nine in ten, ISO 281", _OF_BEARING, by="loads, eq. 22")
    ]

    @property
    def slip_dry(self) -> Array:
        """The slip without liquid."""
        return np.asarray(np.maximum(1.0 - self.load_dry / self.least_load, 0.0))


@dataclass(frozen=True)
class MachineLoads:
    """Loads and clearances at k speeds, or in k intervals of time; f feet, h holders, p points."""

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
    semi_axes: Array  #: of each point's ellipse, m, shape (2, k, p); over time (2, 0, p)
    asked: Index  #: which of the k are speeds of the scene, shape (n,)
    impulse: Array  #: of each hand-over of liquid on each bearing, N s, shape (j, b)
    jumps: Array  #: time of each, s, shape (j,)
    counts: Flags | None = None  #: which of the k count for the worst, shape (k,); all if None
    #: None over time, and without a bearing whose dynamic rating is given
    bearing_life: Annotated[
        BearingLife | None,
        Q(text="life, slip and wear of the bearings", prefix="bearing_life", when="bearing_life"),
    ] = None

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

    def _named(self, names: tuple[str, ...], values: Array) -> dict[str, Array]:
        """Values of shape (k, names) at the scene's speeds or over time, by name."""
        return {name: values[self.asked, k] for k, name in enumerate(names)}

    @property
    def displacement(
        self,
    ) -> Annotated[dict[str, Array], Q("m", text="of each point, largest over a turn", data=False)]:
        return self._named(self.points, self.worst.moved)

    @property
    def mount_force(
        self,
    ) -> Annotated[dict[str, Array], Q("N", text="in each mount, largest over a turn", data=False)]:
        return self._named(self.holders, self.worst.holder)

    @property
    def bearing_force(
        self,
    ) -> Annotated[dict[str, Array], Q("N", text="in each bearing, largest over a turn", data=False)]:
        return self._named(self.bearings, self.worst.bearing)

    @property
    def motor_torque(self) -> Annotated[Array, Q("N m", "torque of the drive", "mean")]:
        return self.torque[self.asked]

    @property
    def motor_power(self) -> Annotated[Array, Q("W", "power of the drive", "mean")]:
        return self.power[self.asked]

    @property
    def clearance_over_time(
        self,
    ) -> Annotated[
        dict[str, Array] | None,
        Q("m", text="of each point with a gap", when="clearance_over_time", data=False),
    ]:
        return self._least_clearance() if self.in_time else None

    def _least_clearance(self) -> dict[str, Array]:
        known = np.flatnonzero(~np.isnan(self.gaps)).tolist()
        return self._named(tuple(self.points[k] for k in known), self.worst.clearance[:, known])

    @property
    def clearance(
        self,
    ) -> Annotated[dict[str, Any], Q("m", text="least of each point with a gap", data=False)]:
        if not self.in_time:
            return self._least_clearance()
        return {name: worst.value for name, worst in self.clearances.items()}

    @property
    def bearing_impulse(
        self,
    ) -> Annotated[
        dict[str, Array] | None,
        Q("N s", text="of a pool-annulus transition", when="bearing_impulse", data=False),
    ]:
        if not self.in_time:
            return None
        return {name: self.impulse[:, k] for k, name in enumerate(self.bearings)}

    @property
    def bearing_impulse_time(
        self,
    ) -> Annotated[Array | None, Q("s", "time of a pool-annulus transition", when="bearing_impulse")]:
        return self.jumps if self.in_time else None

    @property
    def orbit(
        self,
    ) -> Annotated[
        dict[str, dict[str, Array]] | None, Q("m", text="semi-axes at each point", when="orbit", data=False)
    ]:
        if self.in_time:
            return None
        large, small = (self._named(self.points, values) for values in self.semi_axes)
        return {name: {"major": large[name], "minor": small[name]} for name in self.points}

    @property
    def standing(self) -> MachineLoads | None:
        """The same where there is a cabinet."""
        return self if self.stands else None

    @property
    def floor_force(
        self,
    ) -> Annotated[Array, Q("N", "vertical force of the floor", "largest", when="standing")]:
        return self.worst.floor_force[self.asked]

    @property
    def floor_force_least(
        self,
    ) -> Annotated[Array, Q("N", "vertical force of the floor", "least", when="standing")]:
        return self.worst.floor_force_least[self.asked]

    @property
    def floor_force_rest(
        self,
    ) -> Annotated[Array, Q("N", "vertical force of the floor", "at rest", when="standing")]:
        return self.rest

    @property
    def lift_off_margin(self) -> Annotated[Array, Q("1", "margin against lift-off", when="standing")]:
        return self.worst.lift_off[self.asked]

    @property
    def slip_margin(self) -> Annotated[Array, Q("1", "margin against slip", when="standing")]:
        return self.worst.slip[self.asked]

    @property
    def walking_margin(
        self,
    ) -> Annotated[Array | float, Q("1", "margin against walking", "over time the least", when="standing")]:
        return self.walking.value if self.in_time else self.worst.walking[self.asked]

    @property
    def walking_margin_over_time(
        self,
    ) -> Annotated[Array | None, Q("1", "margin against walking", when="walking_margin_over_time")]:
        return self.worst.walking[self.asked] if self.in_time and self.stands else None

    @property
    def worst_cases(self) -> Annotated[dict[str, Any], Q(text="worst of each and where it is", key="worst")]:
        w = self.worst
        found: dict[str, Any] = {
            "clearance": self.clearances,
            "displacement": self._largest(self.points, w.moved),
            "mount_force": self._largest(self.holders, w.holder),
            "bearing_force": self._largest(self.bearings, w.bearing),
            "motor_torque": self.largest(self.torque),
            "motor_power": self.largest(self.power),
        }
        if self.stands:
            found |= {"floor_force": self.feet, "walking_margin": self.walking}
        return found

    def _largest(self, names: tuple[str, ...], values: Array) -> dict[str, Worst]:
        return {name: self.largest(values[:, k]) for k, name in enumerate(names)}

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
                for name, values in zip(("major", "minor"), self.semi_axes, strict=True):
                    text = f"{name} semi-axis of the orbit"
                    found[f"point_{name}"] = var((over, "point"), values[rows], "m", text)
        if self.in_time and self.bearings:
            text = "of a pool-annulus transition"
            found["handover_time"] = var(("handover",), self.jumps, "s", "time", text)
            found["bearing_impulse"] = var(
                ("handover", "bearing"), self.impulse, "N s", "impulse on the bearing", text
            )
        if self.bearing_life is not None:
            for name, q in quantities(BearingLife).items():
                values = getattr(self.bearing_life, name)
                found[f"bearing_life_{name}"] = var(q.over, values, q.unit, q.name, q.text)
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


@dataclass(frozen=True)
class LoadRow:
    """One line of the table."""

    label: str  #: what it is
    size: str  #: its worst, with the unit
    speed: str  #: where that is, rpm and s; no time over speed
    time: str
    remark: str  #: what it is beside
    failed: bool = False  #: it must not be


def load_rows(loads: MachineLoads) -> list[LoadRow]:
    """The worst of each quantity, what matters most first."""
    found = [_clearance(loads, name, worst) for name, worst in loads.clearances.items()]
    if loads.stands:
        walking = loads.walking
        size = _percent(walking.value) if math.isfinite(walking.value) else NOT_FOUND
        text = "100 % at rest; at 0 a foot slips or lifts off"
        found.append(_row("Margin against walking", walking, size, text, walking.value <= 0.0))
        for k, worst in enumerate(loads.feet):
            text = f"{number(float(loads.rest[k]))} N at rest"
            found.append(_row(f"Foot {k + 1}, largest force", worst, _newton(worst), text))
    for k, name in enumerate(loads.points):
        worst = loads.largest(loads.worst.moved[:, k])
        found.append(_row(f"Movement of {name}", worst, _length(worst.value), "from where it rests"))
    for kind in ("spring", "damper", "support", "bearing"):
        found += _strongest(loads, kind)
    found += _blow(loads)
    worst = loads.largest(loads.torque)
    found.append(_row("Motor, torque", worst, _sized(worst.value, "N m"), _share(loads)))
    worst = loads.largest(loads.power)
    found.append(_row("Motor, power", worst, _sized(worst.value, "W"), ""))
    return found


def _blow(loads: MachineLoads) -> list[LoadRow]:
    """The largest impulse of liquid that is caught or falls on a bearing; nothing where there was none."""
    if not loads.bearings or not np.isfinite(loads.impulse).any():
        return []
    k, j = np.unravel_index(np.nanargmax(loads.impulse), loads.impulse.shape)
    time = float(loads.jumps[k])
    worst = Worst(float(loads.impulse[k, j]), float(np.interp(time, loads.time, loads.speed)), time)
    said = f"of liquid that is caught or falls, on {loads.bearings[j]}"
    return [_row("Bearing, largest impulse", worst, f"{number(worst.value)} N s", said)]


def _share(loads: MachineLoads) -> str:
    """What the torque is for."""
    if loads.in_time:
        return "to speed up the drum and the liquid, and for the dampers"
    return "at constant speed, for dampers and liquid"


def _clearance(loads: MachineLoads, name: str, worst: Worst) -> LoadRow:
    gap = float(loads.gaps[loads.points.index(name)])
    touches = worst.value <= 0.0
    text = f"of {with_unit(gap, LENGTH)} at rest" + (": it touches" if touches else "")
    return _row(f"Clearance of {name}", worst, _length(worst.value), text, touches)


def _strongest(loads: MachineLoads, kind: str) -> list[LoadRow]:
    """The part of a kind with the largest force; nothing where there is none."""
    names = loads.bearings if kind == "bearing" else loads.holders
    values = loads.worst.bearing if kind == "bearing" else loads.worst.holder
    found = [(name, loads.largest(values[:, k])) for k, name in enumerate(names) if name.startswith(kind)]
    known = [(name, worst) for name, worst in found if not math.isnan(worst.value)]
    if not known:
        return []
    name, worst = max(known, key=lambda entry: entry[1].value)
    label = f"{kind.capitalize()}, largest force"
    return [_row(label, worst, _newton(worst), f"in {name}" if len(found) > 1 else "")]


def _row(label: str, worst: Worst, size: str, remark: str, failed: bool = False) -> LoadRow:
    time = "" if math.isnan(worst.time) else number(worst.time)
    speed = number(worst.speed * RPM) if math.isfinite(worst.speed) else ""
    return LoadRow(label, size, speed, time, remark, failed)


def _length(value: float) -> str:
    return with_unit(value, LENGTH) if math.isfinite(value) else _sized(value, "")


def _percent(value: float) -> str:
    size = 100.0 * value
    return f"{size:.0f} %" if abs(size) >= 10.0 else f"{number(float(f'{size:.2g}'))} %"


def _newton(worst: Worst) -> str:
    return _sized(worst.value, "N")


def _sized(value: float, unit: str) -> str:
    if math.isnan(value):
        return NOT_FOUND
    return f"{number(value)} {unit}" if math.isfinite(value) else "without bound"


def verdict(loads: MachineLoads) -> str:
    """Whether the machine stays where it is and whole, in a sentence or two; empty where nothing tells."""
    told = []
    if loads.stands and not math.isnan(loads.walking.value):
        left = f"{_percent(loads.walking.value)} sliding margin at {in_rpm(loads.walking.speed)}"
        if loads.walking.value <= 0.0:
            told.append(f"The machine walks: a foot slips or lifts off at {in_rpm(loads.walking.speed)}.")
        elif loads.walking.value < LITTLE:
            told.append(f"The machine is near walking, with {left}.")
        else:
            told.append(f"The machine does not walk: it has {left}.")
    known = {name: worst for name, worst in loads.clearances.items() if not math.isnan(worst.value)}
    touching = [name for name, worst in known.items() if worst.value <= 0.0]
    if touching:
        told.append(f"It touches its housing: {', '.join(touching)}.")
    elif known:
        name = min(known, key=lambda point: known[point].value)
        least = known[name]
        told.append(f"The least clearance is {_length(least.value)}, {name}, at {in_rpm(least.speed)}.")
    return " ".join(told)


def bearing_tables(loads: MachineLoads) -> list[Table]:
    """Life, slip and wear of the bearings with a rating at the last speed; none without one."""
    found, rows = loads.bearing_life, []
    if found is None:
        return []
    for k, name in enumerate(loads.bearings):
        if math.isnan(found.least_load[k, -1]):
            continue
        size = (f"{number(float(each[k, -1]))} N" for each in (found.load, found.load_dry, found.least_load))
        slip, life = float(found.slip[k, -1]), float(found.life_hours[k, -1])
        wear = float(found.wear_volume[k, -1]) * 1e9
        told = NOT_FOUND if math.isnan(slip) else _percent(slip)
        worn = "balls not given" if math.isnan(wear) else f"{number(wear)} mm3"
        rows.append((name, *size, told, worn, f"{number(life)} h" if math.isfinite(life) else "no end"))
    speed = in_rpm(float(loads.speed[loads.asked[-1]]))
    head = ("Bearing", "load", "without liquid", "least load", "cage slip", "wear in an hour", "rating life")
    return [Table(rows, head, title=f"Ball bearings at {speed}")]


def load_table(loads: MachineLoads) -> Table:
    """The worst of each, below what it comes to."""
    time = ("after (s)",) if loads.in_time else ()
    rows = [
        (
            # A number keeps its unit beside it.
            *(row.label, Cell(row.size.replace(" ", "\N{NO-BREAK SPACE}"), warning=row.failed), row.speed),
            *((row.time,) if time else ()),
            row.remark,
        )
        for row in load_rows(loads)
    ]
    return Table(rows, ("Machine", "worst", "at (rpm)", *time, ""), title=verdict(loads))
