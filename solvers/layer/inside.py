"""What stands inside a ring: baffles, and an inner wall that the layer may reach [theory: long_wave, eq. 18].

Where the layer fills its gap it is a full pipe. A narrow slot takes what is more than the gap holds, and the
pressure rises steeply with it. Air that is shut in is let out.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fluid.fill import Fill
from meshes.arrays import Array
from solvers.layer.baffles import COLUMNS, table_of

# Speed of waves in a full gap over that of the layer's own, sqrt(L) Omega.
SLOT_SPEED = 8.0
# An area over R^2 that no layer has.
OPEN = 1.0


class Inside(NamedTuple):
    """Obstacles of a ring, as the steps take them."""

    plates: Array  #: table of the baffles, as by `solvers.layer.baffles.table_of`
    full: float  #: area of the full gap over R^2, (1 - (R_i/R)^2)/2; 1 without an inner wall
    slot: float  #: rise of the head with the area beyond that, over Omega^2


NOTHING = Inside(np.zeros((0, COLUMNS)), OPEN, 0.0)


def full_area(fill: Fill) -> float:
    """Area of the full gap of a chamber over R^2; 1 without an inner wall."""
    ratio = fill.chamber.inner_radius / fill.chamber.radius
    return 0.5 * (1.0 - ratio) * (1.0 + ratio) if ratio > 0.0 else OPEN


def inside_of(fill: Fill, cells: int, smeared: bool | None = None) -> Inside:
    """Obstacles of a chamber, baffles smeared over the layer or not; None: the cells decide."""
    return Inside(table_of(fill, cells, smeared), full_area(fill), SLOT_SPEED**2)
