"""The ring of cells, and a layer's loads on its drum as means over a time from what the steps have summed up.

Lengths over R, times in the unit of the spin; complex numbers: along the deflection, 90 deg ahead of it.
"""

from __future__ import annotations

import cmath
import math
from functools import lru_cache

import numpy as np

from meshes.arrays import Array, Complex
from solvers.layer.records import Drive, Record


@lru_cache(maxsize=16)
def ring(cells: int) -> Array:
    """Cosine and sine at the cells' middles and at their left faces, shape (4, n); the first cell from 0."""
    edge = 2.0 * math.pi * np.arange(cells) / cells
    middle = edge + math.pi / cells
    return np.stack([np.cos(middle), np.sin(middle), np.cos(edge), np.sin(edge)])


def offset(area: Array, drive: Drive, angles: Array, time: float) -> complex:
    """Offset of the liquid's centre of mass from the drum's axis at a time.

    Parameters
    ----------
    area : A, shape (n,)
    drive, angles : as for `solvers.layer.step.advance`
    time : at which the deflection has turned by the slip times it
    """
    surface = np.sqrt(np.maximum(1.0 - 2.0 * area, 0.0))
    lever = (1.0 - surface) * (1.0 + surface + surface * surface) / 3.0
    found = complex(lever @ angles[0], lever @ angles[1]) / float(area.sum())
    return found * cmath.exp(-1j * drive.slip * time)


def means(
    sums: Record, length: float, mass: float, whirl_speed: float, offsets: tuple[complex, complex]
) -> Complex:
    """Means over a time [theory: long_wave, eq. 7].

    Parameters
    ----------
    sums : a record LOADS of `solvers.layer.records`
    length : of the time
    mass : of the liquid, over rho h_c R^2
    whirl_speed : omega_w
    offsets : at the beginning and at the end

    Returns
    -------
    Force by the liquid's momentum and offset, turning, least and largest depth, force by the pressure on the
    wall, shape (6,); forces are over rho h_c R^3
    """
    pressure = complex(sums.force_x, sums.force_y) / length
    moved = complex(sums.offset_x, sums.offset_y) / length
    push = complex(sums.push_x, sums.push_y) / length
    drift = (offsets[1] - offsets[0]) / length
    # The liquid as a whole: what pushes it, the centripetal and the Coriolis part.
    inertia = mass * (push + whirl_speed**2 * moved - 2j * whirl_speed * drift)
    rest = sums.turning / length, sums.depth_min / length, sums.depth_max / length
    return np.array([inertia, moved, *rest, pressure], dtype=np.complex128)
