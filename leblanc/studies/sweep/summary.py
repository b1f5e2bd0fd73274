"""What a sweep found: statistics, and which varied field an output follows. The only door to SALib."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from functools import partial
from pathlib import Path

import numpy as np

from leblanc.results.sweep import QUANTILES, Sensitivity, Statistics, SweepResult
from leblanc.studies.run.notes import plane_words
from leblanc.studies.sweep.block import DONE, FAILED, NOT_CONVERGED, single_outputs
from leblanc.studies.sweep.sampling import sample_rows
from leblanc.studies.sweep.store import Store, read_arrays
from leblanc.studies.sweep.study import Sweep
from leblanc.studies.sweep.sweep import Progress, run_sweep
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


OVER_SPEED = ("amplitude", "amplitude_dry")
_VALUES = 4_000_000  # read at once
_NUMBER = re.compile(r"(?<![\w.])[-+]?\d[\w.+-]*")


def sweep_result(
    sweep: Sweep,
    folder: Path,
    workers: int | None = None,
    scheduler: str | None = None,
    fresh: bool = False,
    progress: Progress | None = None,
) -> SweepResult:
    """Answer what the store does not hold yet, and say what all samples have in common.

    Parameters and errors are those of `run_sweep`.
    """
    return summarise(run_sweep(sweep, folder, workers, scheduler, fresh, progress), sweep)


def summarise(store: Store, sweep: Sweep) -> SweepResult:
    """Statistics over all samples; reads a few of the store's columns at a time."""
    counts = np.bincount(store.read("status"), minlength=4)
    fields = sample_rows(sweep)(0, store.samples)
    categorical = [field.categorical for field in sweep.fields]
    single, shares = {}, {}
    outputs = single_outputs(bool(sweep.scene.balls))
    for output in outputs:
        values = store.read(output.name)
        single[output.name] = statistics(values[:, None])
        shares[output.name] = sensitivity(sweep.method, fields, categorical, values, sweep.seed)
    speeds = sweep.scene.speeds.count
    own_speeds = any(field.path.startswith("speeds.") for field in sweep.fields)
    return SweepResult(
        name=sweep.name,
        scene=sweep.scene.name,
        store=store.path,
        method=sweep.method,
        seed=sweep.seed,
        fields=tuple(field.path for field in sweep.fields),
        speeds=speeds,
        samples=store.samples,
        done=int(counts[DONE]),
        failed=int(counts[FAILED]),
        not_converged=int(counts[NOT_CONVERGED]),
        reasons=_grouped(store),
        speed=None if own_speeds else sweep.scene.speed_array(),
        single=single,
        units={output.name: output.units for output in outputs},
        over_speed={
            name: _over_speed(store, name, speeds)
            for name in (*OVER_SPEED, *(["amplitude_without"] if sweep.scene.balls else []))
        },
        sensitivities=shares,
        digest=sweep.digest,
        read=partial(read_arrays, store.path),
        plane="" if sweep.scene.rotor.kind == "jeffcott" else _plane(sweep),
    )


def _plane(sweep: Sweep) -> str:
    """Plane of the amplitudes, with its place unless that varies."""
    if not sweep.scene.chambers:
        return plane_words(0.0, chambers=False)
    varied = any(field.path.startswith("chambers.0.plane") for field in sweep.fields)
    words = plane_words(sweep.scene.chambers[0].plane, chambers=True)
    return words.partition(" at ")[0] if varied else words


def statistics(values: Array) -> Statistics:
    """Statistics of each column, over the rows that are finite."""
    found = []
    for column in values.T:
        known = np.sort(column[np.isfinite(column)])
        if known.size == 0:
            found.append((0, np.nan, np.nan, np.full(len(QUANTILES), np.nan)))
            continue
        spread = known.std(ddof=1) if known.size > 1 else 0.0
        found.append((known.size, known.mean(), spread, np.quantile(known, QUANTILES)))
    count, mean, spread, quantiles = zip(*found, strict=True)
    return Statistics(np.array(count), np.array(mean), np.array(spread), np.array(quantiles))


def _over_speed(store: Store, name: str, speeds: int) -> Statistics:
    """Statistics at each speed, as many speeds at once as a bounded memory takes."""
    width = max(1, _VALUES // store.samples)
    pieces = [
        statistics(store.read(name, columns=slice(start, start + width))) for start in range(0, speeds, width)
    ]
    return Statistics(
        *(
            np.concatenate([getattr(piece, part) for piece in pieces])
            for part in ("count", "mean", "deviation", "quantiles")
        )
    )


def _grouped(store: Store) -> tuple[tuple[str, int], ...]:
    """Reasons that differ in numbers only count as one."""
    counts: Counter[str] = Counter()
    examples: dict[str, str] = {}
    for start in range(0, store.samples, store.block):
        for reason in filter(None, store.read("reason", slice(start, start + store.block))):
            kind = _NUMBER.sub("#", reason)
            counts[kind] += 1
            examples.setdefault(kind, reason)
    return tuple((examples[kind], count) for kind, count in counts.most_common())
