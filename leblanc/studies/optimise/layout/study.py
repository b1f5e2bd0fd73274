"""Places and directions of a tub's mounts that uncouple its motions, or keep its resonances away.

[theory: rotor, eq. 36-38; DR18, section 2]
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from leblanc.core.progress import update
from leblanc.scene.scene import Scene, TubRotor
from leblanc.scene.tasks import Layout, Optimisation
from leblanc.studies.optimise.answer import ConstraintValue, about
from leblanc.studies.optimise.layout.answer import LayoutAnswer, MountPlace
from meshes.arrays import Array, Flags, Index
from meshes.errors import InputError
from solvers.rotor.layout import (
    Mounts,
    centre_of_mass,
    couplings,
    mass_matrix,
    natural_frequencies,
    sag,
)
from solvers.rotor.tub import Tub
from solvers.search import evolve

_MIRRORED = np.array([-1.0, 1.0, 1.0])
_SAME = 1e-9  # m or relative, of places and directions that are one
_POPULATION, _GENERATIONS = 12, 400  # of the search: members a variable, generations at most
_SETTLED = 1e-9  # spread of a population that has come together
_SAG = 1.1  # times the scene's own sag, where no limit is given
_REFUSED = 10.0  # objective of a layout whose springs give way, above those of all that hold


class Variable(NamedTuple):
    """One searched number: how far mounts move along `ways`, m, or lean to them, rad, shape (n, 3).

    Mounts are counted together, springs first; `most` is the largest change either way.
    """

    mounts: tuple[int, ...]
    ways: Array
    leans: bool
    most: float


@dataclass(frozen=True)
class Suspension:
    """A tub's mounts as a search moves them."""

    rotor: Tub  #: as it is
    every: Mounts  #: springs and dampers as one layout, springs first
    springs: int  #: how many springs
    variables: tuple[Variable, ...]  #: what is searched
    mirrored: bool  #: the mounts are alike on both sides of x = 0, and stay so
    origin: Array  #: centre of mass of tub and drum from that of the tub, m, shape (3,)
    weight: Array  #: of tub and drum, N, shape (3,)

    @property
    def mass(self) -> Array:
        """Mass matrix about the centre of mass, shape (6, 6)."""
        return mass_matrix(self.rotor, self.origin)

    def moved(self, change: Array) -> tuple[Mounts, Mounts]:
        """Springs and dampers with changes."""
        position = np.repeat(self.every.position, change.shape[0], axis=0)
        way = np.repeat(self.every.direction, change.shape[0], axis=0)
        for value, variable in zip(change.T, self.variables, strict=True):
            moved, size = (way, np.tan(value)) if variable.leans else (position, value)
            moved[:, variable.mounts] += size[:, None, None] * variable.ways
        way /= np.linalg.norm(way, axis=-1, keepdims=True)
        cut, e = self.springs, self.every
        return (
            Mounts(position[:, :cut], way[:, :cut], e.coefficient[:cut], e.along_axes[:cut]),
            Mounts(position[:, cut:], way[:, cut:], e.coefficient[cut:], e.along_axes[cut:]),
        )


def suspension_of(scene: Scene, task: Layout) -> Suspension:
    """The mounts of a scene's tub, what of them may move, and how far.

    Mounts at one place stay at one place: they are parts of one spring or damper.
    """
    if not isinstance(scene.rotor, TubRotor):
        raise InputError("rotor.kind", scene.rotor.kind, "tub for the objective layout")
    rotor = scene.rotor.machine()
    every = Mounts.of((*rotor.springs, *rotor.dampers))
    partner = _partners(every, len(rotor.springs))
    mirrored = bool(np.all(partner >= 0))
    down = np.array([0.0, -1.0, 0.0] if scene.rotor.axis == "vertical" else [0.0, 0.0, -1.0])
    return Suspension(
        rotor=rotor,
        every=every,
        springs=len(rotor.springs),
        variables=tuple(_variables(every, partner if mirrored else np.arange(partner.size), task)),
        mirrored=mirrored,
        origin=centre_of_mass(rotor),
        weight=rotor.mass * scene.gravity * down,
    )


