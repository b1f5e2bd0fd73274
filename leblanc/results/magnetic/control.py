"""What `run` answers of a rotor in magnetic bearings: poles, margins, loads, a trial in time."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from leblanc.core.answer import Result, attributes, carried
from leblanc.core.netcdf import NamedArrays, Variable, flags
from leblanc.core.netcdf import variable as var
from leblanc.results.base import number_or_none
from meshes.arrays import Array, Complex, Flags

if TYPE_CHECKING:
    from solvers.rotor.magnetic.machine import Dimensionless, MagneticRotor
    from solvers.rotor.magnetic.motion import Load, Motion

MARGINS = ("gain_up", "gain_down", "phase_margin", "delay_margin", "sensitivity")


@dataclass(frozen=True)
class LoadAnswer:
    """What one load does, by the linear loop."""

    name: str  #: as in the scene, or gravity
    frequency: float  #: rad/s; nan of a constant load
    peak: float  #: largest deflection in a bearing after it comes on, m; nan of a harmonic load
    settled: float  #: deflection in the end, of a harmonic load its amplitude, m
    current: float  #: control current in the end, of a harmonic load its amplitude, A


@dataclass(frozen=True)
class Followed:
    """A trial in time."""

    motion: Motion  #: all of it
    #: time from which the rotor stays within the band until the next load comes on, s; inf if never
    settled: float
    after_loads: float  #: largest deflection in a bearing from the first later load on, m; nan without one
    left: float  #: largest deflection in a bearing in the last tenth, m
    most_current: float  #: largest control current, A


@dataclass(frozen=True)
class Controlled:
    """One controller; n speeds, p poles."""

    name: str  #: `synergetic` or `pid`
    poles: Complex  #: of the closed loop, the slowest first, 1/s, shape (n, p)
    gain_up: Array  #: largest and smallest factor of the loop gain, shape (n,)
    gain_down: Array
    phase_margin: Array  #: rad, shape (n,)
    delay_margin: Array  #: s, shape (n,)
    sensitivity: Array  #: largest, shape (n,); all margins are nan where the loop is not stable
    #: complex deflection along x of the first bearing, of the unbalances alone, m, shape (n,)
    unbalance: Complex
    amplitude: Array  #: largest deflection in a bearing, of the unbalances alone, m, shape (n,)
    current: Array  #: amplitude of the control current, of the unbalances alone, A, shape (n,)
    loads: tuple[LoadAnswer, ...]  #: what each load does
    trial: Followed | None  #: in time; None where the scene has none

    @property
    def stable(self) -> Flags:
        """All poles decay, shape (n,)."""
        return np.asarray(self.poles.real.max(axis=-1) < 0.0)

    def to_json(self) -> dict[str, Any]:
        """Its part of what `run` prints: poles as [re, im]."""
        found: dict[str, Any] = {
            "poles": np.stack((self.poles.real, self.poles.imag), axis=-1).tolist(),
            **{name: [number_or_none(x) for x in getattr(self, name)] for name in MARGINS},
            "stable": self.stable.tolist(),
            "amplitude": self.amplitude.tolist(),
            "current": self.current.tolist(),
            "loads": [
                {key: x if key == "name" else number_or_none(x) for key, x in asdict(load).items()}
                for load in self.loads
            ],
        }
        if (trial := self.trial) is not None:
            motion = trial.motion
            found["trial"] = {
                "ending": motion.ending.value,
                "settled": number_or_none(trial.settled),
                "after_loads": number_or_none(trial.after_loads),
                "left": trial.left,
                "most_current": trial.most_current,
                "time": motion.time.tolist(),
                "speed": motion.speed.tolist(),
                "displacement": motion.displacement.tolist(),
                "current": motion.current.tolist(),
            }
        return found


@dataclass(frozen=True)
class MagneticResult(Result):
    """Answer over speed; n speeds.

    Examples
    --------
    >>> import leblanc as lb
    >>> pump = lb.example("blood_pump").replace({"speeds.count": 2, "rotor.trial.duration": 0.01})
    >>> result = lb.run(pump)
    >>> [control.name for control in result.controllers], bool(result.stable.all())
    (['synergetic', 'pid'], True)
    """

    figure: ClassVar[str] = "leblanc.figures.magnetic.control:magnetic_figure"
    summary: ClassVar[str] = "leblanc.text.magnetic:facts"

    name: str  #: of the scene
    assumed: tuple[str, ...]  #: values that it assumes
    machine: MagneticRotor  #: the rotor
    numbers: Dimensionless  #: its dimensionless numbers
    speed: Array  #: rad/s, shape (n,)
    controllers: tuple[Controlled, ...]  #: at least one
    loads: tuple[Load, ...]  #: from outside, gravity among them where it lies across the axis
    load_speed: float  #: at which the loads are answered, rad/s
    band: float  #: about the centre within which the rotor has settled, m
    source: str = ""  #: of the scene
    digest: str = ""

    @property
    def converged(self) -> bool:
        """Every trial came to its end, or to a magnet."""
        trials = [control.trial for control in self.controllers if control.trial is not None]
        return all(trial.motion.ending.value != "failed" for trial in trials)

    @property
    def amplitude(self) -> Array:
        """Largest deflection in a bearing, by the unbalances, with the first controller, m, shape (n,)."""
        return self.controllers[0].amplitude

    amplitude_dry = amplitude

    @property
    def phase(self) -> Array:
        """Angle from the unbalance to the deflection, rad, negative where it lags, shape (n,)."""
        return np.asarray(np.angle(self.controllers[0].unbalance))

    @property
    def liquid_offset(self) -> Array:
        """No liquid is carried: nan, shape (n,)."""
        return np.full(self.speed.shape, np.nan)

    liquid_angle = liquid_offset

    @property
    def dry_patch(self) -> Flags:
        """No wall can run dry, shape (n,)."""
        return np.zeros(self.speed.shape, dtype=np.bool_)

    @property
    def stable(self) -> Flags:
        """All poles decay with the first controller, shape (n,)."""
        return self.controllers[0].stable

    @property
    def model(self) -> NDArray[np.str_]:
        """What answers at each speed, the first controller, shape (n,)."""
        return np.full(self.speed.shape, self.controllers[0].name)

    @property
    def controls(self) -> dict[str, Controlled]:
        """Each controller's answer by its name."""
        return {control.name: control for control in self.controllers}

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
            "controls": {name: control.to_json() for name, control in self.controls.items()},
            "load_speed": self.load_speed,
            "band": self.band,
            "dimensionless": {key: number_or_none(x) for key, x in asdict(self.numbers).items()},
        }

    def named_arrays(self) -> NamedArrays:
        """Arrays over `control`, `speed`, `pole`; of trials `time` and `axis`, nan after their end."""
        over, each = ("speed",), ("control", "speed")
        widest = max(control.poles.shape[1] for control in self.controllers)
        poles = np.full((len(self.controllers), self.speed.size, widest), np.nan + 0j)
        for k, control in enumerate(self.controllers):
            poles[k, :, : control.poles.shape[1]] = control.poles

        def all_of(name: str) -> Array:
            return np.array([getattr(control, name) for control in self.controllers])

        found = {
            "pole_real": var((*each, "pole"), poles.real, "s-1", "decay of a pole", "of the closed loop"),
            "pole_imag": var((*each, "pole"), poles.imag, "rad s-1", "frequency of a pole", "damped"),
            "gain_up": var(each, all_of("gain_up"), "1", "gain margin", "largest factor of the loop gain"),
            "gain_down": var(each, all_of("gain_down"), "1", "gain margin", "smallest factor"),
            "phase_margin": var(each, all_of("phase_margin"), "rad", "phase margin", "at all four currents"),
            "delay_margin": var(each, all_of("delay_margin"), "s", "delay margin", "at all four currents"),
            "sensitivity": var(each, all_of("sensitivity"), "1", "largest sensitivity", "over frequency"),
            "stable": flags(each, all_of("stable"), "no yes", "the closed loop is stable"),
            "amplitude": var(each, all_of("amplitude"), "m", "deflection in a bearing", "of the unbalances"),
            "current": var(each, all_of("current"), "A", "control current", "of the unbalances"),
        }
        coords = {
            "speed": var(over, self.speed, "rad s-1", "spin speed", "of the rotor"),
            "control": var(("control",), np.array([c.name for c in self.controllers]), "1", "controller", ""),
        }
        trials = [control.trial for control in self.controllers if control.trial is not None]
        if trials:
            found |= _in_time([trial.motion for trial in trials])
            longest = max((trial.motion.time for trial in trials), key=len)
            coords["time"] = var(("time",), longest, "s", "time", "of the trial")
        return NamedArrays(found, coords=coords, attrs=attributes(self, "run", {}, ()))


def _in_time(motions: list[Motion]) -> dict[str, Variable]:
    """Displacements and currents of trials on the times of the longest."""
    count = max(motion.time.size for motion in motions)
    place, current = (np.full((len(motions), count, 4), math.nan) for _ in range(2))
    for k, motion in enumerate(motions):
        place[k, : motion.time.size], current[k, : motion.time.size] = motion.displacement, motion.current
    over = ("control", "time", "axis")
    what = "first x, first y, second x, second y"
    return {
        "displacement": var(over, place, "m", "displacement in the bearings", what),
        "control_current": var(over, current, "A", "control current in time", what),
    }
