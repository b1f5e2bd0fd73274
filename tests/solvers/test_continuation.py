"""Curves followed by arc length: a circle, a fold, a box, a curve of two turning points."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest

from meshes.errors import InputError
from solvers.continuation import End, follow
from tests.mutants import kills


@kills("solvers.continuation:slopes", "/ (2.0 * _DIFFERENCE)", "/ _DIFFERENCE")
@kills("solvers.continuation:follow", "travelled > 3.0 * step", "travelled > 1e9 * step")
@kills("solvers.continuation:follow", "way * _tangent(slope)", "_tangent(slope)")
@kills("solvers.continuation:_tangent", "np.sign(tangent[heavy])", "-np.sign(tangent[heavy])")
@kills("solvers.continuation:follow", "point < corners[0]", "point < 9.0 * corners[0]")
def test_a_circle_closes_and_a_line_leaves_the_box() -> None:
    circle = follow(
        lambda x: np.array([x[0] ** 2 + 4.0 * x[1] ** 2 - 1.0]), [1.0, 0.0], [1, 1], [-2, -2], [2, 2]
    )
    assert circle.end is End.CLOSED
    # Newton's last change is below 1e-10, and what is left is of its square.
    assert np.abs(circle.points[:, 0] ** 2 + 4.0 * circle.points[:, 1] ** 2 - 1.0).max() < 1e-12
    assert circle.points[:, 0].min() < -0.999 and np.abs(circle.points[:, 1]).max() > 0.499
    line = follow(lambda x: np.array([x[1] - x[0]]), [0.0, 0.0], [1, 1], [-1, -1], [1, 1], way=-1)
    assert line.end is End.LEFT and -1.1 < line.points[-1, 0] < -1.0


@kills("solvers.continuation:_onward", "ahead if ahead @ tangent >= 0.0 else -ahead", "-ahead")
@kills("solvers.continuation:follow", "tangent = ahead\n", "pass\n")
@kills("solvers.continuation:_corrected", "point + size * change", "point - size * change")
def test_it_goes_through_folds() -> None:
    """x^3 - x + a = 0 has folds at x = +-1/sqrt(3): all three branches are passed."""
    curve = follow(
        lambda p: np.array([p[0] ** 3 - p[0] + p[1]]), [-1.2, 0.5], [1, 1], [-2, -1.0], [2, 1.0], step=0.05
    )
    assert curve.points[-1, 0] > 1.0
    rise = np.diff(curve.points[:, 1])
    assert np.count_nonzero(np.sign(rise[1:]) != np.sign(rise[:-1])) == 2
    # Between points half a step apart the extreme lies within their square.
    assert curve.points[:, 1].min() == pytest.approx(-1.0, abs=2e-3) or curve.points[:, 1].max() < 1.0
    inner = curve.points[np.abs(curve.points[:, 0]) < 0.9, 1]
    assert inner.max() == pytest.approx(2.0 / (3.0 * np.sqrt(3.0)), abs=4e-3)


@kills(
    "solvers.continuation:_corrected",
    "left).all():\n            return End.NOWHERE",
    "left).all():\n            return End.LOST",
)
def test_where_the_equations_end_is_no_failure_to_find_a_point() -> None:
    """A line down to y = 0, a parabola that ends upright, a start beyond; a kink is lost."""

    def ends(x: np.ndarray, power: float) -> np.ndarray:
        return np.array([x[1] - x[0] ** power]) if x[0] > 0.0 else np.array([np.nan])

    for power in (1.0, 0.5):
        begin = [0.5, 0.5**power]
        made = partial(ends, power=power)
        found = follow(made, begin, [1, 1], [-1, -1], [1, 1], step=0.3, way=-1)
        assert found.end is End.NOWHERE
        # Down to a shortest step from it, 0.3/4096, or a difference of 1e-6 in x.
        assert 0.0 < found.points[-1, 1] < (2e-4 if power == 1.0 else 2e-3)
    assert follow(lambda x: ends(x, 1.0), [-0.5, 0.5], [1, 1], [-1, -1], [1, 1]).end is End.NOWHERE
    kinked = follow(lambda x: np.array([abs(x[0]) - x[1]]), [-0.5, 0.5], [1, 1], [-1, -1], [1, 1])
    assert kinked.end is End.LOST and np.abs(kinked.points[-1]).max() < 1e-2


@kills("solvers.continuation:_corrected", "/ size) <= reach", "/ size) <= 1e9")
def test_a_curve_does_not_jump_to_its_neighbour() -> None:
    """Bumps of 0.05 width next to a straight line: across the tangent there the line is the nearer one."""

    def both(x: np.ndarray) -> np.ndarray:
        bump = 0.1 * np.exp(-(((x[0] - 0.52) / 0.02) ** 2))
        return np.array([(x[1] - bump) * (x[1] - 0.03 - bump)])

    found = follow(both, [0.0, 0.0], [1, 1], [-1, -1], [1, 1], step=0.05)
    off = np.abs(found.points[:, 1] - 0.1 * np.exp(-(((found.points[:, 0] - 0.52) / 0.02) ** 2)))
    assert found.end is End.LEFT and off.max() < 1e-9


def test_what_is_not_there_is_said() -> None:
    lost = follow(lambda x: np.array([x @ x + 1.0]), [1.0, 0.0], [1, 1], [-2, -2], [2, 2])
    assert lost.end is End.LOST and len(lost.points) == 1
    short = follow(lambda x: np.array([x[1]]), [0.0, 0.0], [1, 1], [-9, -9], [9, 9], most=5)
    assert short.end is End.LONG and len(short.points) == 5


@pytest.mark.parametrize(("unit", "way"), [([0.0, 1.0], 1), ([1.0, 1.0], 0)])
def test_bad_input_is_refused(unit: list[float], way: int) -> None:
    with pytest.raises(InputError):
        follow(lambda x: x[:1], [0.0, 0.0], unit, [-1, -1], [1, 1], way=way)
