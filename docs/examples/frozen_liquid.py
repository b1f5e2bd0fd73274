"""The smallest liquid model: the liquid is frozen to the drum, an even ring about its axis.

Run it: `python docs/examples/frozen_liquid.py`.
"""

from __future__ import annotations

import numpy as np

from fluid.fill import Fill, Fills
from fluid.liquid import known_liquid
from meshes.chamber import Chamber
from solvers.liquid_model import LiquidAnswer, LiquidModel, Whirls
from solvers.rotor.jeffcott import Jeffcott
from solvers.synchronous.response import Response, response


class Frozen(LiquidModel):
    """An even ring of ice on the wall: its unbalance is its mass times the deflection, at any amplitude."""

    name = "frozen"

    def answer(self, fills: Fills, whirls: Whirls) -> LiquidAnswer:
        """See `solvers.liquid_model.LiquidModel`."""
        return LiquidAnswer.at_rest(fills, whirls, fills.mass * whirls.amplitude, fills.mass)


def answers() -> tuple[Response, Response]:
    """A rotor with a ring of ice, and the same rotor that is heavier by the ice."""
    fill = Fill(Chamber(radius=0.25, height=0.04), known_liquid("water"), volume=0.5e-3)
    speed = np.linspace(5.0, 100.0, 39)
    light = Jeffcott(mass=30.0, stiffness=18750.0, damping=90.0, unbalance=0.1)
    heavy = Jeffcott(mass=30.0 + fill.mass, stiffness=18750.0, damping=90.0, unbalance=0.1)
    return (
        response(light, [fill], speed, model=Frozen()),
        response(heavy, [], speed),
    )


if __name__ == "__main__":
    frozen, heavier = answers()
    gap = np.abs(frozen.deflection - heavier.deflection).max() / np.abs(heavier.deflection).max()
    print(f"largest amplitude {1e3 * np.abs(frozen.deflection).max():.3f} mm, apart by {gap:.0e}")
