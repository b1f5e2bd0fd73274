"""The liquid layer as elements of ROSS, by the exact linear theory.

Two forms. As a mass that a link holds in the drum the layer keeps its own degrees of freedom: every analysis
of ROSS sees its waves, modal ones too. As coefficients on the drum's node alone it is exact at one whirl
frequency for each entry of a table. Neither form knows dry walls: whirls must stay below the layer's depth.

ROSS's x, y and its sense of rotation are this package's first and second direction and spin.
"""

from __future__ import annotations

import inspect
import warnings
from dataclasses import dataclass
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import make_interp_spline

from fluid.fill import Fill
from fluid.friction.laws import NO_FRICTION, Friction
from fluid.whirl import layer_rate, offset_with_friction, plane_layer, wave_function
from meshes.arrays import Array, Complex
from meshes.errors import InputError

if TYPE_CHECKING:
    from ross import BearingElement, PointMass

# Axial frequency of the liquid between the chamber's ends, over the highest spin: out of every analysis' way.
_AXIAL = 10.0
_ROTATION = np.array([[0.0, 1.0], [-1.0, 0.0]])  # as a matrix, what -i is to x + i y


@dataclass(frozen=True)
class Coefficients:
    """Matrices on the two in-plane directions, at n points."""

    mass: Array  #: M, kg, shape (n, 2, 2)
    damping: Array  #: C, N s/m, shape (n, 2, 2)
    stiffness: Array  #: K, N/m, shape (n, 2, 2)


@dataclass(frozen=True)
class LiquidElements:
    """What one layer adds to a ROSS rotor."""

    #: the link, and an empty support of the liquid's node without which ROSS does not place its mass
    bearings: tuple[BearingElement, BearingElement]
    mass: PointMass  #: the liquid


def dynamic_stiffness(
    fill: Fill, spin: ArrayLike, whirl_speed: ArrayLike, friction: Friction = NO_FRICTION
) -> Complex:
    """What the liquid adds to the dynamic stiffness of its drum in circular whirl.

    H = -m_l omega^2 (1 + d/w) [theory: ross, eq. 2].

    Parameters
    ----------
    fill : chamber and liquid
    spin : Omega, rad/s, shape (...,)
    whirl_speed : omega in the standing frame, rad/s, negative against the spin, shape (...,)
    friction : a quadratic one is none to a small whirl

    Returns
    -------
    Minus the force on the drum over its deflection, N/m, shape (...,)

    Raises
    ------
    InputError : a speed that is not finite, a whirl at a natural sloshing wave without friction
    """
    omega, w = np.broadcast_arrays(_finite("spin", spin), _finite("whirl_speed", whirl_speed))
    layer = plane_layer(fill, friction)
    if layer is None:
        return np.asarray(-fill.mass * np.square(w), dtype=complex)
    slip = w - omega
    rate = layer_rate(layer, omega, slip)
    if np.any(wave_function(layer.layer_tanh, omega, slip, rate) == 0.0):
        raise InputError(
            "whirl_speed", w.tolist(), "off the natural sloshing waves of a layer without friction"
        )
    offset = offset_with_friction(layer.layer_tanh, omega, w, rate)
    return np.asarray(-layer.mass * np.square(w) * (1.0 + offset))


