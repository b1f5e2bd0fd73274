"""The map of self-excited whirl over spin speed and liquid volume."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
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
from leblanc.core.units import LENGTH, RPM, VOLUME, in_rpm, number, unit_for, with_unit
from leblanc.studies.cycles.answer import Cycle, Cycles
from meshes.arrays import Array, Flags
from meshes.quantity import Q

if TYPE_CHECKING:
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
        return f"{self.name}: {self.volume.size} volumes by {self.speed.size} speeds done"

    def blocks(self) -> tuple[Block, ...]:
        low, high = (number(float(speed) * RPM) for speed in (self.speed[0], self.speed[-1]))
        most = with_unit(float(self.volume[-1]), VOLUME)
        about = f"Whirls that grow by themselves from {low} to {high} rpm, from no liquid to {most}."
        pictures, models = [Picture("map", self.title, self.figure)], [Words(LINEAR, "linear", small=True)]
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
    if not (found.growth > 0.0).any():
        if found.not_known == found.growth.size:
            return "It is not known whether whirl is self-excited at any speed with any volume of liquid."
        where = (
            "where it is known, which is not everywhere" if found.not_known else "with any volume of liquid"
        )
        return f"No self-excited whirl at any speed {where}."
    values = dict(facts(found))
    own = f"with the scene's {with_unit(found.scene_volume, VOLUME)}"
    bands = f"from {band_words(found.scene_edges)} rpm" if found.scene_edges else "nowhere"
    largest = _largest(found)
    grown = f", up to {largest}" if largest else ""
    return (
        f"Self-excited whirl at {values['A whirl grows at']}, fastest by {values['Fastest growth']}; "
        f"{own} it grows {bands}{grown}."
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
    growth, size = found.growth, found.growth.size
    unstable = growth > 0.0
    fastest, turning = "none grows", "none grows"
    if unstable.any():
        row, column = np.unravel_index(int(np.nanargmax(growth)), growth.shape)
        speed, volume = float(found.speed[column]), float(found.volume[row])
        at = f"{in_rpm(speed)}, {with_unit(volume, VOLUME)}"
        fastest = f"{number(float(growth[row, column]))} 1/s at {at}"
        turning = f"{number(float(found.whirl_speed[row, column]) / speed)} of the spin"
    own = f"Bands with the scene's {with_unit(found.scene_volume, VOLUME)} (rpm)"
    return [
        ("Volumes by speeds", f"{found.volume.size} by {found.speed.size}"),
        ("Most liquid, all chambers", with_unit(float(found.volume[-1]), VOLUME)),
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
    """Bands of speed in which a whirl grows, for a few volumes spread over the map."""
    rows, unit = [], unit_for(VOLUME, *found.volume.tolist())
    for k in np.unique(np.linspace(0, found.volume.size - 1, LISTED).round().astype(int)).tolist():
        known = found.growth[k][~np.isnan(found.growth[k])]
        words = Cell(band_words(found.edges[k]), warning=known.size < found.speed.size)
        most = number(float(known.max()) if known.size else math.nan)
        rows.append((unit.number(float(found.volume[k])), words, most))
    head = (f"Liquid ({unit.name})", "a whirl grows between (rpm)", "largest growth (1/s)")
    return Table(rows, head, shown="page")


def alt(found: WhirlMap) -> str:
    """What the figure shows and the numbers a reader would take from it."""
    values = dict(facts(found))
    return (
        "Map of the growth rate over speed and liquid, and of the whirl's speed where one grows; one grows "
        f"at {values['A whirl grows at']}, fastest: {values['Fastest growth']}."
    )


def cycles_alt(found: WhirlMap) -> str:
    """What the figure of limit cycles shows and the numbers a reader would take from it."""
    values = dict(cycle_facts(found))
    return (
        "Curves of the amplitude and, below, of the frequency of self-excited whirls over speed, the stable "
        f"ones in full lines. Largest: {values['Largest stable whirl']}; folds: {values['Folds']}."
    )
