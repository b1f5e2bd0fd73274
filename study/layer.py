"""The liquid's answer to one prescribed whirl, in the plane."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fluid import waves
from fluid.fill import Fill
from meshes.border import InputError, require_not_negative, require_positive
from solvers.hydrostatics import equilibrium
from solvers.layer import film, friction_law, settle, simulate
from solvers.prescribed import LayerHistory, Numerics, Whirl
from study.friction import Friction

if TYPE_CHECKING:
    from study.figures.wave import WaveHistory, WaveRecord

Array = NDArray[np.float64]

MODELS = ("statics", "linear", "long_wave")
NO_FRICTION = Friction("none", 0.0)
_POINTS = 360


@dataclass(frozen=True)
class LayerAnswer:
    """Force and centre of mass of a liquid layer; complex: along the deflection, 90 deg ahead of it.

    Parameters
    ----------
    force_ratio : force on the drum over m_f omega_w^2 A
    offset : liquid's centre of mass from the drum's axis, m
    mass_error : of the surface that the model draws, relative
    converged : the force is finite
    in_range : the model holds; `notes` says why not
    mean_rotation : of the liquid relative to the drum, rad/s
    wall_time : s
    theta, depth : angle from the deflection, rad, and depth of the layer there, m, shape (k,)
    notes : what the model leaves out here, in words
    gravity_offset : steady part of the offset under gravity across the axis, in space, m: up is negative
    captured : centrifugal acceleration at the surface exceeds gravity
    """

    force_ratio: complex
    offset: complex
    mass_error: float
    converged: bool
    in_range: bool
    mean_rotation: float
    wall_time: float
    theta: Array
    depth: Array
    notes: tuple[str, ...]
    gravity_offset: float
    captured: bool


def answer_layer(
    fill: Fill,
    speed: float,
    whirl_speed: float,
    whirl_amplitude: float,
    model: str,
    friction: Friction = NO_FRICTION,
    gravity: float = 0.0,
    numerics: Numerics | None = None,
) -> LayerAnswer:
    """Answer of the liquid in one chamber to a circular whirl of its axis.

    Parameters
    ----------
    fill : chamber and liquid, with some liquid in it
    speed : spin speed Omega, rad/s
    whirl_speed : omega_w in space, rad/s, not 0; negative against the spin
    whirl_amplitude : A, m
    model : `statics` (synchronous whirl only), `linear` [theory: waves, eq. 5] or `long_wave`, stepped in
        time until it settles [theory: long_wave, eq. 4]
    friction : law of the wall friction; the linear theory knows none
    gravity : across the axis, m/s^2; not for the static model
    numerics : resolution of the long-wave model

    Raises
    ------
    InputError : a value out of its range, or one that the model does not serve
    """
    require_positive("--speed", speed)
    require_positive("--whirl-amplitude", whirl_amplitude)
    require_positive("--volume", fill.volume)
    require_not_negative("--gravity", gravity)
    if not math.isfinite(whirl_speed) or whirl_speed == 0.0:
        raise InputError("--whirl-speed", whirl_speed, "a finite number other than 0")
    if model not in MODELS:
        raise InputError("--model", model, "one of " + ", ".join(MODELS))
    begin = time.perf_counter()
    if model == "long_wave":
        whirl = Whirl(speed, whirl_speed, whirl_amplitude, gravity=gravity)
        answer = _long_wave(fill, whirl, friction, numerics or Numerics())
    else:
        solve = _statics if model == "statics" else _linear
        answer = solve(fill, speed, whirl_speed, whirl_amplitude, friction, gravity)
    return replace(answer, wall_time=time.perf_counter() - begin)


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
) -> LayerHistory:
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
    return simulate(
        fill, whirl, duration, friction_law(friction.law, friction.coefficient, fill, whirl), numerics
    )


def wave_record(
    fill: Fill,
    speed: float,
    whirl_speed: float,
    whirl_amplitude: float,
    model: str,
    answer: LayerAnswer,
    **_: object,
) -> WaveRecord:
    """What the figure of a layer's wave shows; the parameters are `answer_layer`'s and its answer."""
    from study.figures.wave import WaveRecord

    return WaveRecord(
        title="Layer under a whirl",
        model=model,
        radius=fill.chamber.radius,
        inner_radius=fill.chamber.inner_radius,
        mean_depth=fill.depth,
        whirl_amplitude=whirl_amplitude,
        spin=speed,
        whirl_speed=whirl_speed,
        theta=answer.theta,
        depth=answer.depth,
        force_ratio=answer.force_ratio,
        offset=answer.offset,
        notes=answer.notes,
    )


def wave_film(
    fill: Fill,
    speed: float,
    whirl_speed: float,
    whirl_amplitude: float,
    model: str,
    friction: Friction,
    gravity: float,
    numerics: Numerics,
    duration: float,
    ramp: float,
) -> WaveHistory:
    """Pictures of the wave in the drum frame over a duration; the parameters are `layer_history`'s.

    Raises
    ------
    InputError : a value out of its range, a model other than `long_wave`
    """
    from study.figures.wave import WaveHistory

    if model != "long_wave":
        raise InputError("--model", model, "long_wave for an animation")
    whirl = Whirl(speed, whirl_speed, whirl_amplitude, ramp, gravity)
    law = friction_law(friction.law, friction.coefficient, fill, whirl)
    # Eight pictures at least while the deflection turns once, and enough for a smooth film.
    frames = int(np.clip(8.0 * duration / whirl.period, 120, 2000))
    shots = film(fill, whirl, frames, duration / whirl.period, law, numerics)
    return WaveHistory(time=shots.time, theta=shots.theta, depth=shots.depth, deflection=shots.deflection)


def _statics(
    fill: Fill, speed: float, whirl: float, amplitude: float, friction: Friction, gravity: float
) -> LayerAnswer:
    """Exact equilibrium: the liquid is at rest in the drum, so no friction acts on it."""
    if whirl != speed:
        raise InputError("--whirl-speed", whirl, f"the spin speed ({speed:g} rad/s) for the static model")
    if gravity != 0.0:
        raise InputError("--gravity", gravity, "0 for the static model: across the axis it turns in the drum")
    chamber = fill.chamber
    state = equilibrium(chamber, fill.volume, amplitude, speed, gravity=0.0)
    moment = float(state.unbalance()[0])
    full = math.pi * chamber.radius**2 * chamber.height
    theta = _angles()
    # The surface is a circle about the rotation axis, at -A from the drum's axis.
    floor = float(state.wetted_height / state.steepness)
    squared = chamber.radius**2 * ((1.0 + amplitude / chamber.radius) ** 2 - floor)
    across = np.maximum(squared - np.square(amplitude * np.sin(theta)), 0.0)
    surface = np.maximum(np.sqrt(across) - amplitude * np.cos(theta), chamber.inner_radius)
    return LayerAnswer(
        force_ratio=complex(moment / (full * amplitude)),
        offset=complex(moment / fill.volume - amplitude),
        mass_error=abs(float(state.volume) / fill.volume - 1.0),
        converged=bool(state.converged),
        in_range=True,
        mean_rotation=0.0,
        wall_time=0.0,
        theta=theta,
        depth=np.clip(chamber.radius - surface, 0.0, chamber.radius),
        notes=("the wall is dry in part",) if bool(state.dry_patch) else (),
        gravity_offset=0.0,
        captured=True,
    )


def _linear(
    fill: Fill, speed: float, whirl: float, amplitude: float, friction: Friction, gravity: float
) -> LayerAnswer:
    """Exact linear theory without friction."""
    if friction.law != "none":
        raise InputError("--friction", friction.law, "none for the linear theory, which is inviscid")
    chamber, surface = fill.chamber, fill.surface_radius
    if fill.depth >= chamber.radius * (1.0 - 1e-9) or surface <= chamber.inner_radius:
        raise InputError("--volume", fill.volume, "less than what fills the chamber, for a free surface")
    kappa, ratio = (chamber.radius / surface) ** 2, whirl / speed
    force = float(waves.force_ratio(kappa, ratio))
    offset = float(waves.offset_ratio(kappa, ratio)) * amplitude
    displacement = float(waves.displacement_ratio(kappa, ratio)) * amplitude
    capture = float(waves.capture_speed(surface, gravity)) if gravity > 0.0 else 0.0
    notes = []
    if not abs(displacement) < fill.depth:
        notes.append("the surface reaches the wall in linear theory: the amplitude is too large for it")
    if surface - abs(displacement) < chamber.inner_radius:
        notes.append("the surface reaches the inner wall")
    if speed <= capture:
        notes.append("gravity is stronger than the centrifugal acceleration at the surface")
    theta = _angles()
    converged = math.isfinite(force) and math.isfinite(displacement)
    drawn = surface + displacement * np.cos(theta) if converged else np.full(theta.shape, surface)
    lost = 0.5 * displacement**2 / (chamber.radius**2 - surface**2) if converged else math.nan
    return LayerAnswer(
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
    )


def _long_wave(fill: Fill, whirl: Whirl, friction: Friction, numerics: Numerics) -> LayerAnswer:
    """Nonlinear long waves, settled."""
    chamber, surface = fill.chamber, fill.surface_radius
    history = settle(fill, whirl, friction_law(friction.law, friction.coefficient, fill, whirl), numerics)
    answered = history.force_ratio.size > 0
    notes = _long_wave_notes(fill, whirl, history)
    capture = float(waves.capture_speed(surface, whirl.gravity)) if whirl.gravity > 0.0 else 0.0
    kappa = (chamber.radius / surface) ** 2
    return LayerAnswer(
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
    )


def _long_wave_notes(fill: Fill, whirl: Whirl, history: LayerHistory) -> tuple[str, ...]:
    """Where the long-wave assumption is strained."""
    notes = []
    if fill.depth > 0.3 * fill.chamber.radius:
        notes.append(f"the layer is deep: h0/R = {fill.depth / fill.chamber.radius:.2g}, long waves need 0.3")
    gap = np.abs(history.force_ratio - history.pressure_ratio)
    if gap.size and gap[-1] > 0.1 * max(1.0, float(np.abs(history.force_ratio[-1]))):
        notes.append("force by pressure and by momentum differ by more than a tenth: not a long wave")
    if history.depth.size and history.depth.max() > fill.chamber.radius - fill.chamber.inner_radius:
        notes.append("the surface reaches the inner wall")
    if whirl.gravity > 0.0 and whirl.spin**2 * fill.surface_radius <= whirl.gravity:
        notes.append("gravity is stronger than the centrifugal acceleration at the surface")
    return tuple(notes)


def _angles() -> Array:
    """Angles from the deflection all round, rad."""
    return np.linspace(-math.pi, math.pi, _POINTS, endpoint=False)
