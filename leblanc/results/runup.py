"""A run-up of a scene: what `runup` answers, for figures, reports, files and scripts."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fluid.friction.laws import Friction
from leblanc.core.answer import Result, attributes
from leblanc.core.netcdf import NamedArrays, flags, variable
from leblanc.core.notes import Note, one_line, texts
from leblanc.core.quantities import to_json
from leblanc.core.units import LENGTH, ZERO_TO_PEAK, friction_words, with_unit
from leblanc.results.base import FilledChamber
from leblanc.results.machine.keys import Loaded
from leblanc.results.motion.passages import Passage, falling, pieces
from leblanc.studies.balls.races import RaceOfBalls, ball_moment, in_race
from leblanc.studies.loads.answer import MachineLoads
from leblanc.studies.run.answer import phase
from leblanc.studies.run.notes import plane_words
from meshes.arrays import Array, Complex, Flags
from solvers.layer.records import Outcome
from solvers.runup.ensemble import Spread
from solvers.runup.machine import Transfer
from solvers.runup.runup import EnergyAudit, RunupHistory
from solvers.synchronous.response import Response

Values = NDArray[Any]
Bands = tuple[tuple[float, float], ...]
# What there is none of without a chamber: an empty list for scripts, no variable in the data file.
OF_LIQUID = (
    *("liquid_offset", "liquid_angle", "liquid_offset_mean", "liquid_angle_mean", "captured"),
    *("depth_max", "depth_min", "mean_rotation", "lag"),
)
_FEWEST = 8  # samples in a mean over turns


@dataclass(frozen=True)
class Moment:
    """An amplitude of a run-up and where it was."""

    amplitude: float  #: m
    speed: float  #: of the spin, rad/s
    time: float  #: s


@dataclass(frozen=True)
class RunupFrames:
    """The layers at regular times, for a film; f frames, l chambers, c cells, all in the drum frame."""

    time: Array  #: s and rad/s, shape (f,)
    speed: Array
    deflection: Complex  #: complex, of each chamber's axis, m, shape (f, l)
    amplitude: Array  #: of the first of them, m, shape (f,)
    theta: Array  #: angle from the drum's zero mark of the cells, rad, shape (c,)
    depth: Array  #: of the layers, m, nan where the liquid is none, shape (f, l, c)
    down: Array  #: angle of gravity's direction, rad, shape (f,)
    pool: Array  #: angle of the middle of liquid that is no layer, rad, shape (f, l)


@dataclass(frozen=True)
class RunupResult(Loaded, Result):
    """A run-up of a scene; k times, l chambers.

    Examples
    --------
    >>> import leblanc as lb
    >>> short = lb.example("runup").replace({"runup.duration": "1 s", "runup.cells": 16})
    >>> result = lb.run_up(short, samples=50, check=False)
    >>> result.model, result.converged, result.amplitude.shape
    ('long_wave', True, (50,))
    """

    name: str  #: of the scene
    source: str
    assumed: tuple[str, ...]
    digest: str
    inputs: tuple[tuple[str, str, str], ...]  #: label, value with its unit, field path
    kind: str  #: of the rotor; "horizontal" or "vertical"
    axis: str
    friction: Friction  #: law and coefficient
    gravity: float  #: across the axis, m/s^2
    model: str  #: of the liquid, "long_wave" or "linear"
    model_reason: str  #: why that one, in words
    #: estimated error of the amplitude over its largest, by the model and by its steps; nan where one of them
    #: is not known
    model_error: float
    cells: int  #: of each layer; whether its waves have the dispersion of the finite depth
    dispersion: bool
    history: RunupHistory  #: of rotor and liquid
    turning: int  #: index of the last time before the speed falls again; the last one of all if it never does
    in_range: Flags  #: the layer describes the liquid at that time, shape (k,)
    #: synchronous response at the speeds passed, of a Jeffcott rotor; None for others
    steady: Response | None
    #: of speed in which some whirl grows by itself, rad/s, an end of the range counting as an edge; None
    #: where they were not looked for
    bands: Bands | None
    chambers: tuple[FilledChamber, ...]  #: one for each chamber; its position along the axis, m
    planes: tuple[float, ...]
    notes: tuple[Note, ...]  #: limits of validity and findings
    frames: RunupFrames | None = None  #: the layers at regular times; None if they were not kept
    #: of the same rotor on the same way without liquid; None if it was not run
    history_dry: RunupHistory | None = None
    #: over an ensemble of runs that rounding tells apart; None if it was not asked for
    spread: Spread | None = None
    #: forces and clearances of each interval; None where the scene asks for none
    loads: MachineLoads | None = None
    bore: str = "none"  #: what bores leave behind, "none" or "enstrophy"
    passages: tuple[Passage, ...] = ()  #: the steps of a programme that were reached; none of a run-up
    #: sizes of all unbalances over what they were at first, shape (k,); None where none leaves
    unbalance_left: Array | None = None
    races: tuple[RaceOfBalls, ...] = ()  #: with the balls that run in them; N balls in all

    figure = "leblanc.figures.runup:speed_figure"
    summary = "leblanc.text.runup:summary"

    @property
    def outcome(self) -> Outcome:
        """How the run ended."""
        return self.history.outcome

    @property
    def converged(self) -> bool:
        """It came to its end, its energy closes, and no axis left its chamber."""
        return self.history.converged and not self.faults

    @property
    def reason(self) -> str:
        """Why, when and at what speed it stopped before its end, or is not physical; empty if neither."""
        return "; ".join((*filter(None, [self.history.reason]), *self.faults))

    @property
    def faults(self) -> tuple[str, ...]:
        """Violations term by term: energy balance, heat below zero, deflection beyond a chamber's radius."""
        return run_faults(self.history, self.chambers)

    @property
    def energy_error(self) -> float:
        """What the energy balance leaves over its scale: `energy.closure`."""
        return self.energy.closure

    @property
    def time(self) -> Array:
        """Times, s, shape (k,)."""
        return self.history.time

    @property
    def speed(self) -> Array:
        """Spin speed, rad/s, shape (k,)."""
        return self.history.speed

    @property
    def amplitude(self) -> Array:
        """Modulus of the first deflection, m, shape (k,)."""
        return self.history.amplitude

    @property
    def speed_dry(self) -> Array:
        """Spin speed of the run without liquid, rad/s, nan where it was not run, shape (k,)."""
        return self._dry("speed")

    @property
    def amplitude_dry(self) -> Array:
        """Modulus of the first deflection without liquid, m, nan where it was not run, shape (k,)."""
        return self._dry("amplitude")

    @property
    def plane(self) -> str:
        """Plane of the amplitude, in words; empty for a rotor that moves in one plane."""
        return "" if self.kind == "jeffcott" else plane_words(self.planes[0], chambers=True)

    @property
    def bare(self) -> bool:
        """Neither liquid nor balls are on the rotor: it is the one that it is compared with."""
        return not self.races and bool(self.layer_mass.sum() == 0.0)

    @property
    def chamberless(self) -> bool:
        """The machine has no chamber at all, with liquid or with balls."""
        return not self.chambers and not self.races

    @property
    def without(self) -> str:
        """What the run that it is compared with lacks, in words."""
        liquid = bool(self.layer_mass.sum() > 0.0)
        return "without " + (
            "liquid and balls" if liquid and self.races else "balls" if self.races else "liquid"
        )

    @property
    def ball_angle(self) -> Array:
        """Angle of each ball in the drum, from its zero mark, whole turns counted, rad, shape (k, N)."""
        return self.history.ball_angle

    @property
    def ball_speed(self) -> Array:
        """Speed of each ball in space, rad/s, shape (k, N)."""
        return self.history.ball_speed

    @property
    def ball_unbalance(self) -> Array:
        """Size of the unbalance of all balls together, kg m, shape (k,)."""
        return np.asarray(np.abs(ball_moment(self.races, self.ball_angle)))

    @property
    def ball_unbalance_angle(self) -> Array:
        """Its angle from the drum's zero mark, rad, shape (k,)."""
        return np.asarray(np.angle(ball_moment(self.races, self.ball_angle)))

    @property
    def deflection(self) -> Complex:
        """Of the first chamber's axis, in the drum frame, m, shape (k,)."""
        return np.asarray(self.history.deflection[:, 0] * np.exp(-1j * self.history.angle))

    @property
    def phase(self) -> Array:
        """Angle of that deflection from the drum's zero mark, where a Jeffcott rotor has its unbalance."""
        return phase(self.deflection)

    @property
    def liquid_position(self) -> Complex:
        """Liquid's centre of mass in the drum frame, m, shape (k,)."""
        return self.history.liquid_position

    @property
    def mean_position(self) -> Complex:
        """The same as a mean over whole turns, m, shape (k,)."""
        return turn_mean(self.history.liquid_position, self.history.angle)

    @property
    def motor_limited(self) -> Flags | None:
        """The motor gave less than the programme asked on the way to each time, shape (k,); None if never."""
        limited = self.history.limited
        return limited if limited is not None and limited.any() else None

    @property
    def captured(self) -> Flags:
        """Each layer rides with its drum, shape (k, l)."""
        return self.history.captured

    @property
    def depth_min(self) -> Array:
        """Least depth of each layer, m, nan while it is not captured, shape (k, l)."""
        return self.history.depth_min[:, : len(self.chambers)]

    @property
    def depth_max(self) -> Array:
        """Largest depth of each layer, m, nan while it is not captured, shape (k, l)."""
        return self.history.depth_max[:, : len(self.chambers)]

    @property
    def mean_rotation(self) -> Array:
        """Rotation of each layer relative to its drum, rad/s, shape (k, l)."""
        return self.history.mean_rotation[:, : len(self.chambers)]

    @property
    def layer_mass(self) -> Array:
        """Mass of each layer, kg, shape (l,)."""
        return self.history.layer_mass

    @property
    def mass_error(self) -> float:
        """Largest relative change of a layer's volume."""
        return self.history.mass_error

    @property
    def error_estimate(self) -> float:
        """Error of the amplitude by half the cells, relative to its largest; nan if it was not estimated."""
        return self.history.error_estimate

    @property
    def lag(self) -> Array:
        """Rotation of each layer or pool behind its drum, rad/s, shape (k, l)."""
        return np.asarray(-self.mean_rotation)

    @property
    def handover_estimate(self) -> float:
        """Error of the amplitude by how liquid becomes a ring, over its largest; nan if none does."""
        return self.history.handover_estimate

    @property
    def amplitude_error(self) -> Array:
        """Error of the amplitude by cells, steps and hand-over, m, nan if not estimated, shape (k,)."""
        band = self.history.band
        return np.full(self.time.shape, math.nan) if band is None else band

    @property
    def peak_error(self) -> dict[str, float]:
        """Error of the run's largest amplitude, m: `cells` (and steps), `handover`; nan if not estimated."""
        return dict(zip(("cells", "handover"), self.history.peak_gaps, strict=True))

    @property
    def energy(self) -> EnergyAudit:
        """Where the energy went."""
        return self.history.audit

    @property
    def steps(self) -> int:
        """Steps of time."""
        return self.history.steps

    @property
    def transfers(self) -> tuple[Transfer, ...]:
        """Liquid that became a layer or fell, with what was handed over."""
        return self.history.transfers

    @property
    def turns_back(self) -> bool:
        """The speed falls again after it has risen."""
        return bool(self.falling.any()) and not bool(self.falling[1:].all())

    @property
    def falling(self) -> Flags:
        """The speed falls on the way to a sample, shape (k,)."""
        return falling(self.history, self.passages, self.turning)

    @property
    def liquid_offset(self) -> Array:
        """Distance of the liquid's centre of mass from the rotation axis, m, shape (k,)."""
        return np.asarray(np.abs(self.liquid_position))

    @property
    def liquid_angle(self) -> Array:
        """Its angle from the drum's zero mark, rad, shape (k,)."""
        return np.asarray(np.angle(self.liquid_position))

    @property
    def liquid_offset_mean(self) -> Array:
        """Distance of its mean over whole turns, m, shape (k,)."""
        return np.asarray(np.abs(self.mean_position))

    @property
    def liquid_angle_mean(self) -> Array:
        """Angle of that mean, rad, shape (k,)."""
        return np.asarray(np.angle(self.mean_position))

    @property
    def peak(self) -> dict[str, float]:
        """Amplitude, speed and time of the largest amplitude on the way up."""
        return asdict(self.crest())

    @property
    def peak_back(self) -> dict[str, float]:
        """The same on the way back."""
        return asdict(self.crest(back=True))

    @property
    def peak_dry(self) -> dict[str, float]:
        """The largest amplitude on the way up without liquid; nan if that was not run."""
        if self.history_dry is None:
            return asdict(Moment(math.nan, math.nan, math.nan))
        return asdict(_crest(self.history_dry, self._way(self.history_dry, False)))

    @property
    def ensemble(self) -> dict[str, Any] | None:
        """What rounding alone does: ranges over time and of the peak, m; None if it was not asked for."""
        if self.spread is None:
            return None
        shares = {name: getattr(self.spread, name) for name in ("peak_spread", "largest_spread")}
        return {field.name: getattr(self.spread, field.name) for field in fields(self.spread)} | shares

    @property
    def end(self) -> dict[str, float]:
        """Amplitude, speed, time and angles at the end."""
        last = self.time.size - 1
        angles = ("phase", "liquid_offset", "liquid_angle")
        return asdict(self.moment(last)) | {name: float(getattr(self, name)[last]) for name in angles}

    def crest(self, back: bool = False) -> Moment:
        """Largest amplitude of all steps on the way up, or on the way back, kept or not."""
        return _crest(self.history, self._way(self.history, back))

    def curve(self, back: bool = False, dry: bool = False) -> tuple[Array, Array, Array]:
        """Time, speed and amplitude, s, rad/s, m, on the way up or back, the largest among them.

        nan between parts of a programme; `dry` is without liquid, empty where that was not run.
        """
        history = self.history_dry if dry else self.history
        if history is None or (back and not self.turns_back):
            return np.empty(0), np.empty(0), np.empty(0)
        way = self._way(history, back)
        if not way.any():
            return np.empty(0), np.empty(0), np.empty(0)
        crest, gap = _crest(history, way), np.full((3, 1), np.nan)
        found: list[Array] = []
        # The way back is drawn from where it turns.
        for shown in self.pieces(history, back):
            rows = np.array([history.time[shown], history.speed[shown], history.amplitude[shown]])
            if rows[0, 0] <= crest.time <= rows[0, -1] and crest.time not in rows[0]:
                place = int(np.searchsorted(rows[0], crest.time))
                rows = np.insert(rows, place, (crest.time, crest.speed, crest.amplitude), axis=1)
            found += [gap, rows] if found else [rows]
        time, speed, amplitude = np.concatenate(found, axis=1)
        return time, speed, amplitude

    def whole_curve(self, dry: bool = False) -> tuple[Array, Array, Array]:
        """The same on both ways, one after the other."""
        ways = np.concatenate((self.curve(False, dry), self.curve(True, dry)), axis=1)
        # They share the samples at which the run turns.
        _, first = np.unique(ways[0], return_index=True)
        time, speed, amplitude = ways[:, first[~np.isnan(ways[0, first])]]
        return time, speed, amplitude

    def pieces(self, history: RunupHistory, back: bool) -> list[slice]:
        """Parts of the way up or of the way back, each from where it turns."""
        return pieces(self._way(history, back))

    def _way(self, history: RunupHistory, back: bool) -> Flags:
        """Which samples are of the way up, or of the way back; all of a run that only falls or only rises."""
        if not self.turns_back:
            return np.ones(history.time.size, dtype=bool)
        return np.asarray(falling(history, self.passages, self.turning) == back)

    def moment(self, index: int) -> Moment:
        """Amplitude, speed and time of one sample."""
        return Moment(*(float(getattr(self, name)[index]) for name in ("amplitude", "speed", "time")))

    def in_range_at(self, time: float) -> bool:
        """The layer is a fair picture of the liquid at a time, s: at the next sample."""
        return bool(self.in_range[min(int(np.searchsorted(self.time, time)), self.time.size - 1)])

    def to_json(self) -> dict[str, Any]:
        """What `runup` prints for scripts, SI and radians; of chambers a list in each list over time.

        Without a chamber lists of the liquid are empty.
        """
        over = ["time", "speed", "amplitude", "speed_dry", "amplitude_dry"]
        over += ["phase", "liquid_offset", "liquid_angle"]
        over += ["liquid_offset_mean", "liquid_angle_mean", "mass_error", "captured", "in_range"]
        over += ["depth_max", "depth_min", "mean_rotation", "lag", "amplitude_error"]
        over += ["peak", "peak_error", "peak_dry", "end"]
        over += ["peak_back"] if self.turns_back else []
        rest = ["error_estimate", "handover_estimate", "energy_error", "converged", "reason"]
        rest += ["steps", "cells", "model", "model_reason"]
        own = ("model_error", "name", "digest", "assumed", "bands", *(("ensemble",) if self.spread else ()))
        return {name: getattr(self, name) for name in (*over, *rest, *own)} | {
            **({**{name: [] for name in OF_LIQUID}, "model": None} if self.chamberless else {}),
            **({"passages": [asdict(passage) for passage in self.passages]} if self.passages else {}),
            **({} if self.unbalance_left is None else {"unbalance_left": self.unbalance_left}),
            **({} if self.motor_limited is None else {"motor_limited": self.motor_limited}),
            "energy": self._energy(),
            "transfers": [asdict(transfer) | {"lost": transfer.lost} for transfer in self.transfers],
            "notes": texts(self.notes),
            **({} if self.loads is None else to_json(self.loads)),
            **({name: getattr(self, name) for name in _BALLS} if self.races else {}),
        }

    def _dry(self, name: str) -> Array:
        """What the run without liquid had at the times of the run, nan where it had not come so far."""
        found, dry = np.full(self.time.shape, np.nan), self.history_dry
        if dry is None:
            return found
        known = getattr(dry, name)
        if not self.passages:
            found[: known.size] = known[: found.size]
            return found
        # A drum without liquid coasts for another time: it has corners of its own.
        return np.asarray(np.interp(self.time, dry.time, known, right=np.nan))

    def _energy(self) -> dict[str, float]:
        """Terms of the balance, J, what it leaves, and that over the work."""
        audit = self.energy
        return asdict(audit) | {"remainder": audit.remainder, "closure": audit.closure}

    def named_arrays(self) -> NamedArrays:
        """The run-up over `time`, `chamber` and `coordinate`.

        Complex numbers are pairs `_real`, `_imag`, truth values are bytes with `flag_meanings`. The energy
        audit and what else is a single value stand in the attributes.
        """
        columns = _columns(self)
        coords = {name: columns.pop(name) for name in ("time", "chamber")}
        if self.chamberless:
            columns = {name: column for name, column in columns.items() if name not in OF_LIQUID}
        return NamedArrays(columns, coords, self._attributes())

    def _attributes(self) -> dict[str, Any]:
        """Scene, numerics, single results and versions."""
        own: dict[str, Any] = {
            "inputs": "\n".join(one_line("{}: {} [{}]".format(*entry)) for entry in self.inputs),
            "rotor": self.kind,
            "axis": self.axis,
            "friction": friction_words(self.friction),
            "model": "none" if self.chamberless else self.model,
            "model_reason": one_line(self.model_reason),
            "model_error": self.model_error,
            "cells": np.int32(self.cells),
            "dispersion": "with" if self.dispersion else "without",
            **({} if self.bore == "none" else {"bore": self.bore}),
            "energy": json.dumps(self._energy()),
            "mass_error": self.mass_error,
            "energy_error": self.energy_error,
            "error_estimate": self.error_estimate,
            "handover_estimate": self.handover_estimate,
            "steps": np.int64(self.steps),
            "converged": "yes" if self.converged else one_line(f"no: {self.reason}"),
        }
        if self.spread is not None:
            own |= {
                "ensemble_members": np.int64(self.spread.members),
                "ensemble_change": self.spread.change,
                "ensemble_seed": np.int64(self.spread.seed),
                "ensemble_peaks": self.spread.peaks,
            }
        return attributes(self, "runup", own, self.notes)


