"""Fixed points and multipliers of maps whose own are known."""

from __future__ import annotations

import numpy as np

from meshes.arrays import Array
from solvers.shooting import Krylov, Map, directions, fixed_point
from tests.mutants import kills

SIZE = 60


def linear(largest: float, angle: float = 0.7) -> tuple[Array, Array]:
    """A matrix that is not normal with a pair of this size and angle and the rest evenly down to nothing."""
    dice = np.random.default_rng(1)
    block = np.diag(np.linspace(0.85, 0.0, SIZE))
    block[:2, :2] = largest * np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    frame = np.linalg.qr(dice.standard_normal((SIZE, SIZE)))[0] + 0.02 * dice.standard_normal((SIZE, SIZE))
    return frame @ block @ np.linalg.inv(frame), dice.standard_normal(SIZE)


def bent(largest: float) -> tuple[Map, Array]:
    """A map that is linear about a point known, and bends away from it."""
    matrix, known = linear(largest)

    def turn(point: Array) -> Array:
        away = point - known
        return np.asarray(known + matrix @ away + 0.05 * np.square(away).sum() * known)

    return turn, known


@kills("solvers.shooting:fixed_point", "share @ (moved + bent)", "share @ moved")
def test_the_fixed_point_is_found_stable_or_not() -> None:
    for largest in (0.9, 0.999, 1.05):
        turn, known = bent(largest)
        at = fixed_point(turn, known + 0.05 / np.sqrt(SIZE), 1e-9, 60)
        assert at.change <= 1e-9
        # What is left of a slow change is its own over what is short of 1.
        np.testing.assert_allclose(at.point, known, atol=1e-9 / abs(1.0 - largest) * 10.0)
        marched = known + 0.05 / np.sqrt(SIZE)
        for _ in range(at.turns):
            marched = turn(marched)
        assert np.abs(at.point - known).max() < 1e-3 * np.abs(marched - known).max()


@kills("solvers.shooting:Krylov.resolved", " - seen", "")
@kills("solvers.shooting:Krylov.moved", "change.T, self.action.T", "np.eye(len(change)), self.action.T")
def test_what_is_known_of_a_map_solves_it() -> None:
    """A map that is known in all directions takes a step, on a mesh that is stretched as well; and a look."""
    matrix, given = linear(0.995)
    known = np.linalg.solve(np.eye(SIZE) - matrix, given)
    stretch = np.diag(np.linspace(1.0, 3.0, SIZE))
    whole = Krylov(np.eye(SIZE), matrix, 0.0).moved(lambda way: stretch @ way)
    back = np.linalg.inv(stretch)
    at = fixed_point(
        lambda point: np.asarray(stretch @ (matrix @ (back @ point) + given)), given, 1e-9, 60, whole
    )
    assert at.turns == 2
    np.testing.assert_allclose(at.point, stretch @ known, atol=1e-8)
    np.testing.assert_allclose(whole.basis.T @ whole.basis, np.eye(SIZE), atol=1e-12)


@kills("solvers.shooting:Krylov.stable", "size - errors > 1.0", "size + errors > 1.0")
def test_multipliers_are_the_eigenvalues() -> None:
    for largest, stable in ((0.9, True), (0.995, True), (1.005, False), (1.2, False)):
        turn, known = bent(largest)
        at = fixed_point(turn, known, 1e-3, 3)
        found = directions(turn, at, np.random.default_rng(2).standard_normal(SIZE))
        values, errors = found.multipliers
        exact = largest * np.exp(0.7j * np.sign(values[0].imag))
        assert found.stable is stable
        assert abs(values[0] - exact) < 2.0 * errors[0] + 1e-5
        assert np.all(np.diff(np.abs(values)) <= 1e-12)


@kills("solvers.shooting:Krylov.stable", "(size + errors)[:_LEADING] < 1.0", "size[:_LEADING] < 1.0")
def test_too_few_directions_do_not_tell() -> None:
    """One direction that is taken to 0.9 of itself and out of the basis by 0.2 may be a part of anything."""
    assert Krylov(np.eye(3)[:, :1], np.array([[0.9]]), 0.2).stable is None
    assert Krylov(np.eye(3)[:, :1], np.array([[0.9]]), 0.05).stable is True
    assert Krylov(np.eye(3)[:, :1], np.array([[1.3]]), 0.2).stable is False


def test_a_map_without_a_fixed_point_is_given_up() -> None:
    """Soon where nothing comes of it, and at once where it is no number."""
    at = fixed_point(lambda point: point + np.array([1.0, np.sin(point[1] * 7.0)]), np.zeros(2), 1e-9, 60)
    assert at.change > 1e-9
    assert at.turns < 30
    assert fixed_point(lambda point: point * np.nan, np.ones(2), 1e-9, 60).turns == 1
