"""Friction of the liquid on its walls: laws for a thin layer, and the laminar layers under an oscillation.

The laws are in lengths of the wall radius; the wall shear is tau/rho = k h u [theory: long_wave, eq. 9].
Outside the laminar layers the flow is plane, irrotational and free of divergence, with frequency sigma in the
frame of the drum. These layers are thin beside the liquid.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array
from meshes.errors import InputError, require_not_negative


class FrictionLaw(StrEnum):
    """How the wall's shear grows with the liquid's velocity in the drum, by the names that users give."""

    NONE = "none"
    LINEAR = "linear"
    STOKES = "stokes"
    QUADRATIC = "quadratic"
    WALL = "wall"

    @property
    def laminar(self) -> bool:
        """Whether waves feel Stokes' oscillating layers under it."""
        return self in (FrictionLaw.STOKES, FrictionLaw.WALL)

    @property
    def number(self) -> int:
        """Place among the laws: compiled code knows them by it."""
        return list(FrictionLaw).index(self)


# The numbers of the laws, which compiled code compares.
NONE, LINEAR, STOKES, QUADRATIC, WALL = (law.number for law in FrictionLaw)


# Share of the spin below which the frequency of a wave counts as this one.
_SLOWEST = 1e-9


@dataclass(frozen=True)
class Friction:
    """Friction of the liquid on its chamber.

    Raises
    ------
    InputError : no such law, a coefficient or a roughness that is negative or not finite, a roughness that
        the law does not know

    Examples
    --------
    >>> Friction(FrictionLaw.LINEAR, 0.5).at(1e-6, 30.0, 0.25)
    (1, 0.5)
    """

    law: FrictionLaw = FrictionLaw.NONE  #: a `FrictionLaw` or its name
    #: k for the linear law, 1/s; c_f for the quadratic one, a number; 0 for the others. Stokes' (laminar) law
    #: takes the liquid's viscosity and the frequency of the motion, see `at`, and so do the waves under the
    #: law of the wall, see `fluid.friction.wall`
    coefficient: float = 0.0
    roughness: float = 0.0  #: height of the wall's roughness for that one, m; 0 for the others

    def __post_init__(self) -> None:
        if self.law not in list(FrictionLaw):
            raise InputError("friction", self.law, "one of " + ", ".join(FrictionLaw))
        require_not_negative("friction", self.coefficient)
        require_not_negative("friction", self.roughness)
        object.__setattr__(self, "law", FrictionLaw(self.law))
        if self.roughness and self.law is not FrictionLaw.WALL:
            raise InputError("friction", self.roughness, "a roughness with the law of the wall alone")

    def at(self, viscosity: float, frequency: float, radius: float) -> tuple[int, float]:
        """Law and coefficient as `damping_rate` and compiled code take them [theory: long_wave, eq. 10].

        Of the law of the wall the part of the waves.

        Parameters
        ----------
        viscosity : of the liquid, nu, m^2/s
        frequency : of the motion seen from the drum, s, rad/s; only the laminar ones depend on it
        radius : of the wall R, m
        """
        if not self.law.laminar:
            return self.law.number, self.coefficient
        return self.law.number, float(stokes_coefficient(viscosity, frequency)) / radius

    def lid(self, radius: float, height: float, frequency: float, spin: float) -> float:
        """Floor and lid as `damping_rate` takes them, 2 R/h_c, for the law of the wall with `plate_factor`.

        Parameters
        ----------
        radius, height : of the chamber, m
        frequency : of the motion seen from the drum, s, rad/s
        spin : Omega, rad/s
        """
        plain = 2.0 * radius / height
        if self.law is FrictionLaw.WALL:
            return plain * plate_factor(frequency, spin)
        return plain if self.law is FrictionLaw.STOKES else 0.0


NO_FRICTION = Friction()


def damping_rate(law: int, coefficient: float, lid: float, depth: Any, area: Any, velocity: Any) -> Any:
    """Rate of decay of u, tau R/(rho u A) in the units of the coefficient [theory: long_wave, eq. 9].

    Serves arrays and, compiled, scalars. Under the law of the wall it is the rate of small waves.

    Parameters
    ----------
    law : number of the `FrictionLaw`
    coefficient : k of the linear law, 1/s; sqrt(nu |s|/2)/R of Stokes' and of the wall's, 1/s; c_f of
        the quadratic one
    lid : 2 R/h_c, floor and lid for Stokes' law, see `Friction.lid`; 0 without them
    depth : h/R
    area : A/R^2 > 0
    velocity : u, in units that make c_f |u| a rate
    """
    if law == LINEAR:
        return coefficient * depth / area
    if law == QUADRATIC:
        return coefficient * np.abs(velocity) / area
    if law != NONE:
        # Stokes' law, and what is left of the law of the wall for small waves.
        return coefficient * (1.0 + lid * depth) / area
    return 0.0 * area


