"""Waves of a liquid layer under one prescribed whirl, by any liquid model that knows them."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

import numpy as np

from fluid import waves
from fluid.fill import Fill
from leblanc.core.notes import Note
from leblanc.results.layer import (
    ExactPeriods,
    ExactWave,
    FreeWaveResult,
    LayerCase,
    LayerPeriodsResult,
    LayerResult,
    Wave,
    WaveFrames,
    against_whirl,
    drawn_depth,
    dry_wall,
    friction_frequency,
    inner_wall,
    lee_waves,
    no_answer,
    no_smooth_wave,
    out_of_range,
    two_grids,
)
from leblanc.results.notes.baffles import smeared_baffles
from leblanc.studies.models.validity import judge
from leblanc.studies.models.whirling import (
    AutoWave,
    WaveChoice,
    choose_free,
    choose_in_time,
    choose_wave,
    watched,
)
from meshes.errors import InputError, require_not_negative, require_positive
from solvers.liquid_model import LiquidWave, WaveModel, Whirl, drag_frequency
from solvers.potential.model import Potential, PotentialWave
from solvers.potential.steady import Branch
from solvers.pypde.models import LongWave, OneFamily, Progress
from solvers.synchronous.models import LINEAR, Linear
from solvers.wave_error import detuning_ratio

_EVEN = 720  # angles of a film
_SMOOTH = "smooth_whirl"  # has a note of its own, which says why
_GRIDS = "grid_gap"  # likewise
_ONE_WAY = 1e-6  # part of the answer that may go the other way round before it is worth a note


def answer_layer(
    fill: Fill,
    speed: float,
    whirl_speed: float,
    whirl_amplitude: float,
    model: WaveModel | AutoWave,
    gravity: float = 0.0,
    progress: Progress = None,
) -> LayerResult:
    """Answer of the liquid in one chamber to a circular whirl of its axis.

    Without an amplitude statics, linear theory and elements give the limit of the force ratio; under gravity
    across the axis nothing whirls then, and the spin takes the whirl's place.
    """
    require_positive("--speed", speed)
    require_not_negative("--whirl-amplitude", whirl_amplitude)
    require_positive("--volume", fill.volume)
    require_not_negative("--gravity", gravity)
    if not math.isfinite(whirl_speed) or whirl_speed == 0.0:
        raise InputError("--whirl-speed", whirl_speed, "a finite number other than 0")
    begin = time.perf_counter()
    whirl = _driven(Whirl(speed, whirl_speed, whirl_amplitude, gravity=gravity))
    with as_options():
        choice = choose_wave(model, fill, whirl) if isinstance(model, AutoWave) else WaveChoice(model)
        wave = choice.wave or watched(_with_baffles(choice.model, fill), progress).wave(fill, whirl)
    taken, model = time.perf_counter() - begin, choice.model
    grids, apart = _both_grids(wave)
    notes = (*wave_notes(wave), *_beyond_waves(fill, whirl, wave), *(grids if apart else ()))
    surface = fill.surface_radius
    in_range = not notes
    if in_range and wave.answer.dry_patch[0]:
        notes = (dry_wall(),)
    notes = (*notes, *choice.notes, *(() if apart else grids), *_friction_notes(model, fill, whirl))
    if isinstance(model, LongWave):
        notes = (*notes, *smeared_baffles([fill], model.numerics.cells))
    exact = _exact(wave) if isinstance(wave, PotentialWave) else None
    if exact is not None and exact.branch == Branch.LEE_WAVES:
        notes = (*notes, lee_waves())
    kappa = (fill.chamber.radius / surface) ** 2 if gravity else math.nan
    return LayerResult(
        case=_case(fill, whirl, choice),
        force_ratio=_force_ratio(fill, whirl, wave),
        offset=complex(wave.answer.offset[0]),
        error_estimate=float(wave.answer.error[0]),
        mass_error=wave.mass_error,
        converged=bool(wave.answer.converged[0]),
        in_range=in_range,
        mean_rotation=wave.mean_rotation,
        wall_time=taken,
        theta=wave.theta,
        depth=wave.depth,
        notes=notes,
        gravity_offset=float(waves.gravity_offset(kappa, speed, gravity)) if gravity else 0.0,
        captured=not gravity or speed > float(waves.capture_speed(surface, gravity)),
        validity=judge(wave.numbers, wave.ranges),
        exact=exact,
    )


def _driven(whirl: Whirl) -> Whirl:
    """Under gravity alone nothing whirls: the answer is that of the drum's own frame."""
    return replace(whirl, speed=whirl.spin) if whirl.gravity and whirl.amplitude == 0.0 else whirl


