"""The map of self-excited whirl over spin speed and liquid volume, or another number of the machine."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from leblanc.core.answer import Answer
from leblanc.core.blocks import (
    Block,
    Cell,
    Check,
    Checks,
    Columns,
    Headline,
    Notes,
    Picture,
    Section,
    Table,
    Words,
    check,
)
from leblanc.core.notes import Note, texts
from leblanc.core.units import LENGTH, RPM, VOLUME, Dimension, Unit, in_rpm, number, unit_for, with_unit
from leblanc.studies.cycles.answer import Cycle, Cycles
from meshes.arrays import Array, Flags
from meshes.quantity import Q

if TYPE_CHECKING:
    from leblanc.core.netcdf import NamedArrays
    from solvers.whirl.edges import Bands

MOST_LOST = 0.01  # of the points, at which a map still is one; they are marked
MOST_BANDS = 4  # listed one by one
LISTED = 11  # volumes of the table of bands
LINEAR = (
    "Free whirls of rotor and liquid together, by the exact linear theory of the plane layer with laminar or "
    "linear friction at its wall; shown is the fastest-growing whirl. Taken for granted: small whirls, a wet "
    "wall all round, one depth along the axis."
)
CYCLES = (
    "Nonlinear long waves that stand in the whirl's frame, rotor and every cell of every layer solved at "
    "once; stability by Floquet multipliers."
)
FAMILY = (
    "KdV-Burgers for the waves against the spin, linear waves with it, on liquid that lags behind the drum "
    "as the whirl's torque and the wall's drag leave it; rotor, modes and lag of every layer solved at once."
)
REASON = "No other model answers this for any growth and any whirl speed."
_OVER, _BANDS, _RATE = ("volume", "speed"), ("volume", "band"), "rad s-1"
_MODE = "of the fastest-growing whirl"
_EDGE = "of a band in which a whirl grows; the ends of the range of speeds count as edges"


@dataclass(frozen=True)
class WhirlMap(Answer):
    """Growth of self-excited whirl; n speeds, v volumes.

    Examples
    --------
    >>> import leblanc as lb
    >>> whirl = lb.map_whirl(lb.example("horizontal_rig"), volumes=3, speeds=5)
    >>> whirl.volume.shape, whirl.speed.shape, whirl.growth.shape
    ((3,), (5,), (3, 5))
    """

    command = "map"
    title = "Self-excited whirl over speed and volume"
    data = "map.nc"
    page = "map.html"
    unused = ("runup", "optimise")
    figure = "leblanc.studies.map.figure:map_figure"

    name: Annotated[str, Q(text="of the scene")]
    source: str
    assumed: Annotated[tuple[str, ...], Q(text="values that no source gives")]
    digest: Annotated[str, Q(text="of the scene")]
    speed: Annotated[Array, Q(_RATE, "spin speed", "of the rotor about its axis", over=("speed",))]
    volume: Annotated[Array, Q("m3", "volume", "of liquid in all chambers together", over=("volume",))]
    #: 0 if it is below rounding, nan if not found, shape (v, n)
    growth: Annotated[Array, Q("s-1", "growth rate", f"{_MODE}; above 0 unstable", over=_OVER)]
    #: positive with the spin, shape (v, n)
    whirl_speed: Annotated[Array, Q(_RATE, "whirl speed", f"{_MODE}, in space", over=_OVER)]
    in_range: Annotated[
        Flags, Q(name="in range", text="the plane layer holds there", over=_OVER, flags="no yes")
    ]
    edges: Annotated[
        tuple[Bands, ...],
        Q(
            "rad s-1",
            text="for each volume the bands of speed in which a whirl grows, or which the range cuts",
            data=False,
        ),
    ]
    friction: Annotated[str, Q(text="of the liquid")]
    damping: Annotated[str, Q(text="of the support")]
    scene_volume: Annotated[float, Q("m3", "volume of the scene as it stands", data=False)]
    scene_edges: Annotated[Bands, Q("rad s-1", text="bands with that volume", data=False)]
    notes: Annotated[tuple[Note, ...], Q(text="limits of validity and findings")]
    edges_not_known: Annotated[
        tuple[Bands, ...],
        Q(
            "rad s-1",
            text="for each volume the bands between the nearest speeds at which the growth is known",
            data=False,
        ),
    ] = ()
    capacity: Annotated[float, Q("m3", "what the chambers that take liquid hold together", data=False)] = (
        math.nan
    )
    #: of several the one at which the unbalance moves the chambers most, nan where there is none
    critical_speed_dry: Annotated[float, Q(_RATE, "critical speed without liquid", data=False)] = math.nan
    #: of the scene as it stands; None where they were not asked for
    large: Annotated[Cycles | None, Q(part=True)] = None
    depth: float = math.nan  #: of the scene's deepest layer, m
    #: of the number on the second axis in place of the volume; empty for that
    paths: Annotated[tuple[str, ...], Q(text="of what varies in place of the volume", when="paths")] = ()
    value: Annotated[Array | None, Q("{0.si}", "{0.paths[0]}", "varied", over=("volume",), when="paths")] = (
        None
    )
    scene_value: Annotated[float, Q(text="what the scene has there, SI", when="paths")] = math.nan
    dimension: Dimension | None = None  #: of these values; None of volumes
    log: bool = False  #: they are spaced by their logarithms

    @property
    def si(self) -> str:
        """Unit of the values in the data file."""
        return (self.dimension and self.dimension.unit) or "1"

    @property
    def second(self) -> tuple[str, Array, Unit]:
        """Name, values and unit for print of the second axis."""
        if self.value is None or self.dimension is None:
            return "liquid", self.volume, unit_for(VOLUME, *self.volume.tolist())
        more = f" and {len(self.paths) - 1} more" if len(self.paths) > 1 else ""
        return self.paths[0] + more, self.value, unit_for(self.dimension, *self.value[[0, -1]].tolist())

    def named_arrays(self) -> NamedArrays:
        """Over what varies, whatever it is."""
        found = super().named_arrays()
        if self.value is None:
            return found
        moved = {
            name: replace(each, dims=tuple("value" if dim == "volume" else dim for dim in each.dims))
            for name, each in found.variables.items()
        }
        return replace(found, variables=moved)

    @property
    def not_known(self) -> Annotated[int, Q("1", "points without a known growth", data=False)]:
        return int(np.count_nonzero(np.isnan(self.growth)))

    @property
    def edge_low(self) -> Annotated[Array, Q(_RATE, "lower edge", _EDGE, over=_BANDS, json=False)]:
        return self._edge(0)

    @property
    def edge_high(self) -> Annotated[Array, Q(_RATE, "upper edge", _EDGE, over=_BANDS, json=False)]:
        return self._edge(1)

    def _edge(self, end: int) -> Array:
        """Volumes with fewer bands than others have nan."""
        found = np.full((self.volume.size, max(map(len, self.edges), default=0)), np.nan)
        for row, bands in zip(found, self.edges, strict=True):
            row[: len(bands)] = [band[end] for band in bands]
        return found

    @property
    def own(self) -> Mapping[str, Any]:
        return {"friction": self.friction, "damping": self.damping}

    @property
    def faults(self) -> tuple[str, ...]:
        lost = f"growth not known at {self.not_known} of {self.growth.size} points, marked in the map"
        return (lost,) if self.not_known > MOST_LOST * self.growth.size else ()

    @property
    def closing(self) -> str:
        what = "volumes" if self.value is None else "values"
        return f"{self.name}: {self.volume.size} {what} by {self.speed.size} speeds done"

    def blocks(self) -> tuple[Block, ...]:
        low, high = (number(float(speed) * RPM) for speed in (self.speed[0], self.speed[-1]))
        name, values, unit = self.second
        span = f"from no liquid to {unit.text(float(values[-1]))}"
        if self.value is not None:
            span = f"with {name} from {unit.text(float(values[0]))} to {unit.text(float(values[-1]))}"
        about = f"Whirls that grow by themselves from {low} to {high} rpm, {span}."
        title = self.title if self.value is None else f"Self-excited whirl over speed and {name}"
        pictures, models = [Picture("map", title, self.figure)], [Words(LINEAR, "linear", small=True)]
        if self.cycles:
            draw = "leblanc.studies.map.figure:cycles_figure"
            pictures.append(Picture("cycles", "How large the whirl grows, over speed", draw))
            by_family = self.large is not None and self.large.wave == "kdv"
            models.append(
                Words(FAMILY if by_family else CYCLES, "kdv" if by_family else "long_wave", small=True)
            )
        tables = Columns(
            (Table(facts(self), indent=2), Checks(checks(self), shown="page")), (bands_table(self),)
        )
        return (
            Headline(sentence(self), about, shown="both"),
            Section("Results", (*pictures, tables), width="120mm"),
            Section("Liquid model, and why", (*models, Words(REASON, small=True)), shown="page"),
            Notes(texts(self.notes)),
        )


def sentence(found: WhirlMap) -> str:
    """Where a whirl grows."""
    any_row = "with any volume of liquid" if found.value is None else f"with any {found.second[0]}"
    if not (found.growth > 0.0).any():
        if found.not_known == found.growth.size:
            return f"It is not known whether whirl is self-excited at any speed {any_row}."
        where = "where it is known, which is not everywhere" if found.not_known else any_row
        return f"No self-excited whirl at any speed {where}."
    values = dict(facts(found))
    own = f"with {_scene_row(found)}"
    bands = f"from {band_words(found.scene_edges)} rpm" if found.scene_edges else "nowhere"
    largest = _largest(found)
    grown = f", up to {largest}" if largest else ""
    return (
        f"Self-excited whirl at {values['A whirl grows at']}, fastest by {values['Fastest growth']}; "
        f"{own} it grows {bands}{grown}."
    )


def _scene_row(found: WhirlMap) -> str:
    """The scene's own place on the second axis."""
    if found.value is None:
        return f"the scene's {with_unit(found.scene_volume, VOLUME)}"
    name, _, unit = found.second
    return (
        f"the scene's {name} of {unit.text(found.scene_value)}" if found.scene_value > 0.0 else "the scene's"
    )


