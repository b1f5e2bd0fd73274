"""Rotor and liquid layers through time: run-up, run-down, hold, and their error [theory: coupling].

The distance of linear layers from long waves is estimated from the linear run alone.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Annotated, Any

import numpy as np
from numpy.typing import ArrayLike

from fluid.fill import Fill
from fluid.friction.laws import NO_FRICTION, Friction
from fluid.whirl import is_full
from meshes.arrays import Array, Complex, Flags, Index
from meshes.errors import InputError
from meshes.quantity import Q
from solvers.layer.records import Outcome
from solvers.rotor.system import RotorSystem
from solvers.runup.long_wave import couple
from solvers.runup.machine import (
    FLOOR,
    MOST_WAVE,
    WAVE,
    Drive,
    Handover,
    LayerSnapshots,
    Reading,
    RunupMachine,
    RunupModel,
    Transfer,
)
from solvers.runup.path import ROWS, Recorder, RotorPath, fastest_frequency
from solvers.runup.programme import FLOOR as FLOOR_SHARE
from solvers.runup.samples import Leg, highest, known_legs, legs, marked
from solvers.runup.shedding import Shedding
from solvers.runup.state import WORKS
from solvers.slices import step_budget

_OVER, _EACH = ("time",), ("time", "chamber")


@dataclass(frozen=True)
class RunupNumerics:
    """How a run-up is resolved."""

    cells: int = 128  #: finite volumes round each wall, from 8
    samples: int = 2000  #: how many times are recorded, at least 2
    dispersion: bool = False  #: add the finite depth's dispersion to the layers [theory: long_wave, eq. 13]
    enstrophy: bool = False  #: the layers' bores carry fluctuations behind them [theory: long_wave, eq. 15]
    #: Courant number of the layers; the rotor turns by at most this share of a cell in a step
    courant: float = 0.8
    handover: Handover = Handover.RIDING  #: how liquid at the bottom of a lying chamber becomes a layer
    #: run once more with half the cells, hence twice the steps, to estimate the error; from 16 cells
    companion: bool = True

    def __post_init__(self) -> None:
        if not 8 <= self.cells <= 65536:
            raise InputError("cells", self.cells, "from 8 to 65536")
        if not 2 <= self.samples <= 10_000_000:
            raise InputError("samples", self.samples, "from 2 to 10000000")
        if not 0.0 < self.courant <= 0.9:
            raise InputError("courant", self.courant, "above 0, at most 0.9")


# Of the scale: what the balance may leave, and how far below zero rounding may put a heat.
OPEN, COLD = 0.05, 1e-6
HEATS = {
    "support": "the supports",
    "friction": "wall friction",
    "bores": "bores",
    "baffles": "baffles",
}


@dataclass(frozen=True)
class EnergyAudit:
    """Where the energy went, J [theory: coupling, eq. 9-10]."""

    unbalance: Annotated[float, Q("J", "work of the unbalance")]
    drive: Annotated[float, Q("J", "work of the drive on the liquid")]
    gravity: Annotated[float, Q("J", "work of gravity")]
    #: less what water that leaves takes
    captured: Annotated[float, Q("J", "brought in by capture")]
    change: Annotated[float, Q("J", "left in rotor and liquid")]
    support: Annotated[float, Q("J", "heat in the supports")]
    friction: Annotated[float, Q("J", "heat by wall friction")]
    bores: Annotated[float, Q("J", "loss in bores", "and by the scheme")]
    #: while the spin changes
    profile: Annotated[float, Q("J", "missed by the flow's profile")]
    motor: Annotated[float, Q("J", "work of the motor", "0 for a given speed")]
    baffles: Annotated[float, Q("J", "loss at baffles")] = 0.0

    @property
    def dissipated(self) -> float:
        """Heat in supports, at walls and baffles and in bores, J."""
        return self.support + self.friction + self.bores + self.baffles

    @property
    def scale(self) -> float:
        """The largest of the works of unbalance, drive and motor and of all that was dissipated, J."""
        return max(abs(self.unbalance), abs(self.drive), abs(self.motor), self.dissipated)

    @property
    def remainder(self) -> Annotated[float, Q("J", "not accounted for")]:
        """What the balance leaves, J."""
        gained = self.unbalance + self.drive + self.gravity + self.captured
        return gained - self.change - self.profile - self.dissipated

    @property
    def closure(self) -> Annotated[float, Q("1", "not accounted for, over the largest term")]:
        """The remainder over the scale: 0 where nothing moves, infinite where a term is no number."""
        if not math.isfinite(self.remainder):
            return math.inf
        work = self.scale
        return abs(self.remainder) / work if work > 0.0 else 0.0

    @property
    def faults(self) -> tuple[str, ...]:
        """Violations of the energy balance: energy unaccounted for, heat below zero; each with its term."""
        return self.faults_beside(self.scale)

    def faults_beside(self, scale: float) -> tuple[str, ...]:
        """The same beside another scale, J."""
        found = [
            f"the heat of {text} is {heat:.3g} J, below zero"
            for name, text in HEATS.items()
            if (heat := getattr(self, name)) < -COLD * scale
        ]
        left = self.remainder
        if not abs(left) <= OPEN * scale:
            share = abs(left) / scale if scale > 0.0 else math.inf
            found.append(f"the energy balance leaves {left:.3g} J, {share:.1%} of its largest term")
        return tuple(found)


@dataclass(frozen=True)
class RunupHistory:
    """A run-up at k times with l layers. Angles in the drum, from its zero mark, positive with the spin."""

    time: Annotated[Array, Q("s", "time", over=_OVER)]
    speed: Annotated[Array, Q("rad s-1", "spin speed", over=_OVER)]
    angle: Annotated[Array, Q("rad", "angle of rotation", over=_OVER, json=False)]
    #: from the static equilibrium, shape (k, n)
    coordinates: Annotated[Array, Q("1", "of the rotor, m or rad", over=("time", "coordinate"), json=False)]
    #: of each chamber's axis in the standing frame, complex, m, shape (k, l); without a chamber, of the axis
    #: at position 0, shape (k, 1)
    deflection: Complex
    #: largest modulus of the first deflection at any step since the time before, m, shape (k,)
    largest: Array
    largest_speed: Array  #: where that was, rad/s and s, shape (k,)
    largest_time: Array
    offset: Annotated[
        Complex,
        Q(
            "m",
            "offset of the liquid's centre of mass from its chamber's axis, standing frame",
            over=_EACH,
            axes=("first direction", "second direction"),
            json=False,
        ),
    ]
    captured: Annotated[
        Flags, Q(name="the liquid rides with the drum as a layer", over=_EACH, flags="no yes")
    ]
    #: nan while it is not captured
    depth_min: Annotated[Array, Q("m", "least depth around the wall", over=_EACH)]
    depth_max: Annotated[Array, Q("m", "largest depth around the wall", over=_EACH)]
    #: of each layer or swinging pool
    mean_rotation: Annotated[Array, Q("rad s-1", "mean rotation of the liquid in the drum", over=_EACH)]
    layer_mass: Annotated[Array, Q("kg", "mass of the liquid", over=("chamber",), json=False)]
    mass_error: Annotated[float, Q("1", "largest relative change of a layer's volume", data=False)]
    #: of the amplitude, relative to its largest: difference to the run with half the cells and twice the
    #: steps; nan without that run
    error_estimate: Annotated[float, Q("1", "relative error by half the cells", data=False)]
    audit: EnergyAudit  #: of the energy
    steps: Annotated[int, Q("1", text="steps of time", data=False)]
    layer_steps: int  #: of single layers within them
    disagreement: float  #: largest relative difference left between the accelerations of rotor and layers
    outcome: Outcome  #: how it ended
    reason: str  #: why it did not come to the end, and when; or empty
    #: of the layers, cell by cell, at the times asked for; None where none were
    snapshots: LayerSnapshots | None = None
    #: in the order of time
    transfers: Annotated[tuple[Transfer, ...], Q(text="liquid that became a layer or fell")] = ()
    handover: Handover = Handover.RIDING  #: how liquid at the bottom of a lying chamber becomes a layer
    #: of the amplitude, relative to its largest: what another sensible hand-over changes, by the drum that
    #: takes the liquid along at once, of the largest value within a turn; nan without it
    handover_estimate: Annotated[
        float, Q("1", "relative error by how liquid becomes a layer", data=False)
    ] = math.nan
    #: over this run, the one with half the cells and the one with the firmer grip, nan where none forms,
    #: shape (l, 2); None without those runs, and where no layer forms
    ring_speed: Annotated[
        Array | None,
        Q(
            "rad s-1",
            "least and largest spin speed at which an annular layer first forms",
            data=False,
            when="ring_speed",
        ),
    ] = None
    #: of the largest amplitude of the run, m: what half the cells change of it, what that hand-over changes,
    #: and what the last digits of the unbalance do; nan without those runs
    peak_gaps: tuple[float, float, float] = (math.nan, math.nan, math.nan)
    #: of the amplitude, m: what all of these change of its largest value within a turn about each time,
    #: shape (k,); None without those runs
    band: Array | None = None
    stage: Index | None = None  #: of its programme in which each time was reached, from 0, shape (k,)
    #: the motor gave less than its programme asked on the way to each time, shape (k,)
    limited: Flags | None = None
    left: Array | None = None  #: share that is left of each part of the unbalance that leaves, shape (k, s)
    path: RotorPath | None = None  #: of the rotor all along; None where nobody asked for it
    #: of the outer wall that liquid wets, and of the liquid that is above the axis, shape (k, l)
    wet_share: Array = field(default_factory=lambda: np.zeros((0, 0)))
    lifted_share: Array = field(default_factory=lambda: np.zeros((0, 0)))
    #: of each ball in the drum, from its zero mark, whole turns counted, rad, shape (k, N)
    ball_angle: Array = field(default_factory=lambda: np.zeros((0, 0)))
    #: of each ball in space, rad/s, shape (k, N)
    ball_speed: Array = field(default_factory=lambda: np.zeros((0, 0)))

    @property
    def converged(self) -> bool:
        """Whether the run came to its end."""
        return self.outcome is Outcome.DONE

    @property
    def amplitude(
        self,
    ) -> Annotated[
        Array,
        Q(
            "m",
            "deflection of the first chamber's axis, modulus",
            "zero to peak",
            over=_OVER,
            error="amplitude_error",
        ),
    ]:
        """Modulus of the first deflection, shape (k,)."""
        first = self.deflection[:, 0]
        # As the steps take it: numpy's modulus of many numbers at once may differ in the last digit.
        return np.hypot(first.real, first.imag)

    @property
    def liquid_position(self) -> Complex:
        """Centre of mass of all liquid in the drum frame, from the axis at rest, m, shape (k,)."""
        if self.layer_mass.sum() == 0.0:
            return np.zeros(self.time.shape, dtype=complex)
        places = self.deflection + self.offset
        return np.asarray(places @ self.layer_mass / self.layer_mass.sum() * np.exp(-1j * self.angle))


def run_up(
    system: RotorSystem,
    fills: Sequence[Fill],
    drive: Drive,
    friction: Friction = NO_FRICTION,
    gravity: float = 0.0,
    numerics: RunupNumerics | None = None,
    progress: Callable[[float], None] | None = None,
    model: RunupModel = couple,
    snapshots: ArrayLike = (),
    follow: bool = False,
) -> RunupHistory:
    """Run a rotor with liquid layers through its speeds; at first liquid and rotor are at rest in the drum.

    Gravity acts across the axis, against the first direction; liquid that it holds at the bottom is a pool
    that the walls carry round or, under the rule `riding`, a mass that moves with the axis. The laminar law
    takes the frequency of the slower natural sloshing wave. `model` makes the liquid: long waves, or
    `solvers.runup.linear.couple_linear` at a hundredth of the cost. Layers are kept cell by cell at the
    recorded times next to `snapshots`, s; `follow` keeps the rotor's path; neither changes the run. If the
    run ends early, what was reached.
    """
    numerics = numerics or RunupNumerics()
    start = drive.corners()[1, 0]

    def machine(resolved: RunupNumerics, of: RotorSystem) -> RunupMachine:
        how = resolved.cells, resolved.dispersion, resolved.enstrophy, resolved.handover
        return model(of, fills, start, friction, gravity, *how)

    def alone(resolved: RunupNumerics, change: float = 0.0) -> RunupHistory:
        of = replace(system, unbalance=system.unbalance * (1.0 + change)) if change else system
        return _march(machine(resolved, of), Shedding(of), drive, resolved, lambda _: None, np.empty(0))

    share = 0.8 if numerics.companion else 1.0
    wanted = np.asarray(snapshots, dtype=float)
    recorder = Recorder(fastest_frequency(system), len(system.coordinates)) if follow else None
    tell = lambda part: progress and progress(share * part)  # noqa: E731
    history = _march(machine(numerics, system), Shedding(system), drive, numerics, tell, wanted, recorder)
    if not numerics.companion or not history.converged or numerics.cells < 16:
        return history
    coarse = replace(numerics, cells=numerics.cells // 2)
    other = alone(coarse)
    early, nudged = None, []
    if numerics.handover is Handover.CARRIED and any(each.captured for each in history.transfers):
        early = alone(replace(coarse, handover=Handover.DRUM))
        # Liquid that tumbles makes of the last digits what is seen.
        nudged = [alone(coarse, change) for change in (-NUDGE, NUDGE)]
    if progress:
        progress(1.0)
    return _with_errors(history, other, early, nudged)


NUDGE = 1e-9  # relative change of the unbalance, next to nothing but for rounding


def _with_errors(
    history: RunupHistory, coarse: RunupHistory, early: RunupHistory | None, nudged: Sequence[RunupHistory]
) -> RunupHistory:
    """The run with its errors, from others as coarse: by its own rule of capture, another, and nudged."""
    if not coarse.converged:
        return history
    firmer = [] if early is None or not early.converged else [early]
    formed = np.array([_formed(run) for run in (history, coarse, *firmer)])
    largest = float(history.amplitude.max())
    scale = 1.0 / largest if largest > 0.0 else 0.0
    at_once = float(np.nanmax(_gap(history, coarse, history.amplitude, coarse.amplitude))) * scale
    crests = {id(run): _over_a_turn(run) for run in (history, coarse, early) if run is not None}
    band = _gap(history, coarse, crests[id(history)], crests[id(coarse)])
    handed, peak = math.nan, float(coarse.largest.max())
    gaps = [abs(float(history.largest.max()) - peak), math.nan, math.nan]
    if early is not None and early.converged:
        gaps[1] = abs(float(early.largest.max()) - peak)
        other = _gap(coarse, early, crests[id(coarse)], crests[id(early)])
        handed = float(np.nanmax(other)) * scale
        known = ~np.isnan(other)
        band = band + np.interp(history.time, coarse.time[known], other[known])
    ended = [run for run in nudged if run.converged]
    if ended:
        peaks = [peak, *(float(run.largest.max()) for run in ended)]
        gaps[2] = max(peaks) - min(peaks)
        apart = [_gap(coarse, run, crests[id(coarse)], _over_a_turn(run)) for run in ended]
        widest = np.fmax.reduce(apart)
        known = ~np.isnan(widest)
        band += np.interp(history.time, coarse.time[known], widest[known])
    known = ~np.isnan(band)
    whole = np.interp(history.time, history.time[known], band[known])
    return replace(
        history,
        error_estimate=at_once,
        handover_estimate=handed,
        ring_speed=None if np.isnan(formed).all() else _band_of(formed),
        peak_gaps=(gaps[0], gaps[1], gaps[2]),
        band=whole,
    )


def _band_of(values: Array) -> Array:
    """Least and largest of some values of each chamber, nan where none is known, (k, l) to (l, 2)."""
    return np.stack([np.fmin.reduce(values), np.fmax.reduce(values)], axis=-1)


def _formed(run: RunupHistory) -> Array:
    """Spin speed at which the liquid of each chamber first became a layer, nan where none did, shape (l,)."""
    found = np.full(run.layer_mass.shape, np.nan)
    for each in reversed(run.transfers):
        if each.captured:
            found[each.chamber] = each.speed
    return found


def _gap(run: RunupHistory, other: RunupHistory, own: Array, others: Array) -> Array:
    """Difference of two quantities at the times of a run, nan where the other has none, shape (k,).

    A free speed gives each run corners of its own; the other times are the same.
    """
    _, here, there = np.intersect1d(run.time, other.time, assume_unique=True, return_indices=True)
    found = np.full(run.time.shape, np.nan)
    found[here] = np.abs(own[here] - others[there])
    return found


def _over_a_turn(run: RunupHistory) -> Array:
    """Largest amplitude within half a turn before and after each time, m, shape (k,).

    At one time alone, beats that come a little earlier or later may differ by all of it.
    """
    first = np.searchsorted(run.angle, run.angle - np.pi)
    last = np.searchsorted(run.angle, run.angle + np.pi, side="right")
    pairs = zip(first.tolist(), last.tolist(), strict=True)
    return np.array([run.amplitude[i:j].max() for i, j in pairs])


def _march(
    machine: RunupMachine,
    shedding: Shedding,
    drive: Drive,
    numerics: RunupNumerics,
    progress: Callable[[float], object],
    snapshots: Array,
    recorder: Recorder | None = None,
) -> RunupHistory:
    """Run a machine sample by sample."""
    top, last = highest(drive), float(drive.corners()[0, -1])
    energy, captured, outcome = machine.energy(), 0.0, Outcome.DONE
    wanted, kept, depths = marked(drive, numerics.samples, snapshots), [0], [machine.depth()]
    if 0.0 not in wanted:
        kept, depths = [], []
    readings, stages, left, limited = [machine.read()], [0], [shedding.left], [False]
    if recorder is not None:
        recorder.begin(machine)
    known = known_legs(drive, machine, numerics.samples)
    if known is not None and not shedding.left.size and recorder is None:
        made = _at_once(machine, known, max(machine.spin, top), numerics, progress, (energy, wanted))
        if made is not None:
            return made
    for leg in legs(drive, machine, numerics.samples):
        machine.watch()
        try:
            captured += machine.switch()
            fastest = max(machine.spin, top)
            most = step_budget(leg.stop - machine.time, fastest, numerics.cells, numerics.courant)
            for stop in shedding.pieces(machine, leg.stop):
                outcome, brought = _advance(machine, stop, leg.rate, numerics.courant, most, recorder)
                captured += brought
                if outcome is not Outcome.DONE:
                    break
        except KeyboardInterrupt:
            outcome = Outcome.INTERRUPTED
        if outcome is Outcome.STOPPED and leg.coasts:
            # A drum that comes to a stand has ended its coast.
            outcome = Outcome.DONE
            if machine.time == readings[-1].time:
                continue
        if outcome is not Outcome.DONE:
            break
        readings.append(machine.read())
        stages.append(leg.stage)
        limited.append(leg.limited)
        left.append(shedding.left)
        if recorder is not None:
            recorder.sample(machine)
        if leg.stop in wanted:
            kept.append(len(readings) - 1)
            depths.append(machine.depth())
        if len(readings) % 64 == 2:
            progress(min(leg.stop / last, 1.0))
    shots = LayerSnapshots(np.array(kept, dtype=np.intp), machine.theta, np.array(depths)) if wanted else None
    read: dict[str, Any] = {
        field.name: np.array([getattr(reading, field.name) for reading in readings])
        for field in fields(Reading)
    }
    return _history(
        machine,
        read,
        (captured + shedding.brought, machine.energy() - energy),
        outcome,
        numerics,
        snapshots=shots,
        stage=np.array(stages),
        limited=np.array(limited),
        left=np.array(left),
        path=None if recorder is None else recorder.path([each.time for each in machine.transfers]),
    )


def _at_once(
    machine: RunupMachine,
    known: tuple[Array, Array],
    fastest: float,
    numerics: RunupNumerics,
    progress: Callable[[float], object],
    given: tuple[float, list[float]],
) -> RunupHistory | None:
    """Run a machine through all its samples in one compiled call; digits as sample by sample.

    `given`: its energy, J, and the times of snapshots, s. None of a machine that changes on the way.
    """
    (stops, rates), (energy, wanted) = known, given
    first, depths = machine.read(), [machine.depth()] if 0.0 in wanted else []
    machine.watch()
    most = sum(
        step_budget(time, fastest, numerics.cells, numerics.courant)
        for time in np.diff(stops, prepend=machine.time).tolist()
    )
    gone = machine.through(stops, rates, numerics.courant, most, progress)
    if gone is None:
        return None
    outcome, found, layers = gone
    count = len(layers)
    kept = np.flatnonzero(np.isin(stops[:count], wanted))
    shots = None
    if wanted:
        sample = np.concatenate((np.zeros(len(depths), dtype=np.intp), kept + 1))
        shots = LayerSnapshots(sample, machine.theta, np.array([*depths, *layers[kept]]))
    last = machine.read()  # what does not change on the way
    read = {}
    for name in (each.name for each in fields(Reading)):
        own = np.array([getattr(first, name)])
        later = found[name] if name in found else np.repeat([getattr(last, name)], count, axis=0)
        read[name] = np.concatenate((own, later))
    return _history(
        machine,
        read,
        (0.0, machine.energy() - energy),
        outcome,
        numerics,
        snapshots=shots,
        stage=np.zeros(count + 1, dtype=int),
        limited=np.zeros(count + 1, dtype=bool),
        left=np.ones((count + 1, 0)),
        path=None,
    )


def _history(
    machine: RunupMachine,
    read: dict[str, Any],
    gained: tuple[float, float],
    outcome: Outcome,
    numerics: RunupNumerics,
    **known: Any,
) -> RunupHistory:
    """The run of a machine from what was read on the way; `gained`: energy captured and left, J."""
    when, sums = f"at {machine.time:.6g} s, {machine.spin:.6g} rad/s", machine.sums
    works = {name: float(sums[name]) for name in WORKS}
    return RunupHistory(
        **read,
        **known,
        layer_mass=machine.masses,
        mass_error=machine.mass_error(),
        error_estimate=math.nan,
        handover_estimate=math.nan,
        audit=EnergyAudit(captured=gained[0], change=gained[1], **works),
        steps=int(sums.steps),
        layer_steps=int(sums.layer_steps),
        disagreement=float(sums.disagreement),
        outcome=outcome,
        reason="" if outcome is Outcome.DONE else f"{outcome.message} {when}",
        transfers=tuple(machine.transfers),
        handover=numerics.handover,
    )


def _advance(
    machine: RunupMachine, stop: float, rate: float, courant: float, most: int, recorder: Recorder | None
) -> tuple[Outcome, float]:
    """Advance to a time, letting liquid fall where gravity has won; the energy that this brought in, J."""
    brought = 0.0
    while True:
        outcome = machine.advance(stop, rate, courant, most)
        if recorder is not None:
            recorder.steps(machine)
        fallen = machine.fall(outcome)
        if fallen is None:
            return outcome, brought
        brought += fallen


_SLIVER = 1e-9  # of a step: less of a leg is no step of its own
_CURVE = np.zeros((2, 0))  # of a speed that is given


class SteppedRunup:
    """A run-up that goes on step by step: by its own drive, to a given speed, or under a given torque."""

    def __init__(
        self,
        system: RotorSystem,
        fills: Sequence[Fill],
        drive: Drive,
        friction: Friction,
        gravity: float,
        numerics: RunupNumerics,
        model: RunupModel = couple,
        start: float | None = None,
    ) -> None:
        """As `run_up`; `start` is the spin speed at the beginning in place of the drive's, rad/s."""
        spin = float(drive.corners()[1, 0]) if start is None else start
        how = numerics.cells, numerics.dispersion, numerics.enstrophy, numerics.handover
        self.machine = model(system, fills, spin, friction, gravity, *how)
        self.floor = FLOOR_SHARE * highest(drive)  #: a drum that turns more slowly stands, rad/s
        self.acceleration = np.zeros(len(system.coordinates))  #: of the rotor's coordinates
        self._numerics, self._fastest = numerics, fastest_frequency(system)
        self._shedding = Shedding(system)
        self._leg: Leg | None = None
        self._legs = legs(drive, self.machine, numerics.samples)
        self.machine.follow(ROWS)
        self._steps = np.zeros((0, 2 + len(system.coordinates)))
        self._longest = float(drive.corners()[0, -1]) / (numerics.samples - 1)

    def on(self, step: float) -> Outcome:
        """Go on by its own drive, s; where that has come to its end the speed is held."""
        end, sliver = self.machine.time + step, _SLIVER * step
        while self.machine.time < end - sliver:
            if self._leg is None or self.machine.time >= self._leg.stop:
                self._leg = next(self._legs, None)
                if self._leg is None:
                    return self._given(end, 0.0, _CURVE, 0.0)
                self.machine.switch()
            leg = self._leg
            outcome = self._go(leg.stop if leg.stop < end + sliver else end, leg.rate)
            if outcome is Outcome.STOPPED and leg.coasts:
                self._leg = None  # a drum that comes to a stand has ended its coast
            elif outcome is not Outcome.DONE:
                return outcome
        return Outcome.DONE

    def to(self, step: float, speed: float) -> Outcome:
        """Go on by a step, s, in which the spin changes to a speed, rad/s, along a straight line."""
        rate = (max(speed, self.floor) - self.machine.spin) / step
        return self._given(self.machine.time + step, rate, _CURVE, 0.0)

    def under(self, step: float, torque: float, inertia: float) -> Outcome:
        """Go on by a step, s, under a torque, N m; `inertia` of rotor and motor about the axis, kg m^2."""
        curve = np.array([[0.0, 1.0], [torque, torque]])  # level beyond its ends
        return self._given(self.machine.time + step, 0.0, curve, inertia)

    def _given(self, end: float, rate: float, curve: Array, inertia: float) -> Outcome:
        """Advance to a time under a curve of torque, in pieces no longer than a leg of the drive."""
        self.machine.drive(curve, inertia)
        begin = self.machine.time
        pieces = max(1, math.ceil((end - begin) / self._longest))
        for k in range(1, pieces + 1):
            self.machine.switch()
            outcome = self._go(end if k == pieces else begin + (end - begin) * k / pieces, rate)
            if outcome is not Outcome.DONE:
                return outcome
        return Outcome.DONE

    def _go(self, end: float, rate: float) -> Outcome:
        """Advance to a time."""
        machine, numerics = self.machine, self._numerics
        fast = max(machine.spin, machine.spin + rate * (end - machine.time), self._fastest)
        most = step_budget(end - machine.time, fast, numerics.cells, numerics.courant)
        for stop in self._shedding.pieces(machine, end):
            outcome, _ = _advance(machine, stop, rate, numerics.courant, most, None)
            if outcome is not Outcome.DONE:
                return outcome
        self._look(2.0 * np.pi / (_FINE * fast))
        return Outcome.DONE

    def _look(self, width: float) -> None:
        """Take the acceleration from a cubic through the steps of the last time of such a width, s."""
        columns, now = self._steps.shape[1], self.machine.time
        steps = np.concatenate([self._steps, self.machine.followed()[:, :columns]])
        recent = max(int(np.count_nonzero(steps[:, 0] >= now - width)), _FEWEST)
        self._steps = steps[-recent:]
        time, places = (self._steps[:, 0] - now) / width, self._steps[:, 2:]
        if len(time) >= _FEWEST:
            cubic = np.linalg.lstsq(np.vander(time, 4), places, rcond=None)[0]
            self.acceleration = 2.0 * cubic[1] / width**2


