"""The response of a machine to its unbalance over speed: what `run` answers."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, field, fields
from itertools import pairwise
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from leblanc.results.base import FilledChamber, Note, Result, attributes, carried, one_line, texts
from leblanc.results.choice import ModelSpan
from leblanc.results.netcdf import NamedArrays, Variable, flags
from leblanc.results.netcdf import variable as var
from meshes.arrays import Array, Complex, Flags
from meshes.errors import InputError
from solvers.rotor.balance_quality import GRADES, grade_name, grade_of
from solvers.rotor.campbell import Campbell
from solvers.synchronous.peaks import highest
from solvers.synchronous.response import Response, by_speed


@dataclass(frozen=True)
class RestMode:
    """Free vibration of the dry rotor at rest.

    Parameters
    ----------
    frequency : damped, rad/s; 0 where overdamped
    damping_ratio : 1 where overdamped
    moves : what moves most, in words
    """

    frequency: float
    damping_ratio: float
    moves: str


@dataclass(frozen=True)
class Motion:
    """What a rotor that tilts, or moves differently in two directions, adds to a planar one.

    The axis goes round as forward e^{i Omega t} + backward e^{-i Omega t}; the deflections of the response
    are the forward part. s speeds, b branches, c chambers.

    Parameters
    ----------
    position : along the axis of the plane reported, m
    backward, backward_dry : m, shape (s,)
    branch_backward : m, shape (s, b)
    chamber_forward : at each chamber, m, shape (s, c)
    modes : of the dry rotor at rest, by rising frequency
    campbell : natural frequencies of the dry rotor over its speed
    critical_speeds_dry, critical_speeds_wet : undamped, each with the direction of its whirl, -1 to 1
    zero : what angles count from, in words
    refined_forward : as chamber_forward, at the refined speeds; none if empty, shape (r, c)
    """

    position: float
    backward: NDArray[np.complex128]
    backward_dry: NDArray[np.complex128]
    branch_backward: NDArray[np.complex128]
    chamber_forward: NDArray[np.complex128]
    modes: tuple[RestMode, ...]
    campbell: Campbell
    critical_speeds_dry: tuple[tuple[float, float], ...]
    critical_speeds_wet: tuple[tuple[float, float], ...]
    zero: str
    refined_forward: Complex = field(default_factory=lambda: np.zeros((0, 0), dtype=complex))

    @property
    def natural_frequency(self) -> list[float]:
        """Of each mode of the dry rotor at rest, rad/s."""
        return [mode.frequency for mode in self.modes]

    @property
    def natural_damping_ratio(self) -> list[float]:
        """Of each of these modes."""
        return [mode.damping_ratio for mode in self.modes]


@dataclass(frozen=True)
class SelfExcited:
    """Whirl that grows by itself from the even layer, in linear theory.

    Parameters
    ----------
    growth : of the whirl that grows most, 1/s, nan where it was not found, shape (n,)
    whirl_speed : of that whirl in the standing frame, rad/s, shape (n,)
    bands : of speed in which some whirl grows, rad/s; the ends of the range of speeds count as edges
    friction : of the liquid, in words
    not_known : bands of speed in which the modes were not found, between the nearest speeds where they were,
        rad/s
    """

    growth: Array
    whirl_speed: Array
    bands: tuple[tuple[float, float], ...]
    friction: str
    not_known: tuple[tuple[float, float], ...] = ()

    def leaves_stable(self, stable: Flags) -> Flags:
        """Stable against slow disturbances, and no whirl grows; what is not known is not stable, shape (n,).

        Parameters
        ----------
        stable : against slow disturbances, shape (n,)
        """
        return np.asarray(stable & (self.growth <= 0.0))

    def inside(self, speed: Array) -> Flags:
        """Whether speeds lie inside a band in which a whirl grows, shape (n,)."""
        found = np.zeros(speed.shape, dtype=bool)
        for low, high in self.bands:
            found |= (speed >= low) & (speed <= high)
        return found


@dataclass(frozen=True)
class Held:
    """What rotor and long waves do at the speeds at which they were held in time until they settled.

    n speeds, c chambers. At the other speeds numbers are nan and states are "steady".

    Parameters
    ----------
    at : where that was done, shape (n,)
    state : one of `MOTIONS`, as met while the speed rises, shape (n,)
    least, largest : distance of the axis from where it rests, over time, m, shape (n,)
    whirl_speed : of the whirl that goes round beside the spin, in space, nan without one, rad/s, shape (n,)
    liquid : mean of each layer's centre of mass from its chamber's axis, in the drum, m, shape (n, c)
    ripple : largest distance of it from that mean, m, shape (n, c)
    error : estimated from half the cells, over the largest distance, shape (n,)
    state_down, amplitude_down : while the speed falls, m, shape (n,)
    cells : round each wall
    reason : why the motion has not settled, else empty, shape (n,); no entry where that is not known
    """

    at: Flags
    state: NDArray[np.str_]
    least: Array
    largest: Array
    whirl_speed: Array
    liquid: Complex
    ripple: Array
    error: Array
    state_down: NDArray[np.str_]
    amplitude_down: Array
    cells: int
    reason: NDArray[np.str_] = field(default_factory=lambda: np.zeros(0, dtype="U1"))

    @property
    def limit_cycle(self) -> Flags:
        """Where the motion, as met while the speed rises, is bounded but never repeats, shape (n,)."""
        return np.asarray(self.at & (self.state == "limit_cycle"))

    @property
    def not_settled(self) -> Flags:
        """Where the motion still changed when it was given up, shape (n,)."""
        return np.asarray(self.at & (self.state == "not_settled"))

    @property
    def hysteresis(self) -> Flags:
        """Where the motion depends on whether the speed rises or falls, shape (n,).

        What has not settled on either way is no motion of its own.
        """
        settled = (self.state != "not_settled") & (self.state_down != "not_settled")
        return np.asarray(self.at & settled & ~np.isnan(self.amplitude_down))


MOTIONS = ("steady", "periodic", "limit_cycle", "not_settled")
HELD_MODEL = "long_wave"  # the liquid model of motions held in time


def grade_words(quality: float) -> str:
    """The finest grade of ISO 21940-11 that a balance quality keeps, in words.

    Parameters
    ----------
    quality : m/s

    Examples
    --------
    >>> grade_words(0.005), grade_words(5.0)
    ('G 6.3', 'above G 4000')
    """
    grade = grade_of(quality)
    return f"above {grade_name(GRADES[-1])}" if grade is None else grade_name(grade)


_CIRCLE = 1e-9  # of the deflection, that the part against the spin may have in a circle
SCALARS = ("liquid_mass", "critical_speed_dry", "critical_speed_wet", "capture_speed")
STABILITY = ("not_known", "unstable", "stable")
STATES = ("dry_patch", "stable", "model", "in_range", "converged")  # over speed


def phase(deflection: NDArray[np.complex128]) -> Array:
    """Angle from the unbalance to the deflection.

    Parameters
    ----------
    deflection : complex, the unbalance pointing along the real axis, m, shape (...,)

    Returns
    -------
    rad in (-pi, pi], negative where the deflection lags, 0 where there is none, shape (...,).
    """
    angle = np.angle(deflection)
    angle = np.where(angle <= -math.pi, math.pi, angle)
    return np.where(deflection == 0.0, 0.0, angle)


def peak(deflection: NDArray[np.complex128] | Array) -> int | None:
    """Index of the largest deflection, the first of equals; None if there is no finite one.

    Parameters
    ----------
    deflection : complex or its size, nan where nothing was found, m, shape (n,)
    """
    size = np.abs(deflection)
    known = np.asarray(np.isfinite(size))
    return int(np.argmax(np.where(known, size, -1.0))) if known.any() else None


@dataclass(frozen=True)
class RunResult(Result):
    """Response to the unbalance at each speed, the machine it belongs to, and what a reader must know.

    Parameters
    ----------
    name, source : of the scene, free text
    assumed : field paths of the values that no source gives
    inputs : label, value with its unit, field path
    digest : of the scene
    response : the answer at each speed, SI
    liquid_mass : of all chambers, kg
    notes : limits of validity and findings
    axis : "horizontal" or "vertical"
    chambers : one for each chamber
    capture_speed : below it gravity keeps the liquid from riding with the drum, rad/s; None if never
    critical_speed_dry, critical_speed_wet : without liquid and with its added mass, rad/s; of several the one
        at which the unbalance moves the axis most
    motion : None for a planar rotor
    whirl : None where it was not computed
    error_estimate : relative, of amplitude and liquid the larger one, nan where there is none, shape (n,);
        None where nothing was estimated
    models : which liquid model answers at which speeds, how well, and why; empty where that is not known
    tolerance : relative error that the scene allows; None where nothing was estimated
    refined : the answer between these speeds as well, where it takes that to find the largest amplitudes, by
        rising speed; None where nobody looked
    balance_quality, balance_quality_dry : unbalance of rotor and liquid together over the rotor's mass times
        the speed, and that of the rotor alone, m/s [theory: balance_quality, eq. 1]; infinite where the
        motion is; shape (n,); None where no mass spins
    axial_gravity : gravity along the axis, m/s^2
    held : of speeds at which the motion was held in time; None where it was at none

    Raises
    ------
    InputError : no speed at all, an axis of another name, arrays of the response that do not fit together

    Examples
    --------
    >>> import leblanc as lb
    >>> result = lb.run(lb.example("horizontal_rig"))
    >>> result.models_used, result.to_dataset()["amplitude"].attrs["units"]
    (('linear',), 'm')
    """

    figure: ClassVar[str] = "leblanc.figures.response:amplitude_figure"
    summary: ClassVar[str] = "leblanc.text.run:summary"

    name: str
    source: str
    assumed: tuple[str, ...]
    inputs: tuple[tuple[str, str, str], ...]
    digest: str
    response: Response
    liquid_mass: float
    notes: tuple[Note, ...]
    axis: str
    chambers: tuple[FilledChamber, ...]
    capture_speed: float | None
    critical_speed_dry: float
    critical_speed_wet: float
    motion: Motion | None = None
    whirl: SelfExcited | None = None
    error_estimate: Array | None = None
    models: tuple[ModelSpan, ...] = ()
    tolerance: float | None = None
    refined: Response | None = None
    balance_quality: Array | None = None
    balance_quality_dry: Array | None = None
    axial_gravity: float = 0.0
    held: Held | None = None

    def __post_init__(self) -> None:
        if self.axis not in ("horizontal", "vertical"):
            raise InputError("rotor.axis", self.axis, "horizontal or vertical")
        count = self.response.speed.size
        if self.response.speed.ndim != 1 or count == 0:
            raise InputError("speeds", self.response.speed.shape, "a list of at least one speed")
        branches = self.response.branch_deflection.shape
        for each in fields(self.response):
            if each.name in ("coordinates", "branch_coordinates", "position", "over_time"):
                continue
            shape = getattr(self.response, each.name).shape
            expected = (count, *branches[1:]) if each.name.startswith("branch_") else (count,)
            if shape != expected:
                raise InputError(f"response.{each.name}", shape, f"of shape {expected}")

    @property
    def amplitude(self) -> Array:
        """Largest distance of the axis from the line it rests in, of the branch reported, m, shape (n,)."""
        return self.response.amplitude

    @property
    def amplitude_dry(self) -> Array:
        """The same of the rotor without liquid, m, shape (n,)."""
        return self.response.amplitude_dry

    @property
    def branch_amplitude(self) -> Array:
        """The same of every branch, nan where there is none, m, shape (n, b)."""
        return self.response.branch_amplitude

    @property
    def curve(self) -> Response:
        """The answer at the speeds asked for and at the refined ones, by rising speed: what figures draw."""
        return self.response if self.refined is None else by_speed([self.response, self.refined])

    @property
    def chamber_curve(self) -> Complex:
        """Deflection at each chamber at the speeds of `curve`, m, shape (n, c)."""
        if self.motion is None:
            return np.repeat(self.curve.deflection[:, None], len(self.chambers), axis=1)
        if self.refined is None:
            return self.motion.chamber_forward
        order = np.argsort(np.concatenate((self.speed, self.refined.speed)), kind="stable")
        return np.concatenate((self.motion.chamber_forward, self.motion.refined_forward))[order]

    @property
    def peak(self) -> dict[str, float]:
        """Largest amplitude over the whole range of speeds and where it is, m and rad/s.

        The amplitude is infinite where it has no bound; both are nan where nothing was found.
        """
        return asdict(highest(self.curve.speed, self.curve.amplitude))

    @property
    def peak_dry(self) -> dict[str, float]:
        """The same of the rotor without liquid."""
        return asdict(highest(self.curve.speed, self.curve.amplitude_dry))

    @property
    def speed(self) -> Array:
        """Spin speed, rad/s, shape (n,)."""
        return self.response.speed

    @property
    def deflection(self) -> Complex:
        """Deflection of the branch reported, from the unbalance, m, shape (n,)."""
        return self.response.deflection

    @property
    def deflection_dry(self) -> Complex:
        """The same of the rotor without liquid, m, shape (n,)."""
        return self.response.deflection_dry

    @property
    def phase(self) -> Array:
        """Angle from the unbalance to the deflection, rad, negative where it lags, shape (n,)."""
        return phase(self.response.deflection)

    @property
    def liquid_offset(self) -> Array:
        """Distance of the liquid's centre of mass from the rotation axis, m, shape (n,)."""
        return self.response.liquid_offset

    @property
    def liquid_angle(self) -> Array:
        """Angle from the unbalance to the liquid's centre of mass, rad, shape (n,)."""
        return self.response.liquid_angle

    @property
    def dry_patch(self) -> Flags:
        """The wall is dry somewhere in at least one chamber, shape (n,)."""
        return self.response.dry_patch

    @property
    def stable(self) -> Flags:
        """The branch reported is known to be stable; False where that is not known, shape (n,)."""
        return self.response.stable

    @property
    def stability(self) -> NDArray[np.str_]:
        """Of the branch reported, one of `STABILITY`, shape (n,).

        Not known where no branch was found or the modes of the whirls were not. A motion held in time has
        shown its stability itself; one that has not settled has not.
        """
        kept = self.response.branch_stable.any(axis=1)
        growth = np.zeros(self.speed.shape) if self.growth is None else self.growth
        lost = ~np.isfinite(self.response.deflection) | (kept & np.isnan(growth))
        if self.held is not None:
            growth = np.where(self.held.at, 0.0, growth)
            lost = np.where(self.held.at, self.held.not_settled, lost)
        state = np.where(lost & ~(growth > 0.0), 0, np.where(self.stable, 2, 1))
        return np.asarray(np.array(STABILITY)[state])

    @property
    def model(self) -> NDArray[np.str_]:
        """Name of the liquid model used, shape (n,)."""
        return self.response.model

    @property
    def in_range(self) -> Flags:
        """The liquid model holds there, shape (n,)."""
        return self.response.in_range

    @property
    def converged(self) -> Flags:
        """Every branch was found, shape (n,)."""
        return self.response.converged

    @property
    def growth(self) -> Array | None:
        """Growth of the whirl that grows most by itself, 1/s, shape (n,); None where it was not computed."""
        return None if self.whirl is None else self.whirl.growth

    @property
    def whirl_speed(self) -> Array | None:
        """Speed of that whirl in space, rad/s, shape (n,); None where it was not computed."""
        return None if self.whirl is None else self.whirl.whirl_speed

    @property
    def models_used(self) -> tuple[str, ...]:
        """Names of the liquid models, in the order in which they appear over speed."""
        return tuple(dict.fromkeys(self.curve.model.tolist()))

    @property
    def amplitude_min(self) -> Array:
        """Least distance of the axis from where it rests, over time, m, shape (n,)."""
        least = np.abs(np.abs(self.response.deflection) - np.abs(self.response.backward))
        found = np.where(np.isfinite(self.response.deflection), least, self.amplitude)
        return found if self.held is None else np.where(self.held.at, self.held.least, found)

    @property
    def amplitude_max(self) -> Array:
        """Largest distance of the axis from where it rests, over time, m, shape (n,)."""
        return (
            self.amplitude if self.held is None else np.where(self.held.at, self.held.largest, self.amplitude)
        )

    @property
    def state(self) -> NDArray[np.str_]:
        """What the motion is: one of `MOTIONS`, shape (n,).

        A circle with the spin is steady, an ellipse periodic; a limit cycle never repeats with the turn. To a
        steady answer that is unstable the machine does not settle.
        """
        r = self.response
        ellipse = np.abs(r.backward) > _CIRCLE * np.abs(r.deflection)
        left = ~r.converged | (self.stability == "unstable")
        found = np.where(left, "not_settled", np.where(ellipse, "periodic", "steady"))
        return found if self.held is None else np.where(self.held.at, self.held.state, found)

    @property
    def cycling(self) -> Flags:
        """Where the answer of `curve` is a limit cycle, shape (p,)."""
        curve = self.curve
        return np.asarray((curve.model == HELD_MODEL) & curve.converged & ~curve.stable)

    # Held states; every branch; what a rotor adds that is not planar.
    held_at = carried("held.at")
    held_error = carried("held.error")
    held_whirl_speed = carried("held.whirl_speed")
    held_reason = carried("held.reason")
    liquid_mean = carried("held.liquid")
    liquid_ripple = carried("held.ripple")
    amplitude_down = carried("held.amplitude_down")
    state_down = carried("held.state_down")
    branches = carried("response.branch_deflection")
    branch_stable = carried("response.branch_stable")
    whirl_bands = carried("whirl.bands")
    whirl_bands_not_known = carried("whirl.not_known")
    position = carried("motion.position")
    backward = carried("motion.backward")
    chamber_deflection = carried("motion.chamber_forward")
    natural_frequency = carried("motion.natural_frequency")
    natural_damping_ratio = carried("motion.natural_damping_ratio")
    critical_speeds_dry = carried("motion.critical_speeds_dry")
    critical_speeds_wet = carried("motion.critical_speeds_wet")

    def to_json(self) -> dict[str, Any]:
        """What `run` prints for scripts: plain Python values, SI, radians, complex numbers as [re, im].

        Lists run over speed, with None (null) where nothing was found; `branches` has one list for each
        speed, of as many deflections as there are branches. The amplitude of a peak is None where it has no
        bound; `refined` has speeds of its own.
        """
        r = self.response
        present = ~np.isnan(r.branch_deflection)
        ends = np.cumsum(np.count_nonzero(present, axis=1)).tolist()
        rows = [slice(start, stop) for start, stop in pairwise([0, *ends])]
        branches, branch_stable = _finite(r.branch_deflection[present]), r.branch_stable[present].tolist()
        return {
            "speed": _finite(r.speed),
            "amplitude": _finite(self.amplitude),
            "amplitude_min": _finite(self.amplitude_min),
            "amplitude_max": _finite(self.amplitude_max),
            "state": self.state.tolist(),
            "amplitude_dry": _finite(self.amplitude_dry),
            "peak": _numbers(self.peak),
            "peak_dry": _numbers(self.peak_dry),
            "phase": _finite(phase(r.deflection)),
            "liquid_offset": _finite(r.liquid_offset),
            "liquid_angle": _finite(r.liquid_angle),
            **{name: getattr(r, name).tolist() for name in STATES},
            "stability": self.stability.tolist(),
            "deflection": _finite(r.deflection),
            "branches": [branches[row] for row in rows],
            "branch_stable": [branch_stable[row] for row in rows],
            **{name: getattr(self, name) for name in ("name", "digest", *SCALARS)},
            "assumed": list(self.assumed),
            "notes": list(texts(self.notes)),
            **({} if self.error_estimate is None else {"error_estimate": _finite(self.error_estimate)}),
            **_quality_json(self),
            **_motion_json(self.motion),
            **_whirl_json(self.whirl),
            **_refined_json(self.refined),
            **_held_json(self.held),
        }

    def named_arrays(self) -> NamedArrays:
        """Arrays over the dimensions `speed` and `branch`; units, names and descriptions in the attributes.

        netCDF has no complex numbers and no truth values: deflections are pairs `_real`, `_imag`, truth
        values are bytes with `flag_meanings`. There is no time stamp, so one result gives one file, byte for
        byte, as long as the versions of xarray, h5netcdf and HDF5 stay the same.
        """
        rank = np.arange(self.response.branch_deflection.shape[1], dtype=np.int32)
        own = {
            "inputs": "\n".join(one_line("{}: {} [{}]".format(*entry)) for entry in self.inputs),
            "model": ", ".join(self.models_used),
            "axis": self.axis,
        }
        return NamedArrays(
            _variables(self),
            coords={
                "speed": var(("speed",), self.speed, "rad s-1", "spin speed", "of the rotor about its axis"),
                **_refined_speeds(self.refined),
                "branch": var(("branch",), rank, "1", "branch", "rank by rising amplitude"),
            },
            attrs=attributes(self, "run", own, self.notes),
        )