def _partners(every: Mounts, springs: int) -> Index:
    """For each mount the one that is its mirror image in x = 0, itself included; -1 without one."""
    place, way = every.position[0], every.direction[0]
    kind = np.arange(place.shape[0]) < springs
    found = np.full(place.shape[0], -1)
    for k in range(place.shape[0]):
        if found[k] >= 0:
            continue
        there = (np.abs(place - place[k] * _MIRRORED).max(axis=1) <= _SAME) & (found < 0)
        alike = (kind == kind[k]) & (every.coefficient == every.coefficient[k])
        alike &= np.all(every.along_axes == every.along_axes[k], axis=1)
        # A line has no head: a direction and its opposite are one.
        along = np.abs(np.abs(way @ (way[k] * _MIRRORED)) - 1.0) <= _SAME
        fits = np.flatnonzero(there & alike & (along | (every.coefficient[k] == 0.0)))
        if fits.size:
            # One on the plane is its own image; of several alike each is taken once.
            image = k if k in fits else int(fits[0])
            found[k], found[image] = image, k
    return found


def _variables(every: Mounts, partner: Index, task: Layout) -> list[Variable]:
    """Places of groups of mounts that sit together, then directions of those that act along one.

    A mount that is its own partner stays in the plane x = 0 where the tub is mirrored; without a mirror every
    mount is its own partner.
    """
    place, way = every.position[0], every.direction[0]
    alone = bool(np.all(partner == np.arange(partner.size)) and np.any(np.abs(place[:, 0]) > _SAME))
    found, done = [], np.zeros(partner.size, dtype=bool)
    for k in range(partner.size):
        if done[k]:
            continue
        members = np.flatnonzero(np.abs(place - place[k]).max(axis=1) <= _SAME)
        there = np.flatnonzero(np.abs(place - place[k] * _MIRRORED).max(axis=1) <= _SAME)
        images = members[:0] if alone else np.setdiff1d(there, members)
        done[members] = done[images] = True
        both, signs = (*members.tolist(), *images.tolist()), np.ones((members.size + images.size, 3))
        signs[members.size :] = _MIRRORED
        for axis, most in enumerate(task.reach):
            if most > 0.0 and not (axis == 0 and not alone and abs(place[k, 0]) <= _SAME):
                found.append(Variable(both, signs * np.eye(3)[axis], False, most))
    done[:] = every.coefficient == 0.0
    for k in np.flatnonzero(~done & (task.turn > 0.0)).tolist():
        if done[k]:
            continue
        pair = (k,) if alone or partner[k] == k else (k, int(partner[k]))
        done[list(pair)] = True
        first, second = _across(way[k])
        # A line has no head: the partner's direction is the image of this one, or its opposite.
        sign = 1.0 if len(pair) == 1 else math.copysign(1.0, float(way[pair[1]] @ (way[k] * _MIRRORED)))
        leaning = [first] if not alone and len(pair) == 1 else [first, second]
        if not alone and len(pair) == 1 and abs(way[k, 0]) > _SAME:
            continue  # across the plane of the mirror: it leans no way without leaving it
        ways = [np.stack([lean, sign * lean * _MIRRORED])[: len(pair)] for lean in leaning]
        found += [Variable(pair, way, True, task.turn) for way in ways]
    return found


def _across(way: Array) -> tuple[Array, Array]:
    """Two unit vectors across a direction and each other, the first in the plane x = 0."""
    first = np.cross([1.0, 0.0, 0.0], way)
    size = float(np.linalg.norm(first))
    first = first / size if size > _SAME else np.array([0.0, 1.0, 0.0])
    return first, np.cross(way, first)


@dataclass(frozen=True)
class _Judged:
    """Layouts evaluated; m of them."""

    value: Array
    excess: Array
    stiffness: Array
    damping: Array


def _judge(held: Suspension, task: Layout, limit: float) -> Callable[[Array], _Judged]:
    """What a layout is worth, and by how much its springs give way more than they may, relative."""
    mass = held.mass

    def judged(change: Array) -> _Judged:
        springs, dampers = held.moved(change)
        stiffness, damping = springs.matrix(held.origin), dampers.matrix(held.origin)
        if task.measure == "couplings":
            value = np.square(couplings(stiffness)).sum(axis=1) + np.square(couplings(damping)).sum(axis=1)
        else:
            assert task.band is not None
            value = -separation(natural_frequencies(stiffness, mass), task.band)
        return _Judged(value, sag(stiffness, held.weight)[0] / limit - 1.0, stiffness, damping)

    return judged


def separation(frequency: Array, band: tuple[float, float]) -> Array:
    """Least distance of frequencies from a band of speeds, over its nearer end [theory: rotor, eq. 38]."""
    low, high = band
    return np.asarray(np.maximum((low - frequency) / low, (frequency - high) / high).min(axis=-1))


