"""Synchronous answer of a rotor with liquid chambers: every branch at every speed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fluid.fill import Fill
from meshes.border import InputError
from solvers.bracket import bracketed_root
from solvers.branches import find_branches
from solvers.liquid_models import LiquidModel, synchronous_model
from solvers.rotor.jeffcott import Jeffcott

Array = NDArray[np.float64]
Index = NDArray[np.intp]
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


@dataclass(frozen=True)
class _Liquid:
    """All chambers together at (speed, deflection) pairs, shape (m,)."""

    unbalance: Array
    slope: Array
    dry_patch: NDArray[np.bool_]
    in_range: NDArray[np.bool_]
    converged: NDArray[np.bool_]


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
    if not np.all(np.isfinite(spin) & (spin > 0.0)):
        raise InputError("speed", spin.tolist(), "finite numbers above 0")
    liquid = synchronous_model(model)
    stiffness = rotor.dynamic_stiffness(spin)
    force = rotor.unbalance * np.square(spin)
    dry = _divide(force, stiffness)
    modulus, which, converged = _all_deflections(rotor, fills, spin, gravity, liquid)
    bounded = np.isfinite(modulus)
    deflection = np.where(bounded, modulus, 0.0)
    state = _evaluate(fills, spin[which], deflection, gravity, liquid)
    stable = bounded & _is_stable(rotor, spin[which], deflection, state)
    phased = np.where(bounded, _with_phase(rotor, spin[which], deflection, state), complex(np.inf, 0.0))
    table = _Table.arrange(spin.size, which, deflection, stable)
    chosen = table.reported
    offset = _offset(fills, deflection[chosen], state.unbalance[chosen])
    answer = phased[chosen]
    np.logical_and.at(converged, which, state.converged)
    return Response(
        speed=spin,
        deflection=answer,
        deflection_dry=dry,
        liquid_offset=offset,
        liquid_angle=np.angle(answer),
        dry_patch=state.dry_patch[chosen],
        stable=stable[chosen],
        model=np.full(spin.shape, liquid.name),
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
    wet = [fill for fill in fills if fill.volume > 0.0]

    def stiffness(speed: Array, _: Index) -> Array:
        slope = _evaluate(wet, speed, np.zeros_like(speed), gravity, liquid).slope
        return np.asarray(rotor.stiffness - (rotor.mass + slope) * np.square(speed))

    # The slope of the unbalance never exceeds a full chamber's mass; a hair's breadth holds the rounding.
    heaviest = rotor.mass + sum(fill.full_mass for fill in wet)
    ends = np.sqrt(rotor.stiffness / np.array([heaviest, rotor.mass])) * np.array([1.0 - 1e-9, 1.0 + 1e-9])
    root, _ = bracketed_root(stiffness, ends[:1], ends[1:])
    return float(root[0])


def _divide(force: Array, stiffness: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """force/stiffness; infinite where an undamped rotor runs at its critical speed."""
    out = np.full(force.shape, complex(np.inf, 0.0))
    np.divide(force, stiffness, out=out, where=stiffness != 0.0)
    return np.where(force == 0.0, 0.0, out)


def _evaluate(
    fills: Sequence[Fill], speed: Array, deflection: Array, gravity: float, model: LiquidModel
) -> _Liquid:
    """Sum of the chambers at each pair."""
    none = np.zeros(speed.shape)
    yes, no = np.ones(speed.shape, dtype=bool), np.zeros(speed.shape, dtype=bool)
    total = _Liquid(none, none, no, yes, yes)
    for fill in fills:
        one = model.synchronous(fill, speed, deflection, gravity)
        total = _Liquid(
            unbalance=total.unbalance + one.unbalance,
            slope=total.slope + one.slope,
            dry_patch=total.dry_patch | (one.dry_patch & (fill.volume > 0.0)),
            in_range=total.in_range & one.in_range,
            converged=total.converged & one.converged,
        )
    return total


def _all_deflections(
    rotor: Jeffcott, fills: Sequence[Fill], speed: Array, gravity: float, model: LiquidModel
) -> tuple[Array, Index, NDArray[np.bool_]]:
    """Moduli of all solutions, the speed each belongs to, and whether a speed's are all there."""
    everyone = np.arange(speed.size)
    if rotor.unbalance == 0.0:
        return np.zeros_like(speed), everyone, np.ones(speed.shape, dtype=bool)
    wet = [fill for fill in fills if fill.volume > 0.0]
    force, damping = rotor.unbalance * np.square(speed), rotor.damping * speed
    limits = [model.linear_limit(fill, speed, gravity) for fill in wet]
    limit = np.min(limits, axis=0) if limits else np.full(speed.shape, np.inf)
    added = rotor.dynamic_stiffness(speed) - sum(fill.full_mass for fill in wet) * np.square(speed)
    straight = np.abs(_divide(force, added))
    linear = np.flatnonzero(straight <= limit)

    elastic = rotor.stiffness - (rotor.mass + sum(fill.mass for fill in wet)) * np.square(speed)
    most = force + np.square(speed) * sum(fill.mass * fill.chamber.radius for fill in wet)
    by_damping, by_stiffness = np.full((2, speed.size), np.inf)
    np.divide(force, damping, out=by_damping, where=damping > 0.0)
    np.divide(most, np.abs(elastic), out=by_stiffness, where=elastic != 0.0)
    # No solution is farther out than the damper or the spring allows.
    reach = np.minimum(by_damping, by_stiffness) * (1.0 + 1e-9)
    bounded = np.isfinite(reach) | np.isinf(limit)

    def pull(deflection: Array, which: Index) -> Array:
        """Liquid's pull beyond its mass at the chamber's centre; never decreases with the deflection."""
        state = _evaluate(wet, speed[which], deflection, gravity, model)
        own = sum(fill.mass for fill in wet) * deflection
        return np.asarray(np.square(speed[which]) * np.maximum(state.unbalance - own, 0.0))

    stop = np.where(bounded & np.isfinite(limit), np.maximum(reach, limit), limit)
    bent, which, converged = find_branches(pull, elastic, damping, force, limit, stop)
    modulus, owner = np.concatenate((straight[linear], bent)), np.concatenate((linear, which))
    lost = np.setdiff1d(everyone, owner)
    if lost.size:
        converged[lost] = False
        modulus = np.concatenate((modulus, np.full(lost.size, np.inf)))
        owner = np.concatenate((owner, lost))
    return modulus, owner, converged & bounded & np.isfinite(straight)