def _finite(values: NDArray[Any]) -> list[Any]:
    """Nested lists, None in place of what is not finite, complex numbers as [re, im]."""
    known = np.isfinite(values)
    if np.iscomplexobj(values):
        values, known = np.stack([values.real, values.imag], axis=-1), np.stack([known, known], axis=-1)
    if known.all():
        return list(values.tolist())
    found: list[Any] = np.where(known, values, np.array(None)).tolist()
    return found


def _numbers(found: dict[str, float]) -> dict[str, float | None]:
    """The same, None in place of what is not finite."""
    return {name: value if math.isfinite(value) else None for name, value in found.items()}


def _refined_json(refined: Response | None) -> dict[str, Any]:
    """Amplitudes between the speeds asked for."""
    if refined is None:
        return {}
    names = ("speed", "amplitude", "amplitude_dry")
    return {"refined": {name: _finite(getattr(refined, name)) for name in names}}


def _held_json(held: Held | None) -> dict[str, Any]:
    """Motions that were held in time, null at the other speeds."""
    if held is None:
        return {}
    return {
        "held_at": held.at.tolist(),
        "held_error": _finite(held.error),
        "held_whirl_speed": _finite(held.whirl_speed),
        "liquid_mean": _finite(held.liquid),
        "liquid_ripple": _finite(held.ripple),
        "amplitude_down": _finite(held.amplitude_down),
        "state_down": held.state_down.tolist(),
        "held_reason": held.reason.tolist(),
    }