def _within(found: WhirlMap) -> list[Cycle]:
    """Limit cycles at the speeds of the map, without those on the way to them."""
    # The whirl at the end of the range is there up to rounding.
    first, last = float(found.speed[0]) * (1.0 - 1e-9), float(found.speed[-1]) * (1.0 + 1e-9)
    return [row for row in found.cycles or () if first <= row.speed <= last]


def _largest(found: WhirlMap) -> str:
    """Amplitude of the largest stable whirl, and its speed; empty where there is none."""
    stable = [row for row in _within(found) if row.stable]
    row = max(stable, key=lambda row: row.amplitude, default=None)
    return "" if row is None else f"{with_unit(row.amplitude, LENGTH)} at {in_rpm(row.speed)}"


def cycle_facts(found: WhirlMap) -> list[tuple[str, str]]:
    """What the limit cycles say in numbers: label and value; nothing where there are none."""
    rows = _within(found)
    if found.large is None or not rows:
        return []
    stable = [row for row in rows if row.stable]
    folds = [f"{in_rpm(fold.speed)} at {with_unit(fold.amplitude, LENGTH)}" for fold in found.large.folds]
    said = [
        ("Whirls of finite size", f"{len(rows)} on {len(found.large.branches)} branches"),
        ("Largest stable whirl", _largest(found) or "none is stable"),
    ]
    if stable:
        power = max(stable, key=lambda row: row.power)
        ends = [number(f(row.speed for row in stable) * RPM) for f in (min, max)]
        turning = [number(f(row.whirl_speed for row in stable) * RPM) for f in (min, max)]
        lag = max(row.lag / row.speed for row in stable)
        said += [
            ("Stable whirls (rpm)", " to ".join(ends)),
            ("They go round in space with (rpm)", " to ".join(turning)),
            ("Their liquid lags by up to", f"{number(100.0 * lag)} % of the spin"),
            ("Power of the drive on top", f"up to {number(power.power)} W at {in_rpm(power.speed)}"),
        ]
    return [*said, ("Folds", "; ".join(folds) or "none in this range")]