def liquid_coefficients(
    fill: Fill, spin: ArrayLike, whirl_speed: ArrayLike | None = None, friction: Friction = NO_FRICTION
) -> Coefficients:
    """Mass, damping and stiffness that act on the drum as the layer does [theory: ross, eq. 6-8].

    The mass is that of synchronous whirl; damping and stiffness, direct and cross-coupled, make up the
    difference to the answer at one whirl frequency, to forward and to backward whirl.

    Parameters
    ----------
    fill : chamber and liquid
    spin : Omega, rad/s, shape (n,) or a number
    whirl_speed : omega, rad/s, above 0, shape (n,) or a number; None for the spin
    friction : see `dynamic_stiffness`

    Raises
    ------
    InputError : a whirl speed that is not positive; see `dynamic_stiffness`
    """
    omega, w = np.broadcast_arrays(
        np.atleast_1d(_finite("spin", spin)),
        np.atleast_1d(_finite("whirl_speed", spin if whirl_speed is None else whirl_speed)),
    )
    if not np.all(w > 0.0):
        raise InputError("whirl_speed", w.tolist(), "above 0")
    forward = dynamic_stiffness(fill, omega, w, friction)
    backward = dynamic_stiffness(fill, omega, -w, friction)
    # That of a full cylinder, however thin the layer is.
    mass = fill.mass if plane_layer(fill, friction) is None else fill.full_mass
    mean, half = 0.5 * (forward + backward), 0.5 * (forward - backward)
    return Coefficients(
        mass=_isotropic(np.full(w.shape, mass), np.zeros(w.shape)),
        damping=_isotropic(half.imag / w, half.real / w),
        stiffness=_isotropic(mean.real + mass * np.square(w), -mean.imag),
    )


def liquid_link(fill: Fill, spin: ArrayLike, friction: Friction = NO_FRICTION) -> Coefficients:
    """Link between the drum and a mass that moves as the liquid's centre of mass [theory: ross, eq. 4-5].

    Parameters
    ----------
    fill : chamber and liquid, with a free surface; the mass is that of its liquid
    spin : Omega, rad/s, shape (n,) or a number
    friction : see `dynamic_stiffness`; not the laminar one, which depends on the frequency

    Returns
    -------
    Coefficients of the link, at each spin

    Raises
    ------
    InputError : a chamber without a free surface, a spin that is not finite, another friction
    """
    omega = np.atleast_1d(_finite("spin", spin))
    layer = plane_layer(fill, friction)
    if layer is None:
        raise InputError("volume", fill.volume, "above 0 and less than full: a full chamber is a point mass")
    if layer.stokes != 0.0:
        raise InputError("friction", "stokes", "none or linear; the laminar one depends on the frequency")
    none, ones = np.zeros(omega.shape), np.ones(omega.shape)
    inertia = layer.mass * (1.0 + layer.layer_tanh) / (1.0 - layer.layer_tanh)
    damping = 2.0 * layer.mass * layer.rate / (1.0 - layer.layer_tanh)
    return Coefficients(
        mass=_isotropic(inertia * ones, none),
        damping=_isotropic(damping * ones, 4.0 * inertia * omega),
        stiffness=_isotropic(-2.0 * inertia * np.square(omega), damping * omega),
    )


def liquid_layer(
    fill: Fill,
    node: int,
    liquid_node: int,
    speed: ArrayLike,
    friction: Friction = NO_FRICTION,
    tag: str = "liquid",
) -> LiquidElements:
    """Layer with its own degrees of freedom, for every analysis of ROSS at any spin.

    Parameters
    ----------
    fill : chamber and liquid, with a free surface
    node : of the shaft, where the drum sits
    liquid_node : a free number beyond the shaft's nodes; without gaps, if there are several
    speed : spins of the analyses, rad/s, shape (n,), n >= 4, rising; within their range the element is exact
    friction : see `liquid_link`
    tag : begins the names of the elements

    Returns
    -------
    LiquidElements, for `bearing_elements` and `point_mass_elements` of `ross.Rotor`

    Raises
    ------
    InputError : see `liquid_link`; too few speeds or not rising; ImportError without ROSS
    """
    spin = _table("speed", speed)
    link = _named(liquid_link(fill, spin, friction))
    link["kzz"] = np.full(spin.shape, fill.mass * np.square(_AXIAL * np.abs(spin).max()))
    ross = _ross()
    held = _bearing(ross, node, spin, link, f"{tag} link", liquid_node)
    support = ross.BearingElement(n=liquid_node, kxx=0.0, cxx=0.0, tag=f"{tag} support")
    return LiquidElements((held, support), ross.PointMass(n=liquid_node, m=fill.mass, tag=f"{tag} mass"))


