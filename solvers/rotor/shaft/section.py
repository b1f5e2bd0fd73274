"""A uniform section of a shaft: bending, shear, distributed mass, rotary inertia and spin, solved exactly.

The state of a cross-section is (w, theta, M, Q): deflection, slope, bending moment, shear force.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from meshes.arrays import Array
from meshes.errors import InputError, require_not_negative, require_positive

SHORT = 2.0  # most of a wave number times a length: no piece then has a resonance between clamped ends
_SERIES, _TERMS = 1.0, 12  # up to this size of its argument a function is summed, with so many terms


@dataclass(frozen=True)
class Section:
    """A uniform piece of a beam [theory: spindle, eq. 1-2]."""

    length: float  #: m
    bending_stiffness: float  #: E I, N m^2
    mass: float  #: of a unit of length, kg/m
    rotary_inertia: float = 0.0  #: rho I of a unit of length across the axis, kg m; 0 leaves it out
    shear_flexibility: float = 0.0  #: 1/(kappa G A), 1/N; 0 leaves shear out
    #: of a unit of length about the axis, kg m, of what spins; 0 for what does not
    polar_inertia: float = 0.0

    def __post_init__(self) -> None:
        for name in ("length", "bending_stiffness", "mass"):
            require_positive(name, getattr(self, name))
        for name in ("rotary_inertia", "shear_flexibility", "polar_inertia"):
            require_not_negative(name, getattr(self, name))

    @property
    def cutoff(self) -> float:
        """Frequency from which on shear waves run across it, rad/s; infinite where one of both is 0."""
        both = self.rotary_inertia * self.shear_flexibility
        return 1.0 / math.sqrt(both) if both > 0.0 else math.inf

    def turning_inertia(self, frequency: Array, spin: float) -> Array:
        """R, moment of the inertia of a unit of length over its slope [theory: spindle, eq. 2], N."""
        turning = self.rotary_inertia * np.square(frequency) - self.polar_inertia * spin * frequency
        return np.asarray(turning)

    def pieces(self, frequency: float, spin: float = 0.0) -> int:
        """Into how many pieces it must be cut up to a frequency [theory: spindle, eq. 9].

        An `InputError` where the frequency is not below the cutoff of shear waves.
        """
        gyroscopic = self.polar_inertia * abs(spin) * frequency
        turning = self.rotary_inertia * frequency**2 + gyroscopic
        if turning * self.shear_flexibility >= 1.0:
            text = f"below the cutoff of shear waves across a section, {self.cutoff:g} rad/s without spin"
            raise InputError("frequency", frequency, text)
        inertia = self.mass * frequency**2
        half = 0.5 * (self.shear_flexibility * inertia + turning / self.bending_stiffness)
        square = inertia * (1.0 + self.shear_flexibility * gyroscopic) / self.bending_stiffness
        wave_number = math.sqrt(half + math.sqrt(half * half + square))
        return max(1, math.ceil(wave_number * self.length / SHORT))


def round_section(
    length: float,
    diameter: float,
    bore: float = 0.0,
    *,
    elastic_modulus: float = 210e9,
    density: float = 7850.0,
    poisson_ratio: float = 0.3,
    theory: str = "timoshenko",
    spins: bool = False,
) -> Section:
    """A round section, solid or hollow, of one material [theory: spindle, eq. 16].

    SI units. Theory "euler" has the mass alone, "rayleigh" rotary inertia, "timoshenko" also shear; one that
    `spins` has gyroscopic moments.
    """
    for name, value in (("length", length), ("diameter", diameter), ("density", density)):
        require_positive(name, value)
    require_positive("elastic_modulus", elastic_modulus)
    if not 0.0 <= bore < diameter:
        raise InputError("bore", bore, f"0 or above and below the diameter, {diameter:g} m")
    if not 0.0 <= poisson_ratio < 0.5:
        raise InputError("poisson_ratio", poisson_ratio, "from 0 to below 0.5")
    if theory not in ("euler", "rayleigh", "timoshenko"):
        raise InputError("theory", theory, "one of: euler, rayleigh, timoshenko")
    area = 0.25 * math.pi * (diameter**2 - bore**2)
    second_moment = math.pi / 64.0 * (diameter**4 - bore**4)
    rotary = density * second_moment if theory != "euler" else 0.0
    shear = 0.0
    if theory == "timoshenko":
        shear_modulus = 0.5 * elastic_modulus / (1.0 + poisson_ratio)
        shear = 1.0 / (shear_coefficient(bore / diameter, poisson_ratio) * shear_modulus * area)
    return Section(
        length=length,
        bending_stiffness=elastic_modulus * second_moment,
        mass=density * area,
        rotary_inertia=rotary,
        shear_flexibility=shear,
        polar_inertia=2.0 * density * second_moment if spins else 0.0,
    )


def shear_coefficient(ratio: float, poisson_ratio: float) -> float:
    """kappa of a round section by Cowper [theory: spindle, eq. 16].

    `ratio`: bore over diameter.
    """
    both = (1.0 + ratio**2) ** 2
    rest = (7.0 + 6.0 * poisson_ratio) * both + (20.0 + 12.0 * poisson_ratio) * ratio**2
    return 6.0 * (1.0 + poisson_ratio) * both / rest


def transfer_matrices(section: Section, length: float, frequency: Array, spin: float = 0.0) -> Array:
    """From the state at the left end of a piece to that at its right end [theory: spindle, eq. 3-4].

    Shape (n, 4, 4), for the states (w, theta, M, Q) in SI units; frequencies below 0 for backward whirl.
    """
    bending, shear = section.bending_stiffness, section.shear_flexibility
    omega = np.asarray(frequency, dtype=float)
    turning = section.turning_inertia(omega, spin) * length**2 / bending
    inertia = section.mass * np.square(omega) * length**4 / bending
    sheared = shear * bending / length**2
    change = np.zeros((*omega.shape, 4, 4))
    change[..., 0, 1] = change[..., 1, 2] = 1.0
    change[..., 0, 3], change[..., 2, 3] = sheared, -1.0
    change[..., 2, 1], change[..., 3, 0] = -turning, -inertia
    # Squares of the two wave numbers, times the length squared: of the part that decays and of the other.
    half = 0.5 * (sheared * inertia + turning)
    root = np.sqrt(0.25 * np.square(sheared * inertia - turning) + inertia)
    decaying, waving = root - half, -(root + half)
    scale = np.array([length, 1.0, bending / length, bending / length**2])
    exponential = _exponential(change, decaying, waving)
    return np.asarray(exponential * scale[:, None] / scale)


def _exponential(matrix: Array, first: Array, second: Array) -> Array:
    """exp of matrices (n, 4, 4) whose squares have two double eigenvalues, by their even and odd parts."""
    square, unit = matrix @ matrix, np.eye(4)
    rest = square - first[..., None, None] * unit
    even = _even(first)[..., None, None] * unit + _slope(_even, first, second, 0)[..., None, None] * rest
    odd = _odd(first)[..., None, None] * unit + _slope(_odd, first, second, 1)[..., None, None] * rest
    return np.asarray(even + matrix @ odd)


def _even(x: Array) -> Array:
    """cosh of the root of x, cos where x is negative."""
    root = np.sqrt(np.abs(x))
    return np.where(x >= 0.0, np.cosh(root), np.cos(root))


def _odd(x: Array) -> Array:
    """sinh of the root of x over that root, sin where x is negative."""
    root = np.sqrt(np.abs(x))
    safe = np.where(root > 0.0, root, 1.0)
    return np.where(root > 0.0, np.where(x >= 0.0, np.sinh(safe), np.sin(safe)) / safe, 1.0)


def _slope(function: object, first: Array, second: Array, odd: int) -> Array:
    """Divided difference of one of both functions; where its arguments are small by its power series."""
    assert callable(function)
    near = np.maximum(np.abs(first), np.abs(second)) < _SERIES
    apart = np.where(near, 1.0, first - second)
    found = (function(first) - function(second)) / apart
    if not near.any():
        return np.asarray(found)
    x, y = np.where(near, first, 0.0), np.where(near, second, 0.0)
    total, sums, power = np.zeros(x.shape), np.zeros(x.shape), np.ones(x.shape)
    for k in range(1, _TERMS):
        sums = x * sums + power  # of x^i y^j, i + j = k - 1
        power = power * y
        total += sums / math.factorial(2 * k + odd)
    return np.where(near, total, found)


def stiffness_matrices(transfer: Array) -> Array:
    """Forces on both ends of a piece from the motion of the ends [theory: spindle, eq. 8].

    Symmetric, shape (n, 4, 4), for the motions (w, theta) at the left and the right end; forces and moments
    are those from outside.
    """
    # The force at the left end is -Q, the moment -M; the states order M before Q, motions w before theta.
    order = [3, 2]
    to_motion, from_force = transfer[..., :2, :2], transfer[..., :2, order]
    back = np.linalg.inv(from_force)
    left = np.concatenate([-back @ to_motion, back], axis=-1)  # (Q, M) at the left end
    motion = transfer[..., order, :2]
    right = transfer[..., order, :][..., order] @ left
    right[..., :, :2] += motion
    found = np.concatenate([-left, right], axis=-2)
    return np.asarray(0.5 * (found + np.swapaxes(found, -1, -2)))