def stokes_coefficient(viscosity: ArrayLike, frequency: ArrayLike) -> Array:
    """Shear over velocity of an oscillating laminar layer, sqrt(nu |s|/2), m/s [theory: long_wave, eq. 10].

    Parameters
    ----------
    viscosity : nu, m^2/s, shape (...,)
    frequency : whirl frequency s seen from the drum, rad/s, shape (...,)
    """
    squared = 0.5 * np.asarray(viscosity, dtype=float) * np.abs(np.asarray(frequency, dtype=float))
    return np.asarray(np.sqrt(squared))


def layer_thickness(viscosity: ArrayLike, frequency: ArrayLike) -> Array:
    """Thickness of an oscillating layer, sqrt(2 nu/|sigma|), m [theory: sloshing, eq. 19].

    Parameters
    ----------
    viscosity : nu, m^2/s, shape (...,)
    frequency : sigma, rad/s, not 0, shape (...,)
    """
    return np.asarray(np.sqrt(2.0 * np.asarray(viscosity, dtype=float) / np.abs(frequency)))


def plate_drags(viscosity: ArrayLike, frequency: ArrayLike, spin: ArrayLike) -> tuple[Array, Array]:
    """Shear over velocity on floor and lid for the two circles of an oscillation e^{-i sigma t}, m/s.

    sqrt(nu |2 Omega - sigma|/2) for the circle that goes round as e^{-i sigma t} and sqrt(nu |2 Omega +
    sigma|/2) for the other [theory: sloshing, eq. 21].

    Parameters
    ----------
    viscosity : nu, m^2/s, shape (...,)
    frequency : sigma in the frame of the drum, rad/s, shape (...,)
    spin : Omega, rad/s; 0 for the plain layers without Coriolis force, shape (...,)
    """
    sigma, twice = np.asarray(frequency, dtype=float), 2.0 * np.asarray(spin, dtype=float)
    return stokes_coefficient(viscosity, twice - sigma), stokes_coefficient(viscosity, twice + sigma)


def plate_factor(frequency: float, spin: float) -> float:
    """Drag of floor and lid on waves in a thin layer over that of the wall [theory: friction, eq. 9].

    Floor and lid bound a flow that goes to and fro on straight lines: both circles have equal weight. Not
    below a billionth of the spin is the frequency told from 0, where no wave is.

    Parameters
    ----------
    frequency : of the waves seen from the drum, s, rad/s
    spin : Omega, rad/s; 0 for 1
    """
    slow = max(abs(frequency), _SLOWEST * abs(spin), 1e-300)
    twice = 2.0 * abs(spin)
    return 0.5 * (math.sqrt(abs(twice - slow) / slow) + math.sqrt((twice + slow) / slow))


def edge_weight(distance: ArrayLike, thickness: ArrayLike) -> Array:
    """Share of the squared outer velocity that counts near the edge of a thin baffle, d/(d + delta).

    The outer velocity grows as d^(-1/2) towards the edge and its square has no integral. A layer cannot
    follow it nearer than its own thickness [theory: sloshing, eq. 23].

    Parameters
    ----------
    distance : d from the edge, m, shape (...,); inf without an edge
    thickness : delta of the layer, m, above 0, shape (...,)
    """
    return np.asarray(1.0 / (1.0 + np.asarray(thickness, dtype=float) / np.asarray(distance, dtype=float)))


def decay_rate(
    wall: ArrayLike,
    kinetic: ArrayLike,
    sense: ArrayLike,
    potential: ArrayLike,
    height: float,
    drags: tuple[ArrayLike, ArrayLike, ArrayLike],
) -> Array:
    """Rate at which the amplitude of a mode decays: loss of energy over twice the energy.

    [g w + (g_1 (k + c) + g_2 (k - c))/h]/(k + b) [theory: sloshing, eq. 22].

    Parameters
    ----------
    wall : w = oint |d psi/dn|^2 ds on all walls, m^3/s^2, shape (...,)
    kinetic : k = int |grad psi|^2, m^4/s^2, shape (...,)
    sense : c = Im oint psi* psi_theta dtheta on the free surface, m^4/s^2, shape (...,)
    potential : b = (Omega/sigma)^2 oint |psi_theta|^2 dtheta, m^4/s^2, shape (...,)
    height : of the chamber, m; inf leaves floor and lid out
    drags : g on the walls; g_1 and g_2 of `plate_drags`, m/s, shape (...,)

    Returns
    -------
    1/s, shape (...,)
    """
    g, first, second = (np.asarray(drag, dtype=float) for drag in drags)
    k, c = np.asarray(kinetic, dtype=float), np.asarray(sense, dtype=float)
    lost = g * wall + (first * (k + c) + second * (k - c)) / height
    return np.asarray(lost / (k + potential))
