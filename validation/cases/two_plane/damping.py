"""Damping of the supports and balls in two planes [FF20, conclusion 2]: roots, and motion in time.

The runs of many minutes of a machine's time are kept in `validation/data/two_plane_damping.json`; `python -m
validation.cases.two_plane.damping` makes them anew.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np

from meshes.arrays import Array
from solvers.rotor.balls.balancers import race_arrays, simulate
from solvers.rotor.balls.stability import balanced_stability, linearised
from solvers.rotor.balls.states import balanced_places, quarter_turn
from solvers.rotor.balls.steps import advance
from solvers.rotor.balls.two_plane_balance import dynamic_balancing, of_two_planes
from solvers.rotor.two_plane import TwoPlane
from validation.case import Case, Claims
from validation.cases.two_plane.machine import BALLS, LONG, RACES, SCATTERED, over_bare
from validation.study import data, launch, write

CLAIMS = Claims("two_plane")

DAMPINGS = (0.5, 5.0, 40.0, 8000.0)  # N s/m, of each support
SIDES = (0.98, 1.02)  # of the edge, at which motions in time are looked at
DATA = Path(__file__).parents[2] / "data" / "two_plane_damping.json"
# Long runs: damping, N s/m; speed, rad/s; duration, s; the balls set out near their balanced places.
LONG_RUNS = (
    (0.5, 60.0, 120.0, False),
    (0.5, 85.0, 600.0, False),
    (8000.0, 120.0, 6000.0, False),
    (8000.0, 120.0, 1500.0, True),
)
OFF = (0.2, -0.1, 0.1, 0.15)  # rad, from the balanced places
_SMALL = 1e-8  # of the radius of a race and of a radian: size of a disturbance, whose square is nothing
_NOT_REACHED = "not reached: the balls creep round"
# Growth over a run, in powers of e, and the least and the longest run, s.
_POWERS, _LEAST, _LONGEST = 0.5, 0.3, 4.0


@dataclass(frozen=True)
class Side:
    """A motion in time on one side of an edge."""

    speed: float  #: rad/s
    root: float  #: real part of the root that grows most, 1/s
    seen: float  #: rate at which the disturbance grew in time, 1/s


def damped(rotor: TwoPlane, damping: float) -> TwoPlane:
    """Rotor with another damping in each support, N s/m."""
    return replace(rotor, supports=tuple(replace(support, damping=damping) for support in rotor.supports))


@cache
def edge(damping: float) -> float:
    """Least speed above which the long rotor stays balanced, up to 150 rad/s; damping in N s/m."""
    system = damped(LONG, damping).system()
    speeds = np.linspace(42.0, 150.0, 109)
    return lasting(lambda speed: balanced_stability(system, RACES, speed).stable, speeds, 24)


def lasting(stable: Callable[[float], bool], speeds: Array, halvings: int) -> float:
    """Least speed above which all is stable, searched for among rising speeds, then by halving."""
    last = max(k for k, speed in enumerate(speeds.tolist()) if not stable(speed))
    left, right = speeds[last : last + 2].tolist()
    for _ in range(halvings):
        middle = 0.5 * (left + right)
        left, right = (left, middle) if stable(middle) else (middle, right)
    return float(right)


def side(damping: float, speed: float) -> Side:
    """Largest growth rate, by its root and in time by the full equations of motion."""
    system, races = damped(LONG, damping).system(), RACES
    known = balanced_stability(system, races, speed)
    matrix = linearised(system, races, speed, known.places).matrix()
    roots, right = np.linalg.eig(matrix)
    mine = int(np.argmax(roots.real))
    # Rows of the inverse are the left vectors: each sees its own motion alone.
    seen_by = np.linalg.inv(right)[mine]
    n = len(system.coordinates)
    axes, balls = race_arrays(system, races)
    radius, count = races[0].radius, len(balls)
    shape = right[:, mine].real if roots[mine].imag == 0.0 else right[:, mine]
    begin = np.real(shape) * _SMALL * radius / np.abs(shape[:n]).max()
    state = np.zeros(2 * (n + count) + 2)
    turn = speed * quarter_turn(system)
    state[:n], state[n : 2 * n] = begin[:n], begin[n + count : 2 * n + count] + turn @ begin[:n]
    state[2 * n : 2 * n + count] = known.places + begin[n : n + count]
    state[2 * n + count : -2] = speed + begin[2 * n + count :]
    duration = float(np.clip(_POWERS / abs(known.growth), _LEAST, _LONGEST))
    # The supports' own decay is over at once: it need only stay within what the steps can take.
    fastest = max(2.0 * speed, 4.0 * damping / LONG.mass)
    steps = int(np.ceil(duration * fastest * 24 / (2.0 * np.pi)))
    record = np.zeros((2, state.size))
    turning = np.stack((system.unbalance.real, system.unbalance.imag))
    matrices = (
        system.mass,
        system.damping + speed * system.gyroscopic,
        system.stiffness,
        turning,
        axes,
        balls,
    )
    advance(state, matrices, np.array([speed, 0.0]), duration / steps, steps, record)
    sizes = [
        abs(seen_by @ _turning(at, time, n, count, speed, turn, known.places))
        for at, time in zip(record, (0.0, duration), strict=True)
    ]
    return Side(speed, known.growth, float(np.log(sizes[1] / sizes[0]) / duration))


def _turning(
    state: Array, time: float, n: int, count: int, speed: float, turn: Array, places: Array
) -> Array:
    """Disturbance in the turning frame: p, psi, p', psi'."""
    angle = speed * time
    back = np.cos(angle) * np.eye(n) - np.sin(angle) * turn / speed
    moved, rate = back @ state[:n], back @ state[n : 2 * n]
    here = state[2 * n : 2 * n + count] - angle - places
    around = state[2 * n + count : 2 * (n + count)] - speed
    return np.concatenate((moved, here, rate - turn @ moved, around))


def long_run(damping: float, speed: float, duration: float, near: bool = False) -> dict[str, float]:
    """Two ball balancers for a long time, deflection at the supports over that without balancers.

    Near: the balls begin `OFF` their balanced places, else at scattered ones. `left` is of the last tenth,
    `rate` of the fall over the last third, 1/s, `root` the largest.
    """
    rotor = damped(LONG, damping)
    system = rotor.system()
    places = balanced_places(system, RACES) + np.array(OFF) if near else np.array(SCATTERED)
    run = simulate(system, RACES, speed, duration, places=places, samples=3000, steps=32)
    size = over_bare(rotor, run, speed)
    late = slice(2 * size.size // 3, None)
    rate = float(np.polyfit(run.time[late], np.log(size[late]), 1)[0])
    return {
        "damping": damping,
        "speed": speed,
        "duration": duration,
        "near": near,
        "left": float(size[-size.size // 10 :].max()),
        "rate": rate,
        "root": balanced_stability(system, RACES, speed).growth,
        "energy_error": run.energy_error,
    }


def kept() -> list[dict[str, float]]:
    """The long runs as they are kept."""
    return list(data(DATA.name)["runs"])


def cases() -> list[Case]:
    """Edges of four dampings, each with motions in time on both sides, then what minutes of a run leave."""
    printed = dynamic_balancing(of_two_planes(LONG, BALLS), 1.0).above
    found = []
    for damping in DAMPINGS:
        speed = edge(damping)
        sides = [side(damping, share * speed) for share in SIDES]
        confirmed, away = sides[0].seen > 0.0 > sides[1].seen, printed / speed - 1.0
        verdict = "differs" if not confirmed else "agrees" if abs(away) <= 0.02 else "erratum"
        told = ", ".join(f"{each.seen:+.2g} 1/s at {each.speed:.2f}" for each in sides)
        words = {"damping": damping, "printed": printed, "difference": away, "told": told}
        found.append(CLAIMS.case("damping", speed, verdict=verdict, **words))
    for run in kept():
        balanced = run["rate"] < 0.0 and run["left"] < 1.0
        # Where the state is stable and this start does not lead to it, the source is not wrong.
        stable = run["root"] < 0.0
        words = {
            "run": run,
            "start": "near the balanced places" if run["near"] else "scattered",
            "where": "-near" if run["near"] else "",
            "difference": "none" if balanced else _NOT_REACHED if stable else "it grows",
            "verdict": "agrees" if balanced else "differs" if stable else "erratum",
        }
        found.append(CLAIMS.case("long-run", run["left"], **words))
    return found


def keep() -> None:
    """Make the kept runs anew."""
    about = (
        "Motion in time of the long rotor of validation.cases.two_plane.damping from scattered places of the "
        "balls, or near the balanced ones. left: largest deflection at the supports in the last tenth over "
        "that without balancers; rate: of its logarithm over the last third, 1/s; root: real part of the "
        "leading root, 1/s."
    )
    write(DATA, {"about": about, "runs": [long_run(*run) for run in LONG_RUNS]})


if __name__ == "__main__":
    launch(keep)
