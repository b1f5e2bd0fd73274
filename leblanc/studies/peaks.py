"""The response of machines between the speeds that were asked for, where its amplitude may be largest.

What is known of a machine says where to look first: the top of its resonance curve where it is planar, its
resonances with and without liquid where it is not. From there `solvers.synchronous.peaks` refines.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from leblanc.liquid.choose import Prepared, captured_speed, models_at, models_of
from leblanc.liquid.models import synchronous_model
from meshes.arrays import Array, Complex, Flags, Index
from solvers.checked_model import CheckedModel
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.vibration import orbit, unbalance_response
from solvers.synchronous.coupled import Near
from solvers.synchronous.models import LINEAR
from solvers.synchronous.peaks import Answer, Samples, refine, seeds
from solvers.synchronous.planar import divide
from solvers.synchronous.resonances import Tops, planar_tops, resonances
from solvers.synchronous.response import Response, by_speed, fill_responses, joined, machine_responses

_UNDAMPED = 1e-8  # half width over speed of a resonance that nothing damps
_NEAR, _NEARER = 1e-4, 1e-6  # relative distances over which its amplitude grows as one over the distance
_GROWN = 30.0  # times, at least
_TWIN = 1e-12  # relative distance of two resonances that are one
_ASIDE = 3e-9  # relative distance of a speed that is taken for the resonance
_EDGE = 1e-9  # relative distance of two speeds, one on each side of where an answer begins to hold
_EDGE_ROUNDS = 14  # in which such two come together
_EDGE_PARTS = np.arange(1, 8) / 8.0  # asked at once: which costs little more than one


@dataclass(frozen=True)
class Resonances:
    """Where a machine may have its peak."""

    speed: Array  #: rad/s; the latter nan where another one shows the shape, shape (k,)
    half_width: Array
    bound: float = math.inf  #: what no amplitude exceeds, m; infinite where that is not known


class Asked(Protocol):
    """Machines that answer at any speed, each by its index."""

    @property
    def dry(self) -> Sequence[Resonances]:
        """Resonances of each machine without liquid."""
        ...

    @property
    def wet(self) -> Sequence[Resonances]:
        """The same with its liquid."""
        ...

    def without_liquid(self, owner: Index, speed: Array) -> Complex:
        """Parts of the deflections of the dry rotors, m, shape (m, 2)."""
        ...

    def with_liquid(self, owner: Index, speed: Array, close: bool) -> Response:
        """Responses by the liquid model that is chosen at each speed, which may be close to known ones."""
        ...


def responses_between(
    machines: Sequence[Prepared], answers: Sequence[Response], dry: bool = True, drawn: bool = False
) -> list[Response]:
    """Responses of machines at as many further speeds as it takes to find their largest amplitudes.

    Between the first and the last speed of each, by rising speed; at none where it has just one. Deflections
    are infinite without a bound. Where the answer holds at some speeds alone, the largest amplitude of those
    is found too. `drawn`: show the shape of the resonances.
    """
    nowhere = np.zeros(0, dtype=np.intp)
    if all(machine.speed[-1] <= machine.speed[0] for machine in machines):
        return [answer.at(nowhere) for answer in answers]
    own = any(isinstance(machine.waves, CheckedModel) for machine in machines)
    if own and len(machines) > 1:
        pairs = zip(machines, answers, strict=True)
        return [responses_between([one], [known], dry, drawn)[0] for one, known in pairs]
    planar = isinstance(machines[0].rotor, Jeffcott) and not own
    asked: Asked = _Planar(machines) if planar else _Other(machines, answers)
    ends = [(float(machine.speed[0]), float(machine.speed[-1])) for machine in machines]

    def wet_parts(owner: Index, speed: Array) -> Complex:
        return asked.with_liquid(owner, speed, close=True).parts

    endless_dry = _without_bound(asked.without_liquid, asked.dry, ends)
    endless_wet = _without_bound(wet_parts, asked.wet, ends)
    found = [[answer.at(nowhere)] for answer in answers]

    def still(owner: Index, speed: Array) -> Complex:
        return _marked(asked.without_liquid(owner, speed), _met(endless_dry, owner, speed))

    def wet(owner: Index, speed: Array, close: bool = True) -> Response:
        """Answer with liquid, which is kept."""
        answer = asked.with_liquid(owner, speed, close)
        endless = _met(endless_wet, owner, speed)
        answer = replace(
            answer,
            deflection=_marked(answer.parts, endless)[:, 0],
            deflection_dry=_marked(answer.parts_dry, _met(endless_dry, owner, speed))[:, 0],
            converged=answer.converged & ~endless,
        )
        for k in np.unique(owner).tolist():
            found[k].append(answer.at(np.flatnonzero(owner == k)))
        return answer

    def wet_of(k: int, speed: Array) -> Response:
        return wet(np.full(speed.size, k, dtype=np.intp), speed)

    seen = [np.zeros(0) for _ in ends]
    if dry:
        begin = [Samples(answer.speed, answer.parts_dry) for answer in answers]
        seen = [samples.speed for samples in _explored(still, still, begin, asked.dry, seen, ends, drawn)]
    begin = [Samples(answer.speed, answer.parts) for answer in answers]
    _explored(
        lambda owner, speed: wet(owner, speed, close=False).parts,
        *(lambda owner, speed: wet(owner, speed).parts, begin, asked.wet, seen, ends, drawn),
    )
    for k, answer in enumerate(answers):
        every = by_speed([answer, *found[k]])
        _holding(partial(wet_of, k), every, asked.wet[k].bound, captured_speed(machines[k].scene))
    return [by_speed(parts) for parts in found]


def _holding(
    answer: Callable[[Array], Response], known: Response, bound: float, carried_from: float | None
) -> None:
    """Ask a machine for the largest amplitude of the speeds at which its answer holds.

    Where that is beside a speed at which it does not hold, the edge between the two is closed in on. Mostly
    it is where the liquid begins to ride with the drum.
    """
    out = ~known.holds & ~np.isnan(known.amplitude)
    if not out.any() or not known.holds.any():
        return

    def parts(_: Index, speed: Array) -> Complex:
        nonlocal known
        fresh = np.setdiff1d(speed, known.speed)  # what does not hold is asked for again
        if fresh.size:
            known = by_speed([known, answer(fresh)])
        own = known.at(np.searchsorted(known.speed, speed))
        return np.where(own.holds[:, None], own.parts, np.nan)

    refine(parts, [Samples(known.speed, np.where(known.holds[:, None], known.parts, np.nan))], [bound])
    for _ in range(_EDGE_ROUNDS):
        top = known.top
        assert top is not None
        sides = [k for k in (top - 1, top + 1) if 0 <= k < known.speed.size and not known.holds[k]]
        here = known.speed[top]
        wide = [known.speed[k] - here for k in sides if abs(known.speed[k] - here) > _EDGE * here]
        if not wide:
            break
        looks = here + np.outer(wide, _EDGE_PARTS).ravel()
        if carried_from is not None:
            beside = carried_from * (1.0 + 0.01 * _EDGE * np.array([-1.0, 1.0]))
            looks = np.append(looks, beside[(beside > known.speed[0]) & (beside < known.speed[-1])])
            carried_from = None
        parts(np.zeros(1, dtype=np.intp), np.unique(looks))


def _explored(
    first: Answer,
    answer: Answer,
    samples: Sequence[Samples],
    near: Sequence[Resonances],
    more: Sequence[Array],
    ends: Sequence[tuple[float, float]],
    drawn: bool,
) -> list[Samples]:
    """Samples of each machine with those at its resonances, at more speeds, and at the peak.

    The first speeds are apart; later ones close in on answers that are known.
    """
    fresh = []
    for own, resonance, others, (start, stop) in zip(samples, near, more, ends, strict=True):
        # Where a bound is known, it is the height of a top: its place is enough.
        width = resonance.half_width if drawn or math.isinf(resonance.bound) else 0.0 * resonance.half_width
        here = seeds(resonance.speed, width, start, stop, own.speed, drawn)
        fresh.append(np.setdiff1d(_distinct(here, others), own.speed))
    owner = np.repeat(np.arange(len(fresh)), [speed.size for speed in fresh])
    if owner.size:
        parts = first(owner, np.concatenate(fresh))
        samples = [own.joined(fresh[k], parts[owner == k]) for k, own in enumerate(samples)]
    return refine(answer, samples, [resonance.bound for resonance in near])


def _distinct(first: Array, others: Array) -> Array:
    """The speeds of both, rising, without twins: between two a few roundings apart rounding makes a top."""
    found = first[np.diff(first, prepend=-np.inf) > _TWIN * first]
    apart = np.abs(others[:, None] - found).min(axis=1, initial=np.inf) > _TWIN * others
    return np.union1d(found, others[apart])


def _without_bound(
    answer: Answer, near: Sequence[Resonances], ends: Sequence[tuple[float, float]]
) -> list[Array]:
    """Speeds of each machine at which its amplitude has no bound, rad/s.

    There it grows as one over the distance.
    """
    found = []
    for k, (own, (start, stop)) in enumerate(zip(near, ends, strict=True)):
        sharp = (own.half_width <= _UNDAMPED * own.speed) & (own.speed >= start) & (own.speed <= stop)
        speed = np.unique(own.speed[sharp])
        if speed.size:
            beside = np.array([-_NEAR, -_NEARER, _NEARER, _NEAR])[:, None]
            every = (speed * (1.0 + beside)).ravel()
            parts = answer(np.full(every.size, k, dtype=np.intp), every)
            below, nearer, nearest, above = np.abs(parts).sum(axis=1).reshape(4, -1)
            speed = speed[np.maximum(nearer, nearest) >= _GROWN * np.maximum(below, above)]
        found.append(speed)
    return found


def _met(endless: Sequence[Array], owner: Index, speed: Array) -> Flags:
    """Which pairs of a machine and a speed have no bound, shape (m,)."""
    found = np.zeros(speed.size, dtype=bool)
    for k in np.unique(owner).tolist():
        if endless[k].size:
            distance = np.abs(speed[owner == k, None] - endless[k]).min(axis=1)
            found[owner == k] = distance <= _TWIN * speed[owner == k]
    return found


def _marked(parts: Complex, endless: Flags) -> Complex:
    """Forward and backward parts, the forward one infinite where there is no bound."""
    return np.where(endless[:, None], np.array([complex(np.inf, 0.0), 0.0]), parts)


class _Planar:
    """Planar machines, many at once."""

    def __init__(self, machines: Sequence[Prepared]) -> None:
        self.machines = machines
        self.rotors = [(machine.planar, machine.scene.fills) for machine in machines]
        self.gravity = np.array([machine.axial_gravity for machine in machines])
        self.dry = _at_tops([planar_tops([(rotor, ()) for rotor, _ in self.rotors], self.gravity, LINEAR)])
        # Where the model is chosen, the one that answers near the top may answer at none of the given speeds.
        names = dict.fromkeys(name for machine in machines for name in models_of(machine.scene))
        models = [synchronous_model(name) for name in names]
        self.wet = _at_tops([planar_tops(self.rotors, self.gravity, model) for model in models])

    def without_liquid(self, owner: Index, speed: Array) -> Complex:
        """See `Asked`."""
        rotors = np.array([(r.mass, r.stiffness, r.damping, r.unbalance) for r, _ in self.rotors])
        mass, stiffness, damping, unbalance = rotors[owner].T
        squared = np.square(speed)
        deflection = divide(unbalance * squared, stiffness - mass * squared + 1j * damping * speed)
        return np.stack((deflection, np.zeros_like(deflection)), axis=1)

    def with_liquid(self, owner: Index, speed: Array, close: bool) -> Response:
        """See `Asked`."""
        names, carried = _models(self.machines, owner, speed)
        parts, places = [], []
        for name in np.unique(names).tolist():
            own = np.flatnonzero(names == name)
            model = synchronous_model(name)
            parts.append(machine_responses(self.rotors, owner[own], speed[own], self.gravity, model))
            places.append(own)
        answer = joined(parts).at(np.argsort(np.concatenate(places)))
        return replace(answer, in_range=answer.in_range & carried)


def _models(machines: Sequence[Prepared], owner: Index, speed: Array) -> tuple[NDArray[np.str_], Flags]:
    """Liquid model at pairs of a machine and a speed, and whether the liquid rides with the drum there."""
    present = np.unique(owner)
    rows = [np.flatnonzero(owner == k) for k in present.tolist()]
    pairs = zip(present.tolist(), rows, strict=True)
    chosen = models_at([replace(machines[k], speed=speed[own]) for k, own in pairs])
    order = np.argsort(np.concatenate(rows))
    names, carried = (np.concatenate(values)[order] for values in zip(*chosen, strict=True))
    return names, carried


def _at_tops(tops: Sequence[Tops]) -> list[Resonances]:
    """Resonances of planar machines, each with its top by every model."""
    found = []
    for k in range(tops[0].speed.size):
        speed, size, half_width = np.array([(t.speed[k], t.amplitude[k], t.half_width[k]) for t in tops]).T
        known = np.isfinite(speed)
        bound = float(size.max()) if known.all() else math.inf
        found.append(Resonances(speed[known], half_width[known], bound))
    return found


def _beside(speed: Array, half_width: Array) -> Resonances:
    """Resonances, those that nothing damps moved a little: at the very speed no answer can be computed."""
    sharp = half_width <= _UNDAMPED * speed
    return Resonances(np.where(sharp, speed * (1.0 + _ASIDE), speed), half_width)


class _Other:
    """Machines of one rotor that is not planar, each with its volumes."""

    def __init__(self, machines: Sequence[Prepared], answers: Sequence[Response]) -> None:
        self.machines, self.position = machines, answers[0].position
        first = machines[0]
        self.dry = [_beside(*resonances(first.system, []))] * len(machines)
        self.wet = [
            _with_folds(wet_resonances(machine), own) for machine, own in zip(machines, answers, strict=True)
        ]
        self._known = list(answers)

    def without_liquid(self, owner: Index, speed: Array) -> Complex:
        """See `Asked`."""
        system = self.machines[0].system
        found = orbit(system, unbalance_response(system, speed), self.position)
        return np.stack((found.forward, found.backward), axis=1)

    def with_liquid(self, owner: Index, speed: Array, close: bool) -> Response:
        """See `Asked`."""
        names, carried = _models(self.machines, owner, speed)
        first, sets = self.machines[0], [machine.scene.fills for machine in self.machines]
        models, near = [synchronous_model(name) for name in names.tolist()], self._near(owner, speed, close)
        answer = fill_responses(
            first.rotor, sets, owner, speed, first.axial_gravity, models, self.position, near
        )
        for k in np.unique(owner).tolist():
            self._known[k] = by_speed([self._known[k], answer.at(np.flatnonzero(owner == k))])
        return replace(answer, in_range=answer.in_range & carried)

    def _near(self, owner: Index, speed: Array, close: bool) -> Near:
        """All branches at the next speeds below and above."""
        tables = [known.branch_coordinates for known in self._known]
        most, n = max(table.shape[1] for table in tables), tables[0].shape[2]
        found = np.full((speed.size, 2, most, n), complex(np.nan, np.nan))
        places = np.empty((speed.size, 2))
        for k in np.unique(owner).tolist():
            known, rows = self._known[k].speed, np.flatnonzero(owner == k)
            above = np.clip(np.searchsorted(known, speed[rows]), 1, known.size - 1)
            sides = np.stack((above - 1, above), axis=1)
            places[rows], found[rows, :, : tables[k].shape[1]] = known[sides], tables[k][sides]
        return Near(places, found, enough=close)


def wet_resonances(machine: Prepared) -> Resonances:
    """Of a rotor that is not planar, wet all over, and with a wall so dry that the liquid is a dead mass."""
    fills = machine.scene.fills
    whole = sum(fill.added_mass for fill in fills)
    shares = (1.0, sum(fill.mass for fill in fills) / whole) if whole > 0.0 else (1.0,)
    near = [resonances(machine.system, fills, share) for share in shares]
    speed, half_width = (np.concatenate(values) for values in zip(*near, strict=True))
    return _beside(speed, half_width)


def _with_folds(near: Resonances, answer: Response) -> Resonances:
    """Resonances, and the speeds at which branches end."""
    ends = answer.fold_speed[np.isfinite(answer.fold_speed)]
    half_width = np.concatenate((near.half_width, np.full(ends.size, np.nan)))
    return Resonances(np.concatenate((near.speed, ends)), half_width)
