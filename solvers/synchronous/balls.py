"""Steady states of a rotor with balls and liquid: the liquid's share follows each state's own deflection."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from fluid.fill import Fill, Fills
from meshes.arrays import Array, Complex, Flags
from meshes.errors import InputError
from solvers.liquid_model import LiquidModel, Whirls
from solvers.rotor.balls.balancers import BallRace
from solvers.rotor.balls.states import RotorWithBalls
from solvers.rotor.balls.steady import (
    BallStates,
    attracting,
    begin_joined,
    collected,
    starts_of,
    steady_states,
)
from solvers.rotor.system import RotorSystem
from solvers.synchronous.balance import backward_mass, directions
from solvers.synchronous.models import STATICS

_ROUNDS = 60
_AGREES = 1e-9  # of the liquid's share in the mass, between two rounds


@dataclass(frozen=True)
class WetStates:
    """States with liquid; s speeds, b states, l chambers."""

    states: BallStates  #: of the balls
    #: first moment of each chamber's liquid about the rotation axis, kg m, complex, in the drum, shape (s, b,
    #: l); nan where there is no state
    liquid: Complex
    dry_patch: Flags  #: a wall is dry over its whole height somewhere, shape (s, b)


def wet_states(
    system: RotorSystem,
    fills: Sequence[Fill],
    races: Sequence[BallRace],
    speed: ArrayLike,
    gravity: float = 0.0,
    model: LiquidModel = STATICS,
) -> WetStates:
    """Steady states of balls and liquid in one drum [theory: races, eq. 8].

    At each round the liquid counts as the mass that its unbalance is over the deflection, and the balls
    settle anew. States that do not converge so are left out.
    """
    spin = np.array(speed, dtype=float).reshape(-1)
    wet = [fill for fill in fills if fill.volume > 0.0]
    if not wet:
        states = steady_states(system, races, spin)
        shape = states.kind.shape
        return WetStates(states, np.zeros((*shape, len(fills)), dtype=complex), np.zeros(shape, dtype=bool))
    if not races:
        raise InputError("races", 0, "one or more")
    if not np.all(np.isfinite(spin) & (spin > 0.0)):
        raise InputError("speed", spin.tolist(), "finite numbers above 0")
    machine, starts = RotorWithBalls(system, tuple(races)), starts_of([len(race.masses) for race in races])
    small = _masses(model, wet, spin, np.zeros((spin.size, len(wet))), gravity)
    compliance = machine.compliance(spin, _added(system, wet, small))
    each, many = np.repeat(compliance, len(starts), axis=0), np.repeat(spin, len(starts))
    joined = begin_joined(spin.size)
    places, rests = machine.settle(each, np.tile(starts, (spin.size, 1)), joined=joined)
    mass, going = np.repeat(small, len(starts), axis=0), np.arange(many.size)
    for _ in range(_ROUNDS):
        seen = _seen(system, wet, machine.coordinates(each[going], places[going]))
        found = _masses(model, wet, many[going], np.abs(seen), gravity)
        far = np.abs(found - mass[going]).max(axis=1) > _AGREES * small.max()
        going, found = going[far], found[far]
        if not going.size:
            break
        # The mean of two rounds in a row: a wall that dries makes them overshoot.
        mass[going] = 0.5 * (mass[going] + found)
        each[going] = machine.compliance(many[going], _added(system, wet, mass[going]))
        places[going], rests[going] = machine.settle(each[going], places[going], joined=joined[going])
    agrees = np.ones(many.size, dtype=bool)
    agrees[going] = False
    shape = spin.size, len(starts)
    own = each.reshape(*shape, *each.shape[1:])
    kept = (rests & agrees & attracting(machine, each, places, len(starts))).reshape(shape)
    states = collected(machine, spin, own, places.reshape(*shape, -1), kept, _in_step(system, wet, small))
    return _with_liquid(model, system, fills, wet, states, gravity)


def in_step(
    system: RotorSystem,
    fills: Sequence[Fill],
    speed: float,
    gravity: float = 0.0,
    model: LiquidModel = STATICS,
) -> RotorSystem:
    """The rotor with its liquid as a mass in step with the axis, for small motions about a balanced state.

    [theory: races, eq. 8]
    """
    wet = [fill for fill in fills if fill.volume > 0.0]
    if not wet:
        return system
    masses = _masses(model, wet, np.array([speed]), np.zeros((1, len(wet))), gravity)
    return replace(system, mass=system.mass + _in_step(system, wet, masses)[0])


def _masses(model: LiquidModel, wet: Sequence[Fill], spin: Array, deflection: Array, gravity: float) -> Array:
    """Unbalance of each liquid over the deflection, kg, shape (p, l)."""
    found = np.zeros(deflection.shape)
    for j, fill in enumerate(wet):
        whirls = Whirls.synchronous(spin, deflection[:, j], np.full(spin.size, gravity))
        answer = model.answer(Fills.of([fill]).at(np.zeros(spin.size, dtype=np.intp)), whirls)
        slope, moved = answer.slope, deflection[:, j] > 0.0
        found[:, j] = np.divide(answer.unbalance.real, deflection[:, j], out=slope.copy(), where=moved)
    return found


def _added(system: RotorSystem, wet: Sequence[Fill], mass: Array) -> Complex:
    """The liquid's share in the mass matrix in synchronous motion, shape (p, n, n)."""
    total = np.zeros((mass.shape[0], *system.mass.shape), dtype=complex)
    for j, (fill, p) in enumerate(zip(wet, directions(system, wet), strict=True)):
        total += 0.5 * mass[:, j, None, None] * np.outer(p, np.conj(p))
        total += 0.5 * backward_mass(fill) * np.outer(np.conj(p), p)
    return total


def _in_step(system: RotorSystem, wet: Sequence[Fill], mass: Array) -> Array:
    """The liquid's share in the mass matrix in slow motion as seen from the rotor, shape (p, n, n).

    It then answers as at rest in the rotor, in both directions, unlike in the backward whirl on unlike
    supports.
    """
    planes = np.array([system.at(fill.chamber.plane) for fill in wet])
    return np.asarray(np.einsum("pj,jai,jak->pik", mass, planes, planes))


def _seen(system: RotorSystem, fills: Sequence[Fill], coordinates: Complex) -> Complex:
    """Forward deflection of each chamber's axis, m, shape (..., l)."""
    return np.asarray(0.5 * coordinates @ directions(system, fills).conj().T)


def _with_liquid(
    model: LiquidModel,
    system: RotorSystem,
    fills: Sequence[Fill],
    wet: Sequence[Fill],
    states: BallStates,
    gravity: float,
) -> WetStates:
    """Where the liquid is in each state."""
    shape = states.kind.shape
    seen = _seen(system, fills, np.nan_to_num(states.coordinates))
    moment, dry = np.zeros((*shape, len(fills)), dtype=complex), np.zeros(shape, dtype=bool)
    many = np.repeat(states.speed, shape[1])
    for j, fill in enumerate(fills):
        if fill not in wet:
            continue
        size = np.abs(seen[..., j]).reshape(-1)
        whirls = Whirls.synchronous(many, size, np.full(many.size, gravity))
        answer = model.answer(Fills.of([fill]).at(np.zeros(many.size, dtype=np.intp)), whirls)
        along = np.exp(1j * np.angle(seen[..., j]))
        moment[..., j] = answer.unbalance.reshape(shape) * along
        dry |= answer.dry_patch.reshape(shape)
    moment[states.kind == 0] = complex(np.nan, np.nan)
    return WetStates(states, moment, dry & (states.kind != 0))
