"""Waves of a liquid layer under one prescribed whirl: long waves in time, one family of steady waves."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fluid import kdv, waves
from fluid.fill import Fill
from fluid.friction import damping_rate
from meshes.border import InputError
from solvers.layer import film, friction_law, settle, simulate
from solvers.prescribed import LayerHistory, Numerics, Whirl
from study.friction import Friction
from study.layer_answer import NO_FRICTION, LayerAnswer

if TYPE_CHECKING:
    from study.figures.wave import WaveHistory

# Beyond these the one-family wave is a sketch: height over the mean area, response left out.
_HIGH, _NEGLECTED = 0.3, 0.2


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


def long_wave_answer(fill: Fill, whirl: Whirl, friction: Friction, numerics: Numerics) -> LayerAnswer:
    """Nonlinear long waves, settled [theory: long_wave, eq. 4]."""
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


def kdv_answer(fill: Fill, whirl: Whirl, friction: Friction, numerics: Numerics) -> LayerAnswer:
    """Steady wave of the family whose resonance is nearer [theory: kdv, eq. 18].

    Raises
    ------
    InputError : gravity across the axis, quadratic friction, no free surface
    """
    from solvers.periodic import family_problem, solve

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
    return LayerAnswer(
        force_ratio=complex(kdv.force_ratio(family, offset, whirl.amplitude)),
        offset=offset,
        mass_error=abs(float(area.mean()) / family.mean_area - 1.0),
        converged=wave.converged,
        in_range=not (notes := _kdv_notes(family, eta, whirl, wave.reason)),
        mean_rotation=math.nan,
        wall_time=0.0,
        theta=around[order],
        depth=(chamber.radius - np.sqrt(chamber.radius**2 - 2.0 * area))[order],
        notes=notes,
        gravity_offset=0.0,
        captured=True,
    )


def _friction_rate(fill: Fill, whirl: Whirl, friction: Friction) -> float:
    """Rate at which the wall friction stops the mean layer, 1/s [theory: long_wave, eq. 9]."""
    if friction.law == "quadratic":
        raise InputError("--friction", friction.law, "none, stokes or linear for one family of waves")
    radius = fill.chamber.radius
    law, coefficient = friction_law(friction.law, friction.coefficient, fill, whirl)
    area = fill.volume / (2.0 * math.pi * fill.chamber.height * radius**2)
    lid = 2.0 * radius / fill.chamber.height
    return float(damping_rate(law, coefficient, lid, fill.depth / radius, area, 0.0))


def _kdv_notes(c: kdv.KdvCoefficients, eta: kdv.Array, whirl: Whirl, reason: str) -> tuple[str, ...]:
    """What one weakly nonlinear family leaves out here."""
    found = kdv.validity(c, eta, whirl.slip)
    high, left_out = float(found.amplitude), float(found.neglected)
    notes = [reason] if reason else []
    if high > _HIGH:
        notes.append(f"the wave is high: {high:.2g} of the mean area, where weakly nonlinear ends at 0.3")
    if left_out > _NEGLECTED:
        notes.append(f"far from resonance: the other family would answer {left_out:.2g} times as much")
    if float(found.thinnest) <= 0.0:
        notes.append("the wave would run the wall dry, which it does not know")
    return tuple(notes)
