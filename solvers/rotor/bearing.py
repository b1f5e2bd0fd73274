"""How fast the cage of a rolling bearing turns, and by how much it lags."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array
from meshes.errors import InputError


def cage_speed(
    shaft_speed: ArrayLike,
    pitch_diameter: ArrayLike,
    ball_diameter: ArrayLike,
    contact_angle: ArrayLike = 0.0,
) -> Array:
    """Speed of the cage when the balls roll without slip, inner ring turning, outer ring at rest.

    n_c = (n_s/2) (d_0 - d_b cos(beta))/d_0 [DR18, eq. 9; theory: rotor, eq. 32]. It is n_s/2 only where the
    balls are small against their circle, also for beta = 0, where the source drops d_b [DR18, eq. 10].

    Parameters
    ----------
    shaft_speed : n_s, in any unit, shape (...,)
    pitch_diameter : d_0 of the circle of the balls' centres, m, shape (...,)
    ball_diameter : d_b, m, shape (...,), below d_0
    contact_angle : beta, rad, shape (...,), from 0 to below pi/2

    Returns
    -------
    n_c in the unit of n_s, shape (...,)

    Raises
    ------
    InputError : a diameter or an angle out of its range

    Examples
    --------
    >>> float(cage_speed(1000.0, 28.5e-3, 6.75e-3))
    381.57894736842104
    """
    shaft, pitch, ball, angle = (
        np.asarray(x, dtype=float) for x in (shaft_speed, pitch_diameter, ball_diameter, contact_angle)
    )
    if not np.all(np.isfinite(pitch) & (pitch > 0.0)):
        raise InputError("pitch_diameter", pitch_diameter, "finite numbers above 0")
    if not np.all((ball >= 0.0) & (ball < pitch)):
        raise InputError("ball_diameter", ball_diameter, "0 or above and below the pitch diameter")
    if not np.all((angle >= 0.0) & (angle < 0.5 * np.pi)):
        raise InputError("contact_angle", contact_angle, "from 0 to below pi/2")
    return np.asarray(0.5 * shaft * (1.0 - ball * np.cos(angle) / pitch))
