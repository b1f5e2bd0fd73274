"""Synchronous answer of a rotor with liquid chambers: every branch at every speed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fluid.fill import Fill
from meshes.arrays import Array, Index
from meshes.errors import InputError
from solvers.roots import bracketed_root
from solvers.rotor.jeffcott import Jeffcott
from solvers.synchronous.branches import find_branches
from solvers.synchronous.models import synchronous_model
from solvers.synchronous.pairs import LiquidState, Pairs, PlanarMachine, pair_machines

_Value = TypeVar("_Value", bound=np.generic)


@dataclass(frozen=True)
class Response:
    """Unbalance response over speed.

    Angles are measured from the unbalance, positive with the spin; a lag is negative. n speeds, b branches.

    Parameters
    ----------
    speed : spin speed Omega, rad/s, shape (n,)
    deflection : complex deflection w of the branch reported, m, shape (n,): of the stable ones the largest,
        which is where a slow run-up of this hardening system arrives and the one to design for
    deflection_dry : the same rotor without liquid, m, shape (n,)
    liquid_offset : distance of the liquid's centre of mass from the rotation axis, m, shape (n,)
    liquid_angle : angle from the unbalance to the liquid's centre of mass, rad, shape (n,)
    dry_patch : the wall is dry somewhere in at least one chamber, shape (n,)
    stable : the branch reported is stable against slow disturbances, shape (n,)
    model : liquid model used, shape (n,)
    in_range : the model holds there, shape (n,)
    converged : every branch was found, shape (n,)
    branch_deflection : all branches by rising amplitude, m, shape (n, b), nan where there are fewer
    branch_stable : their stability, shape (n, b)
    """

    speed: NDArray[np.float64]
    deflection: NDArray[np.complex128]
    deflection_dry: NDArray[np.complex128]
    liquid_offset: NDArray[np.float64]
    liquid_angle: NDArray[np.float64]
    dry_patch: NDArray[np.bool_]
    stable: NDArray[np.bool_]
    model: NDArray[np.str_]
    in_range: NDArray[np.bool_]
    converged: NDArray[np.bool_]
    branch_deflection: NDArray[np.complex128]
    branch_stable: NDArray[np.bool_]


def synchronous_response(
    rotor: Jeffcott, fills: Sequence[Fill], speed: ArrayLike, gravity: float = 9.81, model: str = "auto"
) -> Response:
    """Deflection of a rotor with liquid in its chambers under its unbalance [theory: rotor, eq. 2].

    Parameters
    ----------
    rotor : the dry rotor
    fills : its chambers with their liquid, any number
    speed : spin speeds Omega, rad/s, shape (n,), > 0
    gravity : along the axis, m/s^2; 0 for a horizontal axis
    model : liquid model, `auto`, `statics` or `linear`

    Returns
    -------
    Response; `converged` is False where the deflection is unbounded (no damping at resonance)

    Raises
    ------
    InputError : a speed that is not positive and finite, an unknown model

    Examples
    --------
    >>> rotor = Jeffcott(mass=4.0, stiffness=4.4e4, damping=84.0, unbalance=6e-4)
    >>> answer = synchronous_response(rotor, [], [105.0, 200.0])
    >>> bool((answer.deflection == answer.deflection_dry).all())
    True
    """
    spin = np.array(speed, dtype=float).reshape(-1)
    owner = np.zeros(spin.size, dtype=np.intp)
    return machine_responses([(rotor, fills)], owner, spin, np.array([gravity]), model)


def machine_responses(
    machines: Sequence[PlanarMachine], owner: Index, speed: Array, gravity: Array, model: str = "auto"
) -> Response:
    """`synchronous_response` of many machines at once: of n pairs of a machine and a speed.

    Parameters
    ----------
    machines : rotors, each with its chambers and their liquid
    owner : which machine each pair has, shape (n,)
    speed : spin speeds Omega, rad/s, shape (n,), > 0
    gravity : along the axis of each machine, m/s^2, shape (machines,)
    model : liquid model, `auto`, `statics` or `linear`

    Returns
    -------
    Response over the pairs

    Raises
    ------
    InputError : a speed that is not positive and finite, an unknown model
    """
    if not np.all(np.isfinite(speed) & (speed > 0.0)):
        raise InputError("speed", speed.tolist(), "finite numbers above 0")
    pairs = pair_machines(machines, owner, speed, gravity, synchronous_model(model))
    dry = _divide(pairs.unbalance * np.square(speed), pairs.dynamic_stiffness)
    modulus, which, converged = _all_deflections(pairs)
    bounded = np.isfinite(modulus)
    deflection = np.where(bounded, modulus, 0.0)
    state = pairs.liquid(deflection, which)
    stable = bounded & _is_stable(pairs, which, deflection, state)
    phased = np.where(bounded, _with_phase(pairs, which, deflection, state), complex(np.inf, 0.0))
    table = _Table.arrange(speed.size, which, deflection, stable)
    chosen = table.reported
    farthest = np.array([max((f.chamber.radius for f in fills), default=0.0) for _, fills in machines])
    answer = phased[chosen]
    np.logical_and.at(converged, which, state.converged)
    return Response(
        speed=speed,
        deflection=answer,
        deflection_dry=dry,
        liquid_offset=_offset(pairs, farthest[owner], deflection[chosen], state.unbalance[chosen]),
        liquid_angle=np.angle(answer),
        dry_patch=state.dry_patch[chosen],
        stable=stable[chosen],
        model=np.full(speed.shape, pairs.model.name),
        in_range=state.in_range[chosen],
        converged=converged,
        branch_deflection=table.spread(phased, complex(np.nan, np.nan)),
        branch_stable=table.spread(stable, False),
    )


def critical_speed(
    rotor: Jeffcott, fills: Sequence[Fill], gravity: float = 9.81, model: str = "auto"
) -> float:
    """Speed at which a small deflection meets no stiffness: (M + dU/de) Omega^2 = K [theory: rotor, eq. 4].

    Parameters
    ----------
    rotor, fills, gravity, model : see `synchronous_response`

    Returns
    -------
    Omega, rad/s, between sqrt(K/(M + m_f)) and sqrt(K/M)
    """
    liquid = synchronous_model(model)
    wet, along = [fill for fill in fills if fill.volume > 0.0], np.array([gravity])

    def stiffness(speed: Array, _: Index) -> Array:
        pairs = pair_machines([(rotor, wet)], np.zeros(speed.size, dtype=np.intp), speed, along, liquid)
        slope = pairs.liquid(np.zeros_like(speed), np.arange(speed.size)).slope
        return np.asarray(rotor.stiffness - (rotor.mass + slope) * np.square(speed))

    # The slope of the unbalance never exceeds a full chamber's mass; a hair's breadth holds the rounding.
    heaviest = rotor.mass + sum(fill.added_mass for fill in wet)
    ends = np.sqrt(rotor.stiffness / np.array([heaviest, rotor.mass])) * np.array([1.0 - 1e-9, 1.0 + 1e-9])
    root, _ = bracketed_root(stiffness, ends[:1], ends[1:])
    return float(root[0])


def _divide(force: Array, stiffness: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """force/stiffness; infinite where an undamped rotor runs at its critical speed."""
    out = np.full(force.shape, complex(np.inf, 0.0))
    np.divide(force, stiffness, out=out, where=stiffness != 0.0)
    return np.where(force == 0.0, 0.0, out)


def _all_deflections(pairs: Pairs) -> tuple[Array, Index, NDArray[np.bool_]]:
    """Moduli of all solutions, the pair each belongs to, and whether a pair's are all there."""
    squared, limit = np.square(pairs.speed), pairs.limit
    force, damping = pairs.unbalance * squared, pairs.damping * pairs.speed
    straight = np.abs(_divide(force, pairs.dynamic_stiffness - pairs.added_mass * squared))
    linear = np.flatnonzero((straight <= limit) | (force == 0.0))

    elastic = pairs.stiffness - (pairs.mass + pairs.liquid_mass) * squared
    most = force + squared * pairs.reach
    by_damping, by_stiffness = np.full((2, squared.size), np.inf)
    np.divide(force, damping, out=by_damping, where=damping > 0.0)
    np.divide(most, np.abs(elastic), out=by_stiffness, where=elastic != 0.0)
    # No solution is farther out than the damper or the spring allows.
    reach = np.minimum(by_damping, by_stiffness) * (1.0 + 1e-9)
    bounded = np.isfinite(reach) | np.isinf(limit)
    stop = np.where(bounded & np.isfinite(limit), np.maximum(reach, limit), limit)
    # Without a force nothing moves, and there is nothing to look for.
    stop, force = np.where(force > 0.0, stop, limit), np.where(force > 0.0, force, 1.0)
    # The slope of the unbalance never exceeds a full chamber's mass; a hair's breadth holds the rounding.
    steepest = squared * (pairs.added_mass * (1.0 + 1e-9) - pairs.liquid_mass)
    bent, which, converged = find_branches(pairs.pull, elastic, damping, force, steepest, limit, stop)
    modulus, owner = np.concatenate((straight[linear], bent)), np.concatenate((linear, which))
    lost = np.setdiff1d(np.arange(squared.size), owner)
    if lost.size:
        converged[lost] = False
        modulus = np.concatenate((modulus, np.full(lost.size, np.inf)))
        owner = np.concatenate((owner, lost))
    at_rest = pairs.unbalance == 0.0
    return modulus, owner, (converged & bounded & np.isfinite(straight)) | at_rest


