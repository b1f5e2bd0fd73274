"""A layer under a prescribed circular whirl by the fully nonlinear wave in time; SI units.

What `solvers.pypde.settle` does by long waves: from the uniform layer at rest in the drum, whirl period by
whirl period, or as pictures. A wave that breaks ends it: beyond that the model has no force.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fluid.fill import FULL, Fill
from meshes.arrays import Array
from meshes.errors import InputError, require_positive
from solvers.liquid_history import LayerFilm, LayerHistory
from solvers.liquid_model import Whirl, grown
from solvers.potential.in_time import Moment, Steps, WaveState, course
from solvers.potential.unsteady import Invariants, Push, Surface, force, invariants, node_angles, seen, still

Progress = Callable[[float], object] | None

# Gauss and Legendre's points in a panel, and the longest panel, in 1/Omega.
_POINTS, _PANEL = 8, 3.0
# Force by momentum and by pressure that differ by this share have no meaning.
_GAP = 1e-2
# Angles of a picture.
_AROUND = 2.0 * math.pi * (np.arange(256) + 0.5) / 256
# Energy and angular momentum that count as moved by nothing, beside which gaps are rounding.
_UNMOVED = 1e-9


@dataclass(frozen=True)
class PotentialHistory:
    """Whirl periods of the fully nonlinear wave, and what is known of it."""

    periods: LayerHistory  #: means of the periods that it finished
    state: WaveState  #: what is known of the wave at the end
    crest: float  #: greatest and least depth so far over that of the layer at rest
    trough: float
    crest_number: float  #: greatest speed of the liquid at a crest over that of the crest
    tail: float  #: of the spectrum at the end
    nodes: int  #: at the end
    drift: float  #: greatest relative change of the volume
    #: greatest difference of the means by momentum and by pressure, over the largest force so far
    force_gap: float
    #: greatest energy that force and friction do not account for, over what they have moved
    energy_gap: float
    turning_gap: float  #: of the angular momentum, the same


def simulate(
    fill: Fill, whirl: Whirl, duration: float, steps: Steps | None = None, progress: Progress = None
) -> PotentialHistory:
    """Layer from rest in the drum, uniform, whirl period by whirl period.

    Whole periods within `duration`, s, are answered, at least one; the chamber is circular and clear.
    """
    require_positive("duration", duration)
    steps = steps or Steps()
    begin, push, period = _start(fill, steps), whirl_push(fill, whirl), whirl.period * whirl.spin
    count = max(1, round(duration / whirl.period - 0.5 + 1e-9))
    times, weights = _points(period)
    # The points of all periods, each with its end behind them.
    within = np.concatenate((times, [period]))
    stops = np.asarray((period * np.arange(count)[:, None] + within).ravel(), dtype=np.float64)
    moments = course(begin, stops, push, steps)
    means = _Means(whirl, push, steps.friction, weights, _sample(begin, 0.0, push, steps.friction))
    deepest, last, reason = 1.0 - fill.chamber.inner_radius / fill.chamber.radius, None, ""
    pictures = [1.0 - seen(begin.state, _AROUND)[0]]
    for moment in moments:
        last, reason = moment, moment.reason
        if reason:
            break
        if moment.extremes.crest > deepest:
            reason = "the crest came to the inner wall"
            break
        means.add(_sample(moment.surface, moment.time, push, steps.friction))
        if len(means.rows) == len(pictures):
            pictures.append(1.0 - seen(moment.surface.state, _AROUND)[0])
        if means.force_gap > _GAP:
            reason = f"forces by pressure and by momentum differ by {means.force_gap:.1e}"
            break
        if progress is not None:
            progress(moment.time / (period * count))
    assert last is not None
    ends = _film(fill, whirl, whirl.period * np.arange(len(pictures)), pictures)
    return _history(fill, whirl, last, reason, means, ends)


def film(
    fill: Fill,
    whirl: Whirl,
    frames: int,
    periods: float,
    steps: Steps | None = None,
    progress: Progress = None,
) -> LayerFilm:
    """Layer from rest in the drum, as pictures at equal intervals; a wave that breaks ends it early."""
    if frames < 1:
        raise InputError("frames", frames, "1 or more")
    require_positive("periods", periods)
    steps = steps or Steps()
    begin = _start(fill, steps)
    interval = periods * whirl.period / frames
    pictures = [1.0 - seen(begin.state, _AROUND)[0]]
    times = np.asarray(interval * np.arange(1, frames), dtype=np.float64)
    for moment in course(begin, times * whirl.spin, whirl_push(fill, whirl), steps):
        if moment.state is WaveState.BROKEN:
            break
        pictures.append(1.0 - seen(moment.surface.state, _AROUND)[0])
        if progress is not None:
            progress(len(pictures) / frames)
    return _film(fill, whirl, interval * np.arange(len(pictures)), pictures)


def _film(fill: Fill, whirl: Whirl, at: ArrayLike, depths: Sequence[Array]) -> LayerFilm:
    """Pictures of a layer from its depths over the radius at some times, s."""
    time = np.asarray(at, dtype=np.float64)
    turning = grown(time, whirl.ramp) * np.exp(1j * whirl.slip * time)
    depth = fill.chamber.radius * np.array(depths)
    return LayerFilm(time, _AROUND, depth, np.asarray(whirl.amplitude * turning))


def whirl_push(fill: Fill, whirl: Whirl) -> Push:
    """The force f of a whirl and of gravity across the axis [theory: potential, eq. 24].

    f over Omega^2 R, of the time in 1/Omega; the ramp scales the force [theory: long_wave, eq. 8].
    """
    unit = whirl.spin**2 * fill.chamber.radius
    size, slip = whirl.speed**2 * whirl.amplitude / unit, whirl.slip / whirl.spin
    weight, ramp = whirl.gravity / unit, whirl.ramp * whirl.spin

    def push(time: float) -> complex:
        share = float(grown(time, ramp)) if time < ramp else 1.0
        return size * share * cmath.exp(1j * slip * time) - 1j * weight * cmath.exp(-1j * time)

    return push


@dataclass(frozen=True)
class _Sample:
    """A wave's force and momentum at a time, in units of R and Omega."""

    time: float
    push: complex
    force: complex
    deepest: float
    least: float
    kept: Invariants


