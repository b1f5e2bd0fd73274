"""What is to be small: vibrations over the volumes [theory: optimum, eq. 2-4].

At one speed or a mean over several, the largest over many without asking for all of them, the largest of a
run-up in time, and a quantile over operating conditions.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from fluid.liquid import expansion, liquid_at
from leblanc.scene.scene import JeffcottRotor, Scene, Speeds
from leblanc.studies.liquid import runup_model
from leblanc.studies.optimise.answers import FilledMachine, with_volumes
from meshes.arrays import Array, Flags
from meshes.errors import InputError


class Vibration(Protocol):
    """A vibration that depends on the volumes of m sets, m^3, shape (m, c)."""

    def exact(self, volumes: Array, bound: float = math.inf) -> Array:
        """Vibration, m, shape (m,); above the bound an estimate from below will do."""
        ...

    def least(self, volumes: Array, bound: float = math.inf) -> tuple[Array, Flags]:
        """The same, known for sure where it is least; elsewhere estimates from below.

        Parameters
        ----------
        volumes : m^3, shape (m, c)
        bound : what is above it need not be known for sure even if it is least

        Returns
        -------
        vibration, m, and where that is sure, shape (m,) each
        """
        ...


class AlwaysExact(ABC):
    """A vibration that costs the same to know for sure."""

    @abstractmethod
    def exact(self, volumes: Array, bound: float = math.inf) -> Array:
        """See `Vibration`."""

    def least(self, volumes: Array, bound: float = math.inf) -> tuple[Array, Flags]:
        """See `Vibration`; sure everywhere."""
        return self.exact(volumes, bound), np.ones(volumes.shape[0], dtype=bool)


class AtSpeed(AlwaysExact):
    """Amplitude at one speed, or the weighted mean over several [theory: optimum, eq. 2].

    Parameters
    ----------
    machine : with any volumes
    speeds, weights : rad/s and their shares, shape (k,)
    """

    def __init__(self, machine: FilledMachine, speeds: Array, weights: Array) -> None:
        self.machine, self.speeds, self.weights = machine, speeds, weights / weights.sum()

    def exact(self, volumes: Array, bound: float = math.inf) -> Array:
        """See `Vibration`."""
        count = self.speeds.size
        pairs = self.machine.at(np.repeat(volumes, count, axis=0), np.tile(self.speeds, volumes.shape[0]))
        return np.asarray(pairs.amplitude.reshape(-1, count) @ self.weights)


class RunupPeak(AlwaysExact):
    """Largest amplitude of a run-up in time.

    Parameters
    ----------
    scene : with a table `runup`
    cells : round each wall; the scene's if None
    """

    def __init__(self, scene: Scene, cells: int | None = None) -> None:
        from leblanc.studies.runup import across_gravity, drive_of, liquid_model, numerics_of, planned

        plan = planned(scene)
        self.scene, self.drive, self.gravity = scene, drive_of(plan), across_gravity(scene)
        self.numerics = numerics_of(plan, cells, check=False)
        self.model = runup_model(liquid_model(scene))
        self._known: dict[bytes, float] = {}

    def exact(self, volumes: Array, bound: float = math.inf) -> Array:
        """See `Vibration`; infinite for a run that did not come to its end."""
        return np.array([self._one(np.ascontiguousarray(row)) for row in volumes])

    def _one(self, volumes: Array) -> float:
        from leblanc.scene.scene import dry_rotor
        from solvers.runup.runup import run_up

        key = volumes.tobytes()
        if key not in self._known:
            friction, fills = self.scene.model.friction, with_volumes(self.scene, volumes).fills
            system = dry_rotor(self.scene).system()
            numerics, drive = self.numerics, self.drive
            run = run_up(system, fills, drive, friction, self.gravity, numerics, None, self.model)
            self._known[key] = float(run.amplitude.max()) if run.converged else math.inf
        return self._known[key]


class PeakOver(AlwaysExact):
    """Largest amplitude over a range of speeds, found between them as well [theory: optimum, eq. 3].

    Parameters
    ----------
    machine : with any volumes
    speeds : the range
    """

    def __init__(self, machine: FilledMachine, speeds: Speeds) -> None:
        self.machine, self.speeds = machine, speeds

    def exact(self, volumes: Array, bound: float = math.inf) -> Array:
        """See `Vibration`."""
        return self.machine.peaks(volumes, self.speeds)


@dataclass(frozen=True)
class OperatingCondition:
    """One of the conditions a machine must cope with.

    Parameters
    ----------
    unbalance : kg m
    temperature : K; None for that at which the scene's values hold
    """

    unbalance: float
    temperature: float | None


class Robust(AlwaysExact):
    """A quantile of the amplitudes at one speed over conditions [theory: optimum, eq. 4].

    Parameters
    ----------
    scene : a planar rotor
    speed : rad/s
    conditions : equally likely
    quantile : 1 for the worst case

    Raises
    ------
    InputError : another kind of rotor, a liquid whose properties over temperature are not known
    """

    def __init__(
        self, scene: Scene, speed: float, conditions: Sequence[OperatingCondition], quantile: float
    ) -> None:
        self.speed, self.quantile = speed, quantile
        made = [_in_condition(scene, condition) for condition in conditions]
        self.machines = [FilledMachine(changed) for changed, _ in made]
        self.growths = np.array([growth for _, growth in made])
        self.capacity = np.array([fill.chamber.capacity for fill in scene.fills])

    def exact(self, volumes: Array, bound: float = math.inf) -> Array:
        """See `Vibration`."""
        speed = np.full(volumes.shape[0], self.speed)
        rows = [
            machine.at(np.minimum(volumes * growth, self.capacity), speed).amplitude
            for machine, growth in zip(self.machines, self.growths, strict=True)
        ]
        return np.asarray(np.quantile(np.array(rows), self.quantile, axis=0, method="higher"))

    def fullest(self, volumes: Array) -> Array:
        """Largest share of a chamber that its liquid takes in any condition, shape (m,)."""
        return np.asarray((volumes[:, None, :] * self.growths / self.capacity).max(axis=(1, 2)))


def _in_condition(scene: Scene, condition: OperatingCondition) -> tuple[Scene, list[float]]:
    """The scene there, and by what factor the volume of each chamber's liquid grows."""
    if not isinstance(scene.rotor, JeffcottRotor):
        raise InputError("rotor.kind", scene.rotor.kind, "jeffcott for the objective robust")
    rotor = scene.rotor.altered(unbalance=condition.unbalance)
    if condition.temperature is None:
        return scene.altered(rotor=rotor), [1.0] * len(scene.fills)
    growth = [expansion(chamber.liquid, condition.temperature) for chamber in scene.chambers]
    warm = [
        chamber.altered(liquid=liquid_at(chamber.liquid, condition.temperature), volume=0.0)
        for chamber in scene.chambers
    ]
    return scene.altered(rotor=rotor, chambers=tuple(warm)), growth


def operating_conditions(
    own: float,
    unbalance: tuple[float, float] | None,
    temperature: tuple[float, float] | None,
    samples: int = 0,
    seed: int = 0,
) -> tuple[OperatingCondition, ...]:
    """Unbalances and temperatures that a machine must cope with.

    Parameters
    ----------
    own : the scene's unbalance, where no range is given, kg m
    unbalance, temperature : ranges, kg m and K
    samples, seed : so many at random, the same for the same seed; 0 for a grid of the ends and the middle
    """
    if samples > 0:
        share = np.random.default_rng(seed).random((samples, 2))
    else:
        thirds = np.array([0.0, 0.5, 1.0])
        share = np.array([(a, b) for a in thirds for b in thirds])
    low, high = unbalance or (own, own)
    loads = low + (high - low) * share[:, 0]
    if temperature is None:
        return tuple(OperatingCondition(load, None) for load in dict.fromkeys(loads.tolist()))
    cold, warm = temperature
    heats = cold + (warm - cold) * share[:, 1]
    pairs = dict.fromkeys(zip(loads.tolist(), heats.tolist(), strict=True))
    return tuple(OperatingCondition(load, heat) for load, heat in pairs)
