"""Oracles of what numba compiles of whirls, run without compiling: see `tests/solvers/test_uncompiled.py`."""

from __future__ import annotations

import numpy as np

from solvers.whirl.elimination import eliminated
from tests.mutants import kills

ELIMINATE = "solvers.whirl.elimination:_eliminate"


@kills(ELIMINATE, "found += 1j * np.pi", "found += 0.0j")
@kills(ELIMINATE, "factor * held[step, j]", "factor * held[i, j]")
@kills(ELIMINATE, "found += np.log(", "found += 0.5 * np.log(")
def test_elimination_is_that_of_lapack() -> None:
    """Determinant and Schur complement of matrices whose pivots must be looked for."""
    chance = np.random.default_rng(1)
    made = chance.normal(size=(20, 5, 5)) + 1j * chance.normal(size=(20, 5, 5))
    made[:, 0, 0] = 0.0
    whole, corner = made[:, :4, :4], made[:, 4, 4]
    unit, length = np.linalg.slogdet(whole)
    rest = corner - np.einsum(
        "ki,ki->k", made[:, 4, :4], np.linalg.solve(whole, made[:, :4, 4, None])[..., 0]
    )
    size, left = eliminated(made.copy())
    assert np.abs(size.real - length).max() < 1e-12
    assert np.abs(np.exp(1j * size.imag) - unit).max() < 1e-12
    assert np.abs(left - rest).max() < 1e-11 * np.abs(rest).max()
