"""What a sweep found, in numbers: how many samples are done, statistics and sensitivities of the outputs."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from leblanc.studies.sweep.outputs import DONE, FAILED, NOT_CONVERGED, SINGLE
from leblanc.studies.sweep.sampling import sample_rows
from leblanc.studies.sweep.sensitivity import Sensitivity, sensitivity
from leblanc.studies.sweep.store import Store
from leblanc.studies.sweep.study import Sweep
from meshes.arrays import Array

QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)
OVER_SPEED = ("amplitude", "amplitude_dry")
_VALUES = 4_000_000  # read at once
_NUMBER = re.compile(r"(?<![\w.])[-+]?\d[\w.+-]*")


@dataclass(frozen=True)
class Statistics:
    """Of an output over the samples that have it; of arrays one for each speed.

    Parameters
    ----------
    count : samples
    mean, deviation : nan without samples; the deviation of a single sample is 0
    quantiles : at the shares `QUANTILES`, the last axis
    """

    count: NDArray[np.int64]
    mean: Array
    deviation: Array
    quantiles: Array


@dataclass(frozen=True)
class Summary:
    """What a sweep found.

    Parameters
    ----------
    samples, done, failed, not_converged : how many
    reasons : why samples are not done, one example for all that differ in numbers only, and how many; the
        most frequent first
    speed : of all samples, rad/s; None where it differs between them
    single : statistics of outputs that are one number a sample
    over_speed : the same at each speed
    sensitivities : of outputs that are one number a sample; None where the samples do not tell
    """

    samples: int
    done: int
    failed: int
    not_converged: int
    reasons: tuple[tuple[str, int], ...]
    speed: Array | None
    single: dict[str, Statistics]
    over_speed: dict[str, Statistics]
    sensitivities: dict[str, Sensitivity | None]


def summarise(store: Store, sweep: Sweep) -> Summary:
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
    return Summary(
        samples=store.samples,
        done=int(counts[DONE]),
        failed=int(counts[FAILED]),
        not_converged=int(counts[NOT_CONVERGED]),
        reasons=_grouped(store),
        speed=None
        if any(one.path.startswith("speeds.") for one in sweep.fields)
        else sweep.scene.speed_array(),
        single=single,
        over_speed={name: _over_speed(store, name, sweep.scene.speeds.count) for name in OVER_SPEED},
        sensitivities=shares,
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


def sweep_json(store: Store, sweep: Sweep, found: Summary) -> dict[str, Any]:
    """What `sweep` prints for scripts: SI, lists over speed or over the varied fields."""
    return {
        "store": str(store.path),
        "name": sweep.name,
        "method": sweep.method,
        "seed": sweep.seed,
        "fields": [one.path for one in sweep.fields],
        "samples": found.samples,
        "done": found.done,
        "failed": found.failed,
        "not_converged": found.not_converged,
        "reasons": [{"reason": reason, "samples": count} for reason, count in found.reasons],
        "outputs": {name: _statistics_json(one, single=True) for name, one in found.single.items()},
        "over_speed": {"speed": found.speed}
        | {name: _statistics_json(one, single=False) for name, one in found.over_speed.items()},
        "sensitivity": found.sensitivities,
        "digest": sweep.digest,
    }


def _statistics_json(one: Statistics, single: bool) -> dict[str, Any]:
    parts = {
        "samples": one.count,
        "mean": one.mean,
        "deviation": one.deviation,
        **{f"quantile_{share:g}": one.quantiles[:, k] for k, share in enumerate(QUANTILES)},
    }
    return {name: value[0] if single else value for name, value in parts.items()}
