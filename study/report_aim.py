"""What an optimisation is after, in units that engineers use."""

from __future__ import annotations

from study.inputs import ML
from study.optimise_table import Aim
from study.record import MM, RPM
from study.words import number

Row = tuple[str, str, str]

MOST = 6  # speeds of a duty cycle that are listed one by one
_DEFAULT = Aim()


def aim_rows(aim: Aim) -> list[Row]:
    """Label, value with its unit and name of what an aim says beyond its defaults; the objective always.

    Parameters
    ----------
    aim : what the liquid is chosen for
    """
    said = [("Objective", aim.objective, "objective")]
    for name, label, text in (
        ("working_speed", "Working speed", _speed(aim.working_speed)),
        ("steady", "Peak", "of the steady response"),
        ("duty", "Duty cycle", _duty(aim)),
        ("vibration_limit", "Vibration limit", _length(aim.vibration_limit)),
        ("limit_at", "Limit holds at", f"{aim.limit_at.replace('_', ' ')} speeds"),
        ("deflection", "Deflection given", _length(aim.deflection)),
        ("unbalance", "Unbalance range", _range(aim.unbalance, 1e6, "g mm")),
        ("temperature", "Temperature range", _range(aim.temperature, 1.0, "K")),
        ("quantile", "Quantile", number(aim.quantile)),
        ("samples", "Samples of the ranges", f"{aim.samples}"),
        ("seed", "Seed", f"{aim.seed}"),
        ("dry_patch", "Dry wall", "not allowed at the working speed"),
        ("stability_margin", "Stability margin", _rate(aim.stability_margin)),
        ("operating", "Operating speeds", _range(aim.operating, RPM, "rpm")),
        ("clearance", "Clearance", _length(aim.clearance)),
        ("volumes", "Volumes", _volumes(aim)),
    ):
        if getattr(aim, name) != getattr(_DEFAULT, name):
            said.append((label, text, name))
    return said


def _speed(value: float | None) -> str:
    return "" if value is None else f"{number(value * RPM)} rpm"


def _length(value: float | None) -> str:
    return "" if value is None else f"{number(value * MM)} mm"


def _rate(value: float | None) -> str:
    return "" if value is None else f"at least {number(value)} 1/s"


def _range(ends: tuple[float, float] | None, unit: float, name: str) -> str:
    return "" if ends is None else f"{number(ends[0] * unit)} to {number(ends[1] * unit)} {name}"


def _duty(aim: Aim) -> str:
    parts = [f"{number(speed * RPM)} rpm (weight {number(weight)})" for speed, weight in aim.duty]
    if len(parts) <= MOST:
        return ", ".join(parts)
    return f"{len(parts)} speeds from {parts[0]} to {parts[-1]}"


def _volumes(aim: Aim) -> str:
    parts = [
        f"chamber {k + 1} {number(low * ML)} to {number(high * ML)} ml"
        for k, (low, high) in enumerate(aim.volumes)
    ]
    return ", ".join(parts)
