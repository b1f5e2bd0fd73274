"""The search against functions whose best point is known: kinks, jumps, plateaus, valleys, edges."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from meshes.arrays import Array
from meshes.errors import InputError
from solvers import search as searching
from solvers.search import Budget, Enough, Judge, Judgement, SearchPlan, best_of, search
from tests.mutants import kills


def free(function: Callable[[Array], Array]) -> Judge:
    """Everything is allowed."""
    return lambda x: Judgement(function(x), np.full(x.shape[0], -1.0))


def solve(judge: Judge, count: int, **more: object):  # type: ignore[no-untyped-def]
    return search(judge, np.zeros(count), np.ones(count), np.ones(count), **more)  # type: ignore[arg-type]


@kills(
    "solvers.search:_least_cost", "beyond = (heard.objective - limit)", "beyond = (limit - heard.objective)"
)
def test_plateau() -> None:
    """Of a plateau the edge with the least liquid; a margin m of its value is 0.2 m of its place."""
    for place in (0.0123, 0.4, 3e-4):
        found = solve(free(lambda x, k=place: np.maximum(1.0 - 0.8 * x[:, 0] / k, 0.2)), 1)
        assert found.point[0] == pytest.approx(place, rel=2e-6)
    both = solve(
        free(
            lambda x: (
                np.maximum(1.0 - 0.8 * x[:, 0] / 0.012, 0.2) + np.maximum(1.0 - 0.8 * x[:, 1] / 0.3, 0.2)
            )
        ),
        2,
    )
    np.testing.assert_allclose(both.point, (0.012, 0.3), rtol=2e-6)


def test_jump() -> None:
    """The value falls by a jump and rises again: the best is just behind it."""
    found = solve(free(lambda x: np.where(x[:, 0] < 0.4567, 3.0 + x[:, 0], 2.0 + x[:, 0])), 1)
    # Closed in to 1e-6 of its place, on the good side.
    assert 0.4567 <= found.point[0] <= 0.4567 * (1.0 + 2e-6)


def test_global() -> None:
    """A narrow valley beside a wide one that is less deep."""
    for place in (0.004, 0.05, 0.62):
        width = 0.25 * place

        def two(x: Array, k: float = place, w: float = width) -> Array:
            return np.minimum((x[:, 0] - 0.9) ** 2 + 1.0, 0.5 + np.abs(x[:, 0] - k) / w)

        assert solve(free(two), 1).objective == pytest.approx(0.5, rel=1e-4)


@kills("solvers.search:_along_rays", "low + t[:, None] * ray", "low + t[:, None] + 0.0 * ray")
def test_edge() -> None:
    """Least cost where 3 sqrt(x) + 2 sqrt(y) + sqrt(z) >= 1.5: by Lagrange (1.5 (3, 2, 1)/14)^2."""
    weights = np.array([3.0, 2.0, 1.0])

    def judge(x: Array) -> Judgement:
        return Judgement(x.sum(axis=1), 1.0 - np.sqrt(x) @ weights[: x.shape[1]] / 1.5)

    for count in (2, 3):
        w = weights[:count]
        found = solve(judge, count, plan=SearchPlan(polish=0))
        exact = 1.5**2 / float(w @ w)
        assert found.feasible
        assert (
            exact * (1.0 - 1e-9) <= found.objective <= exact * (1.0 + 1e-3)
        )  # the floor is flat: second order


@kills("solvers.search:_exchanges", "moved / cost[i], -moved / cost[j]", "moved / cost[i], moved / cost[j]")
def test_valley() -> None:
    """A kink that runs slantwise: no axis goes down along it."""

    def bent(x: Array) -> Array:
        return np.abs(x[:, 0] + 2.0 * x[:, 1] - 0.7) + 0.3 * (x[:, 0] - 0.2) ** 2 + 1.0

    assert solve(free(bent), 2).objective <= 1.0 + 1e-3


@kills("solvers.search:best_of", "np.maximum(judged.excess, 0.0)", "np.maximum(-judged.excess, 0.0)")
def test_infeasible() -> None:
    """Nothing is allowed: the point that exceeds its limits least, whatever its objective."""
    found = solve(lambda x: Judgement(x[:, 0] * 100.0, 0.1 + np.abs(x[:, 0] - 0.37)), 1)
    assert not found.feasible
    assert found.point[0] == pytest.approx(0.37, abs=1e-4)


@kills(
    "solvers.search:best_of",
    "(cost, tie), (judged.excess, tie)",
    "(judged.excess, tie), (cost, tie)",
)
def test_order() -> None:
    """Less excess before a smaller objective, that before less cost, that before more room to the limits."""
    cost = np.array([1.0, 2.0, 3.0, 4.0])
    assert best_of(Judgement(np.array([1.0, 5.0, 5.0, 9.0]), np.array([0.1, -1.0, -2.0, -9.0])), cost) == 1
    assert best_of(Judgement(np.array([5.0, 5.0, 4.0, 4.0]), -np.ones(4)), cost) == 2
    assert best_of(Judgement(np.array([5.0, 5.0]), np.array([-1.0, -2.0])), np.ones(2)) == 1
    assert best_of(Judgement(np.array([np.inf, 7.0]), np.array([0.5, 0.6])), np.ones(2)) == 0


@settings(max_examples=25)
@given(st.floats(1e-3, 1.0), st.floats(0.01, 0.9), st.floats(0.0, 1.0))
def test_never_worse_than_a_dense_grid(place: float, rise: float, start: float) -> None:
    """A fall to a kink, a slow rise, and a jump somewhere."""

    def function(x: Array) -> Array:
        v = x[:, 0]
        return np.maximum(1.0 - v / place, rise * v) + np.where(v > start, 0.1, 0.0) + 0.5

    grid = np.concatenate((np.linspace(0.0, 1.0, 4001), np.geomspace(1e-5, 1.0, 4001)))[:, None]
    found = solve(free(function), 1)
    assert found.objective <= function(grid).min() * (1.0 + 1e-3)


def test_the_same_question_has_the_same_answer() -> None:
    def function(x: Array) -> Array:
        return np.sin(9.0 * x[:, 0]) + np.cos(7.0 * x[:, 1] + x[:, 0])

    one, other = solve(free(function), 2), solve(free(function), 2)
    np.testing.assert_array_equal(one.points, other.points)


def test_exchangeable_coordinates_are_ordered() -> None:
    found = solve(free(lambda x: (x.max(axis=1) - 0.6) ** 2 + (x.min(axis=1) - 0.1) ** 2), 2, alike=[[0, 1]])
    assert found.point[0] >= found.point[1]
    np.testing.assert_allclose(found.point, (0.6, 0.1), atol=2e-3)


def test_what_is_not_a_number_is_never_the_best() -> None:
    found = solve(free(lambda x: np.where(x[:, 0] < 0.5, np.nan, x[:, 0])), 1)
    assert found.point[0] == pytest.approx(0.5, rel=1e-5)


def test_many_coordinates_are_searched_along_lines() -> None:
    aim = np.array([0.1, 0.4, 0.2, 0.7, 0.05])
    found = solve(free(lambda x: 1.0 + np.abs(x - aim).sum(axis=1)), 5, plan=SearchPlan(sweeps=30))
    assert found.objective <= 1.01


def test_a_box_that_is_none_is_refused() -> None:
    judge = free(lambda x: x[:, 0])
    for low, high in ((1.0, 0.0), (0.0, np.inf), (np.nan, 1.0)):
        with pytest.raises(InputError, match="bounds"):
            search(judge, np.array([low]), np.array([high]), np.ones(1))


def test_a_box_of_no_width() -> None:
    found = search(free(lambda x: x.sum(axis=1)), np.array([0.3, 0.0]), np.array([0.3, 1.0]), np.ones(2))
    np.testing.assert_array_equal(found.point, (0.3, 0.0))


@kills(
    "solvers.search:_answer",
    "best_of(said, points @ cost, plan.margin, _EQUAL)",
    "int(np.argmin(said.objective))",
)
@pytest.mark.parametrize("count", [1, 2])
def test_the_least_cost_among_equals_may_be_far_away(count: int) -> None:
    """Two valleys: the wide one is better by less than the margin, the narrow one costs a tenth of it."""
    near, far = np.full(count, 0.06), np.full(count, 0.6)

    def function(x: Array) -> Array:
        first = 1.0 + 4e-4 + 1e3 * np.square(x - near).sum(axis=1)
        second = 1.0 + 10.0 * np.square(x - far).sum(axis=1)
        return np.minimum(first, second)

    found = solve(free(function), count, plan=SearchPlan(margin=1e-3))
    assert found.objective <= found.judged.objective.min() * (1.0 + 1e-3)
    # What is left of the margin is worth sqrt(6e-7) of the place.
    np.testing.assert_allclose(found.point, near, atol=1e-3)
    fine = solve(free(function), count, plan=SearchPlan(margin=1e-5))
    np.testing.assert_allclose(fine.point, far, atol=3e-3)


def test_an_interrupt_ends_the_search_with_what_it_has() -> None:
    asked = 0

    def judge(x: Array) -> Judgement:
        nonlocal asked
        asked += 1
        if asked == 3:
            raise KeyboardInterrupt
        return Judgement(np.abs(x[:, 0] - 0.3), np.full(x.shape[0], -1.0))

    found = solve(judge, 1)
    assert found.interrupted and found.objective == found.judged.objective.min()
    with pytest.raises(KeyboardInterrupt):
        asked = 2
        solve(judge, 1)


@kills("solvers.search:_Log._keep", "(rows.copy(), ", "(rows, ")
@pytest.mark.parametrize("count", [1, 2, 3])
def test_what_is_kept_is_what_was_judged(count: int) -> None:
    """Every point with its own value: steps go on from arrays that were judged before."""

    def function(x: Array) -> Array:
        return 1.0 + np.square(x - 0.3).sum(axis=1)

    found = solve(free(function), count)
    np.testing.assert_array_equal(found.judged.objective, function(found.points))
    assert found.objective == function(found.point[None])[0]


@kills("solvers.search:Budget.take", "self.left -= count", "self.left -= 0")
@kills("solvers.search:_Log._asked", "self._keep(rows[: end.said.objective.size], end.said)", "pass")
def test_a_budget_of_evaluations_keeps_the_best_so_far() -> None:
    """As many points are judged as were allowed, the last of them too, and the best of them is the answer."""
    budget, asked = Budget(evaluations=11), []

    def judge(points: Array) -> Judgement:
        allowed = budget.take(points.shape[0])
        said = free(lambda x: np.square(x - 0.37).sum(axis=1))(points[:allowed])
        asked.append(allowed)
        if allowed < points.shape[0]:
            raise Enough(budget.words, said)
        return said

    found = solve(judge, 2, plan=SearchPlan(at_once=4))
    assert found.stopped == "11 evaluations" and not found.interrupted
    assert sum(asked) == found.points.shape[0] == 11
    assert found.objective == found.judged.objective.min()
    whole = solve(free(lambda x: np.square(x - 0.37).sum(axis=1)), 2)
    assert whole.stopped == "" and whole.objective <= found.objective


@kills("solvers.search:Budget.look", "time.monotonic() > self.until", "False")
def test_a_budget_of_time_answers_once_at_least(monkeypatch: pytest.MonkeyPatch) -> None:
    """The first points are judged however late it is; then the clock decides."""
    now = [100.0]
    monkeypatch.setattr(searching.time, "monotonic", lambda: now[0])
    budget = Budget(seconds=5.0)
    now[0] = 200.0
    assert budget.take(3) == 3
    ended = ""
    try:
        budget.take(1)
    except Enough as why:
        ended = str(why)
    assert ended == "5 s"


@kills("solvers.search:_Log._rounded", "(points == self.low) | (points == self.high)", "points < 0.0")
def test_rounded_points_are_judged_once_and_corners_stay() -> None:
    """Eight binary digits: no two judged points are alike, the corners are as given, the best is as near."""
    low, high, seen = np.array([0.1]), np.array([1.0 / 3.0]), []

    def judge(points: Array) -> Judgement:
        seen.append(points[:, 0].copy())
        return free(lambda x: np.square(x[:, 0] - 0.2))(points)

    found = search(judge, low, high, np.ones(1), plan=SearchPlan(digits=8))
    every = np.concatenate(seen)
    assert every.size == np.unique(every).size
    assert {0.1, 1.0 / 3.0} <= set(every.tolist())
    inner = every[(every > 0.1) & (every < 1.0 / 3.0)]
    part, _ = np.frexp(inner)
    np.testing.assert_array_equal(part * 256.0, np.round(part * 256.0))
    assert abs(found.point[0] - 0.2) <= 0.2 / 256.0
