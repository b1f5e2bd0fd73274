"""The map of self-excited whirl over spin speed and liquid volume: what `map` answers."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from leblanc.core.answer import Result, attributes
from leblanc.core.netcdf import NamedArrays, flags
from leblanc.core.netcdf import variable as var
from leblanc.core.notes import Note, texts
from leblanc.results.motion.cycles import cycle_arrays, cycle_rows, fold_rows
from meshes.arrays import Array, Flags

if TYPE_CHECKING:
    from solvers.cycles.cycles import Branch
    from solvers.whirl.edges import Bands


@dataclass(frozen=True)
class WhirlMap(Result):
    """Growth of self-excited whirl; n speeds, v volumes.

    Examples
    --------
    >>> import leblanc as lb
    >>> whirl = lb.map_whirl(lb.example("horizontal_rig"), volumes=3, speeds=5)
    >>> whirl.volume.shape, whirl.speed.shape, whirl.growth.shape
    ((3,), (5,), (3, 5))
    """

    figure: ClassVar[str] = "leblanc.figures.whirl_map:map_figure"
    summary: ClassVar[str] = "leblanc.text.whirl_map:facts"

    name: str  #: of the scene
    source: str
    assumed: tuple[str, ...]
    digest: str
    speed: Array  #: spin speed Omega, rad/s, shape (n,)
    volume: Array  #: liquid in all chambers together, m^3, shape (v,)
    #: of the whirl that grows most, 1/s, 0 if it is below rounding, nan if not found, shape (v, n)
    growth: Array
    whirl_speed: Array  #: of that whirl in the standing frame, rad/s, positive with the spin, shape (v, n)
    in_range: Flags  #: the plane layer describes the liquid there, shape (v, n)
    #: for each volume the bands of speed in which a whirl grows, rad/s; an end that is the first or last
    #: speed is where the range ends
    edges: tuple[Bands, ...]
    friction: str  #: of the liquid, of the support, in words
    damping: str
    scene_volume: float  #: of the scene as it stands, m^3 and as in `edges`
    scene_edges: Bands
    notes: tuple[Note, ...]  #: limits of validity and findings
    #: for each volume the bands of speed in which the growth is not known, between the nearest speeds where
    #: it is, rad/s
    edges_not_known: tuple[Bands, ...] = ()
    capacity: float = math.nan  #: what the chambers that take liquid hold together, m^3
    #: without liquid; of several the one at which the unbalance moves the chambers most, nan where there is
    #: none, rad/s
    critical_speed_dry: float = math.nan
    #: of limit cycles of the scene as it stands; None where they were not asked for
    branches: tuple[Branch, ...] | None = None
    depth: float = math.nan  #: of the scene's deepest layer, m

    @property
    def not_known(self) -> int:
        """How many points have no known growth."""
        return int(np.count_nonzero(np.isnan(self.growth)))

    @property
    def cycles(self) -> list[dict[str, Any]]:
        """Self-excited whirls of finite size, see `leblanc.results.motion.cycles.cycle_rows`."""
        return cycle_rows(self.branches or ())

    @property
    def folds(self) -> list[dict[str, Any]]:
        """Where branches turn back in speed: `branch`, `speed` and `amplitude`, SI."""
        return fold_rows(self.branches or ())

    def to_json(self) -> dict[str, Any]:
        """What `map` prints for scripts, SI: rows of `growth`, `whirl_speed`, `in_range` follow `volume`."""
        names = ["speed", "volume", "growth", "whirl_speed", "edges", "in_range", "friction", "damping"]
        names += ["scene_volume", "scene_edges", "edges_not_known", "not_known", "capacity"]
        names += ["critical_speed_dry", "name", "digest", "assumed"]
        names += [] if self.branches is None else ["cycles", "folds"]
        return {name: getattr(self, name) for name in names} | {"notes": texts(self.notes)}

    def named_arrays(self) -> NamedArrays:
        """Arrays over the dimensions `volume`, `speed` and `band`; of limit cycles over `cycle` and `fold`.

        Truth values are bytes with `flag_meanings`; volumes with fewer bands than others have nan in
        `edge_low` and `edge_high`.
        """
        over, bands = ("volume", "speed"), max(map(len, self.edges), default=0)
        ends = np.full((self.volume.size, bands, 2), np.nan)
        for row, found in zip(ends, self.edges, strict=True):
            row[: len(found)] = np.reshape(found, (len(found), 2))
        mode = "of the whirl that grows most"
        valid = flags(over, self.in_range, "no yes", "in range", "the plane layer holds there")
        edge = "of a band in which a whirl grows; the ends of the range of speeds count as edges"
        return NamedArrays(
            {
                "growth": var(over, self.growth, "s-1", "growth rate", f"{mode}; above 0 unstable"),
                "whirl_speed": var(over, self.whirl_speed, "rad s-1", "whirl speed", f"{mode}, in space"),
                "in_range": valid,
                "edge_low": var(("volume", "band"), ends[..., 0], "rad s-1", "lower edge", edge),
                "edge_high": var(("volume", "band"), ends[..., 1], "rad s-1", "upper edge", edge),
                **({} if self.branches is None else cycle_arrays(self.branches)),
            },
            coords={
                "speed": var(("speed",), self.speed, "rad s-1", "spin speed", "of the rotor about its axis"),
                "volume": var(("volume",), self.volume, "m3", "volume", "of liquid in all chambers together"),
            },
            attrs=attributes(self, "map", {"friction": self.friction, "damping": self.damping}, self.notes),
        )