_BALLS = ("ball_angle", "ball_speed", "ball_unbalance", "ball_unbalance_angle")  # keys, where there are any


def _crest(history: RunupHistory, part: Flags) -> Moment:
    """Largest amplitude of the steps that lead to some of the samples."""
    amplitude, speed, time = history.largest[part], history.largest_speed[part], history.largest_time[part]
    k = int(np.argmax(amplitude))
    return Moment(float(amplitude[k]), float(speed[k]), float(time[k]))


def _columns(result: RunupResult) -> dict[str, Any]:
    """Variables by name."""
    h, over = result.history, ("time",)
    count = len(result.chambers)

    def each(values: Values, unit: str, text: str) -> Any:
        return variable(("time", "chamber"), values[:, :count], unit, text)

    drum = "in the drum frame, from its zero mark, positive with the spin"
    here = "liquid's centre of mass from the axis"
    captured = "the liquid rides with the drum as a layer"
    columns = {
        "time": variable(over, h.time, "s", "time"),
        "chamber": variable(("chamber",), np.arange(1, count + 1, dtype=np.int32), "1", "chamber"),
        "speed": variable(over, h.speed, "rad s-1", "spin speed"),
        "angle": variable(over, h.angle, "rad", "angle of rotation"),
        "amplitude": variable(
            over, h.amplitude, "m", "deflection of the first chamber's axis, modulus", ZERO_TO_PEAK
        ),
        "amplitude_error": variable(
            over, result.amplitude_error, "m", "error of the amplitude by cells, steps and hand-over"
        ),
        "speed_dry": variable(over, result.speed_dry, "rad s-1", "spin speed without liquid"),
        "amplitude_dry": variable(
            over, result.amplitude_dry, "m", "that modulus without liquid", ZERO_TO_PEAK
        ),
        "phase": variable(over, result.phase, "rad", f"angle of that deflection {drum}"),
        "liquid_offset": variable(over, np.abs(h.liquid_position), "m", here),
        "liquid_angle": variable(over, np.angle(h.liquid_position), "rad", f"angle of that place {drum}"),
        "in_range": flags(over, result.in_range, "no yes", "the layer is a fair picture of the liquid"),
        "coordinates": variable(("time", "coordinate"), h.coordinates, "1", "of the rotor, m or rad"),
        "captured": flags(("time", "chamber"), h.captured[:, :count], "no yes", captured),
        "depth_min": each(h.depth_min, "m", "least depth around the wall"),
        "depth_max": each(h.depth_max, "m", "largest depth around the wall"),
        "mean_rotation": each(h.mean_rotation, "rad s-1", "mean rotation of the liquid in the drum"),
        "layer_mass": variable(("chamber",), h.layer_mass, "kg", "mass of the liquid"),
    }
    if result.unbalance_left is not None:
        words = "sizes of all unbalances over what they were at first"
        columns["unbalance_left"] = variable(over, result.unbalance_left, "1", words)
    if result.motor_limited is not None:
        words = "the motor gives less than is asked"
        columns["motor_limited"] = flags(over, result.motor_limited, "no yes", words)
    if result.loads is not None:
        columns |= result.loads.variables()
    if result.spread is not None:
        for part in ("min", "max", "median"):
            name, words = f"amplitude_{part}", f"amplitude, {part} over runs that rounding tells apart"
            columns[name] = variable(over, getattr(result.spread, name), "m", words)
    if result.races:
        columns |= _ball_columns(result, drum)
    for name, values, text in (
        ("deflection", h.deflection, "of the chamber's axis, standing frame"),
        ("offset", h.offset, "of the liquid's centre of mass from its chamber's axis, standing frame"),
    ):
        columns[f"{name}_real"] = each(values.real, "m", f"{name} {text}, first direction")
        columns[f"{name}_imag"] = each(values.imag, "m", f"{name} {text}, second direction")
    return columns


