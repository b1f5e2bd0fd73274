"""Which varied field an output of a sweep follows. The only door to SALib."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from leblanc.studies.sweep.answer import Sensitivity
from meshes.arrays import Array

CONFIDENCE = 0.95
_RESAMPLES = 100
_HARMONICS = 10  # of an output sorted by a field
_LEAST = 100  # samples; fewer do not tell ten harmonics from noise
_MOST = 16_384  # samples taken from a larger set: the confidence interval is narrow by then


def sensitivity(
    method: str, fields: Array, categorical: Sequence[bool], output: Array, seed: int
) -> Sensitivity | None:
    """Sensitivity of an output to each field, by what the samples of a method allow.

    None where the output does not vary, or where there are too few samples.
    """
    if method == "saltelli":
        return saltelli_indices(output.reshape(-1, fields.shape[1] + 2), seed)
    known = np.isfinite(output)
    fields, output = fields[known], output[known]
    if not _varies(output):
        return None
    if method == "grid":
        return variance_shares(fields, output)
    return given_data(fields, categorical, output, seed)


def _varies(output: Array) -> bool:
    """More than by rounding."""
    if output.size < 2:
        return False
    return bool(np.ptp(output) > 1e-12 * np.max(np.abs(output)))


def variance_shares(fields: Array, output: Array) -> Sensitivity:
    """Variance of the means over each field's levels over the whole variance [theory: sampling, eq. 7].

    Exact where every combination of levels is there once.
    """
    centred = output - output.mean()
    shares = []
    for column in fields.T:
        _, level = np.unique(column, return_inverse=True)
        count = np.bincount(level)
        shares.append(np.sum(np.bincount(level, centred) ** 2 / count) / np.sum(centred**2))
    return Sensitivity("variance of the means over levels", output.size, np.array(shares))


def given_data(fields: Array, categorical: Sequence[bool], output: Array, seed: int) -> Sensitivity | None:
    """First-order indices of any sample by random balance designs [theory: sampling, eq. 8]."""
    from SALib.analyze import rbd_fast

    if output.size < _LEAST:
        return None
    step = -(-output.size // _MOST)
    taken, output = fields[::step].copy(), output[::step]
    rng = np.random.default_rng(seed)
    for j in np.flatnonzero(categorical):
        _, place = np.unique(taken[:, j], return_inverse=True)
        taken[:, j] = place + rng.random(output.size)  # equal values come in any order
    names = [str(j) for j in range(taken.shape[1])]
    found = rbd_fast.analyze(
        {"num_vars": len(names), "names": names},
        *(taken, output / np.std(output)),
        M=_HARMONICS,
        num_resamples=_RESAMPLES,
        conf_level=CONFIDENCE,
        seed=rng,
    )
    first, interval = np.array(found["S1"], dtype=float), np.array(found["S1_conf"], dtype=float)
    return Sensitivity("random balance designs", output.size, first, first_interval=interval)


def saltelli_indices(members: Array, seed: int) -> Sensitivity | None:
    """First-order and total indices of a "saltelli" design [theory: sampling, eq. 9].

    Output at each point with A, with A and one field after the other from B, and with B, shape (points,
    fields + 2).
    """
    from SALib.analyze.sobol import first_order, total_order

    whole = members[np.isfinite(members).all(axis=1)]
    if whole.shape[0] < 2 or not _varies(whole.ravel()) or not _varies(whole[:, [0, -1]].ravel()):
        return None
    whole = (whole - whole.mean()) / whole.std()
    a, b = whole[:, 0], whole[:, -1]
    swapped = whole[:, 1:-1].T
    rng = np.random.default_rng(seed)
    drawn: list[Array] = []
    for _ in range(_RESAMPLES):
        again = rng.integers(a.size, size=a.size)
        if np.ptp(a[again]) == np.ptp(b[again]) == 0.0:
            continue
        drawn.append(
            np.array(
                [
                    [index(a[again], values[again], b[again]) for values in swapped]
                    for index in (first_order, total_order)
                ]
            )
        )
    half = (
        1.959963984540054 * np.std(drawn, axis=0, ddof=1)
        if len(drawn) > 1
        else np.full((2, len(swapped)), np.nan)
    )
    return Sensitivity(
        "Sobol indices",
        a.size,
        np.array([first_order(a, values, b) for values in swapped]),
        np.array([total_order(a, values, b) for values in swapped]),
        half[0],
        half[1],
    )