def _with_phase(pairs: Pairs, which: Index, deflection: Array, state: LiquidState) -> NDArray[np.complex128]:
    """Complex deflections: w lags the unbalance by the angle of the wet rotor's dynamic stiffness."""
    pull = np.square(pairs.speed[which]) * state.unbalance
    total = pairs.dynamic_stiffness[which] * deflection - pull
    return np.asarray(deflection * np.exp(-1j * np.angle(total)), dtype=complex)


def _is_stable(pairs: Pairs, which: Index, deflection: Array, state: LiquidState) -> NDArray[np.bool_]:
    """Stability against disturbances that are slow beside the liquid's waves [theory: rotor, eq. 8]."""
    spin, own, damping, stiffness = (
        x[which] for x in (pairs.speed, pairs.mass, pairs.damping, pairs.stiffness)
    )
    secant = np.divide(state.unbalance, deflection, out=state.slope.copy(), where=deflection > 0.0)
    mass = own + secant
    radial = stiffness - np.square(spin) * (own + state.slope)
    tangential = stiffness - np.square(spin) * (own + secant)
    matrix = np.zeros((which.size, 4, 4))
    matrix[:, 0, 2] = matrix[:, 1, 3] = 1.0
    matrix[:, 2, 0], matrix[:, 3, 1] = -radial / mass, -tangential / mass
    matrix[:, 2, 1], matrix[:, 3, 0] = damping * spin / mass, -damping * spin / mass
    matrix[:, 2, 2] = matrix[:, 3, 3] = -damping / mass
    matrix[:, 2, 3], matrix[:, 3, 2] = 2.0 * spin, -2.0 * spin
    roots = np.linalg.eigvals(matrix)
    # Without damping the roots are imaginary to rounding (square root of it where two meet).
    slack = 1e-7 * np.abs(roots).max(axis=1, initial=0.0)
    return np.asarray(roots.real.max(axis=1, initial=-np.inf) <= slack)


