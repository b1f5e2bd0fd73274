"""The nonlinear wave through time: limited steps, nodes as its spectrum needs them, and where it breaks.

A wave is `resolved`, or carries `short_waves` that its nodes do not resolve, or is `broken`. Its spectrum
alone never shows that it is broken: short waves fill it while the crest may be falling. Its crest does, where
the liquid is nearly as fast as the crest itself, and a surface that overhangs [theory: potential, eq. 23].
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

import numpy as np
from scipy import fft

from meshes.arrays import Array
from meshes.errors import InputError, require_not_negative
from solvers.potential.unsteady import (
    FEWEST,
    LARGE,
    Push,
    Surface,
    invariants,
    rates,
    resampled,
    tail,
    wave_numbers,
)

if TYPE_CHECKING:
    from scipy.integrate import DOP853

_RELATIVE, _ABSOLUTE = 1e-10, 1e-13
# Tail of a spectrum at which nodes are doubled, and above which it is not resolved.
DOUBLED, RESOLVED = 1e-8, 1e-6
# A crest at this number that fills its spectrum to this much breaks [theory: potential, eq. 23].
BREAKING, FILLED = 0.65, 1e-3
# Share of the volume that no sound wave loses; nothing but (17) keeps it.
LOST = 1e-6
# Depth at the crest over that of the layer from which its speed is looked at.
CREST = 1.05


class WaveState(StrEnum):
    """What is known of a wave in time."""

    RESOLVED = "resolved"
    SHORT_WAVES = "short_waves"
    BROKEN = "broken"


@dataclass(frozen=True)
class Steps:
    """How a wave is taken through time."""

    nodes: int = 128  #: all round the drum to begin with, even
    most: int = 2048  #: nodes are doubled up to this many
    #: of the shortest waves that are kept, over Omega; falls with the eighth power of the wave number
    damping: float = 0.0
    #: k of a small body force -k grad phi on the liquid, over Omega, in a drum that keeps its speed [theory:
    #: potential, eq. 22]
    friction: float = 0.0
    #: crest number from which a crest that fills its spectrum is broken [theory: potential, eq. 23]; infinite
    #: to follow it for its shape until it overhangs, or its nodes lose volume
    breaking: float = BREAKING

    def __post_init__(self) -> None:
        if self.nodes < FEWEST or self.nodes % 2:
            raise InputError("nodes", self.nodes, f"an even number from {FEWEST}")
        if self.most < self.nodes:
            raise InputError("most", self.most, f"at least as many as nodes ({self.nodes})")
        require_not_negative("damping", self.damping)
        require_not_negative("friction", self.friction)
        if not self.breaking > 0.0:
            raise InputError("breaking", self.breaking, "above 0")


@dataclass(frozen=True)
class Watch:
    """Shape of a wave, and how well its nodes carry it."""

    crest: float  #: greatest and least depth, over R
    trough: float
    crest_number: float  #: speed of the liquid at the crest over that of the crest; 0 where the crest is low
    slope: float  #: steepest slope of the surface, rad; beyond pi/2 it overhangs
    drift: float  #: relative change of the volume
    tail: float  #: largest coefficient in the last tenth of the spectrum over the largest

    def since(self, before: Watch) -> Watch:
        """Extremes of before and now; the tail is that of now."""
        return Watch(
            crest=max(self.crest, before.crest),
            trough=min(self.trough, before.trough),
            crest_number=max(self.crest_number, before.crest_number),
            slope=max(self.slope, before.slope),
            drift=max(self.drift, before.drift),
            tail=self.tail,
        )


@dataclass(frozen=True)
class Moment:
    """A wave at a time."""

    time: float  #: in 1/Omega
    surface: Surface  #: the wave
    state: WaveState  #: what is known of it
    extremes: Watch  #: since the beginning, up to the step that the moment is in
    reason: str = ""  #: why it is broken, or empty


def course(
    begin: Surface, times: Array, push: Push | None = None, steps: Steps | None = None
) -> Iterator[Moment]:
    """A wave at rising times, in 1/Omega: the last at a step's end, the others from within the steps.

    The surface is taken to the nodes of `steps` where it has fewer. A wave that breaks comes last, as it was
    found, with the reason.
    """
    if times.size == 0:
        return
    steps = steps or Steps()
    if begin.height.size < steps.nodes:
        begin = _surface(resampled(begin.state, steps.nodes))
    change = _changes(push, steps)
    volume = invariants(begin.state).volume
    solver, due = _solver(change, begin.state, 0.0, times[-1]), 0
    extremes = watched(begin.state, solver.f, volume)
    while due < times.size:
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            message = solver.step()
        nodes = solver.y.size // 2
        if solver.status == "failed" or not np.isfinite(solver.y).all():
            yield _moment(
                solver.t, solver.y, WaveState.BROKEN, extremes, f"no step was short enough ({message})"
            )
            return
        now = watched(solver.y, solver.f, volume)
        extremes = now.since(extremes)
        state, reason = judged(now, nodes, steps.most, steps.breaking)
        if reason:
            yield _moment(solver.t, solver.y, state, extremes, reason)
            return
        within = solver.dense_output() if times[due] < solver.t else None
        while due < times.size and times[due] <= solver.t:
            reached = solver.y if within is None or times[due] == solver.t else within(times[due])
            yield _moment(times[due], reached, state, extremes)
            due += 1
        if now.tail > DOUBLED and 2 * nodes <= steps.most and due < times.size:
            solver = _solver(change, resampled(solver.y, 2 * nodes), solver.t, times[-1])


def advance(begin: Surface, time: float, push: Push | None = None, steps: Steps | None = None) -> Moment:
    """A wave after a time in 1/Omega, or where it broke."""
    *_, last = course(begin, np.array([time]), push, steps)
    return last


def judged(now: Watch, nodes: int, most: int, breaking: float = BREAKING) -> tuple[WaveState, str]:
    """State of a wave, and why it is broken, or empty [theory: potential, eq. 23]."""
    broken = WaveState.BROKEN
    if now.slope > 0.5 * math.pi:
        return broken, "the surface overhangs"
    if now.crest_number > breaking and now.tail > FILLED and 2 * nodes > most:
        return broken, f"the crest breaks: its liquid has {now.crest_number:.2f} of its speed"
    if not now.drift < LOST:
        return broken, f"{nodes} nodes do not carry it: they lose {now.drift:.1e} of the volume"
    return (WaveState.RESOLVED if now.tail < RESOLVED else WaveState.SHORT_WAVES), ""


def watched(state: Array, change: Array, volume: float) -> Watch:
    """Shape of a wave by its state and rates, shape (2n,), and the volume that it began with, over R^2."""
    n = state.size // 2
    height, waves, depth = fft.rfft(state[:n]), wave_numbers(n), float(state[:n].mean())
    flux = np.concatenate(([0.0], waves.k[1:] / np.tanh(np.minimum(waves.k[1:] * depth, LARGE))))
    opened, steep = fft.irfft(np.stack((flux * height, 1j * waves.odd * height)), n)
    opened += 1.0
    layer = 1.0 - math.sqrt(max(1.0 - volume / math.pi, 0.0))
    depths = -np.expm1(-state[:n])
    crest = float(depths.max())
    found = math.pi * float(np.mean(-np.expm1(-2.0 * state[:n]) * opened))
    sharp = crest > CREST * layer
    return Watch(
        crest=crest,
        trough=float(depths.min()),
        crest_number=_crest_number(state, change) if sharp else 0.0,
        slope=float(np.arctan2(np.abs(steep), opened).max()),
        drift=abs(found / volume - 1.0),
        tail=tail(state, layer),
    )


def _crest_number(state: Array, change: Array) -> float:
    """Angular speed of the liquid at the highest crest over that of the crest, both in the frame."""
    n = state.size // 2
    waves, top = wave_numbers(n), int(np.argmax(state[:n]))
    height, potential, lift = fft.rfft(np.stack((state[:n], state[n:], change[:n])))
    depth, deeper = float(state[:n].mean()), float(change[:n].mean())
    k = waves.k[: waves.kept]
    inner = np.minimum(k[1:] * depth, LARGE)
    over = np.concatenate(([0.0], 1.0 / np.tanh(inner)))
    closing = np.concatenate(([0.0], k[1:] * deeper / np.sinh(inner) ** 2))
    y, phi, rise = (spectrum[: waves.kept] * (2.0 / n) for spectrum in (height, potential, lift))
    u = float(waves.angle[top])
    for _ in range(3):
        # To where the surface is level, from the nearest node.
        ray = np.exp(1j * k * u)
        bend = float((-k * k * y @ ray).real)
        if not bend < 0.0:
            return 0.0
        u -= float(np.clip((1j * k * y @ ray).real / bend, -2.0 * math.pi / n, 2.0 * math.pi / n))
    ray = np.exp(1j * k * u)
    bend = float((-k * k * y @ ray).real)
    opened = 1.0 + float((k * over * y @ ray).real)
    liquid = float((1j * k * phi @ ray).real) / opened
    moved = -float((1j * k * rise @ ray).real) / bend
    # At a fixed u the angle changes as well.
    turned = float((-1j * (over * rise - closing * y) @ ray).real)
    radius = math.exp(-float((y @ ray).real - 0.5 * y[0].real))
    speed = turned + opened * moved
    return abs(liquid / (radius * radius * speed)) if liquid * speed > 0.0 else 0.0


def carried(acceleration: Callable[[float], complex]) -> Push:
    """Force f of a drum whose axis moves anyhow, while it spins anyhow [theory: potential, eq. 24].

    The acceleration of the axis in space is over Omega^2 R, complex; gravity is one in its direction with the
    other sign.
    """
    return lambda time: -acceleration(time) * complex(math.cos(time), -math.sin(time))


def _changes(push: Push | None, steps: Steps) -> Callable[[float, Array], Array]:
    """Function that gives the rates at a time."""

    def change(time: float, state: Array) -> Array:
        return rates(state, 0j if push is None else push(time), steps.damping, steps.friction)

    return change


def _solver(change: Callable[[float, Array], Array], state: Array, start: float, stop: float) -> DOP853:
    """Runge-Kutta steps that the fastest of the waves allows."""
    from scipy.integrate import DOP853

    # A method that tries longer ones fills the spectrum with what its tolerance lets through.
    longest = 2.0 / (1.0 + math.sqrt(1.0 + state.size / 6.0))
    first = min(longest, stop - start)
    return DOP853(change, start, state, stop, longest, _RELATIVE, _ABSOLUTE, first_step=first)


def _surface(state: Array) -> Surface:
    n = state.size // 2
    return Surface(state[:n].copy(), state[n:].copy())


def _moment(time: float, state: Array, judged: WaveState, extremes: Watch, reason: str = "") -> Moment:
    return Moment(float(time), _surface(state), judged, extremes, reason)
