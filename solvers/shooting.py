"""Fixed points of the map of a period, and the multipliers of small changes of them.

The map is known by its values alone, and takes most changes to a fraction of themselves
[theory: held, eq. 19-23].
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from meshes.arrays import Array, Complex

Map = Callable[[Array], Array]

# Pairs of states that a step is made of; singular values below this share of the largest are noise.
_KEPT, _NOISE = 20, 1e-10
# A fixed point is given up where so many turns have not brought the change down to this share.
_PATIENCE, _SHARE = 12, 0.3
_DIFFERENCE = 1e-6  # of a state, for derivatives
# Directions from which on a map is told to be stable, and at most; between two looks.
_FEWEST, _MOST, _EVERY = 12, 64, 2
_LEADING = 4  # multipliers that have to come out: two pairs


@dataclass(frozen=True)
class Krylov:
    """A map about a point in an orthonormal basis, whose directions it leaves by little."""

    basis: Array  #: shape (n, m)
    action: Array  #: of the derivative in the basis, shape (m, m)
    left: float  #: by which the derivative leads out of the last direction

    @property
    def multipliers(self) -> tuple[Complex, Array]:
        """Ritz values, the largest first, and their residuals, shape (m,) [theory: held, eq. 23]."""
        values, vectors = np.linalg.eig(self.action)
        order = np.argsort(-np.abs(values), kind="stable")
        return values[order], self.left * np.abs(vectors[-1, order])

    @property
    def stable(self) -> bool | None:
        """Whether all small changes decay; None where the directions are too few to tell."""
        values, errors = self.multipliers
        size = np.abs(values)
        if np.any(size - errors > 1.0):
            return False
        # Those further in come out last, and are no larger.
        sure = size.max() < 1.0 and np.all((size + errors)[:_LEADING] < 1.0)
        return True if sure else None

    def leading(self) -> Array:
        """A change in the directions of the largest multipliers, shape (n,)."""
        values, vectors = np.linalg.eig(self.action)
        first = np.argsort(-np.abs(values), kind="stable")[:_LEADING]
        # Of a pair both parts, so that the sum is in the plane that it turns in.
        return np.asarray(self.basis @ (vectors[:, first].real + vectors[:, first].imag).sum(axis=1))

    def resolved(self, change: Array) -> Array:
        """What has to be added to a point that the map changes by this [theory: held, eq. 21]."""
        seen = self.basis.T @ change
        more = np.linalg.solve(np.eye(seen.size) - self.action, seen) - seen
        return np.asarray(change + self.basis @ more)

    def moved(self, onto: Callable[[Array], Array]) -> Krylov:
        """The same on another mesh, onto which a state is taken by a linear function."""
        basis, change = np.linalg.qr(np.stack([onto(row) for row in self.basis.T], axis=1))
        action = change @ np.linalg.solve(change.T, self.action.T).T
        return Krylov(basis, action, self.left)


@dataclass(frozen=True)
class FixedPoint:
    """Where the turns of a map have led."""

    point: Array
    image: Array  #: what the map makes of it
    change: float  #: that is left, in the norm of the states
    turns: int  #: what it took


def fixed_point(
    turn: Map, start: Array, tolerance: float, most: int, known: Krylov | None = None
) -> FixedPoint:
    """Fixed point of a map near a start, by Newton's method on what its values tell of its derivative.

    Steps are those of Anderson's mixing, each of one turn [theory: held, eq. 20 and 21]; `known` is the map
    about a point nearby. Its change is above the tolerance where it was not found in so many turns.
    """
    points: list[Array] = []
    changes: list[Array] = []
    point, begun = start, math.inf
    for turns in range(1, most + 1):
        image = turn(point)
        change = image - point if known is None else known.resolved(image - point)
        left = float(np.linalg.norm(change))
        begun = min(begun, left) if turns == 1 else begun
        stuck = turns >= _PATIENCE and left > _SHARE * begun
        if not left > tolerance or turns == most or stuck or not math.isfinite(left):
            return FixedPoint(point, image, left, turns)
        points, changes = [*points[-_KEPT:], point], [*changes[-_KEPT:], change]
        point = point + change
        if len(points) > 1:
            moved, bent = np.diff(points, axis=0), np.diff(changes, axis=0)
            share = np.linalg.lstsq(bent.T, change, rcond=_NOISE)[0]
            point = point - share @ (moved + bent)
    raise AssertionError("unreachable")


def directions(turn: Map, at: FixedPoint, begin: Array) -> Krylov:
    """Derivative of a map at a fixed point in the directions that a first one leads to, by Arnoldi's method.

    A turn each, until they tell whether it is stable.
    """
    basis, action = [begin / np.linalg.norm(begin)], np.zeros((_MOST + 1, _MOST))
    for k in range(_MOST):
        ahead = (turn(at.point + _DIFFERENCE * basis[k]) - at.image) / _DIFFERENCE
        for _ in range(2):
            for i, each in enumerate(basis):
                along = each @ ahead
                action[i, k] += along
                ahead = ahead - along * each
        left = action[k + 1, k] = float(np.linalg.norm(ahead))
        found = Krylov(np.stack(basis, axis=1), action[: k + 1, : k + 1].copy(), left)
        if left == 0.0 or (k + 1) % _EVERY == 0:
            stable = found.stable
            if left == 0.0 or stable is False or (stable and k + 1 >= _FEWEST):
                break
        basis.append(ahead / left)
    return found