def band_words(bands: Sequence[tuple[float, float]]) -> str:
    """Ranges of speed in which a whirl grows."""
    parts = [f"{number(low * RPM)} to {number(high * RPM)}" for low, high in bands]
    if len(parts) > MOST_BANDS:
        return f"{len(parts)} bands between {number(bands[0][0] * RPM)} and {number(bands[-1][1] * RPM)}"
    return "; ".join(parts) or "none"


def facts(found: WhirlMap) -> list[tuple[str, str]]:
    """What the map says in numbers: label and value."""
    growth, size, (_, values, unit) = found.growth, found.growth.size, found.second
    unstable = growth > 0.0
    fastest, turning = "none grows", "none grows"
    if unstable.any():
        row, column = np.unravel_index(int(np.nanargmax(growth)), growth.shape)
        speed = float(found.speed[column])
        at = f"{in_rpm(speed)}, {unit.text(float(values[row]))}"
        fastest = f"{number(float(growth[row, column]))} 1/s at {at}"
        turning = f"{number(float(found.whirl_speed[row, column]) / speed)} of the spin"
    own = f"Bands with {_scene_row(found)} (rpm)"
    first = [
        ("Volumes by speeds", f"{found.volume.size} by {found.speed.size}"),
        ("Most liquid, all chambers", with_unit(float(found.volume[-1]), VOLUME)),
    ]
    if found.value is not None:
        span = f"{unit.text(float(values[0]))} to {unit.text(float(values[-1]))}"
        first = [
            ("Values by speeds", f"{found.volume.size} by {found.speed.size}"),
            (f"Over {', '.join(found.paths)}", span),
        ]
    return [
        *first,
        ("A whirl grows at", f"{number(100.0 * float(np.count_nonzero(unstable)) / size)} % of the points"),
        *([("Growth not known at", f"{found.not_known} of {size} points")] if found.not_known else []),
        ("Fastest growth", fastest),
        ("That whirl's speed in space", turning),
        (own, band_words(found.scene_edges)),
        ("Friction of the liquid", found.friction),
        ("Support", found.damping),
        *cycle_facts(found),
    ]


