"""The response of a machine to its unbalance over speed: what `run` answers."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, fields
from itertools import pairwise
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from leblanc.core.answer import Result, attributes, carried
from leblanc.core.netcdf import NamedArrays, Variable, finite, flags, pair
from leblanc.core.netcdf import variable as var
from leblanc.core.notes import Note, one_line, texts
from leblanc.results.base import FilledChamber
from leblanc.results.choice import ModelSpan
from leblanc.results.machine.keys import Loaded
from leblanc.results.machine.loads import MachineLoads
from leblanc.results.motion.closed_forms import ClosedForms
from leblanc.results.motion.held import HELD_MODELS, MOTIONS, Held, numbered
from leblanc.results.motion.self_excited import SelfExcited
from leblanc.results.motion.tilting import Motion
from meshes.arrays import Array, Complex, Flags
from meshes.errors import InputError
from solvers.rotor.balance_quality import GRADES, grade_name, grade_of
from solvers.synchronous.peaks import highest
from solvers.synchronous.response import Response, by_speed


def grade_words(quality: float) -> str:
    """The finest grade of ISO 21940-11 that a balance quality, m/s, keeps, in words."""
    grade = grade_of(quality)
    return f"above {grade_name(GRADES[-1])}" if grade is None else grade_name(grade)


_CIRCLE = 1e-9  # of the deflection, that the part against the spin may have in a circle
SCALARS = ("liquid_mass", "critical_speed_dry", "critical_speed_wet", "capture_speed")
STABILITY = ("not_known", "unstable", "stable")
# What there is none of without a chamber: an empty list for scripts, no variable in the data file.
OF_LIQUID = (
    *("liquid_offset", "liquid_angle", "dry_patch", "model", "error_estimate", "critical_speeds_wet"),
    *("chamber_deflection", "chamber_real", "chamber_imag", "critical_speed_wet", "capture_speed"),
    "carried_from",
)
STATES = ("dry_patch", "stable", "model", "in_range", "converged")  # over speed


def phase(deflection: NDArray[np.complex128]) -> Array:
    """Angle from the unbalance to the deflection, rad in (-pi, pi], negative for a lag; 0 for none."""
    angle = np.angle(deflection)
    angle = np.where(angle <= -math.pi, math.pi, angle)
    return np.where(deflection == 0.0, 0.0, angle)


def peak(deflection: NDArray[np.complex128] | Array) -> int | None:
    """Index of the largest deflection, the first of equals; None if there is no finite one."""
    size = np.abs(deflection)
    known = np.asarray(np.isfinite(size))
    return int(np.argmax(np.where(known, size, -1.0))) if known.any() else None


@dataclass(frozen=True)
class RunResult(Loaded, Result):
    """Response to the unbalance at each speed, the machine it belongs to, and what a reader must know.

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

    figure: ClassVar[str] = "leblanc.studies.run.figure:amplitude_figure"
    summary: ClassVar[str] = "leblanc.studies.run.words:summary"

    name: str  #: of the scene, free text
    source: str
    assumed: tuple[str, ...]  #: field paths of the values that no source gives
    inputs: tuple[tuple[str, str, str], ...]  #: label, value with its unit, field path
    digest: str  #: of the scene
    response: Response  #: the answer at each speed, SI
    liquid_mass: float  #: of all chambers, kg
    notes: tuple[Note, ...]  #: limits of validity and findings
    axis: str  #: "horizontal" or "vertical"
    chambers: tuple[FilledChamber, ...]  #: one for each chamber
    #: from it on a ring of liquid can stand against gravity across the axis, rad/s; None if at any
    capture_speed: float | None
    #: without liquid and with its added mass, rad/s; of several the one at which the unbalance moves the axis
    #: most
    critical_speed_dry: float
    critical_speed_wet: float
    motion: Motion | None = None  #: None for a planar rotor
    whirl: SelfExcited | None = None  #: None where it was not computed
    #: relative, of amplitude and liquid the larger one, nan where there is none, shape (n,); None where
    #: nothing was estimated
    error_estimate: Array | None = None
    #: which liquid model answers at which speeds, how well, and why; empty where that is not known
    models: tuple[ModelSpan, ...] = ()
    tolerance: float | None = None  #: relative error that the scene allows; None where nothing was estimated
    #: the answer between these speeds as well, where it takes that to find the largest amplitudes, by rising
    #: speed; None where nobody looked
    refined: Response | None = None
    #: unbalance of rotor and liquid together over the rotor's mass times the speed, and that of the rotor
    #: alone, m/s [theory: balance_quality, eq. 1]; infinite where the motion is; shape (n,); None where no
    #: mass spins
    balance_quality: Array | None = None
    balance_quality_dry: Array | None = None
    axial_gravity: float = 0.0  #: gravity along the axis, m/s^2
    held: Held | None = None  #: of speeds at which the motion was held in time; None where it was at none
    #: forces and clearances at the speeds of `curve`; None where the scene asks for none
    loads: MachineLoads | None = None
    #: speed from which the walls carry the liquid round from rest, rad/s, inf where nothing drags on it; None
    #: where that is not asked or not known
    carried_from: float | None = None
    #: what the sources' closed forms say beside the answer; None where nobody asked
    closed_forms: ClosedForms | None = None

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
    def chamberless(self) -> bool:
        """The machine has no chamber: it is the one without liquid."""
        return not self.chambers

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
        """Largest amplitude over the range of speeds and where it is, m and rad/s.

        Of the speeds at which the answer holds: found and in the range of its model; of all where it holds at
        none. The amplitude is infinite where it has no bound; both are nan where nothing was found.
        """
        return asdict(self.curve.peak)

    @property
    def peak_dry(self) -> dict[str, float]:
        """The same of the rotor without liquid, which is known at every speed."""
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
        return np.asarray(np.isin(curve.model, list(HELD_MODELS)) & curve.converged & ~curve.stable)

    # Held states; every branch; what a rotor adds that is not planar.
    held_at = carried("held.at")
    held_error = carried("held.error")
    held_wave_error = carried("held.wave_error")
    held_whirl_speed = carried("held.whirl_speed")
    held_reason = carried("held.reason")
    held_solver = carried("held.solver")
    energy_error = carried("held.energy_error")
    liquid_mean = carried("held.liquid")
    liquid_ripple = carried("held.ripple")
    amplitude_down = carried("held.amplitude_down")
    state_down = carried("held.state_down")
    branches = carried("response.branch_deflection")
    branch_stable = carried("response.branch_stable")
    whirl_bands = carried("whirl.bands")
    whirl_bands_not_known = carried("whirl.not_known")
    self_excited_amplitude = carried("whirl.large.amplitude")
    self_excited_whirl_speed = carried("whirl.large.whirl_speed")
    cycles = carried("whirl.large.cycles")
    folds = carried("whirl.large.folds")
    position = carried("motion.position")
    backward = carried("motion.backward")
    chamber_deflection = carried("motion.chamber_forward")
    natural_frequency = carried("motion.natural_frequency")
    natural_damping_ratio = carried("motion.natural_damping_ratio")
    critical_speeds_dry = carried("motion.critical_speeds_dry")
    critical_speeds_wet = carried("motion.critical_speeds_wet")
    upright = carried("closed_forms.upright")
    vector_model = carried("closed_forms.vector")
    balancing = carried("closed_forms.balancing")
    cage_speed = carried("closed_forms.cage_speed")

    def to_json(self) -> dict[str, Any]:
        """What `run` prints for scripts: plain Python values, SI, radians, complex numbers as [re, im].

        Lists run over speed, with None (null) where nothing was found; `branches` has one list for each
        speed, of as many deflections as there are branches. The amplitude of a peak is None where it has no
        bound. `refined` has speeds of its own; `curve` has those of both, so that its largest amplitude in
        range is the peak. Without a chamber lists of the liquid are empty.
        """
        r = self.response
        present = ~np.isnan(r.branch_deflection)
        ends = np.cumsum(np.count_nonzero(present, axis=1)).tolist()
        rows = [slice(start, stop) for start, stop in pairwise([0, *ends])]
        branches, branch_stable = finite(r.branch_deflection[present]), r.branch_stable[present].tolist()
        found: dict[str, Any] = {
            "speed": finite(r.speed),
            "amplitude": finite(self.amplitude),
            "amplitude_min": finite(self.amplitude_min),
            "amplitude_max": finite(self.amplitude_max),
            "state": self.state.tolist(),
            "amplitude_dry": finite(self.amplitude_dry),
            "peak": _numbers(self.peak),
            "peak_dry": _numbers(self.peak_dry),
            "phase": finite(phase(r.deflection)),
            "liquid_offset": finite(r.liquid_offset),
            "liquid_angle": finite(r.liquid_angle),
            **{name: getattr(r, name).tolist() for name in STATES},
            "stability": self.stability.tolist(),
            "deflection": finite(r.deflection),
            "branches": [branches[row] for row in rows],
            "branch_stable": [branch_stable[row] for row in rows],
            **{name: getattr(self, name) for name in ("name", "digest", *SCALARS)},
            "carried_from": None if self.carried_from is None else finite(np.array([self.carried_from]))[0],
            "assumed": list(self.assumed),
            "notes": list(texts(self.notes)),
            **({} if self.error_estimate is None else {"error_estimate": finite(self.error_estimate)}),
            **_quality_json(self),
            **({} if self.motion is None else self.motion.to_json()),
            **({} if self.whirl is None else self.whirl.to_json()),
            **_curve_json(self),
            **({} if self.held is None else self.held.to_json()),
            **({} if self.loads is None else self.loads.to_json()),
            **({} if self.closed_forms is None else self.closed_forms.to_json()),
        }
        if self.chamberless:
            of_liquid = found.keys() & OF_LIQUID
            found |= {name: [] if isinstance(found[name], list) else None for name in of_liquid}
        return found

    def named_arrays(self) -> NamedArrays:
        """Arrays over the dimensions `speed`, `curve_speed` and `branch`; units and names in the attributes.

        `amplitude` stands at the speeds asked for; `curve_amplitude` is the whole curve with its peaks.

        netCDF has no complex numbers and no truth values: deflections are pairs `_real`, `_imag`, truth
        values are bytes with `flag_meanings`. There is no time stamp, so one result gives one file, byte for
        byte, as long as the versions of xarray, h5netcdf and HDF5 stay the same.
        """
        rank = np.arange(self.response.branch_deflection.shape[1], dtype=np.int32)
        own = {
            "inputs": "\n".join(one_line("{}: {} [{}]".format(*entry)) for entry in self.inputs),
            **({} if self.chamberless else {"model": ", ".join(self.models_used)}),
            "axis": self.axis,
        }
        columns = _variables(self)
        if self.chamberless:
            columns = {name: column for name, column in columns.items() if name not in OF_LIQUID}
        return NamedArrays(
            columns,
            coords={
                "speed": var(("speed",), self.speed, "rad s-1", "spin speed", "of the rotor about its axis"),
                **_further_speeds(self),
                "branch": var(("branch",), rank, "1", "branch", "rank by rising amplitude"),
            },
            attrs=attributes(self, "run", own, self.notes),
        )