def _quality_json(result: RunResult) -> dict[str, Any]:
    """Balance quality over speed."""
    if result.balance_quality is None or result.balance_quality_dry is None:
        return {}
    names = "balance_quality", "balance_quality_dry"
    return {name: _finite(getattr(result, name)) for name in names}


def _whirl_json(whirl: SelfExcited | None) -> dict[str, Any]:
    """Self-excited whirl over speed, and the bands of speed in which it grows."""
    if whirl is None:
        return {}
    return {
        "growth": _finite(whirl.growth),
        "whirl_speed": _finite(whirl.whirl_speed),
        "whirl_bands": [list(band) for band in whirl.bands],
        "whirl_bands_not_known": [list(band) for band in whirl.not_known],
    }


def _motion_json(motion: Motion | None) -> dict[str, Any]:
    """What a rotor that is not planar adds; critical speeds as [rad/s, direction of the whirl]."""
    if motion is None:
        return {}
    return {
        "position": motion.position,
        "backward": _finite(motion.backward),
        "chamber_deflection": _finite(motion.chamber_forward),
        "natural_frequency": motion.natural_frequency,
        "natural_damping_ratio": motion.natural_damping_ratio,
        "critical_speeds_dry": [list(speed) for speed in motion.critical_speeds_dry],
        "critical_speeds_wet": [list(speed) for speed in motion.critical_speeds_wet],
    }


