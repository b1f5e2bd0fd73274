"""A liquid layer under a prescribed circular whirl, by the nonlinear long-wave model in time.

`LongWave` is the liquid model. The state is `solvers.layer.finite_volume`'s; here are units, starting states,
whirl periods and when to stop.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np

from fluid.fill import Fill
from fluid.friction import NO_FRICTION, Friction, FrictionLaw
from meshes.arrays import Complex
from meshes.errors import require_positive
from solvers.layer.state import (
    LayerFilm,
    LayerHistory,
    MovingLayer,
    Numerics,
    depth,
    settle_statics,
    start,
)
from solvers.liquid_model import (
    CAPTURED,
    LONG,
    THIN_LAYERS,
    LiquidWave,
    Range,
    WaveModel,
    Whirl,
    kept_limits,
    numbers_of,
    wave_amplitude,
    whirl_answer,
)

_PERIODS = 400
_TURNS = 20_000.0  # rad of spin
_SETTLED = 1e-4


def simulate(
    fill: Fill,
    whirl: Whirl,
    duration: float,
    friction: Friction = NO_FRICTION,
    numerics: Numerics | None = None,
) -> LayerHistory:
    """Layer from rest in the drum, uniform, whirl period by whirl period.

    Parameters
    ----------
    fill : chamber and liquid, with some liquid and a free surface
    whirl : what drives it
    duration : s; whole periods within it are answered, at least one
    friction : on the wall; the laminar law takes the frequency of the whirl seen from the drum
    numerics : resolution

    Returns
    -------
    LayerHistory

    Raises
    ------
    InputError : no liquid, no free surface, a value out of its range
    """
    require_positive("duration", duration)
    layer = start(fill, whirl, friction, numerics or Numerics())
    count = max(1, round(duration / whirl.period - 0.5 + 1e-9))
    rows = []
    for _ in range(count):
        row = layer.periods(1)
        if row is None:
            break
        rows.append(row)
    return _history(layer, rows)


def settle(
    fill: Fill,
    whirl: Whirl,
    friction: Friction = NO_FRICTION,
    numerics: Numerics | None = None,
) -> LayerHistory:
    """Layer whose force no longer changes from one stretch of whirl periods to the next.

    A synchronous whirl starts from its equilibrium. Any other starts from rest with a gentle ramp; stretches
    of ever more periods are compared until the mean force of one differs by less than 1e-4 (without friction
    1e-3) from the last.

    Parameters
    ----------
    fill, whirl, friction, numerics : see `simulate`

    Returns
    -------
    LayerHistory of stretches, its last row the answer; `converged` is False where it does not settle, as a
    frictionless bore never does
    """
    synchronous = whirl.slip == 0.0 and whirl.gravity == 0.0
    if not synchronous and whirl.ramp == 0.0:
        # The slowest free wave turns in some 30/Omega: a ramp of ten of them hardly stirs it.
        whirl = replace(whirl, ramp=max(6.0 * whirl.period, 300.0 / whirl.spin))
    layer = start(fill, whirl, friction, numerics or Numerics())
    if synchronous:
        settle_statics(layer)
        count = 2
    else:
        count = max(1, round(100.0 / (whirl.period * whirl.spin)))
        if layer.periods(math.ceil(whirl.ramp / whirl.period)) is None:
            return _history(layer, [])
    # Without friction free waves never die: the means carry what little the ramp has stirred.
    settled = 10.0 * _SETTLED if friction.law is FrictionLaw.NONE else _SETTLED
    rows: list[Complex] = []
    total = 0
    while total < _PERIODS and layer.time < _TURNS:
        row = layer.periods(count)
        if row is None:
            return _history(layer, rows)
        rows.append(row)
        total += count
        if len(rows) > 1 and abs(rows[-1][0] - rows[-2][0]) <= settled * abs(rows[-1][0]):
            return _history(layer, rows)
        if len(rows) % 3 == 0:
            count = min(2 * count, 64)
    layer.reason = "the force still changes from one stretch of whirl periods to the next"
    return _history(layer, rows)


def film(
    fill: Fill,
    whirl: Whirl,
    frames: int,
    periods: float,
    friction: Friction = NO_FRICTION,
    numerics: Numerics | None = None,
) -> LayerFilm:
    """Layer from rest in the drum, as pictures at equal intervals.

    Parameters
    ----------
    fill, whirl, friction, numerics : see `simulate`
    frames : how many pictures, at least 1
    periods : how many whirl periods they cover

    Returns
    -------
    LayerFilm; it ends early where the surface came to the axis
    """
    layer = start(fill, whirl, friction, numerics or Numerics())
    n = layer.area.size
    time, layers = [], []
    for _ in range(frames):
        time.append(layer.time / whirl.spin)
        layers.append(depth(layer))
        if layer.periods(periods / frames) is None:
            break
    moments = np.array(time)
    grown = np.ones_like(moments)
    if whirl.ramp > 0.0:
        part = np.minimum(moments / whirl.ramp, 1.0)
        grown = part - np.sin(2.0 * math.pi * part) / (2.0 * math.pi)
    return LayerFilm(
        time=moments,
        theta=2.0 * math.pi * (np.arange(n) + 0.5) / n,
        depth=np.array(layers),
        deflection=np.asarray(whirl.amplitude * grown * np.exp(1j * whirl.slip * moments), dtype=complex),
    )


@dataclass(frozen=True)
class LongWave(WaveModel):
    """Nonlinear long waves, held under the whirl until they settle [theory: long_wave, eq. 4].

    Parameters
    ----------
    friction : on the wall
    numerics : resolution
    """

    friction: Friction = NO_FRICTION
    numerics: Numerics = field(default_factory=Numerics)

    name = "long_wave"
    ranges: ClassVar[Mapping[str, Range]] = {
        "relative_depth": LONG, "centrifuge": CAPTURED, "wall_layer": THIN_LAYERS, "force_gap": (0.0, 0.1),
    }  # fmt: skip

    def wave(self, fill: Fill, whirl: Whirl) -> LiquidWave:
        """See `WaveModel`; the error is the gap between the force by momentum and that by pressure.

        Raises
        ------
        InputError : no liquid, no free surface
        """
        return self.wave_at_end(fill, whirl, settle(fill, whirl, self.friction, self.numerics))

    def wave_at_end(self, fill: Fill, whirl: Whirl, history: LayerHistory) -> LiquidWave:
        """The wave as a history leaves it, with the last means as its answer.

        Parameters
        ----------
        fill, whirl : chamber and liquid, and its whirl
        history : from `settle` or `simulate`
        """
        chamber, answered = fill.chamber, history.force_ratio.size > 0
        none = complex(math.nan, math.nan)
        force, offset = (history.force_ratio[-1], history.offset[-1]) if answered else (none, none)
        gap, found = math.nan, {}
        if answered:
            gap = float(abs(force - history.pressure_ratio[-1])) / max(1.0, float(abs(force)))
            extremes = np.concatenate([history.depth_max, history.depth_min])
            found = {"force_gap": gap, "wave_amplitude": wave_amplitude(extremes, fill.depth)}
        numbers = numbers_of(fill, whirl, found)
        deepest = float(history.depth.max(initial=0.0))
        limits = {"inner_wall": deepest <= chamber.radius - chamber.inner_radius}
        answer = whirl_answer(
            fill,
            whirl,
            force_ratio=complex(force),
            offset=complex(offset),
            limits=kept_limits(numbers, self.ranges) | limits,
            dry_patch=float(history.depth.min(initial=math.inf)) <= 0.0,
            converged=history.converged,
            error=gap,
        )
        return LiquidWave(
            answer=answer,
            theta=history.theta,
            depth=history.depth,
            numbers=numbers,
            ranges=self.ranges,
            mass_error=history.mass_error,
            mean_rotation=float(history.mean_rotation[-1]) if answered else math.nan,
            reason=history.reason,
        )


def _history(layer: MovingLayer, rows: list[Complex]) -> LayerHistory:
    """Means in SI units, and the layer as it stands in the frame of the deflection."""
    whirl, radius = layer.whirl, layer.fill.chamber.radius
    table = np.array(rows, dtype=np.complex128).reshape(len(rows), 6)
    drive = layer.drive
    scale = math.pi * drive.amplitude * drive.whirl**2 or math.inf
    n = layer.area.size
    middle = 2.0 * math.pi * (np.arange(n) + 0.5) / n
    theta = np.mod(middle - drive.slip * layer.time + math.pi, 2.0 * math.pi) - math.pi
    order = np.argsort(theta)
    wanted = layer.fill.volume / (layer.fill.chamber.height * radius**2)
    force, moved, turning, least, largest, pressure = table.T
    return LayerHistory(
        time=np.asarray((np.arange(len(rows)) + 0.5) * whirl.period, dtype=np.float64),
        force_ratio=force / scale,
        pressure_ratio=pressure / scale,
        offset=moved * radius,
        mean_rotation=turning.real * whirl.spin,
        depth_min=least.real * radius,
        depth_max=largest.real * radius,
        theta=theta[order],
        depth=depth(layer)[order],
        mass_error=abs(float(layer.area.sum()) * 2.0 * math.pi / n / wanted - 1.0),
        converged=not layer.reason and bool(np.isfinite(table).all()),
        reason=layer.reason,
    )
