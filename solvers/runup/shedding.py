"""The unbalance of a run-up as parts of it leave [theory: coupling, eq. 15]."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from meshes.arrays import Array
from solvers.rotor.system import RotorSystem
from solvers.runup.machine import RunupMachine

# A drum held at the speed itself is fast enough, whatever rounding makes of it.
_HELD = 1e-9
# Of the shortest time constant: for so long the unbalance stands at what it is in the middle.
_PIECE = 1e-3


class Shedding:
    """What is left of the s parts of a rotor that leave, and the pieces of time in which it is set anew."""

    def __init__(self, system: RotorSystem) -> None:
        self._system = system
        self._time = np.array([shed.time_constant for shed in system.sheds])
        self._above = (1.0 - _HELD) * np.array([shed.above for shed in system.sheds])
        self._heavy = any(shed.mass is not None for shed in system.sheds)
        self.left: Array = np.ones(len(system.sheds))
        self.brought = 0.0  # energy that came with what has left, below 0, J

    def pieces(self, machine: RunupMachine, stop: float) -> Iterator[float]:
        """Times on the way to another; the unbalance is set before each, what has left is gone after."""
        if not self.left.size:
            yield stop
            return
        begin = machine.time
        count = max(1, math.ceil((stop - begin) / (_PIECE * float(self._time.min()))))
        for until in [begin + (stop - begin) * k / count for k in range(1, count)] + [stop]:
            spin, step = machine.spin, until - machine.time
            middle = self.left * np.exp(-0.5 * step / self._time * (spin > self._above))
            machine.load(self._system.unbalance - sum(self._gone(middle)))
            if self._heavy:
                self.brought += machine.lighten(*self._lost(middle))
            yield until
            self.left = self.left * np.exp(-step / self._time * self._share(spin, machine.spin))

    def _gone(self, left: Array) -> list[Array]:
        """What has left of each part, kg m, for the shares that are left."""
        pairs = zip(self._system.sheds, left.tolist(), strict=True)
        return [(1.0 - share) * shed.unbalance for shed, share in pairs]

    def _lost(self, left: Array) -> tuple[Array, float]:
        """Mass matrix and moment of inertia of what has left."""
        mass, inertia = np.zeros_like(self._system.mass), 0.0
        for shed, share in zip(self._system.sheds, left.tolist(), strict=True):
            if shed.mass is not None:
                mass += (1.0 - share) * shed.mass
                inertia += (1.0 - share) * shed.inertia
        return mass, inertia

    def _share(self, before: float, after: float) -> Array:
        """Share of a piece of time in which the drum is fast enough, its speed on a straight line."""
        low, high = min(before, after), max(before, after)
        if high <= low:
            return np.asarray(low > self._above, dtype=float)
        return np.clip((high - self._above) / (high - low), 0.0, 1.0)
