"""Waves of a liquid layer under one prescribed whirl: long waves in time, one family of steady waves."""

from __future__ import annotations

import math
import time
from dataclasses import replace

import numpy as np

from fluid import kdv, waves
from fluid.fill import Fill
from fluid.friction import NO_FRICTION, Friction, damping_rate
from leblanc.results import layer as notes_of
from leblanc.results.base import Note
from leblanc.results.layer import (
    LayerCase,
    LayerPeriodsResult,
    LayerResult,
    Number,
    Wave,
    WaveFrames,
    angles,
    wave_amplitude,
)
from leblanc.studies.validity import judge
from meshes.arrays import Array
from meshes.errors import InputError, require_not_negative, require_positive
from solvers.layer.settle import film, settle, simulate
from solvers.layer.state import LayerHistory, Numerics, Whirl
from solvers.statics.hydrostatics import equilibrium

MOST_CELLS = 600  # around; the matrices of the free surface are dense
_ACROSS = 6
_ONE_WAY = 1e-6  # part of the answer that may go the other way round before it is worth a note


def fem_answer(fill: Fill, whirl: Whirl, friction: Friction, cells: int) -> LayerResult:
    """Forced response of the liquid in the drum's frame [theory: sloshing, eq. 13-16].

    Parameters
    ----------
    fill : chamber and liquid
    whirl : of its axis
    friction : none
    cells : around the liquid, at least

    Returns
    -------
    The part of the answer that turns with the whirl; depths at an instant when the deflection lies along the
    first baffle.

    Raises
    ------
    InputError : friction, gravity, a full chamber, too many cells
    """
    _check(fill, whirl, friction, cells)
    from meshes.rings.quadrilaterals import ring
    from solvers.sloshing.forced import FORWARD, displacement_field, newton_force
    from solvers.sloshing.modes import surface_displacement
    from solvers.sloshing.system import condense

    chamber, inner = fill.chamber, fill.surface_radius
    system = condense(ring(chamber.radius, inner, cells, _ACROSS, baffles=chamber.baffles))
    pull = whirl.speed**2 * whirl.amplitude or 1.0  # without any amplitude the limit of the ratio
    force = (pull * FORWARD).astype(complex)
    field = displacement_field(system, whirl.spin, whirl.slip, force)
    total = newton_force(system, whirl.spin, whirl.slip, force, field)
    moment = -(system.moment @ field) / system.liquid_area
    onward, counter = 0.5 * (total @ FORWARD.conj()), 0.5 * (total @ FORWARD)
    nodes, moved = surface_displacement(system.section, system.on_nodes(field[None]))
    displacement = moved[0].real * (whirl.amplitude > 0.0)
    offset = complex(0.5 * (moment @ FORWARD.conj())) if whirl.amplitude > 0.0 else 0j
    height = float(np.abs(displacement).max())
    validity = judge("linear", fill, whirl, {"wave_amplitude": height / fill.depth})
    notes = [*notes_of.out_of_range(validity)]
    if abs(counter) > _ONE_WAY * abs(onward):
        notes.append(notes_of.against_whirl(float(abs(counter) / abs(onward))))
    if inner - height < chamber.inner_radius:
        notes.append(notes_of.inner_wall())
    theta, drawn = _profile(system.section.points[nodes], displacement)
    return LayerResult(
        case=_case(fill, whirl, "fem"),
        force_ratio=complex(onward / (pull * system.enclosed_area)),
        offset=offset,
        mass_error=abs(system.liquid_area * chamber.height / fill.volume - 1.0),
        converged=bool(np.isfinite(onward)),
        in_range=not notes,
        mean_rotation=0.0,
        wall_time=0.0,
        theta=theta,
        depth=np.clip(chamber.radius - inner - drawn, 0.0, chamber.radius),
        notes=tuple(notes),
        gravity_offset=0.0,
        captured=True,
        validity=validity,
    )


def _check(fill: Fill, whirl: Whirl, friction: Friction, cells: int) -> None:
    if friction.law != "none":
        raise InputError("--friction", friction.law, "none for finite elements, which are inviscid")
    if whirl.gravity != 0.0:
        raise InputError("--gravity", whirl.gravity, "0 for finite elements; --model linear has it")
    chamber = fill.chamber
    if fill.depth >= chamber.radius * (1.0 - 1e-9) or fill.surface_radius <= chamber.inner_radius:
        raise InputError("--volume", fill.volume, "less than what fills the chamber, for a free surface")
    if not 8 <= cells <= MOST_CELLS:
        raise InputError("--cells", cells, f"8 to {MOST_CELLS} for finite elements")


