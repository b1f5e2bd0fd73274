"""What a scene of kind "exciter" answers: stuck speeds, platform vibration and the critical speed."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from leblanc.units import MM, RPM
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.rotor.exciter.machine import Dimensionless, Exciter, platform_motion
from solvers.rotor.exciter.motion import RANGES, Start, critical_speed, integrate, printed_critical_speed
from solvers.rotor.exciter.stuck import characteristic_speeds, stuck_speeds

if TYPE_CHECKING:
    from leblanc.scene.scene import Scene


CHECKS = 5  # time integrations beside the formulas


@dataclass(frozen=True)
class Check:
    """One time integration beside the formulas.

    Parameters
    ----------
    speed : of the shaft, rad/s
    stuck_speed : mean speed of the balls, rad/s
    slow, fast : amplitudes of the platform, m; nan where they cannot be told apart
    holds : the dual-frequency motion holds
    converged : every number is finite
    """

    speed: float
    stuck_speed: float
    slow: float
    fast: float
    holds: bool
    converged: bool


@dataclass(frozen=True)
class ExciterRecord:
    """Answer over speed; n speeds.

    Parameters
    ----------
    name : of the scene
    assumed : values that it assumes
    machine : the exciter
    numbers : its dimensionless numbers
    start : from which the critical speed is searched
    speed : of the shaft, rad/s, shape (n,)
    stuck : speeds at which the balls can stick together, by size, rad/s, nan where there are fewer, shape
        (n, 3)
    slow, fast : amplitudes of the platform, m, shape (n,), the balls at the slowest stuck speed
    dual_frequency : below the critical speed, shape (n,)
    characteristic : shaft speeds between which there are three stuck speeds and, second, where the slowest
        passes the resonance, rad/s; nan if there is one at every speed
    critical : largest shaft speed at which the dual-frequency motion is reached, rad/s; nan if there is one
        stuck speed at every speed
    printed_critical : by the source's regression, rad/s; nan outside its ranges
    checks : time integrations
    """

    name: str
    assumed: tuple[str, ...]
    machine: Exciter
    numbers: Dimensionless
    start: Start
    speed: Array
    stuck: Array
    slow: Array
    fast: Array
    dual_frequency: NDArray[np.bool_]
    characteristic: tuple[float, float, float]
    critical: float
    printed_critical: float
    checks: tuple[Check, ...]

    @property
    def converged(self) -> bool:
        """Every time integration stayed finite."""
        return all(one.converged for one in self.checks)


def run_exciter(scene: Scene) -> ExciterRecord:
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
    return answer_exciter(scene.rotor.machine(), scene.speed_array(), scene.name, scene.assumed)


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


def describe_exciter(record: ExciterRecord) -> list[str]:
    """The answer in a few lines of words.

    Parameters
    ----------
    record : the answer
    """
    lines = [f"Natural frequency of the platform: {record.machine.natural_frequency * RPM:.5g} rpm"]
    if math.isfinite(record.critical):
        first, _, last = (speed * RPM for speed in record.characteristic)
        lines += [
            f"Three stuck speeds of the balls from {first:.5g} to {last:.5g} rpm of the shaft",
            f"Critical speed, up to which the balls stick together: {record.critical * RPM:.5g} rpm",
        ]
    else:
        lines.append("One stuck speed of the balls at every speed of the shaft")
    for one in record.checks:
        words = "balls stay" if one.holds else "balls leave"
        both = ""
        if math.isfinite(one.slow):
            both = f", platform {one.slow * MM:.3g} mm with them and {one.fast * MM:.3g} mm with the shaft"
        lines.append(
            f"Integrated at {one.speed * RPM:.5g} rpm: {words} at {one.stuck_speed * RPM:.5g} rpm{both}"
            if one.holds
            else f"Integrated at {one.speed * RPM:.5g} rpm: {words}"
        )
    return lines


def answer_exciter(
    machine: Exciter,
    speed: ArrayLike,
    name: str = "exciter",
    assumed: tuple[str, ...] = (),
    start: Start | None = None,
    checks: int = CHECKS,
) -> ExciterRecord:
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
    return ExciterRecord(
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


def exciter_json(record: ExciterRecord) -> dict[str, Any]:
    """The answer as an object that JSON can hold: SI units, radians, null for what is not there.

    Parameters
    ----------
    record : the answer
    """
    first, through, last = map(_number, record.characteristic)
    nothing = [None] * record.speed.size
    ratio = record.speed / record.machine.natural_frequency
    lag = np.arctan2(2.0 * record.numbers.damping * ratio, 1.0 - np.square(ratio))
    return {
        "speed": record.speed.tolist(),
        "amplitude": (record.fast + np.where(record.dual_frequency, record.slow, 0.0)).tolist(),
        "amplitude_dry": record.fast.tolist(),
        "phase": (-lag).tolist(),
        "liquid_offset": nothing,
        "liquid_angle": nothing,
        "dry_patch": [False] * record.speed.size,
        "stable": record.dual_frequency.tolist(),
        "model": ["balls"] * record.speed.size,
        "stuck_speeds": [[_number(q) for q in row] for row in record.stuck],
        "amplitude_slow": record.slow.tolist(),
        "amplitude_fast": record.fast.tolist(),
        "dual_frequency": record.dual_frequency.tolist(),
        "characteristic_speeds": {"second_pair": first, "through_resonance": through, "merger": last},
        "critical_speed": _number(record.critical),
        "critical_speed_printed": _number(record.printed_critical),
        "natural_frequency": record.machine.natural_frequency,
        "dimensionless": asdict(record.numbers),
        "start": asdict(record.start),
        "checks": [
            asdict(one) | {"slow": _number(one.slow), "fast": _number(one.fast)} for one in record.checks
        ],
    }


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


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
