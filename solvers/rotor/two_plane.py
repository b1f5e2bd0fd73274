"""A rigid rotor in supports along its axis, with the gyroscopic terms of its spin."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from meshes.arrays import Array
from meshes.errors import InputError, require_not_negative, require_positive
from solvers.rotor.system import RotorSystem


@dataclass(frozen=True)
class Support:
    """A support of the rotor's axis, the same in all directions or unlike in two."""

    position: float  #: along the axis from the rotor's centre of mass, m
    #: k, N/m: of all directions across the axis, or of the first and of the second
    stiffness: float | tuple[float, float]
    damping: float | tuple[float, float]  #: c, N s/m, likewise

    def __post_init__(self) -> None:
        _require_finite("position", self.position)
        for name in ("stiffness", "damping"):
            for value in _in_two(getattr(self, name)):
                require_not_negative(name, value)

    @property
    def across(self) -> tuple[Array, Array]:
        """Stiffness and damping along the two directions across the axis, shape (2, 2) each."""
        return np.diag(_in_two(self.stiffness)), np.diag(_in_two(self.damping))

    @property
    def isotropic(self) -> bool:
        """It resists in all directions alike."""
        return all(len(set(_in_two(value))) == 1 for value in (self.stiffness, self.damping))


def _in_two(value: float | tuple[float, float]) -> tuple[float, float]:
    """Value across both directions x and y: one stands for both."""
    return value if isinstance(value, tuple) else (value, value)


@dataclass(frozen=True)
class PlaneUnbalance:
    """An unbalance in one plane across the axis."""

    position: float  #: of the plane, along the axis from the rotor's centre of mass, m
    size: float  #: mass times its distance from the axis, kg m
    angle: float = 0.0  #: fixed in the rotor, positive with the spin, rad

    def __post_init__(self) -> None:
        _require_finite("position", self.position)
        _require_finite("angle", self.angle)
        require_not_negative("size", self.size)


@dataclass(frozen=True)
class TwoPlane:
    """Rigid rotor with four degrees of freedom [theory: rotor, eq. 16-19].

    The centre of mass sits at position 0; the spin about z turns x into y.
    """

    mass: float  #: M, kg, without the liquid
    transverse_inertia: float  #: A, about an axis through the centre of mass across the rotor's, kg m^2
    polar_inertia: float  #: C, about the rotor's axis, kg m^2; at most 2 A, as for every body
    supports: tuple[Support, ...]  #: any number
    unbalances: tuple[PlaneUnbalance, ...] = ()  #: any number

    def __post_init__(self) -> None:
        require_positive("mass", self.mass)
        require_positive("transverse_inertia", self.transverse_inertia)
        require_not_negative("polar_inertia", self.polar_inertia)
        # A disc without thickness has C = 2 A; values given with nine digits may exceed it by rounding.
        most = 2.0 * self.transverse_inertia * (1.0 + 1e-9)
        if self.polar_inertia > most:
            raise InputError(
                "polar_inertia", self.polar_inertia, f"at most twice the transverse one, {most:g}"
            )

    def system(self) -> RotorSystem:
        """Equations of motion for x, y of the centre of mass and the turns alpha, beta about x and y."""
        return self._system

    @cached_property
    def _system(self) -> RotorSystem:
        """The same, which many steps of one answer ask for."""
        stiffness, damping, gyroscopic = np.zeros((3, 4, 4))
        for support in self.supports:
            axis, (spring, damper) = _axis(support.position), support.across
            stiffness += axis.T @ spring @ axis
            damping += axis.T @ damper @ axis
        gyroscopic[2, 3], gyroscopic[3, 2] = self.polar_inertia, -self.polar_inertia
        unbalance = np.zeros(4, dtype=complex)
        for unbalanced in self.unbalances:
            turning = unbalanced.size * cmath.exp(1j * unbalanced.angle) * np.array([1.0, -1j])
            unbalance += _axis(unbalanced.position).T @ turning
        inertia = self.transverse_inertia
        return RotorSystem(
            coordinates=("x", "y", "alpha", "beta"),
            mass=np.diag([self.mass, self.mass, inertia, inertia]),
            damping=damping,
            gyroscopic=gyroscopic,
            stiffness=stiffness,
            unbalance=unbalance,
            centre=_axis(0.0),
            lean=_axis(1.0) - _axis(0.0),
        )


def _axis(position: float) -> Array:
    """Displacement of the axis at a position for unit coordinates: x + z beta, y - z alpha, shape (2, 4)."""
    return np.array([[1.0, 0.0, 0.0, position], [0.0, 1.0, -position, 0.0]])


def _require_finite(field: str, value: float) -> None:
    if not math.isfinite(value):
        raise InputError(field, value, "a finite number")
