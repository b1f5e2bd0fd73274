"""Whirl over spin of a hollow rotor with a little oil, and what damping of the supports does [KSD16, KS94].

A rotor that whirls meets the backward wave of its liquid. Of two modes that decay at rates alpha and gamma
and make each other grow at kappa without decay, one grows where their frequencies differ by less than

    (alpha + gamma) sqrt(kappa^2/(alpha gamma) - 1),

the root of (lambda + alpha)(lambda + gamma + i difference) = kappa^2 on the imaginary axis; over the spin
they part at the rate 1 - c. More alpha widens such a band where alpha - gamma > 2 gamma alpha^2/kappa^2,
which some alpha does if gamma < kappa/sqrt(8), and closes it at alpha gamma = kappa^2.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cache

import numpy as np
from scipy.optimize import brentq

from fluid.friction.laws import NO_FRICTION, Friction, FrictionLaw
from fluid.whirl import damped_waves, plane_layer, slower_slip
from meshes.arrays import Array
from solvers.cycles.cycles import FEWEST, Branch, limit_cycles
from solvers.whirl.edges import unstable_bands
from solvers.whirl.growth import asynchronous_growth
from validation.case import Case, Claims, Effect
from validation.cases.published.partitions import NATURAL, chamber_with, rotor, widest
from validation.cases.rotors.whirl import NATURAL as OTHER
from validation.cases.rotors.whirl import layered_rotor

CLAIMS = Claims("published")

_LIGHT = 100.0  # kg: the full chamber weighs 0.016 of it
_SHARE = 0.25  # of the chamber
# Decay of the wave over the growth without any, and decays of the rotor over it.
WEAK, STRONG = (0.1, (0.1, 0.5, 2.0)), (0.5, (0.5, 1.0, 3.0))
_NEAR = 0.05  # of widths, to first order in the roots of masses
_MEASURED = (0.55, 0.92)  # whirl over spin
_SHARES = (0.01, 0.03, 0.1, 0.25, 0.5, 0.75, 0.99)
_RATIOS = (0.02, 0.04)  # damping of the supports
_CYCLES = (1.15, 1.45, 1.9)  # speeds over the natural frequency


def decay_of_wave(rate: float, spin: float) -> float:
    """Decay of the backward wave with a rate of linear friction, 1/s."""
    layer = plane_layer(chamber_with(0, _SHARE), Friction(FrictionLaw.LINEAR, rate))
    assert layer is not None
    return float(damped_waves(layer.layer_tanh, spin, layer.rate)[1].imag)


def width_of_two(rotor_decay: float, wave_decay: float, growth: float, ratio: float) -> float:
    """Width of the band of two such modes, rad/s of spin, c the frequency of the wave over the spin."""
    left = growth**2 / (rotor_decay * wave_decay) - 1.0
    return 2.0 * (rotor_decay + wave_decay) * math.sqrt(max(left, 0.0)) / (1.0 - ratio)


@cache
def alone() -> tuple[float, float]:
    """Largest growth without decay, 1/s, and the spin there, rad/s."""
    machine, fill = rotor(0.0, _LIGHT), chamber_with(0, _SHARE)
    (found,) = unstable_bands(machine, [[fill]], np.array([0.5, 3.0]) * NATURAL)
    speeds = np.linspace(*widest(found), 401)
    growth, _ = asynchronous_growth(machine, [fill], speeds)
    return float(growth.max()), float(speeds[growth.argmax()])


def widths(wave: float, decays: tuple[float, ...]) -> tuple[Array, Array]:
    """Width of the band over the natural frequency for decays over the growth, computed and of two modes."""
    growth, spin = alone()
    rate = float(brentq(lambda k: decay_of_wave(k, spin) - wave * growth, 1e-3 * growth, 1e2 * growth))
    fill, law = chamber_with(0, _SHARE), Friction(FrictionLaw.LINEAR, rate)
    layer = plane_layer(fill, NO_FRICTION)
    assert layer is not None
    found, known = [], []
    for decay in decays:
        machine = rotor(decay * growth / NATURAL, _LIGHT)
        (bands,) = unstable_bands(machine, [[fill]], np.array([0.5, 3.0]) * NATURAL, law)
        found.append(sum(high - low for low, high in bands) / NATURAL)
        ratio = slower_slip(layer.layer_tanh)
        known.append(width_of_two(decay * growth, wave * growth, growth, ratio) / NATURAL)
    return np.array(found), np.array(known)


def ratios(mass: float) -> Array:
    """Whirl speed over spin from a thin film to a full chamber, shape (shares, 2).

    Where the growth is largest, and the least in the band.
    """
    found = []
    for share in _SHARES:
        machine, fill = rotor(0.0, mass), chamber_with(0, share)
        (bands,) = unstable_bands(machine, [[fill]], np.array([0.5, 3.0]) * NATURAL)
        speeds = np.linspace(*widest(bands), 23)[1:-1]
        growth, whirl_speed = asynchronous_growth(machine, [fill], speeds)
        each = whirl_speed / speeds
        found.append((each[growth.argmax()], each.min()))
    return np.array(found)


@cache
def cycles(damping_ratio: float) -> tuple[tuple[float, float], Branch]:
    """Band of small whirls over the natural frequency, and the branch of large ones from its lower edge."""
    machine, fill = layered_rotor(0.1, 0.1, damping_ratio)
    law = Friction(FrictionLaw.LINEAR, 0.01 * OTHER)
    (bands,) = unstable_bands(machine, [[fill]], np.array([0.5, 4.0]) * OTHER, law)
    branch = limit_cycles(machine, [fill], (1.1 * OTHER, 2.0 * OTHER), law, FEWEST).branches[0]
    low, high = widest(bands)
    return (low / OTHER, high / OTHER), branch


def cases() -> Iterator[Case]:
    """Ratios of small whirls and of large ones, the response and the band under damping."""
    light, heavy = ratios(_LIGHT)[:, 0], ratios(0.1 * _LIGHT)[:, 1]
    effect = Effect("least whirl speed over spin", _MEASURED[0], float(light.min()))
    told = {"least": light.min(), "most": light.max(), "heavy": heavy.min(), "effect": effect}
    within = 2.0 - math.sqrt(2.0) < light.min() and light.max() < 1.0
    yield CLAIMS.case("whirl-ratio", agrees=within, **told)
    (band, weak), (wider, damped) = (cycles(ratio) for ratio in _RATIOS)
    held = [weak.at(speed * OTHER)[0] for speed in _CYCLES]
    falls = np.array([whirl.whirl_speed for whirl in held]) / (np.array(_CYCLES) * OTHER)
    words = _words(falls), _words(_CYCLES)
    yield CLAIMS.case("limit-cycle-ratio", words[0], bool(np.all(np.diff(falls) < 0.0)), speeds=words[1])
    sizes = [branch.at(_CYCLES[1] * OTHER)[0].amplitude for branch in (weak, damped)]
    told = {
        "less": sizes[1] / sizes[0],
        "before": "{:.2f} to {:.2f}".format(*band),
        "after": "{:.2f} to {:.2f}".format(*wider),
    }
    wide = wider[1] - wider[0] > band[1] - band[0]
    yield CLAIMS.case("outer-damping", agrees=wide and sizes[1] < sizes[0], **told)
    for name, (wave, decays), widens in (("weak", WEAK, True), ("strong", STRONG, False)):
        found, known = widths(wave, decays)
        same = bool(np.all(np.diff(found) > 0.0)) if widens else bool(np.all(np.diff(found) < 0.0))
        told = {"wave": wave, "decays": _words(decays), "known": _words(known)}
        yield CLAIMS.case(f"{name}-friction", _words(found), same, **told)


def _words(values: Array | tuple[float, ...]) -> str:
    return ", ".join(f"{value:.3g}" for value in values)