def _with_phase(rotor: Jeffcott, speed: Array, deflection: Array, state: _Liquid) -> NDArray[np.complex128]:
    """Complex deflections: w lags the unbalance by the angle of the wet rotor's dynamic stiffness."""
    stiffness = rotor.dynamic_stiffness(speed)
    pull = np.square(speed) * state.unbalance
    total = stiffness * deflection - pull
    return np.asarray(deflection * np.exp(-1j * np.angle(total)), dtype=complex)


def _is_stable(rotor: Jeffcott, speed: Array, deflection: Array, state: _Liquid) -> NDArray[np.bool_]:
    """Stability against disturbances that are slow beside the liquid's waves [theory: rotor, eq. 8]."""
    secant = np.divide(state.unbalance, deflection, out=state.slope.copy(), where=deflection > 0.0)
    mass, spin, damping = rotor.mass + secant, speed, rotor.damping
    radial = rotor.stiffness - np.square(spin) * (rotor.mass + state.slope)
    tangential = rotor.stiffness - np.square(spin) * (rotor.mass + secant)
    matrix = np.zeros((speed.size, 4, 4))
    matrix[:, 0, 2] = matrix[:, 1, 3] = 1.0
    matrix[:, 2, 0], matrix[:, 3, 1] = -radial / mass, -tangential / mass
    matrix[:, 2, 1], matrix[:, 3, 0] = damping * spin / mass, -damping * spin / mass
    matrix[:, 2, 2] = matrix[:, 3, 3] = -damping / mass
    matrix[:, 2, 3], matrix[:, 3, 2] = 2.0 * spin, -2.0 * spin
    roots = np.linalg.eigvals(matrix)
    # Without damping the roots are imaginary to rounding (square root of it where two meet).
    slack = 1e-7 * np.abs(roots).max(axis=1, initial=0.0)
    return np.asarray(roots.real.max(axis=1, initial=-np.inf) <= slack)


def _offset(fills: Sequence[Fill], deflection: Array, unbalance: Array) -> Array:
    """Distance of the liquid's centre of mass from the rotation axis; without liquid, that of a drop."""
    mass = sum(fill.mass for fill in fills)
    if mass > 0.0:
        return unbalance / mass
    farthest = max((fill.chamber.radius for fill in fills), default=0.0)
    return np.where(deflection > 0.0, deflection + farthest, 0.0)


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
