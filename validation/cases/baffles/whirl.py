"""Self-excited whirl with baffles: growth over speed and the bands, drawn and as a table.

python -m validation.cases.baffles.whirl --out docs/images
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import NO_FRICTION, Friction, FrictionLaw
from meshes.baffles import Baffles
from solvers.rotor.jeffcott import Jeffcott
from solvers.whirl.edges import unstable_bands
from solvers.whirl.growth import asynchronous_growth
from validation.cases.rotors.whirl import NATURAL, layered_rotor
from validation.page import Figure, Table, page
from validation.study import launch, shown

_ZETA = 0.05
_LAW = Friction(FrictionLaw.STOKES)

SPEEDS = np.linspace(0.3, 2.5, 221)  # over the natural frequency
COUNTS = (1, 2, 3, 4, 6, 8)
DEPTHS = (0.5, 0.75, 0.9, 1.0)


def with_baffles(fill: Fill, count: int, depth: float) -> Fill:
    """The same liquid with baffles over a part of the layer from the wall, 1 through the surface."""
    if count == 0:
        return fill
    tip = 0.0 if depth >= 1.0 else fill.chamber.radius - depth * fill.depth
    return replace(fill, chamber=replace(fill.chamber, baffles=Baffles(count, tip)))


def rotors() -> tuple[Jeffcott, Jeffcott, Fill]:
    """The rotor without and with damping of its support, and the clear layer: m_f/M = 0.1, h0/R = 0.1."""
    free, clear = layered_rotor(0.1, 0.1, 0.0)
    return free, layered_rotor(0.1, 0.1, _ZETA)[0], clear


def table() -> Table:
    """Growth and bands for sets of baffles, the clear ring first; damped with laminar friction."""
    free, damped, clear = rotors()
    rows = []
    for count, depth in [(0, 0.0), *((n, d) for n in COUNTS for d in DEPTHS)]:
        fill = with_baffles(clear, count, depth)
        growth, _ = asynchronous_growth(free, [fill], NATURAL * SPEEDS)
        both = (_bands(rotor, fill, law) for rotor, law in ((free, NO_FRICTION), (damped, _LAW)))
        rows.append((f"{count}", f"{depth:.0%}", f"{growth.max() / NATURAL:.4f}", *both))
    head = ("of the depth", "largest growth, undamped", "bands, undamped", "bands, damped")
    return Table(("baffles", *head), tuple(rows))


def _bands(rotor: Jeffcott, fill: Fill, friction: Friction) -> str:
    """Bands of speed, over the natural frequency without liquid, in which a whirl grows."""
    (found,) = unstable_bands(rotor, [[fill]], NATURAL * SPEEDS, friction)
    return ", ".join(f"{low / NATURAL:.4g} to {high / NATURAL:.4g}" for low, high in found) or "none"


def growth_figure() -> Figure:
    """Growth over speed of a damped rotor with none and with four baffles of several depths."""
    _, damped, clear = rotors()
    curves: tuple[tuple[str, int, float, str, Any], ...] = (
        ("no baffles", 0, 0.0, "#0072B2", "-"),
        ("4 baffles, 50 % of the depth", 4, 0.5, "#D55E00", (0, (5, 1.5))),
        ("4 baffles, 75 %", 4, 0.75, "#009E73", (0, (6, 1.5, 1, 1.5))),
        ("4 baffles, 90 %", 4, 0.9, "#CC79A7", (0, (1, 1.2))),
        ("4 baffles through the surface", 4, 1.0, "0.35", (0, (3, 1, 1, 1, 1, 1))),
    )
    text = (
        "Growth rate of the small whirl that grows most; above zero it grows by itself. Planar rotor "
        "with one layer, m_f/M = 0.1, h0/R = 0.1, damping ratio of the support "
        f"{_ZETA:g}, laminar friction in water. Linear theory, finite elements."
    )
    with page([2.75], text) as (figure, [[axes]]):
        axes.axhline(0.0, color="0.15", linewidth=0.8)
        for label, count, depth, color, dashes in curves:
            fill = with_baffles(clear, count, depth)
            growth, _ = asynchronous_growth(damped, [fill], NATURAL * SPEEDS, _LAW)
            look = {"color": color, "linestyle": dashes, "linewidth": 1.4, "label": label}
            axes.plot(SPEEDS, growth / NATURAL, **look)
        axes.set(xlim=(0.6, 2.4), xlabel="Spin speed over the natural frequency without liquid (\N{EN DASH})")
        axes.set_ylabel("Growth over the natural frequency (\N{EN DASH})")
    return figure


if __name__ == "__main__":
    launch(shown(table, whirl_baffles=growth_figure))
