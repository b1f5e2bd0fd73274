"""What `run` answers of a spindle unit: dynamic compliances over frequency, natural frequencies, shapes."""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from leblanc.core.answer import Answer
from leblanc.core.blocks import Block, Check, Checks, Headline, Notes, Picture, Table, check
from leblanc.core.units import LENGTH, in_rpm, number, with_unit
from meshes.arrays import Array, Complex
from meshes.quantity import Q

RECIPROCITY, WAYS = 1e-9, 1e-6  # relative differences up to which two ways to one answer agree
PER_NEWTON = 1e9  # nm/N in one m/N
THEORIES = {
    "euler": "bending and distributed mass",
    "rayleigh": "bending, distributed mass and rotary inertia",
    "timoshenko": "bending, shear, distributed mass and rotary inertia",
}
HEAD = (
    "Frequency (Hz)",
    *("measured (nm/N)", "phase (deg)"),
    *("wanted (nm/N)", "phase (deg)"),
    *("|W|", "phase (deg)"),
)
_OVER, _PARTS = ("frequency",), ("real part", "imaginary part")
_MOVED = "displacement over the force, of the"


@dataclass(frozen=True)
class NaturalMode:
    """A natural motion without damping, and the damped answer to the force at its frequency."""

    frequency: Annotated[float, Q("rad s-1", "natural frequency")]
    #: of each beam places from its first station, m, and deflections, the largest of all being 1
    along: tuple[tuple[Array, Array], ...]
    stations: Annotated[dict[str, float], Q("1", text="deflection by station", data=False)]
    measured: Annotated[complex, Q("m N-1", "compliance", "of what is measured, at this frequency")]
    wanted: Annotated[complex, Q("m N-1", "compliance", "of what is asked for, at this frequency")]


@dataclass(frozen=True)
class Turning:
    """What is known of a spindle whose spin speed the scene says."""

    rotation: Annotated[float, Q("rad s-1", "spin speed of the spindle", data=False)]
    cage_speed: Annotated[
        dict[str, float], Q("rad s-1", text="speed of each cage without slip, by its joint", data=False)
    ]


@dataclass(frozen=True)
class SpindleAnswer(Answer):
    """Answer to a unit harmonic force over its frequency; n frequencies, k natural ones, s stations.

    Examples
    --------
    >>> import leblanc as lb
    >>> answer = lb.run(lb.example("spindle").replace({"speeds.count": 3}))
    >>> answer.transmissibility.shape
    (3,)
    """

    command = "run"
    title = "Dynamic compliance of a spindle unit"
    data, page = "response.nc", "summary.html"
    unused = ("model", "runup", "optimise")
    figure = "leblanc.wings.spindle.figure:compliance_figure"

    name: str  #: of the scene
    source: str
    assumed: tuple[str, ...]  #: values that no source gives
    digest: str  #: of the scene
    theory: str  #: of the beams
    frequency: Annotated[Array, Q("rad s-1", "frequency of the force", over=_OVER)]
    driven_at: Annotated[str, Q(text="station of the force")]
    measured_at: Annotated[str, Q(text="station that is measured")]
    wanted_at: Annotated[str, Q(text="station that is asked for")]
    #: displacements over the force at the three stations, shape (n,)
    driven: Annotated[
        Complex, Q("m N-1", "compliance", f"{_MOVED} driven station", over=_OVER, axes=_PARTS, json=False)
    ]
    measured: Annotated[
        Complex, Q("m N-1", "compliance", f"{_MOVED} measured station", over=_OVER, axes=_PARTS, json=False)
    ]
    wanted: Annotated[
        Complex, Q("m N-1", "compliance", f"{_MOVED} wanted station", over=_OVER, axes=_PARTS, json=False)
    ]
    beams: tuple[str, ...]  #: names of the beams
    #: of all beams, shape (s,)
    stations: Annotated[
        tuple[str, ...],
        Q("1", "station", over=("station",), variable="station", coordinate=True, json=False),
    ]
    places: tuple[float, ...]  #: of the first station of each beam along the machine, m
    #: between the first and the last frequency
    modes: Annotated[tuple[NaturalMode, ...], Q(text="natural motions", data=False)]
    #: largest relative difference of a compliance from that with force and motion exchanged
    reciprocity: float
    #: largest relative difference of the way by reactions in the joints from the exact assembly; nan where no
    #: joint is between two beams
    ways_apart: float
    #: smallest -Im of the compliance at the force over its size; not below 0 where joints only take energy
    least_dissipation: float
    turning: Annotated[Turning | None, Q(part=True)] = None

    @property
    def transmissibility(
        self,
    ) -> Annotated[Complex, Q("1", "W", "wanted over measured", over=_OVER, axes=_PARTS)]:
        """W = q2/q1, of what is asked for over what is measured, shape (n,)."""
        return np.asarray(self.wanted / self.measured)

    @property
    def natural_frequency(self) -> Annotated[Array, Q("rad s-1", "natural frequency", over=("mode",))]:
        """All natural frequencies of the band without damping, shape (k,)."""
        return np.array([mode.frequency for mode in self.modes])

    @property
    def mode_shape(
        self,
    ) -> Annotated[
        Array,
        Q("1", "deflection", "over the largest along all beams", over=("mode", "station"), json=False),
    ]:
        shapes = [[mode.stations[name] for name in self.stations] for mode in self.modes]
        return np.array(shapes).reshape(len(self.modes), len(self.stations))

    @property
    def compliance(
        self,
    ) -> Annotated[
        dict[str, Complex], Q("m N-1", text="displacement over the force, by part in the answer", data=False)
    ]:
        return {"driven": self.driven, "measured": self.measured, "wanted": self.wanted}

    @property
    def checks(self) -> Annotated[dict[str, float], Q(text="whether two ways to one answer agree, SI")]:
        return {name: getattr(self, name) for name in ("reciprocity", "ways_apart", "least_dissipation")}

    @property
    def own(self) -> Mapping[str, Any]:
        return {name: getattr(self, name) for name in ("theory", "driven_at", "measured_at", "wanted_at")}

    @property
    def closing(self) -> str:
        return f"{self.name}: {self.frequency.size} frequencies, {len(self.modes)} natural ones done"

    def blocks(self) -> tuple[Block, ...]:
        low, high = (number(float(self.frequency[k]) / (2.0 * math.pi)) for k in (0, -1))
        about = (
            f"A spindle unit of {len(self.beams)} beams with {len(self.stations)} stations, driven by a unit "
            f"force from {low} to {high} Hz at {self.frequency.size} frequencies."
        )
        cages = {} if self.turning is None else self.turning.cage_speed
        rows = [(f"Cage of {name}", f"{in_rpm(speed)} without slip") for name, speed in cages.items()]
        shapes = (Picture("shapes", "Shapes of the natural motions", f"{_FIGURES}:shapes_figure"),)
        return (
            Headline(sentence(self), about, shown="both"),
            Picture("compliance", "Dynamic compliances and their ratio", self.figure),
            *(shapes if self.modes else ()),
            Table(_compliances(self), HEAD, True, "At the ends of the band and at the natural frequencies"),
            Table(rows, title="At the speed at which the spindle turns"),
            Checks(_limits(self), head=""),
            Notes(
                (
                    f"Beams of round sections with {THEORIES[self.theory]}, solved exactly at each "
                    "frequency; joints are springs with dampers.",
                    "Motion in one plane; gyroscopic moments of the spinning shaft are left out, as in the "
                    "source.",
                    "Natural frequencies are those without damping; all of the band are found, by counting.",
                ),
                shown="page",
            ),
        )