def _numbers(found: dict[str, float]) -> dict[str, float | None]:
    """The same, None in place of what is not finite."""
    return {name: value if math.isfinite(value) else None for name, value in found.items()}


def _curve_json(result: RunResult) -> dict[str, Any]:
    """Amplitudes between the speeds asked for, and the curve through both, which has the peaks."""
    if result.refined is None:
        return {}
    names, curve = ("speed", "amplitude", "amplitude_dry"), result.curve
    refined = {name: finite(getattr(result.refined, name)) for name in names}
    whole = {name: finite(getattr(curve, name)) for name in names} | {"in_range": curve.in_range.tolist()}
    return {"refined": refined, "curve": whole}


def _quality_json(result: RunResult) -> dict[str, Any]:
    """Balance quality over speed."""
    if result.balance_quality is None or result.balance_quality_dry is None:
        return {}
    names = "balance_quality", "balance_quality_dry"
    return {name: finite(getattr(result, name)) for name in names}


def _variables(result: RunResult) -> dict[str, Variable]:
    """Variables of the dataset by name."""
    r, over, each, rate = result.response, ("speed",), ("speed", "branch"), "rad s-1"
    states = np.where(np.isnan(r.branch_deflection), -1, r.branch_stable)
    # The last one has the value 1.
    stability = np.array([STABILITY.index(state) - 1 for state in result.stability.tolist()])
    motion = numbered(result.state)
    mass, dry, wet, capture = (np.array(getattr(result, name), dtype=np.float64) for name in SCALARS)
    carried = np.array(math.nan if result.carried_from is None else result.carried_from)
    reported = "of the branch reported, at the speeds asked for: curve_amplitude has the peaks between them"
    lag, slow = "from the unbalance, positive with the spin, a lag is negative", "against slow disturbances"
    return {
        "amplitude": var(over, result.amplitude, "m", "amplitude", reported),
        "amplitude_min": var(over, result.amplitude_min, "m", "least amplitude", "over time"),
        "amplitude_max": var(over, result.amplitude_max, "m", "largest amplitude", "over time"),
        "state": flags(*(over, motion, " ".join(MOTIONS), "state of the motion"), "once it is settled"),
        "amplitude_dry": var(over, result.amplitude_dry, "m", "amplitude", "without liquid"),
        "phase": var(over, phase(r.deflection), "rad", "phase of the deflection", lag),
        "phase_dry": var(over, phase(r.deflection_dry), "rad", "phase without liquid", lag),
        **pair("deflection", over, r.deflection, "deflection of the branch reported"),
        **pair("deflection_dry", over, r.deflection_dry, "deflection without liquid"),
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
        **pair("branch", each, r.branch_deflection, "deflection of every branch"),
        "branch_stable": flags(each, states, "absent unstable stable", "stability of every branch", slow),
        "liquid_mass": var((), mass, "kg", "liquid mass", "of all chambers"),
        "critical_speed_dry": var((), dry, rate, "critical speed without liquid", "undamped"),
        "critical_speed_wet": var((), wet, rate, "critical speed with liquid", "undamped, wall wet"),
        "capture_speed": var((), capture, rate, "capture speed", "a ring can stand above it"),
        "carried_from": var((), carried, rate, "speed of balance", "from rest the walls carry the liquid"),
        **_peak_variables(result),
        **_quality_variables(result),
        **_error_variables(result),
        **({} if result.motion is None else result.motion.variables()),
        **({} if result.whirl is None else result.whirl.variables()),
        **({} if result.held is None else result.held.variables()),
        **({} if result.loads is None else result.loads.variables()),
        **({} if result.closed_forms is None else result.closed_forms.variables()),
    }


