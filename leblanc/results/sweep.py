"""What many scenes answered: counts, statistics and sensitivities of the outputs of `sweep`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from leblanc.core.answer import Result, carried
from leblanc.core.netcdf import NamedArrays
from meshes.arrays import Array

QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)


@dataclass(frozen=True)
class Statistics:
    """Of an output over the samples that have it; of arrays one for each speed."""

    count: NDArray[np.int64]  #: samples
    mean: Array  #: nan without samples; the deviation of a single sample is 0
    deviation: Array
    quantiles: Array  #: at the shares `QUANTILES`, the last axis


@dataclass(frozen=True)
class Sensitivity:
    """Shares of an output's variance, one for each varied field."""

    method: str  #: in words
    used: int  #: samples that went in; for "saltelli" points of the design
    first: Array  #: share that the field explains by itself, shape (fields,)
    #: share that is gone once the field is known besides all others; None where the samples are too few
    total: Array | None = None
    #: half widths of the 95 % intervals; None where the design is complete
    first_interval: Array | None = None
    total_interval: Array | None = None


@dataclass(frozen=True)
class EmulatorError:
    """Error of an emulator on samples that it was not shown [theory: emulator, eq. 4]."""

    root_mean_square: float  #: relative to the output for positive outputs, otherwise to its spread
    largest: float
    spread: float  #: standard deviation of the output in the same measure, what knowing nothing leaves
    #: share of the samples within two of the standard deviations that the emulator itself claims
    within_two: float
    samples: int  #: that were predicted


@dataclass(frozen=True)
class SweepResult(Result):
    """What a sweep found.

    Examples
    --------
    >>> import leblanc as lb
    >>> found = lb.sweep("study.toml", workers=0)  # doctest: +SKIP
    >>> found.done, found.to_dataset()["last_amplitude"]  # doctest: +SKIP
    """

    figure: ClassVar[str] = "leblanc.figures.sweep:sweep_figure"
    summary: ClassVar[str] = "leblanc.text.sweep:summary"

    name: str  #: of the study
    scene: str  #: name of the scene that the samples are made from
    store: Path  #: folder of the samples
    method: str  #: of sampling
    seed: int
    fields: tuple[str, ...]  #: paths of what varies
    speeds: int  #: at which each sample is answered, how many
    samples: int  #: how many
    done: int
    failed: int
    not_converged: int
    #: why samples are not done, one example for all that differ in numbers only, and how many; the most
    #: frequent first
    reasons: tuple[tuple[str, int], ...]
    speed: Array | None  #: of all samples, rad/s; None where it differs between them
    single: Mapping[str, Statistics]  #: statistics of outputs that are one number a sample
    units: Mapping[str, str]  #: of these outputs
    over_speed: Mapping[str, Statistics]  #: statistics of the others at each speed
    #: of outputs that are one number a sample; None where the samples are too few
    sensitivities: Mapping[str, Sensitivity | None]
    digest: str  #: fingerprint of the sweep
    #: reads the store, each time it is called
    read: Callable[[], NamedArrays] = field(repr=False, compare=False)
    plane: str = ""  #: of the amplitudes, in words; empty for rotors that move in one plane

    outputs = carried("single")
    sensitivity = carried("sensitivities")

    def to_json(self) -> dict[str, Any]:
        """What `sweep` prints for scripts: SI, lists over speed or over the varied fields."""
        return {
            "store": str(self.store),
            "name": self.name,
            "method": self.method,
            "seed": self.seed,
            "fields": list(self.fields),
            "samples": self.samples,
            "done": self.done,
            "failed": self.failed,
            "not_converged": self.not_converged,
            "reasons": [{"reason": reason, "samples": count} for reason, count in self.reasons],
            "outputs": {name: _statistics_json(values, single=True) for name, values in self.single.items()},
            "over_speed": {"speed": self.speed}
            | {name: _statistics_json(values, single=False) for name, values in self.over_speed.items()},
            "sensitivity": self.sensitivities,
            "digest": self.digest,
        }

    def named_arrays(self) -> NamedArrays:
        """The store over the dimensions `sample` and `speed`; read whole, at each call."""
        return self.read()


def _statistics_json(values: Statistics, single: bool) -> dict[str, Any]:
    parts = {
        "samples": values.count,
        "mean": values.mean,
        "deviation": values.deviation,
        **{f"quantile_{share:g}": values.quantiles[:, k] for k, share in enumerate(QUANTILES)},
    }
    return {name: value[0] if single else value for name, value in parts.items()}
