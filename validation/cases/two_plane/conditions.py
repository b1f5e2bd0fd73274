"""Balancing in two planes: the conditions of [FF20] against the motion of rotors with ball balancers."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from leblanc.core.units import MM
from solvers.rotor.balls.balancers import simulate
from solvers.rotor.balls.two_plane_balance import (
    RigidRotor,
    dynamic_balancing,
    of_two_planes,
    potential_hessian,
)
from solvers.rotor.two_plane import TwoPlane
from validation.case import Case, Claims
from validation.cases.two_plane.machine import (
    BALLS,
    LONG,
    RACES,
    SCATTERED,
    SHORT,
    bare_deflection,
    over_bare,
)
from validation.page import Figure, logarithmic, page
from validation.study import launch, shown

CLAIMS = Claims("two_plane")


def cases() -> Iterator[Case]:
    """The conditions beside their potential, over many rotors and speeds, and balls in time."""
    rng, wrong, count = np.random.default_rng(5), 0, 0
    for _ in range(200):
        c = float(rng.uniform(0.05, 0.5))
        a, b = c * rng.uniform(0.6, 3.0, 2)
        if max(a, b, c) > a + b + c - max(a, b, c):
            continue
        stiffness, far = tuple(rng.uniform(1e3, 1e5, 2)), tuple(rng.uniform(0.05, 0.5, 2))
        any_rotor = RigidRotor(float(rng.uniform(1.0, 50.0)), (a, b, c), stiffness, (far[0], -far[1]))
        answer = dynamic_balancing(any_rotor, np.geomspace(1.0, 3e3, 40))
        definite = [
            np.linalg.eigvalsh(potential_hessian(any_rotor, w))[0] > 0.0 for w in answer.speed.tolist()
        ]
        wrong += int(np.sum(answer.possible != np.array(definite)))
        count += answer.speed.size
    difference = "none" if wrong == 0 else f"{wrong}"
    yield CLAIMS.case("potential", float(wrong), wrong == 0, count=count, difference=difference)
    # Without coupling the limit is a square root [FF20, eq. 37].
    uncoupled = RigidRotor(10.0, (0.5, 0.5, 0.1), (1e4, 1e4), (0.2, -0.2))
    printed, computed = math.sqrt(800.0 / 0.4), dynamic_balancing(uncoupled, 1.0).above
    same, highest = math.isclose(printed, computed, rel_tol=1e-12), printed >= math.sqrt(2e4 / 10.0)
    order = "of eq. 37 holds" if highest else "of eq. 37 does not hold: tilt is the lower"
    words = {"printed": printed, "difference": printed / computed - 1.0, "order": order}
    yield CLAIMS.case("uncoupled", computed, same, **words)
    for name, rotor in (("long", LONG), ("short", SHORT)):
        for speed in _SPEEDS:
            answer = dynamic_balancing(of_two_planes(rotor, BALLS), speed)
            run = simulate(rotor.system(), RACES, speed, 60.0, places=SCATTERED)
            left = float(over_bare(rotor, run, speed)[-run.time.size // 10 :].max())
            said, balanced = bool(answer.possible[0]), left < 1e-6
            told = {"rotor": name, "speed": speed, "printed": "balanced" if said else "not balanced"}
            told["difference"] = "none" if said == balanced else "the other way"
            yield CLAIMS.case("balls", left, run.converged and said == balanced, note=answer.why(), **told)


_SPEEDS = (30.0, 120.0)


def balls_figure(duration: float = 12.0) -> Figure:
    """Deflection at both supports of a long and a short rotor, below and above the resonances."""
    text = (
        "Deflection of the axis at its two supports after a start at full speed, with two ball "
        "balancers of two balls each in two planes; balls of 15 g on a radius of 80 mm, rotor of 10 kg "
        "with a static and a couple unbalance. Made-up machine; no gravity."
    )
    room = {"left": 0.74, "top": 0.3, "between": 0.42, "below": 0.45, "apart": 0.5}
    with page([1.6, 1.6], text, (2, 2), **room) as (figure, rows):
        for row, name, rotor in zip(rows, ("long", "short"), (LONG, SHORT), strict=True):
            for axes, speed in zip(row, _SPEEDS, strict=True):
                _draw(axes, name, rotor, speed, duration)
                axes.tick_params(labelbottom=name == "short", labelleft=speed == _SPEEDS[0])
            row[0].set_ylabel("Deflection (mm)")
        for axes in rows[-1]:
            axes.set_xlabel("Time (s)")
    return figure


def _draw(axes: Any, name: str, rotor: TwoPlane, speed: float, duration: float) -> None:
    """One rotor at one speed."""
    system = rotor.system()
    run = simulate(system, RACES, speed, duration, places=SCATTERED, samples=800)
    for k, (support, dashes) in enumerate(zip(rotor.supports, ("-", "--"), strict=True)):
        size = np.abs(run.deflection(system, support.position)) * MM
        look: dict[str, Any] = {"color": f"C{k}", "linestyle": dashes, "linewidth": 1.0}
        axes.plot(run.time, np.maximum(size, 1e-5), **look, label=f"support {k + 1}")
    bare = max(bare_deflection(rotor, support.position, speed) for support in rotor.supports) * MM
    look = {"color": "0.25", "linestyle": ":", "linewidth": 1.2}
    axes.axhline(bare, **look, label="the larger of both without balancers")
    said = bool(dynamic_balancing(of_two_planes(rotor, BALLS), speed).possible[0])
    verdict = "conditions: yes" if said else "conditions: no"
    axes.set_title(f"{name} rotor, {speed:.0f} rad/s; {verdict}")
    logarithmic(axes, y=[1e-4, 1e-3, 1e-2, 1e-1, 1.0, 10.0])
    axes.set(ylim=(1e-4, 10.0), xlim=(0.0, duration))


if __name__ == "__main__":
    launch(shown(two_plane_balls=balls_figure))
