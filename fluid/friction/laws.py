"""Friction of the liquid on its walls: laws for a thin layer, and the laminar layers under an oscillation.

The laws are in lengths of the wall radius, tau/rho = k h u [theory: long_wave, eq. 9]. Outside the laminar
layers, thin beside the liquid, the flow is plane, irrotational and free of divergence, with frequency sigma
in the frame of the drum.
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
    """Friction of the liquid on its chamber: a law and what it takes.

    Examples
    --------
    >>> Friction("linear", 0.5).law.laminar
    False
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

        Of the wall law the part of the waves; the frequency, seen from the drum, matters to laminar laws
        alone.
        """
        if not self.law.laminar:
            return self.law.number, self.coefficient
        return self.law.number, float(stokes_coefficient(viscosity, frequency)) / radius

    def lid(self, radius: float, height: float, frequency: float, spin: float) -> float:
        """What `damping_rate` takes for floor and lid, 2 R/h_c, times `plate_factor` for the wall law."""
        plain = 2.0 * radius / height
        if self.law is FrictionLaw.WALL:
            return plain * plate_factor(frequency, spin)
        return plain if self.law is FrictionLaw.STOKES else 0.0


NO_FRICTION = Friction()


def damping_rate(law: int, coefficient: float, lid: float, depth: Any, area: Any, velocity: Any) -> Any:
    """Rate of decay of u, tau R/(rho u A) in the units of the coefficient [theory: long_wave, eq. 9].

    Coefficient: k of the linear law, 1/s; sqrt(nu |s|/2)/R of Stokes' and the wall law, 1/s (the rate of
    small waves); c_f of the quadratic one, for which c_f |u| is a rate. `lid` as from `Friction.lid`; depth
    over R, area over R^2. Serves arrays and, compiled, scalars.
    """
    if law == LINEAR:
        return coefficient * depth / area
    if law == QUADRATIC:
        return coefficient * abs(velocity) / area
    if law != NONE:
        # Stokes' law, and what is left of the law of the wall for small waves.
        return coefficient * (1.0 + lid * depth) / area
    return 0.0 * area


def stokes_coefficient(viscosity: ArrayLike, frequency: ArrayLike) -> Array:
    """Shear over velocity in an oscillating layer, sqrt(nu |s|/2), m/s [theory: long_wave, eq. 10]."""
    squared = 0.5 * np.asarray(viscosity, dtype=float) * np.abs(np.asarray(frequency, dtype=float))
    return np.asarray(np.sqrt(squared))


def layer_thickness(viscosity: ArrayLike, frequency: ArrayLike) -> Array:
    """Thickness of an oscillating layer, sqrt(2 nu/|sigma|), m [theory: sloshing, eq. 19]."""
    return np.asarray(np.sqrt(2.0 * np.asarray(viscosity, dtype=float) / np.abs(frequency)))


def plate_drags(viscosity: ArrayLike, frequency: ArrayLike, spin: ArrayLike) -> tuple[Array, Array]:
    """Shear over velocity on floor and lid for the two circles of an oscillation e^{-i sigma t}, m/s.

    sqrt(nu |2 Omega -+ sigma|/2), first of the circle that goes round as e^{-i sigma t}
    [theory: sloshing, eq. 21].
    """
    sigma, twice = np.asarray(frequency, dtype=float), 2.0 * np.asarray(spin, dtype=float)
    return stokes_coefficient(viscosity, twice - sigma), stokes_coefficient(viscosity, twice + sigma)


def plate_factor(frequency: float, spin: float) -> float:
    """Drag of floor and lid on waves in a thin layer over that of the wall [theory: friction, eq. 9].

    Half from either circle of a straight-line flow; 1 without spin. The frequency counts as a billionth of
    the spin at least: no wave is slower.
    """
    slow = max(abs(frequency), _SLOWEST * abs(spin), 1e-300)
    twice = 2.0 * abs(spin)
    return 0.5 * (math.sqrt(abs(twice - slow) / slow) + math.sqrt((twice + slow) / slow))


def edge_weight(distance: ArrayLike, thickness: ArrayLike) -> Array:
    """Share of the squared outer velocity that counts near the edge of a thin baffle, d/(d + delta).

    It grows as d^(-1/2) there; a layer cannot follow it nearer than its thickness [theory: sloshing, eq. 23].
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
    """Decay rate of a mode's amplitude, 1/s: loss of energy over twice the energy.

    [g w + (g_1 (k + c) + g_2 (k - c))/h]/(k + b) [theory: sloshing, eq. 22], with w = oint |d psi/dn|^2 ds on
    all walls, k = int |grad psi|^2, on the free surface c = Im oint psi* psi_theta dtheta and b =
    (Omega/sigma)^2 oint |psi_theta|^2 dtheta; drags g on the walls, g_1 and g_2 of `plate_drags`, m/s; h is
    inf without floor and lid.
    """
    g, first, second = (np.asarray(drag, dtype=float) for drag in drags)
    k, c = np.asarray(kinetic, dtype=float), np.asarray(sense, dtype=float)
    lost = g * wall + (first * (k + c) + second * (k - c)) / height
    return np.asarray(lost / (k + potential))
