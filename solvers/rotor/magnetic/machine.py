"""A rigid rotor in two radial magnetic bearings: inertia, magnets, motor, drag of a fluid."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array
from meshes.errors import InputError, require_not_negative, require_positive

COORDINATES = ("x", "y", "alpha", "beta")


@dataclass(frozen=True)
class Magnets:
    """Two opposite electromagnets on each of two axes, in each of two bearings [theory: magnetic, eq. 4]."""

    gap: float  #: delta, between the rotor in the centre and each magnet, m
    force_constant: float  #: k_A, N m^2/A^2
    bias_current: float  #: i_0 of every coil, A
    #: largest control current, A; the bias current, with which one of two coils is off, if None
    most_current: float | None = None
    #: of the coils with their amplifiers, rad/s; coils that follow at once if None
    bandwidth: float | None = None

    def __post_init__(self) -> None:
        for name in ("gap", "force_constant", "bias_current"):
            require_positive(name, getattr(self, name))
        for name in ("most_current", "bandwidth"):
            if (value := getattr(self, name)) is not None:
                require_positive(name, value)
        if self.limit > self.bias_current:
            raise InputError("most_current", self.limit, f"at most the bias current, {self.bias_current:g} A")

    @property
    def limit(self) -> float:
        """Largest control current, A."""
        return self.bias_current if self.most_current is None else self.most_current

    @property
    def current_stiffness(self) -> float:
        """k_i, change of the force with the current in the centre, N/A [theory: magnetic, eq. 6]."""
        return 4.0 * self.force_constant * self.bias_current / self.gap**2

    @property
    def position_stiffness(self) -> float:
        """k_s, change of the force with the position in the centre, N/m [theory: magnetic, eq. 6]."""
        return 4.0 * self.force_constant * self.bias_current**2 / self.gap**3

    def force(self, displacement: ArrayLike, current: ArrayLike) -> Array:
        """Force of a pair of magnets [theory: magnetic, eq. 4] [BG18, eq. 28].

        Towards the first magnet, N, as the displacement, m, which is below the gap in size; control current
        in A.
        """
        x, i = np.asarray(displacement, dtype=float), np.asarray(current, dtype=float)
        near = np.square((self.bias_current + i) / (self.gap - x))
        far = np.square((self.bias_current - i) / (self.gap + x))
        return np.asarray(self.force_constant * (near - far))

    def current(self, displacement: ArrayLike, force: ArrayLike) -> Array:
        """Control current for a force, the inverse of `force` [theory: magnetic, eq. 5].

        A force that no current gives is answered by the current of the largest one in its direction; A,
        beyond `limit` where the force takes so much.
        """
        x, f = np.asarray(displacement, dtype=float), np.asarray(force, dtype=float) / self.force_constant
        near, far, i = 1.0 / np.square(self.gap - x), 1.0 / np.square(self.gap + x), self.bias_current
        apart, both = near - far, i * (near + far)
        root = np.sqrt(np.maximum(4.0 * near * far * i * i + apart * f, 0.0))
        # Where no current gives the force the root is 0: f is put in its place so that the slope vanishes.
        least = np.where(root > 0.0, f, -4.0 * near * far * i * i / np.where(apart == 0.0, 1.0, apart))
        return np.asarray((least - apart * i * i) / (both + root))

    def energy(self, displacement: ArrayLike, current: ArrayLike) -> Array:
        """Potential of `force` at held currents, J, shape (...,) [theory: magnetic, eq. 7]."""
        x, i = np.asarray(displacement, dtype=float), np.asarray(current, dtype=float)
        near = np.square(self.bias_current + i) / (self.gap - x)
        far = np.square(self.bias_current - i) / (self.gap + x)
        return np.asarray(-self.force_constant * (near + far))


@dataclass(frozen=True)
class MagneticRotor:
    """A rigid rotor between two bearings; x, y, alpha, beta of its centre [theory: magnetic, eq. 1]."""

    mass: float  #: m, kg
    transverse_inertia: float  #: I_x and I_z, kg m^2; I_z at most 2 I_x
    polar_inertia: float
    eccentricity: float  #: e of the centre of mass, m
    inertia_tilt: float  #: gamma of the principal axis to the rotor's axis, rad
    first: float  #: places of the bearings along the axis, m, the first one lower
    second: float
    magnets: Magnets  #: of each bearing
    motor_stiffness: float = 0.0  #: c_m, by which the motor pulls the rotor outwards, N/m
    motor_length: float = 0.0  #: l_m, over which it does so evenly, m
    drag: float = 0.0  #: moment of the fluid over the rate of turning, N m s

    def __post_init__(self) -> None:
        for name in ("mass", "transverse_inertia", "polar_inertia"):
            require_positive(name, getattr(self, name))
        for name in ("eccentricity", "inertia_tilt", "motor_stiffness", "motor_length", "drag"):
            require_not_negative(name, getattr(self, name))
        if self.polar_inertia > 2.0 * self.transverse_inertia:
            raise InputError("polar_inertia", self.polar_inertia, "at most twice transverse_inertia")
        if not (math.isfinite(self.first) and math.isfinite(self.second) and self.first < self.second):
            raise InputError("first, second", (self.first, self.second), "places, the first one lower")

    @property
    def inertia(self) -> Array:
        """Diagonal of M: m, m, I_x, I_x, shape (4,)."""
        return np.array([self.mass, self.mass, self.transverse_inertia, self.transverse_inertia])

    @property
    def gyroscopic(self) -> Array:
        """G for a spin of 1 rad/s, shape (4, 4) [theory: magnetic, eq. 1]."""
        found = np.zeros((4, 4))
        found[2, 3], found[3, 2] = self.polar_inertia, -self.polar_inertia
        return found

    @property
    def bearing_motion(self) -> Array:
        """T, displacements in the bearings for unit coordinates, shape (4, 4) [theory: magnetic, eq. 3]."""
        rows = [((1, 0, 0, z), (0, 1, -z, 0)) for z in (self.first, self.second)]
        return np.array([row for pair in rows for row in pair], dtype=float)

    @property
    def motor_pull(self) -> Array:
        """C_m, force and moment of the motor for unit coordinates, shape (4, 4) [theory: magnetic, eq. 8].

        The motor sits in the middle between the bearings.
        """
        middle = 0.5 * (self.first + self.second)
        across = np.array([[1.0, 0.0, 0.0, middle], [0.0, 1.0, -middle, 0.0]])
        own = np.diag([0.0, 0.0, 1.0, 1.0]) * self.motor_length**2 / 12.0
        return np.asarray(self.motor_stiffness * (across.T @ across + own))

    @property
    def damping(self) -> Array:
        """Moment of the fluid against the rate of leaning, shape (4, 4) [theory: magnetic, eq. 9]."""
        return np.diag([0.0, 0.0, self.drag, self.drag])

    @property
    def circulation(self) -> Array:
        """Moment of the fluid across the lean, for 1 rad/s, shape (4, 4) [theory: magnetic, eq. 9]."""
        found = np.zeros((4, 4))
        found[2, 3], found[3, 2] = self.drag, -self.drag
        return found

    @property
    def unbalance(self) -> Array:
        """m e and (I_x - I_z) gamma, of x and alpha; y and beta follow a quarter turn later, shape (2,)."""
        couple = (self.transverse_inertia - self.polar_inertia) * self.inertia_tilt
        return np.array([self.mass * self.eccentricity, couple])

    def unbalance_load(self, angle: ArrayLike, speed: ArrayLike, rate: ArrayLike = 0.0) -> Array:
        """Force and moment of the unbalances [theory: magnetic, eq. 2].

        N and N m, shape (..., 4), at the angle phi, speed Omega and its rate of change.
        """
        speed = np.asarray(speed, dtype=float)
        turning = (speed**2 - 1j * np.asarray(rate)) * np.exp(1j * np.asarray(angle))
        pair = np.stack((turning.real, turning.imag), axis=-1)
        return np.concatenate((self.unbalance[0] * pair, self.unbalance[1] * pair), axis=-1)

    def outward_force(self, displacement: ArrayLike, current: ArrayLike) -> Array:
        """Force outwards on a rotor that does not lean, of both bearings and the motor, along one axis, N."""
        x = np.asarray(displacement, dtype=float)
        return np.asarray(2.0 * self.magnets.force(x, current) + self.motor_stiffness * x)

    @property
    def reach(self) -> float:
        """Largest deflection along an axis from which the magnets bring it home, m: the gap at most."""
        from scipy.optimize import brentq

        def outwards(x: float) -> float:
            return float(self.outward_force(x, -self.magnets.limit))

        end = self.magnets.gap * (1.0 - 1e-9)
        return float(brentq(outwards, 0.0, end)) if outwards(end) > 0.0 else self.magnets.gap

    def energy(self, place: ArrayLike, rate: ArrayLike, current: ArrayLike = 0.0) -> Array:
        """Energy of the motion, of motor and magnets at held currents [theory: magnetic, eq. 7]."""
        q, v = np.asarray(place, dtype=float), np.asarray(rate, dtype=float)
        motion = 0.5 * np.sum(self.inertia * v * v, axis=-1)
        motor = -0.5 * np.sum(q * (q @ self.motor_pull), axis=-1)
        return np.asarray(
            motion + motor + self.magnets.energy(q @ self.bearing_motion.T, current).sum(axis=-1)
        )


@dataclass(frozen=True)
class Dimensionless:
    """Numbers that rotors of this kind are compared by [theory: magnetic, eq. 10] [BG18, eq. 41]."""

    gyroscopic: float  #: Pi_1 = I_z/I_x
    slenderness: float  #: Pi_2 = m l^2/I_x, l the distance of the bearings
    drag: float  #: Pi_H
    #: Pi_K (i_0/S_i)^2, force constant times the square of the bias current over c_m delta^3; nan without a
    #: motor
    magnets: float
    time: float  #: S_t = sqrt(m/c_m), s; nan without a motor


def dimensionless(machine: MagneticRotor, length: float | None = None) -> Dimensionless:
    """The numbers of a rotor.

    Pi_2 is taken with `length`, m; distance of the bearings if None.
    """
    length = machine.second - machine.first if length is None else length
    inertia, pull = machine.transverse_inertia, machine.motor_stiffness
    time = math.sqrt(machine.mass / pull) if pull > 0.0 else math.nan
    magnets = machine.magnets
    return Dimensionless(
        gyroscopic=machine.polar_inertia / inertia,
        slenderness=machine.mass * length**2 / inertia,
        drag=machine.drag * time / inertia,
        magnets=magnets.force_constant * magnets.bias_current**2 / (pull * magnets.gap**3)
        if pull
        else math.nan,
        time=time,
    )


def screw_drag(coefficient: float, viscosity: float, radius: float, length: float) -> float:
    """Moment of the fluid over the speed of turning, c_w eta pi r^2 l, N m s [theory: magnetic, eq. 9].

    c_w, dynamic viscosity eta in Pa s, r and l of the body in m.
    """
    require_not_negative("coefficient", coefficient)
    require_not_negative("viscosity", viscosity)
    require_positive("radius", radius)
    require_positive("length", length)
    return coefficient * viscosity * math.pi * radius**2 * length


def motor_length(shape: float, first: float, second: float) -> float:
    """Length of a motor whose shape number k_m = l_m^2/(3 (a_1 + a_2)^2) is known, m [BG18, eq. 31]."""
    require_not_negative("shape", shape)
    return math.sqrt(3.0 * shape) * (second - first)
