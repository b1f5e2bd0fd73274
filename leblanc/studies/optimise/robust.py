"""Amplitudes over operating conditions: unbalances and temperatures [theory: optimum, eq. 4, 9]."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fluid.liquid import expansion, liquid_at
from leblanc.scene.scene import Scene, require_whirl
from leblanc.scene.tasks import Optimisation, pairs_of
from leblanc.scene.unbalances import with_unbalances
from leblanc.studies.optimise.answer import ConditionTable
from leblanc.studies.optimise.filled import FilledMachine
from meshes.arrays import Array
from meshes.errors import InputError

Pair = tuple[float, float]

_SHARES = (0.0, 0.5, 1.0)  # of a range: its ends and its middle
MOST_CONDITIONS = 729  # of a grid: unbalances of five planes, each with a range of its own, and a temperature
DOUBLE = (0.5, 2.0)  # default range of unbalances over the scene's


@dataclass(frozen=True)
class OperatingCondition:
    """One of the conditions a machine must cope with."""

    unbalance: tuple[float, ...]  #: size of each of the rotor's unbalances, kg m
    temperature: float | None  #: K; None for that at which the scene's values hold


@dataclass(frozen=True)
class UnbalanceRange:
    """Sizes of a rotor's unbalances between least and most."""

    least: tuple[float, ...]  #: of each unbalance, kg m
    most: tuple[float, ...]
    together: bool  #: all grow by one factor; else each is anywhere in its range

    @property
    def ways(self) -> int:
        """How many numbers say where in the range the unbalances are."""
        return 1 if self.together else len(self.least)

    def at(self, shares: Sequence[float]) -> tuple[float, ...]:
        """Sizes where each is so far from its least to its most, or all of them alike."""
        along = shares if len(shares) == len(self.least) else [shares[0]] * len(self.least)
        return tuple(
            low + (high - low) * share for low, high, share in zip(self.least, self.most, along, strict=True)
        )


def unbalance_range(
    own: Sequence[float], wanted: Pair | tuple[Pair, ...] | None, default: Pair = (1.0, 1.0)
) -> UnbalanceRange:
    """The unbalances of a rotor over a range that a task gives, kg m.

    One range is that of the largest, with which all others grow by one factor; several are taken
    independently; None: factors of the rotor's own.
    """
    sizes = tuple(own)
    if not sizes:
        raise InputError("rotor.unbalances", "none", "at least one for the objective robust")
    if wanted is None:
        least, most = (tuple(factor * size for size in sizes) for factor in default)
        return UnbalanceRange(least, most, True)
    ranges = pairs_of(wanted)
    if ranges != (wanted,):
        if len(ranges) != len(sizes):
            raise InputError("optimise.unbalance", f"{len(ranges)} ranges", f"one, or {len(sizes)}")
        least, most = (tuple(span[k] for span in ranges) for k in (0, 1))
        return UnbalanceRange(least, most, len(sizes) == 1)
    largest = max(sizes)
    if len(sizes) > 1 and not largest > 0.0:
        text = "above 0 somewhere, where all grow with one range; or give a range for each"
        raise InputError("rotor.unbalances", 0.0, text)
    parts = [size / largest if largest > 0.0 else 1.0 for size in sizes]
    ((low, high),) = ranges
    return UnbalanceRange(tuple(low * part for part in parts), tuple(high * part for part in parts), True)


def operating_conditions(
    unbalance: UnbalanceRange, temperature: Pair | None, samples: int = 0, seed: int = 0
) -> tuple[OperatingCondition, ...]:
    """Unbalances and temperatures that a machine must cope with.

    So many samples at random, the same for the same seed; 0: a grid of the ends and the middle.
    """
    ways = unbalance.ways + 1
    if samples > 0:
        shares = np.random.default_rng(seed).random((samples, ways)).tolist()
    else:
        fixed = [low == high for low, high in zip(unbalance.least, unbalance.most, strict=True)]
        still = [all(fixed)] if unbalance.together else fixed
        axes = [(0.0,) if single else _SHARES for single in still]
        heated = temperature is not None and temperature[0] < temperature[1]
        axes.append(_SHARES if heated else (0.0,))
        count = math.prod(map(len, axes))
        if count > MOST_CONDITIONS:
            text = f"above 0, where a grid of the ranges has {count} conditions (at most {MOST_CONDITIONS})"
            raise InputError("optimise.samples", samples, text)
        shares = list(itertools.product(*axes))
    low, high = temperature or (0.0, 0.0)
    found = (
        OperatingCondition(
            unbalance.at(share[:-1]), None if temperature is None else low + (high - low) * share[-1]
        )
        for share in shares
    )
    return tuple(dict.fromkeys(found))