def _profile(points: Array, displacement: Array) -> tuple[Array, Array]:
    """Displacement of the surface at the angles of a profile, from that at its nodes."""
    theta = angles()
    at = np.arctan2(points[:, 1], points[:, 0])
    order = np.argsort(at, kind="stable")
    return theta, np.interp(theta, at[order], displacement[order], period=2.0 * math.pi)


def layer_history(
    fill: Fill,
    speed: float,
    whirl_speed: float,
    whirl_amplitude: float,
    model: str,
    duration: float,
    ramp: float = 0.0,
    friction: Friction = NO_FRICTION,
    gravity: float = 0.0,
    numerics: Numerics | None = None,
) -> LayerPeriodsResult:
    """Layer from rest in the drum, whirl period by whirl period; the parameters are `answer_layer`'s.

    Parameters
    ----------
    duration : time answered, s
    ramp : time over which the whirl amplitude grows, s

    Raises
    ------
    InputError : a value out of its range, a model other than `long_wave`
    """
    if model != "long_wave":
        raise InputError("--model", model, "long_wave where a --duration is given")
    whirl = Whirl(speed, whirl_speed, whirl_amplitude, ramp, gravity)
    history = simulate(fill, whirl, duration, friction, numerics)
    validity = long_wave_validity(fill, whirl, history)
    return LayerPeriodsResult(
        _case(fill, whirl, model), history, long_wave_notes(fill, history, validity), validity
    )


def layer_film(
    fill: Fill,
    speed: float,
    whirl_speed: float,
    whirl_amplitude: float,
    model: str,
    friction: Friction = NO_FRICTION,
    gravity: float = 0.0,
    numerics: Numerics | None = None,
    duration: float | None = None,
    ramp: float = 0.0,
) -> tuple[Wave, WaveFrames]:
    """A layer in the drum frame for a film; the parameters are `layer_history`'s.

    Long waves start from rest and run for six whirl periods unless a duration is given; waves of the other
    models stand still in the frame of the deflection and run round the drum for two.

    Returns
    -------
    Walls and speeds with the wave at the end, and the wave over time

    Raises
    ------
    InputError : a value out of its range
    """
    whirl = Whirl(speed, whirl_speed, whirl_amplitude, ramp, gravity)
    if model != "long_wave":
        answer = answer_layer(fill, speed, whirl_speed, whirl_amplitude, model, friction, gravity, numerics)
        return answer.wave(), steady_film(answer, whirl, 2.0 * whirl.period)
    frames = _film_from_rest(fill, whirl, friction, numerics or Numerics(), duration or 6.0 * whirl.period)
    linear = answer_layer(fill, speed, whirl_speed, whirl_amplitude, "linear", NO_FRICTION, gravity, numerics)
    last = replace(linear.wave(), model=model, theta=frames.theta, depth=frames.depth[-1], notes=())
    return last, frames


def _film_from_rest(
    fill: Fill, whirl: Whirl, friction: Friction, numerics: Numerics, duration: float
) -> WaveFrames:
    """Long waves from rest."""
    # Eight pictures at least while the deflection turns once, and enough for a smooth film.
    frames = int(np.clip(8.0 * duration / whirl.period, 120, 2000))
    shots = film(fill, whirl, frames, duration / whirl.period, friction, numerics)
    return WaveFrames(time=shots.time, theta=shots.theta, depth=shots.depth, deflection=shots.deflection)


def steady_film(answer: LayerResult, whirl: Whirl, duration: float) -> WaveFrames:
    """Pictures of a wave that stands still in the frame of the deflection, as it runs round the drum.

    Parameters
    ----------
    answer : with its profile
    whirl : that it answers
    duration : s
    """
    frames = int(np.clip(60.0 * duration / whirl.period, 60, 2000))
    time = duration * np.arange(frames) / frames
    turned = answer.theta - whirl.slip * time[:, None]
    depth = np.interp(turned, answer.theta, answer.depth, period=2.0 * math.pi)
    deflection = whirl.amplitude * np.exp(1j * whirl.slip * time)
    return WaveFrames(time=time, theta=answer.theta, depth=depth, deflection=deflection)


