"""Moments of a liquid body: volume, centre of mass, unbalance, inertia."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Moments:
    """Integrals over a liquid body, divided by the density.

    The origin lies on the rotation axis at the chamber floor; x points along the deflection, z along the
    axis. A body that is symmetric about the plane of the deflection has y = xy = yz = 0.

    Parameters
    ----------
    volume : integral of 1, m^3, shape (...,)
    x, y, z : first moments, m^4; x is the unbalance of the liquid over its density
    xx, yy, zz, xy, xz, yz : second moments, m^5
    """

    volume: Array
    x: Array
    y: Array
    z: Array
    xx: Array
    yy: Array
    zz: Array
    xy: Array
    xz: Array
    yz: Array

    @property
    def polar_inertia(self) -> Array:
        """Moment of inertia about the rotation axis over the density, m^5."""
        return self.xx + self.yy
