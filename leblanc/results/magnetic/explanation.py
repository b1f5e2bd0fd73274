"""What `explain` tells of a rotor in magnetic bearings: its numbers, what the magnets can hold."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from leblanc.core.answer import Result, attributes, carried
from leblanc.core.netcdf import NamedArrays
from leblanc.core.netcdf import variable as var
from leblanc.results.base import number_or_none
from meshes.arrays import Array

if TYPE_CHECKING:
    from solvers.rotor.magnetic.machine import Dimensionless


@dataclass(frozen=True)
class MagneticExplanation(Result):
    """What a rotor in magnetic bearings is in numbers, without any motion in time; k controllers, n places.

    Examples
    --------
    >>> import leblanc as lb
    >>> explanation = lb.explain(lb.example("blood_pump"))
    >>> f"{explanation.position_stiffness:.0f} N/m"
    '9000 N/m'
    """

    figure: ClassVar[str] = "leblanc.figures.magnetic.force:force_figure"
    summary: ClassVar[str] = "leblanc.text.magnetic:explanation_facts"

    name: str  #: of the scene
    numbers: Dimensionless  #: dimensionless
    current_stiffness: float  #: of one pair of magnets in the centre, N/A and N/m
    position_stiffness: float
    growth: float  #: of a deflection without control at the last speed, 1/s
    holds: float  #: largest constant force in the centre along one axis, N
    reach: float  #: largest deflection along an axis from which the currents can bring the rotor home, m
    #: decay of the fastest pole with each controller at the last speed, 1/s, by name
    fastest: dict[str, float]
    place: Array  #: deflections along an axis, m, shape (n,)
    #: outwards of both bearings and the motor, at the largest current home, none, out, N, shape (3, n)
    force: Array
    source: str = ""  #: of the scene
    assumed: tuple[str, ...] = ()
    digest: str = ""

    dimensionless = carried("numbers")

    def to_json(self) -> dict[str, Any]:
        """What `explain` prints for scripts, SI, null for what is not there."""
        return {
            "name": self.name,
            "dimensionless": {key: number_or_none(x) for key, x in asdict(self.numbers).items()},
            "current_stiffness": self.current_stiffness,
            "position_stiffness": self.position_stiffness,
            "growth": self.growth,
            "holds": self.holds,
            "reach": self.reach,
            "fastest": self.fastest,
        }

    def named_arrays(self) -> NamedArrays:
        """The forces over the deflection, and single numbers."""
        return NamedArrays(
            {
                "force": var(("current", "place"), self.force, "N", "force outwards", "home, none, out"),
                "growth": var((), self.growth, "s-1", "growth", "without control"),
                "holds": var((), self.holds, "N", "largest constant force", "along one axis"),
                "reach": var((), self.reach, "m", "largest deflection", "from which it comes home"),
            },
            coords={"place": var(("place",), self.place, "m", "deflection", "along an axis")},
            attrs=attributes(self, "explain", {}, ()),
        )