class Conditions:
    """A scene's machine with any volumes in each of several conditions.

    An `InputError` for a liquid whose properties are not known at these temperatures.
    """

    def __init__(self, scene: Scene, speed: float, conditions: Sequence[OperatingCondition]) -> None:
        self.speed, self.conditions = speed, tuple(conditions)
        self.scenes, growths = zip(*(in_condition(scene, own) for own in self.conditions), strict=True)
        self.growths = np.array(growths)
        self.capacity = np.array([fill.chamber.capacity for fill in scene.fills])

    @cached_property
    def machines(self) -> list[FilledMachine]:
        """One for each condition."""
        return [FilledMachine(scene) for scene in self.scenes]

    def held(self, volumes: Array, condition: int) -> Array:
        """Volumes in a condition, at most what the chambers hold, shape of `volumes`."""
        return np.asarray(np.minimum(volumes * self.growths[condition], self.capacity))

    def amplitudes(self, volumes: Array) -> Array:
        """Amplitude in each of n conditions with each of m sets of volumes, m, shape (n, m)."""
        speed = np.full(volumes.shape[0], self.speed)
        return np.array(
            [machine.at(self.held(volumes, k), speed).amplitude for k, machine in enumerate(self.machines)]
        )

    def fullest(self, volumes: Array) -> Array:
        """Largest share of a chamber that its liquid takes in any condition, shape (m,)."""
        return np.asarray((volumes[:, None, :] * self.growths / self.capacity).max(axis=(1, 2)))


def in_condition(scene: Scene, condition: OperatingCondition) -> tuple[Scene, list[float]]:
    """The scene in a condition, and by what factor the volume of each chamber's liquid grows."""
    require_whirl(scene)
    rotor = with_unbalances(scene.rotor, condition.unbalance)
    if condition.temperature is None:
        return scene.altered(rotor=rotor), [1.0] * len(scene.fills)
    growth = [expansion(chamber.liquid, condition.temperature) for chamber in scene.liquids]
    warm = [
        chamber.altered(liquid=liquid_at(chamber.liquid, condition.temperature), volume=0.0)
        for chamber in scene.liquids
    ]
    return scene.altered(rotor=rotor, chambers=tuple(warm)), growth


class Robust:
    """A quantile of the amplitudes at one speed over conditions [theory: optimum, eq. 4]."""

    def __init__(
        self, scene: Scene, speed: float, conditions: Sequence[OperatingCondition], quantile: float
    ) -> None:
        self.around, self.quantile = Conditions(scene, speed, conditions), quantile

    def exact(self, volumes: Array) -> Array:
        """As of a `Vibration`."""
        rows = self.around.amplitudes(volumes)
        return np.asarray(np.quantile(rows, self.quantile, axis=0, method="higher"))


_FINE, _COARSE = 25, 9  # points along the curve of a table; where an answer costs much


def condition_table(
    scene: Scene,
    task: Optimisation,
    robust: Robust,
    volume: Array,
    unbalance: UnbalanceRange,
    growth: Callable[[Scene, Array], float],
) -> ConditionTable:
    """What the machine does with the best volumes over the ranges of temperature and unbalance."""
    around = robust.around
    count = _FINE if around.machines[0].planar else _COARSE
    heated = task.temperature is not None and task.temperature[0] < task.temperature[1]
    spread = unbalance.least != unbalance.most
    shares = np.linspace(0.0, 1.0, 1 if not spread else 3 if heated else count)
    sizes = [unbalance.at([share] * unbalance.ways) for share in shares.tolist()]
    heats: list[float | None] = [None]
    if task.temperature is not None:
        heats = np.linspace(*task.temperature, count if heated else 1).tolist()
    grid = [OperatingCondition(size, heat) for heat in heats for size in sizes]
    shape = len(heats), len(sizes)
    own, nothing = volume[None], np.zeros((1, volume.size))
    over = Conditions(scene, around.speed, grid)
    whirls = [growth(over.scenes[k], over.held(volume, k)) for k in range(0, len(grid), len(sizes))]
    judged = around.amplitudes(own)[:, 0]
    # Without liquid no temperature changes the amplitude.
    bare = [OperatingCondition(size, None) for size in {c.unbalance for c in (*grid, *around.conditions)}]
    still = Conditions(scene, around.speed, bare).amplitudes(nothing)[:, 0].tolist()
    dry = {condition.unbalance: size for condition, size in zip(bare, still, strict=True)}
    value = float(robust.exact(own)[0])
    return ConditionTable(
        temperature=_known(heats),
        unbalance=np.array(sizes),
        amplitude=over.amplitudes(own).reshape(shape),
        stability_margin=-np.array(whirls),
        amplitude_dry=np.array([dry[size] for size in sizes]),
        condition_temperature=_known([condition.temperature for condition in around.conditions]),
        condition_unbalance=np.array([condition.unbalance for condition in around.conditions]),
        condition_amplitude=judged,
        condition_amplitude_dry=np.array([dry[condition.unbalance] for condition in around.conditions]),
        quantile=robust.quantile,
        decisive=int(np.argmin(np.abs(judged - value))) if math.isfinite(value) else int(np.argmax(judged)),
    )


def _known(temperatures: Sequence[float | None]) -> Array:
    return np.array([math.nan if heat is None else heat for heat in temperatures])


def filled_scenes(around: Conditions, volumes: Array) -> list[tuple[Scene, Array]]:
    """The machine at each temperature that occurs, with the volumes that it has there."""
    first = {condition.temperature: k for k, condition in reversed(list(enumerate(around.conditions)))}
    return [(around.scenes[k], around.held(volumes, k)) for k in first.values()]