def _pair(name: str, dims: tuple[str, ...], values: NDArray[Any], long_name: str) -> dict[str, Variable]:
    """Real and imaginary part of a deflection, both nan where one is."""
    values = np.where(np.isnan(values), complex(np.nan, np.nan), values)
    return {
        f"{name}_real": var(dims, values.real, "m", f"{long_name}, real part", "along the unbalance"),
        f"{name}_imag": var(dims, values.imag, "m", f"{long_name}, imaginary part", "90 deg ahead of it"),
    }


def _variables(result: RunResult) -> dict[str, Variable]:
    """Variables of the dataset by name."""
    r, over, each, rate = result.response, ("speed",), ("speed", "branch"), "rad s-1"
    states = np.where(np.isnan(r.branch_deflection), -1, r.branch_stable)
    # The last one has the value 1.
    stability = np.array([STABILITY.index(state) - 1 for state in result.stability.tolist()])
    motion = _numbered(result.state)
    mass, dry, wet, capture = (np.array(getattr(result, name), dtype=np.float64) for name in SCALARS)
    lag, slow = "from the unbalance, positive with the spin, a lag is negative", "against slow disturbances"
    return {
        "amplitude": var(over, result.amplitude, "m", "amplitude", "of the branch reported"),
        "amplitude_min": var(over, result.amplitude_min, "m", "least amplitude", "over time"),
        "amplitude_max": var(over, result.amplitude_max, "m", "largest amplitude", "over time"),
        "state": flags(*(over, motion, " ".join(MOTIONS), "state of the motion"), "once it is settled"),
        "amplitude_dry": var(over, result.amplitude_dry, "m", "amplitude", "without liquid"),
        "phase": var(over, phase(r.deflection), "rad", "phase of the deflection", lag),
        "phase_dry": var(over, phase(r.deflection_dry), "rad", "phase without liquid", lag),
        **_pair("deflection", over, r.deflection, "deflection of the branch reported"),
        **_pair("deflection_dry", over, r.deflection_dry, "deflection without liquid"),
        "liquid_offset": var(over, r.liquid_offset, "m", "liquid offset", "rotation axis to centre of mass"),
        "liquid_angle": var(over, r.liquid_angle, "rad", "angle of the liquid's centre of mass", lag),
        "dry_patch": flags(over, r.dry_patch, "no yes", "dry patch", "the wall is dry somewhere"),
        "stable": flags(over, r.stable, "no yes", "the branch reported is stable", f"{slow} and whirls"),
        "stability": flags(
            *(over, stability, " ".join(STABILITY), "stability of the branch reported"), f"{slow} and whirls"
        ),
        "model": var(over, r.model, "1", "liquid model", "used at this speed"),
        "in_range": flags(over, r.in_range, "no yes", "in range", "the liquid model holds there"),
        "converged": flags(over, r.converged, "no yes", "converged", "every branch was found"),
        **_pair("branch", each, r.branch_deflection, "deflection of every branch"),
        "branch_stable": flags(each, states, "absent unstable stable", "stability of every branch", slow),
        "liquid_mass": var((), mass, "kg", "liquid mass", "of all chambers"),
        "critical_speed_dry": var((), dry, rate, "critical speed without liquid", "undamped"),
        "critical_speed_wet": var((), wet, rate, "critical speed with liquid", "undamped, wall wet"),
        "capture_speed": var((), capture, rate, "capture speed", "the liquid rides with the drum above it"),
        **_peak_variables(result),
        **_quality_variables(result),
        **_error_variables(result),
        **_motion_variables(result),
        **_whirl_variables(result),
        **_held_variables(result.held),
    }