def _both_grids(wave: LiquidWave) -> tuple[tuple[Note, ...], bool]:
    """How far two grids differ, where the wave is as steep as they let it be, and whether that is too far."""
    if _GRIDS not in wave.numbers:
        return (), False
    gap = wave.numbers[_GRIDS]
    return (two_grids(gap),), _GRIDS in wave.ranges and gap > wave.ranges[_GRIDS][1]


def _friction_notes(model: WaveModel, fill: Fill, whirl: Whirl) -> tuple[Note, ...]:
    """Which frequency laminar friction takes, where gravity acts as well."""
    if not (isinstance(model, LongWave) and model.friction.law.laminar and whirl.gravity):
        return ()
    return (friction_frequency(drag_frequency(fill, whirl), whirl.amplitude == 0.0 or whirl.slip == 0.0),)


def _with_baffles(model: WaveModel, fill: Fill) -> WaveModel:
    """The model, if it takes the baffles that there may be."""
    if not model.takes_baffles and fill.chamber.baffles is not None:
        allowed = f"0 for --model {model.name}; fem takes them"
        raise InputError("baffles", fill.chamber.baffles.count, allowed)
    return model


def _exact(wave: PotentialWave) -> ExactWave:
    """What only the exact wave has."""
    numbers = {name: wave.numbers.get(name, math.nan) for name in ("crest", "trough", "crest_number")}
    return ExactWave(
        state="resolved" if wave.answer.converged[0] else None,
        branch=wave.branch or None,
        error_estimate=float(wave.answer.error[0]),
        largest_whirl=wave.largest,
        **numbers,
    )


def free_wave(
    fill: Fill, speed: float, crest: float, crests: int, model: WaveModel | AutoWave
) -> FreeWaveResult:
    """The wave that runs round the drum by itself with crests of a given height."""
    require_positive("--speed", speed)
    require_positive("--volume", fill.volume)
    with as_options():
        choice = choose_free(model) if isinstance(model, AutoWave) else WaveChoice(model)
    model = choice.model
    if not isinstance(model, Potential | Linear):
        raise InputError("--model", model.name, "auto, linear or potential where --free is given")
    begin = time.perf_counter()
    with as_options():
        wave = model.free_wave(fill, speed, crest, crests)
    taken, numbers = time.perf_counter() - begin, judge(wave.numbers, wave.ranges)
    notes = (*([no_answer(wave.reason)] if wave.reason else []), *out_of_range(numbers))
    if wave.converged and float(wave.depth.max()) > fill.chamber.radius - fill.chamber.inner_radius:
        notes = (*notes, inner_wall())
    return FreeWaveResult(
        case=_case(fill, Whirl(speed, wave.whirl_speed[0] if wave.converged else speed, 0.0), choice),
        mode=crests,
        whirl_speed=np.array(wave.whirl_speed),
        crest=wave.crest,
        trough=wave.trough,
        crest_number=wave.crest_number,
        branch=wave.branch or None,
        converged=wave.converged,
        in_range=not notes,
        mass_error=wave.mass_error,
        error_estimate=wave.error,
        wall_time=taken,
        theta=wave.theta,
        depth=wave.depth,
        notes=notes,
        validity=numbers,
    )


def _beyond_waves(fill: Fill, whirl: Whirl, wave: LiquidWave) -> tuple[Note, ...]:
    """Whether the whirl is larger than any that a smooth steady wave follows, and why those end."""
    if not any(number.name == _SMOOTH and not number.in_range for number in judge(wave.numbers, wave.ranges)):
        return ()
    size, layer = whirl.amplitude / fill.depth, fill.depth / fill.chamber.radius
    above = float(detuning_ratio(layer, whirl.detuning)) > 1.0
    return (no_smooth_wave(size, size / wave.numbers[_SMOOTH], above),)


