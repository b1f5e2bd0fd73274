"""The vector model of the liquid balancer: the balance of unbalances in angles.

The liquid lies along the deflection, which lags the total unbalance by delta. In units of the liquid's
unbalance the total is 1 + k e^{i alpha}, whose argument is delta [theory: rotor, eq. 10]; alpha from the
liquid to the rotor's unbalance, rad, positive with the spin.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array
from meshes.errors import InputError


def deflection_lag(speed: ArrayLike, mass: ArrayLike, damping: ArrayLike, stiffness: ArrayLike) -> Array:
    """Angle delta by which the deflection lags the total unbalance, rad, 0 to pi.

    tan(delta) = C Omega/(K - M Omega^2) [DR18, section 6; theory: rotor, eq. 9].
    """
    omega, m, c, k = (np.asarray(x, dtype=float) for x in (speed, mass, damping, stiffness))
    return np.asarray(np.arctan2(c * omega, k - m * np.square(omega)))


def balance_residual(angle: ArrayLike, lag: ArrayLike, ratio: ArrayLike) -> Array:
    """What is left of the balance of the tangential forces, over the liquid's unbalance; 0 in balance.

    k sin(alpha - delta) - sin(delta): smooth in every argument and without the square root of the source
    [DR18, eq. 23b and 24; theory: rotor, eq. 11].
    """
    alpha, delta, k = (np.asarray(x, dtype=float) for x in (angle, lag, ratio))
    return np.asarray(k * np.sin(alpha - delta) - np.sin(delta))


def balance_angles(lag: ArrayLike, ratio: ArrayLike) -> tuple[Array, Array]:
    """Both angles at which the tangential forces balance, rad.

    alpha_0 = delta + phi_C with sin(phi_C) = sin(delta)/k; their cosines are those of the source's solution
    with its lost factor 1/k put back [DR18, eq. 25; theory: rotor, eq. 13]. For k >= 1 only the first is an
    equilibrium; for k < 1 both are while delta < pi/2 and none beyond. An `InputError` below k = sin(delta),
    where no angle balances.
    """
    delta, k = (np.asarray(x, dtype=float) for x in (lag, ratio))
    if not np.all((delta >= 0.0) & (delta <= np.pi)):
        raise InputError("lag", lag, "0 to pi")
    if not np.all((k > 0.0) & (k >= np.sin(delta))):
        raise InputError("ratio", ratio, "above 0 and not below sin(lag)")
    inner = np.arcsin(np.sin(delta) / k)
    return np.asarray(delta + inner), np.asarray(delta + np.pi - inner)


def unbalance_left(angle: ArrayLike, ratio: ArrayLike) -> Array:
    """Residual unbalance ratio, total unbalance over the rotor's own; 0 where the liquid balances the rotor.

    lambda_0 = |1 + k e^{i alpha_0}|/k [DR18, eq. 26; theory: rotor, eq. 14].
    """
    alpha, k = (np.asarray(x, dtype=float) for x in (angle, ratio))
    if not np.all(k > 0.0):
        raise InputError("ratio", ratio, "above 0")
    return np.asarray(np.hypot(1.0 + k * np.cos(alpha), k * np.sin(alpha)) / k)