_FIGURES = "leblanc.wings.spindle.figure"


def hertz(rate: float) -> str:
    """A frequency in rad/s for print."""
    return f"{number(rate / (2.0 * math.pi))} Hz"


def sentence(answer: SpindleAnswer) -> str:
    """Where it resonates and what the housing tells of the tool there, in one or two sentences."""
    low, high = answer.frequency[0] / (2.0 * math.pi), hertz(float(answer.frequency[-1]))
    if not answer.modes:
        return f"No natural frequency lies between {number(low)} and {high}."
    every = ", ".join(number(mode.frequency / (2.0 * math.pi)) for mode in answer.modes)
    strongest = max(answer.modes, key=lambda mode: abs(mode.wanted))
    return (
        f"Natural frequencies between {number(low)} and {high}: {every} Hz. A force of 1 N at "
        f"{answer.driven_at} moves {answer.wanted_at} most at {hertz(strongest.frequency)}, by "
        f"{with_unit(abs(strongest.wanted), LENGTH)}, "
        f"{number(abs(strongest.wanted / strongest.measured))} times what {answer.measured_at} shows."
    )


def _compliances(answer: SpindleAnswer) -> list[tuple[str, ...]]:
    """Compliances and W at the first frequency, at each natural one and at the last: cells of `HEAD`."""
    first, last = ((float(answer.frequency[k]), answer.measured[k], answer.wanted[k]) for k in (0, -1))
    lines = [first, *((mode.frequency, mode.measured, mode.wanted) for mode in answer.modes), last]

    def polar(value: complex, unit: float = 1.0) -> tuple[str, str]:
        return number(abs(value) * unit), f"{math.degrees(cmath.phase(value)):.1f}"

    return [
        (number(rate / (2.0 * math.pi)), *polar(q1, PER_NEWTON), *polar(q2, PER_NEWTON), *polar(q2 / q1))
        for rate, q1, q2 in lines
    ]


def _limits(answer: SpindleAnswer) -> list[Check]:
    """Whether the answer holds what it must: each check with its number."""
    ways, least = answer.ways_apart, answer.least_dissipation

    return [
        check(
            "Force and motion exchanged", f"{answer.reciprocity:.1e} apart", answer.reciprocity > RECIPROCITY
        ),
        check(
            "By the reactions in the joints",
            "not asked: no joint between two beams" if math.isnan(ways) else f"{ways:.1e} apart",
            ways > WAYS,
        ),
        check(
            "Joints take energy at every frequency",
            "yes" if least >= 0.0 else f"no, by {-least:.1e}",
            least < -RECIPROCITY,
        ),
    ]