def _further_speeds(result: RunResult) -> dict[str, Variable]:
    """The speeds between those asked for, and both together, dimensions of their own."""
    if result.refined is None:
        return {}
    text = "between those asked for, where it takes that to find the largest amplitudes"
    whole, both = result.curve.speed, "those asked for and those between them: the whole curve with its peaks"
    return {
        "refined_speed": var(("refined_speed",), result.refined.speed, "rad s-1", "refined spin speed", text),
        "curve_speed": var(("curve_speed",), whole, "rad s-1", "spin speed of the curve", both),
    }


def _peak_variables(result: RunResult) -> dict[str, Variable]:
    """Largest amplitudes over the range of speeds, and the amplitudes that were looked at for them."""
    found, most = {}, "largest amplitude over the"
    holds, every = f"{most} speeds at which the answer holds", f"{most} whole range of speeds, without liquid"
    for name, peak, whole in (("peak", result.peak, holds), ("peak_dry", result.peak_dry, every)):
        speed, size = (np.array(peak[key], dtype=np.float64) for key in ("speed", "amplitude"))
        found[f"{name}_speed"] = var((), speed, "rad s-1", "speed of the peak", f"of the {whole}")
        found[f"{name}_amplitude"] = var((), size, "m", "peak", whole)
    if result.refined is not None:
        over, text = ("refined_speed",), "at the refined speeds"
        wet, dry = result.refined.amplitude, result.refined.amplitude_dry
        found["refined_amplitude"] = var(over, wet, "m", "amplitude", text)
        found["refined_amplitude_dry"] = var(over, dry, "m", "amplitude", f"{text}, without liquid")
        over, curve, text = ("curve_speed",), result.curve, "the whole curve with its peaks"
        wet, dry = curve.amplitude, curve.amplitude_dry
        found["curve_amplitude"] = var(over, wet, "m", "amplitude", text)
        found["curve_amplitude_dry"] = var(over, dry, "m", "amplitude", f"{text}, without liquid")
        found["curve_in_range"] = flags(over, curve.in_range, "no yes", "in range", "the liquid model holds")
    return found


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
