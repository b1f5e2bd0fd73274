"""A liquid layer under a prescribed circular whirl, by the nonlinear long-wave model in time.

The state is `solvers.finite_volume`'s; here are units, starting states, whirl periods and when to stop.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fluid.fill import Fill
from fluid.friction import LINEAR, NONE, QUADRATIC, STOKES, stokes_coefficient
from meshes.border import InputError, require_positive
from solvers.prescribed import LayerFilm, LayerHistory, Numerics, Whirl

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

_COURANT = 0.45
_STEPS = 20_000_000  # in one whirl period
_PERIODS = 400
_TURNS = 20_000.0  # rad of spin
_SETTLED = 1e-4


@dataclass
class _Layer:
    """State of the layer and what drives it, lengths over R, times over 1/Omega."""

    fill: Fill
    whirl: Whirl
    area: Array
    momentum: Array
    drive: tuple[float, float, float, float, float, float]
    rub: tuple[float, float, float, float]
    angles: Array
    scratch: Array
    time: float = 0.0
    reason: str = ""

    def periods(self, count: float) -> Complex | None:
        """Advance by whirl periods; means over them, or None where the surface came to the axis."""
        from solvers.forced_layer import AT_AXIS, advance

        length = self.whirl.period * self.whirl.spin * count
        means = np.empty(6, dtype=np.complex128)
        steps = advance(
            self.area,
            self.momentum,
            self.time,
            self.time + length,
            self.drive,
            self.rub,
            self.angles,
            _COURANT,
            _STEPS,
            self.scratch,
            means,
        )
        if steps < 0:
            self.reason = "the surface came to the axis" if steps == AT_AXIS else "the time steps ran out"
            return None
        self.time += length
        return means


def simulate(
    fill: Fill,
    whirl: Whirl,
    duration: float,
    friction: tuple[int, float] = (NONE, 0.0),
    numerics: Numerics | None = None,
) -> LayerHistory:
    """Layer from rest in the drum, uniform, whirl period by whirl period.

    Parameters
    ----------
    fill : chamber and liquid, with some liquid and a free surface
    whirl : what drives it
    duration : s; whole periods within it are answered, at least one
    friction : law of `fluid.friction` and coefficient: k, 1/s, or c_f
    numerics : resolution

    Returns
    -------
    LayerHistory

    Raises
    ------
    InputError : no liquid, no free surface, a value out of its range
    """
    require_positive("duration", duration)
    layer = _start(fill, whirl, friction, numerics or Numerics())
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
    friction: tuple[int, float] = (NONE, 0.0),
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
    layer = _start(fill, whirl, friction, numerics or Numerics())
    if synchronous:
        _rest(layer)
        count = 2
    else:
        count = max(1, round(100.0 / (whirl.period * whirl.spin)))
        if layer.periods(math.ceil(whirl.ramp / whirl.period)) is None:
            return _history(layer, [])
    # Without friction free waves never die: the means carry what little the ramp has stirred.
    settled = _SETTLED if friction[0] != NONE else 10.0 * _SETTLED
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
    friction: tuple[int, float] = (NONE, 0.0),
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
    layer = _start(fill, whirl, friction, numerics or Numerics())
    n = layer.area.size
    time, depth = [], []
    for _ in range(frames):
        time.append(layer.time / whirl.spin)
        depth.append(_depth(layer))
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
        depth=np.array(depth),
        deflection=np.asarray(whirl.amplitude * grown * np.exp(1j * whirl.slip * moments), dtype=complex),
    )


def friction_law(law: str, coefficient: float, fill: Fill, whirl: Whirl) -> tuple[int, float]:
    """Law and coefficient for `simulate`; Stokes' follows from the whirl [theory: long_wave, eq. 10].

    Raises
    ------
    InputError : no such law
    """
    laws = {"none": NONE, "linear": LINEAR, "stokes": STOKES, "quadratic": QUADRATIC}
    if law not in laws:
        raise InputError("friction", law, "one of " + ", ".join(laws))
    if law == "stokes":
        shear = float(stokes_coefficient(fill.liquid.viscosity, whirl.slip))
        return STOKES, shear / fill.chamber.radius
    return laws[law], coefficient


def _start(fill: Fill, whirl: Whirl, friction: tuple[int, float], numerics: Numerics) -> _Layer:
    """Uniform layer at rest in the drum."""
    from solvers.forced_layer import scratch

    chamber = fill.chamber
    if not 0.0 < fill.volume < chamber.capacity * (1.0 - 1e-9):
        raise InputError("volume", fill.volume, f"above 0 and below the capacity ({chamber.capacity:g} m^3)")
    radius, spin = chamber.radius, whirl.spin
    n = numerics.cells
    edge = 2.0 * math.pi * np.arange(n) / n
    middle = edge + math.pi / n
    area = np.full(n, fill.volume / (2.0 * math.pi * chamber.height * radius**2))
    log = -0.5 * math.log1p(-2.0 * area[0])
    law, coefficient = friction
    # The quadratic coefficient is a pure number, the others are rates.
    scaled = coefficient if law == QUADRATIC else coefficient / spin
    return _Layer(
        fill=fill,
        whirl=whirl,
        area=area,
        momentum=-np.square(area),
        drive=(
            whirl.amplitude / radius,
            whirl.slip / spin,
            whirl.ramp * spin,
            whirl.speed / spin,
            whirl.gravity / (radius * spin**2),
            1.0,
        ),
        rub=(float(law), scaled, 2.0 * radius / chamber.height, log**2 if numerics.dispersion else 0.0),
        angles=np.stack([np.cos(middle), np.sin(middle), np.cos(edge), np.sin(edge)]),
        scratch=scratch(n),
    )


def _rest(layer: _Layer) -> None:
    """Equilibrium of the liquid under a synchronous whirl: a circle about the rotation axis, cell by cell."""
    amplitude, whole = layer.drive[0], float(layer.area.sum())
    cosine, sine = layer.angles[0], layer.angles[1]

    def cells(squared: float) -> Array:
        # Distance from the drum's axis to the circle of that squared radius about the rotation axis.
        across = squared - np.square(amplitude * sine)
        surface = np.sqrt(np.maximum(across, 0.0)) - amplitude * cosine
        return np.asarray(0.5 * np.maximum(1.0 - np.square(np.clip(surface, 0.0, 1.0)), 0.0))

    low, high = 0.0, (1.0 + amplitude) ** 2
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if cells(middle).sum() > whole else (low, middle)
    layer.area[:] = cells(0.5 * (low + high))
    layer.momentum[:] = -np.square(layer.area)


def _history(layer: _Layer, rows: list[Complex]) -> LayerHistory:
    """Means in SI units, and the layer as it stands in the frame of the deflection."""
    whirl, radius = layer.whirl, layer.fill.chamber.radius
    table = np.array(rows, dtype=np.complex128).reshape(len(rows), 6)
    amplitude, slip, _, speed, _, _ = layer.drive
    scale = math.pi * amplitude * speed**2 or math.inf
    n = layer.area.size
    middle = 2.0 * math.pi * (np.arange(n) + 0.5) / n
    theta = np.mod(middle - slip * layer.time + math.pi, 2.0 * math.pi) - math.pi
    order = np.argsort(theta)
    wanted = layer.fill.volume / (layer.fill.chamber.height * radius**2)
    force, offset, turning, least, largest, pressure = table.T
    return LayerHistory(
        time=np.asarray((np.arange(len(rows)) + 0.5) * whirl.period, dtype=np.float64),
        force_ratio=force / scale,
        pressure_ratio=pressure / scale,
        offset=offset * radius,
        mean_rotation=turning.real * whirl.spin,
        depth_min=least.real * radius,
        depth_max=largest.real * radius,
        theta=theta[order],
        depth=_depth(layer)[order],
        mass_error=abs(float(layer.area.sum()) * 2.0 * math.pi / n / wanted - 1.0),
        converged=not layer.reason and bool(np.isfinite(table).all()),
        reason=layer.reason,
    )


def _depth(layer: _Layer) -> Array:
    """Depth of each cell, m."""
    surface = np.sqrt(np.maximum(1.0 - 2.0 * layer.area, 0.0))
    return np.asarray(layer.fill.chamber.radius * (1.0 - surface))
