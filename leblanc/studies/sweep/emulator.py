"""An emulator of one output over varied values: Gaussian processes with a cross-validated error.

The only door to scikit-learn. Positive outputs are emulated by their logarithm, so that the error is one of
ratios. The process follows smooth outputs well and rounds off kinks, as where a wall runs dry; how far it is
off is measured on samples that the process has not seen [theory: emulator, eq. 1-4].
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from leblanc.studies.sweep.answer import Emulated, EmulatorError, NotEmulated
from leblanc.studies.sweep.block import DONE
from leblanc.studies.sweep.store import Store, read_store
from meshes.arrays import Array, Flags
from meshes.errors import InputError

LEAST = 10  # samples for each varied value
MOST = 400  # samples a process learns from; its cost grows with their cube
_FOLDS = 5
_SMOOTHNESS = 2.5  # of the Matern kernel: twice differentiable
_NOISE = 1e-10, 1e-2  # share of the variance
_REACH = 1e-2, 1e3  # correlation lengths over the range of a value
_WIDE = 30.0  # ratio of the ends of a range from which the logarithm of the value is taken


@dataclass(frozen=True)
class Emulator:
    """An output as a function of varied values."""

    fields: tuple[str, ...]  #: names of the values
    low: Array  #: ranges of the samples it has learned from, shape (d,)
    high: Array
    wide: Flags  #: values that are taken by their logarithm, shape (d,)
    positive: bool  #: the output is emulated by its logarithm
    centre: float  #: of what is emulated
    scale: float
    process: Any  #: fitted
    settled: bool  #: the search for the correlation lengths has come to an end, for it and all folds
    error: EmulatorError  #: cross-validated

    def predict(self, values: ArrayLike) -> tuple[Array, Array]:
        """Output and its standard deviation.

        Shape (n,); of a positive output the relative deviation times the output. An `InputError` outside the
        ranges.
        """
        mean, deviation = self.process.predict(self._points(values), return_std=True)
        mean, deviation = self.centre + self.scale * mean, self.scale * deviation
        return (np.exp(mean), np.exp(mean) * deviation) if self.positive else (mean, deviation)

    def output(self, values: ArrayLike) -> Array:
        """Output alone, at a fraction of the cost; see `predict`."""
        mean = self.centre + self.scale * self.process.predict(self._points(values))
        return np.asarray(np.exp(mean) if self.positive else mean)

    def _points(self, values: ArrayLike) -> Array:
        """Values over their ranges."""
        points, slack = np.asarray(values, dtype=float), 1e-9 * (self.high - self.low)
        for k, name in enumerate(self.fields):
            column = points[:, k]
            wrong = ~((column >= self.low[k] - slack[k]) & (column <= self.high[k] + slack[k]))
            if wrong.any():
                allowed = f"inside the range of the samples, {self.low[k]:g} to {self.high[k]:g}"
                raise InputError(name, float(column[wrong][0]), allowed)
        return _unit(points, self.low, self.high, self.wide)


def emulate(fields: Sequence[str], values: Array, output: Array, seed: int = 0) -> Emulator:
    """Emulator of an output from samples, with its error on unseen samples."""
    known = np.isfinite(output) & np.isfinite(values).all(axis=1)
    values, output = values[known], output[known]
    if output.size < LEAST * len(fields):
        allowed = f"at least {LEAST} finite samples for each varied value, {LEAST * len(fields)} in all"
        raise InputError("samples", output.size, allowed)
    if output.max() - output.min() <= 1e-12 * np.abs(output).max():
        raise InputError("output", float(output[0]), "one that varies over the samples")
    low, high = values.min(axis=0), values.max(axis=0)
    for name, a, b in zip(fields, low.tolist(), high.tolist(), strict=True):
        if not b > a:
            raise InputError(name, a, "a value that varies over the samples")
    rng = np.random.default_rng(seed)
    taken = rng.permutation(output.size)[:MOST]
    wide, positive = (low > 0.0) & (high > _WIDE * np.maximum(low, 1e-300)), bool(output.min() > 0.0)
    points = _unit(values[taken], low, high, wide)
    scaled = np.log(output[taken]) if positive else output[taken]
    centre, scale = float(scaled.mean()), float(scaled.std())
    standard = (scaled - centre) / scale
    process, settled = _fit(points, standard)
    missed, claimed, all_settled = _on_unseen(points, standard)
    # A difference of logarithms is the relative error; without them it is over the spread.
    size = scale if positive else 1.0
    error = EmulatorError(
        root_mean_square=float(size * np.sqrt(np.mean(np.square(missed)))),
        largest=float(size * np.abs(missed).max()),
        spread=size,
        within_two=float(np.mean(np.abs(missed) <= 2.0 * claimed)),
        samples=missed.size,
    )
    return Emulator(
        *(tuple(fields), low, high, wide, positive, centre, scale, process, settled and all_settled, error)
    )


def _unit(values: Array, low: Array, high: Array, wide: Flags) -> Array:
    """Values over their ranges, 0 to 1, wide ones by their logarithm [theory: emulator, eq. 1]."""
    x, a, b = values.copy(), low.copy(), high.copy()
    a[wide], b[wide] = np.log(low[wide]), np.log(high[wide])
    x[:, wide] = np.log(np.maximum(values[:, wide], 1e-300))
    return np.asarray((x - a) / (b - a))


def _on_unseen(points: Array, standard: Array) -> tuple[Array, Array, bool]:
    """Errors and claimed deviations of each sample by a process that learned from the other folds."""
    missed, claimed = np.empty((2, standard.size))
    settled = True
    fold = np.arange(standard.size) % _FOLDS  # the samples are in random order
    for k in range(_FOLDS):
        process, fine = _fit(points[fold != k], standard[fold != k])
        mean, claimed[fold == k] = process.predict(points[fold == k], return_std=True)
        missed[fold == k] = mean - standard[fold == k]
        settled &= fine
    return missed, claimed, settled


def _fit(points: Array, standard: Array) -> tuple[Any, bool]:
    """Process of the greatest likelihood [theory: emulator, eq. 2], and whether its search came to an end."""
    from sklearn.exceptions import ConvergenceWarning
    from sklearn.gaussian_process import GaussianProcessRegressor
    from sklearn.gaussian_process.kernels import ConstantKernel, Matern, WhiteKernel

    lengths = np.full(points.shape[1], 0.5)
    kernel = ConstantKernel(1.0, (1e-3, 1e4)) * Matern(lengths, _REACH, nu=_SMOOTHNESS)
    process = GaussianProcessRegressor(kernel + WhiteKernel(1e-6, _NOISE), alpha=1e-12)
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        process.fit(points, standard)
    # A length at the end of its range is an answer: the output does not follow that value.
    ours = [warning for warning in said if issubclass(warning.category, ConvergenceWarning)]
    for warning in said:
        if warning not in ours:
            warnings.warn_explicit(warning.message, warning.category, warning.filename, warning.lineno)
    return process, all("close to" in str(warning.message) for warning in ours)


def emulate_store(store: Store | Path, output: str, seed: int = 0) -> Emulator:
    """Emulator of an output that is one number a sample, over the varied fields [theory: emulator]."""
    found = read_store(store) if isinstance(store, Path) else store
    if output not in (known := single_outputs(found)):
        raise InputError("output", output, "one of " + ", ".join(known))
    fields = varied_fields(found)
    columns = [found.read(name) for name in fields]
    for name, column in zip(fields, columns, strict=True):
        if column.dtype.kind != "f":
            raise InputError(name, "words", "a number; an emulator has no measure for words")
    values = np.where(found.read("status") == DONE, found.read(output), np.nan)
    return emulate(fields, np.stack(columns, axis=1), values, seed)


def emulated_outputs(store: Store, seed: int = 0) -> dict[str, Emulated | NotEmulated]:
    """Error of an emulator of every output that is one number a sample, or the reason why there is none."""
    found: dict[str, Emulated | NotEmulated] = {}
    for output in single_outputs(store):
        try:
            emulator = emulate_store(store, output, seed)
            found[output] = Emulated(emulator.settled, emulator.error, emulator.positive)
        except InputError as error:
            found[output] = NotEmulated(f"{error.field} must be {error.allowed}")
    return found


def single_outputs(store: Store) -> tuple[str, ...]:
    """Outputs of a store that are one number a sample."""
    fields, single = varied_fields(store), ("sample",)
    return tuple(
        name
        for name, array in store.arrays.items()
        if name not in fields and store.dims(name) == single and array.dtype.kind == "f"
    )


def varied_fields(store: Store) -> tuple[str, ...]:
    """Paths of the varied fields, in the order of the study."""
    lines = str(store.attributes()["vary"]).splitlines()
    return tuple(line.partition(": ")[0] for line in lines)