@contextmanager
def as_options() -> Iterator[None]:
    """Name what a model refuses as the options of the command line."""
    try:
        yield
    except InputError as fault:
        option = "--" + fault.field.replace("_", "-")
        raise InputError(option, fault.value, fault.allowed) from fault


def _force_ratio(fill: Fill, whirl: Whirl, wave: LiquidWave) -> complex:
    """Force over that of a full drum; without a deflection the limit of a small one, if the model has one."""
    unbalance, slope = complex(wave.answer.unbalance[0]), float(wave.answer.slope[0])
    if whirl.amplitude == 0.0:
        return unbalance if math.isnan(slope) else complex(slope / fill.full_mass)
    full = fill.full_mass * whirl.amplitude
    return complex(unbalance.real / full, unbalance.imag / full)


def wave_notes(wave: LiquidWave) -> tuple[Note, ...]:
    """Why there is no answer, and where the model is out of its range."""
    clear = wave.answer.limits.get("inner_wall")
    return (
        *([no_answer(wave.reason)] if wave.reason else []),
        *out_of_range(tuple(n for n in judge(wave.numbers, wave.ranges) if n.name not in (_SMOOTH, _GRIDS))),
        *([against_whirl(wave.counter)] if wave.counter > _ONE_WAY else []),
        *([] if clear is None or clear[0] else [inner_wall()]),
    )


def _case(fill: Fill, whirl: Whirl, choice: WaveChoice) -> LayerCase:
    """The whirl, the chamber and the model, for texts and figures."""
    model = choice.model
    dispersed = isinstance(model, LongWave) and model.numerics.dispersion
    return LayerCase(
        model=model.name,
        radius=fill.chamber.radius,
        inner_radius=fill.chamber.inner_radius,
        mean_depth=fill.depth,
        speed=whirl.spin,
        whirl_speed=whirl.speed,
        whirl_amplitude=whirl.amplitude,
        solver=model.solver,
        dispersion=dispersed or (isinstance(model, OneFamily) and model.dispersion),
        reason=choice.reason,
    )


def layer_history(
    fill: Fill,
    speed: float,
    whirl_speed: float,
    whirl_amplitude: float,
    model: WaveModel | AutoWave,
    duration: float,
    ramp: float = 0.0,
    gravity: float = 0.0,
    progress: Progress = None,
) -> LayerPeriodsResult:
    """Layer from rest in the drum, whirl period by whirl period, its whirl growing over the ramp, s."""
    whirl = _driven(Whirl(speed, whirl_speed, whirl_amplitude, ramp, gravity))
    choice = _in_time(model, fill, whirl)
    model = choice.model
    if isinstance(model, Potential):
        return _exact_history(fill, whirl, duration, choice, model, progress)
    if not isinstance(model, LongWave):
        raise InputError("--model", model.name, "auto, long_wave or potential where a --duration is given")
    from solvers.pypde.settle import simulate

    with as_options():
        history = simulate(fill, whirl, duration, model.friction, model.numerics, model.solver, progress)
    wave = model.wave_at_end(fill, whirl, history)
    numbers = judge(wave.numbers, wave.ranges)
    notes = (*wave_notes(wave), *_friction_notes(model, fill, whirl))
    return LayerPeriodsResult(_case(fill, whirl, choice), history, notes, numbers)


def _in_time(model: WaveModel | AutoWave, fill: Fill, whirl: Whirl) -> WaveChoice:
    """The model that goes through time."""
    with as_options():
        return choose_in_time(model, fill, whirl) if isinstance(model, AutoWave) else WaveChoice(model)


def _exact_history(
    fill: Fill, whirl: Whirl, duration: float, choice: WaveChoice, model: Potential, progress: Progress
) -> LayerPeriodsResult:
    """Exact waves from rest, until they break."""
    from solvers.potential.histories import simulate

    with as_options():
        found = simulate(fill, whirl, duration, model.steps, progress)
    wave = model.wave_at_end(fill, whirl, found)
    names = ("crest", "trough", "crest_number", "nodes", "force_gap")
    exact = ExactPeriods(state=found.state, **{name: getattr(found, name) for name in names})
    numbers = judge(wave.numbers, wave.ranges)
    return LayerPeriodsResult(_case(fill, whirl, choice), found.periods, wave_notes(wave), numbers, exact)