_FEWEST = 5  # steps through which a cubic goes
_FINE = 64  # of a turn: the part of it from which the acceleration is taken

# Found from random run-ups with both models: see the theory page.
_LAG = 2.0
MOST_LAG = 0.08


@dataclass(frozen=True)
class LinearRunError:
    """What a linear run says of its own error."""

    estimate: float  #: of the amplitude's largest error over its largest value; infinite where there is none
    wave: float  #: largest rise of a surface over its layer's mean depth
    lag: float  #: largest lag of a layer's rotation behind its drum over the spin
    touches: bool  #: a surface came to an inner wall


def linear_run_error(history: RunupHistory, fills: Sequence[Fill]) -> LinearRunError:
    """Error of a run with linear layers from how large its waves were [theory: model_error, eq. 23]."""
    wave, lag, touches = 0.0, 0.0, False
    for k, fill in enumerate(fills):
        held = history.captured[:, k]
        if fill.volume == 0.0 or is_full(fill) or not held.any():
            continue
        crest = float(history.depth_max[held, k].max())
        wave = max(wave, crest / fill.depth - 1.0)
        slow = np.abs(history.mean_rotation[held, k]) / np.abs(history.speed[held])
        lag = max(lag, float(slow.max()))
        inner = fill.chamber.inner_radius
        touches |= inner > 0.0 and crest >= fill.chamber.radius - inner
    lost = not history.converged or touches or wave > MOST_WAVE or lag > MOST_LAG
    estimate = np.inf if lost else FLOOR + WAVE * wave**2 + _LAG * lag**2
    return LinearRunError(float(estimate), wave, lag, touches)
