"""Balance quality: residual unbalance over mass times the service speed, and the grades of ISO 21940-11.

The standard speaks of a rigid rotor without liquid; its G is no measured vibration velocity. With liquid the
total unbalance that turns with the rotor takes its place: what a rotor without liquid would need to move as
the machine does [theory: balance_quality, eq. 1-3].
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array, Complex
from meshes.errors import InputError
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import Rotor, RotorSystem
from solvers.rotor.tub import Tub
from solvers.rotor.two_plane import TwoPlane
from solvers.rotor.vibration import dynamic_stiffness

# Grades of the standard, m/s; each about two and a half times the one before [ISO16].
GRADES = tuple(
    1e-3 * millimetres
    for millimetres in (0.4, 1.0, 2.5, 6.3, 16.0, 40.0, 100.0, 250.0, 630.0, 1600.0, 4000.0)
)
_LEAST_SHARE, _MOST_SHARE = 0.3, 0.7  # of the permissible unbalance that a plane may have [ISO16]
_ROUNDING = 1e-9  # relative; a quality that is a grade to rounding has that grade


def grade_of(quality: float) -> float | None:
    """The finest grade of ISO 21940-11 that a balance quality keeps.

    Both in m/s; None above the coarsest grade, or where the quality is not finite.
    """
    if not math.isfinite(quality):
        return None
    return next((grade for grade in GRADES if quality <= grade * (1.0 + _ROUNDING)), None)


def grade_name(grade: float) -> str:
    """A grade as the standard writes it."""
    return f"G {grade * 1e3:.6g}"


@dataclass(frozen=True)
class TolerancePlane:
    """A plane across the axis in which an unbalance is compared with its share of the permissible one."""

    position: float  #: along the axis, m
    mass: float  #: share of the rotor's mass, kg


def tolerance_planes(rotor: Rotor) -> tuple[TolerancePlane, ...]:
    """Planes in which the unbalance of a rotor is judged [theory: balance_quality, eq. 3].

    Two for a rigid rotor on supports at two or more places: the outermost ones, each with its share of the
    mass, from 0.3 to 0.7. One (resultant, no couple) for a Jeffcott rotor, a tub and supports at one place;
    none where no mass spins.
    """
    if isinstance(rotor, Tub):
        return (TolerancePlane(0.0, rotor.drum_mass),) if rotor.drum_mass > 0.0 else ()
    if not isinstance(rotor, Jeffcott | TwoPlane):
        raise InputError("rotor", type(rotor).__name__, "a Jeffcott rotor, a two-plane rotor or a tub")
    places = [support.position for support in rotor.supports] if isinstance(rotor, TwoPlane) else [0.0]
    first, last = min(places), max(places)
    if last == first:
        return (TolerancePlane(first, rotor.mass),)
    share = min(max(last / (last - first), _LEAST_SHARE), _MOST_SHARE)
    return TolerancePlane(first, share * rotor.mass), TolerancePlane(last, (1.0 - share) * rotor.mass)


def residual_unbalance(system: RotorSystem, generalised: Complex, positions: ArrayLike) -> Complex:
    """Unbalances in one or two planes that act as a generalised one does [theory: balance_quality, eq. 2].

    From shape (s, n) on its coordinates to (s, planes), kg m, turning with the spin; of a single plane the
    resultant.
    """
    wanted = np.atleast_1d(np.asarray(positions, dtype=float))
    places = wanted if wanted.size == 2 else np.array([wanted[0], wanted[0] + 1.0])
    turning = np.array([1.0, -1j])
    p = np.stack([system.at(place).T @ turning for place in places.tolist()], axis=1)
    # Forces against the spin are there too, of layers that hardly follow; they are not the rotor's.
    columns = np.hstack((p, np.conj(p)))
    found, *_ = np.linalg.lstsq(columns, generalised.T, rcond=1e-10)
    planes = found[:2].T
    return np.asarray(planes if wanted.size == 2 else planes.sum(axis=1, keepdims=True))


def balance_quality(rotor: Rotor, speed: ArrayLike, coordinates: Complex | None = None) -> Array:
    """Balance quality of a machine, m/s, shape (s,) [theory: balance_quality, eq. 1-3].

    That of the worst plane, from the complex amplitudes with liquid, shape (s, n), or of the rotor by itself
    if these are None; infinite where the motion is, nan where no mass spins.

    Examples
    --------
    >>> rotor = Jeffcott(mass=4.0, stiffness=4.4e4, damping=84.0, unbalance=6e-4)
    >>> [round(1e3 * quality, 3) for quality in balance_quality(rotor, [100.0, 200.0]).tolist()]
    [15.0, 30.0]
    """
    omega, system = np.atleast_1d(np.asarray(speed, dtype=float)), rotor.system()
    planes = tolerance_planes(rotor)
    if not planes:
        return np.full(omega.shape, np.nan)
    bounded = np.ones(omega.size, dtype=bool)
    total = np.broadcast_to(system.unbalance, (omega.size, system.unbalance.size))
    if coordinates is not None:
        bounded = np.asarray(np.isfinite(coordinates).all(axis=1))
        moved = np.where(bounded[:, None], coordinates, 0.0)
        held = np.einsum("sij,sj->si", dynamic_stiffness(system, omega), moved)
        total = held / np.square(omega)[:, None]
    sizes = np.abs(residual_unbalance(system, total, [plane.position for plane in planes]))
    each = sizes * omega[:, None] / np.array([plane.mass for plane in planes])
    return np.where(bounded, each.max(axis=1), np.inf)
