"""Solutions of the harmonic balance of rotor and liquid: all of them with one plane, by Newton with more."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fluid.fill import Fill, Fills
from fluid.friction import NO_FRICTION
from fluid.waves import force_ratio
from meshes.arrays import Array, Complex, Flags, Index
from meshes.errors import InputError
from solvers.rotor.system import RotorSystem
from solvers.rotor.vibration import (
    Orbit,
    critical_speeds,
    dynamic_stiffness,
    orbit,
    solve_each,
    unbalance_response,
)
from solvers.sloshing.reduced import section_layer
from solvers.synchronous.branches import find_branches
from solvers.synchronous.models import LiquidModel, synchronous_model
from solvers.synchronous.planar import Response


@dataclass(frozen=True)
class Liquid:
    """The liquid of c chambers at k states.

    Parameters
    ----------
    unbalance : first moments about the rotation axis U_liq, kg m, shape (k, c)
    slope : their derivatives with respect to the deflection, kg, shape (k, c)
    dry_patch, in_range, converged : shape (k, c)
    """

    unbalance: Array
    slope: Array
    dry_patch: Flags
    in_range: Flags
    converged: Flags


@dataclass(frozen=True)
class Balance:
    """Equations [theory: rotor, eq. 29] of n coordinates and c chambers with liquid at s speeds.

    Parameters
    ----------
    speed : Omega, rad/s, shape (s,)
    stiffness : dynamic stiffness with the liquid's answer to the backward part, shape (s, n, n)
    force : Omega^2 U, shape (s, n)
    plane : p = B^T (1, -i) of each chamber, shape (c, n)
    fills : the chambers with liquid
    limit : forward deflection up to which a chamber adds exactly its full mass, m, shape (s, c)
    model : of the liquid
    gravity : along the axis, m/s^2
    """

    speed: Array
    stiffness: Complex
    force: Complex
    plane: Complex
    fills: tuple[Fill, ...]
    limit: Array
    model: LiquidModel
    gravity: float

    def forward(self, answer: Complex) -> Complex:
        """Forward deflection at each chamber, m, shape (k, c), for coordinates of shape (k, n)."""
        return np.asarray(0.5 * answer @ np.conj(self.plane).T)

    def linear(self, which: Index, share: Array | float = 1.0) -> Complex:
        """Coordinates if each chamber adds a share of its full mass, shape (k, n).

        Parameters
        ----------
        which : of the speeds, shape (k,)
        share : shape (k,) or a number
        """
        full = np.array([fill.added_mass for fill in self.fills])
        added = 0.5 * np.einsum("c,ci,cj->ij", full, self.plane, np.conj(self.plane))
        size = (share * np.square(self.speed[which]))[:, None, None]
        return solve_each(self.stiffness[which] - size * added, self.force[which])

    def liquid(self, which: Index, deflection: Array) -> Liquid:
        """Law of each chamber at forward deflections.

        Parameters
        ----------
        which : of the speeds, shape (k,)
        deflection : m, shape (k, c)
        """
        shape = deflection.shape
        full = np.array([fill.added_mass for fill in self.fills])
        unbalance, slope = full * deflection, np.broadcast_to(full, shape).copy()
        flags = np.zeros(shape, dtype=bool), np.ones(shape, dtype=bool), np.ones(shape, dtype=bool)
        bent = ~(deflection <= self.limit[which])
        for j, fill in enumerate(self.fills):
            # The law costs most of the time, and up to the limit it is known.
            rows = np.flatnonzero(bent[:, j])
            if rows.size:
                same, gravity = Fills.same(fill, rows.size), np.full(rows.size, self.gravity)
                one = self.model.synchronous(same, self.speed[which[rows]], deflection[rows, j], gravity)
                unbalance[rows, j], slope[rows, j] = one.unbalance, one.slope
                for flag, found in zip(flags, (one.dry_patch, one.in_range, one.converged), strict=True):
                    flag[rows, j] = found
        return Liquid(unbalance, slope, *flags)


def balance(
    system: RotorSystem, fills: Sequence[Fill], speed: Array, gravity: float, model: LiquidModel
) -> Balance:
    """Terms of the harmonic balance [theory: rotor, eq. 28 and 29].

    Parameters
    ----------
    system : the dry rotor
    fills : its chambers; those without liquid are left out
    speed : Omega, rad/s, shape (s,), above 0
    gravity : along the axis, m/s^2
    model : of the liquid
    """
    wet = tuple(fill for fill in fills if fill.volume > 0.0)
    squared = np.square(speed)
    plane = directions(system, wet)
    stiffness = dynamic_stiffness(system, speed)
    for fill, p in zip(wet, plane, strict=True):
        back = 0.5 * backward_mass(fill) * np.outer(np.conj(p), p)
        stiffness = stiffness - squared[:, None, None] * back
    along = np.full(speed.size, gravity)
    limits = [model.linear_limit(Fills.same(fill, speed.size), speed, along) for fill in wet]
    return Balance(
        speed=speed,
        stiffness=stiffness,
        force=squared[:, None] * system.unbalance,
        plane=plane,
        fills=wet,
        limit=np.stack(limits, axis=1) if wet else np.zeros((speed.size, 0)),
        model=model,
        gravity=gravity,
    )


def directions(system: RotorSystem, fills: Sequence[Fill]) -> Complex:
    """p = B^T (1, -i) of each chamber: a forward force F on it acts on the coordinates with p F, (c, n)."""
    found = np.zeros((len(fills), len(system.coordinates)), dtype=complex)
    for j, fill in enumerate(fills):
        found[j] = system.at(fill.chamber.plane).T @ np.array([1.0, -1j])
    return found


def backward_mass(fill: Fill) -> float:
    """Mass with which a layer resists a backward whirl at the speed of its spin, kg.

    m_f G(kappa, -1), G = 1 - 8/(1 + 7 kappa) [theory: rotor, eq. 28]; that of the liquid where it fills its
    chamber; with baffles in the liquid the part of the answer that turns with the whirl.
    """
    full = fill.volume >= fill.chamber.capacity * (1.0 - 1e-9)
    if full or fill.surface_radius == 0.0:
        return fill.mass
    if fill.uneven:
        layer = section_layer(fill, NO_FRICTION)
        assert layer is not None
        whole = layer.density * layer.liquid.enclosed_area
        return whole * float(layer.liquid.force_ratio([-2.0])[0])
    curvature = (fill.chamber.radius / fill.surface_radius) ** 2
    return fill.full_mass * float(force_ratio(curvature, -1.0)) if curvature > 1.0 else 0.0


# Shares of the full added mass from which Newton starts where walls run dry: 1 is the wall wet all over, 0 a
# liquid that the deflection has left behind.
_STARTS = tuple(np.linspace(0.0, 1.0, 13).tolist())
# Where none of these leads anywhere.
_MORE_STARTS = tuple(np.linspace(-0.3, 1.3, 81).tolist())
_STEPS, _HALVINGS = 25, 5
_ROUNDING = 1e-11  # of the largest term of the balance
_SAME = 1e-6  # relative distance of two solutions that count as one


def one_plane(balance: Balance) -> tuple[Complex, Index, NDArray[np.bool_]]:
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
    full = sum(fill.added_mass for fill in balance.fills)
    limit = np.where(moved, balance.limit.min(axis=1), np.inf)
    resistance = np.abs(support - squared * full)
    straight = np.full(force.shape, np.inf)
    np.divide(force, resistance, out=straight, where=resistance > 0.0)

    def pull(deflection: Array, k: Index) -> Array:
        """Liquid's pull beyond its mass at the chamber's centre; never decreases with the deflection."""
        moment = balance.liquid(k, np.repeat(deflection[:, None], len(balance.fills), 1)).unbalance.sum(
            axis=1
        )
        return np.asarray(squared[k] * np.maximum(moment - mass * deflection, 0.0))

    elastic = support.real - squared * mass
    most = force + squared * sum(fill.mass * fill.chamber.radius for fill in balance.fills)
    # No solution is farther out than the damping or the stiffness allows.
    reach = np.minimum(_over(force, np.abs(support.imag)), _over(most, np.abs(elastic))) * (1.0 + 1e-9)
    bounded = np.isfinite(reach) | np.isinf(limit)
    stop = np.where(moved & bounded & np.isfinite(limit), np.maximum(reach, limit), limit)
    # The slope of the unbalance never exceeds a full chamber's mass; a hair's breadth holds the rounding.
    steepest = squared * (full * (1.0 + 1e-9) - mass)
    bent, owner, found = find_branches(pull, elastic, np.abs(support.imag), force, steepest, limit, stop)
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


def _over(above: Array, below: Array) -> Array:
    """Quotient, infinite where there is nothing to divide by."""
    return np.asarray(np.divide(above, below, out=np.full(above.shape, np.inf), where=below > 0.0))


def _phase(support: Complex, alone: Complex, size: Array, pulled: Array) -> Complex:
    """Direction of the forward deflection of that size."""
    return np.asarray(np.exp(1j * (np.angle(support * alone) - np.angle(support * size - pulled))))


def several_planes(balance: Balance) -> tuple[Complex, Index, NDArray[np.bool_]]:
    """Solutions where chambers sit in several planes: Newton from many starts, then from speed to speed.

    Parameters and returns as in `one_plane`; solutions far from every start may be missed.
    """
    everyone = np.arange(balance.speed.size)
    straight = balance.linear(everyone)
    wet = np.asarray(np.isfinite(straight).all(axis=1))
    wet &= np.all(np.abs(balance.forward(np.where(wet[:, None], straight, 0.0))) <= balance.limit, axis=1)
    answer, which = straight[wet], everyone[wet]
    answer, which = _added(balance, answer, which, *_linear_starts(balance, everyone, _STARTS))
    fresh = np.arange(which.size)
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


def newton(balance: Balance, begin: Complex, which: Index) -> tuple[Complex, NDArray[np.bool_]]:
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
    return x, converged


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


@dataclass(frozen=True)
class CoupledResponse:
    """Unbalance response of any rotor; s speeds, n coordinates, b branches, c chambers with liquid.

    Parameters
    ----------
    response : forward part of the axis' motion in one plane, and the liquid. Angles count from angle 0 of the
        unbalances. Reported is the branch with the largest forward part; `stable` says nothing here, it is
        True wherever a branch was found
    position : of that plane, m
    backward, backward_dry : backward part of the branch reported, and of the rotor without liquid, m, (s,)
    branch_backward : of all branches, m, shape (s, b)
    coordinates : complex amplitudes of the branch reported, q = Re(coordinates e^{i Omega t}), shape (s, n)
    chamber_forward, chamber_backward : the axis at each chamber with liquid, m, shape (s, c)
    residual : what is left of the balance over its largest term, shape (s,)
    """

    response: Response
    position: float
    backward: Complex
    backward_dry: Complex
    branch_backward: Complex
    coordinates: Complex
    chamber_forward: Complex
    chamber_backward: Complex
    residual: Array


def coupled_response(
    system: RotorSystem,
    fills: Sequence[Fill],
    speed: ArrayLike,
    gravity: float = 9.81,
    model: str = "auto",
    position: float | None = None,
) -> CoupledResponse:
    """Steady motion of a rotor of any kind with liquid in its chambers [theory: rotor, eq. 28-30].

    Where all chambers sit in one plane every branch is found. With several planes Newton starts from several
    shares of the added mass and from the neighbouring speeds, up and down.

    Parameters
    ----------
    system : the dry rotor
    fills : its chambers with their liquid, any number
    speed : spin speeds Omega, rad/s, shape (s,), > 0
    gravity : along the axis, m/s^2; 0 for a horizontal axis
    model : liquid model, `auto`, `statics` or `linear`, for the forward part
    position : of the plane that is reported, m; that of the first chamber if None, 0 without chambers

    Returns
    -------
    CoupledResponse; `converged` is False where nothing was found

    Raises
    ------
    InputError : a speed that is not positive and finite, an unknown model

    Examples
    --------
    >>> from solvers.rotor.jeffcott import Jeffcott
    >>> rotor = Jeffcott(mass=4.0, stiffness=4.4e4, damping=84.0, unbalance=6e-4)
    >>> answer = coupled_response(rotor.system(), [], [105.0, 200.0])
    >>> print(np.round(1e3 * np.abs(answer.response.deflection), 4))
    [0.75   0.2042]
    """
    spin = np.array(speed, dtype=float).reshape(-1)
    if not np.all(np.isfinite(spin) & (spin > 0.0)):
        raise InputError("speed", spin.tolist(), "finite numbers above 0")
    law = synchronous_model(model)
    place = position if position is not None else (fills[0].chamber.plane if fills else 0.0)
    terms = balance(system, fills, spin, gravity, law)
    answer, which, converged = _solutions(terms)
    lost = np.setdiff1d(np.arange(spin.size), which)
    nothing = np.full((lost.size, answer.shape[1]), complex(np.inf, 0.0))
    answer, which = np.concatenate((answer, nothing)), np.concatenate((which, lost))
    return _arranged(system, terms, place, answer, which, converged)


def _solutions(terms: Balance) -> tuple[Complex, Index, NDArray[np.bool_]]:
    """Coordinates of each solution, the speed it belongs to, and whether a speed's were found."""
    if not terms.fills:
        answer = solve_each(terms.stiffness, terms.force)
        bounded = np.asarray(np.isfinite(answer).all(axis=1))
        which = np.flatnonzero(bounded)
        return answer[which], which, bounded
    apart = np.abs(terms.plane - terms.plane[0])
    alike = bool(np.all(apart <= 1e-12 * np.abs(terms.plane).max()))
    return one_plane(terms) if alike else several_planes(terms)


