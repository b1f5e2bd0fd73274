"""The optimal volume of a chamber and the surface of a given one: what `volume` answers."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from enum import IntEnum
from typing import TYPE_CHECKING, Any, ClassVar

from leblanc.results.base import Result, versions
from leblanc.results.netcdf import dataset
from leblanc.results.netcdf import variable as var
from meshes.chamber import Chamber

if TYPE_CHECKING:
    from leblanc.results.netcdf import Dataset


class Coverage(IntEnum):
    """How much liquid there is beside the optimal volume; the numbers are the cases of DR18, section 5."""

    MORE = 1
    AS_MUCH = 2
    LESS = 3

    @property
    def message(self) -> str:
        """The case in words."""
        return {
            Coverage.MORE: "more than just covers the wall: wet all round",
            Coverage.AS_MUCH: "just covers the wall",
            Coverage.LESS: "less than covers the wall: dry in part",
        }[self]


@dataclass(frozen=True)
class Surface:
    """Free surface that holds a given volume.

    Parameters
    ----------
    surface_constant : C of z = beta r^2 + C, m; None without gravity along the axis
    unbalance_volume : first moment of the liquid about the rotation axis over its density, m^4
    unbalance_volume_fem : the same by finite elements, m^4
    case : against the optimal volume
    converged : both surfaces hold the volume asked for
    """

    surface_constant: float | None
    unbalance_volume: float
    unbalance_volume_fem: float
    case: Coverage
    converged: bool


@dataclass(frozen=True)
class VolumeResult(Result):
    """Optimal volume of a chamber at a deflection and a speed.

    Parameters
    ----------
    chamber : its walls
    eccentricity, speed, gravity : deflection, m; spin speed, rad/s; gravity along the axis, m/s^2
    optimal_volume : exact, m^3
    optimal_volume_fem : by finite elements, m^3
    fem_error : of the latter, relative
    printed_eq18 : as the source prints it, m^3; None where the formula has no value
    corrected_eq18 : with its moment corrected, m^3; None where the formula has no value
    volume : that was asked for, m^3; None without one
    surface : of that volume
    """

    figure: ClassVar[str] = "leblanc.figures.volume:surface_figure"
    summary: ClassVar[str] = "leblanc.text.volume:facts"

    chamber: Chamber
    eccentricity: float
    speed: float
    gravity: float
    optimal_volume: float
    optimal_volume_fem: float
    fem_error: float
    printed_eq18: float | None
    corrected_eq18: float | None
    volume: float | None = None
    surface: Surface | None = None

    @property
    def converged(self) -> bool:
        """The surface of the volume asked for was found."""
        return self.surface is None or self.surface.converged

    def to_json(self) -> dict[str, Any]:
        """What `volume` prints for scripts, SI; the surface only where a volume was asked for."""
        found: dict[str, Any] = {
            "optimal_volume": self.optimal_volume,
            "optimal_volume_fem": self.optimal_volume_fem,
            "fem_error": self.fem_error,
            "printed_eq18": self.printed_eq18,
            "corrected_eq18": self.corrected_eq18,
        }
        return found if self.surface is None else found | asdict(self.surface)

    def to_dataset(self) -> Dataset:
        """Dataset of single numbers, nan where a formula has none."""
        units = {"surface_constant": "m", "unbalance_volume": "m4", "unbalance_volume_fem": "m4"}
        units |= {"fem_error": "1", "case": "1", "converged": "1"}
        given = {
            "radius": var((), self.chamber.radius, "m", "radius", "of the wall"),
            "inner_radius": var((), self.chamber.inner_radius, "m", "inner radius", "of the chamber"),
            "height": var((), self.chamber.height, "m", "height", "of the chamber"),
            "eccentricity": var((), self.eccentricity, "m", "deflection", "of the geometric axis"),
            "speed": var((), self.speed, "rad s-1", "spin speed"),
            "gravity": var((), self.gravity, "m s-2", "gravity", "along the axis"),
        }
        found = {
            name: var(
                (), math.nan if value is None else float(value), units.get(name, "m3"), name.replace("_", " ")
            )
            for name, value in self.to_json().items()
        }
        return dataset(
            given | found,
            coords={},
            attrs={
                "history": "written by leblanc volume",
                **{f"version_{package}": version for package, version in versions().items()},
            },
        )
