"""Linear layer with friction on a whirling drum: offset, force, natural sloshing waves, neutral whirl.

Plane flow with a drag against the velocity relative to the drum. Everything is a function of T = tanh(L) =
(R^2 - a^2)/(R^2 + a^2), from 0 (no liquid) to 1 (full), of which no formula here loses digits. The whirl
speed omega in the standing frame and the slip s = omega - Omega may be complex: e^{i omega t} grows where the
imaginary part is negative. The rate k is complex with the inertia of wall layers.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fluid.fill import FULL, Fill
from fluid.friction.laws import LINEAR, Friction, FrictionLaw, damping_rate
from meshes.arrays import Array, Complex


@dataclass(frozen=True)
class Layer:
    """What the whirl of a drum knows of the liquid in a chamber."""

    mass: float  #: of the liquid m_l, kg
    layer_tanh: float  #: T = tanh(L), from 0 to 1
    rate: float  #: k of the linear friction, 1/s
    #: of the laminar friction on the wall, k(s) = stokes sqrt(i s), s^(-1/2) [theory: whirl, eq. 12]
    stokes: float
    lids: float = 0.0  #: 2 sqrt(nu)/h_c of floor and lid, s^(-1/2), see `plate_rate`


def plane_layer(fill: Fill, friction: Friction) -> Layer | None:
    """Layer of a fill under a law of friction; None without liquid or without a free surface.

    Quadratic friction is none to an infinitesimal whirl; of the law of the wall the laminar part of the waves
    acts.
    """
    radius = fill.chamber.radius
    if fill.volume == 0.0 or is_full(fill):
        return None
    # R^2 - a^2 and, twice the area per radian, over R^2.
    film = fill.volume / (math.pi * fill.chamber.height) / radius**2
    tanh, rate, stokes, lids = film / (2.0 - film), 0.0, 0.0, 0.0
    if friction.law is FrictionLaw.LINEAR:
        depth = fill.depth / radius
        rate = float(damping_rate(LINEAR, friction.coefficient, 0.0, depth, 0.5 * film, 0.0))
    elif friction.law.laminar:
        shear = math.sqrt(fill.liquid.viscosity)
        stokes, lids = shear / radius * wall_share(tanh), 2.0 * shear / fill.chamber.height
    return Layer(fill.mass, tanh, rate, stokes, lids)


def wall_share(layer_tanh: float, crests: int = 1) -> float:
    """Drag of a wall on a wave over that on the shear of its own velocity, times R [theory: whirl, eq. 12].

    n (1 - T_n^2)/T_n: a wall layer moves the wall in by its thickness d, and T_n with it.
    """
    return crests * (1.0 - layer_tanh) * (1.0 + layer_tanh) / layer_tanh


def plate_rate(layer_tanh: ArrayLike, spin: ArrayLike, slip: ArrayLike) -> Complex:
    """Drag of floor and lid on a wave over 2 sqrt(nu)/h_c, complex, s^(-1/2) [theory: whirl, eq. 12].

    Of two circles, made unlike by the Coriolis force: (1 - T)/2 of the energy goes round as e^{i s t}.
    """
    return _plates(layer_tanh, spin, slip)[0]


def plate_terms(layer_tanh: ArrayLike, spin: ArrayLike, slip: ArrayLike) -> tuple[Complex, Complex]:
    """`plate_rate` and its derivative with respect to the slip."""
    rate, *circles = _plates(layer_tanh, spin, slip)
    # At the end of a cut the root is 0 and its slope without end, for which that next to it serves.
    steep = (share / np.where(x == 0.0, 1e-150, x) for share, x in circles)
    return rate, np.asarray(0.5j * sum(steep))


def _plates(
    layer_tanh: ArrayLike, spin: ArrayLike, slip: ArrayLike
) -> tuple[Complex, tuple[Array, Complex], tuple[Array, Complex]]:
    """`plate_rate`, and of each circle its share and its root."""
    s, t, twice = np.asarray(slip, dtype=complex), np.asarray(layer_tanh), 2.0 * np.asarray(spin)
    along, against = np.sqrt(1j * (s + twice)), np.sqrt(1j * (s - twice))
    first, second = 0.5 * (1.0 - t), 0.5 * (1.0 + t)
    return np.asarray(first * along + second * against), (first, along), (second, against)


def layer_rate(layer: Layer, spin: ArrayLike, slip: ArrayLike) -> Complex:
    """All friction of a layer, k of `wave_function`, 1/s, complex with the inertia of wall layers."""
    plates = layer.lids * plate_rate(layer.layer_tanh, spin, slip)
    return np.asarray(layer.rate + stokes_rate(layer.stokes, slip) + plates)


def steady_rate(layer: Layer, spin: ArrayLike) -> Complex:
    """Friction that does not depend on the frequency, from which the search for modes starts, 1/s.

    Linear friction, and floor and lid as they drag on the slower natural wave, next to which whirls grow.
    """
    plates = layer.lids * complex(plate_rate(layer.layer_tanh, 1.0, -slower_slip(layer.layer_tanh)))
    return np.asarray(layer.rate + plates * np.sqrt(np.asarray(spin)))


def body_force_rate(fill: Fill, friction: Friction, spin: float) -> float:
    """Rate k of a force -k u on all the liquid that damps its slower natural wave as its walls do, 1/s.

    It makes no vorticity, unlike walls: it has their drag on waves, not their layers
    [theory: potential, eq. 30]. 0 without liquid or without a free surface.
    """
    layer = plane_layer(fill, friction)
    if layer is None:
        return 0.0
    return float(layer_rate(layer, spin, -slower_slip(layer.layer_tanh) * spin).real)


def slower_slip(layer_tanh: float) -> float:
    """Size of the slower natural wave's frequency seen from the drum over the spin, sqrt(T^2 + T) - T."""
    # Without the difference of what is nearly alike.
    return layer_tanh / (math.sqrt(layer_tanh * (layer_tanh + 1.0)) + layer_tanh)


