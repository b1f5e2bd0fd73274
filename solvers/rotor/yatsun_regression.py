"""The printed regression of the dual-frequency exciter's critical speed."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

# Coefficients of 1, delta, h, b: numerators and denominators of g1, g2, g3 [YF17, eq. 20].
_PRINTED = (
    ((1.0, -26.5235, -16.7424, -30.1288), (-0.2537, -0.8080, -3.9439, 0.6984)),
    ((1.0, 1.7134, 8.2055, -28.7751), (-0.3455, -0.5673, 4.3034, 8.2679)),
    ((1.0, -9.2714, 229.7664, 43.5133), (-0.0992, 2.4911, 35.3149, -0.1019)),
)
# Ranges that the coefficients were fitted in [YF17, section 5.2].
RANGES = {"smallness": (0.005, 0.05), "drag": (0.1, 0.6), "unbalance": (0.0, 1.0), "damping": (0.01, 0.07)}


def printed_critical_speed(
    smallness: ArrayLike, drag: ArrayLike, unbalance: ArrayLike, damping: ArrayLike
) -> Array:
    """Critical speed as the source prints it [YF17, eq. 18-20]; two balls.

    Parameters
    ----------
    smallness, drag, unbalance, damping : eps, b, delta, h, see `solvers.rotor.exciter.Dimensionless`,
        shapes (...,)

    Returns
    -------
    n_cr over the natural frequency, shape (...,)
    """
    eps, b, delta, h = np.broadcast_arrays(
        *(np.asarray(x, dtype=float) for x in (smallness, drag, unbalance, damping))
    )
    terms = np.stack((np.ones_like(eps), delta, h, b), axis=-1)
    first, second, third = (terms @ np.array(top) / (terms @ np.array(bottom)) for top, bottom in _PRINTED)
    return np.asarray(1.0 + (1.0 + eps * first) / (4.0 * (b + eps * second) * (h + eps * third)))
