"""What it costs to go by py-pde: a layer driven by its `solve`, against the compiled kernel called directly.

`python -m tests.oracles.bare_layer` runs both in turn and prints the processor time of each and the ratio.
"""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import QUADRATIC, Friction, FrictionLaw
from fluid.liquid import known_liquid
from meshes.arrays import Array
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.layer.records import LOADS, Drive, Outcome, Record, Wall, records
from solvers.layer.state import Numerics, ring
from solvers.layer.step import march, scratch
from solvers.liquid_model import Whirl, drag_frequency
from solvers.pypde.settle import simulate
from validation.study import launch

PERIODS, CELLS, REPEATS = 100, 128, 15
_COURANT = 0.8


class BareLayer:
    """Uniform layer at rest in the drum, for the compiled time steps; lengths over R, times over 1/Omega.

    Parameters as of `solvers.pypde.settle.simulate`.
    """

    def __init__(self, fill: Fill, whirl: Whirl, friction: Friction, numerics: Numerics) -> None:
        chamber, spin, n = fill.chamber, whirl.spin, numerics.cells
        radius = chamber.radius
        self.fill, self.whirl, self.time, self.outcome = fill, whirl, 0.0, Outcome.DONE
        self.steps = 0
        self.area = np.full(n, fill.volume / (2.0 * math.pi * chamber.height * radius**2))
        self.momentum = -np.square(self.area)
        law, coefficient = friction.at(fill.liquid.viscosity, drag_frequency(fill, whirl), radius)
        # The quadratic coefficient is a pure number, the others are rates.
        scaled = coefficient if law == QUADRATIC else coefficient / spin
        self.wall = Wall(law, scaled, 2.0 * radius / chamber.height, numerics.dispersion)
        self.drive = Drive(
            amplitude=whirl.amplitude / radius,
            slip=whirl.slip / spin,
            ramp=whirl.ramp * spin,
            whirl=whirl.speed / spin,
            weight=whirl.gravity / (radius * spin**2),
            spin=1.0,
        )
        self.angles, self.scratch = ring(n), scratch(n)

    def advance(self, periods: float = 1.0, most: int | None = None) -> Record:
        """Go on for so many whirl periods; the integrals of the loads over them, as a record LOADS."""
        sums, length = records(LOADS), periods * self.whirl.period * self.whirl.spin
        self.outcome, self.steps = march(
            *(self.area, self.momentum, self.time, self.time + length, self.drive, self.wall, self.angles),
            *(_COURANT, self.scratch, sums),
            most=most,
        )
        self.time += length
        return sums

    def profile(self) -> Array:
        """Depth over R from the deflection onward, by rising angles, shape (n,)."""
        middle = 2.0 * math.pi * (np.arange(self.area.size) + 0.5) / self.area.size
        theta = np.mod(middle - self.drive.slip * self.time + math.pi, 2.0 * math.pi)
        return np.asarray(1.0 - np.sqrt(1.0 - 2.0 * self.area))[np.argsort(theta)]


@dataclass(frozen=True)
class Road:
    """Cost of a layer over whirl periods, by py-pde and without it."""

    cells: int  #: of the layer and of its way
    periods: int
    bare: float  #: least processor times of the kernel called period by period and of py-pde's `solve`, s
    road: float
    overhead: float  #: share by which the second takes longer; noise only adds to a time


def measure(periods: int = PERIODS, cells: int = CELLS, repeats: int = REPEATS) -> Road:
    """Both in turn in this process, after one of each to compile."""
    if repeats < 1:
        raise InputError("repeats", repeats, "1 or more")
    radius, friction, numerics = 0.15, Friction(FrictionLaw.LINEAR, 1.0), Numerics(cells)
    fill = Fill(Chamber(radius, 0.05), known_liquid("water"), 6.7e-4)
    whirl = Whirl(40.0, 32.0, 1.5e-4, ramp=1.0)

    def bare() -> None:
        layer = BareLayer(fill, whirl, friction, numerics)
        for _ in range(periods):
            layer.advance()

    def road() -> None:
        simulate(fill, whirl, periods * whirl.period, friction, numerics)

    times = []
    for turn in range(repeats + 1):
        # To and fro, so that neither always follows the other.
        runs = (bare, road) if turn % 2 else (road, bare)
        taken = {run: _cpu_time(run) for run in runs}
        times.append((taken[bare], taken[road]))
    least = np.min(times[1:], axis=0)
    return Road(cells, periods, float(least[0]), float(least[1]), float(least[1] / least[0]) - 1.0)


def _cpu_time(run: Callable[[], None]) -> float:
    begin = time.process_time()
    run()
    return time.process_time() - begin


def main(
    periods: int = PERIODS, cells: int = CELLS, repeats: int = REPEATS, as_json: bool = False
) -> Iterator[str]:
    """Measure and print, in words or as one JSON object."""
    found = measure(periods, cells, repeats)
    if as_json:
        yield json.dumps(asdict(found))
        return
    told = f"kernel {found.bare:.3f} s, by py-pde {found.road:.3f} s of processor time"
    more = f"{100.0 * found.overhead:+.1f} %, least of {repeats} turns"
    yield f"{found.periods} whirl periods on {found.cells} cells: {told}; {more}"


if __name__ == "__main__":
    launch(main)
