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
from study.layer_answer import NO_FRICTION, LayerAnswer, wave_amplitude
from study.validity import Number, judge, strained

if TYPE_CHECKING:
    from study.figures.wave import WaveHistory


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
    """Pictures of the wave from rest, in the drum frame; the parameters are `layer_history`'s.

    Raises
    ------
    InputError : a value out of its range, a model other than `long_wave`
    """
    from study.figures.wave import WaveHistory

    if model != "long_wave":
        raise InputError("--model", model, "long_wave for a layer set in motion")
    whirl = Whirl(speed, whirl_speed, whirl_amplitude, ramp, gravity)
    law = friction_law(friction.law, friction.coefficient, fill, whirl)
    # Eight pictures at least while the deflection turns once, and enough for a smooth film.
    frames = int(np.clip(8.0 * duration / whirl.period, 120, 2000))
    shots = film(fill, whirl, frames, duration / whirl.period, law, numerics)
    return WaveHistory(time=shots.time, theta=shots.theta, depth=shots.depth, deflection=shots.deflection)


def steady_film(answer: LayerAnswer, whirl: Whirl, duration: float) -> WaveHistory:
    """Pictures of a wave that stands still in the frame of the deflection, as it runs round the drum.

    Parameters
    ----------
    answer : with its profile
    whirl : that it answers
    duration : s
    """
    from study.figures.wave import WaveHistory

    frames = int(np.clip(60.0 * duration / whirl.period, 60, 2000))
    time = duration * np.arange(frames) / frames
    turned = answer.theta - whirl.slip * time[:, None]
    depth = np.interp(turned, answer.theta, answer.depth, period=2.0 * math.pi)
    deflection = whirl.amplitude * np.exp(1j * whirl.slip * time)
    return WaveHistory(time=time, theta=answer.theta, depth=depth, deflection=deflection)


def long_wave_answer(fill: Fill, whirl: Whirl, friction: Friction, numerics: Numerics) -> LayerAnswer:
    """Nonlinear long waves, settled [theory: long_wave, eq. 4]."""
    chamber, surface = fill.chamber, fill.surface_radius
    history = settle(fill, whirl, friction_law(friction.law, friction.coefficient, fill, whirl), numerics)
    answered = history.force_ratio.size > 0
    validity = long_wave_validity(fill, whirl, history)
    notes = long_wave_notes(fill, history, validity)
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


def long_wave_notes(fill: Fill, history: LayerHistory, validity: tuple[Number, ...]) -> tuple[str, ...]:
    """Why there is no answer, and where the long waves are out of their range, in words."""
    chamber = fill.chamber
    notes = (*([history.reason] if history.reason else []), *strained(validity))
    if history.depth.size and history.depth.max() > chamber.radius - chamber.inner_radius:
        notes = (*notes, "the surface reaches the inner wall")
    return notes


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
    size = kdv.validity(family, eta, whirl.slip)
    sizes = {"wave_amplitude": float(size.amplitude), "other_family": float(size.neglected)}
    validity = judge("kdv", fill, whirl, sizes)
    # Below nothing and above all that the drum holds there is no layer, whatever the equation says.
    possible = float(size.thinnest) > 0.0 and float(eta.max()) < 0.5 * surface**2
    reason = wave.reason if possible else "the wave would run the wall dry or fill the drum"
    notes = (*([reason] if reason else []), *strained(validity))
    return LayerAnswer(
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
    law, coefficient = friction_law(friction.law, friction.coefficient, fill, whirl)
    area = fill.volume / (2.0 * math.pi * fill.chamber.height * radius**2)
    lid = 2.0 * radius / fill.chamber.height
    return float(damping_rate(law, coefficient, lid, fill.depth / radius, area, 0.0))