def _sample(surface: Surface, time: float, push: Push, friction: float) -> _Sample:
    f, state = push(time), surface.state
    depth = -np.expm1(-surface.height)
    return _Sample(
        *(time, f, force(state, f, friction), float(depth.max()), float(depth.min()), invariants(state))
    )


@dataclass
class _Means:
    """Means over whirl periods, and how well the balances hold [theory: potential, eq. 20-22]."""

    whirl: Whirl  #: what drives the layer
    push: Push
    friction: float  #: k over Omega
    weights: Array  #: of the samples in a period, shape (m,); one more sample ends it
    before: _Sample  #: sample at the end of the last period
    force_gap: float = 0.0
    energy_gap: float = 0.0
    turning_gap: float = 0.0

    def __post_init__(self) -> None:
        self.rows: list[tuple[complex, ...]] = []
        self._samples: list[_Sample] = []
        self._largest = 0.0
        self._moved = np.full(2, _UNMOVED)

    def add(self, sample: _Sample) -> None:
        """Take a sample; where it ends a period, its means."""
        self._samples.append(sample)
        if len(self._samples) > self.weights.size:
            self._close()

    def _close(self) -> None:
        *inner, end = self._samples
        length, slip = end.time - self.before.time, self.whirl.slip / self.whirl.spin
        seen = np.exp(-1j * slip * np.array([sample.time for sample in inner]))

        def mean(values: list[complex]) -> complex:
            return complex(self.weights @ (np.array(values) * seen)) / length

        momentum = mean([sample.kept.momentum for sample in inner])
        centre = mean([sample.kept.centre for sample in inner])
        push = mean([sample.push for sample in inner])
        ends = [each.kept.momentum * cmath.exp(-1j * slip * each.time) for each in (self.before, end)]
        volume = end.kept.volume
        # By parts: the change of the momentum is known by its ends.
        change = (ends[1] - ends[0]) / length + 1j * slip * momentum
        by_momentum = -(change + 2j * momentum - centre - volume * push)
        by_pressure = mean([sample.force for sample in inner])
        self._largest = max(self._largest, abs(by_pressure), abs(by_momentum))
        if self._largest > 0.0:
            self.force_gap = max(self.force_gap, abs(by_momentum - by_pressure) / self._largest)
        plain = np.array([(s.kept.rotation, s.deepest, s.least) for s in inner])
        self.rows.append((by_momentum, by_pressure, centre / volume, *(self.weights @ plain / length)))
        self._balance(inner, end)
        self.before, self._samples = end, []

    def _balance(self, inner: list[_Sample], end: _Sample) -> None:
        """Energy and angular momentum against what f and friction do [theory: potential, eq. 20, 22]."""
        k = self.friction
        work = [(s.push.conjugate() * s.kept.momentum).real - 2.0 * k * s.kept.kinetic for s in inner]
        twist = [(s.kept.centre.conjugate() * s.push).imag - k * s.kept.turning for s in inner]
        power = np.array([work, twist])
        self._moved += np.abs(power) @ self.weights
        first, last = self.before.kept, end.kept
        grown_by = last.energy - first.energy, last.angular_momentum - first.angular_momentum
        gaps = np.abs(grown_by - power @ self.weights) / self._moved
        self.energy_gap, self.turning_gap = np.maximum((self.energy_gap, self.turning_gap), gaps).tolist()


