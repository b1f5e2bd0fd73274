"""The Jeffcott rotor: a rigid disc on an isotropic elastic support with external damping."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fluid.fill import Fill
from meshes.arrays import Array
from meshes.errors import require_not_negative, require_positive
from solvers.rotor.system import RotorSystem


@dataclass(frozen=True)
class Jeffcott:
    """Planar rotor [theory: rotor, eq. 1].

    Raises
    ------
    InputError : mass or stiffness not positive, damping or unbalance negative
    """

    mass: float  #: M, kg, without the liquid
    stiffness: float  #: K, N/m
    damping: float  #: C of the support, N s/m
    unbalance: float  #: U0 = m e, kg m; its direction is the origin of all angles

    def __post_init__(self) -> None:
        require_positive("mass", self.mass)
        require_positive("stiffness", self.stiffness)
        require_not_negative("damping", self.damping)
        require_not_negative("unbalance", self.unbalance)

    @property
    def natural_frequency(self) -> float:
        """sqrt(K/M), rad/s."""
        return float(np.sqrt(self.stiffness / self.mass))

    @property
    def damping_ratio(self) -> float:
        """zeta = C/(2 sqrt(K M))."""
        return float(self.damping / (2.0 * np.sqrt(self.stiffness * self.mass)))

    def dynamic_stiffness(self, speed: Array) -> NDArray[np.complex128]:
        """K - M Omega^2 + i C Omega of the rotor without liquid in the drum frame, N/m, shape of `speed`."""
        return np.asarray(
            self.stiffness - self.mass * np.square(speed) + 1j * self.damping * speed, dtype=complex
        )

    def system(self) -> RotorSystem:
        """Equations of motion in the two directions across the axis; chambers in any plane move alike."""
        unit = np.eye(2)
        return RotorSystem(
            coordinates=("x", "y"),
            mass=self.mass * unit,
            damping=self.damping * unit,
            gyroscopic=0.0 * unit,
            stiffness=self.stiffness * unit,
            # Its force turns with the spin, from the first direction to the second.
            unbalance=np.array([self.unbalance, -1j * self.unbalance], dtype=complex),
            centre=unit,
            lean=0.0 * unit,
        )


# A rotor with the fills of its chambers, all of which move alike.
PlanarMachine = tuple[Jeffcott, Sequence[Fill]]
