"""What `volume` answers: optimal volume at a deflection and a speed, surface of a given volume."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import Annotated

from leblanc.core.answer import Answer
from leblanc.core.blocks import Block, Picture, Table, Words
from leblanc.core.units import LENGTH, ML, MM, VOLUME, Unit, in_rpm, unit_for, with_unit
from meshes.arrays import Array
from meshes.chamber import Chamber
from meshes.quantity import Q

_ML_MM = ML * MM  # millilitres times millimetres in one m^4
_WETTING = ("m3", "wetting volume", "the wall is wet all round at the floor")
_LID = ("m3", "lid volume", "the surface first touches the lid or the foot of the inner wall")
_FULL = ("m3", "full volume", "the wall is wet all round up to the lid")
_OVER, _BY = ("chamber", "speed"), "statics, eq. 8, 22, 23"


class Coverage(IntEnum):
    """How much liquid there is beside the optimal volume; the numbers are the cases of DR18, section 5."""

    MORE = 1
    AS_MUCH = 2
    LESS = 3

    @property
    def message(self) -> str:
        """The case as text."""
        return {
            Coverage.MORE: "more than wets the wall at the floor: wet all round there",
            Coverage.AS_MUCH: "just wets the wall at the floor",
            Coverage.LESS: "less than wets the wall: dry in part",
        }[self]


@dataclass(frozen=True)
class WallVolumes:
    """Volumes at which the surface meets an edge, at the deflection of an answer at each speed.

    nan where that is not known, and in chambers that are no clear ring.
    """

    wetting_volume: Annotated[Array, Q(*_WETTING, _OVER, by=_BY)]
    #: nan where gravity does not act along the axis and there is no inner wall
    lid_volume: Annotated[Array, Q(*_LID, _OVER, by=_BY)]
    #: more liquid adds nothing to its unbalance, unless the surface has reached an inner wall
    full_volume: Annotated[Array, Q(*_FULL, _OVER, by=_BY)]


@dataclass(frozen=True)
class Surface:
    """Free surface that holds a given volume."""

    #: None without gravity along the axis
    surface_constant: Annotated[float | None, Q("m", "surface constant", "C of z = beta r^2 + C")]
    unbalance_volume: Annotated[
        float, Q("m4", "unbalance volume", "first moment about the rotation axis over the density")
    ]
    unbalance_volume_fem: Annotated[float, Q("m4", "unbalance volume fem")]
    case: Annotated[Coverage, Q("1", "case", "1 more, 2 as much, 3 less than the optimal volume")]
    converged: Annotated[
        bool, Q(name="converged", text="both surfaces hold the given volume", flags="no yes")
    ]


@dataclass(frozen=True)
class VolumeAnswer(Answer):
    """Optimal volume of a chamber at a deflection and a speed.

    Examples
    --------
    >>> import leblanc as lb
    >>> best = lb.volume(radius=0.2, height=0.05, eccentricity="1 mm", speed=90.0)
    >>> f"{1e6 * best.optimal_volume:.4f} ml, {best.fem_error < 1e-3}"
    '54.4396 ml, True'
    """

    command = "volume"
    figure = "leblanc.studies.volume.figure:surface_figure"

    chamber: Annotated[Chamber, Q(part=True, json=False)]
    eccentricity: Annotated[float, Q("m", "deflection", "of the geometric axis", json=False)]
    speed: Annotated[float, Q("rad s-1", "spin speed", json=False)]
    gravity: Annotated[float, Q("m s-2", "gravity", "along the axis", json=False)]
    optimal_volume: Annotated[float, Q("m3", "optimal volume", by="statics, eq. 8")]
    optimal_volume_fem: Annotated[
        float, Q("m3", "optimal volume fem", "by finite elements", error="fem_error")
    ]
    fem_error: Annotated[float, Q("1", "fem error", "of the latter, relative")]
    #: None where the formula has no value, of the next as well
    printed_eq18: Annotated[float | None, Q("m3", "printed eq18", "as the source prints it")]
    corrected_eq18: Annotated[float | None, Q("m3", "corrected eq18", "with its moment corrected")]
    #: None without gravity along the axis and without an inner wall
    lid_volume: Annotated[float | None, Q(*_LID, by=_BY)]
    full_volume: Annotated[float, Q(*_FULL, by=_BY)]
    volume: float | None = None  #: that was given, m^3; None without one
    surface: Annotated[Surface | None, Q(part=True)] = None  #: of that volume

    @property
    def wetting_volume(self) -> Annotated[float, Q(*_WETTING, by=_BY)]:
        return self.optimal_volume

    @property
    def faults(self) -> tuple[str, ...]:
        lost = self.surface is not None and not self.surface.converged
        return ("no surface found that holds the volume asked for",) if lost else ()

    def blocks(self) -> tuple[Block, ...]:
        return (
            Words(question_words(self)),
            Table(facts(self)),
            Picture("surface", "Free surface", self.figure),
        )


def question_words(answer: VolumeAnswer) -> str:
    """What was understood, in engineers' units."""
    chamber = answer.chamber
    inner = f", inner radius {with_unit(chamber.inner_radius, LENGTH)}" if chamber.inner_radius > 0.0 else ""
    return (
        f"Chamber of radius {with_unit(chamber.radius, LENGTH)}{inner}, height "
        f"{with_unit(chamber.height, LENGTH)}; deflection {with_unit(answer.eccentricity, LENGTH)} at "
        f"{in_rpm(answer.speed)}"
    )


def facts(answer: VolumeAnswer) -> tuple[tuple[str, str], ...]:
    """Label and value with its unit."""
    unit = unit_for(VOLUME, answer.optimal_volume)
    rows = [
        ("wetting volume, at the floor", _volume(answer.optimal_volume, unit)),
        ("by finite elements", _volume(answer.optimal_volume_fem, unit)),
        ("relative difference", f"{answer.fem_error:.2g}"),
        ("as published, DR18 eq. 18", _volume(answer.printed_eq18, unit)),
        ("the same, corrected", _volume(answer.corrected_eq18, unit)),
        ("touches the lid, or an inner wall", _volume(answer.lid_volume, unit)),
        ("wets the wall to the lid", _volume(answer.full_volume, unit)),
    ]
    if surface := answer.surface:
        constant = surface.surface_constant
        rows += [
            ("surface constant", "none" if constant is None else f"{constant:.10g} m"),
            ("unbalance volume", f"{surface.unbalance_volume * _ML_MM:.10g} ml mm"),
            ("by finite elements", f"{surface.unbalance_volume_fem * _ML_MM:.10g} ml mm"),
            ("case", f"{surface.case.value}: {surface.case.message}"),
            ("converged", "yes" if surface.converged else "no"),
        ]
    return tuple(rows)


def _volume(value: float | None, unit: Unit) -> str:
    if value is None:
        return "none"
    return f"{value * unit.count:.10g} {unit.name}"  # digits that show how near the finite elements come
