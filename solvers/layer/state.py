"""A finite-volume layer: its ring, resolution, equilibrium and the means of its loads.

Lengths over R, times over 1/Omega; complex numbers: along the deflection, 90 deg ahead of it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from meshes.arrays import Array, Complex
from meshes.errors import InputError
from solvers.layer.records import Record


@lru_cache(maxsize=16)
def ring(cells: int) -> Array:
    """Cosine and sine at the cells' middles and at their left faces, shape (4, n); the first cell from 0."""
    edge = 2.0 * math.pi * np.arange(cells) / cells
    middle = edge + math.pi / cells
    return np.stack([np.cos(middle), np.sin(middle), np.cos(edge), np.sin(edge)])


def turned_ring(values: Array, angle: float) -> Array:
    """Densities a radian on as many cells that begin at minus `angle`; their integral stays, shape (k, n)."""
    count = values.shape[1]
    whole = np.concatenate([np.zeros((len(values), 1)), np.cumsum(values, axis=1)], axis=1) / count
    edges = np.arange(count + 1) / count - angle / (2.0 * math.pi)
    turns = np.floor(edges)
    places = np.linspace(0.0, 1.0, count + 1)
    sums = np.array([np.interp(edges - turns, places, row) + turns * row[-1] for row in whole])
    return np.asarray(np.diff(sums, axis=1) * count)


def means(
    sums: Record,
    length: float,
    mass: float,
    whirl_speed: float,
    offsets: tuple[complex, complex],
    rates: tuple[complex, complex],
) -> Complex:
    """Means over a time of a record LOADS, shape (6,); forces over rho h_c R^3 [theory: long_wave, eq. 7].

    Force by the liquid's momentum, offset, turning, least and largest depth, force by the pressure on the
    wall. The mass is over rho h_c R^2; offsets and their rates are those at both ends, in the frame of the
    deflection.
    """
    pressure = complex(sums.force_x, sums.force_y) / length
    moved = complex(sums.offset_x, sums.offset_y) / length
    push = complex(sums.push_x, sums.push_y) / length
    drift = (offsets[1] - offsets[0]) / length
    gain = (rates[1] - rates[0]) / length
    # The liquid as a whole: what pushes it, the centripetal and the Coriolis part, what its velocity gains.
    inertia = mass * (push + whirl_speed**2 * moved - 2j * whirl_speed * drift - gain)
    rest = sums.turning / length, sums.depth_min / length, sums.depth_max / length
    return np.array([inertia, moved, *rest, pressure], dtype=np.complex128)


@dataclass(frozen=True)
class Numerics:
    """How the layer is resolved."""

    cells: int = 256  #: finite volumes round the wall, at least 8
    dispersion: bool = False  #: add the finite depth's dispersion [theory: long_wave, eq. 13]

    def __post_init__(self) -> None:
        if not 8 <= self.cells <= 65536:
            raise InputError("cells", self.cells, "from 8 to 65536")


def resting_area(amplitude: float, cells: int, mean: float) -> Array:
    """Equilibrium of the liquid under a synchronous whirl: a circle about the rotation axis, cell by cell.

    A over R^2, the deflection along theta = 0, shape (n,).
    """
    cosine, sine = ring(cells)[:2]

    def at(squared: float) -> Array:
        # Distance from the drum's axis to the circle of that squared radius about the rotation axis.
        across = squared - np.square(amplitude * sine)
        surface = np.sqrt(np.maximum(across, 0.0)) - amplitude * cosine
        return np.asarray(0.5 * np.maximum(1.0 - np.square(np.clip(surface, 0.0, 1.0)), 0.0))

    low, high = 0.0, (1.0 + amplitude) ** 2
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if at(middle).mean() > mean else (low, middle)
    return at(0.5 * (low + high))
