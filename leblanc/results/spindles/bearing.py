"""What `bearing` answers: frequencies of a rolling bearing, what they tell of it, slip of its cage."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from leblanc.results.base import Result
from leblanc.results.netcdf import NamedArrays
from leblanc.results.netcdf import variable as var

if TYPE_CHECKING:
    from solvers.rotor.rolling_bearing import Bearing, BearingFit


@dataclass(frozen=True)
class BearingResult(Result):
    """Frequencies of a bearing at one speed of its shaft, the outer ring at rest.

    Examples
    --------
    >>> import leblanc as lb
    >>> found = lb.bearing(speed="33 Hz", balls=9, ball_diameter="7.144 mm", pitch_diameter="31 mm")
    >>> round(found.bpfo / (2 * 3.141592653589793), 1)  # Hz
    114.3
    """

    figure: ClassVar[str] = "leblanc.figures.spindles.bearing:bearing_figure"
    summary: ClassVar[str] = "leblanc.text.spindles.bearing:rows"

    bearing: Bearing  #: number of balls, ratio of diameters, contact angle
    speed: float  #: of the shaft, rad/s
    orders: dict[str, float]  #: frequencies over that of the shaft, by name
    #: orders to which the bearing was fitted, by name; none where its dimensions were given
    given: dict[str, float]
    fit: BearingFit | None  #: how it was fitted; None where its dimensions were given
    cage_measured: float | None  #: speed of the cage as measured, rad/s; None if it is not given
    slip: float | None  #: share by which the cage is behind rolling; None without a measured speed

    @property
    def ftf(self) -> float:
        """Of the cage, rad/s."""
        return self.orders["ftf"] * self.speed

    @property
    def bpfo(self) -> float:
        """Of balls that pass a place of the outer ring, rad/s."""
        return self.orders["bpfo"] * self.speed

    @property
    def bpfi(self) -> float:
        """Of balls that pass a place of the inner ring, rad/s."""
        return self.orders["bpfi"] * self.speed

    @property
    def bsf(self) -> float:
        """Of a ball about its own axis, rad/s."""
        return self.orders["bsf"] * self.speed

    @property
    def balls(self) -> int:
        """How many there are."""
        return self.bearing.balls

    @property
    def diameter_ratio(self) -> float:
        """Of a ball over the circle of the balls' centres."""
        return self.bearing.diameter_ratio

    @property
    def contact_angle(self) -> float:
        """Rad."""
        return self.bearing.contact_angle

    def to_json(self) -> dict[str, Any]:
        """What `bearing` prints for scripts: SI units, null for what is not there."""
        return {
            "speed": self.speed,
            "balls": self.balls,
            "diameter_ratio": self.diameter_ratio,
            "contact_angle": self.contact_angle,
            **{name: order * self.speed for name, order in self.orders.items()},
            "orders": self.orders,
            "cage_measured": self.cage_measured,
            "slip": self.slip,
            "given": self.given,
            "fit": None if self.fit is None else _fit(self.fit),
        }

    def named_arrays(self) -> NamedArrays:
        """Scalars by name."""
        names = {"ftf": "of the cage", "bpfo": "outer ring", "bpfi": "inner ring", "bsf": "of a ball"}
        found = {
            name: var((), getattr(self, name), "rad s-1", "frequency", text) for name, text in names.items()
        }
        found["balls"] = var((), self.balls, "1", "balls in a row")
        found["diameter_ratio"] = var((), self.diameter_ratio, "1", "ball over pitch diameter")
        found["contact_angle"] = var((), self.contact_angle, "rad", "contact angle")
        found["slip"] = var((), math.nan if self.slip is None else self.slip, "1", "slip of the cage")
        return NamedArrays(found, {"speed": var((), self.speed, "rad s-1", "speed of the shaft")}, {})


def _fit(fit: BearingFit) -> dict[str, Any]:
    values = {
        "projected_ratio": fit.projected_ratio,
        "projected_ratio_std": fit.projected_ratio_std,
        "cosine": fit.cosine,
        "cosine_std": fit.cosine_std,
        "residual_rms": fit.residual_rms,
        "next_balls": fit.next_balls or None,
        "next_rms": fit.next_rms,
    }
    return {k: None if isinstance(v, float) and math.isnan(v) else v for k, v in values.items()}
