"""Answer of any rotor with liquid chambers to its unbalance, by harmonic balance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fluid.fill import Fill, Fills
from meshes.border import InputError
from solvers.coupled_branches import one_plane, several_planes
from solvers.coupled_terms import Balance, Liquid, backward_mass, balance, directions
from solvers.liquid_models import LiquidModel, synchronous_model
from solvers.response import Response
from solvers.rotor.system import RotorSystem
from solvers.rotor.vibration import Orbit, critical_speeds, orbit, solve_each, unbalance_response

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Index = NDArray[np.intp]


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
