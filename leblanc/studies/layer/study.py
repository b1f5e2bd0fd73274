"""Waves of a liquid layer under one prescribed whirl, by any liquid model that knows them."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from fluid import waves
from fluid.fill import Fill
from fluid.friction.laws import NO_FRICTION, Friction
from fluid.liquid import Liquid
from leblanc.core.notes import Note
from leblanc.core.progress import update
from leblanc.core.question import called
from leblanc.core.terminal import say
from leblanc.liquid.choose import across_gravity
from leblanc.liquid.models import MARCHED, wave_model
from leblanc.liquid.notes import (
    LayerCode,
    against_whirl,
    dry_wall,
    friction_frequency,
    inner_wall,
    lee_waves,
    no_answer,
    no_smooth_wave,
    out_of_range,
    smeared_baffles,
    two_grids,
)
from leblanc.liquid.validity import judge
from leblanc.liquid.whirling import (
    AUTO,
    LAYER_MODELS,
    TOLERANCE,
    AutoWave,
    WaveChoice,
    choose_free,
    choose_in_time,
    choose_wave,
    watched,
)
from leblanc.scene.chambers import round_chamber
from leblanc.scene.scene import Scene, liquid_of, require_whirl
from leblanc.studies.layer.answer import (
    AnyLayerAnswer,
    ExactPeriods,
    ExactWave,
    FreeWaveAnswer,
    LayerAnswer,
    LayerCase,
    PeriodsAnswer,
    drawn_depth,
)
from leblanc.studies.layer.wave import Wave, WaveFrames
from meshes.errors import InputError, require_not_negative, require_positive
from solvers.liquid_model import LiquidWave, WaveModel, Whirl, drag_frequency
from solvers.potential.model import Potential, PotentialWave
from solvers.potential.steady import Branch
from solvers.pypde.models import LongWave, OneFamily
from solvers.synchronous.models import LINEAR, Linear
from solvers.wave_error import detuning_ratio

_EVEN = 720  # angles of a film
_SMOOTH = "smooth_whirl"  # has a note of its own, which says why
_GRIDS = "grid_gap"  # likewise
_SLOWEST = 1e-9  # whirl over the spin
_ONE_WAY = 1e-6  # part of the answer that may go the other way round before it is worth a note


def answer(
    scene: Scene | None,
    chamber: int | None,
    radius: float | None,
    height: float | None,
    volume: float | None,
    speed: float | None,
    whirl_speed: float | None,
    whirl_amplitude: float | None,
    free: float | None,
    mode: int | None,
    model: str,
    tolerance: float | None,
    cells: int | None,
    baffles: int,
    baffle_tip_radius: float,
    baffle_wall_gap: float,
    dispersion: bool,
    friction: Friction | None,
    gravity: float | None,
    liquid: Liquid | None,
    duration: float | None,
    ramp: float,
    solver: str | None,
) -> AnyLayerAnswer:
    """Answer to a whirl, settled or from rest over a duration, or the natural wave of a crest height."""
    update(what="waves under the whirl")
    if scene is not None:
        walls = {"radius": radius, "height": height, "baffles": baffles or None}
        fill = _of_machine(scene, chamber, walls)
        drag = scene.model.friction if model in (AUTO, *MARCHED) else NO_FRICTION
        fill = Fill(fill.chamber, liquid or fill.liquid, fill.volume if volume is None else volume)
        speed = scene.speeds.stop if speed is None else speed
        gravity = across_gravity(scene) if gravity is None else gravity
    else:
        if chamber is not None:
            raise InputError("chamber", chamber, "left out without a machine")
        size = _given("radius", radius), _given("height", height)
        ring = round_chamber(*size, baffles, baffle_tip_radius, baffle_wall_gap)
        fill = Fill(ring, liquid or liquid_of("water", "liquid"), _given("volume", volume))
        drag, speed = NO_FRICTION, _given("speed", speed)
    friction, gravity = drag if friction is None else friction, gravity or 0.0
    if free is not None:
        unused = {
            "whirl_speed": whirl_speed, "whirl_amplitude": whirl_amplitude, "duration": duration,
            "solver": solver, "dispersion": dispersion or None, "baffles": baffles or None,
            "gravity": gravity or None, "ramp": ramp or None,
        }  # fmt: skip
        for name, value in unused.items():
            if value is not None:
                raise InputError(name, value, "left out where free is given")
        made = _named(model, friction, cells, tolerance=tolerance)
        return free_wave(fill, speed, float(free), 1 if mode is None else mode, made)
    if mode is not None:
        raise InputError("mode", mode, "left out without free")
    if gravity > 0.0 and not whirl_amplitude:  # alone it drives: nothing whirls
        whirl_speed, whirl_amplitude = speed if whirl_speed is None else whirl_speed, 0.0
    if whirl_speed is None or whirl_amplitude is None:
        name = "whirl_amplitude" if whirl_amplitude is None else "whirl_speed"
        raise InputError(name, None, "given, or free in its place")
    made = _named(model, friction, cells, dispersion, solver, tolerance)
    asked: dict[str, Any] = {
        "fill": fill, "speed": speed, "whirl_speed": whirl_speed, "whirl_amplitude": whirl_amplitude,
        "model": made, "gravity": gravity,
    }  # fmt: skip
    if duration is None:
        return replace(answer_layer(**asked), asked=asked | {"ramp": ramp})
    asked |= {"duration": duration, "ramp": ramp}
    return replace(layer_history(**asked), asked=asked)


def _given(name: str, value: float | None) -> float:
    """A value that only a machine could stand for."""
    if value is None:
        raise InputError(name, None, "given, or a machine in place of it")
    return value


def _of_machine(scene: Scene, chamber: int | None, walls: Mapping[str, float | None]) -> Fill:
    """A chamber of a machine with its liquid, counted from 1; it has walls of its own."""
    for name, value in walls.items():
        if value is not None:
            raise InputError(name, value, "left out where a machine is given")
    require_whirl(scene)
    number = 1 if chamber is None else chamber
    if not 1 <= number <= len(scene.fills):
        allowed = f"1 to {len(scene.fills)}" if scene.fills else "of a machine with chambers"
        raise InputError("chamber", number, allowed)
    if scene.fills[number - 1].chamber.section is not None:
        raise InputError("chamber", number, "one between circular walls")
    return scene.fills[number - 1]


def _named(
    name: str,
    friction: Friction,
    cells: int | None,
    dispersion: bool = False,
    solver: str | None = None,
    tolerance: float | None = None,
) -> WaveModel | AutoWave:
    """The model that is named, or what stands for it until the whirl is known."""
    if name not in LAYER_MODELS:
        raise InputError("model", name, "one of " + ", ".join(LAYER_MODELS))
    if name != AUTO:
        if tolerance is not None:
            raise InputError("tolerance", tolerance, f"left out for {name}; auto has one")
        return wave_model(name, friction, cells, dispersion, solver)
    if solver is not None:
        raise InputError("solver", solver, "left out for auto; long_wave and kdv have one")
    return AutoWave(friction, cells, dispersion, TOLERANCE if tolerance is None else tolerance)


def _told(share: float) -> None:
    """Say which share of the time is done."""
    update(share, 1.0)


def present(answer: AnyLayerAnswer, profile: bool, film: Path | None) -> AnyLayerAnswer:
    """The answer with its depth around the wall or without; its film is written."""
    if film is not None and (answer.converged or not isinstance(answer, FreeWaveAnswer)):
        animate = called("leblanc.studies.layer.figure:animate")
        update(what="waves through time")
        wave, frames = free_film(answer) if isinstance(answer, FreeWaveAnswer) else layer_film(**answer.asked)
        update(what="drawing")
        say(f"wrote {film}, {animate(wave, frames, film, update)} frames")
    return replace(answer, profile=profile)


def answer_layer(
    fill: Fill,
    speed: float,
    whirl_speed: float,
    whirl_amplitude: float,
    model: WaveModel | AutoWave,
    gravity: float = 0.0,
) -> LayerAnswer:
    """Answer of the liquid in one chamber to a circular whirl of its axis; SI units.

    The whirl speed is that in space, not 0, negative against the spin; without an amplitude under gravity the
    spin takes its place. Without an amplitude statics, linear theory and elements give the limit of the force
    ratio, the others no force. A model is one of `leblanc.liquid.models.wave_model`, or
    what stands for the cheapest that is good enough. Gravity acts across the axis.
    """
    require_positive("speed", speed)
    require_not_negative("whirl_amplitude", whirl_amplitude)
    require_positive("volume", fill.volume)
    require_not_negative("gravity", gravity)
    begin = time.perf_counter()
    whirl = _driven(Whirl(speed, whirl_speed, whirl_amplitude, gravity=gravity))
    choice = choose_wave(model, fill, whirl) if isinstance(model, AutoWave) else WaveChoice(model)
    wave = choice.wave or watched(_with_baffles(choice.model, fill), _told).wave(fill, whirl)
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
    return LayerAnswer(
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
        wall_drift=_wall_drift(fill, speed, gravity),
        captured=not gravity or speed > float(waves.capture_speed(surface, gravity)),
        validity=judge(wave.numbers, wave.ranges),
        exact=exact,
    )


def _wall_drift(fill: Fill, speed: float, gravity: float) -> float:
    """Drift of a clear ring along its wall by gravity, rad/s; 0 without gravity, nan without such a ring."""
    if not gravity:
        return 0.0
    radius, surface = fill.chamber.radius, fill.surface_radius
    if fill.uneven or speed <= float(waves.capture_speed(surface, gravity)):
        return math.nan
    return float(waves.wall_drift(radius, (radius / surface) ** 2, speed, gravity))


def _driven(whirl: Whirl) -> Whirl:
    """Under gravity alone nothing whirls: the answer is that of the drum's own frame."""
    # Forces are over the whirl speed squared.
    if not _SLOWEST * whirl.spin <= abs(whirl.speed) < math.inf:
        allowed = f"a finite number other than 0, at least {_SLOWEST:g} of the spin"
        raise InputError("whirl_speed", whirl.speed, allowed)
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
        allowed = f"0 for {model.name}; fem takes them"
        raise InputError("baffles", fill.chamber.baffles.count, allowed)
    return model