def _offset(pairs: Pairs, farthest: Array, deflection: Array, unbalance: Array) -> Array:
    """Distance of the liquid's centre of mass from the rotation axis; without liquid, that of a drop."""
    drop = np.where(deflection > 0.0, deflection + farthest, 0.0)
    return np.divide(unbalance, pairs.liquid_mass, out=drop, where=pairs.liquid_mass > 0.0)


@dataclass(frozen=True)
class _Table:
    """Where each solution stands in the table of branches: its row is the speed, its column the rank."""

    rows: Index
    columns: Index
    shape: tuple[int, int]
    reported: Index

    @classmethod
    def arrange(cls, speeds: int, which: Index, deflection: Array, stable: NDArray[np.bool_]) -> _Table:
        """Rank the solutions of each speed by amplitude; report the largest stable one, or the largest."""
        order = np.lexsort((deflection, which))
        counts = np.bincount(which, minlength=speeds)
        starts = np.concatenate(([0], np.cumsum(counts)[:-1]))
        columns = np.empty(which.size, dtype=np.intp)
        columns[order] = np.arange(which.size) - np.repeat(starts, counts)
        best = np.lexsort((deflection, stable, which))
        return cls(which, columns, (speeds, int(counts.max())), best[np.cumsum(counts) - 1])

    def spread(self, values: NDArray[_Value], missing: complex | bool) -> NDArray[_Value]:
        """Values of the solutions as a table (speed, branch), `missing` where there is none."""
        table = np.full(self.shape, missing, dtype=values.dtype)
        table[self.rows, self.columns] = values
        return table
