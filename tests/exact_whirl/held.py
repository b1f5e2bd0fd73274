"""`python -m tests.exact_whirl.held`: exact waves held beside long ones, on the examples; kept."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from leblanc.liquid.choose import choose_all, costed, liquid_models, prepare
from leblanc.scene.examples import example
from leblanc.studies.held.held import held_machine, hold_speeds
from leblanc.studies.held.holding import HERE
from solvers.held.integrate import compile_kernels, start
from solvers.held.state import HoldNumerics
from solvers.synchronous.response import response
from solvers.whirl.growth import asynchronous_growth
from validation.study import launch, stored

KEPT = Path(__file__).parent / "held.json"
# Example, rpm, nodes of the exact wave, cells of the long ones.
CASES = (
    ("tub", 600.0, 32, 64), ("two_plane_rig", 1500.0, 32, 64), ("washing_machine", 800.0, 32, 64),
    ("horizontal_rig", 600.0, 32, 128), ("horizontal_rig", 1000.0, 32, 128),
    ("horizontal_rig", 1600.0, 32, 128),
)  # fmt: skip


@dataclass(frozen=True)
class Told:
    """What one model tells of a speed."""

    state: str  #: how it moves
    reason: str  #: why it has not settled, or empty
    amplitude: float | None  #: mean over time, m; none of a motion that broke off
    turns: int  #: turns that it was held
    seconds: float  #: of one core
    estimate: float  #: of them, by `solvers.held.cost`


@dataclass(frozen=True)
class Pair:
    """Both models at a speed."""

    example: str  #: scene
    rpm: float  #: speed
    exact: Told  #: what they tell
    long: Told

    @property
    def apart(self) -> float:
        """Relative difference of the amplitudes; nan where there is none."""
        if self.exact.amplitude is None or self.long.amplitude is None:
            return math.nan
        return self.exact.amplitude / self.long.amplitude - 1.0


def held_at(name: str, rpm: float, liquid: str, cells: int) -> Told:
    """Time-domain state of an example at one speed, rpm, from its synchronous motion."""
    spin = rpm * math.pi / 30.0
    change = {"speeds.start": spin, "speeds.stop": spin, "speeds.count": 1}
    scene = example(name).replace(change | {"model.liquid": liquid, "model.cells": cells})
    machine = prepare(scene)
    growth = asynchronous_growth(machine.rotor, scene.fills, machine.speed, machine.friction)[0]
    choice = costed(machine, choose_all([machine])[0], growth)
    found = response(machine.rotor, scene.fills, machine.speed, machine.axial_gravity, liquid_models(choice))
    held = held_machine(machine)
    compile_kernels(held, start(held, spin, HoldNumerics(cells=cells)))
    begin = time.process_time()
    (state,) = hold_speeds(machine, found, growth, HERE).up
    seconds = time.process_time() - begin
    estimate = math.nan if choice.holding is None else float(choice.holding[0])
    amplitude = state.amplitude if math.isfinite(state.amplitude) else None
    return Told(str(state.kind), state.reason, amplitude, state.turns, round(seconds, 2), estimate)


def pair(name: str, rpm: float, nodes: int, cells: int) -> Pair:
    """Both models, with nodes of the exact wave and cells of long waves."""
    return Pair(name, rpm, held_at(name, rpm, "potential", nodes), held_at(name, rpm, "long_wave", cells))


kept, keep = stored(KEPT, tuple[Pair, ...])


def main() -> Iterator[str]:
    """Compute, keep, print."""
    pairs: tuple[Pair, ...] = ()
    for case in CASES:
        pairs = (*pairs, pair(*case))
        keep(pairs)
        yield f"{pairs[-1]} {pairs[-1].apart:.2e}"


if __name__ == "__main__":
    launch(main)
