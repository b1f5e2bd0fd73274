"""The small interface of the dry rotors: linear equations of motion, and where a chamber sits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from meshes.arrays import Array, Complex
from meshes.errors import InputError


@dataclass(frozen=True)
class RotorSystem:
    """M q'' + (C + Omega G) q' + K q = Re[(Omega^2 - i Omega') U e^{i phi}] [theory: rotor, eq. 15].

    The plane across the spin axis has two directions; the spin turns the first into the second, and
    complex numbers have their real parts along the first. n coordinates, all measured in the standing frame
    from the static equilibrium.

    Parameters
    ----------
    coordinates : their names
    mass, damping, gyroscopic, stiffness : M, C, G and K; G is for a spin of 1 rad/s, shape (n, n)
    unbalance : U; what turns with the rotor acts with the force Omega^2 Re(U e^{i phi}), complex, shape (n,)
    centre : in-plane displacement of the spin axis at position 0 for unit coordinates, shape (2, n)
    lean : its change with the position along the axis, 1/m times `centre`, shape (2, n)

    Raises
    ------
    InputError : shapes that do not fit together, a mass matrix that is not positive definite
    """

    coordinates: tuple[str, ...]
    mass: Array
    damping: Array
    gyroscopic: Array
    stiffness: Array
    unbalance: Complex
    centre: Array
    lean: Array

    def __post_init__(self) -> None:
        n = len(self.coordinates)
        shapes: dict[str, tuple[int, ...]] = {"unbalance": (n,), "centre": (2, n), "lean": (2, n)}
        shapes |= dict.fromkeys(("mass", "damping", "gyroscopic", "stiffness"), (n, n))
        for name, shape in shapes.items():
            found = getattr(self, name)
            if found.shape != shape or not np.isfinite(found).all():
                raise InputError(name, found.shape, f"finite numbers of shape {shape}")
        if not np.linalg.eigvalsh(0.5 * (self.mass + self.mass.T)).min() > 0.0:
            raise InputError("mass", "matrix", "positive definite")

    def at(self, position: float) -> Array:
        """In-plane displacement of the spin axis at a position, for unit coordinates, shape (2, n)."""
        return np.asarray(self.centre + position * self.lean)

    def system(self) -> RotorSystem:
        """Itself: equations of motion are a rotor, whatever they were written down for."""
        return self


class Rotor(Protocol):
    """A dry rotor to which chambers can be fitted.

    Solvers that know more about a kind of rotor ask for that kind, never for the shape of its matrices.
    """

    def system(self) -> RotorSystem:
        """Its equations of motion."""
        ...
