"""Every solution of the deflection equation, against laws whose solutions are known."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from solvers.branches import find_branches


def saturating(level: float, width: float):  # type: ignore[no-untyped-def]
    """Y = level * min(e/width, 1): a straight line that bends once."""
    return lambda e, k: level * np.minimum(e / width, 1.0)


def closed_solutions(a: float, c: float, level: float, width: float) -> list[float]:
    """Solutions of (a e - Y)^2 + (c e)^2 = 1: a quadratic below the bend, one above."""
    found = []
    rate = a - level / width
    if rate or c:
        e = 1.0 / np.hypot(rate, c)
        found += [e] if e <= width else []
    square, linear, rest = a * a + c * c, -2.0 * a * level, level * level - 1.0
    discriminant = linear * linear - 4.0 * square * rest
    if discriminant >= 0.0:
        found += [
            e
            for e in (
                (-linear - np.sqrt(discriminant)) / (2 * square),
                (-linear + np.sqrt(discriminant)) / (2 * square),
            )
            if e > width
        ]
    return sorted(found)


@given(a=st.floats(-3.0, 3.0), c=st.floats(0.05, 1.0), level=st.floats(0.1, 5.0), width=st.floats(0.05, 3.0))
@settings(max_examples=150)
def test_finds_every_solution(a: float, c: float, level: float, width: float) -> None:
    one = np.ones(1)
    exact = closed_solutions(a, c, level, width)
    found, which, converged = find_branches(
        saturating(level, width), a * one, c * one, one, np.zeros(1), one / c * (1 + 1e-9)
    )
    assert converged.all() and not which.any()
    found = np.sort(found)
    gaps = np.diff(exact)
    if (gaps.size and gaps.min() < 1e-6 / c) or any(abs(e - width) < 1e-9 for e in exact):
        return  # two that touch, or one on the kink, may count as one
    # Near a fold the solution is known to the square root of rounding only.
    np.testing.assert_allclose(found, exact, rtol=1e-7)


def test_speeds_do_not_see_each_other() -> None:
    a, c = np.linspace(-2.0, 2.0, 41), np.full(41, 0.1)
    law = saturating(1.5, 0.7)
    all_at_once, which, _ = find_branches(law, a, c, np.ones(41), np.zeros(41), 10.0 * np.ones(41))
    for k in range(41):
        alone, _, _ = find_branches(law, a[k : k + 1], c[:1], np.ones(1), np.zeros(1), 10.0 * np.ones(1))
        np.testing.assert_array_equal(np.sort(alone), np.sort(all_at_once[which == k]))


def test_a_double_solution_is_one() -> None:
    # Above the bend the parabola just touches zero: its discriminant vanishes at a = c sqrt(level^2 - 1).
    level, c, width = 2.0, 0.5, 0.1
    a = c * np.sqrt(level**2 - 1.0)
    found, _, _ = find_branches(
        saturating(level, width), np.array([a]), np.array([c]), np.ones(1), np.array([width]), np.array([2.0])
    )
    e = a * level / (a * a + c * c)
    np.testing.assert_allclose(found, np.full(found.size, e), rtol=1e-6)
    assert found.size in (1, 2)
