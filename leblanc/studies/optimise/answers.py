"""Responses of a machine with other volumes of liquid; no pair of volumes and speed is solved twice."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from leblanc.scene.scene import JeffcottRotor, Scene, Speeds, jeffcott
from leblanc.studies.batch import answer_scenes
from leblanc.studies.choose import axial_gravity
from leblanc.studies.liquid import synchronous_model
from meshes.arrays import Array, Flags
from solvers.synchronous.response import machine_responses

AT_ONCE = 4000  # pairs; more at once would only take memory


@dataclass(frozen=True)
class FillAnswers:
    """Amplitude and dry wall at pairs of volumes and speed, shape (m,).

    Parameters
    ----------
    amplitude : m; infinite where it has no bound or was not found
    dry_patch : 1 where the wall is dry somewhere, else 0
    """

    amplitude: Array
    dry_patch: Array


class FilledMachine:
    """A scene's machine with any volumes in its chambers.

    Parameters
    ----------
    scene : the machine; its volumes and speeds are replaced
    """

    def __init__(self, scene: Scene) -> None:
        # One model for all volumes: a change of model within its tolerance would look like a better volume.
        liquid = "statics" if scene.model.liquid == "auto" else scene.model.liquid
        self.scene = scene.altered(optimise=None, runup=None, model=scene.model.altered(liquid=liquid))
        self._known: dict[tuple[bytes, float], tuple[float, float]] = {}

    @property
    def planar(self) -> bool:
        """The rotor moves in one plane, so that a single speed costs no more than its share of many."""
        return isinstance(self.scene.rotor, JeffcottRotor)

    def at(self, volumes: Array, speed: Array) -> FillAnswers:
        """Answers at m pairs.

        Parameters
        ----------
        volumes : of the chambers, m^3, shape (m, c)
        speed : rad/s, shape (m,)
        """
        rows = np.ascontiguousarray(volumes)
        keys = [(row.tobytes(), spin) for row, spin in zip(rows, speed.tolist(), strict=True)]
        fresh: dict[tuple[bytes, float], int] = {}
        for k, key in enumerate(keys):
            if key not in self._known:
                fresh.setdefault(key, k)
        new = list(fresh.items())
        for first in range(0, len(new), AT_ONCE):
            part = new[first : first + AT_ONCE]
            which = np.array([k for _, k in part], dtype=np.intp)
            amplitude, dry = (self._planar if self.planar else self._one_by_one)(rows[which], speed[which])
            amplitude = np.where(np.isnan(amplitude), math.inf, amplitude)
            for (key, _), size, dried in zip(part, amplitude.tolist(), dry.tolist(), strict=True):
                self._known[key] = size, float(dried)
        found = np.array([self._known[key] for key in keys]).reshape(-1, 2)
        return FillAnswers(found[:, 0], found[:, 1])

    def over(self, volumes: Array, speeds: Speeds) -> Array:
        """Amplitudes over evenly spaced speeds, m, shape (m, count); other rotors need their neighbours."""
        scenes = [with_volumes(self.scene, row).altered(speeds=speeds) for row in volumes]
        answers = answer_scenes(scenes)
        return np.where(np.isnan(answers.amplitude), math.inf, answers.amplitude)

    def _planar(self, volumes: Array, speed: Array) -> tuple[Array, Flags]:
        """Amplitude and dry wall at m pairs; whirls that grow by themselves are judged apart."""
        different, owner = np.unique(volumes, axis=0, return_inverse=True)
        rotor = jeffcott(self.scene)
        machines = [(rotor, with_volumes(self.scene, row).fills) for row in different]
        gravity = np.full(len(machines), axial_gravity(self.scene))
        model = synchronous_model(self.scene.model.liquid)
        found = machine_responses(machines, owner.reshape(-1), speed, gravity, model)
        return np.abs(found.deflection), found.dry_patch

    def _one_by_one(self, volumes: Array, speed: Array) -> tuple[Array, Flags]:
        """The same of rotors that tilt."""
        pairs = zip(volumes, speed.tolist(), strict=True)
        scenes = [with_volumes(self.scene, row).altered(speeds=Speeds.at(spin)) for row, spin in pairs]
        found = answer_scenes(scenes)
        return found.amplitude[:, 0], found.dry_patch[:, 0]


def with_volumes(scene: Scene, volumes: Array) -> Scene:
    """A scene with other volumes in its chambers.

    Parameters
    ----------
    scene : the machine
    volumes : m^3, shape (c,)

    Raises
    ------
    InputError : a volume that its chamber does not hold
    """
    pairs = zip(scene.chambers, volumes.tolist(), strict=True)
    return scene.altered(chambers=tuple(chamber.holding(volume) for chamber, volume in pairs))
