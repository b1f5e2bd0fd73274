"""Estimated errors of a steady answer: of the linear law, and by gravity across the axis.

Closed forms [theory: model_error]. Every deflection of a planar machine with the exact law lies between two
bounds, from the linear answer and from a bound of the law's distance below its straight line; a rotor that
tilts or has unlike springs has bounds of its own. `error_estimate` takes whichever the rotor has.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fluid.fill import Fill, Fills
from meshes.arrays import Array, Complex, Flags, Index
from solvers.liquid_model import ROUNDING
from solvers.rotor.jeffcott import Jeffcott, PlanarMachine
from solvers.rotor.system import Rotor, RotorSystem
from solvers.rotor.vibration import solve_each
from solvers.statics.law_defect import Surfaces, defect_bound, upright_surfaces
from solvers.synchronous.balance import Balance, directions_at, harmonic_balance
from solvers.synchronous.models import LINEAR
from solvers.synchronous.pairs import Pairs, pair_machines

# Found from long-wave layers held at a speed: most have less, the median a third of it.
_SIZE = 0.15
_THIN = 1.25
# Ripple of the amplitude over the square of gravity's share, from time-domain states: 95 in 100 have less.
_RIPPLE = 1.0


def law_error(fills: Fills, speed: Array, gravity: Array) -> Array:
    """Change of the liquid's unbalance by gravity across the axis, over full mass times deflection.

    0.15 (R/h0)^(5/4) (g/(Omega^2 a))^2 [theory: model_error, eq. 20]; nan where the liquid does not ride with
    the drum.
    """
    depth, radius = fills.depth, fills.chamber.radius
    surface = np.maximum(radius - depth, fills.chamber.inner_radius)
    full = fills.volume >= fills.chamber.capacity * (1.0 - 1e-9)
    field = np.square(speed) * surface
    held = field > gravity
    weakness = np.divide(gravity, field, out=np.zeros_like(field), where=held)
    change = _SIZE * (radius / depth) ** _THIN * np.square(weakness)
    return np.asarray(np.where(full | (gravity == 0.0), 0.0, np.where(held, change, np.nan)))


@dataclass(frozen=True)
class GravityError:
    """Estimates of what gravity does to an answer without it, (n,) [theory: model_error, eq. 21-22].

    Infinite where there is no bound, nan where the liquid does not ride with the drum.
    """

    amplitude: Array  #: of the means over time of amplitude and of the liquid's offset, relative
    liquid: Array
    ripple: Array  #: by which the amplitude goes up and down about its mean, relative
    #: by which the liquid's centre of mass goes round its mean in the drum, once a turn, m
    liquid_ripple: Array

    def at(self, part: slice) -> GravityError:
        """Estimates of some answers."""
        return GravityError(
            self.amplitude[part], self.liquid[part], self.ripple[part], self.liquid_ripple[part]
        )

    @classmethod
    def none(cls, shape: tuple[int, ...]) -> GravityError:
        """Estimates without gravity, or without liquid."""
        return cls(*np.zeros((4, *shape)))


@dataclass(frozen=True)
class LinearError:
    """How far the linear law is from the exact one; shape (n,)."""

    amplitude: Array  #: bound of the amplitude's relative error; infinite where there is none
    liquid: Array  #: of the error of the liquid's unbalance, and so of its centre of mass
    wet: Flags  #: no wall runs dry over its whole height
    #: linear deflection over the one at which the law bends, of the chamber that is nearest to it
    strain: Array

    @property
    def worst(self) -> Array:
        """The larger of the two errors."""
        return np.maximum(self.amplitude, self.liquid)


_ROUNDS = 6  # of the bound on the largest deflection


@dataclass(frozen=True)
class Enclosure:
    """Where every synchronous deflection of planar machines lies, shape (n,)."""

    linear: Array  #: the answer of the linear law, m, infinite at an undamped resonance
    least: Array  #: bounds of all the deflections under the exact law, m
    most: Array
    straight: Array  #: deflection up to which the law is the linear one, m
    depth: Array  #: of the shallowest layer, m
    defect: Array  #: bound of what the law is below the linear one up to `most`, kg m
    added_mass: Array  #: of all chambers, kg

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
            amplitude=np.maximum(np.where(still, 0.0, amplitude), ROUNDING),
            liquid=np.maximum(np.where(none, 0.0, liquid), ROUNDING),
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
    """The chambers of n pairs of a machine and a speed."""

    fills: tuple[Fills, ...]  #: of each chamber, at the pairs that have it
    surfaces: tuple[Surfaces, ...]
    rows: tuple[Index, ...]  #: those pairs
    size: int  #: n

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
    """Bounds of the deflections of planar machines [theory: model_error, eq. 9 to 14]."""
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
        bound = np.where(hardening, most, np.minimum(most, larger))
        if (bound == most).all():
            break
        most = bound
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


def planar_gravity_error(pairs: Pairs, across: Array, most: Array) -> GravityError:
    """Estimates of what gravity across the axis does to n answers of at most the deflections `most`, m."""
    waves = _Waves(pairs.speed, across)
    for slot in pairs.slots:
        rows = np.flatnonzero((slot.place >= 0) & (across > 0.0))
        waves.add(slot.fills.at(slot.place[rows]), rows)
    # One over the stiffness that holds the largest deflection.
    compliance = np.full(most.shape, np.inf)
    force = pairs.unbalance * np.square(pairs.speed)
    np.divide(most, force, out=compliance, where=force > 0.0)
    pull = np.square(pairs.speed) * waves.weighted
    moved = np.zeros(most.shape)
    np.multiply(pull, compliance, out=moved, where=(pull != 0.0) & (force > 0.0))
    return waves.error(moved)


class _Waves:
    """What gravity's waves are in the chambers of n answers, added up chamber by chamber."""

    def __init__(self, speed: Array, across: Array) -> None:
        self.speed, self.across = speed, across
        self.weighted, self.largest, self.weakest, self.moment, self.mass = np.zeros((5, speed.size))

    def add(self, fills: Fills, rows: Index) -> None:
        """Take a chamber of some of the answers."""
        spin, gravity = self.speed[rows], self.across[rows]
        change = law_error(fills, spin, gravity)
        self.weighted[rows] += fills.added_mass * change
        self.largest[rows] = np.maximum(self.largest[rows], change)
        radius = fills.chamber.radius
        surface = np.maximum(radius - fills.depth, fills.chamber.inner_radius)
        share = np.where(change > 0.0, gravity / (np.square(spin) * np.maximum(surface, 1e-300)), change)
        self.weakest[rows] = np.maximum(self.weakest[rows], share)
        # The wave of first order stands in space: each layer leans by a^2/R^2 g/(2 Omega^2) [waves, eq. 10].
        lean = np.where(change == 0.0, 0.0, 0.5 * gravity * np.square(surface / (radius * spin)))
        self.moment[rows] += fills.mass * lean
        self.mass[rows] += fills.mass

    def error(self, moved: Array) -> GravityError:
        """The estimates, given how far the change of the pull moves the amplitude, relative."""
        lean = np.divide(self.moment, self.mass, out=np.zeros_like(self.mass), where=self.mass > 0.0)
        ripple = np.where(np.isnan(self.largest), np.nan, _RIPPLE * np.square(self.weakest))
        lean = np.where(np.isnan(self.largest), np.nan, lean)
        return GravityError(moved + 0.0 * self.largest, self.largest + moved, ripple, lean)