def _exact(wave: PotentialWave) -> ExactWave:
    """Quantities of the fully nonlinear wave alone."""
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
) -> FreeWaveAnswer:
    """The wave that runs round the drum by itself, its crests so many mean depths deep, more than 1."""
    require_positive("speed", speed)
    require_positive("volume", fill.volume)
    choice = choose_free(model) if isinstance(model, AutoWave) else WaveChoice(model)
    model = choice.model
    if not isinstance(model, Potential | Linear):
        raise InputError("model", model.name, "auto, linear or potential where free is given")
    begin = time.perf_counter()
    wave = model.free_wave(fill, speed, crest, crests)
    taken, numbers = time.perf_counter() - begin, judge(wave.numbers, wave.ranges)
    notes = (*([no_answer(wave.reason)] if wave.reason else []), *out_of_range(numbers))
    if wave.converged and float(wave.depth.max()) > fill.chamber.radius - fill.chamber.inner_radius:
        notes = (*notes, inner_wall())
    return FreeWaveAnswer(
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
) -> PeriodsAnswer:
    """Layer from rest in the drum, whirl period by whirl period; the whirl grows over the ramp, s.

    The other parameters are those of `answer_layer`.
    """
    whirl = _driven(Whirl(speed, whirl_speed, whirl_amplitude, ramp, gravity))
    choice, exact = _in_time(model, fill, whirl), None
    chosen = choice.model
    wave: LiquidWave
    if isinstance(chosen, Potential):
        from solvers.potential.histories import simulate as exact_simulate

        found = exact_simulate(fill, whirl, duration, chosen.steps, _told)
        history, wave = found.periods, chosen.wave_at_end(fill, whirl, found)
        names = ("crest", "trough", "crest_number", "nodes", "force_gap")
        exact = ExactPeriods(state=found.state, **{name: getattr(found, name) for name in names})
        notes = wave_notes(wave)
    elif isinstance(chosen, LongWave):
        from solvers.pypde.settle import simulate

        history = simulate(fill, whirl, duration, chosen.friction, chosen.numerics, chosen.solver, _told)
        wave = chosen.wave_at_end(fill, whirl, history)
        notes = (*wave_notes(wave), *_friction_notes(chosen, fill, whirl))
    else:
        raise InputError("model", chosen.name, "auto, long_wave or potential where a duration is given")
    return PeriodsAnswer(
        case=_case(fill, whirl, choice),
        history=history,
        converged=history.converged,
        in_range=all(note.code == LayerCode.FRICTION_FREQUENCY for note in notes),
        notes=notes,
        validity=judge(wave.numbers, wave.ranges),
        exact=exact,
    )


