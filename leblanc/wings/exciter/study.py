"""What a scene of kind "exciter" answers: stuck speeds, platform vibration and the critical speed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from leblanc.wings.exciter.answer import ExciterAnswer, ExciterExplanation, TimeCheck
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.rotor.exciter.machine import (
    Dimensionless,
    Exciter,
    characteristic_speeds,
    platform_motion,
    stuck_speeds,
)
from solvers.rotor.exciter.motion import RANGES, Start, critical_speed, integrate, printed_critical_speed

if TYPE_CHECKING:
    from leblanc.scene.scene import Scene


CHECKS = 5  # time integrations beside the formulas


def run_exciter(scene: Scene) -> ExciterAnswer:
    """Answer of a scene of kind "exciter" over its speeds."""
    of = {"name": scene.name, "source": scene.source, "assumed": scene.assumed, "digest": scene.digest}
    return answer_exciter(_machine(scene), scene.speed_array(), of=of)


def _machine(scene: Scene) -> Exciter:
    """The machine of a scene; an `InputError` where its rotor is of another kind."""
    from leblanc.scene.rotors import Exciter as ExciterRotor

    if not isinstance(scene.rotor, ExciterRotor):
        raise InputError("rotor.kind", scene.rotor.kind, "exciter for this")
    return scene.rotor.machine()


def explain_exciter(scene: Scene) -> ExciterExplanation:
    """Numbers that determine how an exciter behaves, without integration in time [YF17, eq. 2-7 and 13]."""
    machine = _machine(scene)
    unit = machine.natural_frequency
    return ExciterExplanation(
        *(scene.name, scene.source, scene.assumed, scene.digest),
        **_known(machine),
        speed_ratio=(scene.speeds.start / unit, scene.speeds.stop / unit),
    )


def _known(machine: Exciter) -> dict[str, Any]:
    """What is known without any integration in time, by the names of the answer."""
    numbers, unit = machine.dimensionless(), machine.natural_frequency
    values, printed = (numbers.smallness, numbers.drag, numbers.unbalance, numbers.damping), math.nan
    if all(low <= x <= high for x, (low, high) in zip(values, RANGES.values(), strict=True)):
        printed = float(printed_critical_speed(*values))
    known = characteristic_speeds(numbers)
    return {
        "natural_frequency": unit,
        "dimensionless": numbers,
        "characteristic": (known.second_pair * unit, known.through_resonance * unit, known.merger * unit),
        "critical_speed_printed": printed * unit,
    }


def answer_exciter(
    machine: Exciter,
    speed: ArrayLike,
    checks: int = CHECKS,
    of: Mapping[str, Any] | None = None,
) -> ExciterAnswer:
    """Stuck speeds, vibration and critical speed of an exciter [theory: balls, eq. 7-14] [YF17, eq. 8-9].

    The shaft speeds are above 0, rad/s, shape (n,); so many time integrations are spread over those up to a
    quarter beyond the critical one. Gravity is left out, as in the source. `of` names the scene.
    """
    spin = np.array(speed, dtype=float).reshape(-1)
    if not np.all(np.isfinite(spin) & (spin > 0.0)):
        raise InputError("speed", spin.tolist(), "finite numbers above 0")
    numbers, unit, start = machine.dimensionless(), machine.natural_frequency, Start()
    stuck = stuck_speeds(spin / unit, numbers)
    motions = [platform_motion(numbers, n, q) for n, q in zip(spin / unit, stuck[:, 0], strict=True)]
    slow, fast = np.abs(np.array(motions)).T * machine.length
    critical = math.nan
    if not math.isnan(characteristic_speeds(numbers).merger):
        critical = critical_speed(numbers, machine.ball_count, start).holds * unit
    return ExciterAnswer(
        **{"name": "exciter", "source": "", "assumed": (), "digest": "", **(of or {})},
        **_known(machine),
        machine=machine,
        start=start,
        speed=spin,
        stuck_speeds=stuck * unit,
        amplitude_slow=slow,
        amplitude_fast=fast,
        dual_frequency=spin <= critical if math.isfinite(critical) else np.ones(spin.shape, dtype=bool),
        critical_speed=critical,
        checks=_checks(machine, numbers, _checked_speeds(spin, critical, checks), start),
    )


def _checked_speeds(speed: Array, critical: float, count: int) -> Array:
    """Speeds of the scene spread from its lowest to a quarter beyond the critical one."""
    end = min(float(speed.max()), 1.25 * critical) if math.isfinite(critical) else float(speed.max())
    wanted = np.linspace(float(speed.min()), max(end, float(speed.min())), count)
    nearest = np.abs(speed[:, None] - wanted).argmin(axis=0)
    return np.unique(speed[nearest])


def _checks(machine: Exciter, numbers: Dimensionless, speeds: Array, start: Start) -> tuple[TimeCheck, ...]:
    """Integrate at a few speeds."""
    unit, found = machine.natural_frequency, []
    for speed in speeds:
        motion = integrate(numbers, float(speed) / unit, machine.ball_count, start)
        found.append(
            TimeCheck(
                speed=float(speed),
                stuck_speed=motion.stuck_speed * unit,
                slow=motion.slow * machine.length,
                fast=motion.fast * machine.length,
                holds=motion.holds,
                converged=motion.converged,
            )
        )
    return tuple(found)