def _refined_speeds(refined: Response | None) -> dict[str, Variable]:
    """The speeds between those asked for, a dimension of their own."""
    if refined is None:
        return {}
    text = "between those asked for, where it takes that to find the largest amplitudes"
    return {"refined_speed": var(("refined_speed",), refined.speed, "rad s-1", "refined spin speed", text)}


def _peak_variables(result: RunResult) -> dict[str, Variable]:
    """Largest amplitudes over the range of speeds, and the amplitudes that were looked at for them."""
    found, whole = {}, "largest amplitude over the whole range of speeds"
    for name, peak, liquid in (("peak", result.peak, ""), ("peak_dry", result.peak_dry, ", without liquid")):
        speed, size = (np.array(peak[key], dtype=np.float64) for key in ("speed", "amplitude"))
        found[f"{name}_speed"] = var((), speed, "rad s-1", "speed of the peak", f"of the {whole}{liquid}")
        found[f"{name}_amplitude"] = var((), size, "m", "peak", f"{whole}{liquid}")
    if result.refined is not None:
        over, text = ("refined_speed",), "at the refined speeds"
        wet, dry = result.refined.amplitude, result.refined.amplitude_dry
        found["refined_amplitude"] = var(over, wet, "m", "amplitude", text)
        found["refined_amplitude_dry"] = var(over, dry, "m", "amplitude", f"{text}, without liquid")
    return found