def _arranged(
    system: RotorSystem,
    terms: Balance,
    place: float,
    answer: Complex,
    which: Index,
    converged: NDArray[np.bool_],
) -> CoupledResponse:
    """The solutions as tables over speed and branch, and the largest of each speed."""
    motion = orbit(system, answer, place)
    table, chosen = _ranked(motion, which, terms.speed.size)
    bounded = np.isfinite(np.abs(motion.forward[chosen]))
    q = np.where(bounded[:, None], answer[chosen], 0.0)
    forward = terms.forward(q)
    law = terms.liquid(which[chosen], np.abs(forward))
    offset, angle = _centre_of_mass(terms, forward, law)
    dry = orbit(system, unbalance_response(system, terms.speed), place)
    deflection = motion.forward[chosen]
    response = Response(
        speed=terms.speed,
        deflection=deflection,
        deflection_dry=dry.forward,
        liquid_offset=offset,
        liquid_angle=angle if terms.fills else np.angle(np.where(bounded, deflection, 0.0)),
        dry_patch=np.asarray(law.dry_patch.any(axis=1)),
        stable=bounded,
        model=np.full(terms.speed.shape, terms.model.name),
        in_range=np.asarray(law.in_range.all(axis=1)),
        converged=converged & bounded & law.converged.all(axis=1),
        branch_deflection=table[0],
        branch_stable=np.isfinite(table[0]),
    )
    return CoupledResponse(
        response=response,
        position=place,
        backward=motion.backward[chosen],
        backward_dry=dry.backward,
        branch_backward=table[1],
        coordinates=answer[chosen],
        chamber_forward=forward,
        chamber_backward=np.conj(0.5 * q @ terms.plane.T),
        residual=_residual(terms, q, forward, law),
    )


