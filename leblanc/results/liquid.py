"""The liquid of one chamber alone: its optimal volume and free surface, its slowest modes."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from leblanc.core.answer import Result, versions
from leblanc.core.netcdf import NamedArrays, variable
from leblanc.core.notes import Note, NoteCode, one_line, texts
from leblanc.core.units import LENGTH, with_unit
from meshes.arrays import Array
from meshes.findings import Finding
from meshes.liquid_section import LiquidSection
from solvers.sloshing.modes import SloshingModes


class ModesCode(NoteCode):
    """What the notes of modes say."""

    MESH = "mesh"
    STRAIGHT_SIDES = "straight_sides"
    OTHER_RADIUS = "other_radius"
    BAFFLES_CLEAR = "baffles_clear"
    COARSE = "coarse"
    THICK_LAYERS = "thick_layers"
    SHARP_EDGES = "sharp_edges"


def mesh_finding(finding: Finding) -> Note:
    """What is found in a mesh."""
    return Note(ModesCode.MESH, asdict(finding), f"mesh: {finding}")


def straight_sides() -> Note:
    """A mesh of linear cells stands for walls that may be curved."""
    text = "straight sides: the error is that on these walls, whatever curves they stand for"
    return Note(ModesCode.STRAIGHT_SIDES, {}, text)


def other_radius(farthest: float) -> Note:
    """The section reaches to another radius than the one given, m."""
    text = f"the section reaches to {with_unit(farthest, LENGTH)} from the axis: that counts, not --radius"
    return Note(ModesCode.OTHER_RADIUS, {"radius": farthest}, text)


def baffles_clear() -> Note:
    """The baffles do not reach into the liquid."""
    return Note(ModesCode.BAFFLES_CLEAR, {}, "the baffles stand clear of the liquid")


def coarse_mesh(error: float) -> Note:
    """The relative error of the fastest mode calls for more segments."""
    text = f"the mesh is coarse for the fastest of these modes (error about {error:.1g}): more --segments"
    return Note(ModesCode.COARSE, {"error": error}, text)


def thick_layers() -> Note:
    """The laminar layers are not thin beside the liquid."""
    text = "boundary layers are not thin beside the liquid: the damping is their first order alone"
    return Note(ModesCode.THICK_LAYERS, {}, text)


def sharp_edges() -> Note:
    """The liquid separates at edges of baffles."""
    text = "laminar damping at edges of baffles: separation adds to it, more at large amplitude"
    return Note(ModesCode.SHARP_EDGES, {}, text)


# What `modes` prints of a result, in this order, before the notes.
_IN_JSON = (
    "frequency", "exact", "damping", "damping_ratio", "plain_damping", "damping_spread", "crests",
    "travelling", "multiplicity", "error_estimate", "synchronous_force_ratio", "surface_radius",
    "circulations", "unknowns", "surface_unknowns", "converged", "wall_time",
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class ModesResult(Result):
    """Slowest modes of the liquid, by rising size of the frequency, seen from the drum.

    Examples
    --------
    >>> import leblanc as lb
    >>> found = lb.modes(radius=0.15, volume="671 ml", height=0.05, speed=40.0, count=2, segments=32)
    >>> bool(abs(found.frequency / found.exact - 1.0).max() < 1e-3)
    True
    """

    title: str  #: the chamber in words
    speed: float  #: spin, rad/s
    frequency: Array  #: sigma, prograde positive, rad/s, shape (k,)
    exact: tuple[float | None, ...]  #: of the ring without baffles, rad/s; None where no closed form is known
    damping: Array  #: decay rate of the amplitude in laminar layers, 1/s, shape (k,)
    damping_ratio: Array  #: over the size of the frequency, shape (k,)
    plain_damping: Array  #: without the Coriolis force in the layers on floor and lid, 1/s, shape (k,)
    #: change of the damping for half or twice the layers' thickness at edges, relative, shape (k,)
    damping_spread: Array
    crests: NDArray[np.int64]  #: round the drum, of the largest share, shape (k,)
    travelling: Array  #: 0 for a standing oscillation to 1 for a wave that runs one way, shape (k,)
    multiplicity: NDArray[np.int64]  #: modes with that frequency, shape (k,)
    error_estimate: Array  #: of the frequency, relative, from a mesh twice as coarse
    #: force of the liquid in a synchronous whirl over that of all that the wall encloses, the mean over its
    #: directions
    synchronous_force_ratio: float
    surface_radius: float  #: a, m
    circulations: int  #: steady flows, without a frequency
    unknowns: int  #: of the mesh, and
    surface_unknowns: int  #: of the eigenproblem
    converged: bool  #: the eigenproblem is solved to rounding
    wall_time: float  #: s
    notes: tuple[Note, ...]  #: what to know about these values
    section: LiquidSection  #: the liquid at rest
    shapes: SloshingModes  #: of the modes
    phase: Array  #: of each mode at the instant of its strongest flow, rad, shape (k,)

    figure = "leblanc.figures.liquid:modes_figure"
    summary = "leblanc.text.liquid:modes_summary"

    def to_json(self) -> dict[str, Any]:
        """What `modes` prints for scripts, SI and radians."""
        return {name: getattr(self, name) for name in _IN_JSON} | {"notes": texts(self.notes)}

    def named_arrays(self) -> NamedArrays:
        """The modes over `mode`, numbered by rising size of the frequency."""
        over = ("mode",)
        exact = np.array([np.nan if value is None else value for value in self.exact])
        columns = {
            "frequency": variable(over, self.frequency, "rad s-1", "frequency in the drum, with the spin"),
            "exact": variable(over, exact, "rad s-1", "frequency by the closed form of the ring"),
            "damping": variable(over, self.damping, "s-1", "decay rate of the amplitude"),
            "damping_ratio": variable(over, self.damping_ratio, "1", "damping over the frequency"),
            "plain_damping": variable(over, self.plain_damping, "s-1", "decay rate without Coriolis force"),
            "damping_spread": variable(over, self.damping_spread, "1", "relative change by layers at edges"),
            "crests": variable(over, self.crests, "1", "crests round the drum"),
            "travelling": variable(over, self.travelling, "1", "0 standing to 1 running one way"),
            "multiplicity": variable(over, self.multiplicity, "1", "modes with that frequency"),
            "error_estimate": variable(over, self.error_estimate, "1", "relative error of the frequency"),
        }
        numbers = np.arange(1, self.frequency.size + 1, dtype=np.int32)
        coords = {"mode": variable(over, numbers, "1", "mode")}
        singles = ("speed", "synchronous_force_ratio", "surface_radius", "circulations", "wall_time")
        return NamedArrays(
            columns, coords, {name: getattr(self, name) for name in singles} | self._attributes()
        )

    def _attributes(self) -> dict[str, str]:
        """The chamber, whether the modes were found, versions."""
        return {
            "title": one_line(self.title),
            "converged": "yes" if self.converged else "no",
            "notes": "\n".join(map(one_line, texts(self.notes))) or "none",
            "history": "written by leblanc modes",
            **{f"version_{package}": version for package, version in versions().items()},
        }
