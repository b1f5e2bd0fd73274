"""Two liquid layers as the balancers of a rotor in two planes, in time, against the conditions of [FF20]."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import Friction, FrictionLaw
from fluid.liquid import Liquid
from meshes.arrays import Array
from meshes.chamber import Chamber
from solvers.rotor.balls.two_plane_balance import dynamic_balancing, of_two_planes
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from solvers.rotor.vibration import unbalance_response
from solvers.runup.machine import Ramp
from solvers.runup.runup import RunupNumerics, run_up
from validation.case import Case, Claims

CLAIMS = Claims("two_plane")

SUPPORTS = (Support(-0.3, 1e4, 200.0), Support(0.3, 1e4, 200.0))
UNBALANCES = (PlaneUnbalance(-0.28, 6e-3, 0.0), PlaneUnbalance(0.28, 6e-3, 2.0))
LONG = TwoPlane(20.0, 1.0, 0.4, SUPPORTS, UNBALANCES)
SHORT = TwoPlane(20.0, 1.0, 1.4, SUPPORTS, UNBALANCES)
FILLS = tuple(Fill(Chamber(0.15, 0.03, 0.0, z), Liquid("water", 998.2, 1e-6), 3e-4) for z in (-0.25, 0.25))
# Friction of chambers with baffles: with smooth walls the liquid's waves would excite whirls of their own.
FRICTION = Friction(FrictionLaw.LINEAR, 30.0)
SPEEDS = (20.0, 45.0, 110.0, 150.0)  # rad/s: below, between and above the critical speeds of the long rotor
_HOLD = 6.0  # s


@dataclass(frozen=True)
class Layered:
    """What two layers made of a rotor's deflections."""

    left: Array  #: deflection at each chamber with liquid over that without, shape (2,)
    unsteady: float  #: what still moves, over the deflection
    possible: bool  #: the conditions let the rotor be balanced in two planes


def layers_in_time(rotor: TwoPlane, speed: float, cells: int = 64) -> Layered:
    """Hold a rotor with two layers at a speed until it is steady."""
    system = rotor.system()
    whirl = unbalance_response(system, [speed])[0]
    planes = [system.at(fill.chamber.plane) for fill in FILLS]
    # Half of x - i y of a forward whirl: its radius.
    bare = np.array([abs(plane[0] @ whirl + 1j * (plane[1] @ whirl)) / 2.0 for plane in planes])
    drive = Ramp(0.999 * speed, speed, 0.01 * speed, _HOLD)
    numerics = RunupNumerics(cells=cells, samples=200, companion=False)
    history = run_up(system, FILLS, drive, FRICTION, 0.0, numerics)
    last = np.abs(history.deflection[-50:])
    steady = last.mean(axis=0)
    verdict = dynamic_balancing(of_two_planes(rotor), speed)
    return Layered(steady / bare, float((last.std(axis=0) / steady).max()), bool(verdict.possible[0]))


def cases() -> Iterator[Case]:
    """A long and a short rotor over the speeds."""
    for name, rotor in (("long", LONG), ("short", SHORT)):
        for speed in SPEEDS:
            run = layers_in_time(rotor, speed)
            better = bool(np.all(run.left < 1.0))
            words = {
                "rotor": name,
                "speed": speed,
                "left": run.left,
                "printed": "yes" if run.possible else "no",
            }
            yield CLAIMS.case("layers", "yes" if better else "no", better == run.possible, **words)
