"""Compiled elimination of a layer's motions: many small matrices, one after the other."""

from __future__ import annotations

from typing import Any

import numpy as np

from meshes.arrays import Complex
from solvers.machine_code import machine_code

_jit: Any = machine_code(error_model="numpy", nogil=True, fastmath={"contract"})


@_jit
def _eliminate(matrices: Complex, size: Complex, left: Complex) -> None:
    """See `eliminated`; one matrix after the other, in place, with rows changed as the pivots ask."""
    count = matrices.shape[1] - 1
    for k in range(size.size):
        held, found = matrices[k], 0.0j
        for step in range(count):
            best, largest = step, -1.0
            for i in range(step, count):
                here = abs(held[i, step].real) + abs(held[i, step].imag)
                if here > largest:
                    best, largest = i, here
            if best != step:
                found += 1j * np.pi
                for j in range(step, count + 1):
                    held[step, j], held[best, j] = held[best, j], held[step, j]
            found += np.log(held[step, step])
            inverse = 1.0 / held[step, step]
            for i in range(step + 1, count + 1):
                factor = held[i, step] * inverse
                for j in range(step + 1, count + 1):
                    held[i, j] -= factor * held[step, j]
        size[k], left[k] = found, held[count, count]


def eliminated(matrices: Complex) -> tuple[Complex, Complex]:
    """log det of all but the last row and column of k matrices, and what is left of the last entry.

    Shape (k, m + 1, m + 1), used up; the phase is that of the determinant but for whole turns.
    """
    size, left = np.empty((2, len(matrices)), dtype=complex)
    _eliminate(matrices, size, left)
    return size, left
