"""Unbalances and temperatures that a machine must cope with, and its vibration over them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fluid.liquid import expansion, liquid_at
from leblanc.scene.scene import JeffcottRotor, Scene
from leblanc.studies.optimise.answers import FilledMachine
from leblanc.studies.optimise.objectives import AlwaysExact
from meshes.arrays import Array
from meshes.errors import InputError


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

    @property
    def asked(self) -> int:
        """How many pairs of volumes and condition were answered."""
        return sum(machine.asked for machine in self.machines)

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
