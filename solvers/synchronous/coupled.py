"""Solutions of the harmonic balance of any rotor and liquid, over all speeds at once.

Where all chambers sit in one plane the balance has one unknown and every branch is found. With several planes
Newton's method starts from several shares of the added mass and from the neighbouring speeds, up and down.
"""

from __future__ import annotations

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


def solutions(balance: Balance, near: Complex | None = None) -> tuple[Complex, Index, Flags]:
    """Solutions of the balance: all where the chambers sit in one plane, by Newton's method elsewhere.

    Parameters
    ----------
    balance : at s speeds, n coordinates
    near : coordinates of the solutions at close speeds, from which Newton's method starts, nan where there
        are none, shape (s, k, n)

    Returns
    -------
    answer : coordinates, shape (k, n)
    which : the speed each belongs to, shape (k,)
    converged : a speed's solutions were found, shape (s,)
    """
    if not balance.fills:
        answer = solve_each(balance.stiffness, balance.force)
        bounded = np.asarray(np.isfinite(answer).all(axis=1))
        which = np.flatnonzero(bounded)
        return answer[which], which, bounded
    apart = np.abs(balance.plane - balance.plane[0])
    alike = bool(np.all(apart <= 1e-12 * np.abs(balance.plane).max()))
    return one_plane(balance) if alike else several_planes(balance, near)


def one_plane(balance: Balance) -> tuple[Complex, Index, Flags]:
    """Every solution where all chambers sit in one plane [theory: rotor, eq. 30].

    Parameters
    ----------
    balance : all its planes alike

    Returns
    -------
    answer : coordinates, shape (k, n)
    which : the speed each belongs to, shape (k,)
    converged : all solutions of a speed were found, shape (s,)
    """
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
    mass = sum(fill.mass for fill in balance.fills)
    full = float(balance.added_mass.sum())
    limit = np.where(moved, balance.limit.min(axis=1), np.inf)
    resistance = np.abs(support - squared * full)
    straight = over(force, resistance)

    def pull(deflection: Array, k: Index) -> Array:
        """Liquid's pull beyond its mass at the chamber's centre; never decreases with the deflection."""
        moment = balance.liquid(k, np.repeat(deflection[:, None], len(balance.fills), 1)).unbalance.sum(
            axis=1
        )
        return np.asarray(squared[k] * np.maximum(moment - mass * deflection, 0.0))

    elastic = support.real - squared * mass
    # The slope of the unbalance never exceeds a full chamber's mass; a little more holds the rounding.
    steepest = squared * (full * (1.0 + 1e-9) - mass)
    dead = squared * sum(fill.mass * fill.chamber.radius for fill in balance.fills)
    bent, owner, found, bounded = branches_beyond(
        pull, elastic, np.abs(support.imag), force, steepest, limit, dead, moved
    )
    linear = np.flatnonzero(moved & (straight <= limit))
    still = np.flatnonzero(sound & ~moved)
    size = np.concatenate((straight[linear], bent, np.abs(alone[still])))
    which = np.concatenate((linear, owner, still)).astype(np.intp)
    pulled = np.concatenate(
        (squared[linear] * full * straight[linear], pull(bent, owner) + squared[owner] * mass * bent)
    )
    turn = _phase(support[which[: pulled.size]], alone[which[: pulled.size]], size[: pulled.size], pulled)
    answer = free[which]
    answer[: pulled.size] += unit[which[: pulled.size]] * (pulled * turn)[:, None]
    lost = np.isin(everyone, which, invert=True)
    return answer, which, found & bounded & sound & ~lost


def _phase(support: Complex, alone: Complex, size: Array, pulled: Array) -> Complex:
    """Direction of the forward deflection of that size."""
    return np.asarray(np.exp(1j * (np.angle(support * alone) - np.angle(support * size - pulled))))


def several_planes(balance: Balance, near: Complex | None = None) -> tuple[Complex, Index, Flags]:
    """Solutions where chambers sit in several planes: Newton from many starts, then from speed to speed.

    Parameters and returns as in `solutions` and `one_plane`; solutions far from every start may be missed.
    """
    everyone = np.arange(balance.speed.size)
    straight = balance.linear(everyone)
    wet = np.asarray(np.isfinite(straight).all(axis=1))
    wet &= np.all(np.abs(balance.forward(np.where(wet[:, None], straight, 0.0))) <= balance.limit, axis=1)
    answer, which = straight[wet], everyone[wet]
    unknown, followed = everyone, 0
    if near is not None:
        known = np.isfinite(near).all(axis=2)
        answer, which = _added(balance, answer, which, near[known], np.nonzero(known)[0])
        # What was found from a close speed is not looked for again.
        unknown, followed = np.setdiff1d(everyone, which), which.size
    answer, which = _added(balance, answer, which, *_linear_starts(balance, unknown, _STARTS))
    fresh = np.arange(followed, which.size)
    # A fold is followed one speed at a time, in both directions.
    for _ in range(balance.speed.size):
        if fresh.size == 0:
            break
        begin = np.concatenate((answer[fresh], answer[fresh]))
        owner = np.concatenate((which[fresh] - 1, which[fresh] + 1))
        inside = (owner >= 0) & (owner < balance.speed.size)
        before = which.size
        answer, which = _added(balance, answer, which, begin[inside], owner[inside])
        fresh = np.arange(before, which.size)
    lost = np.setdiff1d(everyone, which)
    if lost.size:
        answer, which = _added(balance, answer, which, *_linear_starts(balance, lost, _MORE_STARTS))
    return answer, which, np.isin(everyone, which)


def _linear_starts(balance: Balance, which: Index, shares: tuple[float, ...]) -> tuple[Complex, Index]:
    """Solutions with several shares of the added mass at each of some speeds, and their speeds.

    Left out are those with every wall wet: from there Newton's first step leads to the whole mass's one.
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
    found, owner = found[converged], owner[converged]
    weight = np.sqrt(np.maximum(np.abs(np.diagonal(balance.stiffness, axis1=1, axis2=2)), 1e-300))
    for k in range(owner.size):
        rivals = answer[which == owner[k]] - found[k]
        size = np.linalg.norm(weight[owner[k]] * found[k])
        if not np.any(np.linalg.norm(weight[owner[k]] * rivals, axis=1) <= _SAME * size):
            answer, which = np.vstack((answer, found[k])), np.append(which, owner[k])
    return answer, which


def newton(balance: Balance, begin: Complex, which: Index) -> tuple[Complex, Flags]:
    """Solutions next to starts.

    Parameters
    ----------
    begin : coordinates, shape (k, n)
    which : the speed of each, shape (k,)

    Returns
    -------
    answer : shape (k, n)
    converged : shape (k,)
    """
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
        sound = np.asarray(np.isfinite(step).all(axis=1))
        step = np.where(sound[:, None], step[:, : x.shape[1]] + 1j * step[:, x.shape[1] :], 0.0)
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


def _at_rounding(balance: Balance, x: Complex, which: Index) -> Flags:
    """Nothing is left of the balance but rounding of its terms, of which the largest may cancel."""
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