def _points(period: float) -> tuple[Array, Array]:
    """Times within a period and their weights, by Gauss and Legendre in panels, both shape (m,)."""
    panels = math.ceil(period / _PANEL)
    place, weight = np.polynomial.legendre.leggauss(_POINTS)
    half = 0.5 * period / panels
    middles = half * (2.0 * np.arange(panels) + 1.0)
    return (middles[:, None] + half * place).ravel(), np.tile(half * weight, panels)


def _start(fill: Fill, steps: Steps) -> Surface:
    """The uniform layer at rest in the drum."""
    chamber, wanted = fill.chamber, "none for the fully nonlinear wave, which needs a clear circular wall"
    if chamber.section is not None:
        raise InputError("section", type(chamber.section).__name__, wanted)
    if chamber.baffles is not None:
        raise InputError("baffles", chamber.baffles.count, wanted)
    if not 0.0 < fill.volume < chamber.capacity * FULL:
        raise InputError("volume", fill.volume, f"above 0 and below the capacity ({chamber.capacity:g} m^3)")
    return still(fill.depth / chamber.radius, steps.nodes)


def _history(
    fill: Fill, whirl: Whirl, last: Moment, reason: str, means: _Means, ends: LayerFilm
) -> PotentialHistory:
    """Means in SI units, and the layer as it stands in the frame of the deflection at the end."""
    radius, spin, found = fill.chamber.radius, whirl.spin, last.extremes
    table = np.array(means.rows, dtype=np.complex128).reshape(len(means.rows), 6)
    by_momentum, by_pressure, centre, rotation, deepest, least = table.T
    full = math.pi * whirl.amplitude / radius * (whirl.speed / spin) ** 2 or math.inf
    turned = node_angles(last.surface.state) - whirl.slip / spin * last.time
    theta = np.mod(turned + math.pi, 2.0 * math.pi) - math.pi
    order = np.argsort(theta)
    periods = LayerHistory(
        time=np.asarray((np.arange(len(means.rows)) + 0.5) * whirl.period, dtype=np.float64),
        force_ratio=by_momentum / full,
        pressure_ratio=by_pressure / full,
        offset=centre * radius,
        mean_rotation=rotation.real * spin,
        depth_max=deepest.real * radius,
        depth_min=least.real * radius,
        theta=theta[order],
        depth=-np.expm1(-last.surface.height[order]) * radius,
        ends=ends,
        mass_error=found.drift,
        converged=not reason and bool(np.isfinite(table).all()),
        reason=reason,
    )
    layer = fill.depth / radius
    return PotentialHistory(
        periods=periods,
        state=WaveState.BROKEN if reason else last.state,
        crest=found.crest / layer,
        trough=found.trough / layer,
        crest_number=found.crest_number,
        tail=found.tail,
        nodes=last.surface.height.size,
        drift=found.drift,
        force_gap=means.force_gap,
        energy_gap=means.energy_gap,
        turning_gap=means.turning_gap,
    )
