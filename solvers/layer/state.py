"""A finite-volume layer with what drives it: its start, its equilibrium, its way through whirl periods.

Lengths over R, times over 1/Omega.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fluid.fill import Fill
from fluid.friction import QUADRATIC, Friction
from meshes.arrays import Array, Complex
from meshes.errors import InputError
from solvers.layer.loads import Drive, means, offset, ring
from solvers.layer.prescribed import Numerics, Whirl

_COURANT = 0.8
_STEPS = 20_000_000  # in one whirl period


@dataclass
class MovingLayer:
    """A layer and what drives it.

    Parameters
    ----------
    fill, whirl : what it is made from
    area, momentum : A and q, shape (n,)
    drive, rub, angles, scratch : as for `solvers.layer.step.advance`
    time : how far it has come
    reason : why it went no further, or empty
    """

    fill: Fill
    whirl: Whirl
    area: Array
    momentum: Array
    drive: Drive
    rub: tuple[float, float, float, float]
    angles: Array
    scratch: Array
    time: float = 0.0
    reason: str = ""

    def periods(self, count: float) -> Complex | None:
        """Advance by whirl periods; `solvers.layer.loads.means` over them, or None with a `reason`."""
        from solvers.layer.step import AT_AXIS, advance

        length = self.whirl.period * self.whirl.spin * count
        first, sums = offset(self.area, self.drive, self.angles, self.time), np.empty(9)
        steps = advance(
            self.area,
            self.momentum,
            self.time,
            self.time + length,
            self.drive,
            self.rub,
            self.angles,
            _COURANT,
            _STEPS,
            self.scratch,
            sums,
        )
        if steps < 0:
            self.reason = "the surface came to the axis" if steps == AT_AXIS else "the time steps ran out"
            return None
        self.time += length
        last = offset(self.area, self.drive, self.angles, self.time)
        mass = 2.0 * math.pi * float(self.area.mean())
        return means(sums, length, mass, self.drive[3], (first, last))


def start(fill: Fill, whirl: Whirl, friction: Friction, numerics: Numerics) -> MovingLayer:
    """Uniform layer at rest in the drum.

    Parameters
    ----------
    fill, whirl, friction, numerics : as for `solvers.layer.settle.simulate`

    Raises
    ------
    InputError : no liquid, no free surface
    """
    from solvers.layer.step import scratch

    chamber = fill.chamber
    if not 0.0 < fill.volume < chamber.capacity * (1.0 - 1e-9):
        raise InputError("volume", fill.volume, f"above 0 and below the capacity ({chamber.capacity:g} m^3)")
    radius, spin = chamber.radius, whirl.spin
    n = numerics.cells
    area = np.full(n, fill.volume / (2.0 * math.pi * chamber.height * radius**2))
    log = -0.5 * math.log1p(-2.0 * area[0])
    law, coefficient = friction.at(fill.liquid.viscosity, whirl.slip, radius)
    # The quadratic coefficient is a pure number, the others are rates.
    scaled = coefficient if law == QUADRATIC else coefficient / spin
    return MovingLayer(
        fill=fill,
        whirl=whirl,
        area=area,
        momentum=-np.square(area),
        drive=(
            whirl.amplitude / radius,
            whirl.slip / spin,
            whirl.ramp * spin,
            whirl.speed / spin,
            whirl.gravity / (radius * spin**2),
            1.0,
        ),
        rub=(float(law), scaled, 2.0 * radius / chamber.height, log**2 if numerics.dispersion else 0.0),
        angles=ring(n),
        scratch=scratch(n),
    )


def settle_statics(layer: MovingLayer) -> None:
    """Equilibrium of the liquid under a synchronous whirl: a circle about the rotation axis, cell by cell."""
    amplitude, whole = layer.drive[0], float(layer.area.sum())
    cosine, sine = layer.angles[0], layer.angles[1]

    def cells(squared: float) -> Array:
        # Distance from the drum's axis to the circle of that squared radius about the rotation axis.
        across = squared - np.square(amplitude * sine)
        surface = np.sqrt(np.maximum(across, 0.0)) - amplitude * cosine
        return np.asarray(0.5 * np.maximum(1.0 - np.square(np.clip(surface, 0.0, 1.0)), 0.0))

    low, high = 0.0, (1.0 + amplitude) ** 2
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if cells(middle).sum() > whole else (low, middle)
    layer.area[:] = cells(0.5 * (low + high))
    layer.momentum[:] = -np.square(layer.area)


def depth(layer: MovingLayer) -> Array:
    """Depth of each cell, m."""
    surface = np.sqrt(np.maximum(1.0 - 2.0 * layer.area, 0.0))
    return np.asarray(layer.fill.chamber.radius * (1.0 - surface))
