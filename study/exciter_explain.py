"""What decides how a scene of kind "exciter" behaves, without any integration in time."""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import Any

from meshes.border import InputError
from solvers.rotor.stuck import characteristic_speeds
from study.exciter import machine_of, printed_critical
from study.scene import Scene
from study.scene_rotor import Exciter as ExciterOfScene


def explain_exciter(scene: Scene) -> dict[str, Any]:
    """Numbers that decide how an exciter behaves, without any integration in time [YF17, eq. 2-7 and 13].

    Parameters
    ----------
    scene : with a rotor of kind "exciter"

    Returns
    -------
    Name, natural frequency and characteristic shaft speeds, rad/s, dimensionless numbers, and the source's
    critical speed, rad/s, by its regression; None where there is none

    Raises
    ------
    InputError : its rotor is of another kind
    """
    if not isinstance(scene.rotor, ExciterOfScene):
        raise InputError("rotor.kind", scene.rotor.kind, "exciter for this")
    machine = machine_of(scene.rotor)
    numbers, unit = machine.dimensionless(), machine.natural_frequency
    known = characteristic_speeds(numbers)
    return {
        "name": scene.name,
        "natural_frequency": unit,
        "speed_ratio": [scene.speeds.start / unit, scene.speeds.stop / unit],
        "dimensionless": asdict(numbers),
        "characteristic_speeds": {
            "second_pair": _number(known.second_pair * unit),
            "through_resonance": _number(known.through_resonance * unit),
            "merger": _number(known.merger * unit),
        },
        "critical_speed_printed": _number(printed_critical(numbers) * unit),
    }


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