def _numbered(states: NDArray[np.str_]) -> Array:
    """Motions as numbers of which the last is 1."""
    return np.array([MOTIONS.index(state) - len(MOTIONS) + 2 for state in states.tolist()], dtype=float)


def _held_variables(held: Held | None) -> dict[str, Variable]:
    """Motions that were held in time."""
    if held is None:
        return {}
    over, each, drum = ("speed",), ("speed", "chamber"), "from the chamber's axis, in the drum"
    down, reasons = _numbered(held.state_down), {}
    if held.reason.size:
        text = "why the motion has not settled"
        reasons["held_reason"] = var(over, held.reason, "1", text, "empty where it has, or was not held")
    return {
        "held_at": flags(over, held.at, "no yes", "held", "the motion was held in time until it settled"),
        "held_error": var(over, held.error, "1", "estimated error", "of the held motion, by half the cells"),
        "held_whirl_speed": var(
            over, held.whirl_speed, "rad s-1", "whirl speed", "beside the spin, in space"
        ),
        **_pair("liquid_mean", each, held.liquid, f"mean of the layer's centre of mass {drum}"),
        "liquid_ripple": var(each, held.ripple, "m", "ripple of the layer's centre of mass", "largest"),
        "amplitude_down": var(over, held.amplitude_down, "m", "amplitude", "while the speed falls"),
        "state_down": flags(over, down, " ".join(MOTIONS), "state of the motion", "while the speed falls"),
        **reasons,
    }


