"""Responses of a machine with other volumes of liquid; no pair of volumes and speed is solved twice."""

from __future__ import annotations

import math
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Generic, TypeVar

import numpy as np

from fluid.waves import capture_speed
from leblanc.liquid.choose import Prepared, axial_gravity, is_cut, models_at, prepare
from leblanc.liquid.models import synchronous_model
from leblanc.liquid.validity import require_supported
from leblanc.scene.scene import JeffcottRotor, Scene, Speeds, dry_rotor, jeffcott
from leblanc.studies.peaks import responses_between, wet_resonances
from meshes.arrays import Array, Flags
from solvers.rotor.balance_quality import balance_quality
from solvers.rotor.vibration import orbit
from solvers.statics.hydrostatics import equilibrium
from solvers.synchronous.peaks import highest, seeds
from solvers.synchronous.resonances import planar_tops
from solvers.synchronous.response import (
    Response,
    by_speed,
    fill_responses,
    joined,
    machine_responses,
    response,
)

AT_ONCE = 4000  # pairs; more at once would only take memory
FEW = 24  # speeds from which the peak of a rotor that tilts is refined
V = TypeVar("V")


class Once(Generic[V]):
    """Values of a function of one set of volumes, shape (c,), none of which is computed twice.

    On so many threads, where the function lets others run.
    """

    def __init__(self, function: Callable[[Array], V], threads: int = 1) -> None:
        self.function, self.threads = function, threads
        self._known: dict[bytes, V] = {}

    def __call__(self, volumes: Array) -> list[V]:
        """Values of m sets, shape (m, c)."""
        rows = np.ascontiguousarray(volumes)
        new = {key: row for row in rows if (key := row.tobytes()) not in self._known}
        if len(new) > 1 and self.threads > 1:
            with ThreadPoolExecutor(self.threads) as pool:
                self._known |= dict(zip(new, pool.map(self.function, new.values()), strict=True))
        else:
            for key, row in new.items():
                self._known[key] = self.function(row)
        return [self._known[row.tobytes()] for row in rows]


@dataclass(frozen=True)
class FillAnswers:
    """Amplitude and liquid at pairs of volumes and speed, shape (m,)."""

    amplitude: Array  #: m; infinite where it has no bound or was not found
    dry_patch: Array  #: 1 where the wall is dry somewhere, else 0
    #: largest share of the way from a wall to its chamber's inner edge that the liquid reaches; 0 without
    #: such edges, and of a clear ring, whose liquid comes farther than that of compartments [theory: optimum,
    #: eq. 12]
    reach: Array


