"""The smallest rotor of one's own: supports that are stiffer upwards than sideways.

Run it: `python docs/examples/uneven_supports.py`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshes.errors import require_not_negative, require_positive
from solvers.rotor.system import RotorSystem
from solvers.rotor.vibration import modes, unbalance_response


@dataclass(frozen=True)
class UnevenSupports:
    """A disc that moves in its plane.

    Parameters
    ----------
    mass : kg
    sideways, upwards : stiffness of the supports, N/m
    damping : of the supports in both directions, N s/m
    unbalance : kg m
    """

    mass: float
    sideways: float
    upwards: float
    damping: float
    unbalance: float

    def __post_init__(self) -> None:
        for name in ("mass", "sideways", "upwards"):
            require_positive(name, getattr(self, name))
        for name in ("damping", "unbalance"):
            require_not_negative(name, getattr(self, name))

    def system(self) -> RotorSystem:
        """See `solvers.rotor.system.Rotor`."""
        identity = np.eye(2)
        return RotorSystem(
            coordinates=("x", "y"),
            mass=self.mass * identity,
            damping=self.damping * identity,
            gyroscopic=0.0 * identity,
            stiffness=np.diag([self.sideways, self.upwards]),
            # The spin turns the first direction into the second, a quarter of a turn later.
            unbalance=np.array([self.unbalance, -1j * self.unbalance]),
            centre=identity,
            lean=0.0 * identity,
        )


ROTOR = UnevenSupports(mass=10.0, sideways=1.0e4, upwards=4.0e4, damping=20.0, unbalance=1e-3)

if __name__ == "__main__":
    system = ROTOR.system()
    print("natural frequencies, rad/s:", modes(system).eigenvalue[0].imag.round(3))
    between = unbalance_response(system, [45.0])[0]
    print("amplitudes at 45 rad/s, mm:", (1e3 * np.abs(between)).round(4))
