"""Small interface of rotors without liquid: linear equations, where a chamber sits, how bearings turn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array, Complex
from meshes.errors import InputError


def cage_speed(
    shaft_speed: ArrayLike,
    pitch_diameter: ArrayLike,
    ball_diameter: ArrayLike,
    contact_angle: ArrayLike = 0.0,
) -> Array:
    """Speed of the cage when the balls roll without slip, inner ring turning, outer ring at rest.

    n_c = (n_s/2) (d_0 - d_b cos(beta))/d_0 in the unit of n_s, d_0 of the circle of the balls' centres
    [DR18, eq. 9; theory: rotor, eq. 32]. It is n_s/2 only where the balls are small against their circle,
    also for beta = 0, where the source drops d_b [DR18, eq. 10].
    """
    shaft, pitch, ball, angle = (
        np.asarray(x, dtype=float) for x in (shaft_speed, pitch_diameter, ball_diameter, contact_angle)
    )
    if not np.all(np.isfinite(pitch) & (pitch > 0.0)):
        raise InputError("pitch_diameter", pitch_diameter, "finite numbers above 0")
    if not np.all((ball >= 0.0) & (ball < pitch)):
        raise InputError("ball_diameter", ball_diameter, "0 or above and below the pitch diameter")
    if not np.all((angle >= 0.0) & (angle < 0.5 * np.pi)):
        raise InputError("contact_angle", contact_angle, "from 0 to below pi/2")
    return np.asarray(0.5 * shaft * (1.0 - ball * np.cos(angle) / pitch))


@dataclass(frozen=True)
class Shed:
    """A part of the unbalance that leaves with time, as water from laundry [theory: coupling, eq. 15]."""

    unbalance: Complex  #: that leaves in the end, complex, shape (n,)
    time_constant: float  #: s
    above: float  #: spin speed from which it leaves, rad/s
    #: mass matrix of what leaves in the end, shape (n, n); None where its mass is not known
    mass: Array | None = None
    inertia: float = 0.0  #: its moment of inertia about the spin axis, kg m^2


@dataclass(frozen=True)
class RotorSystem:
    """Linear equations of motion of a rotor, n coordinates from the static equilibrium in the standing frame.

    M q'' + (C + Omega G) q' + K q = Re[(Omega^2 - i Omega') U e^{i phi}] [theory: rotor, eq. 15]. The spin
    turns the first direction across the axis into the second; complex numbers have their real parts along the
    first.
    """

    coordinates: tuple[str, ...]  #: their names
    mass: Array  #: M, C, G and K; G is for a spin of 1 rad/s, shape (n, n)
    damping: Array
    gyroscopic: Array
    stiffness: Array
    #: U; what turns with the rotor acts with the force Omega^2 Re(U e^{i phi}), complex, shape (n,)
    unbalance: Complex
    centre: Array  #: in-plane displacement of the spin axis at position 0 for unit coordinates, shape (2, n)
    lean: Array  #: its change with the position along the axis, 1/m times `centre`, shape (2, n)
    #: parts of the unbalance that leave in a run-up; whatever stands still has all of it
    sheds: tuple[Shed, ...] = ()

    def __post_init__(self) -> None:
        n = len(self.coordinates)
        shapes: dict[str, tuple[int, ...]] = {"unbalance": (n,), "centre": (2, n), "lean": (2, n)}
        shapes |= dict.fromkeys(("mass", "damping", "gyroscopic", "stiffness"), (n, n))
        for name, shape in shapes.items():
            found = getattr(self, name)
            kinds, what = ("fiuc", "numbers") if name == "unbalance" else ("fiu", "real numbers")
            allowed = f"an array of finite {what}, shape {shape}"
            if not isinstance(found, np.ndarray):
                raise InputError(name, type(found).__name__, allowed)
            if found.dtype.kind not in kinds or found.shape != shape:
                raise InputError(name, f"{found.dtype} of shape {found.shape}", allowed)
            if not np.isfinite(found).all():
                raise InputError(name, found[~np.isfinite(found)][0].item(), allowed)
        if not np.linalg.eigvalsh(0.5 * (self.mass + self.mass.T)).min() > 0.0:
            raise InputError("mass", "matrix", "positive definite")

    def at(self, position: float) -> Array:
        """In-plane displacement of the spin axis at a position, for unit coordinates, shape (2, n)."""
        return np.asarray(self.centre + position * self.lean)

    def system(self) -> RotorSystem:
        """The equations themselves: they are a rotor, of whatever kind they were written for."""
        return self


def moving_mass(rotor: Rotor) -> float:
    """Mass that moves with the axis, kg: the rotor's, or at position 0 of equations 2/tr(A M^-1 A^T)."""
    if not isinstance(rotor, RotorSystem):
        return float(rotor.mass)  # type: ignore[attr-defined]
    freedom = rotor.centre @ np.linalg.solve(rotor.mass, rotor.centre.T)
    return float(2.0 / np.trace(freedom))


class Rotor(Protocol):
    """A rotor without liquid to which chambers can be fitted.

    Solvers that know more about a kind of rotor ask for that kind, never for the shape of its matrices.
    """

    def system(self) -> RotorSystem:
        """Equations of motion of the rotor."""
        ...
