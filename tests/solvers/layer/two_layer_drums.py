"""Liquid in two layers under a given drum speed, for the tests of either kind."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import NO_FRICTION, Friction
from fluid.liquid import Liquid
from meshes.arrays import Array
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from solvers.layer.records import records
from solvers.layer.state import ring
from solvers.layer.two_layer_step import advance, measure
from solvers.layer.two_layers import FLOWS, ROWS, TAKEN, resting, stream_of

G = 9.81
WATER = Liquid("water", 1000.0, 1e-6)
# The drum of the computed flow, a metre wide.
COMPUTED = Fill(Chamber(0.24, 1.0, 0.20, baffles=Baffles(8, 0.234)), WATER, 0.0200695)


@dataclass
class Drum:
    """Liquid in two layers, its drum and the force on it."""

    fill: Fill
    friction: Friction = NO_FRICTION
    gravity: float = G  #: m/s^2
    down: float = math.pi  #: its direction
    cells: int = 64
    is_ring: bool = False
    spin: float = 0.0  #: of the drum, rad/s, as it was last

    def __post_init__(self) -> None:
        self.stream = stream_of(self.fill, self.friction, self.gravity)
        self.angles, self.work = ring(self.cells), np.zeros((ROWS, self.cells))
        self.force = (
            self.gravity / self.fill.chamber.radius * np.array([math.cos(self.down), math.sin(self.down)])
        )
        self.flow, self.taken = np.zeros((4, self.cells)), records(TAKEN)[0]

    @property
    def mean(self) -> float:
        """Mean area over R^2."""
        return self.fill.volume / (2.0 * math.pi * self.fill.chamber.height * self.fill.chamber.radius**2)

    @property
    def pull(self) -> Array:
        """Radial force over R at the cells, 1/s^2."""
        return self.force[0] * self.angles[0] + self.force[1] * self.angles[1]

    def lie(self) -> None:
        """At rest at the bottom, the stream as deep as the baffles."""
        stream = self.stream
        whole = resting(self.mean, self.pull, stream.full, stream.slot, stream.rim)
        below = np.minimum(whole, stream.tip)
        self.flow[:] = [below, whole - below, 0.0 * whole, 0.0 * whole]

    def spread(self, rotation: float) -> None:
        """A ring of even depth, all of it in the upper layer."""
        area = np.full(self.cells, self.mean)
        self.flow[:] = [0.0 * area, area, 0.0 * area, rotation * area * (1.0 - area)]

    def go(self, time: float, spin: float = 0.0, steps: int = 1) -> None:
        """Go on for a time at a drum speed."""
        self.spin = spin
        for _ in range(steps):
            advance(
                *(self.flow, spin, self.force[0], self.force[1], self.is_ring, time / steps),
                *(self.angles, self.stream, np.array([[0.0, 0.0], [0.0, 0.0]]), self.work, self.taken),
            )

    def flows(self) -> np.record:
        """Record FLOWS now."""
        found = records(FLOWS)[0]
        stream = self.stream
        measure(self.flow, self.angles, stream.full, stream.slot, self.spin, self.work, found)
        return found

    def energy(self) -> float:
        """Of motion, pressure and height, over rho h_c R^4."""
        found = self.flows()
        return float(found.energy - self.force @ [found.moment_x, found.moment_y])