def optimise_layout(scene: Scene, task: Optimisation) -> LayoutAnswer:
    """Best places and directions of a tub's mounts within bounds, by differential evolution [SP97].

    The same seed gives the same layout.
    """
    wanted = task.layout or Layout()
    if wanted.band is None:
        wanted = wanted.altered(band=(scene.speeds.start, scene.speeds.stop))
    held = suspension_of(scene, wanted)
    if not held.variables:
        raise InputError("optimise.layout", "reach and turn of 0", "such that some mount may move")
    nothing = np.zeros((1, len(held.variables)))
    own = float(sag(held.moved(nothing)[0].matrix(held.origin), held.weight)[0, 0])
    if not math.isfinite(own):
        raise InputError(
            "rotor.springs", len(held.rotor.springs), "springs that hold the tub in all directions"
        )
    limit = wanted.sag if wanted.sag is not None else _SAG * own
    judge, most = _judge(held, wanted, limit), np.array([variable.most for variable in held.variables])
    count = 0

    def objective(change: Array) -> Array:
        nonlocal count
        count += change.shape[0]
        share = min(count / (_POPULATION * most.size * _GENERATIONS), 1.0)
        update(share, 1.0, f"{count} layouts evaluated")
        return _penalised(judge(change))

    bounds = list(zip(-most, most, strict=True))
    end = evolve(objective, bounds, nothing[0], task.seed, _POPULATION, _GENERATIONS, _SETTLED)
    best = _polished(judge, end, most)[None]
    judged = judge(nothing), judge(best)
    stiffness, damping = (
        np.concatenate([getattr(each, name) for each in judged]) for name in ("stiffness", "damping")
    )
    before, after = sag(stiffness, held.weight)[0].tolist()
    feasible = after <= limit * (1.0 + 1e-9)
    meaning = "how far tub and drum sink under their weight"
    return LayoutAnswer(
        **about(scene, task),
        measure=wanted.measure,
        band=wanted.band,
        value=float(judged[1].value[0]),
        baseline=float(judged[0].value[0]),
        constraints={"sag": ConstraintValue(limit, after, feasible, "m", meaning)},
        sag_before=before,
        mounts=tuple(_places(held, best)),
        stiffness_coupling=couplings(stiffness),
        damping_coupling=couplings(damping),
        mass_coupling=couplings(held.mass),
        frequency=natural_frequencies(stiffness, held.mass),
        origin=held.origin,
        mirrored=held.mirrored,
        evaluations=count,
    )


def _penalised(found: _Judged) -> Array:
    """One number to make least: a layout whose springs give way too much is worse than every other."""
    excess: Flags = found.excess > 0.0
    lost = np.where(np.isfinite(found.excess), np.minimum(found.excess, 1e6), 1e6)
    return np.where(excess, _REFUSED + lost, found.value)


def _polished(judge: Callable[[Array], _Judged], start: Array, most: Array) -> Array:
    """The end of the search, closer: by steps downhill within the bounds, where they keep the limit."""
    from scipy.optimize import minimize

    unit = np.maximum(most, 1e-300)
    found = minimize(
        lambda x: float(_penalised(judge((x * unit)[None]))[0]),
        start / unit,
        method="L-BFGS-B",
        bounds=[(-1.0, 1.0)] * start.size,
        options={"maxiter": 500, "ftol": 1e-30, "gtol": 1e-14},
    )
    ends = np.stack([start, np.clip(found.x, -1.0, 1.0) * unit])
    return np.asarray(ends[int(np.argmin(_penalised(judge(ends))))])


def _places(held: Suspension, best: Array) -> Iterator[MountPlace]:
    """Each mount where it is and where the best layout has it."""
    was, now = held.every, held.moved(best)
    position, direction = (
        np.concatenate([getattr(mounts, name)[0] for mounts in now]) for name in ("position", "direction")
    )
    for k in range(position.shape[0]):
        spring, acts = k < held.springs, was.coefficient[k] > 0.0
        yield MountPlace(
            name=f"spring {k + 1}" if spring else f"damper {k - held.springs + 1}",
            position=tuple(position[k].tolist()),
            position_before=tuple(was.position[0, k].tolist()),
            direction=tuple(direction[k].tolist()) if acts else None,
            direction_before=tuple(was.direction[0, k].tolist()) if acts else None,
        )