def long_wave_answer(fill: Fill, whirl: Whirl, friction: Friction, numerics: Numerics) -> LayerResult:
    """Nonlinear long waves, settled [theory: long_wave, eq. 4]."""
    chamber, surface = fill.chamber, fill.surface_radius
    history = settle(fill, whirl, friction, numerics)
    answered = history.force_ratio.size > 0
    validity = long_wave_validity(fill, whirl, history)
    notes = long_wave_notes(fill, history, validity)
    capture = float(waves.capture_speed(surface, whirl.gravity)) if whirl.gravity > 0.0 else 0.0
    kappa = (chamber.radius / surface) ** 2
    return LayerResult(
        case=_case(fill, whirl, "long_wave"),
        force_ratio=complex(history.force_ratio[-1]) if answered else complex(math.nan, math.nan),
        offset=complex(history.offset[-1]) if answered else complex(math.nan, math.nan),
        mass_error=history.mass_error,
        converged=history.converged,
        in_range=not notes,
        mean_rotation=float(history.mean_rotation[-1]) if answered else math.nan,
        wall_time=0.0,
        theta=history.theta,
        depth=history.depth,
        notes=notes,
        gravity_offset=float(waves.gravity_offset(kappa, whirl.spin, whirl.gravity))
        if whirl.gravity
        else 0.0,
        captured=whirl.spin > capture,
        validity=validity,
    )


def long_wave_validity(fill: Fill, whirl: Whirl, history: LayerHistory) -> tuple[Number, ...]:
    """What the long-wave assumption rests on, of an answer of `simulate` or `settle`."""
    found = {}
    if history.force_ratio.size:
        force = history.force_ratio
        found["force_gap"] = float(abs(force[-1] - history.pressure_ratio[-1])) / max(
            1.0, float(abs(force[-1]))
        )
        extremes = np.concatenate([history.depth_max, history.depth_min])
        found["wave_amplitude"] = wave_amplitude(extremes, fill.depth)
    return judge("long_wave", fill, whirl, found)


def long_wave_notes(fill: Fill, history: LayerHistory, validity: tuple[Number, ...]) -> tuple[Note, ...]:
    """Why there is no answer, and where the long waves are out of their range."""
    chamber = fill.chamber
    reached = history.depth.size and history.depth.max() > chamber.radius - chamber.inner_radius
    return (
        *([notes_of.no_answer(history.reason)] if history.reason else []),
        *notes_of.out_of_range(validity),
        *([notes_of.inner_wall()] if reached else []),
    )


def kdv_answer(fill: Fill, whirl: Whirl, friction: Friction, numerics: Numerics) -> LayerResult:
    """Steady wave of the family whose resonance is nearer [theory: kdv, eq. 18].

    Raises
    ------
    InputError : gravity across the axis, quadratic friction, no free surface
    """
    from solvers.waves.steady import family_problem, solve

    chamber, surface = fill.chamber, fill.surface_radius
    if whirl.gravity != 0.0:
        raise InputError("--gravity", whirl.gravity, "0 for one family of waves")
    if not chamber.inner_radius < surface < chamber.radius:
        raise InputError("--volume", fill.volume, "less than what fills the chamber, for a free surface")
    pair = [kdv.coefficients(chamber.radius, surface, whirl.spin, sign) for sign in (1, -1)]
    family = min(pair, key=lambda c: abs(whirl.slip - c.linear_speed))
    gamma = float(kdv.decay(family, _friction_rate(fill, whirl, friction)))
    problem = family_problem(family, whirl.speed**2 * whirl.amplitude, numerics.dispersion, gamma)
    wave = solve(problem, whirl.slip)
    points = max(numerics.cells, 2 * wave.modes.size + 2)
    eta = wave.profile(points)
    offset = complex(kdv.offset(family, eta))
    theta = 2.0 * math.pi * np.arange(points) / points
    around = np.mod(theta + math.pi, 2.0 * math.pi) - math.pi
    order = np.argsort(around)
    area = np.clip(family.mean_area + eta, 0.0, 0.5 * chamber.radius**2)
    size = kdv.validity(family, eta, whirl.slip)
    sizes = {"wave_amplitude": float(size.amplitude), "other_family": float(size.neglected)}
    validity = judge("kdv", fill, whirl, sizes)
    # Below nothing and above all that the drum holds there is no layer, whatever the equation says.
    possible = float(size.thinnest) > 0.0 and float(eta.max()) < 0.5 * surface**2
    reason = wave.reason if possible else "the wave would run the wall dry or fill the drum"
    notes = (*([notes_of.no_answer(reason)] if reason else []), *notes_of.out_of_range(validity))
    return LayerResult(
        case=_case(fill, whirl, "kdv"),
        force_ratio=complex(kdv.force_ratio(family, offset, whirl.amplitude)) if whirl.amplitude else 0j,
        offset=offset,
        mass_error=abs(float(area.mean()) / family.mean_area - 1.0),
        converged=wave.converged and possible,
        in_range=not notes,
        mean_rotation=math.nan,
        wall_time=0.0,
        theta=around[order],
        depth=(chamber.radius - np.sqrt(chamber.radius**2 - 2.0 * area))[order],
        notes=notes,
        gravity_offset=0.0,
        captured=True,
        validity=validity,
    )