def liquid_bearing(
    fill: Fill,
    node: int,
    spin: ArrayLike,
    whirl_speed: ArrayLike | None = None,
    friction: Friction = NO_FRICTION,
    tag: str = "liquid",
) -> BearingElement:
    """Layer as coefficients on the drum's node, each entry exact at one whirl frequency.

    Over an array of spins, which is where ROSS's own runs look coefficients up; with one spin and an array of
    whirl speeds over those, for its matrices M(frequency), C(frequency), K(frequency), A(speed, frequency).

    Parameters
    ----------
    fill : chamber and liquid
    node : of the shaft, where the drum sits
    spin : Omega, rad/s, shape (n,), n >= 4, rising, or a number
    whirl_speed : omega, rad/s, above 0, shape (n,) or a number; None for synchronous whirl, as in a response
        to unbalance
    friction : see `dynamic_stiffness`
    tag : name of the element

    Raises
    ------
    InputError : see `liquid_coefficients`; an axis too short or not rising; ImportError without ROSS
    """
    if whirl_speed is None or np.ndim(spin) > 0:
        over, table = "speed", _table("spin", spin)
    else:
        over, table = "frequency", _table("whirl_speed", whirl_speed)
    found = liquid_coefficients(fill, spin, whirl_speed, friction)
    return _bearing(_ross(), node, table, _named(found), tag, over=over)


def _ross() -> ModuleType:
    """ROSS, loaded when it is first needed."""
    try:
        with warnings.catch_warnings():
            # Its dependencies tell on import what else could be installed.
            warnings.simplefilter("ignore")
            import ross
    except (ImportError, ValueError) as missing:
        # The latter comes from a plotly too new for it.
        raise ImportError("ROSS is missing or cannot be loaded: pip install 'leblanc[ross]'") from missing
    module: ModuleType = ross
    return module


def _bearing(
    ross: ModuleType,
    node: int,
    axis: Array,
    table: dict[str, Array],
    tag: str,
    link: int | None = None,
    over: str = "speed",
) -> BearingElement:
    """Bearing of ROSS with coefficients over the spin or the whirl's frequency, through every entry.

    ROSS 2 has one axis, which it calls `frequency` and which is the spin in its runs; ROSS 3 has both.
    """
    both = "speed" in inspect.signature(ross.BearingElement).parameters
    given = {over if both else "frequency": axis}
    element = ross.BearingElement(n=node, n_link=link, tag=tag, **given, **table)
    for name, values in table.items():
        spline, own = make_interp_spline(axis, values, k=3), f"{name}_interpolated"
        if both:
            # ROSS 3 passes through the entries, but with slopes of second order between them: a link's
            # coefficients, polynomials of the spin, would not be exact there.
            getattr(element, own)._interpolated = spline
        else:
            # The splines of ROSS 2 smooth over a residual of the order of one unit: small ones would vanish.
            setattr(element, own, spline)
    return element


def _finite(field: str, value: ArrayLike) -> Array:
    found = np.asarray(value, dtype=float)
    if not np.isfinite(found).all():
        raise InputError(field, value, "finite")
    return found


def _table(field: str, axis: ArrayLike) -> Array:
    """The axis of a table, long enough for a cubic spline."""
    found = _finite(field, axis)
    if found.ndim != 1 or found.size < 4 or not np.all(np.diff(found) > 0.0):
        raise InputError(field, found.tolist(), "at least four rising numbers")
    return found


def _isotropic(direct: Array, crossed: Array) -> Array:
    """Matrices that do to (x, y) what direct - i crossed does to x + i y, shape (n, 2, 2)."""
    return np.asarray(direct[:, None, None] * np.eye(2) + crossed[:, None, None] * _ROTATION)


def _named(found: Coefficients) -> dict[str, Array]:
    """Coefficients by their names in ROSS."""
    matrices = {"m": found.mass, "c": found.damping, "k": found.stiffness}
    places = [(i, j) for i in (0, 1) for j in (0, 1)]
    return {
        f"{letter}{'xy'[i]}{'xy'[j]}": m[:, i, j].copy() for letter, m in matrices.items() for i, j in places
    }