_COUPLED_ROUNDS = 8  # of the bound on the largest deflections


def coupled_error(
    system: RotorSystem,
    fills: Sequence[Fill],
    speed: Array,
    gravity: float,
    position: float,
    across: float = 0.0,
) -> tuple[LinearError, GravityError]:
    """Errors in the motion of any rotor: of the linear law, and by gravity across the axis.

    [theory: model_error, eq. 17 to 19 and 21]
    """
    wet = [fill for fill in fills if fill.volume > 0.0]
    terms = harmonic_balance(system, [wet], np.zeros(speed.size, dtype=np.intp), speed, gravity, LINEAR)
    if not wet:
        nothing = np.full(speed.shape, ROUNDING)
        exact = LinearError(nothing, nothing, np.ones(speed.shape, dtype=bool), np.zeros(speed.shape))
        return exact, GravityError.none(speed.shape)
    full, own, radius, depth = np.array(
        [(fill.added_mass, fill.mass, fill.chamber.radius, fill.depth) for fill in wet]
    ).T
    place = np.concatenate((terms.plane, directions_at(system, [position])))
    answer, spread = _answer(terms, full, place)
    frozen, far = _answer(terms, own, place)
    chambers, upright, each = len(wet), np.full(speed.size, gravity), terms.fills
    surfaces = [upright_surfaces(same, speed, upright) for same in each]
    linear = np.abs(answer[0][:, :chambers])
    most = _largest_coupled(
        linear,
        spread[0][:, :chambers],
        np.abs(frozen[0][:, :chambers]),
        far[0][:, :chambers],
        surfaces,
        speed,
        own * radius,
    )
    missing = _missing(surfaces, speed, most)
    size = np.sum([np.abs(part[:, chambers]) for part in answer], axis=0)
    lost = np.sum(full * _carried(spread[0][:, :chambers], missing), axis=1)
    lost = lost + missing.sum(axis=1) / np.square(speed)
    straight = np.stack([own.straight * own.radius for own in surfaces], axis=1)
    bent = np.divide(linear, straight, out=np.where(linear > 0.0, np.inf, 0.0), where=straight > 0.0)
    found = LinearError(
        amplitude=_share(_shift(spread, missing), size),
        liquid=_share(lost, np.abs(np.sum(full * answer[0][:, :chambers], axis=1))),
        wet=np.asarray((most < depth).all(axis=1)),
        strain=np.asarray(bent.max(axis=1)),
    )
    lying = np.full(speed.size, across)
    change = np.stack([law_error(same, speed, lying) for same in each], axis=1)
    waves = _Waves(speed, lying)
    if across > 0.0:
        for same in each:
            waves.add(same, np.arange(speed.size))
    thrown = _shift(spread, np.square(speed)[:, None] * full * most * change)
    return found, waves.error(_part(thrown, size))


