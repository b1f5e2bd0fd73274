"""Bracketed roots: found where the function changes sign, and only there."""

from __future__ import annotations

import numpy as np

from solvers.roots import bracketed_root


def test_roots_of_many_functions() -> None:
    target = np.array([0.1, 2.0, 50.0, 1e-9])
    root, found = bracketed_root(lambda x, k: x**3 - target[k], np.zeros(4), np.full(4, 10.0))
    assert found.all()
    np.testing.assert_allclose(root, np.cbrt(target), rtol=1e-15 * 8)


def test_steep_and_flat_functions() -> None:
    # A step with a flat foot: the secant alone would creep.
    root, found = bracketed_root(
        lambda x, k: np.where(x < 0.9, -1e-12, (x - 0.9) * 1e6 - 1e-12), np.array([0.0]), np.array([1.0])
    )
    assert found.all()
    np.testing.assert_allclose(root, 0.9 + 1e-18, rtol=1e-14)


def test_no_change_of_sign_is_said() -> None:
    root, found = bracketed_root(lambda x, k: x**2 + 1.0, np.array([-1.0]), np.array([0.5]))
    assert not found.any()
    assert root[0] == 0.5


def test_root_at_an_end() -> None:
    root, found = bracketed_root(lambda x, k: x, np.array([0.0]), np.array([1.0]))
    assert found.all() and root[0] == 0.0


def test_smooth_functions_take_few_steps() -> None:
    """Quadratic interpolation: some ten points for full accuracy, where halving takes fifty."""
    calls = 0

    def function(x: np.ndarray, k: np.ndarray) -> np.ndarray:
        nonlocal calls
        calls += 1
        return np.exp(x) - 2.0 - k

    root, found = bracketed_root(function, np.zeros(5), np.full(5, 4.0))
    assert found.all() and calls < 15
    np.testing.assert_allclose(root, np.log(2.0 + np.arange(5)), rtol=1e-15)
