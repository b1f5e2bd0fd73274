"""A liquid layer under a prescribed circular whirl, by the nonlinear long waves, driven by py-pde.

The wave is `AnnularLongWavePDE`; its solver is "finite_volume" unless another is named. Here are starting
states, whirl periods and when to stop.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from contextlib import suppress
from typing import Any

import numpy as np
from pde.storage.memory import MemoryStorage
from pde.trackers.interrupts import FixedInterrupts
from pde.trackers.trackers import CallbackTracker

from fluid.fill import Fill
from fluid.friction.laws import NO_FRICTION, Friction, FrictionLaw
from meshes.arrays import Array
from meshes.errors import InputError, require_positive
from solvers.layer.state import Numerics, resting_area
from solvers.liquid_history import LayerFilm, LayerHistory
from solvers.liquid_model import Whirl, grown
from solvers.pypde.grid import circle
from solvers.pypde.long_wave import AnnularLongWavePDE
from solvers.pypde.stock import SAMPLES, is_ours, require_solver, stepping
from solvers.pypde.stretches import Stretches, StretchMeans, gently, run, settling

SETTLED = 1e-4
OURS = "finite_volume"
Progress = Callable[[float], object] | None


def simulate(
    fill: Fill,
    whirl: Whirl,
    duration: float,
    friction: Friction = NO_FRICTION,
    numerics: Numerics | None = None,
    solver: str = OURS,
    progress: Progress = None,
) -> LayerHistory:
    """Layer from rest in the drum, uniform, whirl period by whirl period.

    Whole periods within `duration`, s, are answered, at least one. The laminar law takes the frequency of the
    whirl seen from the drum.
    """
    require_positive("duration", duration)
    equation, state = _start(fill, whirl, friction, numerics or Numerics())
    count = max(1, round(duration / whirl.period - 0.5 + 1e-9))
    stretches = Stretches((1,) * count, 0.0, whirl.period)
    return _held(equation, state, stretches, None, solver, progress)


def settle(
    fill: Fill,
    whirl: Whirl,
    friction: Friction = NO_FRICTION,
    numerics: Numerics | None = None,
    solver: str = OURS,
    progress: Progress = None,
) -> LayerHistory:
    """Layer whose force no longer changes from one stretch of whirl periods to the next.

    A synchronous whirl starts from its equilibrium, any other from rest with a gentle ramp; stretches of ever
    more periods are compared until the mean force of one differs by less than 1e-4 (without friction 1e-3)
    from the last. The last row is the answer; `converged` is False where it does not settle, as a
    frictionless bore never does.
    """
    synchronous = whirl.slip == 0.0 and whirl.gravity == 0.0
    if not synchronous:
        whirl = gently(whirl)
    equation, state = _start(fill, whirl, friction, numerics or Numerics())
    if synchronous:
        radius = fill.chamber.radius
        area = resting_area(whirl.amplitude / radius, state.data[0].size, state.data[0].mean() / radius**2)
        state.data[0] = area * radius**2
        state.data[1] = -whirl.spin * np.square(state.data[0])
    settled = settled_at(friction)
    return _held(equation, state, settling(whirl, synchronous), settled, solver, progress)


def settled_at(friction: Friction) -> float:
    """Relative difference of two means at which a layer has settled."""
    # Without friction natural sloshing waves never die: the means carry what little the ramp has stirred.
    return 10.0 * SETTLED if friction.law is FrictionLaw.NONE else SETTLED


def film(
    fill: Fill,
    whirl: Whirl,
    frames: int,
    periods: float,
    friction: Friction = NO_FRICTION,
    numerics: Numerics | None = None,
    solver: str = OURS,
    progress: Progress = None,
) -> LayerFilm:
    """Layer from rest in the drum, as pictures at equal intervals; a surface at the axis ends it early."""
    equation, state = _start(fill, whirl, friction, numerics or Numerics())
    if solver != OURS:
        require_solver(equation, solver)
    interval = periods * whirl.period / frames
    times, stop = interval * np.arange(frames), interval * frames
    storage = MemoryStorage()
    trackers: list[Any] = [storage.tracker(FixedInterrupts(times))]
    if progress is not None:
        trackers.append(CallbackTracker(lambda _, t: progress(t / stop), FixedInterrupts(times)))
    options = stepping(equation, state.grid, solver, interval)
    with suppress(RuntimeError):  # py-pde's solvers have no other; the pictures end there
        equation.solve(state, stop, tracker=trackers, solver=solver, **options)
    fields = (np.asarray(data, dtype=np.float64) for data in storage.data)
    return _film(equation, state, zip(storage.times, fields, strict=True))


def _film(equation: AnnularLongWavePDE, state: Any, fields: Iterable[tuple[float, Array]]) -> LayerFilm:
    """Pictures of a layer from its fields and their times."""
    radius, whirl = equation.terms.fill.chamber.radius, equation.terms.whirl
    found = list(fields)
    moments, areas = np.array([time for time, _ in found]), np.array([data[0] for _, data in found])
    turned = grown(moments, whirl.ramp) * np.exp(1j * whirl.slip * moments)
    return LayerFilm(
        time=moments,
        theta=np.asarray(state.grid.axes_coords[0]),
        depth=radius - np.sqrt(np.maximum(radius**2 - 2.0 * areas, 0.0)),
        deflection=np.asarray(whirl.amplitude * turned, dtype=complex),
    )


def _start(
    fill: Fill, whirl: Whirl, friction: Friction, numerics: Numerics
) -> tuple[AnnularLongWavePDE, Any]:
    """The equation, and the uniform layer at rest in the drum."""
    chamber = fill.chamber
    if not 0.0 < fill.volume < chamber.capacity * (1.0 - 1e-9):
        raise InputError("volume", fill.volume, f"above 0 and below the capacity ({chamber.capacity:g} m^3)")
    equation = AnnularLongWavePDE(fill, whirl, friction=friction, dispersion=numerics.dispersion)
    state = equation.start(circle(numerics.cells))
    # The volume itself, not by way of the depth.
    state.data[0] = fill.volume / (2.0 * math.pi * chamber.height)
    state.data[1] = -whirl.spin * np.square(state.data[0])
    return equation, state


def _held(
    equation: AnnularLongWavePDE,
    state: Any,
    stretches: Stretches,
    settled: float | None,
    solver: str,
    progress: Progress,
) -> LayerHistory:
    """The layer driven over stretches of whirl periods, to their end or until it has settled."""
    if solver != OURS:
        require_solver(equation, solver)
    samples = 0 if is_ours(solver) else SAMPLES
    means = StretchMeans(equation, stretches, samples, settled)
    options = stepping(equation, state.grid, solver, stretches.period / SAMPLES)
    reason = run(equation, state, means, solver, options, progress)
    if not reason and settled is not None and not means.steady:
        reason = "the force still changes from one stretch of whirl periods to the next"
    return _history(equation, means, means.last or (state, 0.0), reason)


def _history(
    equation: AnnularLongWavePDE, means: StretchMeans, last: tuple[Any, float], reason: str
) -> LayerHistory:
    """Means over whirl periods, and the layer as it stands in the frame of the deflection at the end."""
    fill, whirl, rows = equation.terms.fill, equation.terms.whirl, means.rows
    table = np.array(rows, dtype=np.complex128).reshape(len(rows), 6)
    state, time = last
    theta = np.mod(state.grid.axes_coords[0] - whirl.slip * time + math.pi, 2.0 * math.pi) - math.pi
    order = np.argsort(theta)
    force, moved, turning, least, largest, pressure = table.T
    volume = float(state.data[0].mean()) * 2.0 * math.pi * fill.chamber.height
    return LayerHistory(
        time=np.asarray((np.arange(len(rows)) + 0.5) * whirl.period, dtype=np.float64),
        force_ratio=force,
        pressure_ratio=pressure,
        offset=moved,
        mean_rotation=turning.real,
        depth_min=least.real,
        depth_max=largest.real,
        theta=theta[order],
        depth=equation.depth(state)[order],
        ends=_film(equation, state, means.fields or [(time, state.data)]),
        mass_error=abs(volume / fill.volume - 1.0),
        converged=not reason and bool(np.isfinite(table).all()),
        reason=reason,
    )
