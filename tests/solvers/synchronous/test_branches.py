"""Every solution of the deflection equation, against laws whose solutions are known."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from solvers.synchronous.planar import find_branches
from tests.mutants import kills


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
        saturating(level, width), a * one, c * one, one, level / width * one, 0.0 * one, one / c * (1 + 1e-9)
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
    law, one = saturating(1.5, 0.7), np.ones(41)
    all_at_once, which, _ = find_branches(law, a, c, one, 1.5 / 0.7 * one, 0.0 * one, 10.0 * one)
    for k in range(41):
        first = one[:1]
        alone, _, _ = find_branches(
            law, a[k : k + 1], c[:1], first, 1.5 / 0.7 * first, 0.0 * first, 10.0 * first
        )
        np.testing.assert_array_equal(np.sort(alone), np.sort(all_at_once[which == k]))


def test_a_double_solution_is_one() -> None:
    # Above the bend the parabola just touches zero: its discriminant vanishes at a = c sqrt(level^2 - 1).
    level, c, width = 2.0, 0.5, 0.1
    a = c * np.sqrt(level**2 - 1.0)
    found, _, _ = find_branches(
        saturating(level, width), *(np.array([x]) for x in (a, c, 1.0, level / width, width, 2.0))
    )
    e = a * level / (a * a + c * c)
    np.testing.assert_allclose(found, np.full(found.size, e), rtol=1e-6)
    assert found.size in (1, 2)


@kills("solvers.synchronous.planar:_one_way", "+ np.square(c) * low", "+ np.square(c) * high * 4.0")
def test_one_way() -> None:
    """What the slope allows to skip holds no further solution: the same ones without that knowledge."""
    a, c = np.meshgrid(np.linspace(-3.0, 3.0, 61), np.geomspace(0.05, 1.0, 7))
    a, c = a.ravel() + 0.0123, c.ravel()
    one = np.ones(a.size)
    counts = []
    for level, width in ((0.4, 0.2), (1.5, 0.7), (4.0, 2.0)):
        law, slope = saturating(level, width), level / width
        found = [find_branches(law, a, c, one, s * one, 0.0 * one, 1.01 / c) for s in (slope, 1e6)]
        counts.append(np.bincount(found[1][1], minlength=a.size))
        (quick, own, _), (slow, other, _) = found
        order, other_order = np.lexsort((quick, own)), np.lexsort((slow, other))
        np.testing.assert_array_equal(own[order], other[other_order])
        # Near a fold a solution is known to the square root of rounding only.
        np.testing.assert_allclose(quick[order], slow[other_order], rtol=1e-7)
    assert set(np.concatenate(counts).tolist()) >= {1, 3}
