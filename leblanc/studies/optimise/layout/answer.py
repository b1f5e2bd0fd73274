"""The best layout of a tub's springs and dampers, beside where they sit."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from leblanc.core.blocks import Block, Checks, Columns, Headline, Notes, Picture, Table, check
from leblanc.core.netcdf import Variable, variable
from leblanc.core.units import LENGTH, MM, number, with_unit
from leblanc.studies.optimise.answer import Best
from meshes.arrays import Array
from meshes.quantity import Q
from solvers.rotor.layout import COORDINATES, PAIRS

Vector = tuple[float, ...]
_FIGURES = "leblanc.studies.optimise.layout.figure"
_BOTH, _PLACES, _COUPLED = ("layout",), ("mount", "layout", "axis"), ("layout", "pair")
_SHOWN = 5e-4  # couplings below are printed as 0
_REMARKS = (
    "A layout is evaluated at rest and without liquid: frequencies are those without damping and spin, "
    "which couples alpha and gamma whatever the layout.",
    "A coupling is the term of the matrix about the common centre of mass of tub and drum over the root "
    "of the product of those on the diagonal: 0 where two motions are separate, 1 where they are one.",
    "Mounts at one place stay together, and springs and dampers keep their stiffness and damping.",
)
_MIRRORED = "Mounts are alike on both sides of x = 0, and stay so."


@dataclass(frozen=True)
class MountPlace:
    """A spring or damper before and after."""

    name: str  #: "spring 1" and so on, in the order of the scene
    position: Vector  #: from the tub's centre of mass, m
    position_before: Vector
    direction: Vector | None  #: of length 1; None where it acts along x, y and z
    direction_before: Vector | None


@dataclass(frozen=True, kw_only=True)
class LayoutAnswer(Best):
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

    title = "Layout of springs and dampers"
    data, page = "layout.nc", "layout.html"
    figure = f"{_FIGURES}:layout_figure"

    unused: tuple[str, ...] = ("runup", "model")
    measure: Annotated[str, Q(text="what is made least: couplings or separation")]
    band: Annotated[tuple[float, float] | None, Q("rad s-1", name="running speeds", data=False)]
    baseline: Annotated[float, Q(name="value of the scene's own layout, SI")]
    sag_before: Annotated[float, Q("m", "sag of the scene's own layout", data=False)]
    mounts: Annotated[tuple[MountPlace, ...], Q(text="springs, then dampers")]
    #: about the centre of mass, each -1 to 1, shape (2, 15)
    stiffness_coupling: Annotated[Array, Q("1", "coupling of the stiffness", over=_COUPLED, json=False)]
    damping_coupling: Annotated[Array, Q("1", "coupling of the damping", over=_COUPLED, json=False)]
    #: which no mount changes, shape (15,)
    mass_coupling: Annotated[Array, Q("1", "coupling of the mass", over=("pair",), json=False)]
    #: without damping, rising, shape (2, 6)
    frequency: Annotated[
        Array, Q("rad s-1", "natural frequency", "at rest", over=(*_BOTH, "mode"), json=False)
    ]
    origin: Annotated[Array, Q("m", "centre of mass", "of tub and drum", over=("axis",))]
    #: springs and dampers are alike on both sides of x = 0, and stay so
    mirrored: Annotated[bool, Q(name="both sides are alike")]

    @property
    def objective(self) -> Annotated[str, Q(text="what was asked for")]:
        return "layout"

    @property
    def couplings(self) -> dict[str, Array]:
        """Of stiffness and damping."""
        return {"stiffness": self.stiffness_coupling, "damping": self.damping_coupling}

    @property
    def natural_frequency(
        self,
    ) -> Annotated[dict[str, Array], Q("rad s-1", text="at rest without damping", data=False)]:
        return {"before": self.frequency[0], "after": self.frequency[1]}

    @property
    def coupling_terms(
        self,
    ) -> Annotated[dict[str, dict[str, Array]], Q(text="before and after, by matrix and coordinates, SI")]:
        tables = {**self.couplings, "mass": np.stack([self.mass_coupling] * 2)}
        return {name: dict(zip(pair_names(), table.T, strict=True)) for name, table in tables.items()}

    @property
    def mount(self) -> Annotated[Array, Q("1", "name", over=("mount",), json=False)]:
        return np.array([mount.name for mount in self.mounts], dtype=object)

    @property
    def position(
        self,
    ) -> Annotated[Array, Q("m", "place", "from the tub's centre", over=_PLACES, json=False)]:
        return np.array([[mount.position_before, mount.position] for mount in self.mounts])

    @property
    def direction(self) -> Annotated[Array, Q("1", "direction", over=_PLACES, json=False)]:
        none = (np.nan,) * 3
        return np.array([[m.direction_before or none, m.direction or none] for m in self.mounts])

    @property
    def pair(self) -> Annotated[Array, Q("1", "pair of coordinates", over=("pair",), json=False)]:
        return np.array(pair_names(), dtype=object)

    @property
    def sag(
        self,
    ) -> Annotated[Array, Q("m", "sag", "of tub and drum under their weight", over=_BOTH, json=False)]:
        return np.array([self.sag_before, self.constraints["sag"].value])

    @property
    def values(self) -> Annotated[Variable, Q(text="what is made least", variable="value", json=False)]:
        both = np.array([self.baseline, self.value])
        return variable(_BOTH, both, "1", self.measure, "what is made least")

    @property
    def faults(self) -> tuple[str, ...]:
        return () if self.feasible else (self.sentence(),)

    @property
    def closing(self) -> str:
        return f"{self.name}: {self.evaluations} layouts evaluated"

    def blocks(self) -> tuple[Block, ...]:
        about = "for the least couplings of stiffness and damping"
        if self.measure == "separation":
            about = "for natural frequencies far from the running speeds"
        about = f"Places and directions of {len(self.mounts)} springs and dampers of a tub, searched {about}."
        sag = self.constraints["sag"]
        sizes = [with_unit(size, LENGTH) for size in (sag.value, self.sag_before, sag.limit)]
        facts = (
            ("Sag under the weight", "{}, {} before, at most {}".format(*sizes)),
            ("Couplings of the mass", self._mass()),
            ("Layouts evaluated", f"{self.evaluations}"),
        )
        held = check("Sag under the weight", f"{sizes[0]}, at most {sizes[2]}", not sag.satisfied)
        hertz = [
            (f"{k + 1}", number(after), number(before))
            for k, (before, after) in enumerate((self.frequency.T / (2.0 * math.pi)).tolist())
        ]
        frequencies = Table(hertz, ("mode", "after (Hz)", "before (Hz)"), title="Natural frequencies at rest")
        return (
            Headline(self.sentence(), about, shown="both"),
            self._mounts(),
            Picture("places", "Places of springs and dampers", f"{_FIGURES}:places_figure"),
            Columns((self._couplings(),), (frequencies, Table(facts), Checks((held,), head=""))),
            Picture("layout", "Couplings and natural frequencies", self.figure),
            Notes((*_REMARKS, *((_MIRRORED,) if self.mirrored else ())), shown="page"),
        )

    def sentence(self) -> str:
        """What the layout gains."""
        if self.measure == "couplings":
            sums = (f"{value:.3g}" if value >= _SHOWN**2 else "0" for value in (self.value, self.baseline))
            text = "The squared couplings of stiffness and damping add up to {} in place of {}".format(*sums)
        else:
            now, was = (f"{0.0 - 100.0 * value:.3g} %" for value in (self.value, self.baseline))
            text = f"The natural frequencies keep {now} from the running speeds in place of {was}"
        if self.feasible:
            return f"{text}."
        return f"{text}; no layout within the bounds keeps the sag, this one exceeds it least."

    def _mass(self) -> str:
        """What no mount changes."""
        pairs = zip(pair_names(), self.mass_coupling.tolist(), strict=True)
        found = ", ".join(f"{pair} {value:.3g}" for pair, value in pairs if abs(value) >= _SHOWN)
        return f"{found}, which no mount changes" if found else "none about the centre of mass"

    def _mounts(self) -> Table:
        """Places and directions, a row for each mount."""
        rows = []
        for mount in self.mounts:
            places = (
                ", ".join(f"{length * MM:.1f}" for length in at)
                for at in (mount.position, mount.position_before)
            )
            ways = (
                "along x, y, z" if way is None else ", ".join(f"{part:.4f}" for part in way)
                for way in (mount.direction, mount.direction_before)
            )
            rows.append((mount.name, *places, *ways))
        head = "mount", "at x, y, z (mm)", "before", "direction", "before"
        return Table(rows, head, title="Springs and dampers")

    def _couplings(self) -> Table:
        """Couplings that there are or were."""
        rows = []
        for k, pair in enumerate(pair_names()):
            sizes = [float(table[layout, k]) for table in self.couplings.values() for layout in (1, 0)]
            if np.max(np.abs(sizes)) >= _SHOWN:
                rows.append((pair, *(f"{size:.3f}" if abs(size) >= _SHOWN else "0" for size in sizes)))
        head = "coupling", "stiffness", "before", "damping", "before"
        return Table(rows, head, title="Couplings about the centre of mass")


def pair_names() -> tuple[str, ...]:
    """Pairs of coordinates as printed: "x-beta" and so on."""
    return tuple(f"{COORDINATES[i]}-{COORDINATES[j]}" for i, j in PAIRS)
