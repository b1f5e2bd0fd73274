"""What `sweep` answers: counts of samples, statistics and sensitivities of their outputs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from leblanc.core.answer import Answer
from leblanc.core.blocks import Block, Headline, Notes, Picture, Table, Words
from leblanc.core.files import path_text
from leblanc.core.netcdf import NamedArrays
from leblanc.core.notes import one_line
from leblanc.core.quantities import plain, quantities
from leblanc.core.question import called
from leblanc.core.units import (
    ANGULAR_SPEED,
    LENGTH,
    MASS,
    NOT_FOUND,
    Dimension,
    Unit,
    amplitude_sentence,
    amplitudes_are,
    in_rpm,
    number,
    unit_for,
)
from leblanc.scene.schema.load import SceneError, SceneFault
from leblanc.studies.sweep.outputs import Answers, RunupAnswers
from meshes.arrays import Array, Flags, Index
from meshes.quantity import Q

QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)
_HEAD = ("Output", "mean", "deviation", "5 %", "50 %", "95 %", "unit")
_OUTPUTS = {**quantities(Answers), **quantities(RunupAnswers)}
# Those whose sensitivities are shown.
_SHARED = "peak_amplitude", "last_amplitude", "peak_growth", "top_speed", "walking_margin", "clearance"
_SHOWN = 10  # kinds of reasons
_ROWS = 12  # of the table over a value
_ALIKE = 1e-3  # relative: amplitudes as near as this are equal, which is less than any model is off


@dataclass(frozen=True)
class Statistics:
    """Of an output over the samples that have it; of one over speed at each speed, in arrays."""

    count: NDArray[np.int64] | int  #: samples
    mean: Array | float  #: nan without samples; the deviation of a single sample is 0
    deviation: Array | float
    quantiles: Array  #: at the shares `QUANTILES`, the last axis

    def to_json(self) -> dict[str, Any]:
        """Each number by its name."""
        shares = {f"quantile_{share:g}": self.quantiles[..., k] for k, share in enumerate(QUANTILES)}
        return {"samples": self.count, "mean": self.mean, "deviation": self.deviation, **shares}


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
class Emulated:
    """An emulator of an output."""

    settled: Annotated[bool, Q(text="the search for its correlation lengths has come to an end")]
    error: Annotated[EmulatorError, Q(text="on samples that it was not shown")]
    positive: bool  #: so is the output, of which the errors are then shares

    def words(self) -> str:
        """How far it is off."""
        error, of = self.error, "" if self.positive else " of the spread"
        return (
            f"off by {error.root_mean_square:.2g}{of} on unseen samples (root mean square; "
            f"largest {error.largest:.2g}, by the mean alone {error.spread:.2g}), "
            f"{error.within_two:.0%} within twice what it claims"
        )


@dataclass(frozen=True)
class NotEmulated:
    """Why an output has no emulator."""

    reason: str

    def words(self) -> str:
        """The same, in a row of many."""
        return f"none; {self.reason}"


@dataclass(frozen=True)
class Reason:
    """Why some samples are not done."""

    reason: str  #: an example of all that differ in numbers only
    samples: int  #: how many


@dataclass(frozen=True)
class OverValue:
    """Outputs over the one field that varies on a grid, shape (n,); numbers in rising order."""

    name: str  #: of the field, in words
    value: Array  #: SI, or the number of the option
    options: tuple[str, ...]  #: what the values are where they are no numbers; else empty
    unit: Unit  #: in which a person would write the values
    outputs: Mapping[str, Array]  #: amplitudes at the last speed and the largest; growth rate of a `run`
    stable: Flags | None = None  #: at the last speed; None of run-ups
    stable_speeds: Index | None = None  #: at how many speeds, None of run-ups

    @property
    def label(self) -> str:
        """What varies, with its unit."""
        return f"{self.name} ({self.unit.name})" if self.unit.name else self.name

    def text(self, k: int) -> str:
        """One value as printed, without its unit."""
        return self.options[int(self.value[k])] if self.options else self.unit.number(float(self.value[k]))

    @property
    def known(self) -> Flags:
        """Where the last amplitude is known and stable; where it is nowhere stable, where it is known."""
        known: Flags = np.isfinite(self.outputs["last_amplitude"])
        steady = known if self.stable is None else known & self.stable
        return steady if steady.any() else known

    def sentence(self, where: str) -> str:
        """The least last amplitude, at which value it is, and what more of it changes."""
        name, count = self.name, self.value.size
        last, known = self.outputs["last_amplitude"], self.known
        if not known.any():
            return f"None of {count} values of {name} has an amplitude {where}."
        least = float(last[known].min())
        near = known & (last <= least * (1.0 + _ALIKE))
        best = int(np.argmax(near))
        unstable = self.stable is not None and not self.stable[best]
        size = f"{unit_for(LENGTH, least).text(float(last[best]))}{', unstable' if unstable else ''}"
        if near.all() and count > 1:
            return f"None of {count} values of {name} changes the amplitude {where}, {size}, by 0.1 %."
        unit = "" if self.options else f" {self.unit.name}".rstrip()
        found = (
            f"Of {count} values of {name} the least amplitude {where}, {size}, is at {self.text(best)}{unit}"
        )
        same = best + int(np.argmin(np.append(near[best:], False))) - 1  # up to there all are as small
        if self.options:
            pass
        elif same > best:
            upto = "" if same == count - 1 else f"up to {self.text(same)}{unit} "
            found += f"; {upto}more changes nothing (under 0.1 %)"
            if upto and np.isfinite(last[same + 1]) and not known[same + 1]:
                found += ", beyond that it is unstable"
        elif best in (0, count - 1):
            found += f", the {'largest' if best else 'smallest'} of them"
        if bool(np.any(last[np.isfinite(last) & ~known] < least)):
            found += "; what is less is unstable"
        return f"{found}."


@dataclass(frozen=True)
class SweepAnswer(Answer):
    """What many scenes answered.

    Examples
    --------
    >>> import leblanc as lb
    >>> found = lb.sweep("study.toml", workers=0)  # doctest: +SKIP
    >>> found.done, found.to_dataset()["last_amplitude"]  # doctest: +SKIP
    """

    command = "sweep"
    title = "Sweep over many machines"
    page = "sweep.html"
    figure = "leblanc.studies.sweep.figure:sweep_figure"

    store: Annotated[Path, Q(text="folder of the samples")]
    name: Annotated[str, Q(text="of the study")]
    method: Annotated[str, Q(text="of sampling")]
    seed: Annotated[int, Q("1", text="of the random numbers", data=False)]
    fields: Annotated[tuple[str, ...], Q(text="paths of what varies")]
    samples: Annotated[int, Q("1", text="how many scenes", data=False)]
    done: Annotated[int, Q("1", text="samples answered", data=False)]
    failed: Annotated[int, Q("1", text="samples without an answer", data=False)]
    not_converged: Annotated[int, Q("1", text="samples not converged at every speed", data=False)]
    reasons: Annotated[tuple[Reason, ...], Q(text="why samples are not done, the most frequent first")]
    outputs: Annotated[Mapping[str, Statistics], Q(text="statistics of outputs that are one number a sample")]
    over_speed: Annotated[Mapping[str, Statistics], Q(text="statistics of the others at each speed")]
    #: of outputs that are one number a sample; None where the samples are too few
    sensitivity: Annotated[
        Mapping[str, Sensitivity | None], Q(text="shares of the variance by varied field, in their order")
    ]
    digest: Annotated[str, Q(text="fingerprint of the sweep")]
    scene: str  #: name of the scene that the samples are made from
    speeds: int  #: at which each sample is answered, how many
    speed: Array | None  #: of all samples, rad/s; None where it differs between them
    plane: str = ""  #: of the amplitudes, in words; empty for rotors that move in one plane
    command_of: str = "run"  #: that answered each sample
    #: path and words of what varies, "uniform from 3 kg to 12 kg"
    varied: tuple[tuple[str, str], ...] = ()
    over_value: OverValue | None = None  #: where exactly one field varies on a grid
    netcdf: bool = False  #: its file is written
    emulators: Annotated[
        Mapping[str, Emulated | NotEmulated] | None,
        Q(text="errors of an emulator of each output, or why there is none", when="emulators"),
    ] = None

    @property
    def data(self) -> str:  # type: ignore[override]
        return "sweep.nc" if self.netcdf else ""

    @property
    def unused(self) -> tuple[str, ...]:  # type: ignore[override]
        return ("speeds", "optimise") if self.command_of == "runup" else ("runup", "programme", "optimise")

    @property
    def faults(self) -> tuple[str, ...]:
        return ("no sample converged at every speed",) if self.not_converged == self.samples else ()

    def fault(self, where: str) -> Exception | None:
        if self.failed == self.samples:
            return SceneError([SceneFault(where, "vary", None, "such that some sample is a scene")])
        return super().fault(where)

    @property
    def closing(self) -> str:
        return f"{self.name}: {self.done} of {self.samples} samples done"

    def to_json(self) -> dict[str, Any]:
        found = super().to_json()
        return found | {"over_speed": {"speed": plain(self.speed)} | found["over_speed"]}

    def named_arrays(self) -> NamedArrays:
        """The store over the dimensions `sample` and `speed`; read whole, at each call."""
        found: NamedArrays = called("leblanc.studies.sweep.store:read_arrays")(self.store)
        return found

    def blocks(self) -> tuple[Block, ...]:
        emulators = (self.emulators or {}).items()
        over = self.over_value
        first: tuple[Block, ...] = ()
        if over is None:
            title = "How the amplitudes spread"
            outputs = Table([self._row(name) for name in self.outputs], _HEAD, right=True)
        else:
            first = (Headline(over.sentence(self.at_last), one_line(self.scene), shown="both"),)
            title = f"Amplitude over {over.name}"
            outputs = self._values(over)
        counts = [f"{one.samples} of {self.samples} samples: {one.reason}" for one in self.reasons[:_SHOWN]]
        return (
            *first,
            Table(self._facts(), shown="page"),
            *([Table(self.varied, ("Varied", "how"), shown="page")] if self.varied else []),
            Picture("sweep", title, self.figure),
            outputs,
            Words(amplitude_sentence(self.plane)),
            *(self._shares() if over is None else ()),
            *(Words(f"emulator of {name.replace('_', ' ')}: {one.words()}") for name, one in emulators),
            Notes(counts),
            Words(f"The data are in {path_text(self.store)}"),
        )

    def _facts(self) -> list[tuple[str, str]]:
        rows = [
            ("Scene", one_line(self.scene)),
            ("Samples done", f"{self.done} of {self.samples}, {self.method}, seed {self.seed}"),
            ("Answered by", "leblanc run" if self.command_of == "run" else "leblanc runup, in time"),
            amplitudes_are(self.plane),
        ]
        if self.over_value is not None:
            return rows
        if self.command_of == "runup":
            rows.append(("Highest speed reached", self.spread("top_speed", ANGULAR_SPEED)))
        if self.speeds > 1:
            rows.append(("Largest amplitude", self.spread("peak_amplitude")))
            rows.append(("Largest amplitude without liquid", self.spread("peak_amplitude_dry")))
        last = "Amplitude at the last speed" if self.command_of == "run" else "Amplitude at the end"
        rows.append((last, self.spread("last_amplitude")))
        return [*rows, ("The same without liquid", self.spread("last_amplitude_dry"))]

    @property
    def at_last(self) -> str:
        """Where the last amplitude is, "at 1200 rpm"."""
        if self.command_of == "runup":
            return "at the end"
        return "at the last speed" if self.speed is None else f"at {in_rpm(float(self.speed[-1]))}"

    def _values(self, over: OverValue) -> Table:
        """Some rows over the value, evenly chosen, the first and the last among them."""
        names = ["last_amplitude", "last_amplitude_dry"]
        names += ["peak_amplitude", "peak_amplitude_dry"] if self.speeds > 1 else []
        unit = unit_for(LENGTH, *np.concatenate([over.outputs[name] for name in names]).tolist())
        head = [over.label, f"{self.at_last} ({unit.name})", "without liquid"]
        head += [f"largest ({unit.name})", "without liquid"] if self.speeds > 1 else []
        if over.stable_speeds is not None:
            head += ["growth (1/s)", "stable" if self.speeds == 1 else "stable speeds"]
        rows = []
        for k in np.unique(np.linspace(0, over.value.size - 1, _ROWS).round().astype(np.int64)).tolist():
            row = [over.text(k), *(unit.number(float(over.outputs[name][k])) for name in names)]
            if over.stable_speeds is not None:
                count = int(over.stable_speeds[k])
                words = ("no", "yes")[count] if self.speeds == 1 else f"{count} of {self.speeds}"
                row.append(number(float(over.outputs["peak_growth"][k])))
                row.append(words if np.isfinite(over.outputs["last_amplitude"][k]) else NOT_FOUND)
            rows.append(row)
        return Table(rows, head, right=True)

    def spread(self, name: str, dimension: Dimension = LENGTH) -> str:
        """Median of an output and the range of nine samples in ten."""
        sizes = [float(size) for size in self.outputs[name].quantiles[[0, 2, 4]]]
        unit = unit_for(dimension, *sizes)
        low, middle, high = map(unit.number, sizes)
        return f"{middle} {unit.name}, nine in ten from {low} to {high} {unit.name}"

    def _row(self, name: str) -> tuple[str, ...]:
        """Statistics of one output, as `_HEAD` heads them."""
        values, written = self.outputs[name], _OUTPUTS[name].unit
        numbers = [float(one) for one in (values.mean, values.deviation, *values.quantiles[[0, 2, 4]])]
        unit = Unit(written.replace("s-1", "1/s"), 1.0)
        for dimension in (LENGTH, MASS, ANGULAR_SPEED):
            if written == dimension.unit.replace("rad/s", "rad s-1"):
                unit = unit_for(dimension, *numbers)
        return (name.replace("_", " "), *map(unit.number, numbers), unit.name)

    def _shares(self) -> list[Table]:
        """Shares of the variance, a row for each field."""
        found = []
        for name in _SHARED:
            indices = self.sensitivity.get(name)
            if indices is None or (name == "peak_amplitude" and self.speeds == 1):
                continue
            rows = []
            for j, field in enumerate(self.fields):
                row = [field, f"{indices.first[j]:.3f}"]
                if indices.first_interval is not None:
                    row[-1] += f" +- {indices.first_interval[j]:.3f}"
                if indices.total is not None and indices.total_interval is not None:
                    row.append(f"{indices.total[j]:.3f} +- {indices.total_interval[j]:.3f}")
                rows.append(row)
            title = f"Share of the variance of {name.replace('_', ' ')} ({indices.method})"
            found.append(Table(rows, ("Field", "first", "total")[: len(rows[0])], right=True, title=title))
        return found
