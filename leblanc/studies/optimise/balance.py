"""Balance quality of a machine with any volumes [theory: balance_quality, eq. 1-3]."""

from __future__ import annotations

import numpy as np

from leblanc.scene.scene import dry_rotor, jeffcott
from leblanc.studies.models.choose import axial_gravity
from leblanc.studies.models.liquid import synchronous_model
from leblanc.studies.optimise.answers import FilledMachine, model_name, with_volumes
from meshes.arrays import Array
from solvers.rotor.balance_quality import balance_quality
from solvers.synchronous.response import response


class QualityAtSpeed:
    """Total unbalance over the rotor's mass, times the speed."""

    def __init__(self, machine: FilledMachine, speed: float) -> None:
        self.machine, self.speed = machine, speed
        self._known: dict[bytes, float] = {}

    def of(self, volumes: Array) -> Array:
        """Balance quality with m sets of volumes, m/s; infinite where the motion is, shape (m,)."""
        if self.machine.planar:
            rotor, omega = jeffcott(self.machine.scene), np.array([self.speed])
            held = float(np.abs(rotor.dynamic_stiffness(omega))[0])
            amplitude = self.machine.at(volumes, np.full(volumes.shape[0], self.speed)).amplitude
            return np.asarray(held * amplitude / (rotor.mass * self.speed))
        return np.array([self._one(np.ascontiguousarray(row)) for row in volumes])

    def dry(self) -> float:
        """The same without liquid, m/s."""
        return float(balance_quality(dry_rotor(self.machine.scene), [self.speed])[0])

    def _one(self, volumes: Array) -> float:
        """Of a rotor that tilts."""
        key, scene = volumes.tobytes(), self.machine.scene
        if key not in self._known:
            rotor, filled = dry_rotor(scene), with_volumes(scene, volumes)
            model = synchronous_model(model_name(filled))
            found = response(rotor, filled.fills, [self.speed], axial_gravity(scene), model)
            self._known[key] = float(balance_quality(rotor, [self.speed], found.coordinates)[0])
        return self._known[key]