def _ranked(motion: Orbit, which: Index, speeds: int) -> tuple[Complex, Index]:
    """Both parts over speed and branch, by rising forward part, and the largest solution of each speed."""
    order = np.lexsort((np.abs(motion.forward), which))
    counts = np.bincount(which, minlength=speeds)
    column = np.arange(which.size) - np.repeat(np.cumsum(counts) - counts, counts)
    table = np.full((2, speeds, int(counts.max())), complex(np.nan, np.nan))
    table[:, which[order], column] = motion.forward[order], motion.backward[order]
    return table, order[np.cumsum(counts) - 1]


def _centre_of_mass(terms: Balance, forward: Complex, law: Liquid) -> tuple[Array, Array]:
    """Distance of all the liquid's centre of mass from the rotation axis, and its angle."""
    size = np.abs(forward)
    unit = np.divide(forward, size, out=np.zeros_like(forward), where=size > 0.0)
    moment = np.sum(law.unbalance * unit, axis=1)
    mass = sum(fill.mass for fill in terms.fills)
    return np.abs(moment) / mass if mass > 0.0 else np.zeros(len(forward)), np.angle(moment)


def _residual(terms: Balance, q: Complex, forward: Complex, law: Liquid) -> Array:
    """What is left of the balance of forces over the largest of them."""
    size = np.abs(forward)
    unit = np.divide(forward, size, out=np.zeros_like(forward), where=size > 0.0)
    held = np.einsum("kij,kj->ki", terms.stiffness, q)
    pull = np.square(terms.speed)[:, None] * ((law.unbalance * unit) @ terms.plane)
    scale = np.maximum(np.linalg.norm(held, axis=1), np.linalg.norm(terms.force, axis=1))
    left = np.linalg.norm(held - terms.force - pull, axis=1)
    return np.asarray(np.divide(left, scale, out=np.zeros(scale.shape), where=scale > 0.0))


