"""Where every deflection of a planar machine lies, from closed forms.

Every deflection that satisfies the balance with the exact law lies between two bounds, which follow from the
linear answer and from a bound of what the law is below its straight line. Nothing is solved for
[theory: model_error].
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fluid.fill import Fills
from meshes.arrays import Array, Flags, Index
from solvers.statics.law_defect import Surfaces, defect_bound, upright_surfaces
from solvers.synchronous.errors import ROUNDING, LinearError, law_error
from solvers.synchronous.pairs import Pairs

_ROUNDS = 6  # of the bound on the largest deflection


@dataclass(frozen=True)
class Enclosure:
    """Where every synchronous deflection of planar machines lies, shape (n,).

    Parameters
    ----------
    linear : the answer of the linear law, m, infinite at an undamped resonance
    least, most : bounds of all the deflections under the exact law, m
    straight : deflection up to which the law is the linear one, m
    depth : of the shallowest layer, m
    defect : bound of what the law is below the linear one up to `most`, kg m
    added_mass : of all chambers, kg
    """

    linear: Array
    least: Array
    most: Array
    straight: Array
    depth: Array
    defect: Array
    added_mass: Array

    def error(self) -> LinearError:
        """Bounds of the relative errors [theory: model_error, eq. 15 and 16]."""
        still = self.linear == 0.0
        bounded = np.isfinite(self.linear) & np.isfinite(self.most)
        linear, least, most = (np.where(bounded, e, 0.0) for e in (self.linear, self.least, self.most))
        amplitude = _relative(linear, least, most, bounded)
        full, lost = self.added_mass, np.where(bounded, self.defect, 0.0)
        liquid = _relative(full * linear, full * least - lost, full * most, bounded)
        none = still | (self.added_mass == 0.0)
        strain = np.where(still, 0.0, np.inf)
        measured = (self.straight > 0.0) & np.isfinite(self.linear)
        np.divide(self.linear, self.straight, out=strain, where=measured)
        return LinearError(
            amplitude=np.where(still, 0.0, amplitude) + ROUNDING,
            liquid=np.where(none, 0.0, liquid) + ROUNDING,
            wet=self.most < self.depth,
            strain=strain,
        )


def _relative(value: Array, least: Array, most: Array, known: Flags) -> Array:
    """Largest |value/x - 1| for x between two bounds; infinite where the lower one is not above 0."""
    high, low = np.full(value.shape, np.inf), np.zeros(value.shape)
    np.divide(value, least, out=high, where=known & (least > 0.0))
    np.divide(value, most, out=low, where=known & (most > 0.0))
    return np.maximum(np.maximum(high - 1.0, 1.0 - low), 0.0)


@dataclass(frozen=True)
class Laws:
    """The chambers of n pairs of a machine and a speed.

    Parameters
    ----------
    fills, surfaces : of each chamber, at the pairs that have it
    rows : those pairs
    size : n
    """

    fills: tuple[Fills, ...]
    surfaces: tuple[Surfaces, ...]
    rows: tuple[Index, ...]
    size: int

    def defect(self, deflection: Array) -> Array:
        """Sum of the bounds of what the laws are below the linear one, kg m, shape (n,)."""
        total = np.zeros(self.size)
        for surfaces, rows in zip(self.surfaces, self.rows, strict=True):
            total[rows] += defect_bound(surfaces, deflection[rows])
        return total

    def smallest(self, values: Sequence[Array]) -> Array:
        """Smallest of each pair's chambers, infinite without any, shape (n,)."""
        found = np.full(self.size, np.inf)
        for value, rows in zip(values, self.rows, strict=True):
            found[rows] = np.minimum(found[rows], value)
        return found


def planar_enclosure(pairs: Pairs) -> Enclosure:
    """Bounds of the deflections of planar machines [theory: model_error, eq. 9 to 14].

    Parameters
    ----------
    pairs : n pairs of a machine and a speed, whatever their liquid model
    """
    squared = np.square(pairs.speed)
    force, damping = pairs.unbalance * squared, pairs.damping * pairs.speed
    elastic = pairs.stiffness - pairs.mass * squared
    beyond, frozen = elastic - pairs.added_mass * squared, elastic - pairs.liquid_mass * squared
    linear = _ratio(force, np.hypot(beyond, damping))
    laws = _laws(pairs)
    # No deflection is farther out than the damper, or the spring with the liquid as a dead mass, allows.
    reach = np.minimum(_ratio(force, damping), _ratio(force + squared * pairs.reach, np.abs(frozen)))
    most = _most(laws, linear, reach, elastic, beyond, damping, force, squared)
    defect = laws.defect(most)
    # The slope of the law is at least the liquid's own mass.
    stiffest = np.maximum(np.abs(beyond), frozen)
    least = _ratio(force, np.hypot(stiffest, damping))
    least = np.maximum(least, _smallest(beyond, damping, force, squared * defect, linear))
    straight = laws.smallest([own.straight * own.radius for own in laws.surfaces])
    depth = laws.smallest([fills.depth for fills in laws.fills])
    return Enclosure(linear, np.minimum(least, most), most, straight, depth, defect, pairs.added_mass)


