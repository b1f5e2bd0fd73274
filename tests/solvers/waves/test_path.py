"""Curves over a parameter: the damped way through folds, predictions, and why a curve ends."""

import functools
import math

import numpy as np
import pytest

from solvers.waves.modes import DampingSystem, System, WaveProblem, resized
from solvers.waves.newton import Pace, PathPoint, _predicted, landing, march, newton, scaled_unknowns, segment
from solvers.waves.steady import solve
from tests.mutants import kills

PACE = Pace(longest=0.5, shortest=1e-5, tolerance=1e-9, tail=1e-7, most_modes=255, most_steps=200)
# In the scales of the problem: dispersion a tenth of the steepening, decay a fifth, the whirl at lambda0.
FOLDED = WaveProblem(lambda n: -0.1 * n**3, 1.0, 1.0, decay=0.2)


def damped_start(problem: WaveProblem, speed: float) -> tuple[functools.partial, np.ndarray]:  # type: ignore[type-arg]
    make = functools.partial(DampingSystem, problem, speed=speed)
    system = make(15)
    wave = newton(system, system.linear(2.0), 2.0)
    assert wave.residual < 1e-11
    return make, np.append(scaled_unknowns(wave), 2.0)


@kills("solvers.waves.newton:_tangent", "ahead[-1] * by_p", "0.0 * by_p")
@kills("solvers.waves.newton:_correct", "-dot(direction, here - guess)", "1.0 - dot(direction, here - guess)")
def test_damped_way() -> None:
    """From a strongly damped wave to the one without extra diffusion, which turns back twice on the way."""
    make, first = damped_start(FOLDED, 0.0)
    path = march(make, first, 0.0, PACE)
    assert path.reason == ""
    extra = np.array([point.here[-1] for point in path.points])
    onward = np.sign(np.diff(extra))
    assert np.count_nonzero(onward[1:] * onward[:-1] < 0.0) == 2
    for system, point in zip(path.systems, path.points, strict=True):
        y, p = point.here[:-1], point.here[-1]
        assert system.error(system.residual(y, p), y) <= PACE.tolerance
        # The tangent keeps the equations: J t + F_p t_p = 0, refined to 1e-3.
        left = system.jacobian(y, p, system.modes) @ point.ahead[:-1] + point.ahead[-1] * system.by_parameter(
            y, p
        )
        assert np.linalg.norm(left * system.weight) < 2e-3
    y = landing(path, 0.0)
    end = solve(FOLDED, 0.0, guess=resized_modes(y, 63))
    assert end.converged
    # Newton's method from the linear wave does not arrive, the way does.
    start = System(FOLDED, 63)
    assert newton(start, start.linear(0.0), 0.0).residual > 1e-3
    assert solve(FOLDED, 0.0).converged


def resized_modes(y: np.ndarray, modes: int) -> np.ndarray:
    y = resized(y, modes)
    return np.asarray(y[:modes] + 1j * y[modes:])


@kills("solvers.waves.newton:segment", "3.0 * chord - 2.0 * start - stop", "3.0 * chord - start - stop")
@kills("solvers.waves.newton:segment", "(1.0 - dot(start, stop)) / 12.0", "(1.0 - dot(start, stop)) / 6.0")
@kills("solvers.waves.newton:_predicted", "(1.0 + step / arc)", "(step / arc)")
def test_cubics() -> None:
    """A circle in the plane of mode 1: predicted and interpolated to fourth order of the step."""

    def point(angle: float) -> PathPoint:
        # Mean square 1: two times (Re v)^2 + (Im v)^2.
        radius = math.sqrt(0.5)
        here = np.array([radius * math.cos(angle), radius * math.sin(angle), 0.0])
        ahead = np.array([-radius * math.sin(angle), radius * math.cos(angle), 0.0])
        return PathPoint(here, ahead, 0, 0.0)

    for scheme in (
        lambda h: _predicted(point(0.0), point(h), h) - point(2.0 * h).here,
        lambda h: 0.5 ** np.arange(4) @ segment(
            point(0.0).here, point(h).here, point(0.0).ahead, point(h).ahead
        )[0] - point(0.5 * h).here,
    ):  # fmt: skip
        errors = [float(np.linalg.norm(scheme(h))) for h in (0.1, 0.05)]
        assert math.log2(errors[0] / errors[1]) == pytest.approx(4.0, abs=0.2)


@pytest.mark.parametrize(
    ("limit", "reason"),
    [
        ({"most_steps": 6}, "after 6 steps"),
        ({"most_work": 1e4}, "not at the end"),
        ({"most_modes": 15, "tail": 1e-12}, "not resolved"),
        ({"longest": 40.0, "shortest": 3.9}, "too short"),
    ],
)
def test_reasons(limit: dict[str, float], reason: str) -> None:
    make, first = damped_start(FOLDED, 0.0)
    pace = Pace(**(vars(PACE) | limit))
    path = march(make, first, 0.0, pace)
    assert reason in path.reason
    assert path.points[-1].here[-1] > 0.0


def test_a_curve_that_comes_back_says_so() -> None:
    # The response leans over to faster waves and folds twice.
    problem = WaveProblem(lambda n: -(n**3), 1.0, 0.05, decay=0.01)
    below = solve(problem, -1.4)
    path = march(
        functools.partial(System, problem),
        np.append(scaled_unknowns(below), below.speed / problem.speed_scale),
        0.0,
        PACE,
    )
    assert path.reason == ""
    (turns,) = np.nonzero(np.diff(np.sign(np.diff([p.here[-1] for p in path.points]))))
    assert turns.size == 2
    # From its middle sheet towards rising speeds: round the upper fold and down past the speed it began at.
    middle = path.points[int(turns.mean()) + 1].here
    back = march(functools.partial(System, problem), middle, 0.0, PACE)
    assert back.reason == "the curve came back to where it began"
    assert back.points[-1].here[-1] < middle[-1]
