"""Whether passive balancers in two planes or more can balance a rigid rotor, and from which speed on."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array, Complex, Flags
from meshes.errors import InputError, require_not_negative, require_positive
from meshes.quantity import Q
from solvers.rotor.balls.balancers import BallRace
from solvers.rotor.balls.stability import balanced_stability
from solvers.rotor.system import RotorSystem
from solvers.rotor.two_plane import TwoPlane


@dataclass(frozen=True)
class RigidRotor:
    """A rigid rotor on two isotropic supports, as its balancing sees it [theory: balls, section 3]."""

    mass: float  #: of the whole system with its balancers, kg
    #: A, B, C: about two axes fixed in the rotor and across its own, and about its own, through the centre of
    #: mass, kg m^2
    inertia: tuple[float, float, float]
    stiffness: tuple[float, ...]  #: of the supports, two or more, N/m
    #: of each along the axis from the centre of mass, m; l1 and -l2 of the source
    position: tuple[float, ...]

    def __post_init__(self) -> None:
        require_positive("mass", self.mass)
        for value in self.inertia[:2]:
            require_positive("inertia", value)
        require_not_negative("inertia", self.inertia[2])
        largest = max(self.inertia)
        if largest > (sum(self.inertia) - largest) * (1.0 + 1e-9):
            raise InputError("inertia", self.inertia, "moments of a body: none above the sum of the others")
        for value in self.stiffness:
            require_not_negative("stiffness", value)
        if len(self.position) != len(self.stiffness) or not all(map(math.isfinite, self.position)):
            raise InputError("position", self.position, "a finite number for each support")
        k11, k14, k33 = self.support
        if not k11 * k33 > k14 * k14 * (1.0 + 1e-12):
            raise InputError("stiffness", self.stiffness, "such that no motion of the rotor is free")

    @property
    def support(self) -> tuple[float, float, float]:
        """k11, k14, k33: resistance to shift, of shift to tilt, and to tilt [theory: balls, eq. 23]."""
        pairs = list(zip(self.stiffness, self.position, strict=True))
        return sum(k for k, _ in pairs), sum(k * z for k, z in pairs), sum(k * z * z for k, z in pairs)


@dataclass(frozen=True)
class Condition:
    """One condition for balancing, over speed."""

    name: Annotated[str, Q(text="as written")]
    value: Annotated[Array, Q(text="must be above 0, SI", over=("speed",))]
    satisfied: Annotated[Flags, Q(text="it is", over=("speed",))]
    #: infinite if at none
    above: Annotated[float, Q("rad s-1", "speed above which it holds")]


@dataclass(frozen=True)
class Balancing:
    """Result of `dynamic_balancing`."""

    speed: Annotated[Array, Q("rad s-1", "spin speed", over=("speed",), data=False)]
    possible: Annotated[Flags, Q(name="balancing in two planes", over=("speed",), flags="no yes")]
    conditions: Annotated[tuple[Condition, ...], Q(text="each of them, in the order of the source")]
    #: infinite if at none
    above: Annotated[float, Q("rad s-1", "speed above which all hold", data=False)]
    resonances: Annotated[
        tuple[float, ...], Q("rad s-1", text="speeds of the rotor without damping, ascending", data=False)
    ]
    long: Annotated[bool, Q(text="both transverse inertias exceed the polar one")]
    #: largest real part of the roots of rotor and balls about the balanced state, 1/s, shape (n,); None where
    #: no balls were given
    growth: Array | None = None

    @property
    def holds(self) -> Flags:
        """Where the balanced state is stable: by the roots, or by the conditions where there are none."""
        return self.possible if self.growth is None else np.asarray(self.growth < 0.0)

    def why(self, index: int = 0) -> str:
        """Result at one speed in words."""
        said = self._conditions(index)
        if self.growth is None:
            return said
        growth = float(self.growth[index])
        if growth < 0.0:
            return f"{said}; with these balls a disturbance decays with {-growth:.3g} 1/s at least"
        return f"{said}; with these balls a disturbance grows with {growth:.3g} 1/s"

    def _conditions(self, index: int) -> str:
        if self.possible[index]:
            return f"yes: the rotor is long and {self.speed[index]:.6g} rad/s is above {self.above:.6g} rad/s"
        failed = [condition for condition in self.conditions if not condition.satisfied[index]]
        reasons = [
            f"{condition.name} fails at every speed"
            if math.isinf(condition.above)
            else f"{condition.name} only above {condition.above:.6g} rad/s"
            for condition in failed
        ]
        return "no: " + "; ".join(reasons)


def dynamic_balancing(
    rotor: RigidRotor,
    speed: ArrayLike,
    balls: tuple[RotorSystem, Sequence[BallRace]] | None = None,
) -> Balancing:
    """Whether two or more passive balancers of any type balance the rotor [theory: balls, eq. 26-27].

    Balancers in at least two planes, light beside the rotor, able to produce its unbalance. Damping of the
    supports has no part in the conditions [FF20, eq. 32-35]; it has one in what balls really do: with
    `balls`, the same rotor with its damping and unbalance and its races, their roots stand beside the
    conditions.
    """
    spin = np.atleast_1d(np.asarray(speed, dtype=float))
    if spin.ndim != 1 or not np.all(np.isfinite(spin) & (spin >= 0.0)):
        raise InputError("speed", spin.tolist(), "finite numbers, 0 or above")
    a, b, c = rotor.inertia
    k11, k14, k33 = rotor.support
    square = np.square(spin)
    v11, v22, v33 = (b - c) * square - k33, (a - c) * square - k33, rotor.mass * square - k11
    growth = None
    if balls is not None:
        growth = np.array([balanced_stability(*balls, value).growth for value in spin.tolist()])
    tilts = (_tilt_limits(rotor, b - c), _tilt_limits(rotor, a - c))
    conditions = (
        _condition("A > C", np.full(spin.shape, a - c), 0.0 if a > c else math.inf),
        _condition("B > C", np.full(spin.shape, b - c), 0.0 if b > c else math.inf),
        _condition("v11 = (B - C) w^2 - k33 > 0", v11, _root(k33, b - c)),
        _condition("v22 = (A - C) w^2 - k33 > 0", v22, _root(k33, a - c)),
        _condition("v33 = M w^2 - k11 > 0", v33, _root(k11, rotor.mass)),
        # Together with v > 0; alone it holds at rest as well.
        _condition("v11 v33 > k14^2", v11 * v33 - k14 * k14, tilts[0][-1] if b > c else math.inf),
        _condition("v22 v33 > k14^2", v22 * v33 - k14 * k14, tilts[1][-1] if a > c else math.inf),
    )
    return Balancing(
        speed=spin,
        possible=np.logical_and.reduce([condition.satisfied for condition in conditions]),
        conditions=conditions,
        above=max(condition.above for condition in conditions),
        resonances=_distinct((*tilts[0], *tilts[1])),
        long=a > c and b > c,
        growth=growth,
    )


def of_two_planes(rotor: TwoPlane, added_mass: float = 0.0) -> RigidRotor:
    """Rotor of `solvers.rotor.two_plane` as its balancing sees it, with the mass of the balancers, kg.

    An `InputError` where a support differs in two directions: the conditions are those of supports alike.
    """
    across, along = rotor.transverse_inertia, rotor.polar_inertia
    for support in rotor.supports:
        if not support.isotropic:
            raise InputError("supports", support, "the same in all directions across the axis")
    return RigidRotor(
        mass=rotor.mass + added_mass,
        inertia=(across, across, along),
        stiffness=tuple(float(support.across[0][0, 0]) for support in rotor.supports),
        position=tuple(support.position for support in rotor.supports),
    )


def potential_hessian(rotor: RigidRotor, speed: float) -> Array:
    """Second derivatives of the generalized potential as the balancers see it [theory: balls, eq. 25].

    For (alpha, beta, x, y) in the rotating frame, shape (4, 4); positive definite where balancing occurs.
    """
    a, b, c = rotor.inertia
    k11, k14, k33 = rotor.support
    tilt_x, tilt_y = (b - c) * speed**2 - k33, (a - c) * speed**2 - k33
    shift = rotor.mass * speed**2 - k11
    return np.array(
        [
            [tilt_x, 0.0, 0.0, k14],
            [0.0, tilt_y, -k14, 0.0],
            [0.0, -k14, shift, 0.0],
            [k14, 0.0, 0.0, shift],
        ]
    )


def plane_compliance(
    rotor: RigidRotor, position: float, speed: ArrayLike, damping: Sequence[float] | None = None
) -> Complex:
    """Deflection of one plane for a force there that turns with the rotor [theory: balls, eq. 44].

    g, m/N; its imaginary part is a quarter turn ahead. The position counts from the centre of mass;
    transverse inertias must be equal.
    """
    a, b, c = rotor.inertia
    if a != b:
        raise InputError("inertia", rotor.inertia, "A = B for one plane")
    w = np.asarray(speed, dtype=float)
    pairs = list(zip(damping or [0.0] * len(rotor.position), rotor.position, strict=True))
    k11, k14, k33 = rotor.support
    b11, b14, b33 = (sum(value * z**k for value, z in pairs) for k in range(3))
    shift, both = k11 - rotor.mass * w**2 + 1j * w * b11, k14 + 1j * w * b14
    tilt = k33 - (a - c) * w**2 + 1j * w * b33
    above = tilt - 2.0 * position * both + position**2 * shift
    return np.asarray(above / (shift * tilt - both**2))


def single_plane_balancing(
    rotor: RigidRotor, position: float, speed: ArrayLike, damping: Sequence[float] | None = None
) -> Flags:
    """Whether balancers in one plane take away an unbalance of this plane [theory: balls, eq. 44].

    Light balancers whose drag outweighs their inertia: they do if and only if Re g < 0.
    """
    return np.asarray(plane_compliance(rotor, position, speed, damping).real < 0.0)


def _condition(name: str, value: Array, above: float) -> Condition:
    return Condition(name, value, np.asarray(value > 0.0), above)


def _root(stiffness: float, inertia: float) -> float:
    """Speed above which inertia w^2 exceeds the stiffness."""
    return math.sqrt(stiffness / inertia) if inertia > 0.0 else math.inf


def _distinct(speeds: tuple[float, ...]) -> tuple[float, ...]:
    """Ascending, those that differ by rounding alone once."""
    kept: list[float] = []
    for speed in sorted(speeds):
        if not (kept and math.isclose(speed, kept[-1], rel_tol=1e-12)):
            kept.append(speed)
    return tuple(kept)


def _tilt_limits(rotor: RigidRotor, excess: float) -> tuple[float, ...]:
    """Speeds where (excess w^2 - k33)(M w^2 - k11) = k14^2, ascending: one for a short rotor, else two."""
    k11, k14, k33 = rotor.support
    # excess M s^2 - (excess k11 + M k33) s + (k11 k33 - k14^2) = 0 for s = w^2
    lead, middle, last = excess * rotor.mass, excess * k11 + rotor.mass * k33, k11 * k33 - k14 * k14
    # Never negative: (excess k11 - M k33)^2 + 4 excess M k14^2, and lead has the sign of excess.
    spread = math.sqrt(max(middle * middle - 4.0 * lead * last, 0.0))
    # The sum without cancellation gives the one root, the product the other.
    q = 0.5 * (middle + math.copysign(spread, middle))
    roots = [last / q] if q != 0.0 else []
    if lead != 0.0:
        roots.append(q / lead)
    return tuple(sorted(math.sqrt(s) for s in roots if s > 0.0))