class FilledMachine:
    """A scene's machine with any volumes in its chambers."""

    def __init__(self, scene: Scene) -> None:
        require_supported(scene)
        # One model for all volumes: a change of model within its tolerance would look like a better volume.
        liquid = "statics" if scene.model.liquid == "auto" else scene.model.liquid
        model = scene.model.altered(liquid=liquid)
        self.scene = scene.altered(optimise=None, runup=None, programme=None, model=model)
        self._rotor = dry_rotor(self.scene)
        self._known: dict[tuple[bytes, float], tuple[float, float, float]] = {}
        self._peaks: dict[tuple[bytes, float, float], float] = {}

    @property
    def planar(self) -> bool:
        """The rotor moves in one plane, so that a single speed costs no more than its share of many."""
        return isinstance(self.scene.rotor, JeffcottRotor)

    def at(self, volumes: Array, speed: Array) -> FillAnswers:
        """Answers at m pairs."""
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
            answer = self._planar if self.planar else self._others
            amplitude, dry, moved = answer(rows[which], speed[which])
            amplitude = np.where(np.isnan(amplitude), math.inf, amplitude)
            reach = self._reach(rows[which], speed[which], moved)
            for (key, _), *values in zip(part, amplitude.tolist(), dry.tolist(), reach.tolist(), strict=True):
                size, dried, reached = values
                self._known[key] = size, float(dried), reached
        found = np.array([self._known[key] for key in keys]).reshape(-1, 3)
        return FillAnswers(*found.T)

    def peaks(self, volumes: Array, speeds: Speeds) -> Array:
        """Largest amplitudes over the speeds of a range at which annular layers exist, at any of them.

        m, shape (m,), of volumes (m, c), m^3.
        """
        rows = np.ascontiguousarray(volumes)
        keys = [(row.tobytes(), speeds.start, speeds.stop) for row in rows]
        fresh = list(
            {key: k for k, key in reversed(list(enumerate(keys))) if key not in self._peaks}.values()
        )
        fresh.sort()
        if fresh:
            found = self._planar_peaks if self.planar else self._other_peaks
            begin = self.first_speed(speeds)
            for k, size in zip(fresh, found(rows[fresh], begin, speeds.stop).tolist(), strict=True):
                self._peaks[keys[k]] = math.inf if math.isnan(size) else size
        return np.array([self._peaks[key] for key in keys])

    def first_speed(self, speeds: Speeds) -> float:
        """First speed of a range that counts, rad/s: below it gravity leaves no annular layer, however thin.

        One for all volumes, none included: a peak must not look lower because more of the range is left out.
        All of a range below it counts, for lack of a better answer.
        """
        if self.scene.rotor.axis == "vertical" or self.scene.gravity == 0.0 or not self.scene.fills:
            return speeds.start
        walls = [fill.chamber.radius for fill in self.scene.fills]
        stands = max(float(capture_speed(radius, self.scene.gravity)) for radius in walls)
        return speeds.start if stands >= speeds.stop else max(speeds.start, math.nextafter(stands, math.inf))

    def _planar_peaks(self, volumes: Array, start: float, stop: float) -> Array:
        """The top of each resonance curve; where it lies outside the range, an end of the range."""
        rotor, gravity = jeffcott(self.scene), np.full(volumes.shape[0], axial_gravity(self.scene))
        scenes = [with_volumes(self.scene, row) for row in volumes]
        names = np.array([model_name(filled) for filled in scenes])
        speed, found = np.full((2, names.size), np.nan)
        for name in np.unique(names).tolist():
            own = np.flatnonzero(names == name)
            machines = [(rotor, scenes[k].fills) for k in own.tolist()]
            tops = planar_tops(machines, gravity[own], synchronous_model(name))
            speed[own], found[own] = tops.speed, tops.amplitude
        outside = np.flatnonzero(~((speed >= start) & (speed <= stop)))
        if outside.size:
            ends = np.tile([start, stop], outside.size)
            found[outside] = (
                self.at(np.repeat(volumes[outside], 2, axis=0), ends).amplitude.reshape(-1, 2).max(1)
            )
        return found

    def _other_peaks(self, volumes: Array, start: float, stop: float) -> Array:
        """The same of rotors that tilt, each refined from a few speeds and those of its resonances."""
        machines = [self._near_peaks(row, start, stop) for row in volumes]
        names = np.concatenate([names for names, _ in models_at(machines)])
        models = [synchronous_model(name) for name in names.tolist()]
        owner = np.repeat(np.arange(len(machines)), [machine.speed.size for machine in machines])
        speed = np.concatenate([machine.speed for machine in machines])
        sets = [machine.scene.fills for machine in machines]
        every = fill_responses(self._rotor, sets, owner, speed, machines[0].axial_gravity, models)
        answers = [every.at(np.flatnonzero(owner == k)) for k in range(len(machines))]
        between = responses_between(machines, answers, dry=False)
        found = [by_speed(pair) for pair in zip(answers, between, strict=True)]
        return np.array([highest(own.speed, own.amplitude).amplitude for own in found])

    def answer_over(self, volumes: Array, speeds: Speeds) -> Response:
        """Response with one set of volumes over a range of speeds, its peaks among them."""
        machine = self._near_peaks(volumes, speeds.start, speeds.stop)
        models = [synchronous_model(name) for name in models_at([machine])[0][0].tolist()]
        fills, gravity = machine.scene.fills, machine.axial_gravity
        answer = response(machine.rotor, fills, machine.speed, gravity, models)
        (between,) = responses_between([machine], [answer], dry=False)
        return by_speed([answer, between])

    def _near_peaks(self, volumes: Array, start: float, stop: float) -> Prepared:
        """The machine at a few speeds of a range, and at the resonances where a rotor tilts."""
        few = np.linspace(start, stop, FEW) if stop > start else np.array([start])
        machine = replace(prepare(with_volumes(self.scene, volumes)), speed=few)
        if self.planar:
            return machine
        near = wet_resonances(machine)
        own = seeds(near.speed, near.half_width, start, stop, few, whole=False)
        return replace(machine, speed=np.union1d(few, own))

    def _reach(self, volumes: Array, speed: Array, moved: Array) -> Array:
        """See `FillAnswers`, at deflections of the chambers, m, shape (m, c)."""
        reach, gravity = np.zeros(speed.size), axial_gravity(self.scene)
        for j, fill in enumerate(self.scene.fills):
            chamber = fill.chamber
            if chamber.inner_radius > 0.0:
                wet = np.flatnonzero(volumes[:, j] > 0.0)
                bounded = wet[np.isfinite(moved[wet, j])]
                state = equilibrium(chamber, volumes[bounded, j], moved[bounded, j], speed[bounded], gravity)
                own = np.where(volumes[:, j] > 0.0, math.inf, 0.0)
                own[bounded] = state.farthest_depth / (chamber.radius - chamber.inner_radius)
                reach = np.maximum(reach, own)
        return reach

    def _planar(self, volumes: Array, speed: Array) -> tuple[Array, Flags, Array]:
        """Amplitude, dry wall and deflections at m pairs; self-excited whirls are evaluated apart."""
        different, owner = np.unique(volumes, axis=0, return_inverse=True)
        rotor, owner = jeffcott(self.scene), owner.reshape(-1)
        scenes = [with_volumes(self.scene, row) for row in different]
        machines = [(rotor, filled.fills) for filled in scenes]
        gravity = np.full(len(machines), axial_gravity(self.scene))
        names = np.array([model_name(filled) for filled in scenes])[owner]
        parts, places = [], []
        for name in np.unique(names).tolist():
            own = np.flatnonzero(names == name)
            parts.append(
                machine_responses(machines, owner[own], speed[own], gravity, synchronous_model(name))
            )
            places.append(own)
        found = joined(parts).at(np.argsort(np.concatenate(places), kind="stable"))
        amplitude = np.abs(found.deflection)
        return amplitude, found.dry_patch, np.repeat(amplitude[:, None], volumes.shape[1], axis=1)

    def _others(self, volumes: Array, speed: Array) -> tuple[Array, Flags, Array]:
        """The same of rotors that tilt, as `run` reports them."""
        scenes = [with_volumes(self.scene, row) for row in volumes]
        sets = [filled.fills for filled in scenes]
        models, gravity = (
            [synchronous_model(model_name(filled)) for filled in scenes],
            axial_gravity(self.scene),
        )
        # A pair's answer must not depend on which others are asked for: each is a set of its own.
        found = fill_responses(self._rotor, sets, np.arange(speed.size), speed, gravity, models)
        system = self._rotor.system()
        moved = [np.abs(orbit(system, found.coordinates, fill.chamber.plane).forward) for fill in sets[0]]
        return found.amplitude, found.dry_patch, np.stack(moved, axis=1)


