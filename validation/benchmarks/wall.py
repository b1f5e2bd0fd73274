"""What the law of the wall costs in a run-up: its time steps beside those of Stokes' law, in turns.

    python -m validation.benchmarks.wall

prints microseconds a layer step and their ratio.
"""

from __future__ import annotations

import math
import time

from fluid.fill import Fill
from fluid.friction.laws import Friction, FrictionLaw
from fluid.liquid import Liquid
from meshes.chamber import Chamber
from solvers.rotor.jeffcott import Jeffcott
from solvers.runup.long_wave import couple

_FILL = Fill(Chamber(0.25, 0.04), Liquid("water", 1000.0, 1e-6), 8e-4)
_ROTOR = Jeffcott(3.0, 3.0 * 15.0**2, 4.0, 2e-3)
_RATE, _STOP, _CELLS, _WARM = 4.0, 2.0, 128, 0.01


def step_times(repeats: int = 7) -> dict[str, float]:
    """Least time of a layer step of a run-up from 30 rad/s, s, by name of the law; laws take turns."""
    least = dict.fromkeys((FrictionLaw.STOKES, FrictionLaw.WALL), math.inf)
    for _ in range(repeats):
        for law in least:
            machine = couple(_ROTOR.system(), [_FILL], 30.0, Friction(law), 0.0, _CELLS, False)
            machine.state.rate[:] = 0.02, -0.01
            machine.advance(_WARM, _RATE, 0.8, 10**6)
            before, began = machine.sums.layer_steps, time.perf_counter()
            machine.advance(_STOP, _RATE, 0.8, 10**6)
            took = (time.perf_counter() - began) / (machine.sums.layer_steps - before)
            least[law] = min(least[law], took)
    return {str(law): took for law, took in least.items()}


if __name__ == "__main__":
    found = step_times()
    for name, took in found.items():
        print(f"{name:8} {1e6 * took:.2f} us a layer step, {took / found['stokes']:.3f} of Stokes'")
