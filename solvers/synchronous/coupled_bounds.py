"""Errors of the linear law in the answer of a rotor that tilts or has unlike springs, from closed forms."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fluid.fill import Fill, Fills
from meshes.arrays import Array, Complex
from solvers.rotor.system import RotorSystem
from solvers.rotor.vibration import solve_each
from solvers.statics.law_defect import Surfaces, defect_bound, upright_surfaces
from solvers.synchronous.balance import Balance, directions_at, harmonic_balance
from solvers.synchronous.errors import ROUNDING, LinearError, law_error
from solvers.synchronous.models import LINEAR

_ROUNDS = 8  # of the bound on the largest deflections


def coupled_error(
    system: RotorSystem,
    fills: Sequence[Fill],
    speed: Array,
    gravity: float,
    position: float,
    across: float = 0.0,
) -> tuple[LinearError, Array]:
    """Errors in the motion of any rotor: of the linear law, and by gravity across the axis.

    [theory: model_error, eq. 17 to 19 and 21]

    Parameters
    ----------
    system : the dry rotor
    fills : its chambers with their liquid, any number
    speed : spin speeds Omega, rad/s, shape (s,), > 0
    gravity : along the axis, m/s^2
    position : of the plane whose amplitude is reported, m
    across : gravity across the axis, m/s^2

    Returns
    -------
    Of the linear law; by gravity, as `solvers.synchronous.enclosure.planar_gravity_error`, shape (s,)
    """
    terms = harmonic_balance(system, fills, speed, gravity, LINEAR)
    if not terms.fills:
        nothing = np.full(speed.shape, ROUNDING)
        exact = LinearError(nothing, nothing, np.ones(speed.shape, dtype=bool), np.zeros(speed.shape))
        return exact, np.zeros(speed.shape)
    full, own, radius, depth = np.array(
        [(fill.added_mass, fill.mass, fill.chamber.radius, fill.depth) for fill in terms.fills]
    ).T
    place = np.concatenate((terms.plane, directions_at(system, [position])))
    answer, spread = _answer(terms, full, place)
    frozen, far = _answer(terms, own, place)
    chambers, upright = len(terms.fills), np.full(speed.size, gravity)
    each = [Fills.same(fill, speed.size) for fill in terms.fills]
    surfaces = [upright_surfaces(same, speed, upright) for same in each]
    linear = np.abs(answer[0][:, :chambers])
    most = _largest(
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
    thrown = _shift(spread, np.square(speed)[:, None] * full * most * change)
    return found, np.asarray(change.max(axis=1) + _part(thrown, size))


def _largest(
    linear: Array,
    spread: Array,
    frozen: Array,
    far: Array,
    surfaces: list[Surfaces],
    speed: Array,
    dead: Array,
) -> Array:
    """Bounds of the deflections at the chambers, m, shape (s, c) [theory: model_error, eq. 17 and 18].

    `dead` is the liquids' mass times radius: beyond its mass at the chamber's centre the liquid has less.
    """
    most = frozen + _carried(far, np.square(speed)[:, None] * dead)
    for _ in range(_ROUNDS):
        most = np.minimum(most, linear + _carried(spread, _missing(surfaces, speed, most)))
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
    """Parts with and against the spin at each place, and what a unit force on a chamber adds to them.

    Parameters
    ----------
    terms : of the balance
    mass : that each chamber adds to the part that goes with the spin, kg, shape (c,)
    place : p of each place, the chambers first, shape (k, n)
    """
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
    return np.where(change == 0.0, 0.0, out) + ROUNDING