def checks(found: WhirlMap) -> list[Check]:
    """Where the map is not what it seems, in shares of its points."""
    lost, out = np.isnan(found.growth), ~found.in_range
    rows = [
        check(label, _share(mask), mask.any())
        for label, mask in (
            ("Growth not known", lost),
            ("Model out of range", out),
            ("Grows where out of range", out & (found.growth > 0.0)),
        )
    ]
    own = found.scene_edges
    return [*rows, check("Unstable with the scene's volume (rpm)", band_words(own), own)]


def _share(mask: Flags) -> str:
    """How many of the points."""
    count = int(np.count_nonzero(mask))
    return f"{count} of {mask.size} points ({number(100.0 * count / mask.size)} %)" if count else "none"


def bands_table(found: WhirlMap) -> Table:
    """Bands of speed in which a whirl grows, for a few rows spread over the map."""
    rows, (name, values, unit) = [], found.second
    for k in np.unique(np.linspace(0, found.volume.size - 1, LISTED).round().astype(int)).tolist():
        known = found.growth[k][~np.isnan(found.growth[k])]
        words = Cell(band_words(found.edges[k]), warning=known.size < found.speed.size)
        most = number(float(known.max()) if known.size else math.nan)
        rows.append((unit.number(float(values[k])), words, most))
    label = name.capitalize() if found.value is None else name
    head = (f"{label} ({unit.name or '-'})", "a whirl grows between (rpm)", "largest growth (1/s)")
    return Table(rows, head, shown="page")


def alt(found: WhirlMap) -> str:
    """What the figure shows and the numbers a reader would take from it."""
    values = dict(facts(found))
    return (
        f"Map of the growth rate over speed and {found.second[0]}, and of the whirl's speed where one grows; "
        f"one grows at {values['A whirl grows at']}, fastest: {values['Fastest growth']}."
    )


def cycles_alt(found: WhirlMap) -> str:
    """What the figure of limit cycles shows and the numbers a reader would take from it."""
    values = dict(cycle_facts(found))
    return (
        "Curves of the amplitude and, below, of the frequency of self-excited whirls over speed, the stable "
        f"ones in full lines. Largest: {values['Largest stable whirl']}; folds: {values['Folds']}."
    )