def _quality_variables(result: RunResult) -> dict[str, Variable]:
    """Balance quality over speed."""
    if result.balance_quality is None or result.balance_quality_dry is None:
        return {}
    both, text = "of rotor and liquid together", "unbalance over the rotor's mass, times the speed"
    wet, dry = result.balance_quality, result.balance_quality_dry
    return {
        "balance_quality": var(("speed",), wet, "m s-1", "balance quality", f"{text}; {both}"),
        "balance_quality_dry": var(("speed",), dry, "m s-1", "balance quality", f"{text}; without liquid"),
    }


def _error_variables(result: RunResult) -> dict[str, Variable]:
    """Estimated error over speed."""
    if result.error_estimate is None:
        return {}
    text = "relative, of amplitude and liquid the larger one"
    return {"error_estimate": var(("speed",), result.error_estimate, "1", "estimated error", text)}


def _whirl_variables(result: RunResult) -> dict[str, Variable]:
    """Self-excited whirl over speed."""
    if result.whirl is None:
        return {}
    most, over = "of the whirl that grows most", ("speed",)
    return {
        "growth": var(over, result.whirl.growth, "s-1", "growth rate", f"{most}; above 0 unstable"),
        "whirl_speed": var(over, result.whirl.whirl_speed, "rad s-1", "whirl speed", f"{most}, in space"),
    }