def is_full(fill: Fill) -> bool:
    """No free surface: the liquid turns with the drum like a solid."""
    return fill.volume >= fill.chamber.capacity * FULL


def stokes_rate(stokes: ArrayLike, slip: ArrayLike) -> Complex:
    """Drag of a laminar oscillating layer, stokes sqrt(i s), 1/s [theory: whirl, eq. 12].

    The root with a positive real part, the decay rate for a real s [theory: long_wave, eq. 10]; the imaginary
    part, as large, is the inertia.
    """
    return np.asarray(np.asarray(stokes) * np.sqrt(1j * np.asarray(slip, dtype=complex)))


def wave_function(layer_tanh: ArrayLike, spin: ArrayLike, slip: ArrayLike, rate: ArrayLike) -> Complex:
    """E = s^2 - 2 T Omega s - T Omega^2 - i k s, zero at the natural waves [theory: whirl, eq. 3]."""
    s, t, omega = np.asarray(slip, dtype=complex), np.asarray(layer_tanh), np.asarray(spin)
    return np.asarray(s * (s - 2.0 * t * omega - 1j * np.asarray(rate)) - t * np.square(omega))


def offset_with_friction(
    layer_tanh: ArrayLike, spin: ArrayLike, whirl_speed: ArrayLike, rate: ArrayLike
) -> Complex:
    """Offset of the centre of mass over the deflection, d/w = -(1 - T)/2 omega^2/E [theory: whirl, eq. 4]."""
    omega = np.asarray(whirl_speed, dtype=complex)
    share = 0.5 * (1.0 - np.asarray(layer_tanh))
    resonance = wave_function(layer_tanh, spin, omega - np.asarray(spin), rate)
    return np.asarray(-share * np.square(omega) / resonance)


def drag_power(layer: Layer, spin: ArrayLike, whirl_speed: float | Array, force: ArrayLike) -> Array:
    """Heat by friction in a layer under a force on its mass that goes round, W [theory: loads, eq. 18].

    The force per mass, m/s^2, is omega^2 w of a whirling axis, or gravity, for which omega is 0.
    """
    slip = np.asarray(whirl_speed - np.asarray(spin))
    wave = wave_function(layer.layer_tanh, spin, slip, layer_rate(layer, spin, slip))
    share = 0.5 * layer.mass * (1.0 - layer.layer_tanh)
    return np.asarray(-share * np.square(force) * slip * wave.imag / np.square(np.abs(wave)))


def damped_waves(layer_tanh: ArrayLike, spin: ArrayLike, rate: ArrayLike) -> tuple[Complex, Complex]:
    """Slips of the natural waves with one crest under linear friction, prograde first [theory: whirl, eq. 9].

    b +- sqrt(b^2 + T Omega^2), b = T Omega + i k/2, rad/s; the waves decay with the imaginary part.
    """
    t, omega = np.asarray(layer_tanh), np.asarray(spin)
    centre = t * omega + 0.5j * np.asarray(rate)
    root = np.sqrt(np.square(centre) + t * np.square(omega))
    return np.asarray(centre + root), np.asarray(centre - root)


def covering_speed(fill: Fill, gravity: float) -> float:
    """Spin speed above which a layer about a vertical axis covers the wall and clears the inner one.

    Omega^2 min(R^2 - a^2, a^2 - R_i^2) = g h_c [theory: whirl, eq. 18]; 0 without gravity or free surface.
    """
    if gravity == 0.0 or fill.volume == 0.0 or is_full(fill):
        return 0.0
    chamber = fill.chamber
    outer = fill.volume / (math.pi * chamber.height)
    inner = (chamber.capacity - fill.volume) / (math.pi * chamber.height)
    return math.sqrt(gravity * chamber.height / min(outer, inner))