def _ball_columns(result: RunupResult, drum: str) -> dict[str, Any]:
    """Variables of the balls by name."""
    each, over = ("time", "ball"), ("time",)
    size, angle = result.ball_unbalance, result.ball_unbalance_angle
    race = (in_race(result.races) + 1).astype(np.int32)
    return {
        "race": variable(("ball",), race, "1", "number of the ball's race"),
        "ball_angle": variable(each, result.ball_angle, "rad", f"angle of the ball {drum}"),
        "ball_speed": variable(each, result.ball_speed, "rad s-1", "speed of the ball in space"),
        "ball_unbalance": variable(over, size, "kg m", "unbalance of all balls together"),
        "ball_unbalance_angle": variable(over, angle, "rad", f"angle of that unbalance {drum}"),
    }


def run_faults(history: RunupHistory, chambers: Sequence[FilledChamber]) -> tuple[str, ...]:
    """Violations term by term: energy balance, heat below zero, deflection beyond a chamber's radius."""
    beyond, crest = [], float(history.largest.max())
    for k, chamber in enumerate(chambers):
        # The steps between the samples are known of the first chamber.
        size = max(float(np.abs(history.deflection[:, k]).max()), crest * (k == 0))
        if not size <= chamber.radius:
            wall = f"its radius of {with_unit(chamber.radius, LENGTH)}"
            beyond.append(
                f"the axis of chamber {k + 1} is deflected by {with_unit(size, LENGTH)}, beyond {wall}"
            )
    return (*history.audit.faults, *beyond)


def turn_mean(values: Complex, angle: Array) -> Complex:
    """Mean over the turn around each time, or turns of eight samples: what rests in space drops out.

    Of values in the drum frame over the rising angle of rotation, rad, shape (k,); near the ends over the
    turns that there are.
    """
    if angle.size < 3:
        return values.copy()
    steps = np.diff(angle)
    total = np.concatenate(([0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * steps)))
    half = math.pi * np.maximum(1.0, np.ceil(_FEWEST * np.gradient(angle) / (2.0 * math.pi)))
    half = np.minimum(half, 0.5 * (angle[-1] - angle[0]))
    middle = np.clip(angle, angle[0] + half, angle[-1] - half)

    def until(edge: Array) -> Complex:
        return np.asarray(np.interp(edge, angle, total.real) + 1j * np.interp(edge, angle, total.imag))

    return np.asarray((until(middle + half) - until(middle - half)) / (2.0 * half))