def _motion_variables(result: RunResult) -> dict[str, Variable]:
    """What a rotor that is not planar adds; dimensions `mode` and `chamber` come with it."""
    motion, over, each, rate = result.motion, ("speed",), ("speed", "branch"), "rad s-1"
    if motion is None:
        return {}
    c, against = motion.campbell, "turning against the spin"
    by_spin = ("spin", "mode")
    at_rest = np.array([(mode.frequency, mode.damping_ratio) for mode in motion.modes]).reshape(-1, 2)
    sense = "-1 against the spin to 1 with it"
    return {
        **_pair("backward", over, motion.backward, f"part of the deflection {against}"),
        **_pair("backward_dry", over, motion.backward_dry, f"part {against}, without liquid"),
        **_pair("branch_backward", each, motion.branch_backward, f"part of every branch {against}"),
        **_pair("chamber", ("speed", "chamber"), motion.chamber_forward, "deflection at each chamber"),
        "position": var((), motion.position, "m", "position", "of the plane reported, along the axis"),
        "spin": var(("spin",), c.spin, rate, "spin speed", "of the Campbell diagram"),
        "campbell_frequency": var(by_spin, c.frequency, rate, "natural frequency", "damped, without liquid"),
        "campbell_damping_ratio": var(by_spin, c.damping_ratio, "1", "damping ratio", "without liquid"),
        "campbell_direction": var(by_spin, c.direction, "1", "direction of the whirl", sense),
        "natural_frequency": var(("rest_mode",), at_rest[:, 0], rate, "natural frequency", "at rest, dry"),
        "natural_damping_ratio": var(("rest_mode",), at_rest[:, 1], "1", "damping ratio", "at rest, dry"),
    }
