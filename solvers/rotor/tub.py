"""A rigid tub on springs and dampers with a drum that spins in it: six degrees of freedom."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array
from meshes.errors import InputError, require_not_negative, require_positive
from solvers.rotor.system import RotorSystem
from solvers.rotor.two_plane import PlaneUnbalance

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Mount:
    """A spring or a damper between the tub and the ground [theory: rotor, eq. 21].

    It resists the velocity or displacement u of its point with -c d (d . u) along a direction d, and with
    -c_i u_i along the axes: the sum of both.
    """

    position: Vector  #: where it holds the tub, from the tub's centre of mass, m
    coefficient: float = 0.0  #: c, N/m or N s/m, along `direction`
    direction: Vector = (0.0, 0.0, 1.0)  #: d, of any length but 0
    along_axes: Vector = (0.0, 0.0, 0.0)  #: (c_x, c_y, c_z), N/m or N s/m

    def __post_init__(self) -> None:
        for field in ("position", "direction"):
            if not all(map(math.isfinite, getattr(self, field))):
                raise InputError(field, getattr(self, field), "three finite numbers")
        if not math.hypot(*self.direction) > 0.0:
            raise InputError("direction", self.direction, "not all three 0")
        require_not_negative("coefficient", self.coefficient)
        for coefficient in self.along_axes:
            require_not_negative("along_axes", coefficient)

    def matrix(self) -> Array:
        """J^T c J, its share in the stiffness or damping matrix, shape (6, 6)."""
        unit = np.array(self.direction) / math.hypot(*self.direction)
        tensor = self.coefficient * np.outer(unit, unit) + np.diag(self.along_axes)
        moving = displacement(self.position)
        return np.asarray(moving.T @ tensor @ moving)


@dataclass(frozen=True)
class Tub:
    """Suspended tub with a spinning drum [theory: rotor, eq. 20-23; DR18, eq. 1-8].

    The origin is the tub's centre of mass, the axes are its principal ones; the drum spins about +y, which
    turns z into x.
    """

    tub_mass: float  #: m_1 and m_2, kg
    drum_mass: float
    tub_inertia: Vector  #: (J_x, J_y, J_z) of the tub about its centre of mass, kg m^2
    drum_polar_inertia: float  #: J_b of the drum about its axis, kg m^2
    drum_transverse_inertia: float  #: J_a of the drum across its axis, about its own centre, kg m^2
    springs: tuple[Mount, ...]  #: any number
    dampers: tuple[Mount, ...]
    unbalance: float  #: of the laundry, mass times its distance from the drum's axis, kg m
    #: centre of the drum (x_D, y_D, z_D), m; its axis runs through it along y
    drum_position: Vector = (0.0, 0.0, 0.0)
    unbalance_position: float | None = None  #: y of the unbalance, m; that of the drum's centre if None
    loads: tuple[PlaneUnbalance, ...] = ()  #: further unbalances, their positions along y

    def __post_init__(self) -> None:
        require_positive("tub_mass", self.tub_mass)
        for inertia in self.tub_inertia:
            require_positive("tub_inertia", inertia)
        for field in ("drum_mass", "drum_polar_inertia", "drum_transverse_inertia", "unbalance"):
            require_not_negative(field, getattr(self, field))
        if not all(map(math.isfinite, (*self.drum_position, self.unbalance_position or 0.0))):
            raise InputError("drum_position", self.drum_position, "finite numbers")

    @property
    def mass(self) -> float:
        """All that moves without the liquid, kg."""
        return self.tub_mass + self.drum_mass

    def system(self) -> RotorSystem:
        """Equations of motion for the displacement x, y, z of the tub and its turns alpha, beta, gamma."""
        return self._system

    @cached_property
    def _system(self) -> RotorSystem:
        """The same, which many steps of one answer ask for."""
        across, along = self.drum_transverse_inertia, self.drum_polar_inertia
        drum = displacement(self.drum_position)
        inertia = np.diag([self.tub_mass] * 3 + list(self.tub_inertia))
        inertia += self.drum_mass * drum.T @ drum + np.diag([0.0, 0.0, 0.0, across, along, across])
        gyroscopic = np.zeros((6, 6))
        gyroscopic[3, 5], gyroscopic[5, 3] = -along, along
        x, y, z = self.drum_position
        centre, unit = (displacement((x, position, z))[[2, 0]] for position in (0.0, 1.0))
        lean = unit - centre
        heavy = y if self.unbalance_position is None else self.unbalance_position
        none, turning = np.zeros((6, 6)), np.array([1.0, -1j])
        unbalance = self.unbalance * (centre + heavy * lean).T @ turning
        for load in self.loads:
            size = load.size * cmath.exp(1j * load.angle)
            unbalance = unbalance + size * (centre + load.position * lean).T @ turning
        return RotorSystem(
            coordinates=("x", "y", "z", "alpha", "beta", "gamma"),
            mass=inertia,
            damping=sum((damper.matrix() for damper in self.dampers), none),
            gyroscopic=gyroscopic,
            stiffness=sum((spring.matrix() for spring in self.springs), none),
            unbalance=unbalance,
            centre=centre,
            lean=lean,
        )


def displacement(position: ArrayLike) -> Array:
    """Displacement of points of the tub for unit coordinates [theory: rotor, eq. 20].

    J, shape (..., 3, 6): rows along x, y, z; columns x, y, z, alpha, beta, gamma.
    """
    x, y, z = np.moveaxis(np.asarray(position, dtype=float), -1, 0)
    found = np.zeros((*x.shape, 3, 6))
    found[..., (0, 1, 2), (0, 1, 2)] = 1.0
    found[..., 0, 4], found[..., 0, 5] = z, -y
    found[..., 1, 3], found[..., 1, 5] = -z, x
    found[..., 2, 3], found[..., 2, 4] = y, -x
    return found