class QualityAtSpeed:
    """Total unbalance over the rotor's mass, times the speed [theory: balance_quality, eq. 1-3]."""

    def __init__(self, machine: FilledMachine, speed: float) -> None:
        self.machine, self.speed, self._each = machine, speed, Once(self._one)

    def of(self, volumes: Array) -> Array:
        """With m sets of volumes, m/s; infinite where the motion is, shape (m,)."""
        if not self.machine.planar:
            return np.array(self._each(volumes))
        rotor, omega = jeffcott(self.machine.scene), np.array([self.speed])
        held = float(np.abs(rotor.dynamic_stiffness(omega))[0])
        amplitude = self.machine.at(volumes, np.full(volumes.shape[0], self.speed)).amplitude
        return np.asarray(held * amplitude / (rotor.mass * self.speed))

    def dry(self) -> float:
        """The same without liquid, m/s."""
        return float(balance_quality(dry_rotor(self.machine.scene), [self.speed])[0])

    def _one(self, volumes: Array) -> float:
        """Of a rotor that tilts."""
        scene = self.machine.scene
        rotor, filled = dry_rotor(scene), with_volumes(scene, volumes)
        model = synchronous_model(model_name(filled))
        found = response(rotor, filled.fills, [self.speed], axial_gravity(scene), model)
        return float(balance_quality(rotor, [self.speed], found.coordinates)[0])


def with_volumes(scene: Scene, volumes: Array) -> Scene:
    """A scene with other volumes in its chambers."""
    pairs = zip(scene.liquids, volumes.tolist(), strict=True)
    return scene.altered(chambers=tuple(chamber.holding(volume) for chamber, volume in pairs))


def model_name(scene: Scene) -> str:
    """Liquid model that answers for a scene's volumes: linear theory where baffles cut the liquid."""
    return "linear" if is_cut(scene) and scene.model.liquid != "fem" else scene.model.liquid
