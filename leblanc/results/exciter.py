"""What `run` answers of a vibrating table whose balls can stick: stuck speeds and vibration over speed."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from leblanc.core.answer import Result, attributes, carried
from leblanc.core.netcdf import NamedArrays, flags
from leblanc.core.netcdf import variable as var
from meshes.arrays import Array, Flags

if TYPE_CHECKING:
    from solvers.rotor.exciter.machine import Dimensionless, Exciter
    from solvers.rotor.exciter.motion import Start


@dataclass(frozen=True)
class Check:
    """One time integration beside the formulas."""

    speed: float  #: of the shaft, rad/s
    stuck_speed: float  #: mean speed of the balls, rad/s
    slow: float  #: amplitudes of the platform, m; nan where they cannot be distinguished
    fast: float
    holds: bool  #: the dual-frequency motion holds
    converged: bool  #: every number is finite


@dataclass(frozen=True)
class ExciterResult(Result):
    """Answer over speed; n speeds.

    Examples
    --------
    >>> import leblanc as lb
    >>> result = lb.run(lb.example("vibratory_table").replace({"speeds.count": 2}))
    >>> result.stuck.shape
    (2, 3)
    """

    figure: ClassVar[str] = "leblanc.figures.exciter:exciter_figure"
    summary: ClassVar[str] = "leblanc.text.exciter:facts"

    name: str  #: of the scene
    assumed: tuple[str, ...]  #: values that it assumes
    machine: Exciter  #: the exciter
    numbers: Dimensionless  #: its dimensionless numbers
    start: Start  #: from which the critical speed is searched
    speed: Array  #: of the shaft, rad/s, shape (n,)
    #: speeds at which the balls can stick together, by size, rad/s, nan where there are fewer, shape (n, 3)
    stuck: Array
    slow: Array  #: amplitudes of the platform, m, shape (n,), the balls at the slowest stuck speed
    fast: Array
    dual_frequency: Flags  #: below the critical speed, shape (n,)
    #: shaft speeds between which there are three stuck speeds and, second, where the slowest passes the
    #: resonance, rad/s; nan if there is one at every speed
    characteristic: tuple[float, float, float]
    #: largest shaft speed at which the dual-frequency motion is reached, rad/s; nan if there is one stuck
    #: speed at every speed
    critical: float
    printed_critical: float  #: by the source's regression, rad/s; nan outside its ranges
    checks: tuple[Check, ...]  #: time integrations
    source: str = ""  #: of the scene
    digest: str = ""

    @property
    def converged(self) -> bool:
        """Every time integration stayed finite."""
        return all(check.converged for check in self.checks)

    @property
    def amplitude(self) -> Array:
        """Vibration of the platform with the shaft, and with the balls where they stick, m, shape (n,)."""
        return np.asarray(self.fast + np.where(self.dual_frequency, self.slow, 0.0))

    @property
    def amplitude_dry(self) -> Array:
        """Vibration with the shaft alone, m, shape (n,)."""
        return self.fast

    @property
    def phase(self) -> Array:
        """Angle from the shaft's unbalance to the platform's motion, rad, negative where it lags."""
        ratio = self.speed / self.machine.natural_frequency
        return -np.arctan2(2.0 * self.numbers.damping * ratio, 1.0 - np.square(ratio))

    @property
    def liquid_offset(self) -> Array:
        """There is no liquid: nan, shape (n,)."""
        return np.full(self.speed.shape, np.nan)

    liquid_angle = liquid_offset

    @property
    def dry_patch(self) -> Flags:
        """No wall can run dry, shape (n,)."""
        return np.zeros(self.speed.shape, dtype=np.bool_)

    @property
    def model(self) -> NDArray[np.str_]:
        """What answers at each speed, shape (n,)."""
        return np.full(self.speed.shape, "balls")

    @property
    def characteristic_speeds(self) -> dict[str, float | None]:
        """Shaft speeds where the stuck speeds change, rad/s, by name."""
        return named_speeds(self.characteristic)

    stable = carried("dual_frequency")
    stuck_speeds = carried("stuck")
    amplitude_slow = carried("slow")
    amplitude_fast = carried("fast")
    critical_speed = carried("critical")
    critical_speed_printed = carried("printed_critical")
    natural_frequency = carried("machine.natural_frequency")
    dimensionless = carried("numbers")

    def to_json(self) -> dict[str, Any]:
        """What `run` prints for scripts: SI units, radians, null for what is not there."""
        nothing = [None] * self.speed.size
        return {
            "speed": self.speed.tolist(),
            "amplitude": self.amplitude.tolist(),
            "amplitude_dry": self.amplitude_dry.tolist(),
            "phase": self.phase.tolist(),
            "liquid_offset": nothing,
            "liquid_angle": nothing,
            "dry_patch": self.dry_patch.tolist(),
            "stable": self.stable.tolist(),
            "model": self.model.tolist(),
            "stuck_speeds": [[number_or_none(speed) for speed in row] for row in self.stuck],
            "amplitude_slow": self.slow.tolist(),
            "amplitude_fast": self.fast.tolist(),
            "dual_frequency": self.dual_frequency.tolist(),
            "characteristic_speeds": self.characteristic_speeds,
            "critical_speed": number_or_none(self.critical),
            "critical_speed_printed": number_or_none(self.printed_critical),
            "natural_frequency": self.machine.natural_frequency,
            "dimensionless": asdict(self.numbers),
            "start": asdict(self.start),
            "checks": [
                asdict(check) | {"slow": number_or_none(check.slow), "fast": number_or_none(check.fast)}
                for check in self.checks
            ],
        }

    def named_arrays(self) -> NamedArrays:
        """Arrays over the dimensions `speed`, `pair` (of stuck speeds) and `check` (time integrations)."""
        over, rate = ("speed",), "rad s-1"
        first, through, last = self.characteristic
        checks = {
            name: np.array([getattr(check, name) for check in self.checks])
            for name in ("speed", "stuck_speed", "slow", "fast", "holds")
        }
        slow, fast = "with the balls, slowest stuck speed", "with the shaft"
        return NamedArrays(
            {
                "stuck_speed": var(("speed", "pair"), self.stuck, rate, "stuck speed of the balls"),
                "amplitude": var(over, self.amplitude, "m", "amplitude", "of the platform, both vibrations"),
                "amplitude_slow": var(over, self.slow, "m", "slow vibration of the platform", slow),
                "amplitude_fast": var(over, self.fast, "m", "fast vibration of the platform", fast),
                "dual_frequency": flags(over, self.dual_frequency, "no yes", "the balls stick together"),
                "second_pair": var((), first, rate, "shaft speed", "from here on three stuck speeds"),
                "through_resonance": var((), through, rate, "shaft speed", "slowest at the resonance"),
                "merger": var((), last, rate, "shaft speed", "up to here three stuck speeds"),
                "critical_speed": var((), self.critical, rate, "critical speed", "balls stick up to it"),
                "check_speed": var(("check",), checks["speed"], rate, "shaft speed", "integrated in time"),
                "check_stuck_speed": var(("check",), checks["stuck_speed"], rate, "speed of the balls"),
                "check_slow": var(("check",), checks["slow"], "m", "slow vibration", "integrated in time"),
                "check_fast": var(("check",), checks["fast"], "m", "fast vibration", "integrated in time"),
                "check_holds": flags(("check",), checks["holds"], "no yes", "the balls stay"),
            },
            coords={"speed": var(over, self.speed, rate, "shaft speed", "of the exciter")},
            attrs=attributes(self, "run", {}, ()),
        )


def named_speeds(characteristic: tuple[float, float, float]) -> dict[str, float | None]:
    """Characteristic shaft speeds by name, None where there are none.

    Parameters
    ----------
    characteristic : second pair, through the resonance, merger, rad/s
    """
    names = ("second_pair", "through_resonance", "merger")
    return dict(zip(names, map(number_or_none, characteristic), strict=True))


def number_or_none(value: float) -> float | None:
    """The number, None where it is not finite."""
    return float(value) if math.isfinite(value) else None
