"""Synchronous answer of a rotor with liquid chambers: every branch at every speed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Response:
    """Unbalance response over speed.

    Angles are measured from the unbalance, positive with the spin; a lag is negative. n speeds, b branches.

    Parameters
    ----------
    speed : spin speed Omega, rad/s, shape (n,)
    deflection : complex deflection w of the branch reported, m, shape (n,)
    deflection_dry : the same rotor without liquid, m, shape (n,)
    liquid_offset : distance of the liquid's centre of mass from the rotation axis, m, shape (n,)
    liquid_angle : angle from the unbalance to the liquid's centre of mass, rad, shape (n,)
    dry_patch : the wall is dry somewhere in at least one chamber, shape (n,)
    stable : the branch reported is stable against slow disturbances, shape (n,)
    model : liquid model used, shape (n,)
    in_range : the model holds there, shape (n,)
    converged : every branch was found, shape (n,)
    branch_deflection : all branches by rising amplitude, m, shape (n, b), nan where there are fewer
    branch_stable : their stability, shape (n, b)
    """

    speed: NDArray[np.float64]
    deflection: NDArray[np.complex128]
    deflection_dry: NDArray[np.complex128]
    liquid_offset: NDArray[np.float64]
    liquid_angle: NDArray[np.float64]
    dry_patch: NDArray[np.bool_]
    stable: NDArray[np.bool_]
    model: NDArray[np.str_]
    in_range: NDArray[np.bool_]
    converged: NDArray[np.bool_]
    branch_deflection: NDArray[np.complex128]
    branch_stable: NDArray[np.bool_]