def _friction_rate(fill: Fill, whirl: Whirl, friction: Friction) -> float:
    """Rate at which the wall friction stops the mean layer, 1/s [theory: long_wave, eq. 9]."""
    if friction.law == "quadratic":
        raise InputError("--friction", friction.law, "none, stokes or linear for one family of waves")
    radius = fill.chamber.radius
    law, coefficient = friction.at(fill.liquid.viscosity, whirl.slip, radius)
    area = fill.volume / (2.0 * math.pi * fill.chamber.height * radius**2)
    lid = 2.0 * radius / fill.chamber.height
    return float(damping_rate(law, coefficient, lid, fill.depth / radius, area, 0.0))


MODELS = ("statics", "linear", "long_wave", "kdv", "fem")
CELLS = 96  # of finite elements around the liquid


def answer_layer(
    fill: Fill,
    speed: float,
    whirl_speed: float,
    whirl_amplitude: float,
    model: str,
    friction: Friction = NO_FRICTION,
    gravity: float = 0.0,
    numerics: Numerics | None = None,
) -> LayerResult:
    """Answer of the liquid in one chamber to a circular whirl of its axis.

    Parameters
    ----------
    fill : chamber and liquid, with some liquid in it
    speed : spin speed Omega, rad/s
    whirl_speed : omega_w in space, rad/s, not 0; negative against the spin
    whirl_amplitude : A, m; without any, statics and linear theory give the limit of the force ratio, the
        others no force
    model : `statics` (synchronous whirl only), `linear` [theory: waves, eq. 5] `long_wave`, stepped in
        time until it settles [theory: long_wave, eq. 4], or `kdv`, one family of steady waves next to its
        resonance [theory: kdv, eq. 18], or `fem`, small whirls with baffles in the layer [theory: sloshing,
        eq. 13]
    friction : law of the wall friction; the linear theory and finite elements know none
    gravity : across the axis, m/s^2; for the linear and the long-wave model
    numerics : resolution of the long waves and of the elements; `dispersion` takes the exact one for `kdv`

    Raises
    ------
    InputError : a value out of its range, or one that the model does not serve
    """
    require_positive("--speed", speed)
    require_not_negative("--whirl-amplitude", whirl_amplitude)
    require_positive("--volume", fill.volume)
    require_not_negative("--gravity", gravity)
    if not math.isfinite(whirl_speed) or whirl_speed == 0.0:
        raise InputError("--whirl-speed", whirl_speed, "a finite number other than 0")
    if model not in MODELS:
        raise InputError("--model", model, "one of " + ", ".join(MODELS))
    if model != "fem" and fill.chamber.baffles is not None:
        raise InputError("--baffles", fill.chamber.baffles.count, f"0 for --model {model}; fem takes them")
    begin = time.perf_counter()
    whirl = Whirl(speed, whirl_speed, whirl_amplitude, gravity=gravity)
    if model == "fem":
        answer = fem_answer(fill, whirl, friction, numerics.cells if numerics else CELLS)
    elif model in ("long_wave", "kdv"):
        wave = long_wave_answer if model == "long_wave" else kdv_answer
        answer = wave(fill, whirl, friction, numerics or Numerics())
    else:
        solve = _statics if model == "statics" else _linear
        answer = solve(fill, whirl, friction)
    return replace(answer, wall_time=time.perf_counter() - begin)


def _case(fill: Fill, whirl: Whirl, model: str) -> LayerCase:
    """What was asked for, for whoever shows the answer."""
    return LayerCase(
        model=model,
        radius=fill.chamber.radius,
        inner_radius=fill.chamber.inner_radius,
        mean_depth=fill.depth,
        speed=whirl.spin,
        whirl_speed=whirl.speed,
        whirl_amplitude=whirl.amplitude,
    )


