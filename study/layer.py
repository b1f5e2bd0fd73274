"""The liquid's answer to one prescribed whirl, in the plane."""

from __future__ import annotations

import math
import time
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fluid import waves
from fluid.fill import Fill
from meshes.border import InputError, require_not_negative, require_positive
from solvers.hydrostatics import equilibrium
from solvers.prescribed import Numerics, Whirl
from study.friction import Friction
from study.layer_answer import NO_FRICTION, LayerAnswer, angles, wave_amplitude
from study.layer_fem import fem_answer
from study.layer_waves import kdv_answer, long_wave_answer
from study.validity import judge, strained

if TYPE_CHECKING:
    from study.figures.wave import WaveRecord

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
) -> LayerAnswer:
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


def _statics(fill: Fill, whirl: Whirl, friction: Friction) -> LayerAnswer:
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
    return LayerAnswer(
        force_ratio=complex(ratio),
        offset=complex(moment / fill.volume - amplitude),
        mass_error=abs(float(state.volume) / fill.volume - 1.0),
        converged=bool(state.converged),
        in_range=True,
        mean_rotation=0.0,
        wall_time=0.0,
        theta=theta,
        depth=depth,
        notes=("the wall is dry in part",) if bool(state.dry_patch) else (),
        gravity_offset=0.0,
        captured=True,
        validity=judge("statics", fill, whirl, {"wave_amplitude": wave_amplitude(depth, fill.depth)}),
    )


def _linear(fill: Fill, whirl: Whirl, friction: Friction) -> LayerAnswer:
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
    notes = [] if converged else ["the whirl meets a free wave, the linear force is unbounded"]
    notes += strained(validity)
    if surface - abs(displacement) < chamber.inner_radius:
        notes.append("the surface reaches the inner wall")
    theta = angles()
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
        validity=validity,
    )
