"""What `modes` answers: the slowest modes of the liquid of one chamber alone."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from leblanc.core.answer import Answer
from leblanc.core.blocks import Block, Notes, Picture, Table, Words
from leblanc.core.notes import Note, NoteCode, one_line, texts
from leblanc.core.units import LENGTH, with_unit
from meshes.arrays import Array
from meshes.liquid_section import LiquidSection
from meshes.quantity import Q
from solvers.sloshing.modes import SloshingModes

HEAD = ("rad/s", "times", "crests", "runs", "exact", "error", "decay 1/s", "ratio")
_OVER, _RATE = ("mode",), "rad s-1"


class ModesCode(NoteCode):
    """What the notes of modes say."""

    MESH = "mesh"
    STRAIGHT_SIDES = "straight_sides"
    OTHER_RADIUS = "other_radius"
    BAFFLES_CLEAR = "baffles_clear"
    COARSE = "coarse"
    THICK_LAYERS = "thick_layers"
    SHARP_EDGES = "sharp_edges"


@dataclass(frozen=True, eq=False)
class ModesAnswer(Answer):
    """Slowest modes of the liquid, by rising size of the frequency, seen from the drum.

    Examples
    --------
    >>> import leblanc as lb
    >>> found = lb.modes(radius=0.15, volume="671 ml", height=0.05, speed=40.0, count=2, segments=32)
    >>> bool(abs(found.frequency / found.exact - 1.0).max() < 1e-3)
    True
    """

    command = "modes"
    figure = "leblanc.studies.modes.figure:modes_figure"

    chamber: str  #: in words
    liquid: str  #: its name
    speed: Annotated[float, Q(_RATE, "spin speed", json=False)]
    frequency: Annotated[
        Array, Q(_RATE, "frequency in the drum, with the spin", over=_OVER, error="error_estimate")
    ]
    #: None where no closed form is known
    exact: Annotated[
        tuple[float | None, ...],
        Q(_RATE, "analytical frequency of the ring", over=_OVER, by="waves, eq. 7"),
    ]
    damping: Annotated[Array, Q("s-1", "decay rate of the amplitude", "in laminar layers", over=_OVER)]
    damping_ratio: Annotated[Array, Q("1", "damping over the frequency", over=_OVER)]
    plain_damping: Annotated[
        Array, Q("s-1", "decay rate without Coriolis force", "in the layers on floor and lid", over=_OVER)
    ]
    damping_spread: Annotated[
        Array,
        Q("1", "relative change by layers at edges", "for half or twice their thickness", over=_OVER),
    ]
    crests: Annotated[NDArray[np.int64], Q("1", "crests round the drum", "of the largest share", over=_OVER)]
    travelling: Annotated[Array, Q("1", "0 standing to 1 running one way", over=_OVER)]
    multiplicity: Annotated[NDArray[np.int64], Q("1", "modes with that frequency", over=_OVER)]
    error_estimate: Annotated[
        Array, Q("1", "relative error of the frequency", "from a mesh twice as coarse", over=_OVER)
    ]
    synchronous_force_ratio: Annotated[
        float,
        Q(
            "1",
            "force coefficient of a synchronous whirl",
            "over all that the wall encloses, mean of directions",
        ),
    ]
    surface_radius: Annotated[float, Q("m", "radius of the free surface")]
    circulations: Annotated[int, Q("1", "steady flows", "without a frequency")]
    unknowns: Annotated[int, Q("1", "unknowns of the mesh")]
    surface_unknowns: Annotated[int, Q("1", "unknowns of the eigenproblem")]
    converged: Annotated[bool, Q(name="the eigenproblem is solved to rounding", flags="no yes")]
    wall_time: Annotated[float, Q("s", "time taken")]
    notes: Annotated[tuple[Note, ...], Q(text="what to know about these values")]
    section: LiquidSection  #: the liquid at rest
    shapes: SloshingModes  #: of the modes
    phase: Array  #: of each mode at the instant of its strongest flow, rad, shape (k,)

    @property
    def title(self) -> str:  # type: ignore[override]  # of a frozen class, not set
        return self.chamber

    @property
    def mode(self) -> Annotated[NDArray[np.int32], Q("1", "mode", over=_OVER, json=False)]:
        return np.arange(1, self.frequency.size + 1, dtype=np.int32)

    @property
    def own(self) -> Mapping[str, Any]:
        names = ("speed", "synchronous_force_ratio", "surface_radius", "circulations", "wall_time")
        found = {"title": one_line(self.chamber), "converged": "yes" if self.converged else "no"}
        return found | {name: getattr(self, name) for name in names}

    @property
    def faults(self) -> tuple[str, ...]:
        reason = "the eigenproblem was not solved to rounding; a coarser mesh may help"
        return () if self.converged else (reason,)

    def blocks(self) -> tuple[Block, ...]:
        surface = with_unit(self.surface_radius, LENGTH)
        return (
            Words(f"{self.chamber}; free surface at {surface}; {self.liquid}"),
            Table(tuple(_rows(self)), HEAD, right=True),
            Words(f"force coefficient of a synchronous whirl {self.synchronous_force_ratio:.6g}"),
            Notes(texts(self.notes)),
            Picture("modes", "Shapes of the liquid's modes", self.figure),
        )


def _rows(answer: ModesAnswer) -> Iterator[tuple[str, ...]]:
    """A row for each frequency, equal ones together."""
    k = 0
    while k < len(answer.frequency):
        sigma, same, exact = answer.frequency[k], int(answer.multiplicity[k]), answer.exact[k]
        runs = "stands"
        if abs(answer.travelling[k]) >= 0.5:
            runs = "with" if sigma > 0.0 else "against"
        yield (
            f"{sigma:.6g}",
            f"{same}" if same > 1 else "",
            f"{answer.crests[k]}",
            runs,
            "" if exact is None else f"{exact:.6g}",
            f"{answer.error_estimate[k]:.1g}",
            f"{answer.damping[k]:.4g}",
            f"{answer.damping_ratio[k]:.2g}",
        )
        k += same
