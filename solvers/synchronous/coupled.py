"""Solutions of the harmonic balance of any rotor and liquid, over all speeds at once.

With all chambers in one plane the balance has one unknown and every branch is found. With several planes
Newton's method starts from several shares of the added mass and from the neighbouring speeds, up and down.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshes.arrays import Array, Complex, Flags, Index
from solvers.rotor.vibration import solve_each
from solvers.synchronous.balance import Balance
from solvers.synchronous.planar import branches_beyond, over

# Shares of the full added mass from which Newton starts where walls run dry: 1 is the wall wet all over, 0 a
# liquid that the deflection has left behind.
_STARTS = tuple(np.linspace(0.0, 1.0, 13).tolist())
# Where none of these leads anywhere.
_MORE_STARTS = tuple(np.linspace(-0.3, 1.3, 81).tolist())
_STEPS, _HALVINGS = 25, 5
_ROUNDING = 1e-11  # of the largest term of the balance
_SAME = 1e-6  # relative distance of two solutions that count as one


_STEP = 0.5  # relative change up to which a solution at a close speed counts as the same one, moved
_LEAST = 2.0**-12  # shortest step over the way that is followed


@dataclass(frozen=True)
class Near:
    """Solutions at the next speeds below and above each of s speeds."""

    speed: Array  #: rad/s, shape (s, 2)
    answer: Complex  #: coordinates, nan where there are fewer, shape (s, 2, k, n)
    enough: bool = True  #: no other solutions are looked for where these lead to one

    def at(self, which: Index) -> Near:
        """Solutions near some of the speeds."""
        return Near(self.speed[which], self.answer[which], self.enough)


@dataclass(frozen=True)
class Solutions:
    """Solutions of the balance at s speeds."""

    answer: Complex  #: coordinates, shape (k, n)
    which: Index  #: the speed each belongs to, shape (k,)
    converged: Flags  #: a speed's solutions were found, shape (s,)
    #: speed at which a solution that was followed from this one towards the next speed, or from there to this
    #: one, ended in a fold; nan where none did, rad/s, shape (s,)
    end: Array


def solutions(balance: Balance, near: Near | None = None) -> Solutions:
    """Solutions of the balance: all where the chambers sit in one plane, by Newton's method elsewhere.

    `near`: solutions at close speeds, from which others are followed where chambers sit in several planes.
    """
    if balance.fills:
        apart = np.abs(balance.plane - balance.plane[0])
        alike = bool(np.all(apart <= 1e-12 * np.abs(balance.plane).max()))
        whole = alike and not balance.model.across  # a law of one unknown, and real
        return one_plane(balance) if whole else several_planes(balance, near)
    answer = solve_each(balance.stiffness, balance.force)
    bounded = np.asarray(np.isfinite(answer).all(axis=1))
    which = np.flatnonzero(bounded)
    return Solutions(answer[which], which, bounded, np.full(bounded.shape, np.nan))


def one_plane(balance: Balance) -> Solutions:
    """Every solution where all chambers sit in one plane [theory: rotor, eq. 30]."""
    p, squared = balance.plane[0], np.square(balance.speed)
    everyone = np.arange(balance.speed.size)
    free = solve_each(balance.stiffness, balance.force)
    unit = solve_each(balance.stiffness, np.broadcast_to(p, balance.force.shape))
    sound = np.asarray(np.isfinite(free).all(axis=1) & np.isfinite(unit).all(axis=1))
    free, unit = np.where(sound[:, None], free, 0.0), np.where(sound[:, None], unit, 0.0)
    compliance, alone = 0.5 * unit @ np.conj(p), 0.5 * free @ np.conj(p)
    moved = sound & (compliance != 0.0) & (alone != 0.0)
    support = np.ones_like(compliance)
    np.divide(1.0, compliance, out=support, where=moved)
    force = np.where(moved, np.abs(support * alone), 1.0)
    mass, full = balance.mass, balance.added_mass.sum(axis=1)
    limit = np.where(moved, balance.limit.min(axis=1), np.inf)
    resistance = np.abs(support - squared * full)
    straight = over(force, resistance)

    def pull(deflection: Array, k: Index) -> Array:
        """Liquid's pull beyond its mass at the chamber's centre; never decreases with the deflection."""
        moment = balance.pull(k, deflection)
        return np.asarray(squared[k] * np.maximum(moment - mass[k] * deflection, 0.0))

    elastic = support.real - squared * mass
    # A little more than the steepest slope of the unbalance holds the rounding.
    steepest = squared * (balance.steepest * (1.0 + 1e-9) - mass)
    dead = squared * sum(fills.mass * fills.chamber.radius for fills in balance.fills)
    bent, owner, found, bounded = branches_beyond(
        pull, elastic, np.abs(support.imag), force, steepest, limit, dead, moved
    )
    linear = np.flatnonzero(moved & (straight <= limit))
    still = np.flatnonzero(sound & ~moved)
    size = np.concatenate((straight[linear], bent, np.abs(alone[still])))
    which = np.concatenate((linear, owner, still)).astype(np.intp)
    pulled = np.concatenate(
        (
            squared[linear] * full[linear] * straight[linear],
            pull(bent, owner) + squared[owner] * mass[owner] * bent,
        )
    )
    turn = _phase(support[which[: pulled.size]], alone[which[: pulled.size]], size[: pulled.size], pulled)
    answer = free[which]
    answer[: pulled.size] += unit[which[: pulled.size]] * (pulled * turn)[:, None]
    lost = np.isin(everyone, which, invert=True)
    return Solutions(answer, which, found & bounded & sound & ~lost, np.full(sound.shape, np.nan))


def _phase(support: Complex, alone: Complex, size: Array, pulled: Array) -> Complex:
    """Direction of the forward deflection of that size."""
    return np.asarray(np.exp(1j * (np.angle(support * alone) - np.angle(support * size - pulled))))


def several_planes(balance: Balance, near: Near | None = None) -> Solutions:
    """Solutions where chambers sit in several planes: Newton from many starts, then from speed to speed.

    One that is far from every start and on a branch that no other speed leads to may be missed.
    """
    everyone = np.arange(balance.speed.size)
    straight = balance.linear(everyone)
    wet = np.asarray(np.isfinite(straight).all(axis=1))
    wet &= np.all(np.abs(balance.forward(np.where(wet[:, None], straight, 0.0))) <= balance.limit, axis=1)
    answer, which, end = straight[wet], everyone[wet], np.full(balance.speed.size, np.nan)
    unknown, come = everyone, np.zeros(balance.speed.size, dtype=np.intp)
    if near is not None:
        row, side, k = np.nonzero(np.isfinite(near.answer).all(axis=3))
        way = _followed(balance, near.answer[row, side, k], near.speed[row, side], row)
        end[row[~way.arrived]] = way.speed[~way.arrived]
        answer, which = _joined(balance, answer, which, way.answer[way.met], row[way.met])
        come = np.bincount(which, minlength=come.size)
        if near.enough:
            unknown = np.setdiff1d(everyone, which)
    answer, which = _added(balance, answer, which, *_linear_starts(balance, unknown, _STARTS))
    lost = np.setdiff1d(everyone, which)
    if lost.size:
        answer, which = _added(balance, answer, which, *_linear_starts(balance, lost, _MORE_STARTS))
    for above in (1, -1):
        # Where all came from another speed, the way back leads to nothing else.
        fresh = np.flatnonzero(np.bincount(which, minlength=come.size)[which] > come[which])
        while fresh.size:
            source, target = _beside(balance, which, fresh, above)
            way = _followed(balance, answer[source], balance.speed[which[source]], target)
            end[which[source[~way.arrived]]] = way.speed[~way.arrived]
            come += np.bincount(target[way.arrived], minlength=come.size)
            before = which.size
            answer, which = _joined(balance, answer, which, way.answer[way.met], target[way.met])
            fresh = np.arange(before, which.size)
    return Solutions(answer, which, np.isin(everyone, which), end)


def _beside(balance: Balance, which: Index, some: Index, above: int) -> tuple[Index, Index]:
    """Some of the solutions with the speed above theirs (1) or below it (-1), of the same volumes."""
    target = which[some] + above
    inside = (target >= 0) & (target < balance.speed.size)
    source, target = some[inside], target[inside]
    same = balance.owner[target] == balance.owner[which[source]]
    return source[same], target[same]


@dataclass(frozen=True)
class _Way:
    """Solutions followed from other speeds."""

    answer: Complex  #: coordinates at the speed where they were to go, shape (k, n)
    met: Flags  #: there is a solution, be it that of another branch, shape (k,)
    arrived: Flags  #: it is the one that was followed; else its branch ends on the way, shape (k,)
    speed: Array  #: up to which it was followed, rad/s, shape (k,)


def _followed(balance: Balance, begin: Complex, start: Array, target: Index) -> _Way:
    """Solutions moved from other speeds to those of some pairs, by steps over which they change little."""
    x, here, goal = begin.copy(), start.copy(), balance.speed[target]
    step = goal - here
    least, arrived = _LEAST * np.abs(step), step == 0.0
    found, met = begin.copy(), arrived.copy()
    active = np.flatnonzero(~arrived)
    while active.size:
        last = np.abs(goal - here)[active] <= np.abs(step[active])
        trial = np.where(last, goal[active], here[active] + step[active])
        terms = balance.moved(target[active], trial)
        y, sound = newton(terms, x[active], np.arange(active.size))
        weight = _weight(terms)
        change, size = (np.linalg.norm(weight * z, axis=1) for z in (y - x[active], y))
        close = sound & (change <= _STEP * size)
        x[active[close]], here[active[close]] = y[close], trial[close]
        found[active[last & sound]], met[active[last & sound]] = y[last & sound], True
        arrived[active] = close & last
        step[active] *= np.where(close, 2.0, 0.25)
        active = active[~arrived[active] & (np.abs(step[active]) >= least[active])]
    return _Way(found, met, arrived, here)


def _weight(balance: Balance) -> Array:
    """By which coordinates count when solutions are compared, shape (s, n)."""
    return np.sqrt(np.maximum(np.abs(np.diagonal(balance.stiffness, axis1=1, axis2=2)), 1e-300))


def _linear_starts(balance: Balance, which: Index, shares: tuple[float, ...]) -> tuple[Complex, Index]:
    """Solutions with several shares of the added mass at each of some speeds, and their speeds.

    Without those that wet every wall: from there Newton's first step leads to the solution with the whole
    mass.
    """
    begin = np.concatenate([balance.linear(which, share) for share in shares])
    owner = np.tile(which, len(shares))
    sound = np.asarray(np.isfinite(begin).all(axis=1))
    begin, owner = begin[sound], owner[sound]
    bent = np.any(np.abs(balance.forward(begin)) > balance.limit[owner], axis=1)
    return begin[bent], owner[bent]


def _added(
    balance: Balance, answer: Complex, which: Index, begin: Complex, owner: Index
) -> tuple[Complex, Index]:
    """The solutions with those that Newton finds from other starts and that are not among them yet."""
    found, converged = newton(balance, begin, owner)
    return _joined(balance, answer, which, found[converged], owner[converged])


def _joined(
    balance: Balance, answer: Complex, which: Index, found: Complex, owner: Index
) -> tuple[Complex, Index]:
    """The solutions with others that are not among them yet."""
    weight = _weight(balance)
    rivals, at = answer, which
    while owner.size:
        # Compared with all that their speeds have, then with the first of those that are new to them.
        first, second = _meeting(owner, at)
        scale = weight[owner[first]]
        apart = np.linalg.norm(scale * (rivals[second] - found[first]), axis=1)
        known = np.zeros(owner.size, dtype=bool)
        known[first[apart <= _SAME * np.linalg.norm(scale * found[first], axis=1)]] = True
        found, owner = found[~known], owner[~known]
        at, new = np.unique(owner, return_index=True)
        rivals = found[new]
        answer, which = np.concatenate((answer, rivals)), np.concatenate((which, at))
        rest = np.ones(owner.size, dtype=bool)
        rest[new] = False
        found, owner = found[rest], owner[rest]
    return answer, which


def _meeting(owner: Index, other: Index) -> tuple[Index, Index]:
    """All pairs of one of each that belong to the same speed."""
    order = np.argsort(other, kind="stable")
    start = np.searchsorted(other[order], owner)
    count = np.searchsorted(other[order], owner, side="right") - start
    first = np.repeat(np.arange(owner.size), count)
    within = np.arange(first.size) - np.repeat(np.cumsum(count) - count, count)
    return first, order[start[first] + within]


def newton(balance: Balance, begin: Complex, which: Index) -> tuple[Complex, Flags]:
    """Solutions next to starts, and whether they converged: coordinates (k, n), the speed of each (k,)."""
    x = begin.copy()
    converged = np.zeros(which.size, dtype=bool)
    active = np.arange(which.size)
    left, matrix, scale = _linearised(balance, x, which)
    for _ in range(_STEPS):
        size = np.linalg.norm(left, axis=1)
        done = size <= _ROUNDING * scale
        converged[active[done]] = True
        active, left, matrix, size = active[~done], left[~done], matrix[~done], size[~done]
        if active.size == 0:
            break
        step = solve_each(matrix, -np.hstack((left.real, left.imag)))
        # A singular matrix tells no way; its infinities are no numbers to reckon with.
        step = np.where(np.isfinite(step).all(axis=1, keepdims=True), step, 0.0)
        step = step[:, : x.shape[1]] + 1j * step[:, x.shape[1] :]
        trial, length = x[active] + step, np.ones(active.size)
        left, matrix, scale = _linearised(balance, trial, which[active])
        for _ in range(_HALVINGS):
            worse = np.flatnonzero(np.linalg.norm(left, axis=1) > size * (1.0 - 1e-4 * length))
            if worse.size == 0:
                break
            length[worse] *= 0.4
            trial[worse] = x[active[worse]] + length[worse, None] * step[worse]
            left[worse], matrix[worse], scale[worse] = _linearised(
                balance, trial[worse], which[active[worse]]
            )
        x[active] = trial
        # Where no step helps there is a least distance from balance, or rounding is reached.
        going = (np.linalg.norm(left, axis=1) < size) | (size <= 1e3 * _ROUNDING * scale)
        active, left, matrix, scale = active[going], left[going], matrix[going], scale[going]
    rest = np.flatnonzero(~converged)
    converged[rest] = _at_rounding(balance, x[rest], which[rest])
    return x, converged


def stable_solutions(balance: Balance, answer: Complex, which: Index) -> Flags:
    """Stability of solutions against disturbances slow beside the liquid's waves [theory: rotor, eq. 35].

    With every wall wet the liquid is a mass, and dampers take the energy of any motion.
    """
    stable = np.ones(which.size, dtype=bool)
    bent = np.flatnonzero(np.any(np.abs(balance.forward(answer)) > balance.limit[which], axis=1))
    if not bent.size:
        return stable
    x, own, p, system = answer[bent], which[bent], balance.plane, balance.system
    size = np.abs(balance.forward(x))
    law = balance.liquid(own, size)
    secant = np.divide(law.unbalance, size, out=law.slope.copy(), where=size > 0.0)
    mass = system.mass + 0.5 * np.einsum("kc,ci,cj->kij", secant, p, np.conj(p))
    mass = mass + 0.5 * np.einsum("kc,ci,cj->kij", balance.backward_mass[own], np.conj(p), p)
    spin = balance.speed[own, None, None]
    rate = 2j * spin * mass + system.damping + spin * system.gyroscopic
    _, held, _ = _linearised(balance, x, own)
    n = held.shape[1]
    lower = -np.linalg.solve(_real(mass), np.concatenate((held, _real(rate)), axis=2))
    upper = np.broadcast_to(np.eye(n, 2 * n, n), lower.shape)
    roots = np.linalg.eigvals(np.concatenate((upper, lower), axis=1))
    # Without damping the roots are imaginary to rounding (square root of it where two meet). A branch between
    # two folds falls away along a real root, which the sign of the determinant tells to rounding.
    slack = 1e-7 * np.abs(roots).max(axis=1)
    falls = np.linalg.slogdet(held)[0] < 0.0
    stable[bent] = ~falls & (roots.real.max(axis=1) <= slack)
    return stable


def _real(matrix: Complex) -> Array:
    """Complex matrices as they act on real and imaginary parts, shape (k, 2n, 2n) for (k, n, n)."""
    return np.asarray(np.block([[matrix.real, -matrix.imag], [matrix.imag, matrix.real]]))


def _at_rounding(balance: Balance, x: Complex, which: Index) -> Flags:
    """Whether nothing is left of the balance but rounding of its terms, of which the largest may cancel."""
    terms = np.einsum("kij,kj->ki", np.abs(balance.stiffness[which]), np.abs(x))
    largest = np.linalg.norm(terms, axis=1) + np.linalg.norm(balance.force[which], axis=1)
    left, _, _ = _linearised(balance, x, which)
    return np.asarray(np.linalg.norm(left, axis=1) <= _ROUNDING * largest)


def _linearised(balance: Balance, x: Complex, which: Index) -> tuple[Complex, Array, Array]:
    """What is left of the balance, its derivative in real form, and the size of its largest term."""
    squared, p = np.square(balance.speed[which]), balance.plane
    w = balance.forward(x)
    size = np.abs(w)
    law = balance.liquid(which, size)
    secant = np.divide(law.unbalance, size, out=law.slope.copy(), where=size > 0.0)
    unit = np.divide(w, size, out=np.ones_like(w), where=size > 0.0)
    held = np.einsum("kij,kj->ki", balance.stiffness[which], x)
    left = held - balance.force[which] - squared[:, None] * ((secant * w) @ p)
    same = 0.25 * squared[:, None] * (law.slope + secant)
    other = 0.25 * squared[:, None] * (law.slope - secant) * np.square(unit)
    direct = balance.stiffness[which] - np.einsum("kc,ci,cj->kij", same, p, np.conj(p))
    crossed = -np.einsum("kc,ci,cj->kij", other, p, p)
    plus, minus = direct + crossed, direct - crossed
    matrix = np.block([[plus.real, -minus.imag], [plus.imag, minus.real]])
    scale = np.linalg.norm(held, axis=1) + np.linalg.norm(balance.force[which], axis=1)
    return left, matrix, scale
