"""Frequencies of a rolling bearing, from its dimensions or the other way round."""

from __future__ import annotations

from leblanc.results.spindles.bearing import BearingResult
from meshes.errors import require_not_negative, require_positive
from solvers.rotor.rolling_bearing import Bearing, BearingFit, cage_slip


def answer_bearing(
    bearing: Bearing,
    speed: float,
    cage_measured: float | None = None,
    given: dict[str, float] | None = None,
    fit: BearingFit | None = None,
) -> BearingResult:
    """Frequencies of a bearing at a speed of its shaft, slip of its cage [theory: spindle, eq. 17-19].

    Parameters
    ----------
    bearing : balls, ratio of diameters, contact angle
    speed : of the shaft, rad/s, above 0
    cage_measured : speed of the cage, rad/s
    given, fit : where the bearing comes from, if its dimensions were not given

    Raises
    ------
    InputError : a speed that is not above 0
    """
    require_positive("--speed", speed)
    orders = bearing.orders()
    slip = None
    if cage_measured is not None:
        require_not_negative("--cage", cage_measured)
        slip = cage_slip(cage_measured, orders["ftf"] * speed)
    return BearingResult(bearing, speed, orders, given or {}, fit, cage_measured, slip)
