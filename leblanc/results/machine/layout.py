"""Where the springs and dampers of a tub sit best, beside where they sit."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any, ClassVar

import numpy as np

from leblanc.core.answer import Result, attributes
from leblanc.core.netcdf import NamedArrays
from leblanc.core.netcdf import variable as var
from leblanc.results.base import ConstraintValue
from meshes.arrays import Array
from solvers.rotor.layout import COORDINATES, PAIRS

Vector = tuple[float, ...]


@dataclass(frozen=True)
class MountPlace:
    """A spring or damper before and after."""

    name: str  #: "spring 1" and so on, in the order of the scene
    position: Vector  #: from the tub's centre of mass, m
    position_before: Vector
    direction: Vector | None  #: of length 1; None where it acts along x, y and z
    direction_before: Vector | None


@dataclass(frozen=True)
class LayoutResult(Result):
    """The best layout of a tub's mounts within bounds [theory: rotor, eq. 36-38].

    Arrays have the scene's own layout first and the best one second; couplings are in the order of
    `solvers.rotor.layout.PAIRS`.

    Examples
    --------
    >>> import leblanc as lb
    >>> best = lb.optimise(lb.example("tub"), objective="layout")
    >>> bool(best.value < best.baseline), best.mirrored
    (True, True)
    """

    figure: ClassVar[str] = "leblanc.figures.machine:layout_figure"
    summary: ClassVar[str] = "leblanc.text.layout:facts"

    name: str  #: of the scene
    measure: str  #: "couplings" or "separation"
    band: tuple[float, float] | None  #: running speeds, rad/s
    value: float  #: what is made least, of the best layout and of the scene's own
    baseline: float
    constraints: dict[str, ConstraintValue]  #: by name
    sag_before: float  #: of the scene's own layout, m
    mounts: tuple[MountPlace, ...]  #: springs, then dampers
    #: of "stiffness" and "damping" about the centre of mass, each -1 to 1, shape (2, 15)
    couplings: dict[str, Array]
    mass_couplings: Array  #: of the mass matrix, which no mount changes, shape (15,)
    frequency: Array  #: natural frequencies at rest without damping, rising, rad/s, shape (2, 6)
    origin: Array  #: centre of mass of tub and drum from that of the tub, m, shape (3,)
    mirrored: bool  #: springs and dampers are alike on both sides of x = 0, and stay so
    evaluations: int  #: layouts judged
    source: str = ""  #: of the scene
    assumed: tuple[str, ...] = ()
    digest: str = ""

    @property
    def objective(self) -> str:
        """What `optimise` was asked for."""
        return "layout"

    @property
    def feasible(self) -> bool:
        """Every constraint is kept."""
        return all(constraint.satisfied for constraint in self.constraints.values())

    @property
    def natural_frequency(self) -> dict[str, list[float]]:
        """At rest without damping, rad/s, of the scene's own layout and of the best one."""
        return {"before": self.frequency[0].tolist(), "after": self.frequency[1].tolist()}

    @property
    def coupling_terms(self) -> dict[str, dict[str, list[float]]]:
        """Couplings before and after by matrix and pair of coordinates; those of the mass do not change."""
        tables = {**self.couplings, "mass": np.stack([self.mass_couplings] * 2)}
        return {
            name: {pair: column.tolist() for pair, column in zip(pair_names(), table.T, strict=True)}
            for name, table in tables.items()
        }

    def to_json(self) -> dict[str, Any]:
        """What `optimise --objective layout` prints for scripts, SI."""
        names = ("name", "objective", "measure", "value", "baseline", "feasible", "evaluations", "mirrored")
        return {
            **{name: getattr(self, name) for name in names},
            "band": None if self.band is None else list(self.band),
            "constraints": {name: asdict(each) for name, each in self.constraints.items()},
            "sag_before": self.sag_before,
            "mounts": [asdict(mount) for mount in self.mounts],
            "coupling_terms": self.coupling_terms,
            "natural_frequency": self.natural_frequency,
            "origin": self.origin.tolist(),
            "digest": self.digest,
        }

    def named_arrays(self) -> NamedArrays:
        """Arrays over the dimensions `layout` (before, after), `mount`, `pair`, `mode` and `axis`."""
        both = ("layout",)
        places = np.array([[mount.position_before, mount.position] for mount in self.mounts])
        none = (np.nan,) * 3
        ways = np.array([[m.direction_before or none, m.direction or none] for m in self.mounts])
        sags = np.array([self.sag_before, self.constraints["sag"].value])
        values = np.array([self.baseline, self.value])
        found = {
            "mount": var(("mount",), np.array([m.name for m in self.mounts], dtype=object), "1", "name"),
            "position": var(("mount", "layout", "axis"), places, "m", "place", "from the tub's centre"),
            "direction": var(("mount", "layout", "axis"), ways, "1", "direction"),
            "value": var(both, values, "1", self.measure, "what is made least"),
            "sag": var(both, sags, "m", "sag", "of tub and drum under their weight"),
            "frequency": var((*both, "mode"), self.frequency, "rad s-1", "natural frequency", "at rest"),
            "origin": var(("axis",), self.origin, "m", "centre of mass", "of tub and drum"),
            "pair": var(("pair",), np.array(pair_names(), dtype=object), "1", "pair of coordinates"),
            "mass_coupling": var(("pair",), self.mass_couplings, "1", "coupling of the mass"),
        }
        for name, table in self.couplings.items():
            found[f"{name}_coupling"] = var((*both, "pair"), table, "1", f"coupling of the {name}")
        return NamedArrays(found, coords={}, attrs=attributes(self, "optimise", {}, ()))


def pair_names() -> tuple[str, ...]:
    """Pairs of coordinates as printed: "x-beta" and so on."""
    return tuple(f"{COORDINATES[i]}-{COORDINATES[j]}" for i, j in PAIRS)
