"""A kind of machine: supports that are stiffer upwards than sideways."""

from __future__ import annotations

from typing import Literal

import numpy as np
from pydantic import Field

from leblanc.scene.rotors import Machine
from leblanc.scene.schema.rules import Damping, Mass, Stiffness, Unbalance
from solvers.rotor.system import RotorSystem


class Uneven(Machine):
    """A disc that moves in its plane, on supports of two stiffnesses."""

    kind: Literal["uneven"] = "uneven"
    mass: Mass = Field(description="of the rotor without the liquid")
    sideways: Stiffness = Field(description="of the supports, across gravity")
    upwards: Stiffness = Field(description="of the supports, along gravity")
    damping: Damping = Field(description="of the supports in both directions")
    unbalance: Unbalance = Field(description="mass times its distance from the axis")

    def machine(self) -> RotorSystem:
        """Its equations of motion without the liquid."""
        one = np.eye(2)
        return RotorSystem(
            coordinates=("x", "y"),
            mass=self.mass * one,
            damping=self.damping * one,
            gyroscopic=0.0 * one,
            stiffness=np.diag([self.sideways, self.upwards]),
            # The spin turns the first direction into the second, a quarter of a turn later.
            unbalance=np.array([self.unbalance, -1j * self.unbalance]),
            centre=one,
            lean=0.0 * one,
        )
