"""Exponential Runge-Kutta methods: what one step multiplies with.

A linear part L, one number for each Fourier mode, is carried by its exponential; the rest enters through
weights that are functions of L times the step.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from meshes.arrays import Complex
from meshes.errors import InputError

# Terms of the Taylor series of the phi functions for |z| < 1: the first one left out is below 1/19!.
_TERMS = 19


@dataclass(frozen=True)
class Method:
    """A method of four stages.

    Parameters
    ----------
    order : of the error over a fixed time in the length of the step
    weights : takes z = L times the step, shape (modes,); returns a21, a31, a32, a41, a43, b1, b2, b4
    lawson : whether N is followed along each mode's own motion, e^{-L t} N, instead of in a frame
    """

    order: int
    weights: Callable[[Complex], tuple[Complex, ...]]
    lawson: bool = False


class Weights(NamedTuple):
    """What a step of one length multiplies with, each of shape (modes,).

    `half` and `full` carry the field over half and the whole step; a and b weigh N and contain the step;
    `near` and `far` bring N from the middle and from the start to where N at the end compares with it.
    """

    half: Complex
    full: Complex
    a21: Complex
    a31: Complex
    a32: Complex
    a41: Complex
    a43: Complex
    b1: Complex
    b2: Complex
    b4: Complex
    near: Complex
    far: Complex


def phi_functions(z: Complex) -> tuple[Complex, Complex, Complex]:
    """phi_1, phi_2, phi_3 to rounding for every argument [theory: steppers, eq. 2].

    Parameters
    ----------
    z : shape (...,), dimensionless

    Returns
    -------
    Three arrays of that shape; 1, 1/2 and 1/6 at z = 0
    """
    z = np.asarray(z, dtype=complex)
    near = np.abs(z) < 1.0
    # The quotients cancel near 0; there the Taylor series takes over.
    small, large = np.where(near, z, 0.0), np.where(near, 1.0, z)
    phi_1 = np.expm1(large) / large
    phi_2 = (phi_1 - 1.0) / large
    phi_3 = (phi_2 - 0.5) / large
    series = [np.zeros_like(small) for _ in range(3)]
    for j in reversed(range(_TERMS)):
        series = [s * small + 1.0 / math.factorial(j + k) for k, s in enumerate(series, start=1)]
    return (
        np.where(near, series[0], phi_1),
        np.where(near, series[1], phi_2),
        np.where(near, series[2], phi_3),
    )


def _end_weights(z: Complex) -> tuple[Complex, ...]:
    """Weights of N in the result, exact for N quadratic in time [theory: steppers, eq. 4]."""
    phi_1, phi_2, phi_3 = phi_functions(z)
    return phi_1 - 3.0 * phi_2 + 4.0 * phi_3, 2.0 * phi_2 - 4.0 * phi_3, 4.0 * phi_3 - phi_2


def _cox_matthews(z: Complex) -> tuple[Complex, ...]:
    """Stages of ETDRK4 [theory: steppers, eq. 5]."""
    half, none = phi_functions(0.5 * z)[0], np.zeros_like(z)
    return 0.5 * half, none, 0.5 * half, 0.5 * half * np.expm1(0.5 * z), half, *_end_weights(z)


def _krogstad(z: Complex) -> tuple[Complex, ...]:
    """Stages of Krogstad's ETDRK4-B [theory: steppers, eq. 6]."""
    (half, half_2, _), (full, full_2, _) = phi_functions(0.5 * z), phi_functions(z)
    return 0.5 * half, 0.5 * half - half_2, half_2, full - 2.0 * full_2, 2.0 * full_2, *_end_weights(z)


def _integrating_factor(z: Complex) -> tuple[Complex, ...]:
    """Classical Runge-Kutta for e^{-L t} v [theory: steppers, eq. 7]."""
    half: Complex = np.asarray(np.exp(0.5 * z), dtype=complex)
    unit = np.ones_like(z)
    return 0.5 * half, 0.0 * unit, 0.5 * unit, 0.0 * unit, half, half * half / 6.0, half / 3.0, unit / 6.0


METHODS = {
    "etdrk4": Method(4, _cox_matthews),
    "krogstad": Method(4, _krogstad),
    "ifrk4": Method(4, _integrating_factor, lawson=True),
}


def find_method(name: str) -> Method:
    """A method by its name.

    Parameters
    ----------
    name : "etdrk4" (Cox and Matthews), "krogstad" (ETDRK4-B) or "ifrk4" (integrating factor)

    Returns
    -------
    Method

    Raises
    ------
    InputError : an unknown name
    """
    if name not in METHODS:
        raise InputError("method", name, "one of " + ", ".join(METHODS))
    return METHODS[name]


def step_weights(symbol: Complex, frame: float, method: Method, step: float) -> Weights:
    """What one step multiplies the field and N with.

    N is followed in a frame that turns with the crests [theory: steppers, eq. 9].

    Parameters
    ----------
    symbol : L of each mode, 1/s, shape (modes,)
    frame : angular speed of the frame, rad/s
    method : stages and weights
    step : h, s

    Returns
    -------
    Weights
    """
    half, full = np.exp(0.5 * step * symbol), np.exp(step * symbol)
    if method.lawson:
        return Weights._make((half, full, *(step * w for w in method.weights(step * symbol)), half, full))
    turn = 1j * frame * np.arange(symbol.size, dtype=complex)
    a21, a31, a32, a41, a43, b1, b2, b4 = (step * w for w in method.weights(step * (symbol + turn)))
    near = np.exp(-0.5 * step * turn)
    far = near * near
    return Weights(
        half, full, near * a21, near * a31, a32, far * a41, near * a43, far * b1, near * b2, b4, near, far
    )