def _laws(pairs: Pairs) -> Laws:
    """Surfaces of all chambers."""
    fills, surfaces, rows = [], [], []
    for slot in pairs.slots:
        own = np.flatnonzero(slot.place >= 0)
        here = slot.fills.at(slot.place[own])
        fills.append(here)
        surfaces.append(upright_surfaces(here, pairs.speed[own], pairs.gravity[own]))
        rows.append(own)
    return Laws(tuple(fills), tuple(surfaces), tuple(rows), pairs.speed.size)


def _most(
    laws: Laws,
    linear: Array,
    reach: Array,
    elastic: Array,
    beyond: Array,
    damping: Array,
    force: Array,
    squared: Array,
) -> Array:
    """Largest deflection that the balance allows: what is missing up to a bound gives the next bound."""
    spring, hardening = np.abs(beyond), beyond >= 0.0
    most = np.where(hardening, np.minimum(linear, reach), reach)
    # Above the dry critical speed there is one deflection, below every one at which the balance exceeds F.
    first = _largest(spring, damping, force, squared * laws.defect(linear))
    single = (elastic <= 0.0) & np.isfinite(first) & np.isfinite(linear)
    beside = np.where(single, 2.0 * np.where(single, first, 0.0) - np.where(single, linear, 0.0), 0.0)
    rest = spring * beside - squared * laws.defect(beside)
    above = (rest >= 0.0) & (np.hypot(np.maximum(rest, 0.0), damping * beside) >= force * (1.0 - 1e-14))
    most = np.where(single & above, np.minimum(most, beside), most)
    for _ in range(_ROUNDS):
        larger = _largest(spring, damping, force, squared * laws.defect(most))
        most = np.where(hardening, most, np.minimum(most, larger))
    return most


def _ratio(top: Array, bottom: Array) -> Array:
    """top/bottom; infinite where nothing holds a force, 0 where there is none."""
    out = np.full(top.shape, np.inf)
    np.divide(top, bottom, out=out, where=bottom > 0.0)
    return np.where(top == 0.0, 0.0, out)


def _root(stiffness: Array, damping: Array, force: Array, pull: Array) -> Array:
    """Larger root e of (k e - p)^2 + (c e)^2 = F^2; where it has none, of its lowest point."""
    whole = np.square(stiffness) + np.square(damping)
    under = np.maximum(whole * np.square(force) - np.square(damping * pull), 0.0)
    return _ratio(stiffness * pull + np.sqrt(under), whole)


def _largest(spring: Array, damping: Array, force: Array, pull: Array) -> Array:
    """Largest deflection that a missing pull up to `pull` allows above the wet critical speed."""
    finite = np.where(np.isfinite(pull), pull, 0.0)
    # Where the missing pull can balance the spring, the damper alone sets the bound.
    alone = ~np.isfinite(pull) | (damping * finite >= spring * force)
    bound = _root(spring, damping, force, np.where(alone, 0.0, finite))
    return np.where(alone, _ratio(force, damping), bound)


def _smallest(beyond: Array, damping: Array, force: Array, pull: Array, linear: Array) -> Array:
    """Smallest deflection that a missing pull up to `pull` allows; 0 where it sets no bound."""
    weak = pull < force
    p = np.where(weak, pull, 0.0)
    # Below the wet critical speed the missing pull acts as a stiffer spring, above it may swing the balance
    # to the other side of the spring's zero.
    hardened, softened = _root(beyond, damping, force, -p), _root(np.abs(beyond), damping, force, p)
    return np.where(weak, np.where(beyond >= 0.0, hardened, np.minimum(linear, softened)), 0.0)


def planar_gravity_error(pairs: Pairs, across: Array, most: Array) -> Array:
    """Estimated relative error of amplitude and liquid by gravity across the axis, shape (n,).

    Parameters
    ----------
    pairs : n pairs of a machine and a speed
    across : gravity across their axes, m/s^2, shape (n,)
    most : bound of the deflection, m, shape (n,)

    Returns
    -------
    The larger of the two [theory: model_error, eq. 21], infinite where it has no bound, nan where the liquid
    does not ride with the drum, shape (n,)
    """
    weighted, largest = np.zeros((2, pairs.speed.size))
    for slot in pairs.slots:
        rows = np.flatnonzero((slot.place >= 0) & (across > 0.0))
        here = slot.fills.at(slot.place[rows])
        change = law_error(here, pairs.speed[rows], across[rows])
        weighted[rows] += here.added_mass * change
        largest[rows] = np.maximum(largest[rows], change)
    # One over the stiffness that holds the largest deflection.
    compliance = np.full(most.shape, np.inf)
    force = pairs.unbalance * np.square(pairs.speed)
    np.divide(most, force, out=compliance, where=force > 0.0)
    pull = np.square(pairs.speed) * weighted
    moved = np.zeros(most.shape)
    np.multiply(pull, compliance, out=moved, where=(pull != 0.0) & (force > 0.0))
    return np.asarray(largest + moved)
