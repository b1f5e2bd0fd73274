"""Stability of steady waves: the spectrum of the equation linearised about them, in the whirl's frame."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigvals

from meshes.border import InputError
from solvers.wave_modes import DENSE_MODES, System, one_thread, split
from solvers.wave_newton import SteadyWave, scaled_unknowns

Complex = NDArray[np.complex128]


def growth_rates(wave: SteadyWave) -> Complex:
    """Growth rates of small disturbances of a steady wave, seen in the whirl's frame.

    Eigenvalues of the linearised operator on disturbances that carry no liquid to or from the layer
    [theory: kdv, eq. 21]. A free wave may be shifted at no cost; that direction is taken out.

    Parameters
    ----------
    wave : a converged wave of at most `DENSE_MODES` modes

    Returns
    -------
    Eigenvalues, 1/s, largest real part first; unstable if that is above 0; shape (2 M,) or, for a free wave,
    (2 M - 1,)

    Raises
    ------
    InputError : a wave that is not converged or has too many modes
    """
    if not wave.converged:
        raise InputError("wave", wave.reason, "converged")
    if wave.modes.size > DENSE_MODES:
        raise InputError("wave", wave.modes.size, f"of at most {DENSE_MODES} modes")
    problem, m = wave.problem, wave.modes.size
    with one_thread():
        system = System(problem, m)
        jacobian = system.jacobian(scaled_unknowns(wave), wave.speed / system.scale, m)
        n = system.n[:, None]
        # d v_n/dt = -i n times the derivative of the equation of mode n.
        operator = np.vstack((n * jacobian[m:], -n * jacobian[:m]))
        if problem.forcing == 0.0 and wave.rms > 0.0:
            shift = split(1j * system.n * wave.modes)
            basis = np.linalg.qr(shift[:, None], mode="complete")[0][:, 1:]
            operator = basis.T @ operator @ basis
        values = eigvals(operator, check_finite=False) * system.scale
    return np.asarray(values[np.argsort(-values.real)])


def growth(wave: SteadyWave) -> float:
    """Largest growth rate of small disturbances, 1/s; arguments and errors as in `growth_rates`."""
    return float(growth_rates(wave)[0].real)
