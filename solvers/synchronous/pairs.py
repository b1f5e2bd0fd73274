"""Planar machines with liquid at spin speeds, as arrays over pairs of a machine and a speed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fluid.fill import Fills
from meshes.arrays import Array, Complex, Flags, Index
from solvers.liquid_model import LiquidModel, Whirls
from solvers.rotor.jeffcott import PlanarMachine


@dataclass(frozen=True)
class LiquidState:
    """All chambers of a machine together, shape (m,)."""

    unbalance: Array  #: first moment of the liquid about the rotation axis, kg m
    slope: Array  #: its derivative with respect to the deflection, kg
    dry_patch: Flags  #: of any, all and all chambers with liquid
    in_range: Flags
    converged: Flags


@dataclass(frozen=True)
class Slot:
    """One chamber of each pair that has one with liquid."""

    fills: Fills  #: of those pairs, shape (k,)
    place: Index  #: index into `fills` of each pair, -1 where it has no such chamber, shape (n,)
    #: deflection up to which the chamber adds its full mass, m; infinite where there is none, shape (n,)
    limit: Array


@dataclass(frozen=True)
class Pairs:
    """n pairs of a machine and a speed."""

    mass: Array  #: M, K, C, U0 of the rotor, SI, shape (n,)
    stiffness: Array
    damping: Array
    unbalance: Array
    speed: Array  #: spin speed Omega, rad/s, shape (n,)
    gravity: Array  #: along the axis, m/s^2, shape (n,)
    model: LiquidModel  #: of the liquid
    slots: tuple[Slot, ...]  #: one for each chamber of the machine that has most
    #: sums over the chambers of the liquid's mass, of the mass that it adds in a small whirl and at most, and
    #: of liquid mass times radius, shape (n,)
    liquid_mass: Array
    added_mass: Array
    steepest: Array
    reach: Array

    @property
    def dynamic_stiffness(self) -> Complex:
        """K - M Omega^2 + i C Omega of the dry rotors in the drum frame, N/m, shape (n,)."""
        elastic = self.stiffness - self.mass * np.square(self.speed)
        return np.asarray(elastic + 1j * self.damping * self.speed, dtype=complex)

    @property
    def limit(self) -> Array:
        """Deflection up to which every chamber adds its full mass, m, shape (n,)."""
        limits = [slot.limit for slot in self.slots]
        return np.min(limits, axis=0) if limits else np.full(self.speed.shape, np.inf)

    def liquid(self, deflection: Array, which: Index) -> LiquidState:
        """The liquid of some pairs at deflections, shape (m,)."""
        size, found = deflection.size, self.chambers(which)
        dry = np.zeros(size, dtype=bool)
        in_range, converged = np.ones((2, size), dtype=bool)
        if found is None:
            return LiquidState(np.zeros(size), np.zeros(size), dry, in_range, converged)
        rows, fills, _ = found
        own = which[rows]
        law = self.model.answer(
            fills, Whirls.synchronous(self.speed[own], deflection[rows], self.gravity[own])
        )
        np.logical_or.at(dry, rows, law.dry_patch)
        np.logical_and.at(in_range, rows, law.in_range)
        np.logical_and.at(converged, rows, law.converged)
        unbalance, slope = (_summed(rows, x, size) for x in (law.real_unbalance(), law.slope.real))
        return LiquidState(unbalance, slope, dry, in_range, converged)

    def pull(self, deflection: Array, which: Index) -> Array:
        """Liquid's pull beyond its mass at the chamber's centre, N, (m,); never falls with the deflection."""
        found = self.chambers(which)
        if found is None:
            return np.zeros(deflection.shape)
        rows, fills, limit = found
        e = deflection[rows]
        moment = self.model.added_mass(fills) * e
        bent = np.flatnonzero(e > limit)
        if bent.size:
            k = which[rows[bent]]
            whirls = Whirls.synchronous(self.speed[k], e[bent], self.gravity[k])
            moment[bent] = self.model.pull(fills.at(bent), whirls)
        total = _summed(rows, np.maximum(moment - fills.mass * e, 0.0), deflection.size)
        return np.asarray(np.square(self.speed[which]) * total)

    def chambers(self, which: Index) -> tuple[Index, Fills, Array] | None:
        """All chambers of some pairs at once: whose they are, and their limits; None if there are none.

        Once for many states, since a model takes little longer for these than for a few.
        """
        places = [slot.place[which] for slot in self.slots]
        rows = [np.flatnonzero(place >= 0) for place in places]
        if not any(having.size for having in rows):
            return None
        parts = zip(self.slots, places, rows, strict=True)
        fills = Fills.joined([slot.fills.at(place[having]) for slot, place, having in parts])
        limits = [slot.limit[which[having]] for slot, having in zip(self.slots, rows, strict=True)]
        return np.concatenate(rows), fills, np.concatenate(limits)


def _summed(rows: Index, values: Array, size: int) -> Array:
    """Sums of the values of each row, shape (size,)."""
    return np.asarray(np.bincount(rows, values, minlength=size), dtype=np.float64)


def pair_machines(
    machines: Sequence[PlanarMachine], owner: Index, speed: Array, gravity: Array, model: LiquidModel
) -> Pairs:
    """Arrays over pairs of a machine and a speed; empty fills are left out."""
    rotors = np.array([(r.mass, r.stiffness, r.damping, r.unbalance) for r, _ in machines]).reshape(-1, 4)
    wet = [[fill for fill in fills if fill.volume > 0.0] for _, fills in machines]
    own_gravity = gravity[owner]
    slots, sums = [], np.zeros((4, owner.size))
    for k in range(max(map(len, wet), default=0)):
        having = np.array([i for i, fills in enumerate(wet) if len(fills) > k], dtype=np.intp)
        fills = Fills.of([wet[i][k] for i in having])
        index = np.full(len(machines), -1, dtype=np.intp)
        index[having] = np.arange(having.size)
        place = index[owner]
        rows = np.flatnonzero(place >= 0)
        here = fills.at(place[rows])
        added, steepest = model.added_mass(here), model.steepest(here)
        sums[:, rows] += here.mass, added, steepest, here.mass * here.chamber.radius
        slots.append(Slot(fills, place, np.full(owner.shape, np.inf)))
    mass, stiffness, damping, unbalance = np.ascontiguousarray(rotors[owner].T)
    pairs = Pairs(
        *(mass, stiffness, damping, unbalance, speed, own_gravity, model, tuple(slots)),
        liquid_mass=sums[0],
        added_mass=sums[1],
        steepest=sums[2],
        reach=sums[3],
    )
    return replace(pairs, slots=_with_limits(pairs))


def _with_limits(pairs: Pairs) -> tuple[Slot, ...]:
    """The slots with the limits of all chambers, which the model is asked for at once."""
    everyone = np.arange(pairs.speed.size)
    found = pairs.chambers(everyone)
    if found is None:
        return pairs.slots
    rows, fills, _ = found
    limits = pairs.model.linear_limit(fills, pairs.speed[rows], pairs.gravity[rows])
    slots, first = [], 0
    for slot in pairs.slots:
        limit, there = slot.limit.copy(), slot.place >= 0
        count = int(np.count_nonzero(there))
        limit[there] = limits[first : first + count]
        first += count
        slots.append(replace(slot, limit=limit))
    return tuple(slots)
