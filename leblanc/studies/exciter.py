"""What a scene of kind "exciter" answers: stuck speeds, platform vibration and the critical speed."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from leblanc.results.exciter import Check, ExciterResult
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


def run_exciter(scene: Scene) -> ExciterResult:
    """Answer of a scene of kind "exciter" over its speeds.

    Parameters
    ----------
    scene : the scene

    Raises
    ------
    InputError : its rotor is of another kind, or has no damping
    """
    from leblanc.scene.rotors import Exciter as ExciterOfScene

    if not isinstance(scene.rotor, ExciterOfScene):
        raise InputError("rotor.kind", scene.rotor.kind, "exciter for this")
    answer = answer_exciter(scene.rotor.machine(), scene.speed_array(), scene.name, scene.assumed)
    return replace(answer, source=scene.source, digest=scene.digest)


def printed_critical(numbers: Dimensionless) -> float:
    """Critical speed over the natural frequency by the source's regression, nan outside its ranges.

    Parameters
    ----------
    numbers : of the exciter
    """
    values = (numbers.smallness, numbers.drag, numbers.unbalance, numbers.damping)
    if all(low <= x <= high for x, (low, high) in zip(values, RANGES.values(), strict=True)):
        return float(printed_critical_speed(*values))
    return math.nan


def answer_exciter(
    machine: Exciter,
    speed: ArrayLike,
    name: str = "exciter",
    assumed: tuple[str, ...] = (),
    start: Start | None = None,
    checks: int = CHECKS,
) -> ExciterResult:
    """Stuck speeds, vibration and critical speed of an exciter [theory: balls, eq. 7-14] [YF17, eq. 8-9].

    Gravity is left out, as in the source.

    Parameters
    ----------
    machine : with some damping of the platform and of the balls
    speed : of the shaft, rad/s, shape (n,), above 0
    name, assumed : of the scene
    start : of the time integrations
    checks : how many time integrations, spread over the speeds up to a quarter beyond the critical one

    Raises
    ------
    InputError : a speed that is not positive and finite, a machine without damping
    """
    spin = np.array(speed, dtype=float).reshape(-1)
    if not np.all(np.isfinite(spin) & (spin > 0.0)):
        raise InputError("speed", spin.tolist(), "finite numbers above 0")
    numbers, unit, start = machine.dimensionless(), machine.natural_frequency, start or Start()
    stuck = stuck_speeds(spin / unit, numbers)
    motions = [platform_motion(numbers, n, q) for n, q in zip(spin / unit, stuck[:, 0], strict=True)]
    slow, fast = np.abs(np.array(motions)).T * machine.length
    known = characteristic_speeds(numbers)
    critical = math.nan
    if not math.isnan(known.merger):
        critical = critical_speed(numbers, machine.ball_count, start).holds * unit
    return ExciterResult(
        name=name,
        assumed=assumed,
        machine=machine,
        numbers=numbers,
        start=start,
        speed=spin,
        stuck=stuck * unit,
        slow=slow,
        fast=fast,
        dual_frequency=spin <= critical if math.isfinite(critical) else np.ones(spin.shape, dtype=bool),
        characteristic=(known.second_pair * unit, known.through_resonance * unit, known.merger * unit),
        critical=critical,
        printed_critical=printed_critical(numbers) * unit,
        checks=_checks(machine, numbers, _checked_speeds(spin, critical, checks), start),
    )


def _checked_speeds(speed: Array, critical: float, count: int) -> Array:
    """Speeds of the scene spread from its lowest to a quarter beyond the critical one."""
    end = min(float(speed.max()), 1.25 * critical) if math.isfinite(critical) else float(speed.max())
    wanted = np.linspace(float(speed.min()), max(end, float(speed.min())), count)
    nearest = np.abs(speed[:, None] - wanted).argmin(axis=0)
    return np.unique(speed[nearest])


def _checks(machine: Exciter, numbers: Dimensionless, speeds: Array, start: Start) -> tuple[Check, ...]:
    """Integrate at a few speeds."""
    unit, found = machine.natural_frequency, []
    for speed in speeds:
        motion = integrate(numbers, float(speed) / unit, machine.ball_count, start)
        found.append(
            Check(
                speed=float(speed),
                stuck_speed=motion.stuck_speed * unit,
                slow=motion.slow * machine.length,
                fast=motion.fast * machine.length,
                holds=motion.holds,
                converged=motion.converged,
            )
        )
    return tuple(found)
