"""What a sweep found, in numbers: how many samples are done, statistics and sensitivities of the outputs."""

from __future__ import annotations

import re
from collections import Counter
from functools import partial
from pathlib import Path

import numpy as np

from leblanc.results.sweep import QUANTILES, Statistics, SweepResult
from leblanc.studies.sweep.outputs import DONE, FAILED, NOT_CONVERGED, SINGLE
from leblanc.studies.sweep.sampling import sample_rows
from leblanc.studies.sweep.sensitivity import sensitivity
from leblanc.studies.sweep.store import Store, read_arrays
from leblanc.studies.sweep.study import Sweep
from leblanc.studies.sweep.sweep import Progress, run_sweep
from meshes.arrays import Array

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
    """Statistics over all samples; reads a few of the store's columns at a time.

    Parameters
    ----------
    store : complete
    sweep : that it belongs to
    """
    counts = np.bincount(store.read("status"), minlength=4)
    fields = sample_rows(sweep)(0, store.samples)
    words = [one.words for one in sweep.fields]
    single, shares = {}, {}
    for one in SINGLE:
        values = store.read(one.name)
        single[one.name] = statistics(values[:, None])
        shares[one.name] = sensitivity(sweep.method, fields, words, values, sweep.seed)
    speeds = sweep.scene.speeds.count
    own_speeds = any(one.path.startswith("speeds.") for one in sweep.fields)
    return SweepResult(
        name=sweep.name,
        scene=sweep.scene.name,
        store=store.path,
        method=sweep.method,
        seed=sweep.seed,
        fields=tuple(one.path for one in sweep.fields),
        speeds=speeds,
        samples=store.samples,
        done=int(counts[DONE]),
        failed=int(counts[FAILED]),
        not_converged=int(counts[NOT_CONVERGED]),
        reasons=_grouped(store),
        speed=None if own_speeds else sweep.scene.speed_array(),
        single=single,
        units={one.name: one.units for one in SINGLE},
        over_speed={name: _over_speed(store, name, speeds) for name in OVER_SPEED},
        sensitivities=shares,
        digest=sweep.digest,
        read=partial(read_arrays, store.path),
    )


def statistics(values: Array) -> Statistics:
    """Statistics of each column, over the rows that are finite.

    Parameters
    ----------
    values : shape (samples, n)
    """
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