def wet_critical_speeds(
    system: RotorSystem, fills: Sequence[Fill], gravity: float = 9.81, model: str = "auto"
) -> tuple[Array, Complex]:
    """Critical speeds with liquid at small deflections, dampers left out [theory: rotor, eq. 31].

    Parameters
    ----------
    system, fills, gravity, model : as in `coupled_response`

    Returns
    -------
    speed : rising, rad/s, shape (k,)
    shape : complex, shape (k, n)
    """
    law = synchronous_model(model)
    wet = [fill for fill in fills if fill.volume > 0.0]
    speed, shape = critical_speeds(system, _added_mass(system, wet, None, gravity, law))
    if gravity == 0.0 or not wet:
        return speed, shape
    # Upright, the liquid's share in the mass depends a little on the speed itself.
    for k in range(speed.size):
        for _ in range(30):
            again, shapes = critical_speeds(system, _added_mass(system, wet, float(speed[k]), gravity, law))
            if k >= again.size or abs(again[k] - speed[k]) <= 1e-12 * speed[k]:
                break
            speed[k], shape[k] = again[k], shapes[k]
    return speed, shape


def _added_mass(
    system: RotorSystem, wet: list[Fill], speed: float | None, gravity: float, law: LiquidModel
) -> Complex:
    """Mass matrix of the liquid in synchronous motion, at a speed or far above every other one."""
    n = len(system.coordinates)
    total = np.zeros((n, n), dtype=complex)
    for fill, p in zip(wet, directions(system, wet), strict=True):
        full = fill.added_mass
        if speed is not None:
            state = law.synchronous(Fills.of([fill]), np.array([speed]), np.zeros(1), np.array([gravity]))
            full = float(state.slope[0])
        total += 0.5 * full * np.outer(p, np.conj(p)) + 0.5 * backward_mass(fill) * np.outer(np.conj(p), p)
    return total
