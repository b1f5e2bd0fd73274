"""Balance of a rotor whose axis goes round in circles, with its layers [theory: whirl, eq. 24].

All that moves in circles with the spin is written in complex coordinates c, half as many as the rotor's real
ones: the deflection of an axis is row c, and the whirl c e^{i omega t}.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.whirl import Layer, is_full, plane_layer
from meshes.arrays import Array, Complex
from solvers.rotor.system import Rotor, RotorSystem

_ALIKE = 1e-9  # relative
_ROUND = 1e-7  # of a circle: how much of an ellipse may be in it
_WAY = np.array([1.0, -1j])  # a circle's two directions; with the spin


class NotCircularError(Exception):
    """The rotor does not whirl in circles; the text says why."""


@dataclass(frozen=True)
class Place:
    """A layer of the machine, or several that are alike and move alike."""

    fill: Fill  #: chamber and liquid of one of them
    layer: Layer  #: as small whirls meet it
    row: Complex  #: deflection of its axis for unit coordinates, complex, shape (p,)
    full_mass: float  #: of all of them, m_f of full cylinders and that of the liquid, kg
    mass: float
    which: tuple[int, ...]  #: indices of them among the fills


@dataclass(frozen=True)
class Circular:
    """[K - omega^2 M + i omega (C + Omega G)] c = omega^2 sum_j m_fj row_j^* G_j row_j c; p coordinates."""

    mass: Complex  #: complex, shape (p, p)
    damping: Complex
    gyroscopic: Complex
    stiffness: Complex
    places: tuple[Place, ...]  #: of the layers
    rows: Complex  #: deflection of every chamber's axis for unit coordinates, shape (chambers, p)

    def dynamic_stiffness(self, whirl_speed: float, spin: float) -> Complex:
        """K - omega^2 M + i omega (C + Omega G), shape (p, p)."""
        damping = self.damping + spin * self.gyroscopic
        return np.asarray(self.stiffness - whirl_speed**2 * self.mass + 1j * whirl_speed * damping)

    def gap(self, whirl_speed: float, spin: float, moved: Complex, forces: Sequence[complex]) -> Complex:
        """What is left of the balance, given G of each place, N in the coordinates' units, shape (p,)."""
        left = self.dynamic_stiffness(whirl_speed, spin) @ moved
        for place, force in zip(self.places, forces, strict=True):
            left = left - whirl_speed**2 * place.full_mass * force * (place.row @ moved) * place.row.conj()
        return np.asarray(left)


def circular(system: RotorSystem, fills: Sequence[Fill], friction: Friction) -> Circular:
    """A rotor's circles and the layers on them.

    A `NotCircularError` for unlike supports, baffles in the liquid, no layer.
    """
    if any(fill.uneven for fill in fills if fill.volume > 0.0):
        raise NotCircularError(
            "the long waves of limit cycles know no baffles and no other sections than rings"
        )
    mass = np.array(system.mass, dtype=float)
    for fill in fills:
        if is_full(fill):
            at = system.at(fill.chamber.plane)
            mass = mass + fill.mass * at.T @ at
    layers = {k: plane_layer(fill, friction) for k, fill in enumerate(fills)}
    wet = {k: layer for k, layer in layers.items() if layer is not None}
    if not wet:
        raise NotCircularError("no chamber has a layer with a free surface")
    planes = [system.at(fill.chamber.plane) for fill in fills]
    basis = _circles(system, mass, planes)
    rows = np.array([0.5 * _WAY.conj() @ plane @ basis for plane in planes])

    def seen(matrix: Array) -> Complex:
        return np.asarray(0.5 * basis.conj().T @ matrix @ basis)

    return Circular(
        mass=seen(mass),
        damping=seen(system.damping),
        gyroscopic=seen(system.gyroscopic),
        stiffness=seen(system.stiffness),
        places=_places(fills, wet, rows),
        rows=rows,
    )


def not_circular(rotor: Rotor, fills: Sequence[Fill], friction: Friction) -> str:
    """Why a rotor's self-excited whirls are no circles, whatever its chambers hold; empty where they are."""
    half = [replace(fill, volume=0.5 * fill.chamber.capacity) for fill in fills if not fill.uneven]
    try:
        circular(rotor.system(), half if len(half) == len(fills) else fills, friction)
    except NotCircularError as why:
        return str(why)
    return ""


def _places(fills: Sequence[Fill], wet: dict[int, Layer], rows: Complex) -> tuple[Place, ...]:
    """Layers, those that are alike and move alike as one."""
    found: list[Place] = []
    for k, layer in wet.items():
        fill = fills[k]
        for i, other in enumerate(found):
            # Alike is what the long waves know of a layer.
            mine, its = (
                np.array([f.chamber.radius, f.depth, f.chamber.height, f.liquid.viscosity, f.liquid.density])
                for f in (fill, other.fill)
            )
            scale = np.abs(rows).max()
            together = np.abs(other.row - rows[k]).max() <= _ALIKE * scale
            if together and np.all(np.abs(mine - its) <= _ALIKE * its):
                found[i] = Place(
                    other.fill,
                    other.layer,
                    other.row,
                    other.full_mass + fill.full_mass,
                    other.mass + fill.mass,
                    (*other.which, k),
                )
                break
        else:
            found.append(Place(fill, layer, rows[k], fill.full_mass, fill.mass, (k,)))
    return tuple(found)


def _circles(system: RotorSystem, mass: Array, planes: Sequence[Array]) -> Complex:
    """Coordinates that circles of the chambers' axes bring with them, of unit mass, shape (n, p).

    The smallest space that holds the answers to forces on the chambers which turn with the spin; in isotropic
    supports no axis moves against the spin in it.
    """
    root = np.linalg.cholesky(mass)
    inverse = np.linalg.inv(root)
    parts = [inverse @ m @ inverse.T for m in (system.stiffness, system.damping, system.gyroscopic)]
    parts = [part / (np.abs(part).max() or 1.0) for part in parts]
    basis = np.zeros((len(root), 0), dtype=complex)
    fresh = np.column_stack([inverse @ plane.T @ _WAY for plane in planes])
    while fresh.shape[1]:
        fresh = fresh / np.maximum(np.linalg.norm(fresh, axis=0), 1e-300)
        for _ in range(2):
            fresh = fresh - basis @ (basis.conj().T @ fresh)
        left, size, _ = np.linalg.svd(fresh, full_matrices=False)
        kept = left[:, size > _ROUND]
        basis = np.column_stack([basis, kept])
        fresh = np.column_stack([part @ kept for part in parts])
    # Half of the real mass: a circle moves in two directions.
    basis = np.asarray(inverse.T @ basis) * np.sqrt(2.0)
    along = np.array([0.5 * _WAY.conj() @ plane @ basis for plane in planes])
    against = np.array([0.5 * _WAY @ plane @ basis for plane in planes])
    if np.abs(against).max() > 10.0 * _ROUND * np.abs(along).max():
        raise NotCircularError(
            "the supports are not equal, the whirl is an ellipse; ask for a time-domain state of `run`"
        )
    return np.asarray(basis)