def _in_time(model: WaveModel | AutoWave, fill: Fill, whirl: Whirl) -> WaveChoice:
    """The model that goes through time."""
    return choose_in_time(model, fill, whirl) if isinstance(model, AutoWave) else WaveChoice(model)


def layer_film(
    fill: Fill,
    speed: float,
    whirl_speed: float,
    whirl_amplitude: float,
    model: WaveModel | AutoWave,
    gravity: float = 0.0,
    duration: float | None = None,
    ramp: float = 0.0,
) -> tuple[Wave, WaveFrames]:
    """A layer in the drum frame for a film; the parameters are `layer_history`'s.

    Long waves start from rest and run for six whirl periods unless a duration is given, exact ones where one
    is given; other waves are steady in the frame of the deflection and run round the drum for two. The first
    answer is the wave at the end.
    """
    whirl = _driven(Whirl(speed, whirl_speed, whirl_amplitude, ramp, gravity))
    if isinstance(model, AutoWave):
        model = (choose_wave if duration is None else choose_in_time)(model, fill, whirl).model
    steady = not isinstance(model, LongWave) and (duration is None or not isinstance(model, Potential))
    if steady:
        answer = answer_layer(fill, speed, whirl_speed, whirl_amplitude, model, gravity)
        return answer.wave(), steady_film(answer, whirl, 2.0 * whirl.period)
    frames = _film_from_rest(fill, whirl, watched(model, _told), duration or 6.0 * whirl.period)
    linear = answer_layer(fill, speed, whirl_speed, whirl_amplitude, LINEAR, gravity)
    last = replace(linear.wave(), model=model.name, theta=frames.theta, depth=frames.depth[-1], notes=())
    return last, frames


def free_film(result: FreeWaveAnswer) -> tuple[Wave, WaveFrames]:
    """A natural sloshing wave in the drum frame for a film, twice round the drum."""
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


def steady_film(answer: LayerAnswer | FreeWaveAnswer, whirl: Whirl, duration: float) -> WaveFrames:
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
