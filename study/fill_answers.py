"""Answers of a scene's machine with other volumes of liquid; no pair of volumes and speed is asked twice."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fluid.fill import Fill
from study.batch import Answers, answer_scenes
from study.scene import Rotor, Scene, Speeds

Array = NDArray[np.float64]
Answer = Callable[[Sequence[Scene]], Answers]

AT_ONCE = 1500  # scenes; more at once would only take memory


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
    answer : gives the outputs of `run` of many scenes
    """

    def __init__(self, scene: Scene, answer: Answer = answer_scenes) -> None:
        # One model for all volumes: a change of model within its tolerance would look like a better volume.
        liquid = "statics" if scene.model.liquid == "auto" else scene.model.liquid
        self.scene = replace(scene, optimise=None, runup=None, model=replace(scene.model, liquid=liquid))
        self._answer = answer
        self._known: dict[tuple[bytes, float], tuple[float, float]] = {}

    @property
    def planar(self) -> bool:
        """The rotor moves in one plane, so that a single speed costs no more than its share of many."""
        return isinstance(self.scene.rotor, Rotor)

    @property
    def asked(self) -> int:
        """How many pairs of volumes and speed were answered."""
        return len(self._known)

    def at(self, volumes: Array, speed: Array) -> FillAnswers:
        """Answers at m pairs.

        Parameters
        ----------
        volumes : of the chambers, m^3, shape (m, c)
        speed : rad/s, shape (m,)
        """
        rows = np.ascontiguousarray(volumes)
        keys = [(row.tobytes(), one) for row, one in zip(rows, speed.tolist(), strict=True)]
        fresh: dict[tuple[bytes, float], int] = {}
        for k, key in enumerate(keys):
            if key not in self._known:
                fresh.setdefault(key, k)
        new = list(fresh.items())
        for first in range(0, len(new), AT_ONCE):
            part = new[first : first + AT_ONCE]
            scenes = [self._one(rows[k], float(speed[k])) for _, k in part]
            self._keep([key for key, _ in part], self._answer(scenes))
        found = np.array([self._known[key] for key in keys]).reshape(-1, 2)
        return FillAnswers(found[:, 0], found[:, 1])

    def over(self, volumes: Array, speeds: Speeds) -> Array:
        """Amplitudes over evenly spaced speeds, m, shape (m, count); other rotors need their neighbours."""
        scenes = [replace(with_volumes(self.scene, row), speeds=speeds) for row in volumes]
        answers = self._answer(scenes)
        return np.where(np.isnan(answers.amplitude), math.inf, answers.amplitude)

    def _one(self, volumes: Array, speed: float) -> Scene:
        return replace(with_volumes(self.scene, volumes), speeds=Speeds(speed, speed, 1))

    def _keep(self, keys: list[tuple[bytes, float]], answers: Answers) -> None:
        amplitude = np.where(np.isnan(answers.amplitude), math.inf, answers.amplitude)[:, 0]
        for key, one, dry in zip(keys, amplitude.tolist(), answers.dry_patch[:, 0].tolist(), strict=True):
            self._known[key] = one, float(dry)


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
    return replace(scene, chambers=tuple(Fill(one.chamber, one.liquid, volume) for one, volume in pairs))
