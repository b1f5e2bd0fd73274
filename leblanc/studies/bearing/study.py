"""The bearing of given dimensions or frequencies, and what it answers."""

from __future__ import annotations

from leblanc.studies.bearing.answer import BearingAnswer
from meshes.errors import InputError, require_not_negative, require_positive
from solvers.rotor.rolling_bearing import ORDERS, Bearing, BearingFit, cage_slip, fit_bearing


def answer_bearing(
    speed: float,
    balls: int | None,
    ball_diameter: float | None,
    pitch_diameter: float | None,
    contact_angle: float | None,
    ftf: float | None,
    bpfo: float | None,
    bpfi: float | None,
    bsf: float | None,
    cage: float | None,
) -> BearingAnswer:
    """Frequencies of a bearing at a speed of its shaft, slip of its cage [theory: spindle, eq. 17-19]."""
    require_positive("speed", speed)
    orders = dict(zip(ORDERS, (ftf, bpfo, bpfi, bsf), strict=True))
    given = {name: value for name, value in orders.items() if value is not None}
    lengths = {"ball_diameter": ball_diameter, "pitch_diameter": pitch_diameter}
    fit: BearingFit | None = None
    if given:
        for name, length in lengths.items():
            if length is not None:
                raise InputError(name, length, "left out where frequencies are given, which tell it")
        fit = fit_bearing(
            given, balls, contact_angle if contact_angle is not None or bsf is not None else 0.0
        )
        found = fit.bearing
    else:
        for name, value in {"balls": balls, **lengths}.items():
            if value is None:
                raise InputError(name, None, "given, or frequencies such as ftf in place of dimensions")
        assert balls is not None and ball_diameter is not None and pitch_diameter is not None
        require_positive("pitch_diameter", pitch_diameter)
        if not 0.0 < ball_diameter < pitch_diameter:
            allowed = f"above 0 and below the pitch diameter, {pitch_diameter:g} m"
            raise InputError("ball_diameter", ball_diameter, allowed)
        found = Bearing(balls, ball_diameter / pitch_diameter, contact_angle or 0.0)
    slip = None
    if cage is not None:
        require_not_negative("cage", cage)
        slip = cage_slip(cage, found.orders()["ftf"] * speed)
    return BearingAnswer(found, speed, found.orders(), given, fit, cage, slip)
