"""What `runup` answers: rotor and liquid at the recorded times, their peaks, errors and energy."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Annotated, Any

import numpy as np

from fluid.friction.laws import Friction
from leblanc.core.answer import Answer, input_lines
from leblanc.core.blocks import Block
from leblanc.core.netcdf import NamedArrays
from leblanc.core.notes import Note, one_line
from leblanc.core.progress import update, working
from leblanc.core.quantities import plain
from leblanc.core.question import called
from leblanc.core.terminal import say
from leblanc.core.units import LENGTH, friction_words, with_unit
from leblanc.liquid.filled import FilledChamber
from leblanc.studies.balls.races import RaceOfBalls, ball_moment, in_race
from leblanc.studies.loads.answer import MachineLoads
from leblanc.studies.run.answer import phase
from leblanc.studies.run.notes import plane_words
from meshes.arrays import Array, Complex, Flags
from meshes.quantity import Q
from solvers.layer.records import Outcome
from solvers.runup.ensemble import Spread
from solvers.runup.runup import EnergyAudit, RunupHistory
from solvers.synchronous.response import Response

Bands = tuple[tuple[float, float], ...]
# What there is none of without a chamber: an empty list for scripts, no variable in the data file.
OF_LIQUID = (
    *("liquid_offset", "liquid_angle", "liquid_offset_mean", "liquid_angle_mean", "captured"),
    *("depth_max", "depth_min", "mean_rotation", "lag"),
)
_FEWEST = 8  # samples in a mean over turns
_OVER, _EACH, _BALLS = ("time",), ("time", "chamber"), ("time", "ball")
_DRUM = "in the drum frame, from its zero mark, positive with the spin"


@dataclass(frozen=True)
class Moment:
    """An amplitude of a run-up and where it was."""

    amplitude: float  #: m
    speed: float  #: of the spin, rad/s
    time: float  #: s


@dataclass(frozen=True)
class Passage:
    """A step of a programme as it went."""

    step: int  #: its number, from 1
    text: str  #: as a person writes it
    way: str  #: "up", "hold" or "down"
    begin: float  #: s
    end: float
    speed_begin: float  #: rad/s
    speed_end: float
    amplitude: float  #: largest deflection of the axis in it, m
    speed: float  #: where that was, rad/s and s
    time: float
    amplitude_dry: float  #: the largest without liquid, m; nan where that was not run


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


@dataclass(frozen=True, kw_only=True)
class RunupAnswer(Answer):
    """A run-up of a scene; k times, l chambers.

    Examples
    --------
    >>> import leblanc as lb
    >>> short = lb.example("runup").replace({"runup.duration": "1 s", "runup.cells": 16})
    >>> answer = lb.run_up(short, samples=50, check=False)
    >>> answer.model, answer.converged, answer.amplitude.shape
    ('long_wave', True, (50,))
    """

    command = "runup"
    title = "Run-up in time"
    data = "runup.nc"
    page = "runup.html"
    figure = "leblanc.studies.runup.figure:speed_figure"

    name: Annotated[str, Q(text="of the scene")]
    source: str
    assumed: Annotated[tuple[str, ...], Q(text="values that no source gives")]
    digest: Annotated[str, Q(text="of the scene")]
    inputs: tuple[tuple[str, str, str], ...]  #: label, value with its unit, field path
    kind: str  #: of the rotor
    axis: str  #: "horizontal" or "vertical"
    friction: Friction  #: law and coefficient
    gravity: float  #: across the axis, m/s^2
    model: Annotated[str, Q(text="model of the liquid, long_wave or linear")]
    model_reason: Annotated[str, Q(text="why that one")]
    #: by the model and by its steps, over the largest amplitude; nan where one of them is not known
    model_error: Annotated[float, Q("1", "relative error of the amplitude, by model and steps", data=False)]
    cells: Annotated[int, Q("1", text="cells of each layer", data=False)]
    dispersion: bool  #: the layers' waves have the dispersion of the finite depth
    history: Annotated[RunupHistory, Q(part=True)]
    turning: int  #: index of the last time before the speed falls again; the last one of all if it never does
    #: shape (k,)
    in_range: Annotated[
        Flags, Q(name="the layer is a fair picture of the liquid", over=_OVER, flags="no yes")
    ]
    #: synchronous response at the speeds passed, of a Jeffcott rotor; None for others
    steady: Response | None
    #: an end of the range counting as an edge; None where they were not looked for
    bands: Annotated[Bands | None, Q("rad s-1", text="bands of speed with self-excited whirl", data=False)]
    chambers: tuple[FilledChamber, ...]
    planes: tuple[float, ...]  #: position of each chamber along the axis, m
    notes: Annotated[tuple[Note, ...], Q(text="limits of validity and findings")]
    frames: RunupFrames | None = None  #: the layers at regular times; None if they were not kept
    #: of the same rotor on the same way without liquid; None if it was not run
    history_dry: RunupHistory | None = None
    #: over an ensemble of runs that differ by rounding; None if it was not asked for
    spread: Annotated[Spread | None, Q(part=True, json=False)] = None
    #: forces and clearances of each interval; None where the scene asks for none
    loads: Annotated[MachineLoads | None, Q(part=True)] = None
    bore: str = "none"  #: what bores leave behind, "none" or "enstrophy"
    #: those that were reached; none of a run-up
    passages: Annotated[tuple[Passage, ...], Q(text="the steps of a programme", when="passages")] = ()
    #: shape (k,); None where none leaves
    unbalance_left: Annotated[
        Array | None,
        Q("1", "sizes of all unbalances over what they were at first", over=_OVER, when="unbalance_left"),
    ] = None
    races: tuple[RaceOfBalls, ...] = ()  #: with the balls that run in them; N balls in all
    unused: tuple[str, ...] = ("speeds", "optimise")
    film: Path | None = None  #: where the command draws one

    @property
    def outcome(self) -> Outcome:
        """How the run ended."""
        return self.history.outcome

    @property
    def interrupted(self) -> bool:  # type: ignore[override]
        cut = self.spread is not None and self.spread.members < self.spread.asked
        return cut or self.outcome is Outcome.INTERRUPTED

    @property
    def violations(self) -> tuple[str, ...]:
        """Violations term by term: energy balance, heat below zero, deflection beyond a chamber's radius."""
        return run_faults(self.history, self.chambers)

    @property
    def converged(self) -> Annotated[bool, Q(text="it came to its end and is physical")]:
        """Its energy closes as well, and no axis left its chamber."""
        return self.history.converged and not self.violations

    @property
    def reason(self) -> Annotated[str, Q(text="why, when and where it stopped or is not physical")]:
        return "; ".join((*filter(None, [self.history.reason]), *self.violations))

    @property
    def faults(self) -> tuple[str, ...]:
        return () if self.converged else (f"{self.reason}; what was reached is written",)

    @property
    def closing(self) -> str:
        return f"{self.name}: {self.steps} steps done, energy closed to {self.energy_error:.1e}"

    def after(self) -> None:
        if self.film is not None:
            with working("drawing"):
                frames = called("leblanc.studies.runup.film:animate")(self, self.frames, self.film, update)
            say(f"wrote {self.film}, {frames} frames")

    @property
    def energy(self) -> Annotated[EnergyAudit, Q(text="where the energy went, J")]:
        return self.history.audit

    @property
    def energy_error(self) -> Annotated[float, Q("1", "energy not accounted for, relative", data=False)]:
        return self.energy.closure

    @property
    def chamber(self) -> Annotated[Array, Q("1", "chamber", over=("chamber",), json=False)]:
        return np.arange(1, len(self.chambers) + 1, dtype=np.int32)

    @property
    def speed_dry(self) -> Annotated[Array, Q("rad s-1", "spin speed without liquid", over=_OVER)]:
        """Nan where it was not run, shape (k,)."""
        return self._dry("speed")

    @property
    def amplitude_dry(
        self,
    ) -> Annotated[Array, Q("m", "that modulus without liquid", "zero to peak", over=_OVER)]:
        """Nan where it was not run, shape (k,)."""
        return self._dry("amplitude")

    @property
    def amplitude_error(
        self,
    ) -> Annotated[
        Array, Q("m", "error of the amplitude by cells, steps and pool-annulus transition", over=_OVER)
    ]:
        """Nan if it was not estimated, shape (k,)."""
        band = self.history.band
        return np.full(self.history.time.shape, math.nan) if band is None else band

    @property
    def plane(self) -> str:
        """Plane of the amplitude, in words; empty for a rotor that moves in one plane."""
        return "" if self.kind == "jeffcott" else plane_words(self.planes[0], chambers=True)

    @property
    def wet(self) -> bool:
        """There is liquid."""
        return bool(self.history.layer_mass.sum() > 0.0)

    @property
    def bare(self) -> bool:
        """Neither liquid nor balls are on the rotor: it is the one that it is compared with."""
        return not self.races and not self.wet

    @property
    def chamberless(self) -> bool:
        """The machine has no chamber at all, with liquid or with balls."""
        return not self.chambers and not self.races

    @property
    def without(self) -> str:
        """What the run that it is compared with lacks, in words."""
        both = "liquid and balls" if self.wet else "balls"
        return f"without {both if self.races else 'liquid'}"

    @property
    def race(
        self,
    ) -> Annotated[Array, Q("1", "number of the ball's race", over=("ball",), json=False, when="races")]:
        return (in_race(self.races) + 1).astype(np.int32)

    @property
    def ball_angle(
        self,
    ) -> Annotated[Array, Q("rad", f"angle of the ball {_DRUM}", over=_BALLS, when="races")]:
        """Whole turns counted, shape (k, N)."""
        return self.history.ball_angle

    @property
    def ball_speed(
        self,
    ) -> Annotated[Array, Q("rad s-1", "speed of the ball in space", over=_BALLS, when="races")]:
        return self.history.ball_speed

    @property
    def ball_unbalance(
        self,
    ) -> Annotated[Array, Q("kg m", "unbalance of all balls together", over=_OVER, when="races")]:
        return np.asarray(np.abs(ball_moment(self.races, self.ball_angle)))

    @property
    def ball_unbalance_angle(
        self,
    ) -> Annotated[Array, Q("rad", f"angle of that unbalance {_DRUM}", over=_OVER, when="races")]:
        return np.asarray(np.angle(ball_moment(self.races, self.ball_angle)))

    @property
    def deflections(
        self,
    ) -> Annotated[
        Complex,
        Q(
            "m",
            "deflection of the chamber's axis, standing frame",
            over=_EACH,
            axes=("first direction", "second direction"),
            key="deflection",
            json=False,
        ),
    ]:
        """Of each chamber, shape (k, l)."""
        return self.history.deflection[:, : len(self.chambers)]

    @property
    def deflection(self) -> Complex:
        """Of the first chamber's axis, in the drum frame, m, shape (k,)."""
        return np.asarray(self.history.deflection[:, 0] * np.exp(-1j * self.history.angle))

    @property
    def phase(self) -> Annotated[Array, Q("rad", f"angle of that deflection {_DRUM}", over=_OVER)]:
        """From the unbalance, where a Jeffcott rotor has it at the zero mark."""
        return phase(self.deflection)

    @property
    def liquid_offset(
        self,
    ) -> Annotated[Array, Q("m", "liquid's centre of mass from the axis", over=_OVER)]:
        return np.asarray(np.abs(self.history.liquid_position))

    @property
    def liquid_angle(self) -> Annotated[Array, Q("rad", f"angle of that place {_DRUM}", over=_OVER)]:
        return np.asarray(np.angle(self.history.liquid_position))

    @property
    def mean_position(self) -> Complex:
        """Liquid's centre of mass in the drum frame as a mean over whole turns, m, shape (k,)."""
        return turn_mean(self.history.liquid_position, self.history.angle)

    @property
    def liquid_offset_mean(
        self,
    ) -> Annotated[Array, Q("m", "distance of its mean over whole turns", over=_OVER, data=False)]:
        return np.asarray(np.abs(self.mean_position))

    @property
    def liquid_angle_mean(
        self,
    ) -> Annotated[Array, Q("rad", "angle of its mean over whole turns", over=_OVER, data=False)]:
        return np.asarray(np.angle(self.mean_position))

    @property
    def lag(
        self,
    ) -> Annotated[Array, Q("rad s-1", "rotation behind the drum", "layer or pool", over=_EACH, data=False)]:
        return np.asarray(-self.history.mean_rotation)

    @property
    def wet_share(
        self,
    ) -> Annotated[Array | None, Q("1", "share of the outer wall that is wet", over=_EACH, when="wet_share")]:
        """Of a horizontal drum, shape (k, l); None for others."""
        return self.history.wet_share if self.gravity > 0.0 and self.history.wet_share.size else None

    @property
    def lifted_share(
        self,
    ) -> Annotated[
        Array | None, Q("1", "share of the liquid above the axis", over=_EACH, when="lifted_share")
    ]:
        """Of a horizontal drum, shape (k, l); None for others."""
        return self.history.lifted_share if self.gravity > 0.0 and self.history.lifted_share.size else None

    @property
    def motor_limited(
        self,
    ) -> Annotated[
        Flags | None,
        Q(name="the motor gives less than is asked", over=_OVER, flags="no yes", when="motor_limited"),
    ]:
        """On the way to each time, shape (k,); None if never."""
        limited = self.history.limited
        return limited if limited is not None and limited.any() else None

    @property
    def falling(self) -> Flags:
        """The speed falls on the way to a sample, shape (k,)."""
        return self._falls(self.history)

    @property
    def turns_back(self) -> bool:
        """The speed falls again after it has risen."""
        return bool(self.falling.any()) and not bool(self.falling[1:].all())

    @property
    def peak(
        self,
    ) -> Annotated[
        dict[str, float], Q(text="largest amplitude on the way up, its speed, time; SI, zero to peak")
    ]:
        return asdict(self.crest())

    @property
    def peak_error(
        self,
    ) -> Annotated[dict[str, float], Q("m", text="error of the largest amplitude", data=False)]:
        """By `cells` (and steps), by `handover` and by `rounding`; nan if not estimated."""
        return dict(zip(("cells", "handover", "rounding"), self.history.peak_gaps, strict=True))

    @property
    def peak_dry(self) -> Annotated[dict[str, float], Q(text="the peak without liquid, SI, nan if not run")]:
        if self.history_dry is None:
            return asdict(Moment(math.nan, math.nan, math.nan))
        return asdict(_crest(self.history_dry, self._way(self.history_dry, False)))

    @property
    def peak_back(
        self,
    ) -> Annotated[dict[str, float] | None, Q(text="the peak on the way back, SI", when="peak_back")]:
        """None where it never turns back."""
        return asdict(self.crest(back=True)) if self.turns_back else None

    @property
    def end(self) -> Annotated[dict[str, float], Q(text="amplitude, speed, time and angles at the end, SI")]:
        angles = ("phase", "liquid_offset", "liquid_angle")
        return asdict(self.moment(-1)) | {name: float(getattr(self, name)[-1]) for name in angles}

    @property
    def ensemble(self) -> Annotated[Spread | None, Q(text="what rounding alone does", when="spread")]:
        return self.spread

    def crest(self, back: bool = False) -> Moment:
        """Largest amplitude of all steps on the way up, or on the way back, kept or not."""
        return _crest(self.history, self._way(self.history, back))

    def moment(self, index: int) -> Moment:
        """Amplitude, speed and time of one sample."""
        return Moment(*(float(getattr(self, name)[index]) for name in ("amplitude", "speed", "time")))

    def in_range_at(self, time: float) -> bool:
        """The layer is a fair picture of the liquid at a time, s: at the next sample."""
        times = self.history.time
        return bool(self.in_range[min(int(np.searchsorted(times, time)), times.size - 1)])

    def curve(self, back: bool = False, dry: bool = False) -> tuple[Array, Array, Array]:
        """Time, speed and amplitude, s, rad/s, m, on the way up or back, the largest among them.

        nan between parts of a programme; `dry` is without liquid, empty where that was not run.
        """
        history = self.history_dry if dry else self.history
        way = None if history is None or (back and not self.turns_back) else self._way(history, back)
        if history is None or way is None or not way.any():
            return np.empty(0), np.empty(0), np.empty(0)
        crest, gap = _crest(history, way), np.full((3, 1), np.nan)
        found: list[Array] = []
        for shown in pieces(way):
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

    def _falls(self, history: RunupHistory) -> Flags:
        """The speed falls on the way to a sample of a run."""
        after = np.arange(history.time.size)
        if not self.passages or history.stage is None:
            return after > self.turning
        down = [passage.step - 1 for passage in self.passages if passage.way == "down"]
        return np.isin(history.stage, down) & (after > 0)

    def _way(self, history: RunupHistory, back: bool) -> Flags:
        """Which samples are of the way up, or of the way back; all of a run that only falls or only rises."""
        if not self.turns_back:
            return np.ones(history.time.size, dtype=bool)
        return np.asarray(self._falls(history) == back)

    def _dry(self, name: str) -> Array:
        """What the run without liquid had at the times of the run, nan where it had not come so far."""
        time, dry = self.history.time, self.history_dry
        found = np.full(time.shape, np.nan)
        if dry is None:
            return found
        known = getattr(dry, name)
        if self.passages:  # a drum without liquid coasts for another time: it has corners of its own
            return np.asarray(np.interp(time, dry.time, known, right=np.nan))
        found[: known.size] = known[: found.size]
        return found

    def to_json(self) -> dict[str, Any]:
        found = super().to_json()
        return found | ({**{name: [] for name in OF_LIQUID}, "model": None} if self.chamberless else {})

    def named_arrays(self) -> NamedArrays:
        found = super().named_arrays()
        left_out = OF_LIQUID if self.chamberless else ()
        return replace(found, variables={k: v for k, v in found.variables.items() if k not in left_out})

    @property
    def own(self) -> dict[str, Any]:
        single = ("model_error", "mass_error", "energy_error", "error_estimate", "handover_estimate")
        found = {
            "inputs": input_lines(self.inputs),
            "rotor": self.kind,
            "axis": self.axis,
            "friction": friction_words(self.friction),
            "model": "none" if self.chamberless else self.model,
            "model_reason": one_line(self.model_reason),
            "cells": np.int32(self.cells),
            "dispersion": "with" if self.dispersion else "without",
            **({} if self.bore == "none" else {"bore": self.bore}),
            "energy": json.dumps(plain(self.energy)),
            **{name: getattr(self, name) for name in single},
            "steps": np.int64(self.steps),
            "converged": "yes" if self.converged else one_line(f"no: {self.reason}"),
        }
        for name in ("members", "change", "seed", "peaks") if self.spread else ():
            found[f"ensemble_{name}"] = getattr(self.spread, name)
        return found

    def blocks(self) -> Sequence[Block]:
        shown: Sequence[Block] = called("leblanc.studies.runup.words:blocks")(self)
        return shown


def _crest(history: RunupHistory, part: Flags) -> Moment:
    """Largest amplitude of the steps that lead to some of the samples."""
    amplitude, speed, time = history.largest[part], history.largest_speed[part], history.largest_time[part]
    k = int(np.argmax(amplitude))
    return Moment(float(amplitude[k]), float(speed[k]), float(time[k]))


def pieces(there: Flags) -> list[slice]:
    """Parts of a run in which a condition holds, each with the sample before it, from which it is drawn."""
    edge = np.flatnonzero(np.diff(np.concatenate(([False], there, [False])).astype(np.int8)))
    pairs = zip(edge[::2].tolist(), edge[1::2].tolist(), strict=True)
    return [slice(max(first - 1, 0), last) for first, last in pairs]


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