def layer_film(
    fill: Fill,
    speed: float,
    whirl_speed: float,
    whirl_amplitude: float,
    model: WaveModel | AutoWave,
    gravity: float = 0.0,
    duration: float | None = None,
    ramp: float = 0.0,
    progress: Progress = None,
) -> tuple[Wave, WaveFrames]:
    """A layer in the drum frame for a film; the parameters are `layer_history`'s.

    Long waves start from rest and run for six whirl periods unless a duration is given, exact ones where one
    is given; other waves are steady in the frame of the deflection and run round the drum for two.

    Walls and speeds with the wave at the end, and the wave over time.
    """
    whirl = _driven(Whirl(speed, whirl_speed, whirl_amplitude, ramp, gravity))
    if isinstance(model, AutoWave):
        with as_options():
            model = (choose_wave if duration is None else choose_in_time)(model, fill, whirl).model
    steady = not isinstance(model, LongWave) and (duration is None or not isinstance(model, Potential))
    if steady:
        answer = answer_layer(fill, speed, whirl_speed, whirl_amplitude, model, gravity, progress)
        return answer.wave(), steady_film(answer, whirl, 2.0 * whirl.period)
    with as_options():
        frames = _film_from_rest(fill, whirl, watched(model, progress), duration or 6.0 * whirl.period)
    linear = answer_layer(fill, speed, whirl_speed, whirl_amplitude, LINEAR, gravity)
    last = replace(linear.wave(), model=model.name, theta=frames.theta, depth=frames.depth[-1], notes=())
    return last, frames


def free_film(result: FreeWaveResult) -> tuple[Wave, WaveFrames]:
    """A free wave in the drum frame for a film, twice round the drum."""
    whirl = Whirl(result.case.speed, result.wave().whirl_speed, 0.0)
    frames = steady_film(result, whirl, 2.0 * whirl.period)
    # What the arrow points to is the crest: no whirl deflects the drum.
    towards = result.depth.max() * np.exp(1j * whirl.slip * frames.time)
    return result.wave(), replace(frames, deflection=towards)


def _film_from_rest(fill: Fill, whirl: Whirl, model: WaveModel, duration: float) -> WaveFrames:
    """Long waves or exact ones from rest."""
    # Eight pictures at least while the deflection turns once, and enough for a smooth film.
    frames = int(np.clip(8.0 * duration / whirl.period, 120, 2000))
    periods = duration / whirl.period
    if isinstance(model, Potential):
        from solvers.potential.histories import film as exact_film

        shots = exact_film(fill, whirl, frames, periods, model.steps, model.progress)
    else:
        from solvers.pypde.settle import film

        assert isinstance(model, LongWave)
        law, solver = model.friction, model.solver
        shots = film(fill, whirl, frames, periods, law, model.numerics, solver, model.progress)
    return WaveFrames(time=shots.time, theta=shots.theta, depth=shots.depth, deflection=shots.deflection)


def steady_film(answer: LayerResult | FreeWaveResult, whirl: Whirl, duration: float) -> WaveFrames:
    """Pictures of a wave that is steady in the frame of the deflection, as it runs round the drum."""
    frames = int(np.clip(60.0 * duration / whirl.period, 60, 2000))
    time = duration * np.arange(frames) / frames
    # Angles that crowd at a crest are too far apart for it where it runs to.
    apart, even = np.diff(answer.theta), np.linspace(-math.pi, math.pi, _EVEN, endpoint=False)
    theta = answer.theta if apart.max() < 1.5 * apart.min() else even
    turned = theta - whirl.slip * time[:, None]
    depth = np.interp(turned, answer.theta, drawn_depth(answer.depth, answer.case), period=2.0 * math.pi)
    deflection = whirl.amplitude * np.exp(1j * whirl.slip * time)
    return WaveFrames(time=time, theta=theta, depth=depth, deflection=deflection)