def _statics(fill: Fill, whirl: Whirl, friction: Friction) -> LayerResult:
    """Exact equilibrium: the liquid is at rest in the drum, so no friction acts on it."""
    speed, amplitude = whirl.spin, whirl.amplitude
    if whirl.speed != speed:
        raise InputError(
            "--whirl-speed", whirl.speed, f"the spin speed ({speed:g} rad/s) for the static model"
        )
    if whirl.gravity != 0.0:
        raise InputError(
            "--gravity", whirl.gravity, "0 for the static model: across the axis it turns in the drum"
        )
    chamber = fill.chamber
    state = equilibrium(chamber, fill.volume, amplitude, speed, gravity=0.0)
    moment = float(state.unbalance()[0])
    full = math.pi * chamber.radius**2 * chamber.height
    # Without a whirl the ratio is that of a vanishing one, which no depth of liquid runs dry.
    ratio = moment / (full * amplitude) if amplitude else 1.0
    theta = angles()
    # The surface is a circle about the rotation axis, at -A from the drum's axis.
    floor = float(state.wetted_height / state.steepness)
    squared = chamber.radius**2 * ((1.0 + amplitude / chamber.radius) ** 2 - floor)
    across = np.maximum(squared - np.square(amplitude * np.sin(theta)), 0.0)
    surface = np.maximum(np.sqrt(across) - amplitude * np.cos(theta), chamber.inner_radius)
    depth = np.clip(chamber.radius - surface, 0.0, chamber.radius)
    return LayerResult(
        case=_case(fill, whirl, "statics"),
        force_ratio=complex(ratio),
        offset=complex(moment / fill.volume - amplitude),
        mass_error=abs(float(state.volume) / fill.volume - 1.0),
        converged=bool(state.converged),
        in_range=True,
        mean_rotation=0.0,
        wall_time=0.0,
        theta=theta,
        depth=depth,
        notes=(notes_of.dry_wall(),) if bool(state.dry_patch) else (),
        gravity_offset=0.0,
        captured=True,
        validity=judge("statics", fill, whirl, {"wave_amplitude": wave_amplitude(depth, fill.depth)}),
    )


def _linear(fill: Fill, whirl: Whirl, friction: Friction) -> LayerResult:
    """Exact linear theory without friction."""
    speed, amplitude, gravity = whirl.spin, whirl.amplitude, whirl.gravity
    if friction.law != "none":
        raise InputError("--friction", friction.law, "none for the linear theory, which is inviscid")
    chamber, surface = fill.chamber, fill.surface_radius
    if fill.depth >= chamber.radius * (1.0 - 1e-9) or surface <= chamber.inner_radius:
        raise InputError("--volume", fill.volume, "less than what fills the chamber, for a free surface")
    kappa, ratio = (chamber.radius / surface) ** 2, whirl.speed / speed
    force = float(waves.force_ratio(kappa, ratio))
    offset = float(waves.offset_ratio(kappa, ratio)) * amplitude
    displacement = float(waves.displacement_ratio(kappa, ratio)) * amplitude
    capture = float(waves.capture_speed(surface, gravity)) if gravity > 0.0 else 0.0
    converged = math.isfinite(force) and math.isfinite(displacement)
    found = {"wave_amplitude": abs(displacement) / fill.depth}
    # A synchronous whirl's linear surface is the exact circle, to the square of its own offset, while wet.
    validity = judge("linear", fill, whirl, found, {} if whirl.slip else {"wave_amplitude": (0.0, 1.0)})
    unbounded = notes_of.no_answer("the whirl meets a free wave, the linear force is unbounded")
    notes = [*([] if converged else [unbounded]), *notes_of.out_of_range(validity)]
    if surface - abs(displacement) < chamber.inner_radius:
        notes.append(notes_of.inner_wall())
    theta = angles()
    drawn = surface + displacement * np.cos(theta) if converged else np.full(theta.shape, surface)
    lost = 0.5 * displacement**2 / (chamber.radius**2 - surface**2) if converged else math.nan
    return LayerResult(
        case=_case(fill, whirl, "linear"),
        force_ratio=complex(force),
        offset=complex(offset),
        mass_error=lost,
        converged=converged,
        in_range=not notes,
        mean_rotation=0.0,
        wall_time=0.0,
        theta=theta,
        depth=np.clip(chamber.radius - drawn, 0.0, chamber.radius),
        notes=tuple(notes),
        gravity_offset=float(waves.gravity_offset(kappa, speed, gravity)) if gravity > 0.0 else 0.0,
        captured=speed > capture,
        validity=validity,
    )