def _largest_coupled(
    linear: Array,
    spread: Array,
    frozen: Array,
    far: Array,
    surfaces: list[Surfaces],
    speed: Array,
    dead: Array,
) -> Array:
    """Bounds of the deflections at the chambers, m, shape (s, c) [theory: model_error, eq. 17 and 18].

    `dead`: the liquids' mass times radius; the unbalance exceeds that of its mass at the chamber's centre by
    less.
    """
    most = frozen + _carried(far, np.square(speed)[:, None] * dead)
    left = np.arange(speed.size)  # whose bound still falls
    for _ in range(_COUPLED_ROUNDS):
        missing = _missing([own.at(left) for own in surfaces], speed[left], most[left])
        bound = np.minimum(most[left], linear[left] + _carried(spread[left], missing))
        falls = (bound < most[left]).any(axis=1)
        most[left] = bound
        left = left[falls]
        if not left.size:
            break
    return most


def _part(change: Array, size: Array) -> Array:
    """Change over size, shape (s,); nan where one of them is not known."""
    known = np.isfinite(change) & (size > 0.0)
    return np.asarray(np.divide(change, size, out=np.where(change == 0.0, 0.0, np.nan), where=known))


def _missing(surfaces: list[Surfaces], speed: Array, deflection: Array) -> Array:
    """Bound of the missing pull of each chamber, N, shape (s, c)."""
    bounds = [defect_bound(own, deflection[:, j]) for j, own in enumerate(surfaces)]
    return np.asarray(np.square(speed)[:, None] * np.stack(bounds, axis=1))


def _shift(spread: tuple[Array, Array], pull: Array) -> Array:
    """Largest change of both parts of the orbit at the last place by pulls on the chambers, m, shape (s,)."""
    return np.asarray(sum(_carried(part[:, -1:], pull)[:, 0] for part in spread))


def _answer(
    terms: Balance, mass: Array, place: Complex
) -> tuple[tuple[Complex, Complex], tuple[Array, Array]]:
    """Parts with and against the spin at each place, and what a unit force on a chamber adds to them."""
    p = terms.plane
    added = 0.5 * np.einsum("c,ci,cj->ij", mass, p, np.conj(p))
    matrix = terms.stiffness - np.square(terms.speed)[:, None, None] * added
    answer = solve_each(matrix, terms.force)
    units = [solve_each(matrix, np.broadcast_to(along, terms.force.shape)) for along in p]
    unit = np.stack(units, axis=-1)  # (s, n, c)
    parts = 0.5 * answer @ np.conj(place).T, 0.5 * answer @ place.T
    spread = (
        0.5 * np.abs(np.einsum("kn,snc->skc", np.conj(place), unit)),
        0.5 * np.abs(np.einsum("kn,snc->skc", place, unit)),
    )
    return parts, spread


def _carried(spread: Array, pull: Array) -> Array:
    """Largest change of the deflections by pulls of any direction, shape (s, k)."""
    return np.asarray(np.einsum("skc,sc->sk", spread, pull))


def _share(change: Array, size: Array) -> Array:
    """Change over what is left of the size after it; infinite where nothing is left, 0 for no change."""
    left = size - change
    out = np.full(size.shape, np.inf)
    np.divide(change, left, out=out, where=np.isfinite(change) & (left > 0.0))
    return np.maximum(np.where(change == 0.0, 0.0, out), ROUNDING)


def error_estimate(
    rotor: Rotor,
    fills: Sequence[Fill],
    speed: ArrayLike,
    gravity: float,
    across: float = 0.0,
    position: float | None = None,
) -> tuple[LinearError, GravityError]:
    """Errors in the motion of a rotor: of the linear law, and by gravity across the axis."""
    spin = np.array(speed, dtype=float).reshape(-1)
    if isinstance(rotor, Jeffcott):
        owner = np.zeros(spin.size, dtype=np.intp)
        return machine_errors([(rotor, fills)], owner, spin, np.array([gravity]), np.array([across]))
    place = position if position is not None else (fills[0].chamber.plane if fills else 0.0)
    return coupled_error(rotor.system(), fills, spin, gravity, place, across)


def machine_errors(
    machines: Sequence[PlanarMachine], owner: Index, speed: Array, gravity: Array, across: Array
) -> tuple[LinearError, GravityError]:
    """`error_estimate` of many planar machines at once: of n pairs of a machine and a speed."""
    pairs = pair_machines(machines, owner, speed, gravity, LINEAR)
    bounds = planar_enclosure(pairs)
    return bounds.error(), planar_gravity_error(pairs, across[owner], bounds.most)
